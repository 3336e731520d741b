/* pbrt_textures.c: Texture of a pbrt-v4 scene, and parameters that are textures.
 * Rests on the format's description, pbrt.org/fileformat-v4, "Textures".
 * Flow: pbrt_parser -> [here] -> scene.textures; pbrt_materials, pbrt_lights and pbrt_shapes ask for parameters.
 * Threads: one per scene. */
#define _POSIX_C_SOURCE 200809L
#include "pbrt/pbrt_private.h"

#include "texture/texture_image_load.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Parameters that may be textures */

static const char *type_word(bool is_spectrum) { return is_spectrum ? "spectrum" : "float"; }

static const name_table *names_of(const pbrt_parser *parser, bool is_spectrum)
{
    return is_spectrum ? &parser->spectrum_texture_names : &parser->float_texture_names;
}

/* Finds the texture that the parameter names; *out_is_there is false where the parameter names none. */
static ag_status find_texture(pbrt_parser *parser, parameter_list *list, const char *name, bool is_spectrum,
                              bool *out_is_there, uint32_t *out_index)
{
    const char *texture_name = NULL;
    uint32_t other;
    *out_is_there = false;
    AG_TRY(parameter_get_texture(list, parser->log, name, &texture_name));
    if (!texture_name)
        return AG_OK;
    *out_is_there = true;
    if (name_table_find(names_of(parser, is_spectrum), texture_name, out_index))
        return AG_OK;
    if (name_table_find(names_of(parser, !is_spectrum), texture_name, &other))
        return pbrt_refuse(parser, list, name, "\"%s\" is a %s texture, but \"%s\" takes a %s texture", texture_name,
                           type_word(!is_spectrum), name, type_word(is_spectrum));
    return pbrt_refuse(parser, list, name, "no %s texture is named \"%s\"", type_word(is_spectrum), texture_name);
}

/* Gets the texture of the parameter, or SCENE_NO_TEXTURE where there is none; a constant texture becomes its value. */
static ag_status get_texture(pbrt_parser *parser, parameter_list *list, const char *name, bool is_spectrum,
                             bool *out_is_there, rgb *out_constant, uint32_t *out_texture_index)
{
    uint32_t index;
    *out_texture_index = SCENE_NO_TEXTURE;
    AG_TRY(find_texture(parser, list, name, is_spectrum, out_is_there, &index));
    if (!*out_is_there)
        return AG_OK;
    const texture *found = &parser->scene->textures.items[index];
    if (found->kind == TEXTURE_CONSTANT)
        *out_constant = found->inputs[0].value;
    else
        *out_texture_index = index;
    return AG_OK;
}

ag_status pbrt_get_rgb_texture(pbrt_parser *parser, parameter_list *list, const char *name, rgb *out_constant,
                               uint32_t *out_texture_index)
{
    bool is_there;
    AG_TRY(get_texture(parser, list, name, true, &is_there, out_constant, out_texture_index));
    return is_there ? AG_OK : parameter_get_rgb(list, parser->log, name, out_constant);
}

ag_status pbrt_get_float_texture(pbrt_parser *parser, parameter_list *list, const char *name, float *out_constant,
                                 uint32_t *out_texture_index)
{
    bool is_there;
    rgb value = rgb_gray(*out_constant);
    AG_TRY(get_texture(parser, list, name, false, &is_there, &value, out_texture_index));
    if (!is_there)
        return parameter_get_float(list, parser->log, name, out_constant);
    *out_constant = value.r;
    return AG_OK;
}

/* The inputs and values of a texture */

/* Reads a colour or a float, as the texture is, that is the same everywhere; *value comes with the default. */
static ag_status read_value(pbrt_parser *parser, parameter_list *list, const char *name, bool is_spectrum, rgb *value)
{
    if (is_spectrum)
        return parameter_get_rgb(list, parser->log, name, value);
    float number = value->r;
    AG_TRY(parameter_get_float(list, parser->log, name, &number));
    *value = rgb_gray(number);
    return AG_OK;
}

