# SPDX-License-Identifier: GPL-3.0-or-later
# cmake --install build --prefix X: the program, the schema for editors, the examples, the licence.
install(TARGETS msml_program RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
install(FILES ${CMAKE_SOURCE_DIR}/schemas/msml.xsd DESTINATION ${CMAKE_INSTALL_DATADIR}/msml)
install(DIRECTORY ${CMAKE_SOURCE_DIR}/examples DESTINATION ${CMAKE_INSTALL_DATADIR}/msml)
install(FILES ${CMAKE_SOURCE_DIR}/README.md ${CMAKE_SOURCE_DIR}/LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR})
