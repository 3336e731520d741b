/* pbrt_material_kinds.c: what each kind of material of a pbrt-v4 scene is made of.
 * Rests on the format's description, pbrt.org/fileformat-v4, "Materials"; for the colour of hair on d'Eon et al.,
 * "An Energy-Conserving Hair Reflectance Model", 2011 (melanin), for what stands in for flesh on Jensen et al., "A
 * Practical Model for Subsurface Light Transport", 2001 (the diffuse reflectance). Flow: pbrt_materials -> [here] ->
 * material. Threads: one per scene. */
#include "color/spectra.h"
#include "material/hair.h"
#include "medium/medium.h"
#include "pbrt/pbrt_private.h"

#include <stdio.h>
#include <string.h>

static ag_status read_reflectance(pbrt_parser *parser, parameter_list *list, material *m)
{
    rgb *r = &m->reflectance;
    AG_TRY(pbrt_get_rgb_texture(parser, list, "reflectance", r, &m->reflectance_texture));
    if (rgb_max(*r) > 1.0f) {
        const parameter *p = parameter_list_find(list, "reflectance");
        log_at(parser->log, AG_LOG_WARNING, p->where, "\"reflectance\" is above 1: 1 is used");
        *r = rgb_clamp(*r, 0.0f, 1.0f);
    }
    return AG_OK;
}

/* "roughness" and its two axes, of the outer interface; prefix: of the parts of a coated conductor. */
static ag_status read_roughness(pbrt_parser *parser, parameter_list *list, const char *prefix, material *m)
{
    float *const out_alpha[2] = {&m->alpha_u, &m->alpha_v};
    uint32_t *const out_texture[2] = {&m->alpha_u_texture, &m->alpha_v_texture};
    static const char *const AXES[2] = {"uroughness", "vroughness"};
    char name[48];
    float roughness = 0.0f;
    uint32_t texture_index = SCENE_NO_TEXTURE;
    bool remap = true;
    snprintf(name, sizeof name, "%sroughness", prefix);
    AG_TRY(pbrt_get_float_texture(parser, list, name, &roughness, &texture_index));
    AG_TRY(parameter_get_bool(list, parser->log, "remaproughness", &remap));
    if (roughness < 0.0f)
        return pbrt_refuse(parser, list, name, "\"%s\" should not be negative", name);
    for (int i = 0; i < 2; i++) {
        float value = roughness;
        snprintf(name, sizeof name, "%s%s", prefix, AXES[i]);
        *out_texture[i] = texture_index;
        if (parameter_list_find(list, name))
            AG_TRY(pbrt_get_float_texture(parser, list, name, &value, out_texture[i]));
        if (value < 0.0f)
            return pbrt_refuse(parser, list, name, "\"%s\" should not be negative", name);
        *out_alpha[i] = remap ? sqrtf(value) : value;
    }
    m->remaps_roughness = remap;
    return AG_OK;
}

static bool is_texture(const parameter_list *list, const char *name)
{
    const parameter *p = parameter_list_find(list, name);
    return p && p->type == PARAMETER_TEXTURE;
}

/* eta and k of a conductor, or those that give its reflectance; prefix as for read_roughness. */
static ag_status read_metal(pbrt_parser *parser, parameter_list *list, const char *prefix, material *m)
{
    char eta[32], k[32];
    snprintf(eta, sizeof eta, "%seta", prefix);
    snprintf(k, sizeof k, "%sk", prefix);
    spectra_find_named("metal-Cu-eta", NULL, &m->eta);
    spectra_find_named("metal-Cu-k", NULL, &m->k);
    if (!parameter_list_find(list, "reflectance")) {
        AG_TRY(pbrt_get_rgb_texture(parser, list, eta, &m->eta, &m->eta_texture));
        AG_TRY(pbrt_get_rgb_texture(parser, list, k, &m->k, &m->k_texture));
        if (!(m->eta.r > 0.0f && m->eta.g > 0.0f && m->eta.b > 0.0f))
            return pbrt_refuse(parser, list, eta, "\"%s\" should be above 0", eta);
        if (!is_texture(list, eta) && !is_texture(list, k)) /* textures are read as colours, which converts them */
            working_space_metal(&parser->scene->space, &m->eta, &m->k);
        return AG_OK;
    }
    if (parameter_list_find(list, eta) || parameter_list_find(list, k))
        return pbrt_refuse(parser, list, "reflectance",
                           "\"reflectance\" and \"%s\" or \"%s\" cannot both be given to a conductor", eta, k);
    AG_TRY(read_reflectance(parser, list, m));
    rgb r = m->reflectance;
    m->eta = rgb_gray(1.0f);
    m->k =
        rgb_make(material_k_from_reflectance(r.r), material_k_from_reflectance(r.g), material_k_from_reflectance(r.b));
    return AG_OK;
}

