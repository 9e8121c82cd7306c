// A program for fragments, to be appended to student_t_realtime.wgsl: a metal sphere under one
// distant light.

struct Uniforms {
    light: vec3f, // unit vector towards the light
    gamma: f32,
    metal: vec3f, // reflectance at normal incidence
    sigma: vec2f, // roughness along the parallels and along the meridians
    size: vec2f,  // of the view, in pixels
}

@group(0) @binding(0) var masking: texture_2d<f32>;
@group(0) @binding(1) var albedo: texture_3d<f32>;
@group(0) @binding(2) var linear_clamp: sampler;
@group(0) @binding(3) var<uniform> uniforms: Uniforms;

fn area_of(surface: StudentTSurface, w: vec3f) -> f32 {
    let at = student_t_surface_masking_at(surface, w);
    return student_t_surface_area(surface, w, textureSampleLevel(masking, linear_clamp, at, 0.0).x);
}

fn albedo_of(surface: StudentTSurface, cos_theta: f32) -> vec4f {
    let at = student_t_surface_albedo_at(surface, cos_theta);
    return textureSampleLevel(albedo, linear_clamp, at, 0.0);
}

@fragment
fn metal_sphere(@builtin(position) position: vec4f) -> @location(0) vec4f {
    let half_size = 0.5 * uniforms.size;
    let p = (position.xy - half_size) / min(half_size.x, half_size.y) * vec2f(1.0, -1.0);
    let n = vec3f(p, sqrt(max(1.0 - dot(p, p), 0.0)));
    // The tangent frame: x along the parallels, y along the meridians, z the normal.
    let x = normalize(vec3f(n.z, 0.0, -n.x) + vec3f(1e-6, 0.0, 0.0));
    let y = cross(n, x);
    let v = vec3f(x.z, y.z, n.z);
    let l = vec3f(dot(x, uniforms.light), dot(y, uniforms.light), dot(n, uniforms.light));
    if dot(p, p) >= 1.0 || l.z <= 0.0 {
        return vec4f(0.0, 0.0, 0.0, 1.0);
    }
    let surface = student_t_surface(uniforms.gamma, uniforms.sigma);
    let view = albedo_of(surface, v.z);
    let m = normalize(v + l);
    let first = student_t_surface_eval(surface, v, l, m, area_of(surface, v), area_of(surface, l));
    let average = student_t_schlick_average(uniforms.metal, 1.0);
    let further = student_t_further_bounces(view, albedo_of(surface, l.z).x, average);
    let color = student_t_schlick(uniforms.metal, 1.0, dot(v, m)) * first + further * l.z;
    return vec4f(pow(color, vec3f(1.0 / 2.2)), 1.0);
}
