// One more sample of each pixel, added to those before. scene.rs does the same in Rust.

uniform highp uint shape;      // the place of the tables whose lobe is seen
uniform highp uint drawn;      // and of those that normals are drawn from
uniform vec2 sigma;
uniform vec3 metal_eta;
uniform vec3 metal_k;
uniform float compensated;     // 1 or 0
uniform vec3 returned;         // the factor of Kulla and Conty's lobe, by channel
uniform float gamma;           // for the coordinate of albedos; 1e30 stands for infinity
uniform float layer;           // of the shape among albedos, in [0, 1]
uniform highp sampler3D lost;  // sqrt(1 - E) by layer, roughness and view
uniform highp uint index;      // of the sample
uniform highp uint seed;
uniform float size;            // pixels along an edge
uniform highp sampler2D before;
out vec4 color;

uvec3 pcg3d(uvec3 v) {
    v = v * 1664525u + 1013904223u;
    v.x += v.y * v.z; v.y += v.z * v.x; v.z += v.x * v.y;
    v ^= v >> 16u;
    v.x += v.y * v.z; v.y += v.z * v.x; v.z += v.x * v.y;
    return v;
}

vec3 numbers(uvec2 pixel, uint set, uvec3 steps) {
    uvec3 whole = pcg3d(uvec3(pixel, seed * 3u + set)) + index * steps;
    return vec3(whole >> 8u) / 16777216.0;
}

float tent(float u) {
    float t = 2.0 * u - 1.0;
    float x = 1.0 - sqrt(1.0 - abs(t));
    return t < 0.0 ? -x : x;
}

float lost_at(float mu) {
    vec2 at = albedo_coordinates(gamma, sqrt(sigma.x * sigma.y), max(mu, 1e-4));
    float root = texture(lost, vec3(at, layer)).r;
    return root * root;
}

mat3 frame_at(vec3 n) {
    vec3 across = vec3(n.z, 0.0, -n.x);
    float reach = length(across);
    vec3 x = reach > 1e-6 ? across / reach : vec3(1.0, 0.0, 0.0);
    return mat3(x, cross(n, x), n);
}

// What a light adds, whichever way it was drawn: f cos L over the sum of all densities.
vec3 share(vec3 n, mat3 frame, vec3 v, float lost_v, vec3 l) {
    vec3 m = normalize(v + l);
    float facing = dot(v, m);
    if (!(v.z > 0.0 && l.z > 0.0 && facing > 0.0)) return vec3(0.0);
    vec3 towards = frame * l;
    float pdf = student_t_reflection_pdf(drawn, sigma, v, m) + lamps_pdf(towards);
    uint masking = STUDENT_T_HEIGHT_CORRELATED;
    float facets = student_t_d(shape, sigma, m)
        * student_t_masking_shadowing(shape, sigma, v, l, masking) / (4.0 * v.z);
    vec3 f = reflectance(facing) * facets;
    if (compensated > 0.0) {
        pdf += l.z / 3.14159265;
        f += returned * (lost_v * lost_at(l.z) * l.z);
    }
    if (!(pdf > 0.0)) return vec3(0.0);
    return f / pdf * radiance(n, towards, true);
}

vec3 shade(vec3 n, vec3 d, vec3 a, vec3 b, vec3 c) {
    mat3 frame = frame_at(n);
    vec3 v = -d * frame;
    float lost_v = compensated > 0.0 ? lost_at(v.z) : 0.0;
    vec3 m = student_t_sample_visible_normal(drawn, sigma, v, vec2(a.z, b.x));
    vec3 sum = share(n, frame, v, lost_v, student_t_reflect(v, m));
    for (int i = 0; i < LAMPS.length(); i++) {
        sum += share(n, frame, v, lost_v, sample_lamp(LAMPS[i], b.yz) * frame);
    }
    if (compensated > 0.0) sum += share(n, frame, v, lost_v, by_cosine(c.xy));
    return sum;
}

void main() {
    uvec2 pixel = uvec2(gl_FragCoord.xy);
    vec3 a = numbers(pixel, 0u, STEPS_0);
    vec2 at = 2.0 * (vec2(pixel) + 0.5 + vec2(tent(a.x), tent(a.y))) / size - 1.0;
    vec3 d = camera_ray(at);
    vec3 nearest = EYE - dot(EYE, d) * d;
    float square = 1.0 - dot(nearest, nearest);
    vec3 sum;
    if (square > 0.0) {
        vec3 n = normalize(nearest - sqrt(square) * d);
        sum = shade(n, d, a, numbers(pixel, 1u, STEPS_1), numbers(pixel, 2u, STEPS_2));
    } else {
        sum = radiance(EYE, d, false);
    }
    // What is no number would stay for good.
    if (!(dot(sum, vec3(1.0)) < 1e6)) sum = vec3(0.0);
    color = texelFetch(before, ivec2(pixel), 0) + vec4(sum, 1.0);
}
