/* direct_guide.c: see direct_guide.h. */
#include "integrator/direct_guide.h"

#include "light/light_tree.h"

#include <stdlib.h>

bool direct_guide_serves(const scene *s)
{
    if (s->everywhere_count == 0 || s->everywhere_count >= DIRECT_GUIDE_SHARES_MAX)
        return false;
    return s->lit_count > 1 || light_has_direction_numbers(&s->lights[s->only_light]);
}

/* --- cells --- */

/* The tree of the points whose surfaces face that way: by the axis nearest to the normal and its sign; the last one
 * where light from all sides counts. */
static uint32_t tree_of_normal(vec3 n)
{
    float x = fabsf(n.x), y = fabsf(n.y), z = fabsf(n.z);
    if (!(x > 0.0f || y > 0.0f || z > 0.0f))
        return DIRECT_GUIDE_TREES - 1;
    if (x >= y && x >= z)
        return n.x < 0.0f;
    return y >= z ? 2 + (n.y < 0.0f) : 4 + (n.z < 0.0f);
}

static float along(vec3 p, uint32_t axis) { return axis == 0 ? p.x : axis == 1 ? p.y : p.z; }

typedef struct sorted_point {
    float at;
    uint32_t index;
} sorted_point;

static int compare(const void *a, const void *b)
{
    const sorted_point *p = a, *q = b;
    if (p->at != q->at)
        return p->at < q->at ? -1 : 1;
    return (p->index > q->index) - (p->index < q->index);
}

typedef struct cell_maker {
    const vec3 *positions;
    uint32_t *order;
    sorted_point *sorted;
    direct_guide *g;
} cell_maker;

/* Makes the node of points [begin, begin + count) of the order, which are sorted by cells. Returns its index. */
static uint32_t make_node(cell_maker *m, uint32_t begin, uint32_t count)
{
    direct_guide *g = m->g;
    uint32_t made = g->node_count++, *order = m->order + begin;
    vec3 low = m->positions[order[0]], high = low;
    for (uint32_t i = 1; i < count; i++) {
        low = vec3_min(low, m->positions[order[i]]);
        high = vec3_max(high, m->positions[order[i]]);
    }
    vec3 size = vec3_sub(high, low);
    uint32_t axis = size.y > size.x ? 1 : 0;
    axis = size.z > along(size, axis) ? 2 : axis;
    if (count <= DIRECT_GUIDE_CELL_POINTS || !(along(size, axis) > 0.0f)) {
        bool is_enough = count >= DIRECT_GUIDE_CELL_POINTS_MIN;
        g->nodes[made] = (direct_guide_node){0.0f, 3, is_enough ? g->cell_count : DIRECT_GUIDE_NO_CELL};
        if (is_enough)
            g->cells[g->cell_count++] = (direct_guide_cell){begin, count};
        return made;
    }
    for (uint32_t i = 0; i < count; i++)
        m->sorted[i] = (sorted_point){along(m->positions[order[i]], axis), order[i]};
    qsort(m->sorted, count, sizeof *m->sorted, compare);
    for (uint32_t i = 0; i < count; i++)
        order[i] = m->sorted[i].index;
    float at = m->sorted[count / 2].at;
    make_node(m, begin, count / 2);
    uint32_t other = make_node(m, begin + count / 2, count - count / 2);
    g->nodes[made] = (direct_guide_node){at, axis, other};
    return made;
}

static void count_shares(const scene *s, direct_guide *g)
{
    g->share_count = s->everywhere_count + (s->light_tree != NULL);
    for (uint32_t i = 0; i < s->everywhere_count; i++)
        g->histogram_count += light_has_direction_numbers(&s->lights[s->everywhere_lights[i]]);
    for (uint32_t i = 0, next = 0; i <= s->everywhere_count; i++) {
        bool has = i < s->everywhere_count && light_has_direction_numbers(&s->lights[s->everywhere_lights[i]]);
        g->histogram_of[i] = has ? next++ : g->histogram_count;
    }
}

