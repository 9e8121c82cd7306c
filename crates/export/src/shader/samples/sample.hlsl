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
    Answer a;
    a.m = student_t_sample_visible_normal(q.shape, q.sigma, q.v, q.u);
    a.l = student_t_reflect(q.v, a.m);
    uint masking = STUDENT_T_HEIGHT_CORRELATED;
    a.weight = student_t_reflection_weight(q.shape, q.sigma, q.v, a.l, masking);
    a.pdf = student_t_reflection_pdf(q.shape, q.sigma, q.v, a.m);
    a.f = student_t_compensation(q.shape, q.sigma, q.v, a.l, masking);
    a.albedo = student_t_albedo(q.shape, q.sigma, q.v.z, masking);
    a.average = student_t_albedo_average(q.shape, q.sigma, masking);
    a.masking = student_t_masking(q.shape, q.sigma, q.v);
    answers[id.x] = a;
}
