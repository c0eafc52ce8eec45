# Component `library`: libkaustik as programs run with it. Component `development`: what they are built with, its headers
# and what find_package(kaustik) and pkg-config read.
include(CMakePackageConfigHelpers)
set(KAUSTIK_CMAKE_DIR ${CMAKE_INSTALL_LIBDIR}/cmake/kaustik)
install(TARGETS libkaustik EXPORT kaustikTargets
        LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT library NAMELINK_COMPONENT development)
install(DIRECTORY include/kaustik DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT development
        FILES_MATCHING PATTERN "*.h")
install(FILES ${PROJECT_BINARY_DIR}/include/kaustik/version.h
        DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/kaustik COMPONENT development)
install(EXPORT kaustikTargets NAMESPACE kaustik:: FILE kaustikConfig.cmake DESTINATION ${KAUSTIK_CMAKE_DIR}
        COMPONENT development)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/cmake/kaustikConfigVersion.cmake
                                 COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/cmake/kaustikConfigVersion.cmake
        DESTINATION ${KAUSTIK_CMAKE_DIR} COMPONENT development)
# The folder that pkg-config's file lies in leads to the others, so an installation may be moved.
file(RELATIVE_PATH KAUSTIK_PC_TO_PREFIX /${CMAKE_INSTALL_LIBDIR}/pkgconfig /)
configure_file(cmake/kaustik.pc.in ${PROJECT_BINARY_DIR}/cmake/kaustik.pc @ONLY)
install(FILES ${PROJECT_BINARY_DIR}/cmake/kaustik.pc
        DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig COMPONENT development)