static ag_status read_input(pbrt_parser *parser, parameter_list *list, const char *name, bool is_spectrum,
                            float fallback, texture_input *out_input)
{
    out_input->value = rgb_gray(fallback);
    if (is_spectrum)
        return pbrt_get_rgb_texture(parser, list, name, &out_input->value, &out_input->texture_index);
    AG_TRY(pbrt_get_float_texture(parser, list, name, &fallback, &out_input->texture_index));
    out_input->value = rgb_gray(fallback);
    return AG_OK;
}

/* Reads one of several words; *out_which is left alone where the parameter is absent. */
static ag_status read_word(pbrt_parser *parser, parameter_list *list, const char *name, const char *const *words,
                           int word_count, int *out_which)
{
    const char *word = NULL;
    AG_TRY(parameter_get_string(list, parser->log, name, &word));
    if (!word)
        return AG_OK;
    for (int i = 0; i < word_count; i++)
        if (strcmp(word, words[i]) == 0) {
            *out_which = i;
            return AG_OK;
        }
    char known[160] = "";
    for (int i = 0; i < word_count; i++) {
        size_t used = strlen(known);
        snprintf(known + used, sizeof known - used, "%s%s", i > 0 ? ", " : "", words[i]);
    }
    return pbrt_refuse(parser, list, name, "unknown %s \"%s\"; known are %s", name, word, known);
}

static ag_status read_solid_mapping(pbrt_parser *parser, const parameter_list *list, texture *t)
{
    t->mapping.kind = TEXTURE_MAPPING_SOLID;
    pbrt_warn_still(parser, list->where, "a texture in space");
    texture_mapping_set_space(&t->mapping, &parser->state.world_from_object);
    return AG_OK;
}

static ag_status read_mapping(pbrt_parser *parser, parameter_list *list, texture *t)
{
    static const char *const KINDS[] = {"uv", "spherical", "cylindrical", "planar"}; /* as in texture_mapping_kind */
    texture_mapping *m = &t->mapping;
    int kind = TEXTURE_MAPPING_UV;
    AG_TRY(read_word(parser, list, "mapping", KINDS, 4, &kind));
    m->kind = (texture_mapping_kind)kind;
    if (kind != TEXTURE_MAPPING_UV)
        pbrt_warn_still(parser, list->where, "a texture in space");
    texture_mapping_set_space(m, &parser->state.world_from_object);
    if (kind == TEXTURE_MAPPING_UV) {
        m->scale = (vec2){1.0f, 1.0f};
        AG_TRY(parameter_get_float(list, parser->log, "uscale", &m->scale.x));
        AG_TRY(parameter_get_float(list, parser->log, "vscale", &m->scale.y));
    }
    if (kind == TEXTURE_MAPPING_PLANAR) {
        m->axes[0] = vec3_make(1.0f, 0.0f, 0.0f);
        m->axes[1] = vec3_make(0.0f, 1.0f, 0.0f);
        AG_TRY(parameter_get_vec3(list, parser->log, "v1", PARAMETER_VECTOR3, &m->axes[0]));
        AG_TRY(parameter_get_vec3(list, parser->log, "v2", PARAMETER_VECTOR3, &m->axes[1]));
    }
    if (kind == TEXTURE_MAPPING_UV || kind == TEXTURE_MAPPING_PLANAR) {
        AG_TRY(parameter_get_float(list, parser->log, "udelta", &m->delta.x));
        AG_TRY(parameter_get_float(list, parser->log, "vdelta", &m->delta.y));
    }
    return AG_OK;
}

/* The kinds. t->kind and t->is_spectrum are set, no input is a texture. */

typedef ag_status read_kind(pbrt_parser *parser, parameter_list *list, texture *t);

static ag_status read_constant(pbrt_parser *parser, parameter_list *list, texture *t)
{
    t->inputs[0].value = rgb_gray(1.0f);
    return read_value(parser, list, "value", t->is_spectrum, &t->inputs[0].value);
}

