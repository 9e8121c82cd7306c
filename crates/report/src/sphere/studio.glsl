// The studio: lamps, backdrop, floor and camera. studio.rs has the same functions, and the constants
// before this text come from there.

// The place on a lamp's plane, in halves of its edges, and the cosine; 0 where it does not shine.
vec3 lamp_place(Lamp lamp, vec3 d) {
    float z = dot(d, lamp.towards);
    if (!(z > 1e-3)) return vec3(0.0);
    vec2 p = vec2(dot(d, lamp.across), dot(d, lamp.up)) / (z * lamp.half_size);
    return max(abs(p.x), abs(p.y)) < 1.0 ? vec3(p, z) : vec3(0.0);
}

vec3 lamp_radiance(Lamp lamp, vec2 p) {
    vec2 edge = (1.0 - abs(p)) * lamp.half_size;
    float x = smoothstep(0.0, lamp.soft, edge.x) * smoothstep(0.0, lamp.soft, edge.y);
    return lamp.radiance * (x * (1.0 - 0.25 * dot(p, p)));
}

vec3 dome(vec3 d) {
    float up = max(d.y, 0.0);
    float facing = max(dot(d, GLOW_TOWARDS), 0.0);
    float square = facing * facing;
    return HORIZON + (ZENITH - HORIZON) * (up * up) + GLOW * (square * square * square);
}

// The light of a point of the floor, and how much of it is floor, not backdrop.
vec4 floor_light(vec3 q) {
    // The sphere, which touches the floor, takes (R/distance)^2 cos of the dome.
    float square = q.x * q.x + q.z * q.z;
    float distance = sqrt(square + 1.0);
    float dome = 1.0 - 1.0 / (distance * distance * distance);
    // How far the key light's middle passes by the sphere, in radii of its penumbra.
    float along = -dot(q, LAMPS[0].towards);
    float passes = sqrt(max(dot(q, q) - along * along, 0.0)) - 1.0;
    float key = smoothstep(-PENUMBRA, PENUMBRA, passes / max(along, 0.2));
    float share = 1.0 - smoothstep(FLOOR_ENDS.x, FLOOR_ENDS.y, sqrt(square));
    return vec4(FLOOR_DOME * dome + FLOOR_KEY * (key * (0.35 + 0.65 * dome)), share);
}

// The light that arrives at a point from a direction; the camera sees no lamps.
vec3 radiance(vec3 from, vec3 d, bool with_lamps) {
    vec3 sum = dome(d);
    if (d.y < 0.0) {
        float t = (from.y + 1.0) / -d.y;
        vec4 light = floor_light(from + max(t, 0.0) * d);
        sum += (light.rgb - sum) * light.a;
    }
    if (with_lamps && d.y > -0.2) {
        for (int i = 0; i < LAMPS.length(); i++) {
            vec3 place = lamp_place(LAMPS[i], d);
            if (place.z > 0.0) sum += lamp_radiance(LAMPS[i], place.xy);
        }
    }
    return sum;
}

// A direction towards a lamp, from two numbers.
vec3 sample_lamp(Lamp lamp, vec2 u) {
    vec2 p = (2.0 * u - 1.0) * lamp.half_size;
    return normalize(lamp.towards + p.x * lamp.across + p.y * lamp.up);
}

// The density of directions towards all lamps, one each, per steradian.
float lamps_pdf(vec3 d) {
    float sum = 0.0;
    for (int i = 0; i < LAMPS.length(); i++) {
        float z = lamp_place(LAMPS[i], d).z;
        vec2 size = LAMPS[i].half_size;
        if (z > 0.0) sum += 1.0 / (4.0 * size.x * size.y * z * z * z);
    }
    return sum;
}

// A direction by the cosine, from two numbers.
vec3 by_cosine(vec2 u) {
    float angle = 6.28318531 * u.y, r = sqrt(u.x);
    return vec3(r * cos(angle), r * sin(angle), sqrt(1.0 - u.x));
}

vec3 camera_ray(vec2 at) {
    return normalize(CAMERA_RIGHT * (at.x * TANGENT) + CAMERA_UP * (at.y * TANGENT) - CAMERA_BACK);
}
