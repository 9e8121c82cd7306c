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
    float f;                // of all further bounces towards that light, without the cosine
    float albedo;           // of one bounce, for this view
    float average;
    float masking;
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
    const StudentTLobe lobe = student_t_lobe_of(q.shape, q.sigma, tables);
    const metal::float3 v = metal::float3(q.v);
    const metal::float3 m =
        student_t_lobe_sample_visible_normal(lobe, v, q.u, tables);
    const metal::float3 l = student_t_reflect(v, m);
    const uint masking = STUDENT_T_HEIGHT_CORRELATED;
    device Answer& a = answers[i];
    a.l = metal::packed_float3(l);
    a.weight = student_t_lobe_reflection_weight(lobe, v, l, masking, tables);
    a.m = metal::packed_float3(m);
    a.pdf = student_t_lobe_reflection_pdf(lobe, v, m, tables);
    a.f = student_t_lobe_compensation(lobe, v, l, masking, tables);
    a.albedo = student_t_lobe_albedo(lobe, v.z, masking, tables);
    a.average = student_t_lobe_albedo_average(lobe, masking, tables);
    a.masking = student_t_lobe_masking(lobe, v, tables);
}
