//! The inputs for the instruction counts of `benches/instructions.rs`.

use glam::Vec3;

use microfacet_sampler::lobe::Bounded;
use microfacet_sampler::{
    BsdfSettings, Conductor, ConductorFresnel, Ellipsoid, Family, MicrofacetDistribution, Skew,
    StudentT, Tables,
};

/// Calls of each function; a count divided by it is instructions per call.
pub const CALLS: usize = 1000;

/// Roughness of the material.
pub const SIGMA: [f32; 2] = [0.3, 0.5];

/// A lobe, views, pairs of numbers and the normals they give, the same on every machine; and room
/// for G1 of the views.
pub struct Inputs<L> {
    pub lobe: L,
    pub v: Vec<Vec3>,
    pub u: Vec<[f32; 2]>,
    pub m: Vec<Vec3>,
    pub g1: Vec<f32>,
}

impl Inputs<StudentT> {
    /// From the default tables at γ.
    pub fn new(gamma: f64) -> Self {
        Self::of(Tables::embedded().student_t(SIGMA, gamma).expect("covered by the default set"))
    }
}

impl Inputs<Bounded> {
    /// The lobe of [`Inputs::new`], bounded to reflections; `g1` has room for shares.
    pub fn bounded(gamma: f64) -> Self {
        let Inputs { lobe, v, u, m, g1 } = Inputs::new(gamma);
        Self { lobe: lobe.bounded(), v, u, m, g1 }
    }
}

impl Inputs<Ellipsoid> {
    /// A tilted lobe, and views above the surface but below the lobe's own horizon.
    pub fn below(gamma: f64) -> Self {
        let skew = Skew::new([0.3, 0.1], [0.2, -0.5, 0.5]).expect("a lobe that can be tilted so");
        let lobe = Tables::embedded().ellipsoid(skew, gamma).expect("covered by the default set");
        let Inputs { lobe, u, m, g1, .. } = Self::of(lobe);
        // Along the slope of the mean normal, at cosines of up to 0.2.
        let lean = (skew.x * skew.x + skew.y * skew.y).sqrt();
        let v = (0..CALLS).map(|i| {
            let z = 0.2 * (i as f64 + 0.5) / CALLS as f64;
            let r = -(1.0 - z * z).sqrt() / lean;
            Vec3::new((r * skew.x) as f32, (r * skew.y) as f32, z as f32)
        });
        Self { lobe, v: v.collect(), u, m, g1 }
    }
}

/// The family of the default set, γ, and the inputs of [`Inputs::new`].
pub fn family(gamma: f64) -> (Family, f32, Inputs<StudentT>) {
    let family = Tables::embedded().family().expect("the default set has ranges");
    (family, gamma as f32, Inputs::new(gamma))
}

/// A conductor with the lobe of [`Inputs::new`] and Schlick's reflectance, and those inputs.
pub fn conductor(gamma: f64) -> (Conductor<StudentT>, Inputs<StudentT>) {
    let inputs = Inputs::new(gamma);
    let fresnel = ConductorFresnel::schlick([0.9, 0.7, 0.3]).expect("reflectances");
    let conductor = Conductor::new(inputs.lobe.clone(), fresnel, BsdfSettings::new());
    (conductor.expect("no albedo is needed"), inputs)
}

impl<L: MicrofacetDistribution> Inputs<L> {
    /// Views and numbers from additive recurrences of the golden ratio's generalisation to higher
    /// dimensions (Roberts 2018,
    /// <https://extremelearning.com.au/unreasonable-effectiveness-of-quasirandom-sequences/>).
    /// Cosines of views are even in (0, 1); their azimuths avoid trigonometry and are therefore not
    /// even.
    pub fn of(lobe: L) -> Self {
        let at = |i: usize, step: f64| (i as f64 * step).fract() as f32;
        let views = (0..CALLS).map(|i| {
            let (z, t) =
                (at(i, 0.819_172_513_396_164_4), 2.0 * at(i, 0.671_043_606_703_789_2) - 1.0);
            let r = (1.0 - z * z).sqrt() / (1.0 + t * t);
            Vec3::new(r * (1.0 - t * t), r * 2.0 * t, z)
        });
        let numbers =
            (0..CALLS).map(|i| [at(i, 0.754_877_666_246_692_7), at(i, 0.569_840_290_998_053_3)]);
        let (v, u): (Vec<_>, Vec<_>) = (views.collect(), numbers.collect());
        let m = v.iter().zip(&u).map(|(v, u)| lobe.sample_visible_normal(*v, *u).into()).collect();
        Self { lobe, v, u, m, g1: vec![0.0; CALLS] }
    }
}
