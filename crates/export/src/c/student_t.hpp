/* SPDX-License-Identifier: CC0-1.0 OR MIT
 *
 * student_t.hpp: the materials of student_t_materials.h for C++17, with vectors of your own.
 *
 *     const student_t_lobe lobe = student_t_gamma_3_lobe(0.3f, 0.3f);
 *     const student_t::conductor gold(lobe, student_t_gold); // points to the lobe
 *     const auto s = gold.sample(v, choice, u); // v: anything with [0], [1], [2]; u: with [0], [1]
 *     if (s) { throughput *= s.weight; direction = s.l; }
 *     const auto [f, pdf] = gold.eval_pdf(v, l);
 *
 * A vector of yours is made as V{x, y, z}. All else is as in student_t_materials.h.
 */
#ifndef STUDENT_T_HPP
#define STUDENT_T_HPP

#include <array>
#include <cstddef>
#include <type_traits>
#include <utility>

#include "student_t_materials.h"

namespace student_t {

using spectrum = std::array<float, STUDENT_T_CHANNELS>;

/* A sampled light, as student_t_sample; false where it is absorbed. */
template <class V> struct sampled {
    static_assert(!std::is_array<V>::value,
                  "a vector is a type that V{x, y, z} makes, such as std::array<float, 3>; "
                  "with arrays call the functions of student_t_materials.h");
    student_t_event event;
    bool is_delta;
    V l, m;
    spectrum weight;
    float pdf, eta;
    explicit operator bool() const { return event != STUDENT_T_ABSORBED; }
};

/* f, without the cosine, and the density of l. */
struct evaluated {
    spectrum f;
    float pdf;
};

namespace impl {

struct direction {
    float w[3];
    template <class V>
    explicit direction(const V &v)
        : w{static_cast<float>(v[0]), static_cast<float>(v[1]), static_cast<float>(v[2])}
    {
    }
};

template <class V> V vector(const float (&w)[3])
{
    using number = std::decay_t<decltype(std::declval<const V &>()[0])>;
    return V{static_cast<number>(w[0]), static_cast<number>(w[1]), static_cast<number>(w[2])};
}

/* What all materials have, from the functions `draw` and `evaluate` of one. */
template <class Material> class material {
  public:
    template <class V, class U>
    sampled<V> sample(const V &v, float choice, const U &u,
                      student_t_transport transport = STUDENT_T_RADIANCE) const
    {
        const float numbers[2] = {static_cast<float>(u[0]), static_cast<float>(u[1])};
        const student_t_sample s = self().draw(direction(v).w, choice, numbers, transport);
        sampled<V> made{s.event, s.is_delta != 0, vector<V>(s.l), vector<V>(s.m), {}, s.pdf, s.eta};
        for (std::size_t i = 0; i < made.weight.size(); ++i) made.weight[i] = s.weight[i];
        return made;
    }
    template <class V>
    evaluated eval_pdf(const V &v, const V &l,
                       student_t_transport transport = STUDENT_T_RADIANCE) const
    {
        evaluated made{};
        made.pdf = self().evaluate(direction(v).w, direction(l).w, transport, made.f.data());
        return made;
    }
    template <class V>
    spectrum eval(const V &v, const V &l, student_t_transport transport = STUDENT_T_RADIANCE) const
    {
        return eval_pdf(v, l, transport).f;
    }
    template <class V> float pdf(const V &v, const V &l) const { return eval_pdf(v, l).pdf; }

  private:
    const Material &self() const { return static_cast<const Material &>(*this); }
};

} // namespace impl

/* student_t_conductor at a hit; the lobe must live as long. */
struct conductor : impl::material<conductor> {
    student_t_conductor c;

    conductor(const student_t_lobe &lobe, const student_t_reflectance &reflectance,
              student_t_masking masking = STUDENT_T_HEIGHT_CORRELATED,
              student_t_compensation_form compensation = STUDENT_T_KULLA_CONTY)
        : c(student_t_conductor_at(&lobe, &reflectance, masking, compensation))
    {
    }
    conductor(const student_t_lobe &&, const student_t_reflectance &,
              student_t_masking = STUDENT_T_HEIGHT_CORRELATED,
              student_t_compensation_form = STUDENT_T_KULLA_CONTY) = delete;
    student_t_sample draw(const float *v, float choice, const float *u, student_t_transport) const
    {
        return student_t_conductor_sample(&c, v, choice, u);
    }
    float evaluate(const float *v, const float *l, student_t_transport, float *f) const
    {
        return student_t_conductor_eval_pdf(&c, v, l, f);
    }
};

/* student_t_dielectric at a hit: of one bounce, or by the table of an index. Points to the lobe. */
struct dielectric : impl::material<dielectric> {
    student_t_dielectric d;

    dielectric(const student_t_lobe &lobe, float eta,
               student_t_masking masking = STUDENT_T_HEIGHT_CORRELATED)
        : d(student_t_dielectric_at(&lobe, eta, masking))
    {
    }
    dielectric(const student_t_lobe &lobe, const student_t_interface_table &table,
               student_t_compensation_form compensation = STUDENT_T_KULLA_CONTY)
        : d(student_t_dielectric_compensated(&lobe, &table, compensation))
    {
    }
    dielectric(const student_t_lobe &&, float, student_t_masking = STUDENT_T_HEIGHT_CORRELATED) =
        delete;
    dielectric(const student_t_lobe &&, const student_t_interface_table &,
               student_t_compensation_form = STUDENT_T_KULLA_CONTY) = delete;
    student_t_sample draw(const float *v, float choice, const float *u,
                          student_t_transport transport) const
    {
        return student_t_dielectric_sample(&d, v, choice, u, transport);
    }
    float evaluate(const float *v, const float *l, student_t_transport transport, float *f) const
    {
        return student_t_dielectric_eval_pdf(&d, v, l, transport, f);
    }
};

/* student_t_plastic at a hit; points to the lobe. */
struct plastic : impl::material<plastic> {
    student_t_plastic p;

    plastic(const student_t_lobe &lobe, const student_t_interface_table &table,
            const spectrum &base,
            student_t_compensation_form compensation = STUDENT_T_KULLA_CONTY)
        : p(student_t_plastic_at(&lobe, &table, base.data(), compensation))
    {
    }
    plastic(const student_t_lobe &&, const student_t_interface_table &, const spectrum &,
            student_t_compensation_form = STUDENT_T_KULLA_CONTY) = delete;
    student_t_sample draw(const float *v, float choice, const float *u, student_t_transport) const
    {
        return student_t_plastic_sample(&p, v, choice, u);
    }
    float evaluate(const float *v, const float *l, student_t_transport, float *f) const
    {
        return student_t_plastic_eval_pdf(&p, v, l, f);
    }
};

} // namespace student_t

#endif
