// A kernel that includes student_t.metal: reflects views off visible normals, as a path tracer
// does, and returns what the light is worth.
#include "student_t.metal"

struct Query {
    metal::packed_float3 v; // the view, z up
    uint shape;             // its offset in student_t.json
    metal::float2 sigma;    // roughness along x and y
    metal::float2 u;        // random numbers
};

struct Answer {
    metal::packed_float3 l; // the light
    float weight;           // f cos/pdf with F = 1, of one bounce
    metal::packed_float3 m; // the microfacet normal
    float pdf;              // density of the light, per steradian
};

kernel void reflect_views(
    device const metal::float2* tables [[buffer(0)]],
    device const Query* queries [[buffer(1)]],
    device Answer* answers [[buffer(2)]],
    constant uint& count [[buffer(3)]],
    uint i [[thread_position_in_grid]]
) {
    if (i >= count) return;
    const Query q = queries[i];
    const metal::float3 v = metal::float3(q.v);
    const metal::float3 m =
        student_t_sample_visible_normal(q.shape, q.sigma, v, q.u, tables);
    const metal::float3 l = student_t_reflect(v, m);
    answers[i].l = metal::packed_float3(l);
    answers[i].weight = student_t_reflection_weight(
        q.shape, q.sigma, v, l, STUDENT_T_HEIGHT_CORRELATED, tables);
    answers[i].m = metal::packed_float3(m);
    answers[i].pdf = student_t_reflection_pdf(q.shape, q.sigma, v, m, tables);
}
