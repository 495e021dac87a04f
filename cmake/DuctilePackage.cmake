# What find_package(ductile) reads, and the Debian package (cpack, ./dev package).
include(CMakePackageConfigHelpers)
configure_package_config_file(${CMAKE_CURRENT_LIST_DIR}/ductileConfig.cmake.in
  ${PROJECT_BINARY_DIR}/cmake/ductileConfig.cmake INSTALL_DESTINATION ${DUCTILE_CMAKE_DIR})
# Before 1.0 a minor version may change what stands in the headers.
write_basic_package_version_file(${PROJECT_BINARY_DIR}/cmake/ductileConfigVersion.cmake
  COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/cmake/ductileConfig.cmake ${PROJECT_BINARY_DIR}/cmake/ductileConfigVersion.cmake
  DESTINATION ${DUCTILE_CMAKE_DIR})
install(FILES README.md DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR} RENAME copyright)
if(EXISTS ${PROJECT_SOURCE_DIR}/docs)
  install(DIRECTORY docs/ DESTINATION ${CMAKE_INSTALL_DOCDIR}/docs FILES_MATCHING PATTERN *.md PATTERN *.json
    PATTERN *.svg PATTERN *.png)
endif()
if(DUCTILE_FILES)
  install(DIRECTORY scenes/ DESTINATION ${CMAKE_INSTALL_DATADIR}/ductile/scenes
    FILES_MATCHING PATTERN *.json PATTERN *.svg PATTERN include EXCLUDE)
endif()

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_CONTACT "the ductile authors")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
# The command runs without these; programs that link the libraries are built with them.
set(CPACK_DEBIAN_PACKAGE_RECOMMENDS "libbox2d-dev, libpugixml-dev, zlib1g-dev, libgmp-dev, libfmt-dev, libglpk-dev")
include(CPack)
