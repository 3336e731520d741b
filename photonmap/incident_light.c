/* incident_light.c: see incident_light.h. */
#include "incident_light.h"

#include "parallel_for.h"

#include <stdlib.h>
#include <string.h>

/* A cube's faces, by which normals are divided: a cell's word has a bit for each. */
enum { FACES = 6 };
/* The cells of a worker's turn. */
enum { CELLS_AT_ONCE = 16 };
/* The least number of photons of a histogram, and the number at which it has half of its largest weight. */
enum { LEAST = 8 };
static const float FEW = 64.0f;
/* The share of a bin's photons that counts in each of its four neighbours: a histogram of some hundred photons is
 * noise, mostly. */
static const float SPREAD = 0.5f;
/* Bound of a photon's flux, which keeps sums finite. */
static const float FLUX_MAX = 1e30f;

/* Returns the face of a cube that a normal points to, nearly: the borders lie a little beside a cube's own, where
 * surfaces are that are turned by just half a right angle, and photons' rounded normals would go to either side. */
static uint32_t face_of(vec3 normal)
{
    float x = 1.06f * fabsf(normal.x), y = 1.03f * fabsf(normal.y), z = fabsf(normal.z);
    if (x >= y && x >= z)
        return normal.x < 0.0f;
    if (y >= z)
        return 2 + (normal.y < 0.0f);
    return 4 + (normal.z < 0.0f);
}

/* Returns a frame around the normal. It turns little where the normal does, as long as the face is the same:
 * frame_from_z has a seam through four axes. */
static frame frame_around(vec3 normal, uint32_t face)
{
    static const vec3 axes[FACES / 2] = {{0.0f, 1.0f, 0.0f}, {0.0f, 0.0f, 1.0f}, {1.0f, 0.0f, 0.0f}};
    vec3 axis = axes[face / 2];
    vec3 x = vec3_normalize(vec3_add_scaled(axis, normal, -vec3_dot(axis, normal)));
    return (frame){x, vec3_cross(normal, x), normal};
}

/* The results that depend on a photon's normal alone, kept for the next photon, which often has the same one. */
typedef struct kept_normal {
    uint32_t code; /* of the normal; NORMAL_NONE: there was none */
    uint32_t face;
    frame around;
} kept_normal;
#define NORMAL_NONE UINT32_MAX

