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
/* Of a colour's channel, so that black absorbs finitely. */
static const float REFLECTANCE_MIN = 1e-4f;

static double square(double x) { return x * x; }

static double power(double x, int n)
{
    double product = 1.0;
    for (int i = 0; i < n; i++)
        product *= x;
    return product;
}

static double sine_to_cosine(double s) { return sqrt(fmax(0.0, 1.0 - s * s)); }

rgb hair_absorption_from_reflectance(rgb reflectance, float beta_n)
{
    double b = (double)beta_n, b2 = b * b;
    double fit = 5.969 - 0.215 * b + 2.532 * b2 - 10.73 * b2 * b + 5.574 * b2 * b2 + 0.245 * b2 * b2 * b;
    const float channels[3] = {reflectance.r, reflectance.g, reflectance.b};
    float sigma_a[3];
    for (int c = 0; c < 3; c++)
        sigma_a[c] = (float)square(natural_logarithm((double)fminf(fmaxf(channels[c], REFLECTANCE_MIN), 1.0f)) / fit);
    return rgb_make(sigma_a[0], sigma_a[1], sigma_a[2]);
}

hair_fibre hair_fibre_at(const material *m, float v)
{
    hair_fibre h = {.ior = (double)m->ior,
                    .sigma_a = {(double)m->hair_sigma_a.r, (double)m->hair_sigma_a.g, (double)m->hair_sigma_a.b}};
    double bm = fmax((double)m->hair_beta_m, BETA_MIN), bn = fmax((double)m->hair_beta_n, BETA_MIN);
    /* v grows to the axis' left as the ray comes, phi to its right */
    h.offset = fmin(fmax(1.0 - 2.0 * (double)v, -1.0), 1.0);
    h.variance[0] = square(0.726 * bm + 0.812 * bm * bm + 3.7 * power(bm, 20));
    h.variance[1] = 0.25 * h.variance[0];
    h.variance[2] = h.variance[3] = 4.0 * h.variance[0];
    h.width = 0.62665706865775012560 * (0.265 * bn + 1.194 * bn * bn + 5.372 * power(bn, 22)); /* sqrt(pi / 8) */
    float s, c;
    sincos_turns(m->hair_tilt_degrees / 360.0f, &s, &c);
    h.sin_tilt[0] = (double)s, h.cos_tilt[0] = (double)c;
    for (int k = 1; k < HAIR_TILTED; k++) {
        h.sin_tilt[k] = 2.0 * h.cos_tilt[k - 1] * h.sin_tilt[k - 1];
        h.cos_tilt[k] = square(h.cos_tilt[k - 1]) - square(h.sin_tilt[k - 1]);
    }
    return h;
}

/* --- a direction, and what becomes of light that comes or goes along it --- */

typedef struct inclination {
    double sine, cosine; /* of theta */
} inclination;

