# What `cmake --install` puts where: component Runtime is the program and what it needs, component
# Development the libraries with the package config that find_package(FisherHill) reads.
include(CMakePackageConfigHelpers)
include(GNUInstallDirs)

# Names that nobody else has: libinfo.a and bio/ would meet others in /usr.
set(FISHERHILL_INCLUDE_DIR ${CMAKE_INSTALL_INCLUDEDIR}/fisherhill)
set(FISHERHILL_CONFIG_DIR ${CMAKE_INSTALL_LIBDIR}/cmake/FisherHill)

# fisherhill_install_library(target): library and public headers, as FisherHill::target.
function(fisherhill_install_library target)
  set_target_properties(${target} PROPERTIES OUTPUT_NAME fisherhill_${target})
  install(TARGETS ${target} EXPORT FisherHillTargets
    ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT Development
    LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT Development
    FILE_SET HEADERS DESTINATION ${FISHERHILL_INCLUDE_DIR} COMPONENT Development
    INCLUDES DESTINATION ${FISHERHILL_INCLUDE_DIR})
endfunction()

# fisherhill_install_package(): the config that finds the libraries and what they link.
function(fisherhill_install_package)
  install(EXPORT FisherHillTargets NAMESPACE FisherHill:: FILE FisherHillTargets.cmake
    DESTINATION ${FISHERHILL_CONFIG_DIR} COMPONENT Development)
  configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/FisherHillConfig.cmake.in
    ${PROJECT_BINARY_DIR}/FisherHillConfig.cmake
    INSTALL_DESTINATION ${FISHERHILL_CONFIG_DIR} NO_SET_AND_CHECK_MACRO)
  write_basic_package_version_file(${PROJECT_BINARY_DIR}/FisherHillConfigVersion.cmake
    COMPATIBILITY SameMinorVersion)
  install(
    FILES ${PROJECT_BINARY_DIR}/FisherHillConfig.cmake
          ${PROJECT_BINARY_DIR}/FisherHillConfigVersion.cmake
    DESTINATION ${FISHERHILL_CONFIG_DIR} COMPONENT Development)
endfunction()

# fisherhill_install_data(): models with their notice, trials, licence and changes.
function(fisherhill_install_data)
  install(DIRECTORY ${PROJECT_SOURCE_DIR}/models ${PROJECT_SOURCE_DIR}/emg_data
    DESTINATION ${CMAKE_INSTALL_DATADIR}/fisherhill COMPONENT Runtime)
  install(
    FILES ${PROJECT_SOURCE_DIR}/LICENSE ${PROJECT_SOURCE_DIR}/README.md
          ${PROJECT_SOURCE_DIR}/CHANGELOG.md ${PROJECT_SOURCE_DIR}/CITATION.cff
    DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/fisherhill COMPONENT Runtime)
endfunction()