static void keep_normal(kept_normal *f, uint16_t code)
{
    if (f->code == code)
        return;
    vec3 normal = direction_decode(code);
    f->code = code;
    f->face = face_of(normal);
    f->around = frame_around(normal, f->face);
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

typedef struct job {
    incident_light *light;
    float share;
} job;

typedef struct visit_job {
    const incident_light *light;
    incident_photons_fn *fn;
    void *user;
} visit_job;

typedef struct range {
    uint32_t begin, end;
} range;

static range cell_photons(const incident_light *l, uint64_t cell)
{
    uint32_t shift = l->tree.depth - l->cell_depth;
    uint64_t first = (cell << shift) * PHOTON_BLOCK_LANES, end = ((cell + 1) << shift) * PHOTON_BLOCK_LANES;
    uint64_t count = l->tree.count;
    return (range){(uint32_t)(first < count ? first : count), (uint32_t)(end < count ? end : count)};
}

static uint16_t arrival_of(const incident_light *l, uint32_t i)
{
    return l->tree.blocks[i / PHOTON_BLOCK_LANES].direction[i % PHOTON_BLOCK_LANES];
}

static void find_faces(void *user, uint64_t begin, uint64_t end, uint64_t block, unsigned worker)
{
    (void)block, (void)worker;
    const job *j = user;
    kept_normal f = {.code = NORMAL_NONE};
    for (uint64_t cell = begin; cell < end; cell++) {
        range r = cell_photons(j->light, cell);
        uint32_t counts[FACES] = {0}, mask = 0;
        for (uint32_t i = r.begin; i < r.end; i++)
            if (arrival_is_diffuse(arrival_of(j->light, i))) {
                keep_normal(&f, photon_block_normal(j->light->tree.blocks, i));
                counts[f.face]++;
            }
        for (int w = 0; w < FACES; w++)
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

/* Makes a histogram of the photons' flux in each bin, which counts by that share, < 1: the even remainder makes every
 * bin wider than a step of its lower bound. */
static void make_histogram(const float flux[INCIDENT_BINS], float share, incident_histogram *out)
{
    float smooth[INCIDENT_BINS];
    double sum = 0.0, before = 0.0;
    spread(flux, smooth);
    for (int i = 0; i < INCIDENT_BINS; i++)
        sum += (double)smooth[i];
    for (int i = 0; i < INCIDENT_BINS; i++) {
        out->begins[i % INCIDENT_SIDE][i / INCIDENT_SIDE] = (uint16_t)(before * INCIDENT_ONE);
        double even = 1.0 / INCIDENT_BINS, told = sum > 0.0 ? (double)smooth[i] / sum : even;
        before += even + (double)share * (told - even);
    }
}

static void add_photon(const job *j, uint32_t photon_index, kept_normal *f, float flux[FACES][INCIDENT_BINS],
                       uint32_t counts[FACES])
{
    const photon_block *blocks = j->light->tree.blocks;
    uint16_t code = arrival_of(j->light, photon_index);
    if (!arrival_is_diffuse(code))
        return;
    keep_normal(f, photon_block_normal(blocks, photon_index));
    vec3 going = arrival_direction(code);
    vec2 u = square_from_disk(-vec3_dot(going, f->around.x), -vec3_dot(going, f->around.y));
    rgb carried = flux_decode(photon_block_flux(blocks, photon_index));
    flux[f->face][incident_guide_bin(u.x) * INCIDENT_SIDE + incident_guide_bin(u.y)] +=
        float_min(carried.r + carried.g + carried.b, FLUX_MAX);
    counts[f->face]++;
}

static void fill_cells(void *user, uint64_t begin, uint64_t end, uint64_t block, unsigned worker)
{
    (void)block, (void)worker;
    const job *j = user;
    kept_normal f = {.code = NORMAL_NONE};
    for (uint64_t cell = begin; cell < end; cell++) {
        range r = cell_photons(j->light, cell);
        uint32_t counts[FACES] = {0}, entry = j->light->cells[cell];
        float flux[FACES][INCIDENT_BINS];
        memset(flux, 0, sizeof flux);
        for (uint32_t i = r.begin; i < r.end; i++)
            add_photon(j, i, &f, flux, counts);
        incident_histogram *out = &j->light->histograms[entry >> FACES];
        for (int face = 0; face < FACES; face++)
            if (entry >> face & 1)
                make_histogram(flux[face], j->share * (float)counts[face] / ((float)counts[face] + FEW), out++);
    }
}

ag_status incident_light_create(run_context *run, const photon_tree *tree, float share, incident_light *out_light)
{
    *out_light = (incident_light){0};
    if (!(share > 0.0f) || tree->count == 0)
        return AG_OK;
    incident_light made = {.tree = *tree};
    made.cell_depth = made.tree.depth > INCIDENT_CELL_BLOCKS_LOG2 ? made.tree.depth - INCIDENT_CELL_BLOCKS_LOG2 : 0;
    uint32_t cell_count = 1u << made.cell_depth;
    made.cells = malloc(cell_count * sizeof *made.cells);
    if (!made.cells)
        return AG_ERROR_MEMORY;
    job j = {&made, share};
    ag_status status = parallel_for(run, cell_count, CELLS_AT_ONCE, find_faces, &j, AG_PHASE_MAP, 0.0, 0.0);
    for (uint32_t i = 0; i < cell_count && status == AG_OK; i++) {
        uint32_t faces = made.cells[i];
        made.cells[i] |= made.histogram_count << FACES;
        made.histogram_count += (uint32_t)__builtin_popcount(faces);
    }
    if (status == AG_OK &&
        !(made.histograms = large_alloc(((size_t)made.histogram_count + 1) * sizeof *made.histograms)))
        status = AG_ERROR_MEMORY;
    if (status == AG_OK)
        status = parallel_for(run, cell_count, CELLS_AT_ONCE, fill_cells, &j, AG_PHASE_MAP, 0.0, 0.0);
    if (status != AG_OK)
        incident_light_reset(&made);
    *out_light = made;
    return status;
}

static void visit_cells(void *user, uint64_t begin, uint64_t end, uint64_t block, unsigned worker)
{
    (void)block, (void)worker;
    const visit_job *j = user;
    uint32_t photons[FACES][INCIDENT_CELL_MAX];
    kept_normal f = {.code = NORMAL_NONE};
    for (uint64_t cell = begin; cell < end; cell++) {
        range r = cell_photons(j->light, cell);
        uint32_t counts[FACES] = {0}, entry = j->light->cells[cell], histogram = entry >> FACES;
        for (uint32_t i = r.begin; i < r.end; i++)
            if (arrival_is_diffuse(arrival_of(j->light, i))) {
                keep_normal(&f, photon_block_normal(j->light->tree.blocks, i));
                photons[f.face][counts[f.face]++] = i;
            }
        for (int face = 0; face < FACES; face++)
            if (entry >> face & 1)
                j->fn(j->user, histogram++, photons[face], counts[face]);
    }
}

ag_status incident_light_visit(run_context *run, const incident_light *l, incident_photons_fn *fn, void *user)
{
    visit_job j = {l, fn, user};
    uint32_t cells = l->cells ? 1u << l->cell_depth : 0;
    return parallel_for(run, cells, CELLS_AT_ONCE, visit_cells, &j, AG_PHASE_MAP, 0.0, 0.0);
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
    const float at[PHOTON_TREE_AXES] = {position.x, position.y, position.z};
    uint32_t base = (1u << l->cell_depth) - 1, node = 0, face = face_of(normal);
    while (node < base) {
        photon_tree_node n = photon_tree_node_at(&l->tree, node);
        node = 2 * node + 1 + (at[n.axis] >= n.split);
    }
    uint32_t entry = l->cells[node - base];
    if (!(entry >> face & 1))
        return false;
    uint32_t before = (uint32_t)__builtin_popcount(entry & ((1u << face) - 1));
    *out_guide = (incident_guide){frame_around(normal, face), &l->histograms[(entry >> FACES) + before]};
    return true;
}
