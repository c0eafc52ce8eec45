# Component `development`: the rooms' libraries, their headers, and what find_package(kaustik) reads.
include(CMakePackageConfigHelpers)
set(KAUSTIK_CMAKE_DIR ${CMAKE_INSTALL_LIBDIR}/cmake/kaustik)
get_property(rooms GLOBAL PROPERTY KAUSTIK_ROOMS)
install(TARGETS ${rooms} kaustik_library EXPORT kaustikTargets
        ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT development)
# Left out are the headers that show a library which the rooms hide: Embree, libtiff, pugixml, nlohmann-json.
install(DIRECTORY src/kaustik DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT development
        FILES_MATCHING PATTERN "*.h"
        REGEX "/(geometry/(embree_scene|embree_rays|solid_bodies)|image/tiff_memory)\\.h$" EXCLUDE
        REGEX "/view/(camera_pose|event_streams|json_text|parameter_list|probe|routes|scene_edits|view_report)\\.h$" EXCLUDE
        REGEX "/loader/(xml_document|mitsuba_(element|reader|transform))\\.h$" EXCLUDE)
install(FILES ${PROJECT_BINARY_DIR}/include/kaustik/base/version.h
        DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/kaustik/base COMPONENT development)
install(EXPORT kaustikTargets NAMESPACE kaustik:: DESTINATION ${KAUSTIK_CMAKE_DIR}
        COMPONENT development)
configure_package_config_file(cmake/kaustikConfig.cmake.in
                              ${PROJECT_BINARY_DIR}/cmake/kaustikConfig.cmake
                              INSTALL_DESTINATION ${KAUSTIK_CMAKE_DIR})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/cmake/kaustikConfigVersion.cmake
                                 COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/cmake/kaustikConfig.cmake
              ${PROJECT_BINARY_DIR}/cmake/kaustikConfigVersion.cmake
              cmake/library_dependencies.cmake
        DESTINATION ${KAUSTIK_CMAKE_DIR} COMPONENT development)
