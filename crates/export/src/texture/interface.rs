//! Textures of dielectric interfaces: the shares of light that are reflected and transmitted, seen
//! from either side, over indices, roughnesses and views.
//!
//! As σ → 0 the shares become those of a smooth interface, F(μ) and 1 − F(μ), which no texture of
//! few texels holds. A texel is what they exceed them by, where F is softened about the critical
//! angle: total reflection sets in there like a square root, over a width of the roughness.

use microfacet_core::Masking;

use super::axis::{Along, Place, TexelAxis};
use super::truth::Channel;
use super::{KAPPA, LEAST_COS, MOST_FITTED, Shapes, TextureSpec, check_size, check_surface};

/// The smallest and the largest index of refraction of textures, of the denser medium over that of
/// the other. Nearer 1 the shares of views near the horizon change from those of glass to those of
/// no interface within less than a texel.
pub const ETA: [f64; 2] = [1.05, 3.0];

// The constants of the coordinate of views from inside were found by measuring: their effects are
// on the largest error of either share in 32 × 32 texels of η = 1.5, which is 2.9e-3
// (`export lut --gamma 2 --sigma-max 1 --eta 1.5 --size 32x32 --format npy`).

/// The largest share of x^0.3, and how far it ends beyond a texel, in texels. On smooth surfaces
/// all views between the horizon and the critical angle, and all beyond it, stand close to that
/// place; half a texel off, errors double. With a share of 0.6 they are 5.0e-3.
const NEAR: f64 = 0.45;
const BEYOND: f64 = 0.1;
/// The width of the step at the critical angle, over σμ sin θ in units of μ². With half of it the
/// error is 5.4e-3, with twice as much 6.2e-3.
pub(super) const WIDTH: f64 = 3.2;
/// κ of x = μ/(μ + κσ sin θ): scale and heavy of [`kappa`](microfacet_tables::axis::ViewBlend).
/// With [`KAPPA`] the error is 2.8e-3, but 4.2e-3 instead of 3.5e-3 in the three cells up to η =
/// 2.5 of a volume of 32 texels a side.
pub(super) const KNEE: [f64; 2] = [6.5, 0.5];
/// The power of x. With that of E, ¼, which leaves too few texels for the critical angle, the error
/// is 4.5e-3.
pub(super) const POWER: f64 = 0.3;

/// The indices of refraction of a texture, of the denser medium over that of the other.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Indices {
    /// One; the texture has the axes s and t.
    One(f64),
    /// All between two; the texture has the axes η, s and t.
    Between([f64; 2]),
}

/// The two numbers in which a view of an interface differs from one of a mirror.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bend {
    /// μ² + η² − 1 = (η cos θ_t)², which is below 0 where a smooth interface reflects all light.
    past: f64,
    /// σμ sin θ, the width in `past` over which facets of a rough one begin to.
    rim: f64,
}

impl Bend {
    pub(super) fn new(eta: f64, sigma: f64, cos: f64) -> Self {
        let past = (eta - 1.0) * (eta + 1.0) + cos * cos;
        Self { past, rim: sigma * cos * ((1.0 - cos) * (1.0 + cos)).sqrt() }
    }

    /// From −1 to 1 through the critical angle.
    pub(super) fn step(self) -> f64 {
        let whole = self.past.abs() + WIDTH * self.rim;
        if whole > 0.0 { self.past / whole } else { 0.0 }
    }

    /// η cos θ_t: where all light is reflected not 0, but what keeps it smooth.
    fn softened(self) -> f64 {
        let whole = self.past.abs() + self.rim;
        let soft = if whole > 0.0 { 0.5 * self.rim * self.rim / whole } else { 0.0 };
        (self.past.max(0.0) + soft).sqrt()
    }
}

/// The reflectance of a smooth interface of relative index η, softened about the critical angle by
/// the roughness. The formula is that of Cook and Torrance (1982,
/// <https://doi.org/10.1145/357290.357293>), in which the index stands in g = η cos θ_t alone.
pub(super) fn soft_reflectance(eta: f64, sigma: f64, cos: f64) -> f64 {
    let g = Bend::new(eta, sigma, cos).softened();
    if cos + g == 0.0 {
        return 1.0;
    }
    let across = (cos - g) / (cos + g);
    let along = (cos * (cos + g) - 1.0) / (cos * (g - cos) + 1.0);
    0.5 * across * across * (1.0 + along * along)
}

/// The coordinate of a view from inside: it crowds within the roughness of the horizon, and within
/// that of the critical angle.
pub(super) fn critical_coordinate(near: f64, place: &Place, eta: f64, cos: f64) -> f64 {
    let [scale, heavy] = KNEE;
    let knee = scale + heavy / (2.0 * place.gamma - 3.0);
    let whole = cos + knee * place.sigma * ((1.0 - cos) * (1.0 + cos)).sqrt();
    let x = if whole > 0.0 { cos / whole } else { 0.0 };
    let step = Bend::new(eta, place.sigma, cos).step();
    near * x.powf(POWER) + 0.5 * (1.0 - near) * (1.0 + step)
}

/// The share of x^0.3 in [`critical_coordinate`] along n texels.
fn near(n: usize) -> f64 {
    let cells = (n - 1) as f64;
    ((NEAR * cells).round() + BEYOND) / cells
}

