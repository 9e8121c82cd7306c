// A program for fragments that includes student_t_realtime.hlsl: a metal sphere under one distant
// light. With dxc:
//     dxc -T ps_6_0 -E metal_sphere student_t_realtime_sample.hlsl -Fo sphere.dxil
#include "student_t_realtime.hlsl"

cbuffer Uniforms : register(b3) {
    float3 light; // unit vector towards the light
    float gamma;
    float3 metal; // reflectance at normal incidence
    float2 sigma; // roughness along the parallels and along the meridians
    float2 size;  // of the view, in pixels
};
Texture2D<float> masking : register(t0);
Texture3D<float4> albedo : register(t1);
SamplerState linear_clamp : register(s2);

float area_of(StudentTSurface surface, float3 w) {
    float2 at = student_t_surface_masking_at(surface, w);
    return student_t_surface_area(surface, w, masking.SampleLevel(linear_clamp, at, 0));
}

float4 albedo_of(StudentTSurface surface, float cos_theta) {
    float3 at = student_t_surface_albedo_at(surface, cos_theta);
    return albedo.SampleLevel(linear_clamp, at, 0);
}

float4 metal_sphere(float4 position : SV_Position) : SV_Target {
    float2 half_size = 0.5 * size;
    float2 p = (position.xy - half_size) / min(half_size.x, half_size.y) * float2(1, -1);
    float3 n = float3(p, sqrt(max(1 - dot(p, p), 0)));
    // The tangent frame: x along the parallels, y along the meridians, z the normal.
    float3 x = normalize(float3(n.z, 0, -n.x) + float3(1e-6, 0, 0)), y = cross(n, x);
    float3 v = float3(x.z, y.z, n.z), l = float3(dot(x, light), dot(y, light), dot(n, light));
    if (dot(p, p) >= 1 || l.z <= 0) return float4(0, 0, 0, 1);

    StudentTSurface surface = student_t_surface(gamma, sigma);
    float4 view = albedo_of(surface, v.z);
    float3 m = normalize(v + l);
    float first =
        student_t_surface_eval(surface, v, l, m, area_of(surface, v), area_of(surface, l));
    float3 average = student_t_schlick_average(metal, 1);
    float3 further = student_t_further_bounces(view, albedo_of(surface, l.z).x, average);
    float3 color = student_t_schlick(metal, 1, dot(v, m)) * first + further * l.z;
    return float4(pow(color, 1 / 2.2), 1);
}
