# The image and colour bridges; included by CMakeLists.txt after add_library(ag_scene).

# config.ocio becomes C, so that the program needs no file beside it.
set(color_config_source ${CMAKE_CURRENT_BINARY_DIR}/color_builtin_config.c)
add_custom_command(
  OUTPUT ${color_config_source}
  COMMAND ${CMAKE_COMMAND} -D INPUT=${CMAKE_CURRENT_SOURCE_DIR}/config.ocio -D OUTPUT=${color_config_source}
          -D SYMBOL=color_builtin_config -D HEADER=color_builtin_config.h
          -P ${CMAKE_CURRENT_SOURCE_DIR}/embed_file.cmake
  DEPENDS config.ocio embed_file.cmake
  COMMENT "Turning config.ocio into C"
  VERBATIM)
target_sources(ag_scene PRIVATE ${color_config_source})

# OpenImageIO brings 261 libraries: in a module of its own, which is opened when the first picture is read
# or written.
add_library(afterglow_image MODULE image_oiio.cpp)
target_include_directories(afterglow_image PRIVATE ${CMAKE_CURRENT_SOURCE_DIR} ${PROJECT_SOURCE_DIR}/threads/include)
target_link_libraries(afterglow_image PRIVATE PkgConfig::OIIO PkgConfig::IMATH)
set_target_properties(afterglow_image PROPERTIES PREFIX "" LIBRARY_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/lib/afterglow)
install(TARGETS afterglow_image LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}/afterglow)

# Whoever builds the scene builds the module too.
add_dependencies(ag_scene afterglow_image)
set_property(SOURCE image_module_loader.c APPEND PROPERTY
             COMPILE_DEFINITIONS AG_MODULE_INSTALL_DIR="${CMAKE_INSTALL_FULL_LIBDIR}/afterglow")
# The loader guards the floating-point mode (libm) and opens on a thread of its own.
target_link_libraries(ag_scene PRIVATE ${CMAKE_DL_LIBS} Threads::Threads m)
