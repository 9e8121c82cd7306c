// A program for compute, to be appended to student_t.wgsl: reflects views off visible normals, as a
// path tracer does, and returns what the light is worth.

struct Query {
    v: vec3f,     // the view, z up
    shape: u32,   // its offset in student_t.json
    sigma: vec2f, // roughness along x and y
    u: vec2f,     // random numbers
}

struct Answer {
    l: vec3f,    // the light
    weight: f32, // f cos/pdf with F = 1, of one bounce
    m: vec3f,    // the microfacet normal
    pdf: f32,    // density of the light, per steradian
    f: f32,      // f of all further bounces towards that light, without the cosine
    albedo: f32, // of one bounce, for this view
    average: f32,
    masking: f32,
}

@group(0) @binding(1) var<storage, read> queries: array<Query>;
@group(0) @binding(2) var<storage, read_write> answers: array<Answer>;

@compute @workgroup_size(64)
fn reflect_views(@builtin(global_invocation_id) id: vec3u) {
    if id.x >= arrayLength(&queries) {
        return;
    }
    let q = queries[id.x];
    let masking = STUDENT_T_HEIGHT_CORRELATED;
    let lobe = student_t_lobe_of(q.shape, q.sigma);
    var a: Answer;
    a.m = student_t_lobe_sample_visible_normal(lobe, q.v, q.u);
    a.l = student_t_reflect(q.v, a.m);
    a.weight = student_t_lobe_reflection_weight(lobe, q.v, a.l, masking);
    a.pdf = student_t_lobe_reflection_pdf(lobe, q.v, a.m);
    a.f = student_t_lobe_compensation(lobe, q.v, a.l, masking);
    a.albedo = student_t_lobe_albedo(lobe, q.v.z, masking);
    a.average = student_t_lobe_albedo_average(lobe, masking);
    a.masking = student_t_lobe_masking(lobe, q.v);
    answers[id.x] = a;
}