/* Reads one index for all light, since dispersion is not simulated. */
static ag_status read_index(pbrt_parser *parser, parameter_list *list, const char *name, float *ior)
{
    const parameter *eta = parameter_list_find(list, name);
    if (eta && (eta->type == PARAMETER_SPECTRUM || eta->type == PARAMETER_RGB)) {
        rgb value = rgb_gray(*ior);
        AG_TRY(parameter_get_rgb(list, parser->log, name, &value));
        *ior = value.g;
    } else {
        AG_TRY(parameter_get_float(list, parser->log, name, ior));
    }
    if (!(*ior > 0.0f))
        return pbrt_refuse(parser, list, name, "\"%s\" should be above 0", name);
    return AG_OK;
}

static ag_status read_conductor(pbrt_parser *parser, parameter_list *list, material *m)
{
    AG_TRY(read_metal(parser, list, "", m));
    return read_roughness(parser, list, "", m);
}

static ag_status read_dielectric(pbrt_parser *parser, parameter_list *list, material *m)
{
    AG_TRY(read_index(parser, list, "eta", &m->ior));
    return read_roughness(parser, list, "", m);
}

static ag_status read_thin_dielectric(pbrt_parser *parser, parameter_list *list, material *m)
{
    return read_index(parser, list, "eta", &m->ior);
}

/* Warns of a texture for a value that varies over surfaces in pbrt, but not here. */
static void tell_texture(pbrt_parser *parser, const parameter_list *list, const char *of, const char *name,
                         const char *stand_in)
{
    char key[96];
    snprintf(key, sizeof key, "texture:%s:%s", of, name);
    log_at_once(parser->log, AG_LOG_WARNING, list->where, key,
                "%s: a texture for \"%s\" that varies is not supported: %s stands in", of, name, stand_in);
}

/* Reads a number, or a texture that is one all over; where it varies, `otherwise` stands in. of: whose it is, for the
 * message. */
static ag_status read_constant(pbrt_parser *parser, parameter_list *list, const char *of, const char *name,
                               float otherwise, float *value)
{
    char number[32];
    uint32_t texture_index = SCENE_NO_TEXTURE;
    AG_TRY(pbrt_get_float_texture(parser, list, name, value, &texture_index));
    if (texture_index == SCENE_NO_TEXTURE)
        return AG_OK;
    *value = otherwise;
    snprintf(number, sizeof number, "%g", (double)otherwise);
    tell_texture(parser, list, of, name, number);
    return AG_OK;
}

/* Works as read_constant, for a colour. */
static ag_status read_constant_color(pbrt_parser *parser, parameter_list *list, const char *of, const char *name,
                                     rgb otherwise, const char *stand_in, rgb *value)
{
    uint32_t texture_index = SCENE_NO_TEXTURE;
    AG_TRY(pbrt_get_rgb_texture(parser, list, name, value, &texture_index));
    if (texture_index == SCENE_NO_TEXTURE)
        return AG_OK;
    *value = otherwise;
    tell_texture(parser, list, of, name, stand_in);
    return AG_OK;
}

/* Of pbrt's random walk in a coat its result is kept. What the coat is filled with absorbs even where its albedo is 0,
 * and the walk ends after "maxdepth" steps: both darken. "nsamples" decides pbrt's noise alone. */