ag_status direct_guide_create(const scene *s, const vec3 *positions, const vec3 *normals, uint32_t count,
                              uint32_t *out_order, direct_guide *out_guide)
{
    direct_guide g = {0};
    count_shares(s, &g);
    size_t some = (size_t)count + 1;
    g.nodes = malloc(2 * some * sizeof *g.nodes);
    g.cells = malloc(some * sizeof *g.cells);
    cell_maker m = {positions, out_order, malloc(some * sizeof *m.sorted), &g};
    bool is_whole = g.nodes && g.cells && m.sorted;
    uint32_t begin = 0;
    for (uint32_t tree = 0; is_whole && tree < DIRECT_GUIDE_TREES; tree++) {
        uint32_t end = begin;
        for (uint32_t i = 0; i < count; i++)
            if (tree_of_normal(normals[i]) == tree)
                out_order[end++] = i;
        g.roots[tree] = end > begin ? make_node(&m, begin, end - begin) : DIRECT_GUIDE_NO_CELL;
        begin = end;
    }
    free(m.sorted);
    g.shares = calloc(((size_t)g.cell_count + 1) * g.share_count, sizeof *g.shares);
    g.histograms = malloc(((size_t)g.cell_count * g.histogram_count + 1) * sizeof *g.histograms);
    *out_guide = g;
    if (is_whole && g.shares && g.histograms)
        return AG_OK;
    direct_guide_reset(out_guide);
    return AG_ERROR_MEMORY;
}

void direct_guide_reset(direct_guide *g)
{
    free(g->nodes);
    free(g->cells);
    free(g->shares);
    free(g->histograms);
    *g = (direct_guide){0};
}

/* --- what was seen --- */

/* Finds where each bin begins, in units of 1 / DIRECT_GUIDE_ONE. Rounding loses no bin: with a guided share of 0.8 at
 * most, DIRECT_GUIDE_SHARES_MAX shares at most, and light that is blurred over two rows at least, the narrowest one is
 * 1.6 units wide. */
static void find_begins(const double *weights, double whole, uint16_t *out_begins)
{
    double sum = 0.0;
    for (int i = 0; i < DIRECT_GUIDE_SIDE; i++) {
        out_begins[i] = (uint16_t)(sum / whole * DIRECT_GUIDE_ONE + 0.5);
        sum += weights[i];
    }
}

/* Makes the histogram of what was seen. even: the share of each bin's density that does not depend on that. */
static void fill_histogram(direct_histogram *h, const direct_bins *seen, double even)
{
    double total = 0.0, rows[DIRECT_GUIDE_SIDE], all = 0.0;
    for (int y = 0; y < DIRECT_GUIDE_SIDE; y++)
        for (int x = 0; x < DIRECT_GUIDE_SIDE; x++)
            total += (double)seen->of[y][x];
    double scale = total > 0.0 ? (1.0 - even) * DIRECT_GUIDE_SIDE * DIRECT_GUIDE_SIDE / total : 0.0;
    for (int y = 0; y < DIRECT_GUIDE_SIDE; y++) {
        double weights[DIRECT_GUIDE_SIDE];
        rows[y] = 0.0;
        for (int x = 0; x < DIRECT_GUIDE_SIDE; x++) {
            weights[x] = (total > 0.0 ? even : 1.0) + scale * (double)seen->of[y][x];
            rows[y] += weights[x];
        }
        find_begins(weights, rows[y], h->columns[y]);
        all += rows[y];
    }
    find_begins(rows, all, h->rows);
}

void direct_guide_fill(direct_guide *g, uint32_t cell, float guided_share, const float *brought,
                       const direct_bins *seen)
{
    double total = 0.0, equal = (1.0 - (double)guided_share) / g->share_count;
    float *shares = g->shares + (size_t)cell * g->share_count;
    for (uint32_t i = 0; i < g->share_count; i++)
        total += (double)brought[i];
    if (!(total > 0.0 && isfinite(total)))
        return;
    for (uint32_t i = 0; i < g->share_count; i++) {
        double learned = (double)guided_share * (double)brought[i] / total;
        uint32_t histogram = g->histogram_of[i];
        shares[i] = (float)(equal + learned);
        if (histogram < g->histogram_count)
            fill_histogram(&g->histograms[(size_t)cell * g->histogram_count + histogram], &seen[histogram],
                           equal / (equal + learned));
    }
}

/* --- asking --- */

uint32_t direct_guide_find(const direct_guide *g, vec3 point, vec3 normal)
{
    if (!g)
        return DIRECT_GUIDE_NO_CELL;
    uint32_t at = g->roots[tree_of_normal(normal)];
    if (at == DIRECT_GUIDE_NO_CELL)
        return at;
    const direct_guide_node *node = &g->nodes[at];
    while (node->axis < 3)
        node = along(point, node->axis) < node->at ? node + 1 : &g->nodes[node->other];
    uint32_t cell = node->other;
    return cell != DIRECT_GUIDE_NO_CELL && g->shares[(size_t)cell * g->share_count] > 0.0f ? cell
                                                                                           : DIRECT_GUIDE_NO_CELL;
}

