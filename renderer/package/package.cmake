# The Debian packages: `cpack -G DEB` in the build folder, or its target "package". afterglow is program, library, headers,
# image module, Blender add-on, man pages and examples; what it depends on is found in the files themselves
# (dpkg-shlibdeps). python3-afterglow is the Python module.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME afterglow)
set(CPACK_PACKAGE_VENDOR Afterglow)
set(CPACK_PROJECT_CONFIG_FILE ${CMAKE_CURRENT_LIST_DIR}/package_maintainer.cmake)
set(CPACK_PACKAGE_VERSION ${PROJECT_VERSION})
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_ALL afterglow python)
set(CPACK_COMPONENTS_GROUPING IGNORE) # each is a package
set(CPACK_COMPONENT_AFTERGLOW_DESCRIPTION
"global illumination renderer with photon mapping and final gathering
Afterglow renders scenes in the pbrt-v4 text format, glTF, OBJ and what else
assimp reads. Light is traced into a photon map; irradiance at a photon is
computed the first time a gather ray asks for it. Pictures are the same, bit
for bit, for any number of threads.
.
This package holds the program, the library with its C headers, and examples.")
set(CPACK_COMPONENT_PYTHON_DESCRIPTION
"global illumination renderer - Python module
Afterglow renders with photon mapping and final gathering. The module makes
scenes from numpy arrays, or reads them from files, and gives pictures and
their layers as arrays, while they are rendered too.
.
This package holds the module for Python 3.")
set(CPACK_STRIP_FILES ON)
set(CPACK_VERBATIM_VARIABLES ON)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_PRE_BUILD_SCRIPTS ${CMAKE_CURRENT_LIST_DIR}/package_files.cmake)

set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT) # NAME_VERSION-1_ARCHITECTURE.deb
set(CPACK_DEBIAN_PACKAGE_RELEASE 1)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(control ${CMAKE_CURRENT_BINARY_DIR}/debian)

set(CPACK_DEBIAN_AFTERGLOW_PACKAGE_NAME afterglow)
set(CPACK_DEBIAN_AFTERGLOW_PACKAGE_SECTION graphics)
set(CPACK_DEBIAN_AFTERGLOW_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_AFTERGLOW_PACKAGE_SUGGESTS "python3-afterglow, python3-numpy") # numpy for the Blender add-on
# Who links against the library depends on this package; installing it renews the linker's cache (deb-triggers(5)).
get_target_property(soversion afterglow SOVERSION)
file(WRITE ${control}/shlibs "libafterglow ${soversion} afterglow (>= ${PROJECT_VERSION})\n")
file(WRITE ${control}/triggers "activate-noawait ldconfig\n")
set(CPACK_DEBIAN_AFTERGLOW_PACKAGE_CONTROL_EXTRA ${control}/shlibs ${control}/triggers)

# The module has the layouts of one version's structs.
set(CPACK_DEBIAN_PYTHON_PACKAGE_NAME python3-afterglow)
set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
set(CPACK_DEBIAN_PYTHON_PACKAGE_ARCHITECTURE all)
set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS
  "python3 (>= 3.9), python3-numpy, afterglow (= ${PROJECT_VERSION}-${CPACK_DEBIAN_PACKAGE_RELEASE})")
# Its bytecode is made when it is installed, and removed with it (Debian Python Policy, 2.6), where Debian's tools are there.
set(postinst_tool py3compile)
set(prerm_tool py3clean)
foreach(script postinst prerm)
  set(tool ${${script}_tool})
  file(WRITE ${control}/${script} "#!/bin/sh
set -e
if command -v ${tool} >/dev/null; then
    ${tool} -p python3-afterglow
fi
")
endforeach()
set(CPACK_DEBIAN_PYTHON_PACKAGE_CONTROL_EXTRA ${control}/postinst ${control}/prerm)
include(CPack)
