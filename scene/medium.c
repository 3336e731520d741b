/* medium.c: see medium.h.
 * The table rests on: Jensen, Marschner, Levoy, Hanrahan, "A Practical Model for Subsurface Light Transport", 2001,
 * figure 5; Narasimhan, Gupta, Donner, Ramamoorthi, Nayar, Jensen, "Acquiring Scattering Properties of Participating
 * Media by Dilution", 2006, as pbrt-v4 names and rounds them. Threads: pure functions. */
#include "medium.h"

#include "material/fresnel.h"

#include <string.h>

static float channel_transmittance(float sigma_a, float distance)
{
    return sigma_a > 0.0f ? attenuation(sigma_a * distance) : 1.0f; /* 0 times infinity would be no number */
}

rgb medium_transmittance(const medium *m, float distance)
{
    return (rgb){channel_transmittance(m->sigma_a.r, distance), channel_transmittance(m->sigma_a.g, distance),
                 channel_transmittance(m->sigma_a.b, distance)};
}

static const struct {
    const char *name;
    rgb sigma_a; /* 1/mm */
} PRESETS[] = {
    /* Jensen et al. */
    {"Apple", {0.0030f, 0.0034f, 0.046f}},
    {"Chicken1", {0.015f, 0.077f, 0.19f}},
    {"Chicken2", {0.018f, 0.088f, 0.20f}},
    {"Cream", {0.0002f, 0.0028f, 0.0163f}},
    {"Ketchup", {0.061f, 0.97f, 1.45f}},
    {"Marble", {0.0021f, 0.0041f, 0.0071f}},
    {"Potato", {0.0024f, 0.0090f, 0.12f}},
    {"Skimmilk", {0.0014f, 0.0025f, 0.0142f}},
    {"Skin1", {0.032f, 0.17f, 0.48f}},
    {"Skin2", {0.013f, 0.070f, 0.145f}},
    {"Spectralon", {0.0f, 0.0f, 0.0f}},
    {"Wholemilk", {0.0011f, 0.0024f, 0.014f}},
    /* Narasimhan et al. */
    {"Lowfat Milk", {0.002875f, 0.00575f, 0.0115f}},
    {"Reduced Milk", {0.0025556f, 0.0051111f, 0.012778f}},
    {"Regular Milk", {0.0015333f, 0.0046f, 0.019933f}},
    {"Espresso", {4.7984f, 6.5751f, 8.8493f}},
    {"Mint Mocha Coffee", {3.772f, 5.8228f, 7.82f}},
    {"Lowfat Soy Milk", {0.0014375f, 0.0071875f, 0.035937f}},
    {"Regular Soy Milk", {0.0019167f, 0.0095833f, 0.065167f}},
    {"Lowfat Chocolate Milk", {0.0115f, 0.0368f, 0.1564f}},
    {"Regular Chocolate Milk", {0.010063f, 0.043125f, 0.14375f}},
    {"Coke", {0.10014f, 0.16503f, 0.2468f}},
    {"Pepsi", {0.091641f, 0.14158f, 0.20729f}},
    {"Sprite", {0.001886f, 0.0018308f, 0.0020025f}},
    {"Gatorade", {0.024794f, 0.019289f, 0.008878f}},
    {"Chardonnay", {0.010782f, 0.011855f, 0.023997f}},
    {"White Zinfandel", {0.012072f, 0.016184f, 0.019843f}},
    {"Merlot", {0.11632f, 0.25191f, 0.29434f}},
    {"Budweiser Beer", {0.011492f, 0.024911f, 0.057786f}},
    {"Coors Light Beer", {0.006164f, 0.013984f, 0.034983f}},
    {"Clorox", {0.0033542f, 0.014892f, 0.026297f}},
    {"Apple Juice", {0.012957f, 0.023741f, 0.052184f}},
    {"Cranberry Juice", {0.039437f, 0.094223f, 0.12426f}},
    {"Grape Juice", {0.10404f, 0.23958f, 0.29325f}},
    {"Ruby Grapefruit Juice", {0.085867f, 0.18314f, 0.25262f}},
    {"White Grapefruit Juice", {0.0138f, 0.018831f, 0.056781f}},
    {"Shampoo", {0.014107f, 0.045693f, 0.061717f}},
    {"Strawberry Shampoo", {0.01449f, 0.05796f, 0.075823f}},
    {"Head & Shoulders Shampoo", {0.084621f, 0.15688f, 0.20365f}},
    {"Lemon Tea Powder", {2.4288f, 4.5757f, 7.2127f}},
    {"Orange Powder", {0.001449f, 0.003441f, 0.007863f}},
    {"Pink Lemonade Powder", {0.001165f, 0.002366f, 0.003195f}},
    {"Cappuccino Powder", {35.844f, 49.547f, 61.084f}},
    {"Salt Powder", {0.28415f, 0.3257f, 0.34148f}},
    {"Sugar Powder", {0.012638f, 0.031051f, 0.050124f}},
    {"Suisse Mocha Powder", {17.502f, 27.004f, 35.433f}},
    {"Pacific Ocean Surface Water", {0.031845f, 0.031324f, 0.030147f}},
};

bool medium_find_preset(const char *name, rgb *out_sigma_a)
{
    for (size_t i = 0; i < sizeof PRESETS / sizeof *PRESETS; i++)
        if (strcmp(PRESETS[i].name, name) == 0) {
            *out_sigma_a = PRESETS[i].sigma_a;
            return true;
        }
    return false;
}
