/* incident_light.c: see incident_light.h. */
#include "incident_light.h"

#include "math/sampling.h"
#include "parallel_for.h"

#include <stdlib.h>
#include <string.h>

/* The bits of a cell's word that tell which ways there are; the blocks of a cell; and the cells of a worker's turn. */
enum { WAYS = 6, BLOCKS_LOG2 = 5, CELLS_AT_ONCE = 16 };
/* A histogram takes so many photons; one of `FEW` decides half as much as one of very many would. */
enum { LEAST = 8 };
static const float FEW = 64.0f;
/* What a bin's photons count in each of its four neighbours: a histogram of some hundred photons is noise, mostly. */
static const float SPREAD = 0.5f;
/* So that sums stay finite. */
static const float FLUX_MAX = 1e30f;

/* The axis that a normal is nearest to, and on which side; the borders lie a little beside those of a cube, where
 * surfaces are that are turned by just half a right angle, and photons' rounded normals would go either way. */
static uint32_t way_of(vec3 normal)
{
    float x = 1.06f * fabsf(normal.x), y = 1.03f * fabsf(normal.y), z = fabsf(normal.z);
    if (x >= y && x >= z)
        return normal.x < 0.0f;
    if (y >= z)
        return 2 + (normal.y < 0.0f);
    return 4 + (normal.z < 0.0f);
}

/* Turns little where the normal does, as long as the way is the same: frame_from_z has a seam through four axes. */
static frame frame_around(vec3 normal, uint32_t way)
{
    static const vec3 axes[WAYS / 2] = {{0.0f, 1.0f, 0.0f}, {0.0f, 0.0f, 1.0f}, {1.0f, 0.0f, 0.0f}};
    vec3 axis = axes[way / 2];
    vec3 x = vec3_normalize(vec3_add_scaled(axis, normal, -vec3_dot(axis, normal)));
    return (frame){x, vec3_cross(normal, x), normal};
}

/* A photon's normal, kept for the next photon, which often has the same one. */
typedef struct facing {
    uint32_t code; /* FACING_NONE: there was none */
    uint32_t way;
    frame around;
} facing;
#define FACING_NONE UINT32_MAX

static void face(facing *f, uint16_t code)
{
    if (f->code == code)
        return;
    vec3 normal = direction_decode(code);
    f->code = code;
    f->way = way_of(normal);
    f->around = frame_around(normal, f->way);
}

/* The inverse of sample_disk_concentric, nearly: which bin a photon counts in need not be right to the edge. */
static vec2 square_from_disk(float x, float y)
{
    bool is_wide = fabsf(x) > fabsf(y);
    float wide = is_wide ? x : y, r = copysignf(sqrtf(x * x + y * y), wide);
    float t = wide != 0.0f ? (is_wide ? y : x) / wide : 0.0f;
    float other = r * t * (1.0f + 0.3476f * (1.0f - fabsf(t))); /* r times atan(t) / (pi / 4), within 0.5 % of r */
    vec2 u = is_wide ? (vec2){r, other} : (vec2){other, r};
    return (vec2){0.5f + 0.5f * u.x, 0.5f + 0.5f * u.y};
}

static uint32_t bin_at(float u)
{
    int i = (int)(u * INCIDENT_SIDE);
    return (uint32_t)(i < 0 ? 0 : i >= INCIDENT_SIDE ? INCIDENT_SIDE - 1 : i);
}

typedef struct job {
    const photon_map *map;
    incident_light *light;
    float share;
} job;

typedef struct range {
    uint32_t begin, end;
} range;

static range cell_photons(const job *j, uint64_t cell)
{
    uint32_t shift = j->light->tree.depth - j->light->cell_depth;
    uint64_t first = (cell << shift) * PHOTON_BLOCK_LANES, end = ((cell + 1) << shift) * PHOTON_BLOCK_LANES;
    uint64_t count = j->light->tree.count;
    return (range){(uint32_t)(first < count ? first : count), (uint32_t)(end < count ? end : count)};
}

static uint16_t arrival_of(const job *j, uint32_t i)
{
    return j->map->blocks[i / PHOTON_BLOCK_LANES].direction[i % PHOTON_BLOCK_LANES];
}

