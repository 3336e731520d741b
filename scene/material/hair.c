/* hair.c: see hair.h. theta is the angle of a direction to the plane across the fibre, phi that about its axis; gamma
 * is the angle between normal and ray in the plane across. Threads: pure functions. */
#include "material/hair.h"

#include "material/fresnel.h"
#include "math/angle.h"
#include "math/exponential.h"
#include "math/sampling.h"

static const double TWO_PI = 6.28318530717958647693, HALF_TURN = 3.14159265358979323846;
/* Roughness below which scattering would hardly have a density. */
static const double BETA_MIN = 0.01;
/* The least reflectance of a channel, so that black absorbs finitely. */
static const float REFLECTANCE_MIN = 1e-4f;

static double square(double x) { return x * x; }

static double power(double x, int n)
{
    double product = 1.0;
    for (int i = 0; i < n; i++)
        product *= x;
    return product;
}

static double sine_to_cosine(double s) { return sqrt(double_max(1.0 - s * s, 0.0)); }

rgb hair_absorption_from_reflectance(rgb reflectance, float beta_n)
{
    double b = (double)beta_n, b2 = b * b;
    double fit = 5.969 - 0.215 * b + 2.532 * b2 - 10.73 * b2 * b + 5.574 * b2 * b2 + 0.245 * b2 * b2 * b;
    const float channels[3] = {reflectance.r, reflectance.g, reflectance.b};
    float sigma_a[3];
    for (int c = 0; c < 3; c++)
        sigma_a[c] = (float)square(natural_logarithm((double)float_clamp(channels[c], REFLECTANCE_MIN, 1.0f)) / fit);
    return rgb_make(sigma_a[0], sigma_a[1], sigma_a[2]);
}

/* --- a direction, and what becomes of light that comes or goes along it --- */

typedef struct inclination {
    double sine, cosine; /* of theta */
} inclination;

static inclination inclination_of(float sine)
{
    double s = double_clamp((double)sine, -1.0, 1.0);
    return (inclination){s, sine_to_cosine(s)};
}

/* The inclination that the peak of a lobe mirrors, tilted by the scales (Chiang 2016, 3). */
static inclination tilted(const hair_fibre *h, inclination o, int lobe)
{
    static const int ANGLE[HAIR_TILTED] = {1, 0, 2}; /* 2 alpha, alpha, 4 alpha */
    if (lobe >= HAIR_TILTED)
        return o;
    double s = h->sin_tilt[ANGLE[lobe]] * (lobe == 0 ? -1.0 : 1.0), c = h->cos_tilt[ANGLE[lobe]];
    return (inclination){o.sine * c + o.cosine * s, fabs(o.cosine * c - o.sine * s)};
}

/* An angle in (-pi, pi]. */
static double angle_of(double sine, double cosine)
{
    double turns = angle_turns(sine, cosine);
    return TWO_PI * (turns > 0.5 ? turns - 1.0 : turns);
}

/* The sine of the normal's angle to the ray, [-1, 1]. v grows to the axis' left as the ray comes, phi to its right. */
static double offset_of(float v) { return double_clamp(1.0 - 2.0 * (double)v, -1.0, 1.0); }

static hair_crossing crossing_of(const hair_point *p, double offset, inclination o)
{
    hair_crossing w;
    double ior = p->fibre->ior, cos_gamma = sine_to_cosine(offset);
    double bent =
        sqrt(double_max(1e-12, ior * ior - o.sine * o.sine)) / double_max(o.cosine, 1e-6); /* Marschner's eta' */
    double sin_inside = double_clamp(offset / bent, -1.0, 1.0), cos_inside = sine_to_cosine(sin_inside);
    double within = 2.0 * cos_inside / double_max(sine_to_cosine(o.sine / ior), 1e-6);
    const double sigma_a[3] = {(double)p->sigma_a.r, (double)p->sigma_a.g, (double)p->sigma_a.b};
    w.reflected = (double)fresnel_dielectric((float)double_min(o.cosine * cos_gamma, 1.0), (float)ior);
    w.gamma = angle_of(offset, cos_gamma);
    w.gamma_inside = angle_of(sin_inside, cos_inside);
    for (int c = 0; c < 3; c++)
        w.left[c] = exponential(-sigma_a[c] * within);
    return w;
}

/* The share of light that each lobe carries along one direction. */
typedef struct hair_shares {
    double of[HAIR_LOBES][3], mean[HAIR_LOBES];
} hair_shares;

static hair_shares shares_of(const hair_crossing *w)
{
    hair_shares shares;
    double f = w->reflected;
    for (int c = 0; c < 3; c++) {
        double t = w->left[c];
        shares.of[0][c] = f;
        shares.of[1][c] = square(1.0 - f) * t;
        shares.of[2][c] = shares.of[1][c] * t * f;
        shares.of[3][c] = shares.of[2][c] * f * t / double_max(1.0 - t * f, 1e-6);
    }
    for (int k = 0; k < HAIR_LOBES; k++)
        shares.mean[k] = (shares.of[k][0] + shares.of[k][1] + shares.of[k][2]) / 3.0;
    return shares;
}

