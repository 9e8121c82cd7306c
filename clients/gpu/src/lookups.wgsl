// All functions at many points, appended to the exported module. Points and answers are the numbers
// of `Point` and `Answer`, in their order.

const POINT = 13u;
const ANSWER = 33u;

@group(0) @binding(1) var<storage, read> points: array<f32>;
@group(0) @binding(2) var<storage, read_write> answers: array<f32>;
@group(0) @binding(3) var<uniform> shape: vec4u;

fn three(at: u32) -> vec3f {
    return vec3f(points[at], points[at + 1u], points[at + 2u]);
}

fn write(at: u32, value: vec3f) {
    answers[at] = value.x;
    answers[at + 1u] = value.y;
    answers[at + 2u] = value.z;
}

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3u) {
    if POINT * id.x >= arrayLength(&points) {
        return;
    }
    let s = shape.x;
    let p = POINT * id.x;
    let sigma = vec2f(points[p], points[p + 1u]);
    let v = three(p + 2u);
    let l = three(p + 5u);
    let m = three(p + 8u);
    let u = vec2f(points[p + 11u], points[p + 12u]);
    let a = ANSWER * id.x;
    answers[a] = student_t_d(s, sigma, m);
    answers[a + 1u] = student_t_masking(s, sigma, v);
    answers[a + 2u] = student_t_lambda(s, sigma, v);
    answers[a + 3u] = student_t_visible_normal_pdf(s, sigma, v, m);
    answers[a + 4u] = student_t_reflection_pdf(s, sigma, v, m);
    write(a + 5u, student_t_sample_visible_normal(s, sigma, v, u));
    write(a + 8u, student_t_reflect(v, m));
    for (var k = 0u; k < 2u; k++) {
        answers[a + 11u + k] = student_t_masking_shadowing(s, sigma, v, l, k);
        answers[a + 13u + k] = student_t_reflection_weight(s, sigma, v, l, k);
        answers[a + 15u + k] = student_t_compensation(s, sigma, v, l, k);
        answers[a + 17u + k] = student_t_albedo(s, sigma, v.z, k);
        answers[a + 19u + k] = student_t_albedo_average(s, sigma, k);
        write(a + 21u + 3u * k, student_t_albedo_parts(s, sigma, v.z, k));
        write(a + 27u + 3u * k, student_t_albedo_average_parts(s, sigma, k));
    }
}
