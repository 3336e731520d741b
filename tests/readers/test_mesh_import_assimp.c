/* test_mesh_import_assimp.c: what assimp reads arrives: meshes at their nodes, materials, cameras, lights, up axes;
 * files that assimp refuses, or that it dies of, are errors. */
#define _POSIX_C_SOURCE 200809L
#include "fixtures/collada_fixture.h"
#include "fixtures/model_fixture.h"
#include "model/import_file.h"

static const double PI_D = 3.14159265358979323846;

#define FACET(a, b, c) "facet normal 0 0 0\nouter loop\nvertex " a "\nvertex " b "\nvertex " c "\nendloop\nendfacet\n"

static void extensions(void **state)
{
    (void)state;
    static const char *const READS[] = {".stl", ".dae", ".fbx", ".3ds", ".OFF", ".x"}, *const NOT[] = {".pbrt", ".txt",
                                                                                                       ".exr", "."};
    bool reads;
    run_context run;
    run_context_init(&run, NULL, NULL, NULL, NULL);
    for (int k = 0; k < 10; k++) {
        assert_int_equal(import_reads_extension(&run, k < 6 ? READS[k] : NOT[k - 6], &reads), AG_OK);
        assert_true(reads == (k < 6));
    }
    run_context_reset(&run);
}

/* z is up in STL; it is turned to y. */
static void stl_in_both_forms(void **state)
{
    (void)state;
    reading r = model_quietly("a.stl", "solid a\n" FACET("0 0 0", "1 0 0", "0 1 0")
                                           FACET("0 0 0", "0 1 0", "0 0 1") "endsolid a\n");
    assert_int_equal(r.scene->shape_count, 1);
    const mesh *m = model_mesh(&r, 0);
    assert_int_equal(m->triangle_count, 2);
    assert_vec3(m->positions[m->indices[1]], 1, 0, 0, 0);
    assert_vec3(m->positions[m->indices[2]], 0, 0, -1, 0);
    assert_vec3(m->positions[m->indices[5]], 0, 1, 0, 0);
    assert_true(r.scene->has_camera);
    assert_int_equal(r.scene->light_count, 2);
    reading_destroy(&r);

    unsigned char bytes[84 + 50] = {0};
    const float corners[12] = {0, 0, 1, 0, 0, 0, 2, 0, 0, 0, 0, 3};
    bytes[80] = 1;
    memcpy(bytes + 84, corners, sizeof corners);
    r = model_read(model_write("b.stl", bytes, sizeof bytes));
    assert_int_equal(r.status, AG_OK);
    assert_int_equal(model_mesh(&r, 0)->triangle_count, 1);
    assert_vec3(model_mesh(&r, 0)->positions[model_mesh(&r, 0)->indices[2]], 0, 3, 0, 0);
    reading_destroy(&r);
}

/* A mesh at two nodes, one of them mirrored, is placed twice; its quad becomes two triangles. */
static void nodes_place_meshes(void **state)
{
    (void)state;
    reading r = model_quietly(
        "a.dae", COLLADA("<up_axis>Y_UP</up_axis>", "",
                         "<node id=\"a\"><translate>1 2 3</translate><node id=\"b\"><scale>2 2 -2</scale>" COLLADA_MESH
                         "</node></node>" COLLADA_FLOOR));
    assert_int_equal(r.scene->shape_count, 2);
    assert_int_equal(model_mesh(&r, 0)->triangle_count, 2);
    bool is_mirrored_first = r.scene->shapes[0].flip_normal;
    const mesh *mirrored = model_mesh(&r, is_mirrored_first ? 0 : 1),
               *floor = model_mesh(&r, is_mirrored_first ? 1 : 0);
    assert_true(r.scene->shapes[0].flip_normal != r.scene->shapes[1].flip_normal);
    assert_vec3(floor->positions[floor->indices[0]], -9, 0, 9, 0);
    assert_vec3(mirrored->positions[mirrored->indices[0]], 1 - 18, 2, 3 - 18, 1e-5);
    assert_int_equal(model_material(&r, 0)->kind, MATERIAL_DIFFUSE);
    assert_rgb(model_material(&r, 0)->reflectance, .5, .25, .75, 1e-6);
    assert_int_equal(r.scene->shapes[0].material_index, r.scene->shapes[1].material_index);
    reading_destroy(&r);
    r = model_of("a.dae",
                 COLLADA("<up_axis>Y_UP</up_axis>", "",
                         "<node id=\"b\" name=\"b\"><scale>1 0 1</scale>" COLLADA_MESH "</node>" COLLADA_FLOOR));
    if (r.status)
        fail_msg("%s", r.said[AG_LOG_ERROR]);
    assert_int_equal(r.scene->shape_count, 1);
    model_said(&r, AG_LOG_WARNING, "a.dae", ": warning: mesh \"geo\" is scaled to nothing and is left out\n");
    reading_destroy(&r);
}

