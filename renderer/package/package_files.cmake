# What Debian wants other than `cmake --install` has it: man pages and long texts are compressed, changelogs have fixed names,
# each package has a copyright (Debian Policy 12.1, 12.5, 12.7). CPack runs this on the folders that become the packages.
find_program(AG_GZIP gzip REQUIRED)
find_program(AG_DATE date REQUIRED)
set(doc ${CPACK_TEMPORARY_INSTALL_DIRECTORY}/afterglow/usr/share/doc/afterglow)
set(python_doc ${CPACK_TEMPORARY_INSTALL_DIRECTORY}/python/usr/share/doc/python3-afterglow)
file(RENAME ${doc}/CHANGELOG.md ${doc}/changelog)
file(COPY ${doc}/copyright ${doc}/changelog DESTINATION ${python_doc})

set(when now) # or, for packages that can be made again, the time that the environment names
if(NOT "$ENV{SOURCE_DATE_EPOCH}" STREQUAL "")
  set(when @$ENV{SOURCE_DATE_EPOCH})
endif()
execute_process(COMMAND ${CMAKE_COMMAND} -E env LC_ALL=C ${AG_DATE} -u -R -d ${when}
  OUTPUT_VARIABLE date OUTPUT_STRIP_TRAILING_WHITESPACE COMMAND_ERROR_IS_FATAL ANY)
foreach(folder ${doc} ${python_doc})
  get_filename_component(package ${folder} NAME)
  file(WRITE ${folder}/changelog.Debian
"${package} (${CPACK_PACKAGE_VERSION}-${CPACK_DEBIAN_PACKAGE_RELEASE}) unstable; urgency=medium

  * Package of ${CPACK_PACKAGE_NAME} ${CPACK_PACKAGE_VERSION}; its own changes are in changelog.gz.

 -- ${CPACK_PACKAGE_CONTACT}  ${date}
")
  list(APPEND files ${folder}/changelog ${folder}/changelog.Debian)
endforeach()

file(GLOB_RECURSE manuals ${CPACK_TEMPORARY_INSTALL_DIRECTORY}/afterglow/usr/share/man/*.1)
foreach(file ${manuals} ${files})
  execute_process(COMMAND ${AG_GZIP} -9nf ${file} COMMAND_ERROR_IS_FATAL ANY)
endforeach()
