/* color_table_ocio.cpp: a processor in stages, of which those that are one curve for each channel alone (logarithm,
 * tone curve, display gamma, or several in a row) are read from tables: half of what ACES' output transform costs. A
 * table holds a straight piece for each 1024th of an octave. Each piece is held against OpenColorIO's own values when
 * it is made; values in pieces that are not straight enough, and those beyond the table, go through OpenColorIO.
 * Flow: color_view_ocio -> [here]. Threads: made by one, applied by any number. */
#include "color/color_ocio_private.h"

#include <cmath>
#include <cstdint>
#include <cstring>

namespace ag_color
{

namespace
{

const int MANTISSA_BITS = 10, SHIFT = 23 - MANTISSA_BITS, LEAST_EXPONENT = -20, OCTAVES = 36;
const size_t PIECES = static_cast<size_t>(OCTAVES) << MANTISSA_BITS;
const uint32_t FIRST = static_cast<uint32_t>(127 + LEAST_EXPONENT) << MANTISSA_BITS; /* bits of the least, shifted */
const uint32_t SIGN = 0x80000000u, REST = (1u << SHIFT) - 1;

uint32_t bits_of(float v)
{
    uint32_t bits;
    std::memcpy(&bits, &v, sizeof bits);
    return bits;
}

float of_bits(uint32_t bits)
{
    float v;
    std::memcpy(&v, &bits, sizeof v);
    return v;
}

/* OpenColorIO's own logarithms and powers are that far from exact. */
bool is_near(float v, float exact) { return std::fabs(v - exact) <= 2e-6f * std::fabs(exact) + 1e-7f; }

/* The curve at many arguments; three go into a pixel. */
std::vector<float> curve_at(const OCIO::ConstCPUProcessorRcPtr &cpu, const std::vector<float> &arguments)
{
    const size_t pixels = (arguments.size() + 2) / 3;
    std::vector<float> rgba(4 * pixels, 1.0f), values(arguments.size());
    for (size_t i = 0; i < arguments.size(); i++)
        rgba[4 * (i / 3) + i % 3] = arguments[i];
    OCIO::PackedImageDesc description(rgba.data(), static_cast<long>(pixels), 1, 4);
    cpu->apply(description);
    for (size_t i = 0; i < arguments.size(); i++)
        values[i] = rgba[4 * (i / 3) + i % 3];
    return values;
}

/* Whether each channel goes its own way, and all three the same one. */
bool is_one_curve(const OCIO::ConstCPUProcessorRcPtr &cpu)
{
    std::vector<float> mixed, grey;
    for (int i = 0; i < 96; i++)
        mixed.push_back(std::exp2(static_cast<float>((37 * i) % 97) / 97.0f * 24.0f - 16.0f) *
                        (i % 7 == 3 ? -1.0f : 1.0f));
    for (float v : mixed)
        grey.insert(grey.end(), 3, v);
    const std::vector<float> in_mixed = curve_at(cpu, mixed), in_grey = curve_at(cpu, grey);
    for (size_t i = 0; i < grey.size(); i++)
        if (!(in_mixed[i / 3] == in_grey[i]))
            return false;
    return true;
}

} // namespace

struct curve_table {
    struct piece {
        float value, slope; /* value NaN: OpenColorIO's to do */
    };
    std::vector<piece> pieces;
    size_t bent_count = 0; /* of pieces that are OpenColorIO's to do */
    piece small;           /* of [0, the least), by the value itself */
    enum { OTHER, STRAIGHT, MIRRORED } negative;
    piece negative_piece; /* where they are straight, by the value itself */

    /* NaN where it cannot tell. */
    float at(float v) const
    {
        const uint32_t bits = bits_of(v), size = bits & ~SIGN;
        const bool is_negative = bits != size && size != 0;
        if (is_negative && negative == STRAIGHT && size >> SHIFT < FIRST + PIECES)
            return negative_piece.value + negative_piece.slope * v;
        const uint32_t index = (size >> SHIFT) - FIRST;
        float value;
        if (size >> SHIFT < FIRST)
            value = small.value + small.slope * of_bits(size);
        else if (index < PIECES)
            value = pieces[index].value + pieces[index].slope * static_cast<float>(size & REST);
        else
            return NAN;
        return !is_negative ? value : negative == MIRRORED ? -value : NAN;
    }