static ag_status read_coat_walk(pbrt_parser *parser, parameter_list *list, material *m)
{
    static const char COAT[] = "a coat";
    m->coat_thickness = 0.01f;
    int64_t depth = 10, samples = 1;
    AG_TRY(read_constant(parser, list, COAT, "thickness", m->coat_thickness, &m->coat_thickness));
    AG_TRY(read_constant(parser, list, COAT, "g", m->coat_g, &m->coat_g));
    AG_TRY(parameter_get_int(list, parser->log, "maxdepth", &depth));
    AG_TRY(parameter_get_int(list, parser->log, "nsamples", &samples));
    AG_TRY(read_constant_color(parser, list, COAT, "albedo", m->coat_albedo, "black", &m->coat_albedo));
    if (m->coat_thickness < 0.0f)
        return pbrt_refuse(parser, list, "thickness", "\"thickness\" should not be negative");
    if (depth < 1 || depth > 1000)
        return pbrt_refuse(parser, list, "maxdepth", "\"maxdepth\" should be from 1 to 1000");
    if (!(m->coat_g > -1.0f && m->coat_g < 1.0f))
        return pbrt_refuse(parser, list, "g", "\"g\" should be between -1 and 1");
    m->coat_bounces = (int)(depth + 1) / 2; /* every other step of the walk meets the base */
    if (rgb_max(m->coat_albedo) > 1.0f) {
        const parameter *p = parameter_list_find(list, "albedo");
        log_at_once(parser->log, AG_LOG_WARNING, p->where, "coat albedo", "\"albedo\" is above 1: 1 is used");
        m->coat_albedo = rgb_clamp(m->coat_albedo, 0.0f, 1.0f);
    }
    return AG_OK;
}

static ag_status read_coated_diffuse(pbrt_parser *parser, parameter_list *list, material *m)
{
    AG_TRY(read_reflectance(parser, list, m));
    AG_TRY(read_index(parser, list, "eta", &m->ior));
    AG_TRY(read_coat_walk(parser, list, m));
    return read_roughness(parser, list, "", m);
}

static ag_status read_coated_conductor(pbrt_parser *parser, parameter_list *list, material *m)
{
    AG_TRY(read_metal(parser, list, "conductor.", m));
    AG_TRY(read_index(parser, list, "interface.eta", &m->ior));
    AG_TRY(read_coat_walk(parser, list, m));
    AG_TRY(read_roughness(parser, list, "conductor.", m));
    m->base_alpha_u = m->alpha_u;
    m->base_alpha_v = m->alpha_v;
    m->base_alpha_u_texture = m->alpha_u_texture;
    m->base_alpha_v_texture = m->alpha_v_texture;
    AG_TRY(read_roughness(parser, list, "interface.", m));
    /* the conductor's index is relative to air; under the coat it is relative to the coat */
    m->eta = rgb_scale(m->eta, 1.0f / m->ior);
    m->k = rgb_scale(m->k, 1.0f / m->ior);
    return AG_OK;
}

static ag_status read_diffuse(pbrt_parser *parser, parameter_list *list, material *m)
{
    return read_reflectance(parser, list, m);
}

/* Puts a texture times a number in the place of the texture. */
static ag_status scale_texture(pbrt_parser *parser, const parameter_list *list, float scale, uint32_t *texture_index)
{
    if (*texture_index == SCENE_NO_TEXTURE || scale == 1.0f)
        return AG_OK;
    texture t;
    memset(&t, 0, sizeof t);
    t.kind = TEXTURE_SCALE;
    t.is_spectrum = true;
    for (int i = 0; i < 4; i++)
        t.inputs[i].texture_index = SCENE_NO_TEXTURE;
    t.inputs[0].texture_index = *texture_index;
    t.inputs[1].value = rgb_gray(scale);
    ag_status status = texture_set_add(&parser->scene->textures, &t, texture_index);
    return status == AG_ERROR_SCENE
               ? pbrt_refuse(parser, list, "scale", "the texture to be scaled is made of too many others")
               : status;
}