static void the_up_axis_is_turned(void **state)
{
    (void)state;
    reading r = model_quietly("a.dae", COLLADA("<up_axis>Z_UP</up_axis>", "", COLLADA_FLOOR));
    const mesh *m = model_mesh(&r, 0);
    assert_vec3(m->positions[m->indices[0]], -9, 9, 0, 1e-5); /* z 9 is up now */
    reading_destroy(&r);
}

#define CAMERA(transform) "<node id=\"camn\" name=\"camn\">" transform "<instance_camera url=\"#cam\"/></node>"

/* The camera looks along its node's -z. Its field of view is 40 degrees across at 2:1; the test expects that of its
 * height. */
static void cameras_look_where_the_file_says(void **state)
{
    (void)state;
    reading r =
        model_quietly("a.dae", COLLADA("<up_axis>Y_UP</up_axis>", "",
                                       COLLADA_FLOOR CAMERA("<translate>0 5 1</translate><rotate>1 0 0 -90</rotate>")));
    const camera *c = &r.scene->camera;
    assert_vec3(transform_point(&c->world_from_camera, vec3_make(0, 0, 0)), 0, 5, 1, 1e-5);
    assert_vec3(transform_vector(&c->world_from_camera, vec3_make(0, 0, 1)), 0, -1, 0, 1e-6); /* forward is down */
    assert_vec3(transform_vector(&c->world_from_camera, vec3_make(0, 1, 0)), 0, 0, -1, 1e-6);
    assert_vec3(transform_vector(&c->world_from_camera, vec3_make(1, 0, 0)), 1, 0, 0, 1e-6); /* not mirrored */
    assert_near(c->fov_degrees, 2.0 * atan(tan(20.0 * PI_D / 180.0) / 2.0) * 180.0 / PI_D, 1e-4);
    assert_null(r.said[AG_LOG_INFO] ? strstr(r.said[AG_LOG_INFO], "no camera") : NULL);
    reading_destroy(&r);
}

#define LIGHT(kind, words)                                                                                             \
    "<light id=\"lam\" name=\"lam\"><technique_common><" kind "><color>1 0.5 0.25</color>" words "</" kind             \
    "></technique_common></light>"
#define LAMP(transform) "<node id=\"lamn\" name=\"lamn\">" transform "<instance_light url=\"#lam\"/></node>"

static reading lit(const char *lights, const char *placement)
{
    char text[8192];
    snprintf(text, sizeof text, COLLADA("<up_axis>Y_UP</up_axis>", "%s", "%s"), lights, placement);
    return model_quietly("a.dae", text);
}

