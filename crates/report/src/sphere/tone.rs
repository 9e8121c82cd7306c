//! From radiance to what a display shows.

use glam::Vec3;

/// Khronos' neutral tone curve (<https://github.com/KhronosGroup/ToneMapping>), which keeps colours
/// below its shoulder but for an offset, then [`srgb`]. `present.frag` has the same.
pub(super) fn display(radiance: Vec3) -> [u8; 3] {
    const START: f32 = 0.8 - 0.04;
    const DESATURATION: f32 = 0.15;
    let least = radiance.min_element();
    let offset = if least < 0.08 { least - 6.25 * least * least } else { 0.04 };
    let mut color = radiance - offset;
    let peak = color.max_element();
    if peak >= START {
        let d = 1.0 - START;
        let new = 1.0 - d * d / (peak + d - START);
        color *= new / peak;
        let g = 1.0 - 1.0 / (DESATURATION * (peak - new) + 1.0);
        color += (new - color) * g;
    }
    color.to_array().map(|x| (255.0 * srgb(x.clamp(0.0, 1.0).into()) + 0.5) as u8)
}

/// The transfer function of sRGB (IEC 61966-2-1): from a share of white to what is stored of it.
pub fn srgb(x: f64) -> f64 {
    if x <= 0.003_130_8 { 12.92 * x } else { 1.055 * x.powf(1.0 / 2.4) - 0.055 }
}
