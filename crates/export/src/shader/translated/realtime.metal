#ifndef STUDENT_T_REALTIME
#define STUDENT_T_REALTIME

#include <metal_stdlib>
#include <simd/simd.h>

using metal::uint;

struct StudentTSurface {
    metal::float2 sigma;
    float s;
    float power;
    float peak;
    float kappa;
    float stretch;
    char _pad6[4];
    metal::float2 rows;
};

inline float student_t_impl_texel(
    float x,
    float n
) {
    return (0.5 / n) + ((1.0 - (1.0 / n)) * x);
}

inline StudentTSurface student_t_surface(
    float gamma,
    metal::float2 sigma
) {
    float heavy = 1.0 / ((2.0 * metal::clamp(gamma, 1.6, 1000000.0)) - 3.0);
    metal::float2 a = metal::clamp(sigma, metal::float2(0.0001), metal::float2(10000.0));
    float kappa = 0.5 + (0.5 * heavy);
    float area = a.x * a.y;
    float stand_in = metal::sqrt(area);
    float s = metal::max((2.0 * heavy) / (1.0 + heavy), 0.0005);
    float shape = 0.1556114 * metal::log2(1.0 + (17.0 * heavy));
    float _e51 = student_t_impl_texel(metal::sqrt(metal::min(stand_in, 1.0)), 32.0);
    float _e53 = student_t_impl_texel(shape, 32.0);
    return StudentTSurface {a, s, 1.0 - (1.0 / s), 0.3183099 / area, kappa, (kappa + 2.5) * stand_in, {}, metal::float2(_e51, _e53)};
}

inline float student_t_surface_d(
    StudentTSurface surface,
    metal::float3 m
) {
    metal::float2 x_1 = m.xy / surface.sigma;
    float square = metal::max(m.z * m.z, 0.000000000000000000000001);
    float b = square + (surface.s * metal::dot(x_1, x_1));
    float tail = metal::exp2(surface.power * metal::log2(b / square));
    return (((m.z > 0.0) ? surface.peak : 0.0) / (b * b)) * tail;
}

inline metal::float2 student_t_surface_masking_at(
    StudentTSurface surface_1,
    metal::float3 w
) {
    float c_1 = metal::max(w.z, 0.0);
    float q = c_1 / (c_1 + (surface_1.kappa * metal::length(surface_1.sigma * w.xy)));
    float _e14 = student_t_impl_texel(q, 64.0);
    return metal::float2(_e14, surface_1.rows.y);
}

inline float student_t_surface_area(
    StudentTSurface surface_2,
    metal::float3 w_1,
    float texel
) {
    float c_2 = metal::max(w_1.z, 0.0);
    float simple = c_2 + (surface_2.kappa * metal::length(surface_2.sigma * w_1.xy));
    return simple * (0.75 + texel);
}

inline float student_t_surface_eval(
    StudentTSurface surface_3,
    metal::float3 v,
    metal::float3 l,
    metal::float3 m_1,
    float area_v,
    float area_l
) {
    float _e6 = student_t_surface_d(surface_3, m_1);
    float cos_v = metal::max(v.z, 0.0);
    float cos_l = metal::max(l.z, 0.0);
    float both = (cos_l * area_v) + (cos_v * (area_l - cos_l));
    return ((0.25 * _e6) * cos_l) / metal::max(both, 0.00000000000000000001);
}

inline float student_t_surface_pdf(
    StudentTSurface surface_4,
    metal::float3 m_2,
    float area_v_1
) {
    float _e3 = student_t_surface_d(surface_4, m_2);
    return (0.25 * _e3) / area_v_1;
}

inline metal::float2 student_t_impl_weights(
    float c
) {
    float k = 1.0 - c;
    float fourth = (k * k) * (k * k);
    return metal::float2(fourth * k, ((17.651384 * c) * fourth) * (k * k));
}

inline metal::float3 student_t_impl_untinted(
    metal::float3 f0_,
    metal::float3 tint
) {
    return (metal::float3(1.0) - tint) * (f0_ + ((metal::float3(1.0) - f0_) * 0.46266437));
}