static ag_status read_diffuse_transmission(pbrt_parser *parser, parameter_list *list, material *m)
{
    float scale = 1.0f;
    bool ignored; /* pbrt reads it, and has no use for it */
    AG_TRY(pbrt_get_rgb_texture(parser, list, "reflectance", &m->reflectance, &m->reflectance_texture));
    AG_TRY(pbrt_get_rgb_texture(parser, list, "transmittance", &m->transmittance, &m->transmittance_texture));
    AG_TRY(parameter_get_float(list, parser->log, "scale", &scale));
    if (scale < 0.0f)
        return pbrt_refuse(parser, list, "scale", "\"scale\" should not be negative");
    m->reflectance = rgb_scale(m->reflectance, scale);
    m->transmittance = rgb_scale(m->transmittance, scale);
    AG_TRY(scale_texture(parser, list, scale, &m->reflectance_texture));
    AG_TRY(scale_texture(parser, list, scale, &m->transmittance_texture));
    AG_TRY(parameter_get_bool(list, parser->log, "remaproughness", &ignored));
    rgb sum = rgb_add(m->reflectance, m->transmittance);
    if (rgb_max(sum) > 1.0f) {
        log_at(parser->log, AG_LOG_WARNING, list->where,
               "\"reflectance\" and \"transmittance\" are above 1 together: both are scaled down");
        m->reflectance = rgb_scale(m->reflectance, 1.0f / rgb_max(sum));
        m->transmittance = rgb_scale(m->transmittance, 1.0f / rgb_max(sum));
    }
    return AG_OK;
}

/* Says, once for each type, what stands in for it. */

static void tell_stand_in(pbrt_parser *parser, const parameter_list *list, const char *type, const char *stand_in)
{
    char key[96];
    snprintf(key, sizeof key, "material:%s", type);
    log_at_once(parser->log, AG_LOG_WARNING, list->where, key, "material \"%s\" is not supported: %s stands in", type,
                stand_in);
}

/* Marks the parameters that a stand-in has no use for as read, so that no warning names them. */
static void pass_over(parameter_list *list, const char *const *names, size_t count)
{
    for (size_t i = 0; i < list->count; i++)
        for (size_t n = 0; n < count; n++)
            if (strcmp(list->items[i].name, names[n]) == 0)
                list->items[i].looked_up = true;
}

static rgb hair_absorption(float eumelanin, float pheomelanin)
{
    float e = float_max(eumelanin, 0.0f), p = float_max(pheomelanin, 0.0f);
    return rgb_make(0.419f * e + 0.187f * p, 0.697f * e + 0.4f * p, 1.37f * e + 1.05f * p);
}

static const char HAIR[] = "material \"hair\"";

static ag_status read_hair_color(pbrt_parser *parser, parameter_list *list, material *m)
{
    const char *color = parameter_list_find(list, "reflectance") ? "reflectance" : "color";
    if (!parameter_list_find(list, "sigma_a") && parameter_list_find(list, color)) {
        AG_TRY(pbrt_get_rgb_texture(parser, list, color, &m->reflectance, &m->reflectance_texture));
        m->hair_sigma_a = hair_absorption_from_reflectance(m->reflectance, m->hair_beta_n);
        return AG_OK;
    }
    const float brown = 1.3f;
    float eumelanin = 0.0f, pheomelanin = 0.0f;
    if (!parameter_list_find(list, "eumelanin") && !parameter_list_find(list, "pheomelanin"))
        eumelanin = brown;
    AG_TRY(read_constant(parser, list, HAIR, "eumelanin", brown, &eumelanin));
    AG_TRY(read_constant(parser, list, HAIR, "pheomelanin", brown, &pheomelanin));
    const rgb melanin = working_space_light(&parser->scene->space, hair_absorption(eumelanin, pheomelanin));
    m->hair_sigma_a = melanin;
    return read_constant_color(parser, list, HAIR, "sigma_a", melanin, "brown", &m->hair_sigma_a);
}

