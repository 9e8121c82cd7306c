// A sphere of metal under one round light, appended to the exported module: the same steps, in the
// same order, as in `sphere.rs`.

struct Scene {
    light: vec3f,    // unit vector towards the light
    rim: f32,        // cosine of its radius
    metal: vec3f,    // reflectance at normal incidence
    radiance: f32,   // of the middle of the light
    sigma: f32,
    shape: u32,
    size: u32,       // of the picture
    samples: u32,    // of a pixel
}

@group(0) @binding(1) var<storage, read> scenes: array<Scene>;
@group(0) @binding(2) var<storage, read_write> picture: array<vec4f>;

var<private> state: u32;

// A random number in [0, 1) (PCG by O'Neill 2014).
fn random() -> f32 {
    state = state * 747796405u + 2891336453u;
    let word = ((state >> ((state >> 28u) + 4u)) ^ state) * 277803737u;
    return f32(((word >> 22u) ^ word) >> 8u) / 16777216.0;
}

// A tangent frame (Duff et al. 2017), as columns.
fn frame(n: vec3f) -> mat3x3f {
    let s = select(-1.0, 1.0, n.z >= 0.0);
    let a = -1.0 / (s + n.z);
    let b = n.x * n.y * a;
    return mat3x3f(
        vec3f(1.0 + s * n.x * n.x * a, s * b, -s * n.x),
        vec3f(b, s + n.y * n.y * a, -n.y),
        n,
    );
}

// f cos of the metal, all bounces.
fn f_cos(scene: Scene, v: vec3f, l: vec3f, m: vec3f) -> vec3f {
    let sigma = vec2f(scene.sigma);
    let masking = STUDENT_T_HEIGHT_CORRELATED;
    let k = 1.0 - dot(v, m);
    let fresnel = scene.metal + (1.0 - scene.metal) * (k * k * k * k * k);
    let facets = student_t_d(scene.shape, sigma, m)
        * student_t_masking_shadowing(scene.shape, sigma, v, l, masking) / (4.0 * v.z);
    let average = (20.0 * scene.metal + 1.0) / 21.0;
    let albedo = student_t_albedo_average(scene.shape, sigma, masking);
    let further = average * average * albedo / (1.0 - average * (1.0 - albedo))
        * student_t_compensation(scene.shape, sigma, v, l, masking);
    return fresnel * facets + further * l.z;
}

// Light drawn by the light, and by the metal, each weighted by the balance heuristic.
fn reflected(scene: Scene, n: vec3f, to_viewer: vec3f) -> vec3f {
    let local = transpose(frame(n));
    let v = local * to_viewer;
    if v.z <= 0.0 {
        return vec3f(0.0);
    }
    let sigma = vec2f(scene.sigma);
    let axis = local * scene.light;
    let cap = 6.2831853 * (1.0 - scene.rim);
    let z = 1.0 - random() * (1.0 - scene.rim);
    let turn = 6.2831853 * random();
    let r = sqrt((1.0 - z) * (1.0 + z));
    let by_light = frame(axis) * vec3f(r * cos(turn), r * sin(turn), z);
    let u = vec2f(random(), random());
    let facet = student_t_sample_visible_normal(scene.shape, sigma, v, u);
    let by_metal = student_t_reflect(v, facet);
    var sum = vec3f(0.0);
    for (var k = 0; k < 2; k++) {
        let l = select(by_metal, by_light, k == 0);
        let brightness = max((dot(l, axis) - scene.rim) / (1.0 - scene.rim), 0.0);
        if l.z > 0.0 && brightness > 0.0 {
            let m = normalize(v + l);
            let pdf = student_t_reflection_pdf(scene.shape, sigma, v, m);
            sum += scene.radiance * brightness / (pdf + 1.0 / cap) * f_cos(scene, v, l, m);
        }
    }
    return sum;
}

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3u) {
    let scene = scenes[0];
    if id.x >= scene.size * scene.size {
        return;
    }
    state = id.x;
    let x = f32(id.x % scene.size);
    let y = f32(id.x / scene.size);
    var sum = vec3f(0.0);
    for (var i = 0u; i < scene.samples; i++) {
        // Orthographic, the viewer along z, the sphere of radius 1 in a picture of width 2.2.
        let p = 2.2 * vec2f((x + random()) / f32(scene.size) - 0.5,
                            0.5 - (y + random()) / f32(scene.size));
        let square = dot(p, p);
        if square < 1.0 {
            sum += reflected(scene, vec3f(p, sqrt(1.0 - square)), vec3f(0.0, 0.0, 1.0));
        }
    }
    picture[id.x] = vec4f(sum / f32(scene.samples), 1.0);
}