static void lights_are_as_bright_as_the_file_says(void **state)
{
    (void)state;
    reading r =
        lit(LIGHT("point", "<constant_attenuation>0</constant_attenuation><linear_attenuation>0</linear_attenuation>"
                           "<quadratic_attenuation>0.25</quadratic_attenuation>"),
            COLLADA_FLOOR LAMP("<translate>1 2 3</translate>"));
    assert_int_equal(r.scene->light_count, 1);
    const light *l = &r.scene->lights[0];
    assert_int_equal(l->kind, LIGHT_POINT);
    assert_vec3(l->as.point.position, 1, 2, 3, 0);
    assert_rgb(l->as.point.intensity, 4 * PI_D, 2 * PI_D, PI_D, 1e-5);
    reading_destroy(&r);

    /* without falloff: as at the distance of the scene's centre, 4 */
    r = lit(LIGHT("point", "<constant_attenuation>1</constant_attenuation>"),
            COLLADA_FLOOR LAMP("<translate>0 4 0</translate>"));
    assert_near(r.scene->lights[0].as.point.intensity.r, 16 * PI_D, 1e-4);
    reading_destroy(&r);

    r = lit(LIGHT("directional", ""), COLLADA_FLOOR LAMP("<rotate>1 0 0 -90</rotate>"));
    l = &r.scene->lights[0];
    assert_int_equal(l->kind, LIGHT_DISTANT);
    assert_vec3(l->as.distant.direction, 0, -1, 0, 1e-6);
    assert_rgb(l->as.distant.irradiance, PI_D, PI_D / 2, PI_D / 4, 1e-5);
    reading_destroy(&r);

    r = lit(LIGHT("ambient", ""), COLLADA_FLOOR LAMP(""));
    l = &r.scene->lights[0];
    assert_int_equal(l->kind, LIGHT_INFINITE);
    assert_rgb(l->as.infinite.radiance.value, 1, .5, .25, 1e-6);
    reading_destroy(&r);

    r = lit(LIGHT("spot", "<quadratic_attenuation>1</quadratic_attenuation><falloff_angle>60</falloff_angle>"),
            COLLADA_FLOOR LAMP("<translate>0 4 0</translate><rotate>1 0 0 -90</rotate>"));
    l = &r.scene->lights[0];
    assert_int_equal(l->kind, LIGHT_SPOT);
    assert_vec3(l->as.spot.direction, 0, -1, 0, 1e-6);
    assert_near(l->as.spot.falloff_start, 1 - cos(30.0 * PI_D / 180.0), 1e-6);
    assert_true(l->as.spot.falloff_end >= l->as.spot.falloff_start);
    assert_near(l->as.spot.intensity.r, PI_D, 1e-5);
    reading_destroy(&r);
}

/* Collada by Blender: colours are W or W/m^2, and <extra> says what is an area and how a spot ends. */
static reading blenders_of_unit(const char *unit, const char *kind, const char *words, const char *extra)
{
    char text[8192];
    snprintf(
        text, sizeof text,
        COLLADA(
            "<contributor><authoring_tool>Blender 3.4.1</authoring_tool></contributor>\n%s\n<up_axis>Y_UP</up_axis>",
            "\n<light id=\"lam-light\" name=\"lam\">\n<technique_common><%s><color>50 25 0"
            "</color>%s</%s></technique_common>\n<extra><technique profile=\"blender\">\n%s"
            "</technique></extra></light>\n",
            COLLADA_FLOOR "\n<node id=\"lamn\" name=\"lamn\">\n<translate>1 2 3</translate>"
                          "<instance_light url=\"#lam-light\"/></node>\n"),
        unit, kind, words, kind, extra);
    return model_quietly("a.dae", text);
}

static reading blenders(const char *kind, const char *words, const char *extra)
{
    return blenders_of_unit("", kind, words, extra);
}

/* A scene in centimetres is read in metres; its light looks the same. */
static void lamps_of_blenders_heed_the_unit(void **state)
{
    (void)state;
    reading r = blenders_of_unit("<unit name=\"centimeter\" meter=\"0.01\"/>", "point",
                                 "<quadratic_attenuation>0.0016</quadratic_attenuation>",
                                 "<type sid=\"type\" type=\"int\">0</type>\n");
    assert_near(r.scene->lights[0].as.point.position.z, 0.03, 1e-6);
    assert_rgb(r.scene->lights[0].as.point.intensity, 50e-4 / (4 * PI_D), 25e-4 / (4 * PI_D), 0, 1e-8);
    reading_destroy(&r);
}

