# barchan::barchan, for programs in C++: the layers in one library. Inline functions of headers are compiled with a
# program's own flags, too. A static library would share one copy of each with it, whichever the linker keeps; this one
# calls its own (-Bsymbolic-functions), so that no flag has to reach the program.
add_library(barchan_cpp SHARED
  $<TARGET_OBJECTS:barchan_core> $<TARGET_OBJECTS:barchan_comm> $<TARGET_OBJECTS:barchan_tasks>)
add_library(barchan::barchan ALIAS barchan_cpp)
set_target_properties(barchan_cpp PROPERTIES EXPORT_NAME barchan LINKER_LANGUAGE CXX
  VERSION ${PROJECT_VERSION} SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})
target_compile_features(barchan_cpp INTERFACE cxx_std_20)
target_link_libraries(barchan_cpp PUBLIC Eigen3::Eigen MPI::MPI_CXX
  PRIVATE $<BUILD_INTERFACE:TBB::tbb> $<BUILD_INTERFACE:fmt::fmt> $<BUILD_INTERFACE:PNG::PNG>
  $<BUILD_INTERFACE:ZLIB::ZLIB> $<BUILD_INTERFACE:PkgConfig::XXHASH> $<BUILD_INTERFACE:tomlplusplus::tomlplusplus>)
target_link_options(barchan_cpp PRIVATE LINKER:-Bsymbolic-functions LINKER:--no-undefined)
target_include_directories(barchan_cpp INTERFACE
  $<BUILD_INTERFACE:${PROJECT_BINARY_DIR}/include/core> $<BUILD_INTERFACE:${PROJECT_BINARY_DIR}/include/comm>
  $<BUILD_INTERFACE:${PROJECT_BINARY_DIR}/include/tasks> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)

# What a program may include, and what that includes.
set(BARCHAN_PUBLIC_HEADERS
  tasks/simulation.hpp tasks/open_deck.hpp core/base/error.hpp core/generators/make_particles.hpp
  core/model/contact_numbers.hpp core/model/validate.hpp)

function(barchan_list_headers result)
  set(found "")
  set(to_read ${ARGN})
  while(to_read)
    list(POP_FRONT to_read header)
    list(APPEND found ${header})
    set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/${header})
    file(STRINGS ${PROJECT_SOURCE_DIR}/${header} lines REGEX "^#include <barchan/")
    foreach(line ${lines})
      string(REGEX REPLACE "^#include <barchan/([^>]*)>.*" "\\1" included ${line})
      if(NOT included IN_LIST found AND NOT included IN_LIST to_read)
        list(APPEND to_read ${included})
      endif()
    endforeach()
  endwhile()
  set(${result} ${found} PARENT_SCOPE)
endfunction()