    explicit curve_table(const OCIO::ConstCPUProcessorRcPtr &cpu) : pieces(PIECES)
    {
        std::vector<float> arguments;
        for (uint32_t i = 0; i <= 4 * PIECES; i++) /* the pieces' ends and quarters */
            arguments.push_back(of_bits((FIRST << SHIFT) + (i << (SHIFT - 2))));
        const std::vector<float> values = curve_at(cpu, arguments);
        for (size_t i = 0; i < PIECES; i++) {
            const float *v = &values[4 * i];
            piece p = {v[0], (v[4] - v[0]) / static_cast<float>(REST + 1)};
            for (int k = 1; k < 4; k++)
                if (!is_near(p.value + p.slope * static_cast<float>(k << (SHIFT - 2)), v[k]))
                    p.value = NAN;
            bent_count += std::isnan(p.value);
            pieces[i] = p;
        }
        small = straight(cpu, 1.0f, arguments[0]);
        negative_piece = straight(cpu, -1.0f, arguments.back());
        negative = !std::isnan(negative_piece.value) ? STRAIGHT : is_mirrored(cpu) ? MIRRORED : OTHER;
    }

  private:
    /* Of values from 0 to that size, of that sign, all on one line. */
    static piece straight(const OCIO::ConstCPUProcessorRcPtr &cpu, float sign, float largest)
    {
        std::vector<float> arguments = {0.0f, sign * largest};
        for (int i = 1; i < 64; i++) {
            arguments.push_back(sign * largest * static_cast<float>(i) / 64.0f);
            arguments.push_back(sign * largest * std::exp2(-0.5f * static_cast<float>(i)));
        }
        const std::vector<float> values = curve_at(cpu, arguments);
        piece p = {values[0], (values[1] - values[0]) / arguments[1]};
        for (size_t i = 0; i < arguments.size(); i++)
            if (!is_near(p.value + p.slope * arguments[i], values[i]))
                p.value = NAN;
        return p;
    }

    static bool is_mirrored(const OCIO::ConstCPUProcessorRcPtr &cpu)
    {
        std::vector<float> arguments, mirrored;
        for (int i = -80; i < 60; i++) {
            arguments.push_back(std::exp2(0.25f * static_cast<float>(i)));
            mirrored.push_back(-arguments.back());
        }
        const std::vector<float> values = curve_at(cpu, arguments), others = curve_at(cpu, mirrored);
        for (size_t i = 0; i < values.size(); i++)
            if (!(values[i] == -others[i]))
                return false;
        return true;
    }
};

namespace
{

/* A step that may be a curve for each channel, and costs more than a look into a table. */
bool is_curve(const OCIO::ConstTransformRcPtr &transform)
{
    switch (transform->getTransformType()) {
    case OCIO::TRANSFORM_TYPE_EXPONENT:
    case OCIO::TRANSFORM_TYPE_EXPONENT_WITH_LINEAR:
    case OCIO::TRANSFORM_TYPE_GRADING_RGB_CURVE:
    case OCIO::TRANSFORM_TYPE_LOG:
    case OCIO::TRANSFORM_TYPE_LOG_AFFINE:
    case OCIO::TRANSFORM_TYPE_LOG_CAMERA:
    case OCIO::TRANSFORM_TYPE_LUT1D: return true;
    default: return false;
    }
}

} // namespace

stages::stages(const OCIO::ConstConfigRcPtr &config, const OCIO::ConstProcessorRcPtr &processor)
{
    const OCIO::GroupTransformRcPtr all =
        processor->getOptimizedProcessor(OCIO::OPTIMIZATION_DEFAULT)->createGroupTransform();
    for (int i = 0; i < all->getNumTransforms();) {
        const OCIO::GroupTransformRcPtr part = OCIO::GroupTransform::Create();
        const bool are_curves = is_curve(all->getTransform(i));
        for (; i < all->getNumTransforms() && is_curve(all->getTransform(i)) == are_curves; i++)
            part->appendTransform(all->getTransform(i));
        stage made;
        made.cpu = config->getProcessor(part)->getDefaultCPUProcessor();
        if (are_curves && is_one_curve(made.cpu))
            made.table = std::make_shared<const curve_table>(made.cpu);
        if (made.table && made.table->bent_count > PIECES / 64)
            made.table = nullptr;
        list.push_back(made);
    }
}

void stages::apply(float *rgba, size_t count) const
{
    for (const stage &s : list) {
        if (!s.table) {
            OCIO::PackedImageDesc description(rgba, static_cast<long>(count), 1, 4);
            s.cpu->apply(description);
            continue;
        }
        for (size_t i = 0; i < count; i++) {
            float *pixel = rgba + 4 * i;
            const float r = s.table->at(pixel[0]), g = s.table->at(pixel[1]), b = s.table->at(pixel[2]);
            if (std::isnan(r + g + b)) {
                s.cpu->applyRGBA(pixel);
            } else {
                pixel[0] = r;
                pixel[1] = g;
                pixel[2] = b;
            }
        }
    }
}

} // namespace ag_color
