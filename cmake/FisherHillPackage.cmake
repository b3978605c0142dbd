# Debian packages by `cpack -G DEB` in a built tree: fisherhill (program, models, trials, man page),
# libfisherhill-dev, and python3-fisherhill where the module is built. Dependencies on libraries are what
# dpkg-shlibdeps finds in the binaries (docs/decisions/023-debian-packages.md).
set(FISHERHILL_PACKAGE_CONTACT "FisherHill authors <fisherhill@example.invalid>" CACHE STRING
  "Maintainer of the Debian packages")

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME fisherhill)
set(CPACK_PACKAGE_VENDOR FisherHill)
# CPack puts the summary above the description of every package.
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "simulate and identify how muscles move limbs")
set(CPACK_PACKAGE_CONTACT ${FISHERHILL_PACKAGE_CONTACT})
set(CPACK_PACKAGE_VERSION ${PROJECT_VERSION})
set(CPACK_PACKAGE_DIRECTORY ${PROJECT_BINARY_DIR}/packages)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_RESOURCE_FILE_LICENSE ${PROJECT_SOURCE_DIR}/LICENSE)
set(CPACK_COMPONENTS_ALL Runtime Development)
set(fisherhill_packages fisherhill:Runtime libfisherhill-dev:Development)
if(TARGET fisherhill_python)
  list(APPEND CPACK_COMPONENTS_ALL Python)
  list(APPEND fisherhill_packages python3-fisherhill:Python)
endif()

set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_DEBIAN_ENABLE_COMPONENT_DEPENDS OFF)

set(CPACK_DEBIAN_RUNTIME_PACKAGE_NAME fisherhill)
set(CPACK_DEBIAN_RUNTIME_PACKAGE_SECTION science)
set(CPACK_DEBIAN_RUNTIME_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_RUNTIME_PACKAGE_RECOMMENDS "xvfb, libgl1-mesa-dri, fonts-dejavu-core")
set(CPACK_DEBIAN_RUNTIME_PACKAGE_SUGGESTS "ffmpeg, librsvg2-bin, libfisherhill-dev")
set(CPACK_COMPONENT_RUNTIME_DESCRIPTION
"FisherHill reads a musculoskeletal model (OpenSim's .osim) and recorded muscle
excitations, predicts how the limb moves, says what the measured motion tells
about the model's parameters, estimates them, and finds and names the effect
that the model lacks. It ships a model of the elbow with eight muscles and
synthetic trials to try.")

set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME libfisherhill-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS
  "libeigen3-dev (>= 3.4), libsundials-dev (>= 6.4), libtbb-dev, libfmt-dev, libtinyxml2-dev")
set(CPACK_COMPONENT_DEVELOPMENT_DESCRIPTION
"Static C++20 libraries, headers and a CMake package config. FisherHill::info
holds parameter sensitivities, Fisher information, bounds and estimation for
any system; FisherHill::bio reads, simulates and calibrates models of limbs.")

set(CPACK_DEBIAN_PYTHON_PACKAGE_NAME python3-fisherhill)
set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
set(CPACK_DEBIAN_PYTHON_PACKAGE_SHLIBDEPS ON)
# The module is one Python's own, by the name of its file; NumPy is found when it is imported.
set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS "${FISHERHILL_PYTHON_DEPENDS}, python3-numpy")
set(CPACK_DEBIAN_PYTHON_PACKAGE_SUGGESTS "fisherhill, python3-matplotlib, python3-pandas")
# They compile the package's Python files, and remove what was compiled.
set(CPACK_DEBIAN_PYTHON_PACKAGE_CONTROL_EXTRA
  ${PROJECT_SOURCE_DIR}/packaging/python/postinst ${PROJECT_SOURCE_DIR}/packaging/python/prerm)
set(CPACK_COMPONENT_PYTHON_DESCRIPTION
"The Python module: replays, sensitivities, calibration and discovery with
musculoskeletal models, and Fisher information, bounds and estimation for
systems defined in Python, with NumPy arrays.")

# What Debian calls the changelog of the package; what has changed is told by CHANGELOG.md beside it.
configure_file(${PROJECT_SOURCE_DIR}/packaging/changelog.in ${PROJECT_BINARY_DIR}/changelog @ONLY)
execute_process(COMMAND gzip -9nf ${PROJECT_BINARY_DIR}/changelog COMMAND_ERROR_IS_FATAL ANY)
foreach(package IN LISTS fisherhill_packages)
  string(REPLACE ":" ";" package ${package})
  list(GET package 0 name)
  list(GET package 1 component)
  install(FILES ${PROJECT_BINARY_DIR}/changelog.gz ${PROJECT_SOURCE_DIR}/packaging/copyright
    DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/${name} COMPONENT ${component})
endforeach()

# what is packed needs none of the validation programs
set(CMAKE_SKIP_PACKAGE_ALL_DEPENDENCY ON)

include(CPack)