/* How far from the direction's azimuth the lobe's middle is. sense: -1 for the opposite offset. */
static double turn_of(const hair_crossing *w, int lobe, double sense)
{
    return sense * (2.0 * lobe * w->gamma_inside - 2.0 * w->gamma) + lobe * HALF_TURN;
}

/* --- longitudinal scattering: its integral over cos(theta) dtheta is 1 --- */

/* I0(x) e^(-x), x >= 0, to 3e-7 (Abramowitz, Stegun, 9.8.1 and 9.8.2). */
static double bessel_i0_scaled(double x)
{
    if (x < 3.75) {
        double t = square(x / 3.75);
        double i0 = 1.0 + t * (3.5156229 +
                               t * (3.0899424 + t * (1.2067492 + t * (0.2659732 + t * (0.0360768 + t * 0.0045813)))));
        return i0 * exponential(-x);
    }
    double t = 3.75 / x;
    double tail = -0.02057706 + t * (0.02635537 + t * (-0.01647633 + t * 0.00392377));
    return (0.39894228 + t * (0.01328592 + t * (0.00225319 + t * (-0.00157565 + t * (0.00916281 + t * tail))))) /
           sqrt(x);
}

static double longitudinal(const hair_fibre *h, int lobe, inclination i, inclination o)
{
    double precision = h->precision[lobe], a = i.cosine * o.cosine * precision, b = i.sine * o.sine * precision;
    return bessel_i0_scaled(a) * exponential(a - b - precision) * h->norm[lobe];
}

/* The sine of a direction's inclination. */
static double sample_longitudinal(inclination o, double precision, vec2 u)
{
    double c =
        1.0 + natural_logarithm(double_max((double)u.x, 1e-10) + (1.0 - (double)u.x) * exponential(-2.0 * precision)) /
                  precision;
    float sin_turn, cos_turn;
    sincos_turns(u.y, &sin_turn, &cos_turn);
    return double_clamp(-c * o.sine + sine_to_cosine(c) * (double)cos_turn * o.cosine, -1.0, 1.0);
}

/* --- azimuthal scattering: its integral over phi is 1 --- */

static double azimuthal(const hair_fibre *h, double angle)
{
    double x = angle - TWO_PI * floor((angle + HALF_TURN) / TWO_PI), e = exponential(-fabs(x) / h->width);
    return e / square(1.0 + e) * h->width_norm;
}

static double sample_azimuthal(double u, double width)
{
    double end = exponential(-HALF_TURN / width), low = end / (1.0 + end), high = 1.0 / (1.0 + end);
    double p = double_clamp(low + (high - low) * u, 1e-12, 1.0 - 1e-12);
    return double_clamp(-width * natural_logarithm((1.0 - p) / p), -HALF_TURN, HALF_TURN);
}

/* --- all lobes together --- */

hair_fibre hair_fibre_make(float ior, float beta_m, float beta_n, float tilt_degrees)
{
    hair_fibre h = {.ior = (double)ior};
    double bm = double_max((double)beta_m, BETA_MIN), bn = double_max((double)beta_n, BETA_MIN);
    double variance = square(0.726 * bm + 0.812 * bm * bm + 3.7 * power(bm, 20));
    h.precision[0] = 1.0 / variance;
    h.precision[1] = 4.0 / variance;
    h.precision[2] = h.precision[3] = 0.25 / variance;
    for (int k = 0; k < HAIR_LOBES; k++)
        h.norm[k] = h.precision[k] / (1.0 - exponential(-2.0 * h.precision[k]));
    h.width = 0.62665706865775012560 * (0.265 * bn + 1.194 * bn * bn + 5.372 * power(bn, 22)); /* sqrt(pi / 8) */
    double end = exponential(-HALF_TURN / h.width);
    h.width_norm = (1.0 + end) / ((1.0 - end) * h.width);
    float s, c;
    sincos_turns(tilt_degrees / 360.0f, &s, &c);
    h.sin_tilt[0] = (double)s, h.cos_tilt[0] = (double)c;
    for (int k = 1; k < HAIR_TILTED; k++) {
        h.sin_tilt[k] = 2.0 * h.cos_tilt[k - 1] * h.sin_tilt[k - 1];
        h.cos_tilt[k] = square(h.cos_tilt[k - 1]) - square(h.sin_tilt[k - 1]);
    }
    return h;
}

hair_point hair_point_at(const hair_fibre *fibre, rgb sigma_a, float v, vec3 out)
{
    hair_point p = {.fibre = fibre, .sigma_a = sigma_a, .offset = v, .sine = out.x, .surface = HAIR_FACES_RAYS};
    p.azimuth = angle_of((double)out.z, (double)out.y);
    p.crossing = crossing_of(&p, offset_of(v), inclination_of(out.x));
    return p;
}

