// A program for compute that includes student_t.hlsl: reflects views off visible normals, as a path
// tracer does, and returns what the light is worth. With dxc:
//     dxc -T cs_6_0 -E reflect_views student_t_sample.hlsl -Fo student_t_sample.dxil
#include "student_t.hlsl"

struct Query {
    float3 v;     // the view, z up
    uint shape;   // its offset in student_t.json
    float2 sigma; // roughness along x and y
    float2 u;     // random numbers
};

struct Answer {
    float3 l;     // the light
    float weight; // f cos/pdf with F = 1, of one bounce
    float3 m;     // the microfacet normal
    float pdf;    // density of the light, per steradian
    float f;      // f of all further bounces towards that light, without the cosine
    float albedo; // of one bounce, for this view
    float average;
    float masking;
};

StructuredBuffer<Query> queries : register(t1);
RWStructuredBuffer<Answer> answers : register(u2); // u0 would be binding 0 in Vulkan, as t0 is

[numthreads(64, 1, 1)]
void reflect_views(uint3 id : SV_DispatchThreadID) {
    uint count, stride;
    queries.GetDimensions(count, stride);
    if (id.x >= count) return;
    Query q = queries[id.x];
    const StudentTLobe lobe = student_t_lobe_of(q.shape, q.sigma);
    Answer a;
    a.m = student_t_lobe_sample_visible_normal(lobe, q.v, q.u);
    a.l = student_t_reflect(q.v, a.m);
    uint masking = STUDENT_T_HEIGHT_CORRELATED;
    a.weight = student_t_lobe_reflection_weight(lobe, q.v, a.l, masking);
    a.pdf = student_t_lobe_reflection_pdf(lobe, q.v, a.m);
    a.f = student_t_lobe_compensation(lobe, q.v, a.l, masking);
    a.albedo = student_t_lobe_albedo(lobe, q.v.z, masking);
    a.average = student_t_lobe_albedo_average(lobe, masking);
    a.masking = student_t_lobe_masking(lobe, q.v);
    answers[id.x] = a;
}
