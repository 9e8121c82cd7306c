#version 300 es
// From radiance to what a display shows, as tone.rs has it: Khronos' neutral tone curve, made to
// keep the colours of products, and the transfer function of sRGB.
precision highp float;
uniform highp sampler2D sum;
out vec4 color;

vec3 neutral(vec3 c) {
    const float start = 0.8 - 0.04, desaturation = 0.15;
    float least = min(c.r, min(c.g, c.b));
    c -= least < 0.08 ? least - 6.25 * least * least : 0.04;
    float peak = max(c.r, max(c.g, c.b));
    if (peak < start) return c;
    float d = 1.0 - start;
    float shoulder = 1.0 - d * d / (peak + d - start);
    c *= shoulder / peak;
    float g = 1.0 - 1.0 / (desaturation * (peak - shoulder) + 1.0);
    return mix(c, vec3(shoulder), g);
}

void main() {
    vec4 all = texelFetch(sum, ivec2(gl_FragCoord.xy), 0);
    vec3 c = clamp(neutral(all.rgb / max(all.a, 1.0)), 0.0, 1.0);
    vec3 low = 12.92 * c, high = 1.055 * pow(max(c, 1e-6), vec3(1.0 / 2.4)) - 0.055;
    color = vec4(mix(high, low, vec3(lessThanEqual(c, vec3(0.0031308)))), 1.0);
}
