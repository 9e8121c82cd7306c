// All functions at many points, appended to the exported module of a family. Points and answers are
// the numbers of `Hit` and `At`, in their order.

const HIT = 14u;
const AT = 36u;

@group(0) @binding(1) var<storage, read> hits: array<f32>;
@group(0) @binding(2) var<storage, read_write> answers: array<f32>;

fn three(at: u32) -> vec3f {
    return vec3f(hits[at], hits[at + 1u], hits[at + 2u]);
}

fn write(at: u32, value: vec3f) {
    answers[at] = value.x;
    answers[at + 1u] = value.y;
    answers[at + 2u] = value.z;
}

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3u) {
    if HIT * id.x >= arrayLength(&hits) {
        return;
    }
    let h = HIT * id.x;
    let lobe = student_t_lobe_at(hits[h], vec2f(hits[h + 1u], hits[h + 2u]));
    let v = three(h + 3u);
    let l = three(h + 6u);
    let m = three(h + 9u);
    let u = vec2f(hits[h + 12u], hits[h + 13u]);
    let a = AT * id.x;
    answers[a] = lobe.gamma;
    answers[a + 1u] = student_t_lobe_d(lobe, m);
    answers[a + 2u] = student_t_lobe_masking(lobe, v);
    answers[a + 3u] = student_t_lobe_lambda(lobe, v);
    answers[a + 4u] = student_t_lobe_visible_normal_pdf(lobe, v, m);
    answers[a + 5u] = student_t_lobe_reflection_pdf(lobe, v, m);
    write(a + 6u, student_t_lobe_sample_visible_normal(lobe, v, u));
    for (var k = 0u; k < 2u; k++) {
        answers[a + 9u + k] = student_t_lobe_masking_shadowing(lobe, v, l, k);
        answers[a + 11u + k] = student_t_lobe_reflection_weight(lobe, v, l, k);
        let f_pdf = student_t_lobe_eval_pdf(lobe, v, l, k);
        answers[a + 13u + k] = f_pdf.x;
        answers[a + 15u + k] = f_pdf.y;
        answers[a + 17u + k] = student_t_lobe_albedo(lobe, v.z, k);
        answers[a + 19u + k] = student_t_lobe_albedo_average(lobe, k);
        write(a + 21u + 3u * k, student_t_lobe_albedo_parts(lobe, v.z, k));
        write(a + 27u + 3u * k, student_t_lobe_albedo_average_parts(lobe, k));
        answers[a + 33u + k] = student_t_lobe_compensation(lobe, v, l, k);
    }
    answers[a + 35u] = select(0.0, 1.0, student_t_effectively_smooth(lobe));
}
