# includes.cmake: an include that a target may not make stops the build. Include directories alone cannot do that: the
# folders of ag_image, ag_scene and ag_readers share a root, and a file finds what lies below its own folder.
#
# ag_check_includes(TARGET [FOLDER...]): the sources of TARGET, and the headers beside them, include what lies in the
# target's own folders (those of its sources, and each FOLDER that holds headers alone) and in those of the targets that
# it links, as far as these pass them on. Both forms count, in quotes and in angle brackets. To be called after
# target_link_libraries.
#
# Within a target, the edges of `cut` below are forbidden as well: FOLDER OR FILE -> HEADER, as regular expressions.
if(NOT CMAKE_SCRIPT_MODE_FILE)
  set(AG_INCLUDES_SCRIPT ${CMAKE_CURRENT_LIST_FILE})

  function(ag_check_includes target)
    get_target_property(sources ${target} SOURCES)
    set(folders)
    set(files)
    foreach(source ${sources})
      if(NOT source MATCHES "^\\$<")
        cmake_path(ABSOLUTE_PATH source BASE_DIRECTORY ${CMAKE_CURRENT_SOURCE_DIR} NORMALIZE)
        cmake_path(IS_PREFIX PROJECT_SOURCE_DIR ${source} is_ours)
        cmake_path(IS_PREFIX PROJECT_BINARY_DIR ${source} is_made)
        if(is_ours AND NOT is_made)
          list(APPEND files ${source})
          cmake_path(GET source PARENT_PATH folder)
          list(APPEND folders ${folder})
        endif()
      endif()
    endforeach()
    foreach(folder ${ARGN})
      cmake_path(ABSOLUTE_PATH folder BASE_DIRECTORY ${CMAKE_CURRENT_SOURCE_DIR} NORMALIZE)
      list(APPEND folders ${folder})
    endforeach()
    list(REMOVE_DUPLICATES folders)
    foreach(folder ${folders})
      # No list: a header that one forgets would not be checked.
      file(GLOB headers CONFIGURE_DEPENDS ${folder}/*.h)
      list(APPEND files ${headers})
    endforeach()

    # What is linked PRIVATE may be included here, and is not passed on.
    set(allowed ${folders})
    set(passed_on ${folders})
    foreach(kind LINK_LIBRARIES INTERFACE_LINK_LIBRARIES)
      get_target_property(libraries ${target} ${kind})
      foreach(library ${libraries})
        if(TARGET ${library})
          get_target_property(theirs ${library} AG_FOLDERS)
          if(theirs AND kind STREQUAL LINK_LIBRARIES)
            list(APPEND allowed ${theirs})
          elseif(theirs)
            list(APPEND passed_on ${theirs})
          endif()
        endif()
      endforeach()
    endforeach()
    set_target_properties(${target} PROPERTIES AG_FOLDERS "${passed_on}")

    set(stamp ${CMAKE_CURRENT_BINARY_DIR}/${target}.includes)
    file(WRITE ${stamp}.files "${files}")
    file(WRITE ${stamp}.folders "${allowed}")
    add_custom_command(
      OUTPUT ${stamp}
      COMMAND ${CMAKE_COMMAND} -D TARGET=${target} -D STAMP=${stamp} -D ROOT=${PROJECT_SOURCE_DIR} -P ${AG_INCLUDES_SCRIPT}
      DEPENDS ${files} ${AG_INCLUDES_SCRIPT} ${stamp}.files ${stamp}.folders
      COMMENT "Checking the includes of ${target}"
      VERBATIM)
    target_sources(${target} PRIVATE ${stamp})
  endfunction()

  return()
endif()

cmake_minimum_required(VERSION 3.25)
file(READ ${STAMP}.files files)
file(READ ${STAMP}.folders allowed)
set(roots threads threads/include scene scene/readers photonmap renderer renderer/include tests perf)
list(TRANSFORM roots PREPEND ${ROOT}/)
# In ag_image each folder knows those before it: math and text, color, image. Surfaces and textures know points
# (surface.h) and rays (ray.h), not the tree nor how rays are cast; textures are a set of their own (texture_set.h), which
# knows no scene, and media know numbers alone. Materials know nothing of lights, nor the other way round, and of media
# the phase functions; lights cast rays, but know no tree; what casts rays knows no lights. Photons know of no cameras,
# tiles or hints for a picture. A format's reader knows no other's, but that meshes of pbrt may be PLY files. What finds
# the light knows nothing of pictures' files, which stand above a rendering, and nothing of a rendering, but for
# photon_map_integrator.c, which has the maps made. The programs take name_hash.h, status.h and utf8.h from threads, which
# need no more of the library than its public headers.
set(cut
  "^scene/(shape|texture|material|image|color|text|math)/.*->scene/rays/(bvh|bvh_embree|rays|transmittance|embree_api)\\.h$"
  "^scene/(image|color|text|math)/.*->scene/(scene|surface|shape/.*|material/.*|light/.*|texture/.*)\\.h$"
  "^scene/(math|text)/.*->scene/(color|image)/"
  "^scene/math/.*->scene/text/"
  "^scene/color/.*->scene/image/"
  "^scene/texture/.*->scene/((shape|material|medium|light|rays)/|scene\\.h$|scene_.*\\.h$|camera\\.h$)"
  "^scene/shape/.*->scene/(material|medium|light)/"
  "^scene/medium/.*->scene/((color|image|text|texture|shape|rays|material|light)/|[a-z_]+\\.h$)"
  "^scene/material/.*->scene/(light/|medium/([^p]|p[^h]))"
  "^scene/light/.*->scene/(material|medium)/"
  "^scene/light/.*->scene/rays/(bvh|bvh_embree|clear_space|embree_api|geometry_embree|ray_cone|slab_faces)\\.h$"
  "^scene/light/environment\\.[ch]->scene/light/portal\\.h$"
  "^renderer/film/(film|sample_split)\\.[ch]->renderer/film/splitting\\.h$"
  "^scene/rays/.*->scene/(light|texture)/"
  "^(scene/[a-z_]+\\.|photonmap/|renderer/).*->scene/rays/(bvh_embree|embree_api|geometry_embree)\\.h$"
  "^photonmap/.*->(scene/(camera|scene_hints|scene_request)|threads/tile_scheduler)\\.h$"
  "^scene/readers/gltf/.*->scene/readers/(pbrt|model)/"
  "^scene/readers/model/.*->scene/readers/(pbrt|gltf)/"
  "^scene/readers/pbrt/.*->scene/readers/(gltf/|model/([^p]|p[^l]|pl[^y]|ply_[^f]))"
  "^renderer/film/.*->renderer/(integrator|output|cli)/"
  "^renderer/integrator/([^p]|p[^h]).*->renderer/[a-z_]+\\.h$"
  "^renderer/integrator/.*->renderer/(output|cli)/"
  "^renderer/([a-z_]+\\.|making/).*->renderer/(output|cli)/"
  "^renderer/output/.*->renderer/cli/"
  "^renderer/cli/.*->threads/([a-hj-mo-rtv-z]|i[^n]|n[^a]|s[^t]|st[^a]|u[^t])"
  "^scene/(surface|rays/ray|rays/rays)\\.h->scene/scene\\.h$"
  "^scene/shape/[a-z_]+\\.h->scene/scene\\.h$"
  "^scene/scene\\.h->scene/rays/(bvh|rays|transmittance)\\.h$")
set(is_wrong FALSE)
foreach(file ${files})
  cmake_path(GET file PARENT_PATH own_folder)
  file(STRINGS ${file} lines REGEX "^[ \t]*#[ \t]*(include|import)")
  string(REGEX REPLACE "[][]" "" lines "${lines}") # in a list, brackets would join lines
  foreach(line ${lines})
    if(NOT line MATCHES "^[ \t]*#[ \t]*[a-z_]+[ \t]*([\"<])([^\">]*)[\">]")
      cmake_path(RELATIVE_PATH file BASE_DIRECTORY ${ROOT} OUTPUT_VARIABLE from)
      message(SEND_ERROR "${from}: an include by a macro, which cannot be checked: ${line}")
      set(is_wrong TRUE)
      continue()
    endif()
    set(name ${CMAKE_MATCH_2})
    set(searched ${roots})
    if(CMAKE_MATCH_1 STREQUAL "\"")
      list(PREPEND searched ${own_folder})
    endif()
    foreach(root ${searched})
      cmake_path(SET header NORMALIZE "${root}/${name}")
      if(EXISTS ${header})
        cmake_path(GET header PARENT_PATH folder)
        cmake_path(RELATIVE_PATH file BASE_DIRECTORY ${ROOT} OUTPUT_VARIABLE from)
        cmake_path(RELATIVE_PATH header BASE_DIRECTORY ${ROOT} OUTPUT_VARIABLE to)
        if(NOT folder IN_LIST allowed)
          message(SEND_ERROR "${from} includes ${to}, which is not below ${TARGET}")
          set(is_wrong TRUE)
        endif()
        foreach(edge ${cut})
          if("${from}->${to}" MATCHES "${edge}")
            message(SEND_ERROR "${from} includes ${to}: that edge is cut, see tests/includes.cmake")
            set(is_wrong TRUE)
          endif()
        endforeach()
        break()
      endif()
    endforeach()
  endforeach()
endforeach()
if(NOT is_wrong)
  file(WRITE ${STAMP} "")
endif()
