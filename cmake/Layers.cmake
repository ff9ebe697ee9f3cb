# A layer is a folder and a static library barchan_LAYER. It sees its own headers and those of the layers that it
# links, nothing else: each layer has an include root of its own in the build folder, which holds one link, so
# that `#include <barchan/core/base/vec.hpp>` reads the same in the tree and installed.
set(BARCHAN_LAYERS "")

function(barchan_link_headers layer)
  set(root ${PROJECT_BINARY_DIR}/include/${layer})
  file(MAKE_DIRECTORY ${root}/barchan)
  file(CREATE_LINK ${PROJECT_SOURCE_DIR}/${layer} ${root}/barchan/${layer} SYMBOLIC)
endfunction()

# Reading the libraries is half of a small file's compile time. A compiler cache does better without.
function(barchan_precompile target)
  if(NOT CMAKE_CXX_COMPILER_LAUNCHER)
    target_precompile_headers(${target} PRIVATE <Eigen/Core> <fmt/format.h>
      <algorithm> <array> <cmath> <functional> <map> <memory> <optional> <span> <string> <vector> ${ARGN})
  endif()
endfunction()

# For a target that is compiled with the same flags as another one.
function(barchan_precompiled_with target other)
  if(NOT CMAKE_CXX_COMPILER_LAUNCHER)
    target_precompile_headers(${target} REUSE_FROM ${other})
  endif()
endfunction()

# A layer without sources yet is a library without code.
function(barchan_add_layer layer)
  barchan_link_headers(${layer})
  file(GLOB sources CONFIGURE_DEPENDS
    ${PROJECT_SOURCE_DIR}/${layer}/*.cpp ${PROJECT_SOURCE_DIR}/${layer}/*/*.cpp)
  barchan_set_kernel_flags(sources)
  set(target barchan_${layer})
  if(sources)
    set(scope PUBLIC)
    add_library(${target} STATIC ${sources})
    target_link_libraries(${target} PRIVATE barchan_house)
    set_target_properties(${target} PROPERTIES POSITION_INDEPENDENT_CODE ON)
    barchan_precompile(${target})
    if(BARCHAN_HAS_X86_KERNELS)
      target_compile_definitions(${target} PRIVATE BARCHAN_HAS_X86_KERNELS=1)
    endif()
  else()
    set(scope INTERFACE)
    add_library(${target} INTERFACE)
  endif()
  target_include_directories(${target} ${scope}
    ${PROJECT_BINARY_DIR}/include/${layer})
  target_link_libraries(${target} ${scope} barchan_arithmetic)
  set(BARCHAN_LAYERS ${BARCHAN_LAYERS} ${target} PARENT_SCOPE)
endfunction()

function(barchan_link layer scope)
  get_target_property(type barchan_${layer} TYPE)
  if(type STREQUAL "INTERFACE_LIBRARY")
    set(scope INTERFACE)
  endif()
  target_link_libraries(barchan_${layer} ${scope} ${ARGN})
endfunction()