/* Reads pbrt-v3's "scale", whose inputs are both of the texture's type. */
static ag_status read_old_scale(pbrt_parser *parser, parameter_list *list, texture *t)
{
    log_at_once(parser->log, AG_LOG_WARNING, list->where, "old scale",
                "Texture \"scale\": \"tex1\" and \"tex2\" are pbrt-v3's: they are read as \"tex\" and \"scale\"");
    AG_TRY(read_input(parser, list, "tex1", t->is_spectrum, 1.0f, &t->inputs[0]));
    return read_input(parser, list, "tex2", t->is_spectrum, 1.0f, &t->inputs[1]);
}

static ag_status read_scale(pbrt_parser *parser, parameter_list *list, texture *t)
{
    if (parameter_list_find(list, "tex1") || parameter_list_find(list, "tex2"))
        return read_old_scale(parser, list, t);
    AG_TRY(read_input(parser, list, "tex", t->is_spectrum, 1.0f, &t->inputs[0]));
    return read_input(parser, list, "scale", false, 1.0f, &t->inputs[1]);
}

/* Reads the two inputs between which a texture mixes or chooses. */
static ag_status read_pair(pbrt_parser *parser, parameter_list *list, const char *first, float first_fallback,
                           const char *second, texture *t)
{
    AG_TRY(read_input(parser, list, first, t->is_spectrum, first_fallback, &t->inputs[0]));
    return read_input(parser, list, second, t->is_spectrum, 1.0f - first_fallback, &t->inputs[1]);
}

static ag_status read_mix(pbrt_parser *parser, parameter_list *list, texture *t)
{
    AG_TRY(read_pair(parser, list, "tex1", 0.0f, "tex2", t));
    return read_input(parser, list, "amount", false, 0.5f, &t->inputs[2]);
}

static ag_status read_direction_mix(pbrt_parser *parser, parameter_list *list, texture *t)
{
    vec3 direction = vec3_make(0.0f, 1.0f, 0.0f);
    AG_TRY(parameter_get_vec3(list, parser->log, "dir", PARAMETER_VECTOR3, &direction));
    direction = transform_vector(&parser->state.world_from_object, direction);
    float length = vec3_length(direction);
    if (!(length > 0.0f && isfinite(length)))
        return pbrt_refuse(parser, list, "dir", "\"dir\" should have a length above 0");
    t->direction = vec3_scale(direction, 1.0f / length);
    return read_pair(parser, list, "tex1", 0.0f, "tex2", t);
}

static ag_status read_checkerboard(pbrt_parser *parser, parameter_list *list, texture *t)
{
    int64_t dimension = 2;
    AG_TRY(parameter_get_int(list, parser->log, "dimension", &dimension));
    if (dimension != 2 && dimension != 3)
        return pbrt_refuse(parser, list, "dimension", "\"dimension\" should be 2 or 3, not %d", (int)dimension);
    AG_TRY(dimension == 3 ? read_solid_mapping(parser, list, t) : read_mapping(parser, list, t));
    return read_pair(parser, list, "tex1", 1.0f, "tex2", t);
}

static ag_status read_dots(pbrt_parser *parser, parameter_list *list, texture *t)
{
    AG_TRY(read_mapping(parser, list, t));
    return read_pair(parser, list, "inside", 1.0f, "outside", t);
}

static ag_status read_bilerp(pbrt_parser *parser, parameter_list *list, texture *t)
{
    static const char *const NAMES[4] = {"v00", "v01", "v10", "v11"};
    AG_TRY(read_mapping(parser, list, t));
    for (int i = 0; i < 4; i++) {
        t->inputs[i].value = rgb_gray((float)(i & 1));
        AG_TRY(read_value(parser, list, NAMES[i], t->is_spectrum, &t->inputs[i].value));
    }
    return AG_OK;
}