static void find_ways(void *user, uint64_t begin, uint64_t end, uint64_t block, unsigned worker)
{
    (void)block, (void)worker;
    const job *j = user;
    facing f = {.code = FACING_NONE};
    for (uint64_t cell = begin; cell < end; cell++) {
        range r = cell_photons(j, cell);
        uint32_t counts[WAYS] = {0}, mask = 0;
        for (uint32_t i = r.begin; i < r.end; i++)
            if (arrival_is_diffuse(arrival_of(j, i))) {
                face(&f, photon_block_normal(j->map->blocks, i));
                counts[f.way]++;
            }
        for (int w = 0; w < WAYS; w++)
            mask |= (uint32_t)(counts[w] >= LEAST) << w;
        j->light->cells[cell] = mask;
    }
}

/* Each bin with its neighbours; what lies beyond the square counts as the bin itself. */
static void spread(const float flux[INCIDENT_BINS], float out_flux[INCIDENT_BINS])
{
    const int last = INCIDENT_SIDE - 1;
    for (int row = 0; row <= last; row++)
        for (int column = 0; column <= last; column++) {
            const float *at = &flux[row * INCIDENT_SIDE + column];
            float beside = at[row > 0 ? -INCIDENT_SIDE : 0] + at[row < last ? INCIDENT_SIDE : 0] +
                           at[column > 0 ? -1 : 0] + at[column < last ? 1 : 0];
            out_flux[row * INCIDENT_SIDE + column] = at[0] + SPREAD * beside;
        }
}

/* share < 1: what is left makes every bin wider than a step of its beginning. */
static void finish(const float flux[INCIDENT_BINS], float share, incident_histogram *out)
{
    float smooth[INCIDENT_BINS];
    double sum = 0.0, before = 0.0;
    spread(flux, smooth);
    for (int i = 0; i < INCIDENT_BINS; i++)
        sum += (double)smooth[i];
    for (int i = 0; i < INCIDENT_BINS; i++) {
        out->begins[i] = (uint16_t)(before * INCIDENT_ONE);
        double even = 1.0 / INCIDENT_BINS, told = sum > 0.0 ? (double)smooth[i] / sum : even;
        before += even + (double)share * (told - even);
    }
}

static void count_in(const job *j, uint32_t photon_index, facing *f, float flux[WAYS][INCIDENT_BINS],
                     uint32_t counts[WAYS])
{
    const photon_block *blocks = j->map->blocks;
    uint16_t code = arrival_of(j, photon_index);
    if (!arrival_is_diffuse(code))
        return;
    face(f, photon_block_normal(blocks, photon_index));
    vec3 going = arrival_direction(code);
    vec2 u = square_from_disk(-vec3_dot(going, f->around.x), -vec3_dot(going, f->around.y));
    rgb carried = flux_decode(photon_block_flux(blocks, photon_index));
    flux[f->way][bin_at(u.x) * INCIDENT_SIDE + bin_at(u.y)] += fminf(carried.r + carried.g + carried.b, FLUX_MAX);
    counts[f->way]++;
}

static void fill(void *user, uint64_t begin, uint64_t end, uint64_t block, unsigned worker)
{
    (void)block, (void)worker;
    const job *j = user;
    facing f = {.code = FACING_NONE};
    for (uint64_t cell = begin; cell < end; cell++) {
        range r = cell_photons(j, cell);
        uint32_t counts[WAYS] = {0}, entry = j->light->cells[cell];
        float flux[WAYS][INCIDENT_BINS];
        memset(flux, 0, sizeof flux);
        for (uint32_t i = r.begin; i < r.end; i++)
            count_in(j, i, &f, flux, counts);
        incident_histogram *out = &j->light->histograms[entry >> WAYS];
        for (int way = 0; way < WAYS; way++)
            if (entry >> way & 1)
                finish(flux[way], j->share * (float)counts[way] / ((float)counts[way] + FEW), out++);
    }
}

