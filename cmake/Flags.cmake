# Arithmetic that gives the same bits in every translation unit. For all that is linked with the static layers, because
# the linker keeps any one copy of an inline function; programs of others get a shared library (SharedLibrary.cmake).
# -fno-tree-slp-vectorize: GCC 12 at -O3 -march=native emits vfmaddsub there in spite of -ffp-contract=off.
add_library(barchan_arithmetic INTERFACE)
target_compile_options(barchan_arithmetic INTERFACE -ffp-contract=off -fno-tree-slp-vectorize)
target_compile_features(barchan_arithmetic INTERFACE cxx_std_20)

# What only the project's own sources are compiled with.
add_library(barchan_house INTERFACE)
target_compile_options(barchan_house INTERFACE
  -Wall -Wextra -Wshadow -Wconversion -Wno-sign-conversion -fno-math-errno
  $<$<BOOL:${BARCHAN_WERROR}>:-Werror>)
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
  # GCC's own std::string sets these off (bug 105651).
  target_compile_options(barchan_house INTERFACE -Wno-array-bounds -Wno-restrict -Wno-stringop-overflow)
endif()
target_compile_definitions(barchan_house INTERFACE BARCHAN_VERSION="${PROJECT_VERSION}")

if(BARCHAN_WIDE_KERNELS AND CMAKE_SYSTEM_PROCESSOR MATCHES "^(x86_64|AMD64|amd64)$")
  set(BARCHAN_HAS_X86_KERNELS 1)
endif()
set(BARCHAN_KERNEL_FLAGS -O3)  # batches are loops of constant length; -O2 leaves them in memory
set(BARCHAN_AVX2_FLAGS -mavx2 -mfma)
set(BARCHAN_AVX512_FLAGS
  -mavx512f -mavx512dq -mavx512vl -mavx512bw ${BARCHAN_AVX2_FLAGS} -mprefer-vector-width=512)
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
  # GCC's own intrinsics set the warning off (bug 105593); order matters, these follow -Wall.
  list(APPEND BARCHAN_AVX512_FLAGS -Wno-uninitialized -Wno-maybe-uninitialized)
endif()

# Wide kernels are told by their names: NAME_avx2.cpp and NAME_avx512.cpp (tests: NAME_avx2_test.cpp) get the
# instructions in their name, and are left out of the list on other machines.
function(barchan_set_kernel_flags sources_variable)
  set(sources ${${sources_variable}})
  foreach(width avx2 avx512)
    set(wide ${sources})
    list(FILTER wide INCLUDE REGEX "_${width}(_test)?\\.cpp$")
    string(TOUPPER ${width} upper)
    if(NOT wide)
      continue()
    elseif(BARCHAN_HAS_X86_KERNELS)
      set_source_files_properties(${wide} PROPERTIES
        COMPILE_OPTIONS "${BARCHAN_KERNEL_FLAGS};${BARCHAN_${upper}_FLAGS}" SKIP_PRECOMPILE_HEADERS ON)
    else()
      list(REMOVE_ITEM sources ${wide})
    endif()
  endforeach()
  set(${sources_variable} ${sources} PARENT_SCOPE)
endfunction()