/* Reads pbrt-v3's "gamma": whether the picture is sRGB, or, in its last versions, a power. */
static ag_status read_old_encoding(pbrt_parser *parser, parameter_list *list, image_encoding *encoding)
{
    const parameter *gamma = parameter_list_find(list, "gamma");
    bool is_srgb = true;
    float power = 0.0f;
    if (!gamma)
        return AG_OK;
    log_at_once(parser->log, AG_LOG_WARNING, gamma->where, "old gamma",
                "Texture \"imagemap\": \"gamma\" is pbrt-v3's: it is read as \"encoding\"");
    if (gamma->type == PARAMETER_FLOAT) {
        AG_TRY(parameter_get_float(list, parser->log, "gamma", &power));
        if (!(power > 0.0f && power <= 1000.0f))
            return pbrt_refuse(parser, list, "gamma", "\"gamma\" should be above 0");
        *encoding = (image_encoding){.curve = IMAGE_CURVE_GAMMA, .gamma = power};
        return AG_OK;
    }
    AG_TRY(parameter_get_bool(list, parser->log, "gamma", &is_srgb));
    encoding->curve = is_srgb ? IMAGE_CURVE_SRGB : IMAGE_CURVE_LINEAR;
    return AG_OK;
}

/* Reads one of pbrt's encodings, for colours also one of the config's colour spaces. */
static ag_status read_encoding(pbrt_parser *parser, parameter_list *list, bool is_color, image_encoding *encoding)
{
    const char *text = NULL;
    char spaces[1024] = "";
    AG_TRY(read_old_encoding(parser, list, encoding));
    AG_TRY(parameter_get_string(list, parser->log, "encoding", &text));
    if (!text || image_encoding_parse(text, encoding))
        return AG_OK;
    if (is_color && image_colors_parse(&parser->scene->textures.colors, text, encoding, spaces, sizeof spaces))
        return AG_OK;
    return pbrt_refuse(parser, list, "encoding",
                       "unknown encoding \"%s\"; known are sRGB, linear and, with a number, gamma%s%s", text,
                       spaces[0] ? "; " : "", spaces);
}

/* Returns a name for a picture in memory, which no path of a file begins with; to be freed, NULL when out of memory. */
static char *name_picture(const char *name)
{
    static const char BEFORE[] = "memory:";
    char *all = malloc(sizeof BEFORE + strlen(name));
    if (all)
        sprintf(all, "%s%s", BEFORE, name);
    return all;
}

ag_status pbrt_load_image(pbrt_parser *parser, const parameter_list *list, const char *parameter_name,
                          const char *file_name, image_encoding encoding, texture *t)
{
    char message[1024] = "";
    texture_set *set = &parser->scene->textures;
    uint32_t known_count = set->image_count;
    const pbrt_picture *picture = pbrt_find_picture(parser, file_name);
    char *path = picture ? name_picture(file_name) : pbrt_find_file(parser, file_name);
    if (path && t->is_spectrum && !t->is_data && encoding.curve == IMAGE_CURVE_DEFAULT)
        encoding = image_colors_rule(&set->colors, path);
    ag_status status = AG_ERROR_MEMORY;
    if (path && picture)
        status = texture_image_load_pixels(parser->run, set, path, picture->pixels, picture->version, encoding,
                                           &t->image_index, message, sizeof message);
    else if (path)
        status = texture_image_load(parser->run, set, path, encoding, &t->image_index, message, sizeof message);
    free(path);
    if (status != AG_OK && status != AG_ERROR_MEMORY && status != AG_CANCELLED)
        pbrt_refuse(parser, list, parameter_name, "%s", message);
    if (status == AG_OK && t->image_index >= known_count && set->images[t->image_index]->bad_count > 0)
        log_at(parser->log, AG_LOG_WARNING, parameter_list_find(list, parameter_name)->where,
               "\"%s\": %llu values are infinite or not a number, and count as 0", file_name,
               (unsigned long long)set->images[t->image_index]->bad_count);
    return status;
}

