/* A path tracer's material in one page: gold whose roughness comes from a texture, made at every
 * hit. Prints what a camera sees of a plate in a white sky with a lamp, by paths of one bounce. */
#include <array>
#include <cmath>
#include <cstdio>
#include <random>

#include "student_t.hpp"
#include "student_t_gamma_3.h"

/* Any vector with [0], [1] and [2] does. */
struct vec {
    float x, y, z;
    float operator[](int i) const { return i == 0 ? x : i == 1 ? y : z; }
};

static float dot(const vec &a, const vec &b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

/* What a renderer knows of a hit: the roughness there, and its tangent frame. */
struct hit {
    float sigma;
    vec tangent, bitangent, normal;
    vec local(const vec &w) const { return {dot(w, tangent), dot(w, bitangent), dot(w, normal)}; }
    vec world(const vec &w) const
    {
        return {w.x * tangent.x + w.y * bitangent.x + w.z * normal.x,
                w.x * tangent.y + w.y * bitangent.y + w.z * normal.y,
                w.x * tangent.z + w.y * bitangent.z + w.z * normal.z};
    }
};

/* The heuristic of powers, for a light drawn with the first of two densities. */
static float heuristic(float a, float b) { return a / b > 1e18f ? 1.0f : a * a / (a * a + b * b); }

int main()
{
    std::mt19937 bits(1);
    std::uniform_real_distribution<float> uniform(0.0f, 1.0f);
    /* A round lamp of half angle 0.1 about the zenith, ten times as bright as the sky. */
    const float lamp_cos = std::cos(0.1f), lamp_pdf = 1.0f / (6.2831853f * (1.0f - lamp_cos));
    const int paths = 200000;
    for (const float sigma : {0.05f, 0.3f, 1.0f}) {
        const hit here{sigma, {0.8f, 0.0f, -0.6f}, {0.0f, 1.0f, 0.0f}, {0.6f, 0.0f, 0.8f}};
        const vec v = here.local({0.96f, 0.0f, 0.28f});
        /* The material, from the texture's sigma: this is all that is made at a hit. */
        const student_t_lobe lobe = student_t_gamma_3_lobe(here.sigma, here.sigma);
        const student_t::conductor gold(lobe, student_t_gold);
        std::array<double, 3> seen{};
        for (int i = 0; i < paths; ++i) {
            /* Towards the lamp. */
            const float z = 1.0f - uniform(bits) * (1.0f - lamp_cos);
            const float r = std::sqrt(1.0f - z * z), turn = 6.2831853f * uniform(bits);
            const vec l = here.local({r * std::cos(turn), r * std::sin(turn), z});
            const auto [f, pdf] = gold.eval_pdf(v, l);
            for (std::size_t k = 0; k < 3; ++k)
                if (l.z > 0.0f)
                    seen[k] += double(10.0f * f[k] * l.z / lamp_pdf * heuristic(lamp_pdf, pdf));
            /* Along the material's own sample. */
            const std::array<float, 2> u{uniform(bits), uniform(bits)};
            const auto s = gold.sample(v, uniform(bits), u);
            if (!s) continue;
            const bool meets = here.world(s.l).z >= lamp_cos;
            const float share = s.is_delta ? 1.0f : heuristic(s.pdf, lamp_pdf);
            const float light = meets ? 10.0f * share : 1.0f;
            for (std::size_t k = 0; k < 3; ++k) seen[k] += double(s.weight[k] * light);
        }
        std::printf("gold of sigma %.2f in a white sky with a lamp: %.3f %.3f %.3f\n",
                    double(sigma), seen[0] / paths, seen[1] / paths, seen[2] / paths);
    }
}