static inclination inclination_of(vec3 d)
{
    double s = fmin(fmax((double)d.x, -1.0), 1.0);
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

/* What each lobe carries, and the azimuth of its middle. */
typedef struct fibre_lobes {
    double share[HAIR_LOBES][3], mean[HAIR_LOBES];
    double turn[HAIR_TILTED];
} fibre_lobes;

static fibre_lobes lobes_of(const hair_fibre *h, inclination o)
{
    fibre_lobes w;
    double cos_gamma = sine_to_cosine(h->offset);
    double bent = sqrt(fmax(1e-12, h->ior * h->ior - o.sine * o.sine)) / fmax(o.cosine, 1e-6); /* Marschner's eta' */
    double sin_inside = fmin(fmax(h->offset / bent, -1.0), 1.0), cos_inside = sine_to_cosine(sin_inside);
    double within = 2.0 * cos_inside / fmax(sine_to_cosine(o.sine / h->ior), 1e-6);
    double f = (double)fresnel_dielectric((float)fmin(o.cosine * cos_gamma, 1.0), (float)h->ior);
    double gamma = angle_of(h->offset, cos_gamma), gamma_inside = angle_of(sin_inside, cos_inside);
    for (int k = 0; k < HAIR_TILTED; k++)
        w.turn[k] = 2.0 * k * gamma_inside - 2.0 * gamma + k * HALF_TURN;
    for (int c = 0; c < 3; c++) {
        double t = exponential(-h->sigma_a[c] * within);
        w.share[0][c] = f;
        w.share[1][c] = square(1.0 - f) * t;
        w.share[2][c] = w.share[1][c] * t * f;
        w.share[3][c] = w.share[2][c] * f * t / fmax(1.0 - t * f, 1e-6);
    }
    for (int k = 0; k < HAIR_LOBES; k++)
        w.mean[k] = (w.share[k][0] + w.share[k][1] + w.share[k][2]) / 3.0;
    return w;
}

/* --- longitudinal scattering: its integral over cos(theta) dtheta is 1 --- */

/* Abramowitz, Stegun, 9.6.12 and 9.7.1, times e^(-x). */
static double bessel_i0_scaled(double x)
{
    if (x > 12.0) {
        double y = 1.0 / (8.0 * x);
        return (1.0 + y * (1.0 + y * (4.5 + y * 37.5))) / sqrt(TWO_PI * x);
    }
    double q = 0.25 * x * x, term = 1.0, sum = 1.0;
    for (int k = 1; k <= 32 && term > 1e-10 * sum; k++) {
        term *= q / (k * k);
        sum += term;
    }
    return sum * exponential(-x);
}

static double longitudinal(inclination i, inclination o, double variance)
{
    double inverse = 1.0 / variance, a = i.cosine * o.cosine * inverse, b = i.sine * o.sine * inverse;
    return bessel_i0_scaled(a) * exponential(a - b - inverse) * inverse / (1.0 - exponential(-2.0 * inverse));
}

static vec3 sample_longitudinal(inclination o, double variance, vec2 u, double *out_cosine)
{
    double c = 1.0 + variance * natural_logarithm(fmax((double)u.x, 1e-10) +
                                                  (1.0 - (double)u.x) * exponential(-2.0 / variance));
    double s = sine_to_cosine(c);
    float sin_turn, cos_turn;
    sincos_turns(u.y, &sin_turn, &cos_turn);
    double sine = fmin(fmax(-c * o.sine + s * (double)cos_turn * o.cosine, -1.0), 1.0);
    *out_cosine = sine_to_cosine(sine);
    return (vec3){(float)sine, 0.0f, 0.0f};
}

/* --- azimuthal scattering: its integral over phi is 1 --- */

static double azimuthal(double angle, double width)
{
    double x = angle - TWO_PI * floor((angle + HALF_TURN) / TWO_PI), e = exponential(-fabs(x) / width);
    double end = exponential(-HALF_TURN / width);
    return e / (width * square(1.0 + e)) * (1.0 + end) / (1.0 - end);
}

static double sample_azimuthal(double u, double width)
{
    double end = exponential(-HALF_TURN / width), low = end / (1.0 + end), high = 1.0 / (1.0 + end);
    double p = low + (high - low) * u;
    p = fmin(fmax(p, 1e-12), 1.0 - 1e-12);
    return fmin(fmax(-width * natural_logarithm((1.0 - p) / p), -HALF_TURN), HALF_TURN);
}

/* --- all lobes together --- */

/* From o, which decides what each lobe carries, to i. */
static double lobe_value(const hair_fibre *h, const fibre_lobes *w, int lobe, inclination o, inclination i, double turn)
{
    double around = lobe < HAIR_TILTED ? azimuthal(turn - w->turn[lobe], h->width) : 1.0 / TWO_PI;
    return around > 0.0 ? around * longitudinal(i, tilted(h, o, lobe), h->variance[lobe]) : 0.0;
}

/* How far i lies about the axis from o. */
static double turn_between(vec3 o, vec3 i)
{
    return angle_of((double)i.z, (double)i.y) - angle_of((double)o.z, (double)o.y);
}

static rgb scatter(const hair_fibre *h, inclination o, inclination i, double turn)
{
    fibre_lobes w = lobes_of(h, o);
    double sum[3] = {0.0, 0.0, 0.0};
    for (int k = 0; k < HAIR_LOBES; k++) {
        double value = lobe_value(h, &w, k, o, i, turn);
        for (int c = 0; c < 3; c++)
            sum[c] += value * w.share[k][c];
    }
    return rgb_make((float)sum[0], (float)sum[1], (float)sum[2]);
}

rgb hair_scatter(const hair_fibre *h, vec3 eye, vec3 light)
{
    return scatter(h, inclination_of(eye), inclination_of(light), turn_between(eye, light));
}

rgb hair_scatter_flux(const hair_fibre *h, vec3 light, vec3 eye)
{
    inclination from = inclination_of(light), to = inclination_of(eye);
    /* all places across are as likely, so that turning the same sense about the axis serves both directions */
    rgb value = scatter(h, to, from, turn_between(light, eye));
    return from.cosine > 1e-6 ? rgb_scale(value, (float)(to.cosine / from.cosine)) : rgb_gray(0.0f);
}

vec3 hair_sample(const hair_fibre *h, vec3 o, float u_lobe, vec2 u)
{
    inclination from = inclination_of(o);
    fibre_lobes w = lobes_of(h, from);
    double all = 0.0, before = 0.0, p = 0.0, x = (double)u_lobe, cosine;
    int lobe = 0;
    for (int k = 0; k < HAIR_LOBES; k++)
        all += w.mean[k];
    for (lobe = 0; lobe < HAIR_LOBES; lobe++) {
        p = w.mean[lobe] / all;
        if (x < before + p || lobe == HAIR_LOBES - 1)
            break;
        before += p;
    }
    x = fmin(fmax((x - before) / fmax(p, 1e-12), 0.0), 0x1.fffffep-1);
    vec3 i = sample_longitudinal(tilted(h, from, lobe), h->variance[lobe], u, &cosine);
    double turn = lobe < HAIR_TILTED ? w.turn[lobe] + sample_azimuthal(x, h->width) : TWO_PI * x, s, c;
    turn += angle_of((double)o.z, (double)o.y);
    turn /= TWO_PI;
    float sin_turn, cos_turn;
    sincos_turns((float)(turn - floor(turn)), &sin_turn, &cos_turn);
    s = (double)sin_turn, c = (double)cos_turn;
    i.y = (float)(cosine * c), i.z = (float)(cosine * s);
    return i;
}

float hair_pdf(const hair_fibre *h, vec3 o, vec3 i)
{
    inclination from = inclination_of(o), to = inclination_of(i);
    fibre_lobes w = lobes_of(h, from);
    double turn = turn_between(o, i), sum = 0.0, all = 0.0;
    for (int k = 0; k < HAIR_LOBES; k++) {
        all += w.mean[k];
        sum += w.mean[k] > 0.0 ? w.mean[k] * lobe_value(h, &w, k, from, to, turn) : 0.0;
    }
    return (float)(sum / all);
}