/* The lobes' values from o, whose crossing is of_o, to i, at the azimuth turn from it. sense: as in turn_of. */
static void lobe_values(const hair_fibre *h, const hair_crossing *of_o, inclination o, inclination i, double turn,
                        double sense, double out[HAIR_LOBES])
{
    for (int k = 0; k < HAIR_LOBES; k++) {
        double around = k < HAIR_TILTED ? azimuthal(h, turn - turn_of(of_o, k, sense)) : 1.0 / TWO_PI;
        out[k] = around > 0.0 ? around * longitudinal(h, k, i, tilted(h, o, k)) : 0.0;
    }
}

/* The offset at which flux that came at the point's own leaves, as its direction sees it. */
static double offset_left_at(const hair_point *p, bool is_same_side)
{
    double offset = offset_of(p->offset);
    switch (p->surface) {
    case HAIR_FACES_RAYS: return -offset; /* the one at which the way back is the way there */
    case HAIR_RIBBON: return is_same_side ? offset : -offset;
    case HAIR_OTHER: break;
    }
    return offset;
}

/* How often flux is sampled as if it left at the offset of its arrival, as the direction sees it, and not at the
 * opposite one: either may be the one of a ribbon's point, by the side that the direction turns out to be on. */
static double share_of_own_offset(const hair_point *p, bool is_flux)
{
    static const double SHARES[] = {[HAIR_FACES_RAYS] = 0.0, [HAIR_RIBBON] = 0.5, [HAIR_OTHER] = 1.0};
    return is_flux ? SHARES[p->surface] : 0.0;
}

void hair_evaluate(const hair_point *p, bool is_flux, bool is_same_side, vec3 direction, rgb *out_value, float *out_pdf)
{
    inclination o = inclination_of(p->sine), i = inclination_of(direction.x);
    double turn = angle_of((double)direction.z, (double)direction.y) - p->azimuth, values[HAIR_LOBES];
    double sum[3] = {0.0, 0.0, 0.0}, density = 0.0, all = 0.0, narrower = 1.0;
    hair_shares carried = shares_of(&p->crossing);
    for (int k = 0; k < HAIR_LOBES; k++)
        all += carried.mean[k];
    for (int own = 0; own < 2; own++) {
        double share = own ? share_of_own_offset(p, is_flux) : 1.0 - share_of_own_offset(p, is_flux);
        if (share > 0.0)
            lobe_values(p->fibre, &p->crossing, o, i, turn, own ? -1.0 : 1.0, values);
        for (int k = 0; share > 0.0 && k < HAIR_LOBES; k++)
            density += share * values[k] * carried.mean[k];
    }
    if (is_flux) {
        const hair_crossing of_eye = crossing_of(p, offset_left_at(p, is_same_side), i);
        carried = shares_of(&of_eye);
        lobe_values(p->fibre, &of_eye, i, o, -turn, 1.0, values);
        narrower = p->surface == HAIR_FACES_RAYS ? i.cosine / double_max(o.cosine, 1e-6) : 1.0;
    }
    for (int k = 0; k < HAIR_LOBES; k++)
        for (int c = 0; c < 3; c++)
            sum[c] += values[k] * carried.of[k][c] * narrower;
    *out_value = rgb_make((float)sum[0], (float)sum[1], (float)sum[2]);
    *out_pdf = (float)(density / all);
}

vec3 hair_sample(const hair_point *point, bool is_flux, float u_lobe, vec2 u)
{
    double all = 0.0, before = 0.0, p = 0.0, x = (double)u_lobe;
    int lobe = 0;
    const hair_fibre *h = point->fibre;
    const hair_shares shares = shares_of(&point->crossing);
    double own = share_of_own_offset(point, is_flux), sense = x < own ? -1.0 : 1.0;
    x = x < own ? x / own : (x - own) / (1.0 - own);
    for (int k = 0; k < HAIR_LOBES; k++)
        all += shares.mean[k];
    for (lobe = 0; lobe < HAIR_LOBES; lobe++) {
        p = shares.mean[lobe] / all;
        if (x < before + p || lobe == HAIR_LOBES - 1)
            break;
        before += p;
    }
    x = double_clamp((x - before) / double_max(p, 1e-12), 0.0, 0x1.fffffep-1);
    inclination o = inclination_of(point->sine);
    double sine = sample_longitudinal(tilted(h, o, lobe), h->precision[lobe], u), cosine = sine_to_cosine(sine);
    double turn = TWO_PI * x;
    if (lobe < HAIR_TILTED)
        turn = turn_of(&point->crossing, lobe, sense) + sample_azimuthal(x, h->width);
    turn = (turn + point->azimuth) / TWO_PI;
    float sin_turn, cos_turn;
    sincos_turns((float)(turn - floor(turn)), &sin_turn, &cos_turn);
    return (vec3){(float)sine, (float)cosine * cos_turn, (float)cosine * sin_turn};
}