static void lamps_of_blenders_are_in_watts(void **state)
{
    (void)state;
    reading r = blenders("point", "<quadratic_attenuation>0.0016</quadratic_attenuation>",
                         "<type sid=\"type\" type=\"int\">0</type>\n");
    assert_rgb(r.scene->lights[0].as.point.intensity, 50 / (4 * PI_D), 25 / (4 * PI_D), 0, 1e-5);
    reading_destroy(&r);

    r = blenders("directional", "", "<type sid=\"type\" type=\"int\">1</type>\n");
    assert_rgb(r.scene->lights[0].as.distant.irradiance, 50, 25, 0, 1e-5);
    reading_destroy(&r);

    r = blenders("spot", "<falloff_angle>90</falloff_angle><falloff_exponent>0.25</falloff_exponent>",
                 "<type sid=\"type\" type=\"int\">2</type>\n<spotblend sid=\"spotblend\" type=\"float\">0.25"
                 "</spotblend>\n");
    const light *l = &r.scene->lights[0];
    assert_int_equal(l->kind, LIGHT_SPOT);
    assert_rgb(l->as.spot.intensity, 50 / (4 * PI_D), 25 / (4 * PI_D), 0, 1e-5);
    assert_near(l->as.spot.falloff_end, 1 - sqrt(0.5), 1e-5);
    assert_near(l->as.spot.falloff_start, 0.75 * (1 - sqrt(0.5)), 1e-5);
    assert_true(l->as.spot.dims_by_cosine);
    reading_destroy(&r);

    /* 2 m by 0.5 m: a quarter of the W is what radiance times area is; it is not seen itself */
    r = blenders("point", "",
                 "<type sid=\"type\" type=\"int\">4</type>\n<area_shape sid=\"a\" type=\"int\">1"
                 "</area_shape>\n<area_size sid=\"a\" type=\"float\">2</area_size>\n"
                 "<area_sizey sid=\"a\" type=\"float\">0.5</area_sizey>\n");
    l = &r.scene->lights[0];
    assert_int_equal(l->kind, LIGHT_AREA);
    assert_rgb(l->as.area.radiance, 12.5, 6.25, 0, 1e-4);
    const shape *s = &r.scene->shapes[l->as.area.shape_index];
    assert_near(shape_area(s), 1.0, 1e-5);
    assert_near(s->alpha, 0, 0);
    reading_destroy(&r);
}

/* Reads the fixture's file with this author, and with these elements behind the surface's colour. */
static reading surface_by(const char *author, const char *words)
{
    char text[8192], authored[8192];
    snprintf(authored, sizeof authored,
             COLLADA("<contributor><authoring_tool>%s</authoring_tool></contributor><up_axis>Y_UP</up_axis>", "",
                     COLLADA_FLOOR),
             author);
    const char *behind = strstr(authored, "</lambert>");
    assert_non_null(behind);
    snprintf(text, sizeof text, "%.*s%s%s", (int)(behind - authored), authored, words, behind);
    return model_of("a.dae", text);
}

#define IOR "<index_of_refraction><float>1.45</float></index_of_refraction>"

/* Blender's Collada files hold neither roughness nor specular. Of a principled material they hold the index of
 * refraction, and metallic under the name of reflectivity. */
static void principled_surfaces_of_blenders_shine(void **state)
{
    (void)state;
    static const struct {
        const char *author, *words;
        bool is_principled;
        double metallic;
    } CASES[] = {{"Blender 3.4.1", IOR, true, 0.0},
                 {"Blender 3.4.1", "<reflectivity><float>0.25</float></reflectivity>" IOR, true, 0.25},
                 {"Blender 3.4.1", "<reflectivity><float>0.5</float></reflectivity>", false, 0.0},
                 {"Another 3.4.1", IOR, false, 0.0}};
    for (size_t k = 0; k < sizeof CASES / sizeof CASES[0]; k++) {
        reading r = surface_by(CASES[k].author, CASES[k].words);
        assert_int_equal(r.status, AG_OK);
        const material *m = model_material(&r, 0);
        assert_int_equal(m->kind, CASES[k].is_principled ? MATERIAL_PRINCIPLED : MATERIAL_DIFFUSE);
        assert_rgb(m->reflectance, .5, .25, .75, 1e-6);
        if (CASES[k].is_principled) {
            assert_near(m->metallic, CASES[k].metallic, 1e-6);
            assert_near(m->roughness, 0.5, 1e-6);
            assert_near(m->ior, 1.5, 1e-6);
            model_said(
                &r, AG_LOG_WARNING, "a.dae",
                ": warning: Blender writes neither roughness nor specular to Collada files: both are taken to be "
                "0.5, as in its new materials\n");
        } else {
            assert_true(!r.said[AG_LOG_WARNING] || !strstr(r.said[AG_LOG_WARNING], "roughness"));
        }
        reading_destroy(&r);
    }
}

