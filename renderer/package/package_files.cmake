# What Debian wants other than `cmake --install` has it: man pages and long texts are compressed. CPack runs this on the
# folder that becomes the package.
find_program(AG_GZIP gzip REQUIRED)
file(GLOB_RECURSE files
  ${CPACK_TEMPORARY_INSTALL_DIRECTORY}/*.1 ${CPACK_TEMPORARY_INSTALL_DIRECTORY}/*CHANGELOG.md)
foreach(file ${files})
  execute_process(COMMAND ${AG_GZIP} -9nf ${file} COMMAND_ERROR_IS_FATAL ANY)
endforeach()
