/* option_guess.c: see option_guess.h.
 * Rests on: Damerau, "A technique for computer detection and correction of spelling errors", CACM 7(3), 1964: a letter
 * too many, too few, wrong, or two that changed places. */
#include "option_guess.h"

#include "option_rows.h"

#include <string.h>

/* Words of other programs (Arnold, Blender, Cycles, LuxCore, Mitsuba, pbrt, RenderMan), and ours for the same. */
static const char *const OTHERS[][2] = {
    {"aa-samples", "spp"},
    {"samples", "spp"},
    {"samples-per-pixel", "spp"},
    {"pixelsamples", "spp"},
    {"max-samples", "spp"},
    {"min-samples", "min-spp"},
    {"resolution", "size"},
    {"res", "size"},
    {"width", "size"},
    {"height", "size"},
    {"crop", "cropwindow"},
    {"region", "cropwindow"},
    {"output", "outfile"},
    {"out", "outfile"},
    {"file", "outfile"},
    {"threads", "nthreads"},
    {"num-threads", "nthreads"},
    {"jobs", "nthreads"},
    {"cores", "nthreads"},
    {"bounces", "max-depth"},
    {"max-bounces", "max-depth"},
    {"depth", "max-depth"},
    {"maxdepth", "max-depth"},
    {"threshold", "noise"},
    {"noise-threshold", "noise"},
    {"adaptive-threshold", "noise"},
    {"denoiser", "denoise"},
    {"frame", "frames"},
    {"frame-start", "frames"},
    {"start", "frames"},
    {"anim", "frames"},
    {"format", "type"},
    {"bit-depth", "type"},
    {"depth-bits", "type"},
    {"half", "type"},
    {"layers", "aov"},
    {"passes", "aov"},
    {"gamma", "view"},
    {"tonemap", "view"},
    {"ev", "exposure"},
    {"hdri", "sky"},
    {"envmap", "sky"},
    {"environment", "sky"},
    {"world", "sky"},
    {"sunlight", "sun"},
    {"timeout", "time-limit"},
    {"max-time", "time-limit"},
    {"clamp", "clamp-indirect"},
    {"statistics", "stats"},
    {"log-level", "verbose"},
    {"silent", "quiet"},
    {"overwrite", "no-clobber"},
    {"skip-existing", "no-clobber"},
    {"caustics", "caustic-photons"},
    {"gather", "gather-samples"},
    {"final-gather", "gather-samples"},
    {"method", "integrator"},
    {"engine", "integrator"},
};

enum { LENGTH_MAX = 40, FAR = 100 };

static int least(int a, int b) { return a < b ? a : b; }

/* Returns how many typing slips lie between two words. */
static int distance(const char *a, const char *b)
{
    const size_t length_a = strlen(a), length_b = strlen(b);
    int rows[LENGTH_MAX + 1][LENGTH_MAX + 1];
    if (length_a > LENGTH_MAX || length_b > LENGTH_MAX)
        return FAR;
    for (size_t i = 0; i <= length_a; i++)
        for (size_t k = 0; k <= length_b; k++) {
            if (i == 0 || k == 0) {
                rows[i][k] = (int)(i + k);
                continue;
            }
            rows[i][k] = least(least(rows[i - 1][k], rows[i][k - 1]) + 1, rows[i - 1][k - 1] + (a[i - 1] != b[k - 1]));
            if (i > 1 && k > 1 && a[i - 1] == b[k - 2] && a[i - 2] == b[k - 1])
                rows[i][k] = least(rows[i][k], rows[i - 2][k - 2] + 1);
        }
    return rows[length_a][length_b];
}

/* Keeps a word as the answer where fewer slips lead to it than to the best one so far. */
static void consider(const char *name, const char *word, const char *answer, int *in_out_nearest,
                     const char **in_out_best)
{
    const int slips = distance(name, word);
    if (slips < *in_out_nearest) {
        *in_out_nearest = slips;
        *in_out_best = answer;
    }
}

const char *option_guess(const char *name)
{
    const char *best = NULL;
    listed_option option;
    const size_t length = strlen(name);
    int nearest = length < 6 ? 2 : length < 8 ? 3 : 4; /* so many slips are too many: short words are near others */
    for (size_t i = 0; i < sizeof OTHERS / sizeof *OTHERS; i++)
        if (strcmp(name, OTHERS[i][0]) == 0)
            return OTHERS[i][1];
    for (size_t i = 0; option_at(i, &option); i++)
        consider(name, option.text->name, option.text->name, &nearest, &best);
    for (size_t i = 0; i < sizeof OTHERS / sizeof *OTHERS; i++)
        consider(name, OTHERS[i][0], OTHERS[i][1], &nearest, &best);
    return best;
}