/* FBX: 100 W to the W, in cm unless UnitScaleFactor says otherwise. */
#define FBX_LAMP(unit, kind, words)                                                                                     \
    "; FBX 7.4.0 project file\nFBXHeaderExtension: {\nFBXHeaderVersion: 1003\nFBXVersion: 7400\n"                       \
    "Creator: \"Blender (stable FBX IO) - 3.4.1 - 4.37.1\"\n}\nCreator: \"Blender (stable FBX IO) - 3.4.1 - 4.37.1\"\n" \
    "GlobalSettings: {\nVersion: 1000\nProperties70: {\nP: \"UpAxis\", \"int\", \"Integer\", \"\",1\n"                  \
    "P: \"UnitScaleFactor\", \"double\", \"Number\", \"\"," unit "\n}\n}\nObjects: {\n"                                 \
    "Geometry: 1, \"Geometry::g\", \"Mesh\" {\nVertices: *9 {\na: 0,0,0,1,0,0,0,0,-1\n}\n"                              \
    "PolygonVertexIndex: *3 {\na: 0,1,-3\n}\nGeometryVersion: 124\n}\n"                                                 \
    "Model: 2, \"Model::m\", \"Mesh\" {\nVersion: 232\n}\nModel: 3, \"Model::lam\", \"Light\" {\nVersion: 232\n"        \
    "Properties70: {\nP: \"Lcl Translation\", \"Lcl Translation\", \"\", \"A\",100,200,300\n}\n}\n"                     \
    "NodeAttribute: 4, \"NodeAttribute::lam\", \"Light\" {\nTypeFlags: \"Light\"\nGeometryVersion: 124\n"               \
    "Properties70: {\nP: \"LightType\", \"enum\", \"\", \"\"," kind "\n"                                                \
    "P: \"Color\", \"Color\", \"\", \"A\",1,0.5,0\nP: \"Intensity\", \"Number\", \"\", \"A\",5000\n"                    \
    "P: \"DecayType\", \"enum\", \"\", \"\",2\nP: \"DecayStart\", \"double\", \"Number\", \"\",2500\n" words            \
    "}\n}\n}\nConnections: {\nC: \"OO\",2,0\nC: \"OO\",1,2\nC: \"OO\",3,0\nC: \"OO\",4,3\n}\n"

static void lamps_of_blenders_fbx_are_in_watts(void **state)
{
    (void)state;
    reading r = model_quietly("a.fbx", FBX_LAMP("1", "0", ""));
    assert_int_equal(r.status, AG_OK);
    assert_rgb(r.scene->lights[0].as.point.intensity, 1e4 * 50 / (4 * PI_D), 1e4 * 25 / (4 * PI_D), 0, 0.1);
    reading_destroy(&r);
    r = model_quietly("a.fbx", FBX_LAMP("100", "0", ""));
    assert_rgb(r.scene->lights[0].as.point.intensity, 50 / (4 * PI_D), 25 / (4 * PI_D), 0, 1e-5);
    reading_destroy(&r);
    r = model_quietly("a.fbx", FBX_LAMP("1", "1", ""));
    assert_rgb(r.scene->lights[0].as.distant.irradiance, 50, 25, 0, 1e-4);
    reading_destroy(&r);
    r = model_quietly("a.fbx", FBX_LAMP("1", "2",
                                        "P: \"OuterAngle\", \"double\", \"Number\", \"\",90\n"
                                        "P: \"InnerAngle\", \"double\", \"Number\", \"\",67.5\n"));
    assert_int_equal(r.scene->lights[0].kind, LIGHT_SPOT);
    assert_near(r.scene->lights[0].as.spot.falloff_end, 1 - sqrt(0.5), 1e-5);
    assert_near(r.scene->lights[0].as.spot.falloff_start, 0.75 * (1 - sqrt(0.5)), 1e-5);
    assert_true(r.scene->lights[0].as.spot.dims_by_cosine);
    reading_destroy(&r);
    r = model_of("a.fbx", FBX_LAMP("1", "3", ""));
    assert_int_equal(r.status, AG_OK);
    assert_int_equal(r.scene->lights[0].kind, LIGHT_AREA);
    assert_near(r.scene->lights[0].as.area.radiance.r, 50 / 4.0 / 0.01, 0.1);
    assert_non_null(strstr(r.said[AG_LOG_WARNING], "its size and shape do not stand in the file"));
    reading_destroy(&r);
}

