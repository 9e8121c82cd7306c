#version 450
// A program for compute that includes student_t.glsl: reflects views off visible normals, as a path
// tracer does, and returns what the light is worth. To SPIR-V:
//     glslangValidator -V student_t_sample.comp -o student_t_sample.spv
#extension GL_GOOGLE_include_directive : require
#include "student_t.glsl"

layout(local_size_x = 64) in;

struct Query {
    vec3 v;     // the view, z up
    uint shape; // its offset in student_t.json
    vec2 sigma; // roughness along x and y
    vec2 u;     // random numbers
};

struct Answer {
    vec3 l;       // the light
    float weight; // f cos/pdf with F = 1, of one bounce
    vec3 m;       // the microfacet normal
    float pdf;    // density of the light, per steradian
    float f;      // f of all further bounces towards that light, without the cosine
    float albedo; // of one bounce, for this view
    float average;
    float masking;
};

layout(std430, binding = 1) readonly buffer Queries { Query queries[]; };
layout(std430, binding = 2) writeonly buffer Answers { Answer answers[]; };

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= uint(queries.length())) return;
    Query q = queries[i];
    StudentTLobe lobe = student_t_lobe_of(q.shape, q.sigma);
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
    answers[i] = a;
}
