# `make install` and Debian packages by CPack. Component `program` is what users need; `development` is the library.
install(TARGETS kaustik RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT program)
# Man pages and completions, where shells of most distributions look, and for zsh those of Debian.
set(made ${PROJECT_BINARY_DIR}/apps/kaustik/made)
install(DIRECTORY ${made}/man1 DESTINATION ${CMAKE_INSTALL_MANDIR} COMPONENT program)
install(FILES ${made}/kaustik.bash DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions
        RENAME kaustik COMPONENT program)
install(FILES ${made}/_kaustik DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/site-functions COMPONENT program)
install(FILES ${made}/_kaustik DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/vendor-completions COMPONENT program)
install(FILES ${made}/kaustik.fish DESTINATION ${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d
        COMPONENT program)
install(DIRECTORY scenes DESTINATION ${CMAKE_INSTALL_DATADIR}/kaustik COMPONENT program
        PATTERN generator EXCLUDE)
install(FILES README.md LICENSE CHANGELOG.md DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT program)
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME kaustik)
set(CPACK_PACKAGE_CONTACT "The Kaustik authors")
set(CPACK_COMPONENTS_ALL program development)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_NAME kaustik)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME libkaustik-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEVELOPMENT_DESCRIPTION "Photon mapping renderer, library and headers")
# What cmake/library_dependencies.cmake finds.
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS
    "pkg-config, libembree-dev, libtbb-dev, libimath-dev, libfmt-dev, libopenexr-dev, libtiff-dev, libpng-dev, libjpeg-dev, \
libwebp-dev, libhwy-dev, libpugixml-dev, zlib1g-dev")
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
include(CPack)
