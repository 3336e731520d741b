# The Debian package: `cpack -G DEB` in the build folder, or its target "package". Program, library, headers, module, man
# page, examples in one; what it depends on is found in the files themselves (dpkg-shlibdeps).
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME afterglow)
set(CPACK_PACKAGE_VENDOR Afterglow)
set(CPACK_PROJECT_CONFIG_FILE ${CMAKE_CURRENT_LIST_DIR}/package_maintainer.cmake)
set(CPACK_PACKAGE_VERSION ${PROJECT_VERSION})
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "global illumination renderer with photon mapping and final gathering")
set(CPACK_PACKAGE_DESCRIPTION
  "Afterglow renders scenes in the pbrt-v4 text format, glTF, OBJ and what else
assimp reads. Light is traced into a photon map; irradiance at a photon is
computed the first time a gather ray asks for it. Pictures are the same, bit
for bit, for any number of threads.
.
This package holds the program, the library with its C headers, and examples.")
set(CPACK_STRIP_FILES ON)
set(CPACK_VERBATIM_VARIABLES ON)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_PRE_BUILD_SCRIPTS ${CMAKE_CURRENT_LIST_DIR}/package_files.cmake)

set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT) # afterglow_VERSION-1_ARCHITECTURE.deb
set(CPACK_DEBIAN_PACKAGE_RELEASE 1)
set(CPACK_DEBIAN_PACKAGE_SECTION graphics)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_SUGGESTS "python3-numpy") # for the Python module
# Who links against the library depends on this package; installing it renews the linker's cache (deb-triggers(5)).
set(control ${CMAKE_CURRENT_BINARY_DIR}/debian)
get_target_property(soversion afterglow SOVERSION)
file(WRITE ${control}/shlibs "libafterglow ${soversion} afterglow (>= ${PROJECT_VERSION})\n")
file(WRITE ${control}/triggers "activate-noawait ldconfig\n")
set(CPACK_DEBIAN_PACKAGE_CONTROL_EXTRA ${control}/shlibs ${control}/triggers)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
include(CPack)
