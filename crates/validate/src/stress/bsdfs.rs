//! The BSDFs that are tried with a lobe.

use microfacet_sampler::lobe::Smooth;
use microfacet_sampler::{
    Compensation, Conductor, ConductorFresnel, Dielectric, Lobe, Masking, Plastic, StandIn, Tables,
};

/// Indices of refraction, among them both ends of the allowed range, and 1.
const ETAS: [f64; 8] = [1e-3, 0.5, 1.0, 1.000_02, 1.05, 1.5, 2.4, 1e3];
pub(super) struct Bsdfs {
    pub(super) conductors: Vec<Conductor<Lobe, 1>>,
    pub(super) dielectrics: Vec<(f32, Dielectric<Lobe, 1>)>,
    pub(super) plastic: Plastic<Smooth, 1>,
}

impl Bsdfs {
    pub(super) fn new(lobe: &Lobe, tables: &Tables) -> Self {
        let mirror = Conductor::new(lobe.clone(), ConductorFresnel::mirror());
        let forms = [Compensation::Turquin, Compensation::KullaConty];
        // A roughness outside the tables has no albedo.
        let compensated =
            forms.map(|form| mirror.clone().compensated(tables, form, StandIn::Round).ok());
        let conductors = [Some(mirror)].into_iter().chain(compensated).flatten().collect();
        let dielectric = |(i, eta): (usize, f64)| {
            let dielectric = Dielectric::new(lobe.clone(), eta).expect("an index in the range");
            let dielectric = dielectric.with_masking(Masking::ALL[i % 2]).with_channels();
            (dielectric.eta() as f32, dielectric)
        };
        let dielectrics = ETAS.into_iter().enumerate().map(dielectric).collect();
        let (form, stand_in) = (Compensation::None, StandIn::Refused);
        let plastic = Plastic::new(Smooth, 1.5, [1.0], tables, form, stand_in)
            .expect("a smooth coat needs no tables");
        Self { conductors, dielectrics, plastic }
    }
}
