//! GGX, γ = 2: both closed-form samplers of visible normals, and G1.
//!
//! In single precision as renderers have them, and in double as the truth that their rounding is measured against.

macro_rules! in_precision {
    ($name:ident, $float:ident, $vec:ident) => {
        pub(crate) mod $name {
            use std::$float::consts::TAU;

            use glam::$vec as Vector;

            /// Dupuy and Benyoub 2023, "Sampling Visible GGX Normals with Spherical Caps", listing 1: `u[1]` is the height on the cap.
            #[inline(always)]
            pub(crate) fn caps(sigma: $float, v: Vector, u: [$float; 2]) -> Vector {
                let w = Vector::new(sigma * v.x, sigma * v.y, v.z);
                let w = w * (1.0 / w.dot(w).sqrt());
                let z = (1.0 - u[1]) * (1.0 + w.z) - w.z;
                let sin_theta = (1.0 - z * z).clamp(0.0, 1.0).sqrt();
                let (sin, cos) = (TAU * u[0]).sin_cos();
                let (x, y, z) = (w.x + sin_theta * cos, w.y + sin_theta * sin, w.z + z);
                let m = Vector::new(sigma * x, sigma * y, z);
                m * (1.0 / m.dot(m).sqrt())
            }

            /// Heitz 2018, "Sampling the GGX Distribution of Visible Normals", listing 1.
            #[inline(always)]
            pub(crate) fn heitz(sigma: $float, v: Vector, u: [$float; 2]) -> Vector {
                let w = Vector::new(sigma * v.x, sigma * v.y, v.z);
                let w = w * (1.0 / w.dot(w).sqrt());
                let across = w.x * w.x + w.y * w.y;
                let t1 = if across > 0.0 {
                    Vector::new(-w.y, w.x, 0.0) * (1.0 / across.sqrt())
                } else {
                    Vector::X
                };
                let t2 = w.cross(t1);
                let r = u[0].sqrt();
                let (sin, cos) = (TAU * u[1]).sin_cos();
                let (p1, s) = (r * cos, 0.5 * (1.0 + w.z));
                let p2 = (1.0 - s) * (1.0 - p1 * p1).max(0.0).sqrt() + s * (r * sin);
                let up = (1.0 - p1 * p1 - p2 * p2).max(0.0).sqrt();
                let m = p1 * t1 + p2 * t2 + up * w;
                let m = Vector::new(sigma * m.x, sigma * m.y, m.z.max(0.0));
                m * (1.0 / m.dot(m).sqrt())
            }
        }
    };
}

in_precision!(single, f32, Vec3);
in_precision!(double, f64, DVec3);

/// G1 = 2 cos θ/(cos θ + √(cos²θ + σ² sin²θ)) (Walter et al. 2007, eq. 34), without its tangent.
#[inline(always)]
pub(crate) fn g1(sigma: f32, w: glam::Vec3) -> f32 {
    let (x, y) = (sigma * w.x, sigma * w.y);
    2.0 * w.z / (w.z + (w.z * w.z + x * x + y * y).sqrt())
}