ag_status incident_light_create(run_context *run, const photon_map *map, float share, incident_light *out_light)
{
    *out_light = (incident_light){0};
    if (!(share > 0.0f) || map->tree.count == 0)
        return AG_OK;
    incident_light made = {.tree = map->tree};
    made.cell_depth = made.tree.depth > BLOCKS_LOG2 ? made.tree.depth - BLOCKS_LOG2 : 0;
    uint32_t cell_count = 1u << made.cell_depth;
    made.cells = malloc(cell_count * sizeof *made.cells);
    if (!made.cells)
        return AG_ERROR_MEMORY;
    job j = {map, &made, share};
    ag_status status = parallel_for(run, cell_count, CELLS_AT_ONCE, find_ways, &j, AG_PHASE_MAP, 0.0, 0.0);
    for (uint32_t i = 0; i < cell_count && status == AG_OK; i++) {
        uint32_t ways = made.cells[i];
        made.cells[i] |= made.histogram_count << WAYS;
        made.histogram_count += (uint32_t)__builtin_popcount(ways);
    }
    if (status == AG_OK &&
        !(made.histograms = large_alloc(((size_t)made.histogram_count + 1) * sizeof *made.histograms)))
        status = AG_ERROR_MEMORY;
    if (status == AG_OK)
        status = parallel_for(run, cell_count, CELLS_AT_ONCE, fill, &j, AG_PHASE_MAP, 0.0, 0.0);
    if (status != AG_OK)
        incident_light_reset(&made);
    *out_light = made;
    return status;
}

void incident_light_reset(incident_light *l)
{
    free(l->cells);
    free(l->histograms);
    *l = (incident_light){0};
}

uint64_t incident_light_bytes(const incident_light *l)
{
    uint64_t cells = l->cells ? (uint64_t)1 << l->cell_depth : 0;
    return cells * sizeof *l->cells + l->histogram_count * sizeof *l->histograms;
}

bool incident_light_find(const incident_light *l, vec3 position, vec3 normal, incident_guide *out_guide)
{
    if (!l->cells)
        return false;
    const float at[3] = {position.x, position.y, position.z};
    uint32_t base = (1u << l->cell_depth) - 1, node = 0, way = way_of(normal);
    while (node < base) {
        photon_tree_node n = l->tree.nodes[node];
        node = 2 * node + 1 + (at[n.axis] >= n.split);
    }
    uint32_t entry = l->cells[node - base];
    if (!(entry >> way & 1))
        return false;
    uint32_t before = (uint32_t)__builtin_popcount(entry & ((1u << way) - 1));
    *out_guide = (incident_guide){frame_around(normal, way), &l->histograms[(entry >> WAYS) + before]};
    return true;
}

static uint32_t end_of(const incident_histogram *h, uint32_t bin)
{
    return bin + 1 < INCIDENT_BINS ? h->begins[bin + 1] : INCIDENT_ONE;
}

float incident_guide_warp(const incident_guide *guide, vec2 *in_out_u)
{
    const incident_histogram *h = guide->histogram;
    float x = in_out_u->x * INCIDENT_ONE;
    uint32_t whole = (uint32_t)x, row = 0, column = 0;
    for (uint32_t i = 1; i < INCIDENT_SIDE; i++)
        row += h->begins[i * INCIDENT_SIDE] <= whole;
    const uint16_t *begins = &h->begins[row * INCIDENT_SIDE];
    float low = begins[0], high = (float)end_of(h, row * INCIDENT_SIDE + INCIDENT_SIDE - 1);
    float y = low + in_out_u->y * (high - low);
    whole = (uint32_t)y;
    for (uint32_t i = 1; i < INCIDENT_SIDE; i++)
        column += begins[i] <= whole;
    float bin_low = begins[column], bin_high = (float)end_of(h, row * INCIDENT_SIDE + column);
    const float step = 1.0f / INCIDENT_SIDE, last = 0x1.fffffep-1f;
    in_out_u->x = fminf(((float)row + (x - low) / (high - low)) * step, last);
    in_out_u->y = fminf(((float)column + (y - bin_low) / (bin_high - bin_low)) * step, last);
    return (float)(INCIDENT_ONE / INCIDENT_BINS) / (bin_high - bin_low);
}
