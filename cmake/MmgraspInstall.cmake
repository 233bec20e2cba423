# Install rules: `cmake --install <build> --component development` gives headers, library, planner plugin and the package
# that find_package(mmgrasp) reads. A consumer needs Eigen and nothing else.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)
set(config_dir ${CMAKE_INSTALL_LIBDIR}/cmake/mmgrasp)

install(TARGETS mmgrasp EXPORT mmgraspTargets
        LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT development
        INCLUDES DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
if(TARGET mmgrasp_ompl)
  install(TARGETS mmgrasp_ompl LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT development)
endif()
install(DIRECTORY cpp/include/mmgrasp DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT development
        FILES_MATCHING PATTERN "*.hpp" PATTERN detail EXCLUDE)
install(EXPORT mmgraspTargets NAMESPACE mmgrasp:: DESTINATION ${config_dir} COMPONENT development)
configure_package_config_file(cmake/mmgraspConfig.cmake.in ${CMAKE_BINARY_DIR}/cmake/mmgraspConfig.cmake
                              INSTALL_DESTINATION ${config_dir})
write_basic_package_version_file(${CMAKE_BINARY_DIR}/cmake/mmgraspConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_BINARY_DIR}/cmake/mmgraspConfig.cmake ${CMAKE_BINARY_DIR}/cmake/mmgraspConfigVersion.cmake
        DESTINATION ${config_dir} COMPONENT development)
