// The exact reflectance of a conductor of index eta + i k, as the crate has it
// (crates/core/src/fresnel.rs), from a cosine in [0, 1]; 1 at grazing.
float conductor(float eta, float k, float mu) {
    float sin2 = 1.0 - mu * mu;
    float real = (eta - 1.0) * (eta + 1.0) - k * k + mu * mu;
    float product = eta * k;
    float modulus = length(vec2(real, 2.0 * product));
    float large = sqrt(0.5 * (modulus + abs(real)));
    if (large == 0.0) return 1.0;
    float small = product / large;
    float a = real >= 0.0 ? large : small, b = real >= 0.0 ? small : large;
    float perpendicular = ((a - mu) * (a - mu) + b * b) / ((a + mu) * (a + mu) + b * b);
    float less = a * mu - sin2, more = a * mu + sin2, across = b * mu;
    float parallel = (less * less + across * across) / (more * more + across * across);
    return 0.5 * perpendicular * (1.0 + parallel);
}

// Of a metal, eta and k in x and y of its channels; or Schlick's, with F0 in x and k < 0.
vec3 reflectance(float mu) {
    float at = clamp(mu, 0.0, 1.0);
    if (metal_k.x < 0.0) {
        float k = 1.0 - at;
        return metal_eta + (1.0 - metal_eta) * ((k * k) * (k * k) * k);
    }
    return vec3(conductor(metal_eta.x, metal_k.x, at), conductor(metal_eta.y, metal_k.y, at),
                conductor(metal_eta.z, metal_k.z, at));
}