/* The scale of a camera at the root tells the length of Blender's unit. The picture of a camera with a sensor fit of
 * "Auto", Blender's default, sees along its longer side what the file says of its width. */
static void units_and_fields_of_blenders_fbx(void **state)
{
    (void)state;
#define FBX_CAMERA(scale, width, height)                                                                               \
    "Model: 5, \"Model::cam\", \"Camera\" {\nVersion: 232\nProperties70: {\nP: \"Lcl Scaling\", \"Lcl Scaling\", "     \
    "\"\", \"A\"," scale "," scale "," scale "\n}\n}\nNodeAttribute: 6, \"NodeAttribute::cam\", \"Camera\" {\n"        \
    "TypeFlags: \"Camera\"\nProperties70: {\nP: \"AspectWidth\", \"double\", \"Number\", \"\"," width "\n"             \
    "P: \"AspectHeight\", \"double\", \"Number\", \"\"," height "\n"                                                   \
    "P: \"FieldOfView\", \"FieldOfView\", \"\", \"A\",90\n}\n}\n}\nConnections: {\nC: \"OO\",5,0\nC: \"OO\",6,5\n"
    static const char LAMP[] = FBX_LAMP("1", "0", "");
    static const struct {
        const char *camera;
        double per_watt, fov_degrees;
    } CASES[] = {{FBX_CAMERA("1", "64", "36"), 1, 58.7155}, /* 2 atan(36 / 64) */
                 {FBX_CAMERA("100", "36", "64"), 1e4, 58.7155},
                 {FBX_CAMERA("2.54", "36", "36"), 1e4, 90}}; /* the lamp's node is not scaled: they do not agree */
    for (size_t k = 0; k < sizeof CASES / sizeof *CASES; k++) {
        char text[8192];
        const char *behind = strstr(LAMP, "}\nConnections: {\n");
        assert_non_null(behind);
        snprintf(text, sizeof text, "%.*s%s%s", (int)(behind - LAMP), LAMP, CASES[k].camera,
                 behind + strlen("}\nConnections: {\n"));
        reading r = model_quietly("a.fbx", text);
        assert_int_equal(r.status, AG_OK);
        assert_near(r.scene->camera.fov_degrees, CASES[k].fov_degrees, 0.01);
        assert_near(r.scene->lights[0].as.point.intensity.r, CASES[k].per_watt * 50 / (4 * PI_D),
                    1e-4 * CASES[k].per_watt);
        reading_destroy(&r);
    }
}

static void what_assimp_refuses_is_an_error(void **state)
{
    (void)state;
    model_refused("a.dae", "<?xml version=\"1.0\"?><nothing/>", AG_ERROR_INPUT, ": error: ");
    model_refused("a.dae", "", AG_ERROR_INPUT, ": error: ");
    model_refused("a.stl", "", AG_ERROR_INPUT, ": error: ");
    model_refused("a.fbx", "Kaydara FBX Binary  ", AG_ERROR_INPUT, ": error: ");
    model_refused("a.stl", "solid a\nendsolid a\n", AG_ERROR_INPUT, ": error: ");
}

