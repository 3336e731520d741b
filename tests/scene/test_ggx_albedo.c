/* test_ggx_albedo.c: the table of what rough interfaces reflect in all, worked out again, and what lies between its
 * points. Threads: one. */
#include "fixtures/bsdf_fixture.h"
#include "material/fresnel.h"
#include "material/ggx_albedo.h"
#include "material/microfacet.h"

/* A mean over visible normals of what single scattering leaves, Schlick's two terms apart. */
static void integrate(double alpha, double cosine, double *out_f0, double *out_f90)
{
    enum { STEPS = 96 };
    const ggx facets = {(float)alpha, (float)alpha};
    const vec3 o = {(float)sqrt(1.0 - cosine * cosine), 0.0f, (float)cosine};
    *out_f0 = *out_f90 = 0.0;
    for (int k = 0; k < STEPS * STEPS; k++) {
        vec3 h = ggx_sample_visible(facets, o,
                                    (vec2){((float)(k / STEPS) + 0.5f) / STEPS, ((float)(k % STEPS) + 0.5f) / STEPS});
        vec3 i = reflect_about(o, h);
        if (i.z <= 0.0f)
            continue;
        double kept = (double)(ggx_masking_shadowing(facets, o, i) / ggx_masking(facets, o)) / (STEPS * STEPS);
        double grazing = pow(1.0 - (double)vec3_dot(o, h), 5.0);
        *out_f0 += kept * (1.0 - grazing);
        *out_f90 += kept * grazing;
    }
}

static void rough_interfaces(void **state)
{
    (void)state;
    double worst = 0.0;
    for (double roughness = 0.04; roughness <= 1.0; roughness += 0.0639)
        for (double cosine = 0.055; cosine <= 1.0; cosine += 0.0471) {
            double f0, f90, alpha = roughness * roughness;
            integrate(alpha, cosine, &f0, &f90);
            ggx_albedo a = ggx_albedo_of((float)alpha, (float)cosine);
            double error = fmax(fabs((double)a.of_f0 - f0), fabs((double)a.of_f90 - f90));
            worst = fmax(worst, error);
            if (!(error < 0.007))
                fail_msg("alpha %g, cosine %g: %g and %g, not %g and %g", alpha, cosine, (double)a.of_f0,
                         (double)a.of_f90, f0, f90);
        }
    print_message("at most %.4f off\n", worst);
}

static void smooth_interfaces_are_schlicks(void **state)
{
    (void)state;
    for (double cosine = 0.0; cosine <= 1.0; cosine += 0.125) {
        ggx_albedo a = ggx_albedo_of(0.0f, (float)cosine), b = ggx_albedo_of(1e-3f, (float)cosine);
        assert_close(a.of_f90, pow(1.0 - cosine, 5.0), 1e-6);
        assert_close(a.of_f0 + a.of_f90, 1.0, 1e-6);
        if (cosine > 0.1) /* no step where facets begin */
            assert_close(a.of_f90, b.of_f90, 4e-3);
    }
}

static void all_arguments_are_inside_the_table(void **state)
{
    (void)state;
    for (int k = 0; k <= 16; k++)
        for (int i = 0; i <= 16; i++) {
            ggx_albedo a = ggx_albedo_of((float)k / 16.0f, (float)i / 16.0f);
            assert_true(a.of_f0 >= 0.0f && a.of_f90 >= 0.0f && a.of_f0 + a.of_f90 <= 1.001f);
        }
    ggx_albedo corner = ggx_albedo_of(1.0f, 1.0f);
    double f0, f90;
    integrate(1.0, 1.0, &f0, &f90);
    assert_close(corner.of_f0, f0, 1e-3);
    assert_close(corner.of_f90, f90, 1e-3);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(rough_interfaces),
        cmocka_unit_test(smooth_interfaces_are_schlicks),
        cmocka_unit_test(all_arguments_are_inside_the_table),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