static ag_status read_image(pbrt_parser *parser, parameter_list *list, texture *t)
{
    /* as in texture_wrap; all filters but "point" are one: footprints are filtered alike whatever the file asks for */
    static const char *const WRAPS[] = {"repeat", "black", "clamp", "octahedralsphere"};
    static const char *const FILTERS[] = {"bilinear", "point", "trilinear", "EWA", "ewa"};
    const char *name = NULL;
    int wrap = TEXTURE_WRAP_REPEAT, filter = 0;
    float unused_anisotropy;
    bool unused_trilinear; /* pbrt-v3's "filter" */
    image_encoding encoding = {0};
    t->scale = 1.0f;
    AG_TRY(read_mapping(parser, list, t));
    AG_TRY(read_word(parser, list, "wrap", WRAPS, 4, &wrap));
    AG_TRY(read_word(parser, list, "filter", FILTERS, 5, &filter));
    AG_TRY(parameter_get_float(list, parser->log, "maxanisotropy", &unused_anisotropy));
    AG_TRY(parameter_get_bool(list, parser->log, "trilinear", &unused_trilinear));
    AG_TRY(parameter_get_float(list, parser->log, "scale", &t->scale));
    AG_TRY(parameter_get_bool(list, parser->log, "invert", &t->invert));
    AG_TRY(read_encoding(parser, list, t->is_spectrum, &encoding));
    AG_TRY(parameter_get_string(list, parser->log, "filename", &name));
    if (!name)
        return pbrt_error(parser, list->where, strlen(list->directive),
                          "Texture \"imagemap\" has no \"string filename\"");
    t->wraps = texture_wraps_same((texture_wrap)wrap);
    t->filter = filter == 1 ? TEXTURE_FILTER_POINT : TEXTURE_FILTER_BILINEAR;
    return pbrt_load_image(parser, list, "filename", name, encoding, t);
}

static ag_status read_octaves(pbrt_parser *parser, parameter_list *list, texture *t)
{
    int64_t octaves = 8;
    t->roughness = 0.5f;
    AG_TRY(parameter_get_int(list, parser->log, "octaves", &octaves));
    AG_TRY(parameter_get_float(list, parser->log, "roughness", &t->roughness));
    if (octaves < 0)
        return pbrt_refuse(parser, list, "octaves", "\"octaves\" should not be negative");
    if (octaves > TEXTURE_MAX_OCTAVES)
        log_at(parser->log, AG_LOG_WARNING, parameter_list_find(list, "octaves")->where,
               "\"octaves\" is above %d: %d is used, what is finer cannot be seen", TEXTURE_MAX_OCTAVES,
               TEXTURE_MAX_OCTAVES);
    t->octaves = octaves > TEXTURE_MAX_OCTAVES ? TEXTURE_MAX_OCTAVES : (int)octaves;
    return read_solid_mapping(parser, list, t);
}

static ag_status read_windy(pbrt_parser *parser, parameter_list *list, texture *t)
{
    (void)list;
    return read_solid_mapping(parser, list, t);
}

static ag_status read_marble(pbrt_parser *parser, parameter_list *list, texture *t)
{
    t->scale = 1.0f;
    t->variation = 0.2f;
    AG_TRY(parameter_get_float(list, parser->log, "scale", &t->scale));
    AG_TRY(parameter_get_float(list, parser->log, "variation", &t->variation));
    return read_octaves(parser, list, t);
}

/* Makes a plain stand-in: Ptex has its coordinates in faces of its own, which no mesh here has. */
static ag_status read_stand_in(pbrt_parser *parser, parameter_list *list, texture *t)
{
    log_at_once(parser->log, AG_LOG_WARNING, list->where, "texture:ptex",
                "Texture \"ptex\" is not supported: a constant of 0.5 stands in");
    t->inputs[0].value = rgb_gray(0.5f);
    for (size_t i = 0; i < list->count; i++)
        list->items[i].looked_up = true;
    return AG_OK;
}