inline metal::float3 student_t_schlick(
    metal::float3 f0_1,
    float f90_,
    float cos_theta
) {
    metal::float2 _e5 = student_t_impl_weights(cos_theta);
    return f0_1 + ((metal::float3(f90_) - f0_1) * _e5.x);
}

inline metal::float3 student_t_schlick_average(
    metal::float3 f0_2,
    float f90_1
) {
    return f0_2 + ((metal::float3(f90_1) - f0_2) * 0.04761905);
}

inline metal::float3 student_t_f82_tint(
    metal::float3 f0_3,
    metal::float3 tint_1,
    float cos_theta_1
) {
    metal::float2 _e3 = student_t_impl_weights(cos_theta_1);
    metal::float3 _e10 = student_t_impl_untinted(f0_3, tint_1);
    metal::float3 raw = (f0_3 + ((metal::float3(1.0) - f0_3) * _e3.x)) - (_e10 * _e3.y);
    return metal::max(raw, metal::float3(0.0));
}

inline metal::float3 student_t_f82_tint_average(
    metal::float3 f0_4,
    metal::float3 tint_2
) {
    metal::float3 _e3 = student_t_schlick_average(f0_4, 1.0);
    metal::float3 _e4 = student_t_impl_untinted(f0_4, tint_2);
    return _e3 - (0.14009036 * _e4);
}

inline metal::float3 student_t_surface_albedo_at(
    StudentTSurface surface_5,
    float cos_theta_2
) {
    float c_3 = metal::clamp(cos_theta_2, 0.000000000001, 1.0);
    float x_2 = c_3 / (c_3 + (surface_5.stretch * metal::sqrt(1.0 - (c_3 * c_3))));
    float _e16 = student_t_impl_texel(metal::sqrt(metal::sqrt(x_2)), 48.0);
    return metal::float3(_e16, surface_5.rows);
}

inline metal::float3 student_t_impl_of_texel(
    metal::float4 texel_1,
    float cos_theta_3
) {
    float e = 1.0 - (texel_1.x * texel_1.x);
    metal::float2 _e10 = student_t_impl_weights(metal::clamp(cos_theta_3, 0.0, 1.0));
    metal::float2 w_2 = e * _e10;
    return metal::float3(e, metal::clamp(texel_1.y + w_2.x, 0.0, e), metal::max(texel_1.z + w_2.y, 0.0));
}

inline metal::float3 student_t_schlick_albedo(
    metal::float4 texel_2,
    metal::float3 f0_5,
    float f90_2,
    float cos_theta_4
) {
    metal::float3 _e4 = student_t_impl_of_texel(texel_2, cos_theta_4);
    return (f0_5 * _e4.x) + ((metal::float3(f90_2) - f0_5) * _e4.y);
}

inline metal::float3 student_t_f82_tint_albedo(
    metal::float4 texel_3,
    metal::float3 f0_6,
    metal::float3 tint_3,
    float cos_theta_5
) {
    metal::float3 _e4 = student_t_impl_untinted(f0_6, tint_3);
    metal::float3 _e5 = student_t_impl_of_texel(texel_3, cos_theta_5);
    metal::float3 dip = _e4 * _e5.z;
    metal::float3 _e9 = student_t_schlick_albedo(texel_3, f0_6, 1.0, cos_theta_5);
    return _e9 - dip;
}

inline metal::float3 student_t_further_bounces(
    metal::float4 view,
    float light,
    metal::float3 average
) {
    float lost = view.w * view.w;
    metal::float3 tint_4 = ((average * average) * (1.0 - lost)) / (metal::float3(1.0) - (average * lost));
    float both_1 = (view.x * light) / metal::max(view.w, 0.0001);
    return tint_4 * ((0.3183099 * both_1) * both_1);
}

inline metal::float3 student_t_scaled_bounce(
    metal::float4 view_1,
    metal::float3 f0_7
) {
    float lost_1 = view_1.x * view_1.x;
    return metal::float3(1.0) + (f0_7 * (lost_1 / (1.0 - lost_1)));
}

#endif
