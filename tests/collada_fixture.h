/* collada_fixture.h: a Collada file with all that assimp delivers: meshes in a tree of nodes, materials, a camera,
 * lights. Threads: one at a time. */
#ifndef AFTERGLOW_TESTS_COLLADA_FIXTURE_H
#define AFTERGLOW_TESTS_COLLADA_FIXTURE_H

/* The arguments: what stands beside meter in the asset; the lights' library; nodes in the scene. */
#define COLLADA(asset, lights, nodes)                                                                                  \
    "<?xml version=\"1.0\" encoding=\"utf-8\"?>\n"                                                                     \
    "<COLLADA xmlns=\"http://www.collada.org/2005/11/COLLADASchema\" version=\"1.4.1\">\n"                             \
    "<asset><created>2020-01-01T00:00:00</created><modified>2020-01-01T00:00:00</modified>" asset "</asset>\n"         \
    "<library_cameras><camera id=\"cam\" name=\"cam\"><optics><technique_common><perspective><xfov>40</xfov>"          \
    "<aspect_ratio>2</aspect_ratio><znear>0.1</znear><zfar>100</zfar></perspective></technique_common></optics></"     \
    "camera>"                                                                                                          \
    "</library_cameras>\n"                                                                                             \
    "<library_lights>" lights "</library_lights>\n"                                                                    \
    "<library_effects><effect id=\"fx\"><profile_COMMON><technique sid=\"common\"><lambert><diffuse>"                  \
    "<color>0.5 0.25 0.75 1</color></diffuse></lambert></technique></profile_COMMON></effect></library_effects>\n"     \
    "<library_materials><material id=\"mat\" name=\"mat\"><instance_effect "                                           \
    "url=\"#fx\"/></material></library_materials>\n"                                                                   \
    "<library_geometries><geometry id=\"geo\" name=\"geo\"><mesh>"                                                     \
    "<source id=\"pos\"><float_array id=\"posa\" count=\"12\">-9 0 9  9 0 9  9 0 -9  -9 0 -9</float_array>"            \
    "<technique_common><accessor source=\"#posa\" count=\"4\" stride=\"3\"><param name=\"X\" type=\"float\"/>"         \
    "<param name=\"Y\" type=\"float\"/><param name=\"Z\" type=\"float\"/></accessor></technique_common></source>"      \
    "<vertices id=\"ver\"><input semantic=\"POSITION\" source=\"#pos\"/></vertices>"                                   \
    "<polylist material=\"mat\" count=\"1\"><input semantic=\"VERTEX\" source=\"#ver\" offset=\"0\"/>"                 \
    "<vcount>4</vcount><p>0 1 2 3</p></polylist></mesh></geometry></library_geometries>\n"                             \
    "<library_visual_scenes><visual_scene id=\"Scene\" name=\"Scene\">" nodes                                          \
    "</visual_scene></library_visual_scenes>\n"                                                                        \
    "<scene><instance_visual_scene url=\"#Scene\"/></scene></COLLADA>\n"

#define COLLADA_MESH                                                                                                   \
    "<instance_geometry url=\"#geo\"><bind_material><technique_common><instance_material symbol=\"mat\" "              \
    "target=\"#mat\"/>"                                                                                                \
    "</technique_common></bind_material></instance_geometry>"
#define COLLADA_FLOOR "<node id=\"floor\" name=\"floor\">" COLLADA_MESH "</node>"

#endif