static ag_status read_hair(pbrt_parser *parser, parameter_list *list, material *m)
{
    static const char *const COLORS[] = {"sigma_a", "reflectance", "color", "eumelanin", "pheomelanin"};
    m->ior = 1.55f;
    AG_TRY(read_constant(parser, list, HAIR, "eta", m->ior, &m->ior));
    AG_TRY(read_constant(parser, list, HAIR, "beta_m", m->hair_beta_m, &m->hair_beta_m));
    AG_TRY(read_constant(parser, list, HAIR, "beta_n", m->hair_beta_n, &m->hair_beta_n));
    AG_TRY(read_constant(parser, list, HAIR, "alpha", m->hair_tilt_degrees, &m->hair_tilt_degrees));
    if (!(m->ior > 1.0f))
        return pbrt_refuse(parser, list, "eta", "\"eta\" of \"hair\" should be above 1");
    for (int i = 0; i < 2; i++) {
        const char *name = i == 0 ? "beta_m" : "beta_n";
        float value = i == 0 ? m->hair_beta_m : m->hair_beta_n;
        if (!(value >= 0.0f && value <= 1.0f))
            return pbrt_refuse(parser, list, name, "\"%s\" should be from 0 to 1", name);
    }
    if (!(fabsf(m->hair_tilt_degrees) <= 90.0f))
        return pbrt_refuse(parser, list, "alpha", "\"alpha\" should be from -90 to 90 degrees");
    AG_TRY(read_hair_color(parser, list, m));
    pass_over(list, COLORS, sizeof COLORS / sizeof *COLORS); /* the first of them decides */
    return AG_OK;
}

/* Returns the albedo of a half space that scatters and absorbs so, without its surface, which is the coat's. */
static float half_space_reflectance(float sigma_a, float reduced_sigma_s)
{
    double sum = (double)sigma_a + (double)reduced_sigma_s, albedo = sum > 0.0 ? (double)reduced_sigma_s / sum : 0.0;
    double root = sqrt(3.0 * (1.0 - albedo));
    return (float)(0.5 * albedo * (1.0 + exp(-4.0 / 3.0 * root)) * exp(-root));
}

/* Finds how flesh scatters: by a name, else by "sigma_a", "sigma_s" and "g", else as whole milk, as in pbrt. The name
 * decides even beside a "reflectance". */
static ag_status read_flesh(pbrt_parser *parser, parameter_list *list, const char *name, material *m)
{
    rgb sigma_a, sigma_s;
    float g = 0.0f;
    if (!medium_find_preset(name[0] ? name : "Wholemilk", &sigma_a, &sigma_s))
        return pbrt_refuse(parser, list, "name", "no subsurface material is named \"%s\"", name);
    sigma_a = working_space_light(&parser->scene->space, sigma_a);
    sigma_s = working_space_light(&parser->scene->space, sigma_s);
    if (!name[0]) {
        AG_TRY(parameter_get_rgb(list, parser->log, "sigma_a", &sigma_a));
        AG_TRY(parameter_get_rgb(list, parser->log, "sigma_s", &sigma_s));
        AG_TRY(parameter_get_float(list, parser->log, "g", &g));
    }
    float s = 1.0f - float_clamp(g, -1.0f, 1.0f);
    m->reflectance = rgb_clamp(rgb_make(half_space_reflectance(sigma_a.r, s * sigma_s.r),
                                        half_space_reflectance(sigma_a.g, s * sigma_s.g),
                                        half_space_reflectance(sigma_a.b, s * sigma_s.b)),
                               0.0f, 1.0f);
    return AG_OK;
}

static ag_status read_subsurface(pbrt_parser *parser, parameter_list *list, material *m)
{
    static const char *const UNUSED[] = {"reflectance", "mfp", "g", "scale", "sigma_a", "sigma_s"};
    const char *name = "";
    m->ior = 1.33f;
    tell_stand_in(parser, list, "subsurface",
                  "\"coateddiffuse\" of its diffuse reflectance, which lets no light travel inside,");
    AG_TRY(read_index(parser, list, "eta", &m->ior));
    AG_TRY(read_roughness(parser, list, "", m));
    AG_TRY(parameter_get_string(list, parser->log, "name", &name));
    if (!name[0] && parameter_list_find(list, "reflectance"))
        AG_TRY(read_reflectance(parser, list, m));
    else
        AG_TRY(read_flesh(parser, list, name, m));
    pass_over(list, UNUSED, sizeof UNUSED / sizeof *UNUSED);
    return AG_OK;
}

static ag_status read_measured(pbrt_parser *parser, parameter_list *list, material *m)
{
    const char *ignored = NULL;
    (void)m;
    tell_stand_in(parser, list, "measured", "\"diffuse\" with a reflectance of 0.5");
    return parameter_get_string(list, parser->log, "filename", &ignored);
}

