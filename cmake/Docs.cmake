# Target `docs`: the API reference in build/…/docs/html, by Doxygen.
barchan_list_headers(documented ${BARCHAN_PUBLIC_HEADERS})
list(FILTER documented INCLUDE REGEX "^(tasks|core/model|core/brick|core/base/error|core/links/walls|comm/base/communicator)")
list(TRANSFORM documented PREPEND ${PROJECT_SOURCE_DIR}/)
list(APPEND documented ${PROJECT_SOURCE_DIR}/bindings/c/barchan.h)
list(JOIN documented " " BARCHAN_DOCUMENTED)
configure_file(docs/Doxyfile.in docs/Doxyfile @ONLY)

find_program(BARCHAN_DOXYGEN doxygen)
if(BARCHAN_DOXYGEN)
  add_custom_target(docs COMMAND ${BARCHAN_DOXYGEN} ${PROJECT_BINARY_DIR}/docs/Doxyfile VERBATIM)
else()
  add_custom_target(docs COMMAND ${CMAKE_COMMAND} -E echo "no API reference: there is no doxygen (Debian: doxygen)")
endif()
