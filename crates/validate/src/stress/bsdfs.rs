//! The BSDFs that are tried with a lobe.

use microfacet_sampler::lobe::Smooth;
use microfacet_sampler::{
    BsdfSettings, Compensation, Conductor, ConductorFresnel, Dielectric, Lobe, Masking, Plastic,
    StandIn, Tables,
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
        let settings = BsdfSettings::new().with_stand_in(StandIn::Round);
        let forms = [Compensation::None, Compensation::Turquin, Compensation::KullaConty];
        // A roughness outside the tables has no albedo.
        let conductor = |form| {
            let settings = settings.compensated(form, tables);
            Conductor::new(lobe.clone(), ConductorFresnel::mirror(), settings).ok()
        };
        let conductors = forms.into_iter().filter_map(conductor).collect();
        let dielectric = |(i, eta): (usize, f64)| {
            let settings = settings.with_masking(Masking::ALL[i % 2]);
            let dielectric = Dielectric::new(lobe.clone(), eta, settings);
            let dielectric = dielectric.expect("an index in the range").with_channels();
            (dielectric.eta() as f32, dielectric)
        };
        let dielectrics = ETAS.into_iter().enumerate().map(dielectric).collect();
        let plastic = Plastic::new(Smooth, 1.5, [1.0], settings).expect("an index in the range");
        Self { conductors, dielectrics, plastic }
    }
}