/* The parameters that tilt the shading normal, and turn the grain, which all kinds have. */

/* Reads a picture of directions, as 2 c - 1 of its colours; key: the parameter that has its name. */
static ag_status read_direction_map(pbrt_parser *parser, parameter_list *list, const char *key, const char *what,
                                    uint32_t *out_texture)
{
    const char *name = NULL;
    AG_TRY(parameter_get_string(list, parser->log, key, &name));
    if (!name || *name == '\0')
        return AG_OK;
    texture t = texture_make(TEXTURE_IMAGE);
    t.is_data = true;
    t.is_spectrum = true;
    AG_TRY(pbrt_load_image(parser, list, key, name, (image_encoding){.curve = IMAGE_CURVE_LINEAR}, &t));
    if (parser->scene->textures.images[t.image_index]->channel_count < 3)
        return pbrt_refuse(parser, list, key, "\"%s\" is no %s: it has no red, green and blue", name, what);
    return texture_set_add(&parser->scene->textures, &t, out_texture);
}

/* Reads the direction of "uroughness", which pbrt leaves at dp/du. */
static ag_status read_grain(pbrt_parser *parser, parameter_list *list, material *m)
{
    float degrees = 0.0f;
    AG_TRY(parameter_get_float(list, parser->log, "grain_rotation", &degrees));
    m->grain_turn = (float)remainder((double)degrees / 360.0, 1.0);
    return read_direction_map(parser, list, "grainmap", "map of directions", &m->grain_texture);
}

ag_status pbrt_read_maps(pbrt_parser *parser, parameter_list *list, material *m)
{
    float same_everywhere = 0.0f; /* which tilts nothing */
    AG_TRY(pbrt_get_float_texture(parser, list, "displacement", &same_everywhere, &m->displacement_texture));
    AG_TRY(read_direction_map(parser, list, "normalmap", "normal map", &m->normal_map_texture));
    AG_TRY(read_grain(parser, list, m));
    if (m->displacement_texture != SCENE_NO_TEXTURE && m->normal_map_texture != SCENE_NO_TEXTURE)
        log_at_once(parser->log, AG_LOG_WARNING, list->where, "both maps",
                    "of \"displacement\" and \"normalmap\" together only the latter is used");
    return AG_OK;
}

/* --- the table --- */

/* Reads nothing: an interface has no parameters. */
static ag_status read_interface(pbrt_parser *parser, parameter_list *list, material *m)
{
    (void)parser, (void)list, (void)m;
    return AG_OK;
}

static const pbrt_material_row ROWS[] = {
    {"diffuse", MATERIAL_DIFFUSE, read_diffuse},
    {"diffusetransmission", MATERIAL_DIFFUSE_TRANSMISSION, read_diffuse_transmission},
    {"conductor", MATERIAL_CONDUCTOR, read_conductor},
    {"dielectric", MATERIAL_DIELECTRIC, read_dielectric},
    {"thindielectric", MATERIAL_THIN_DIELECTRIC, read_thin_dielectric},
    {"coateddiffuse", MATERIAL_COATED_DIFFUSE, read_coated_diffuse},
    {"coatedconductor", MATERIAL_COATED_CONDUCTOR, read_coated_conductor},
    {"mix", MATERIAL_MIX, pbrt_read_mix},
    {"principled", MATERIAL_PRINCIPLED, pbrt_read_principled},
    {"interface", MATERIAL_INTERFACE, read_interface},
    {"none", MATERIAL_INTERFACE, read_interface},
    {"", MATERIAL_INTERFACE, read_interface},
    {"hair", MATERIAL_HAIR, read_hair},
    {"subsurface", MATERIAL_COATED_DIFFUSE, read_subsurface},
    {"measured", MATERIAL_DIFFUSE, read_measured},
};

const pbrt_material_row *pbrt_material_row_of(const char *name)
{
    for (size_t i = 0; i < sizeof ROWS / sizeof *ROWS; i++)
        if (strcmp(name, ROWS[i].name) == 0)
            return &ROWS[i];
    return NULL;
}