static void vertices_are_checked_here(void **state)
{
    (void)state;
    unsigned char bytes[84 + 50] = {0};
    float corners[12] = {0, 0, 1, 0, 0, 0, NAN, 0, 0, 0, 0, 3};
    bytes[80] = 1;
    memcpy(bytes + 84, corners, sizeof corners);
    reading r = model_read(model_write("a.stl", bytes, sizeof bytes));
    assert_int_equal(r.status, AG_ERROR_INPUT);
    model_said(&r, AG_LOG_ERROR, "a.stl", ": error: mesh \"\": vertex 1 is not a finite number\n");
    reading_destroy(&r);
    corners[6] = 1e20f;
    memcpy(bytes + 84, corners, sizeof corners);
    r = model_read(model_write("a.stl", bytes, sizeof bytes));
    model_said(&r, AG_LOG_ERROR, "a.stl", ": error: mesh \"\": vertex 1 lies beyond 1e18 units\n");
    reading_destroy(&r);
}

static void damaged_files_do_no_harm(void **state)
{
    (void)state;
    static const char WHOLE[] =
        COLLADA("<up_axis>Y_UP</up_axis>", LIGHT("point", ""), COLLADA_FLOOR CAMERA("") LAMP(""));
    static const char ASE[] = "*3DSMAX_ASCIIEXPORT 200\n*GEOMOBJECT {\n*MESH {\n*MESH_NUMVERTEX 3\n*MESH_NUMFACES 1\n"
                              "*MESH_FACE_LIST {\n*MESH_FACE 0: A: 0 B: 1 C: 99999999\n}\n}\n}\n";
    char bytes[sizeof WHOLE];
    for (size_t k = 0; k < 24; k++) {
        memcpy(bytes, WHOLE, sizeof WHOLE);
        size_t at = (k * 7919 + 13) % (sizeof WHOLE - 1);
        bytes[at] = (char)(k % 3 == 0 ? '9' : k % 3 == 1 ? '<' : '\0');
        reading r = model_read(model_write("a.dae", bytes, k % 4 == 3 ? at : sizeof WHOLE - 1));
        assert_true(r.status == AG_OK || (r.status == AG_ERROR_INPUT && r.count[AG_LOG_ERROR] == 1));
        model_is_sound(&r);
        reading_destroy(&r);
    }
    reading r = model_of("a.ase", ASE);
    assert_int_equal(r.status, AG_ERROR_INPUT);
    assert_int_equal(r.count[AG_LOG_ERROR], 1);
    reading_destroy(&r);
}

static void a_cancelled_run_stops(void **state)
{
    (void)state;
    run_context run;
    scene *s = scene_create();
    run_context_init(&run, NULL, NULL, NULL, NULL);
    run_cancel(&run);
    assert_int_equal(
        scene_file_load(&run, model_write_text("a.stl", "solid a\n" FACET("0 0 0", "1 0 0", "0 1 0") "endsolid a\n"),
                        s),
        AG_CANCELLED);
    run_context_reset(&run);
    scene_destroy(s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(extensions),
        TEST_IN_FOLDER(stl_in_both_forms),
        TEST_IN_FOLDER(nodes_place_meshes),
        TEST_IN_FOLDER(the_up_axis_is_turned),
        TEST_IN_FOLDER(cameras_look_where_the_file_says),
        TEST_IN_FOLDER(lights_are_as_bright_as_the_file_says),
        TEST_IN_FOLDER(lamps_of_blenders_are_in_watts),
        TEST_IN_FOLDER(principled_surfaces_of_blenders_shine),
        TEST_IN_FOLDER(lamps_of_blenders_heed_the_unit),
        TEST_IN_FOLDER(units_and_fields_of_blenders_fbx),
        TEST_IN_FOLDER(lamps_of_blenders_fbx_are_in_watts),
        TEST_IN_FOLDER(what_assimp_refuses_is_an_error),
        TEST_IN_FOLDER(vertices_are_checked_here),
        TEST_IN_FOLDER(damaged_files_do_no_harm),
        TEST_IN_FOLDER(a_cancelled_run_stops),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