/// √((η−1)/(η+1)), the same for both sides; the fourth root of the reflectance at the normal.
pub(super) fn index_coordinate(eta: f64) -> f64 {
    ((eta - 1.0).abs() / (eta + 1.0)).sqrt()
}

impl TextureSpec {
    /// Textures of the shares from outside and from inside, with `_outside` and `_inside` after the
    /// name, each with that of its averages; `size` texels along η (if there is a range), s and t.
    ///
    /// # Panics
    /// Unless `size` has one number for each axis, of at least two.
    pub fn of_interface(
        name: &str,
        gamma: f64,
        indices: Indices,
        sigma_max: f64,
        size: &[usize],
        masking: Masking,
    ) -> [Self; 4] {
        let of_side = |inside: bool| {
            let view = if inside {
                Along::Critical { near: near(size[size.len() - 1]) }
            } else {
                Along::view(KAPPA[0], KAPPA[1])
            };
            let mut along = vec![Along::Roughness { largest: sigma_max }, view];
            let eta = match indices {
                Indices::One(eta) => Some(if inside { 1.0 / eta } else { eta }),
                Indices::Between(ends) => {
                    along.insert(0, Along::Index { ends, inside });
                    None
                }
            };
            assert_eq!(size.len(), along.len(), "a size for each axis");
            let axes = along.into_iter().zip(size).map(|(along, &n)| TexelAxis::to_ends(along, n));
            let side = if inside { "inside" } else { "outside" };
            let directional = Self {
                name: format!("{name}_{side}"),
                gamma,
                eta,
                axes: axes.collect(),
                masking,
                channels: vec![Channel::ReflectedExcess, Channel::TransmittedExcess],
                least_cos: LEAST_COS,
                fitted: size.iter().product::<usize>() <= MOST_FITTED,
            };
            let average = directional.average(&format!("{name}_{side}_average"));
            [directional, average]
        };
        let [[outside, of_outside], [inside, of_inside]] = [of_side(false), of_side(true)];
        [outside, inside, of_outside, of_inside]
    }

    /// The side of an interface that it is of, if it is of one.
    pub fn side(&self) -> Option<&'static str> {
        let inside = self.axes.iter().find_map(|axis| axis.along.inside());
        let inside = inside.or(self.eta.map(|eta| eta < 1.0))?;
        Some(if inside { "inside" } else { "outside" })
    }
}

/// Checks the shape, the indices, the largest roughness and the size of textures of an interface.
///
/// # Errors
/// A message with the value, what is allowed, and what to do.
pub fn check_interface(
    gamma: f64,
    indices: Indices,
    sigma_max: f64,
    size: &[usize],
) -> Result<(), String> {
    check_surface(Shapes::One(gamma), sigma_max)?;
    let [least, most] = ETA;
    let (axes, form, ends) = match indices {
        Indices::One(eta) => (2, "SxT, as 64x64", [eta, eta]),
        Indices::Between(ends) => (3, "HxSxT, as 32x32x32", ends),
    };
    if let Some(eta) = ends.iter().find(|eta| !(least..=most).contains(*eta)) {
        return Err(format!(
            "eta = {eta} must lie in [{least}, {most}]; it is the index of the denser medium over \
             that of the other, for views from either side"
        ));
    }
    if matches!(indices, Indices::Between([low, high]) if !(high - low >= 1e-3)) {
        return Err(format!(
            "eta = {}..{}: a range goes from a smaller to a larger index, at least 0.001 apart, as \
             1.05..2.5; for one index give one number, as 1.5",
            ends[0], ends[1]
        ));
    }
    check_size("a texture of an interface", size, axes, form)
}

#[cfg(test)]
mod tests {
    use microfacet_core::fresnel::dielectric;

    use super::*;

    #[test]
    fn without_roughness_the_reflectance_is_exact() {
        for eta in [0.4, 0.6667, 0.99, 1.0, 1.0001, 1.5, 3.0] {
            for cos in [1e-4, 0.01, 0.3, 0.745, 0.7454, 0.9, 1.0] {
                let (found, want) = (soft_reflectance(eta, 0.0, cos), dielectric(eta, cos));
                assert!((found - want).abs() < 1e-12, "{eta}, {cos}: {found} for {want}");
                let rough = soft_reflectance(eta, 1.0, cos);
                assert!((0.0..=1.0).contains(&rough), "{eta}, {cos}: {rough}");
            }
        }
    }

    #[test]
    fn views_crowd_at_the_critical_angle() {
        let eta: f64 = 1.0 / 1.5;
        let critical = (1.0 - eta * eta).sqrt();
        for sigma in [1e-6, 1e-3, 0.1] {
            let place = Place { sigma, ..Place::of_shape(2.0) };
            let of = |cos| critical_coordinate(near(32), &place, eta, cos);
            // A quarter of the texels and more within a few roughnesses of it.
            let around = of((critical + 5.0 * sigma).min(1.0)) - of(critical - 5.0 * sigma);
            assert!(around > 0.25, "{sigma}: {around}");
            assert!(of(0.0) == 0.0 && of(1.0) == 1.0);
        }
    }
}
