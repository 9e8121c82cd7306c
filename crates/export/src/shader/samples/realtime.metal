// A program for fragments that includes student_t_realtime.metal: a metal sphere under one distant
// light.
#include "student_t_realtime.metal"

struct Uniforms {
    metal::packed_float3 light; // unit vector towards the light
    float gamma;
    metal::packed_float3 metal; // reflectance at normal incidence
    float roughness;
    metal::float2 size; // of the view, in pixels
};

constexpr metal::sampler linear_clamp(metal::filter::linear, metal::address::clamp_to_edge);

static float area_of(
    StudentTSurface surface, metal::float3 w, metal::texture2d<float> masking
) {
    const metal::float2 at = student_t_surface_masking_at(surface, w);
    return student_t_surface_area(surface, w, masking.sample(linear_clamp, at).x);
}

static metal::float4 albedo_of(
    StudentTSurface surface, float cos_theta, metal::texture3d<float> albedo
) {
    return albedo.sample(linear_clamp, student_t_surface_albedo_at(surface, cos_theta));
}

fragment metal::float4 metal_sphere(
    metal::float4 position [[position]],
    constant Uniforms& uniforms [[buffer(0)]],
    metal::texture2d<float> masking [[texture(0)]],
    metal::texture3d<float> albedo [[texture(1)]]
) {
    const metal::float2 half_size = 0.5 * uniforms.size;
    const metal::float2 p = (position.xy - half_size) / metal::min(half_size.x, half_size.y)
        * metal::float2(1.0, -1.0);
    const metal::float3 n =
        metal::float3(p, metal::sqrt(metal::max(1.0 - metal::dot(p, p), 0.0)));
    // The tangent frame: x along the parallels, y along the meridians, z the normal.
    const metal::float3 x = metal::normalize(metal::float3(n.z + 1e-6, 0.0, -n.x));
    const metal::float3 y = metal::cross(n, x), light = metal::float3(uniforms.light);
    const metal::float3 v = metal::float3(x.z, y.z, n.z);
    const metal::float3 l =
        metal::float3(metal::dot(x, light), metal::dot(y, light), metal::dot(n, light));
    if (metal::dot(p, p) >= 1.0 || l.z <= 0.0) return metal::float4(0.0, 0.0, 0.0, 1.0);

    const StudentTSurface surface =
        student_t_surface(uniforms.gamma, metal::float2(uniforms.roughness));
    const metal::float3 f0 = metal::float3(uniforms.metal), m = metal::normalize(v + l);
    const metal::float4 view = albedo_of(surface, v.z, albedo);
    const float first = student_t_surface_eval(
        surface, v, l, m, area_of(surface, v, masking), area_of(surface, l, masking));
    const metal::float3 further = student_t_further_bounces(
        view, albedo_of(surface, l.z, albedo).x, student_t_schlick_average(f0, 1.0));
    const metal::float3 color =
        student_t_schlick(f0, 1.0, metal::dot(v, m)) * first + further * l.z;
    return metal::float4(metal::pow(color, metal::float3(1.0 / 2.2)), 1.0);
}
