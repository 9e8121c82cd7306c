//! GGX, γ = 2: both closed-form samplers of visible normals, D and G1.
//!
//! In single precision as renderers have them, and in double as the reference for their rounding.

macro_rules! in_precision {
    ($name:ident, $float:ident, $vec:ident, $turn:expr) => {
        pub(crate) mod $name {
            use glam::$vec as Vector;

            /// Dupuy and Benyoub 2023, "Sampling Visible GGX Normals with Spherical Caps"
            /// (doi:10.1111/cgf.14867), listings 1 and 3, as printed: the view is normalised after
            /// its stretch, and sine and cosine are the platform's. `u[0]` is the azimuth about n,
            /// `u[1]` the height on the cap.
            #[inline(always)]
            pub(crate) fn listed(sigma: $float, v: Vector, u: [$float; 2]) -> Vector {
                let w = Vector::new(sigma * v.x, sigma * v.y, v.z).normalize();
                let (sin, cos) = (std::$float::consts::TAU * u[0]).sin_cos();
                let z = (1.0 - u[1]) * (1.0 + w.z) - w.z;
                let radius = (1.0 - z * z).clamp(0.0, 1.0).sqrt();
                let m = Vector::new(radius * cos, radius * sin, z) + w;
                Vector::new(sigma * m.x, sigma * m.y, m.z).normalize()
            }

            /// The same sampler, faster: the stretched view is not normalised, only the half
            /// vector.
            #[inline(always)]
            pub(crate) fn caps(sigma: $float, v: Vector, u: [$float; 2]) -> Vector {
                let w = Vector::new(sigma * v.x, sigma * v.y, v.z);
                let square = w.dot(w);
                let height = (1.0 - u[1]) * (square.sqrt() + w.z);
                let z = height - w.z;
                let radius = (square - z * z).max(0.0).sqrt();
                let [sin, cos] = $turn(u[0]);
                let m =
                    Vector::new(sigma * (w.x + radius * cos), sigma * (w.y + radius * sin), height);
                m * (1.0 / m.dot(m).sqrt())
            }

            /// Heitz 2018, "Sampling the GGX Distribution of Visible Normals"
            /// (<https://jcgt.org/published/0007/04/01/>), listing 1, with its cross product
            /// written out and one division for both lengths.
            #[inline(always)]
            pub(crate) fn heitz(sigma: $float, v: Vector, u: [$float; 2]) -> Vector {
                let (x, y) = (sigma * v.x, sigma * v.y);
                let across = x * x + y * y;
                let (rho, length) = (across.sqrt(), (across + v.z * v.z).sqrt());
                let inverse = 1.0 / (rho * length);
                // The azimuth and the elevation of the view.
                let (cos_phi, sin_phi) = if across > 0.0 {
                    (x * length * inverse, y * length * inverse)
                } else {
                    (1.0, 0.0)
                };
                let (sin_theta, cos_theta) =
                    if across > 0.0 { (across * inverse, v.z * rho * inverse) } else { (0.0, 1.0) };
                let r = u[0].sqrt();
                let [sin, cos] = $turn(u[1]);
                let (p1, s) = (r * cos, 0.5 * (1.0 + cos_theta));
                let rest = 1.0 - p1 * p1;
                let p2 = (1.0 - s) * rest.max(0.0).sqrt() + s * (r * sin);
                let up = (rest - p2 * p2).max(0.0).sqrt();
                // p₁ along (−sin φ, cos φ, 0), p₂ along the view's cross product with that.
                let out = up * sin_theta - p2 * cos_theta;
                let m = Vector::new(
                    sigma * (out * cos_phi - p1 * sin_phi),
                    sigma * (out * sin_phi + p1 * cos_phi),
                    (p2 * sin_theta + up * cos_theta).max(0.0),
                );
                m * (1.0 / m.dot(m).sqrt())
            }
        }
    };
}

in_precision!(single, f32, Vec3, crate::rivals::elementary::turn);
in_precision!(double, f64, DVec3, super::turn);

/// The sine and the cosine of 2πu.
fn turn(u: f64) -> [f64; 2] {
    (std::f64::consts::TAU * u).sin_cos().into()
}

/// G1 = 2 cos θ/(cos θ + √(cos²θ + σ² sin²θ)) (Walter et al. 2007, doi:10.2312/EGWR/EGSR07/195-206,
/// eq. 34), without its tangent.
#[inline(always)]
pub(crate) fn g1(sigma: f32, w: glam::Vec3) -> f32 {
    let (x, y) = (sigma * w.x, sigma * w.y);
    2.0 * w.z / (w.z + (w.z * w.z + x * x + y * y).sqrt())
}

/// D = 1/(πσ² (cos²θ + sin²θ/σ²)²) (Walter et al. 2007, eq. 33), without its tangent.
#[inline(always)]
pub(crate) fn d(sigma: f32, m: glam::Vec3) -> f32 {
    let b = (sigma * sigma) * (m.z * m.z) + (m.x * m.x + m.y * m.y);
    (sigma * sigma * std::f32::consts::FRAC_1_PI) / (b * b)
}
