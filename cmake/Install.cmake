include(CMakePackageConfigHelpers)
set(config_dir ${CMAKE_INSTALL_LIBDIR}/cmake/barchan)

install(TARGETS barchan_cpp EXPORT barchanTargets)
install(EXPORT barchanTargets NAMESPACE barchan:: DESTINATION ${config_dir})
configure_package_config_file(cmake/barchanConfig.cmake.in ${PROJECT_BINARY_DIR}/barchanConfig.cmake
  INSTALL_DESTINATION ${config_dir} NO_SET_AND_CHECK_MACRO)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/barchanConfigVersion.cmake
  COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/barchanConfig.cmake ${PROJECT_BINARY_DIR}/barchanConfigVersion.cmake
  DESTINATION ${config_dir})

barchan_list_headers(headers ${BARCHAN_PUBLIC_HEADERS})
foreach(header ${headers})
  get_filename_component(folder ${header} DIRECTORY)
  install(FILES ${header} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/barchan/${folder})
endforeach()
install(DIRECTORY examples DESTINATION ${CMAKE_INSTALL_DATADIR}/barchan
  PATTERN "*.out" EXCLUDE PATTERN "build" EXCLUDE)
if(TARGET barchan_c)
  install(TARGETS barchan_c EXPORT barchanTargets)
endif()
install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR})
if(TARGET barchan)
  install(TARGETS barchan)
endif()
