# What Debian wants other than `cmake --install` has it: man pages and long texts are compressed, changelogs have fixed names
# (Debian Policy 12.1, 12.7). CPack runs this on the folder that becomes the package.
find_program(AG_GZIP gzip REQUIRED)
find_program(AG_DATE date REQUIRED)
set(doc ${CPACK_TEMPORARY_INSTALL_DIRECTORY}/usr/share/doc/${CPACK_PACKAGE_NAME})
file(RENAME ${doc}/CHANGELOG.md ${doc}/changelog)

set(when now) # or, for packages that can be made again, the time that the environment names
if(NOT "$ENV{SOURCE_DATE_EPOCH}" STREQUAL "")
  set(when @$ENV{SOURCE_DATE_EPOCH})
endif()
execute_process(COMMAND ${CMAKE_COMMAND} -E env LC_ALL=C ${AG_DATE} -u -R -d ${when}
  OUTPUT_VARIABLE date OUTPUT_STRIP_TRAILING_WHITESPACE COMMAND_ERROR_IS_FATAL ANY)
file(WRITE ${doc}/changelog.Debian
"${CPACK_PACKAGE_NAME} (${CPACK_PACKAGE_VERSION}-${CPACK_DEBIAN_PACKAGE_RELEASE}) unstable; urgency=medium

  * Package of ${CPACK_PACKAGE_NAME} ${CPACK_PACKAGE_VERSION}; its own changes are in changelog.gz.

 -- ${CPACK_PACKAGE_CONTACT}  ${date}
")

file(GLOB_RECURSE files ${CPACK_TEMPORARY_INSTALL_DIRECTORY}/usr/share/man/*.1)
foreach(file ${files} ${doc}/changelog ${doc}/changelog.Debian)
  execute_process(COMMAND ${AG_GZIP} -9nf ${file} COMMAND_ERROR_IS_FATAL ANY)
endforeach()