static const struct {
    const char *name;
    texture_kind kind;
    bool is_float, is_spectrum; /* of which types there are some */
    read_kind *read;
} KINDS[] = {
    {"constant", TEXTURE_CONSTANT, true, true, read_constant},
    {"scale", TEXTURE_SCALE, true, true, read_scale},
    {"mix", TEXTURE_MIX, true, true, read_mix},
    {"directionmix", TEXTURE_DIRECTION_MIX, true, true, read_direction_mix},
    {"checkerboard", TEXTURE_CHECKERBOARD, true, true, read_checkerboard},
    {"imagemap", TEXTURE_IMAGE, true, true, read_image},
    {"bilerp", TEXTURE_BILERP, true, true, read_bilerp},
    {"dots", TEXTURE_DOTS, true, true, read_dots},
    {"fbm", TEXTURE_FBM, true, false, read_octaves},
    {"wrinkled", TEXTURE_WRINKLED, true, false, read_octaves},
    {"windy", TEXTURE_WINDY, true, false, read_windy},
    {"marble", TEXTURE_MARBLE, false, true, read_marble},
    {"ptex", TEXTURE_CONSTANT, true, true, read_stand_in},
};

/* The directive */

static ag_status read_texture(pbrt_parser *parser, parameter_list *list, bool is_spectrum, texture *out_texture)
{
    memset(out_texture, 0, sizeof *out_texture);
    out_texture->is_spectrum = is_spectrum;
    for (int i = 0; i < 4; i++)
        out_texture->inputs[i].texture_index = SCENE_NO_TEXTURE;
    for (size_t i = 0; i < sizeof KINDS / sizeof *KINDS; i++)
        if (strcmp(list->name, KINDS[i].name) == 0 && (is_spectrum ? KINDS[i].is_spectrum : KINDS[i].is_float)) {
            out_texture->kind = KINDS[i].kind;
            AG_TRY(KINDS[i].read(parser, list, out_texture));
            parameter_list_warn_unused(list, parser->log);
            return AG_OK;
        }
    return pbrt_error(parser, list->where, strlen(list->directive), "there are no %s textures of class \"%s\"",
                      type_word(is_spectrum), list->name);
}

static ag_status add_texture(pbrt_parser *parser, const parameter_list *list, const char *name, const texture *t)
{
    uint32_t index;
    ag_status status = texture_set_add(&parser->scene->textures, t, &index);
    if (status == AG_ERROR_SCENE)
        return pbrt_error(parser, list->where, strlen(list->directive), "texture \"%s\" is made of more than %d others",
                          name, TEXTURE_MAX_COST);
    if (status != AG_OK)
        return status;
    return name_table_set(t->is_spectrum ? &parser->spectrum_texture_names : &parser->float_texture_names, name, index);
}

static ag_status make_texture(pbrt_parser *parser, const char *name, const char *type, file_location type_where,
                              parameter_list *list)
{
    texture t;
    uint32_t index;
    bool is_spectrum = strcmp(type, "spectrum") == 0 || strcmp(type, "color") == 0;
    if (!is_spectrum && strcmp(type, "float") != 0)
        return pbrt_error(parser, type_where, strlen(type) + 2,
                          "texture \"%s\" should be of type \"float\" or \"spectrum\", not \"%s\"", name, type);
    if (strcmp(type, "color") == 0)
        log_at_once(parser->log, AG_LOG_WARNING, type_where, "texture type:color",
                    "the texture type \"color\" is called \"spectrum\" in pbrt-v4 and is read as that");
    if (name_table_find(names_of(parser, is_spectrum), name, &index))
        return pbrt_error(parser, list->where, strlen(list->directive), "%s texture \"%s\" is made twice",
                          type_word(is_spectrum), name);
    AG_TRY(read_texture(parser, list, is_spectrum, &t));
    return add_texture(parser, list, name, &t);
}

ag_status pbrt_texture(pbrt_parser *parser, file_location where)
{
    char *name, *type = NULL;
    file_location type_where;
    parameter_list list;
    AG_TRY(pbrt_read_string(parser, "Texture", "a quoted name", &name, NULL));
    ag_status status = pbrt_read_string(parser, "Texture", "a quoted type after its name", &type, &type_where);
    if (status == AG_OK)
        status = pbrt_read_named_parameters(parser, "Texture", "a quoted class after its type", where, &list);
    if (status == AG_OK) {
        status = make_texture(parser, name, type, type_where, &list);
        parameter_list_reset(&list);
    }
    free(name);
    free(type);
    return status;
}