/* The index of a light's share in a cell; all lamps share the last one. */
static uint32_t share_of(const scene *s, uint32_t light_index)
{
    uint32_t i = 0;
    while (i < s->everywhere_count && s->everywhere_lights[i] != light_index)
        i++;
    return i;
}

uint32_t direct_guide_pick(const direct_guide *g, const scene *s, uint32_t cell, vec3 point, vec3 normal, float u,
                           float *out_probability)
{
    const float *shares = g->shares + (size_t)cell * g->share_count;
    for (uint32_t i = 0; i < s->everywhere_count; i++) {
        if (u < shares[i] || (!s->light_tree && i + 1 == s->everywhere_count)) {
            *out_probability = shares[i];
            return s->everywhere_lights[i];
        }
        u -= shares[i];
    }
    float share = shares[s->everywhere_count];
    uint32_t lamp = light_tree_pick(s->light_tree, point, normal, float_below_one(u / share), out_probability);
    *out_probability *= share;
    return lamp;
}

float direct_guide_probability(const direct_guide *g, const scene *s, uint32_t cell, uint32_t light_index, vec3 point,
                               vec3 normal)
{
    const light *l = &s->lights[light_index];
    if (!(l->power.r + l->power.g + l->power.b > 0.0f))
        return 0.0f;
    uint32_t i = share_of(s, light_index);
    float share = g->shares[(size_t)cell * g->share_count + i];
    if (i < s->everywhere_count)
        return share;
    return share * light_tree_probability(s->light_tree, light_index, point, normal);
}

static const direct_histogram *find_histogram(const direct_guide *g, const scene *s, uint32_t cell,
                                              uint32_t light_index)
{
    uint32_t histogram = g->histogram_of[share_of(s, light_index)];
    return histogram == g->histogram_count ? NULL : &g->histograms[(size_t)cell * g->histogram_count + histogram];
}

static float width_of(const uint16_t *begins, uint32_t i)
{
    return (float)((i + 1 < DIRECT_GUIDE_SIDE ? begins[i + 1] : (uint32_t)DIRECT_GUIDE_ONE) - begins[i]);
}

/* The bin that u falls into. *in_out_u becomes the coordinate in a row of bins of equal width. */
static uint32_t warp(const uint16_t *begins, float *in_out_u)
{
    float scaled = *in_out_u * DIRECT_GUIDE_ONE;
    uint32_t low = 0;
    for (uint32_t step = DIRECT_GUIDE_SIDE / 2; step > 0; step /= 2)
        low += (float)begins[low + step] <= scaled ? step : 0;
    float within = float_below_one((scaled - (float)begins[low]) / width_of(begins, low));
    *in_out_u = float_below_one(((float)low + within) / DIRECT_GUIDE_SIDE);
    return low;
}

/* The density of the random numbers in a bin. */
static float density_of(const direct_histogram *h, uint32_t row, uint32_t column)
{
    const float even = (float)DIRECT_GUIDE_SIDE / DIRECT_GUIDE_ONE;
    return even * width_of(h->rows, row) * (even * width_of(h->columns[row], column));
}

float direct_guide_warp(const direct_guide *g, const scene *s, uint32_t cell, uint32_t light_index, vec2 *in_out_u)
{
    const direct_histogram *h = find_histogram(g, s, cell, light_index);
    if (!h)
        return 1.0f;
    uint32_t row = warp(h->rows, &in_out_u->y), column = warp(h->columns[row], &in_out_u->x);
    return density_of(h, row, column);
}

float direct_guide_density(const direct_guide *g, const scene *s, uint32_t cell, uint32_t light_index, vec3 direction)
{
    const direct_histogram *h = find_histogram(g, s, cell, light_index);
    vec2 u;
    if (!h || !light_direction_numbers(&s->lights[light_index], direction, &u))
        return 1.0f;
    uint32_t column = (uint32_t)(u.x * DIRECT_GUIDE_SIDE), row = (uint32_t)(u.y * DIRECT_GUIDE_SIDE);
    return density_of(h, row, column);
}
