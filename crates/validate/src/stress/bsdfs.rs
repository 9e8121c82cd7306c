//! The BSDFs that are tried with a lobe.

use microfacet_sampler::lobe::Smooth;
use microfacet_sampler::{
    BsdfSettings, Compensation, Conductor, ConductorFresnel, Dielectric, Ggx, Haze, Lobe, Masking,
    MicrofacetDistribution, Plastic, Retroreflective, StandIn, Tables,
};

/// Indices of refraction, among them both ends of the allowed range, and 1.
const ETAS: [f64; 8] = [1e-3, 0.5, 1.0, 1.000_02, 1.05, 1.5, 2.4, 1e3];
/// Weights of haze, and shares of light that goes back, among them both ends.
const SHARES: [f32; 4] = [0.0, 0.3, 1.0 - 1e-6, 1.0];

/// The lobe as a core with haze, and as haze around a mirror, of one bounce.
pub(super) type Hazy = [Haze<Conductor<Lobe, 1>>; 2];

pub(super) struct Bsdfs {
    pub(super) conductors: Vec<Conductor<Lobe, 1>>,
    pub(super) dielectrics: Vec<(f32, Dielectric<Lobe, 1>)>,
    pub(super) plastic: Plastic<Smooth, 1>,
    /// Of one share each.
    pub(super) hazy: Vec<Hazy>,
    /// The compensated conductors and the haze, their light sent back; none of tilted lobes.
    pub(super) back: Vec<Retroreflective<Conductor<Lobe, 1>>>,
    pub(super) hazy_glass: Haze<Dielectric<Lobe, 1>>,
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
        let conductors: Vec<_> = forms.into_iter().filter_map(conductor).collect();
        let white = |lobe: Lobe| {
            let mirror = ConductorFresnel::mirror();
            Conductor::new(lobe, mirror, settings).expect("one bounce needs no tables")
        };
        let wide = || Lobe::from(Ggx::new(0.7).expect("a roughness in the range"));
        let hazy = SHARES.map(|share| {
            [(lobe.clone(), wide()), (Smooth.into(), lobe.clone())].map(|(core, haze)| {
                Haze::new(white(core), white(haze), share).expect("a share in the range")
            })
        });
        let back = |(i, one): (usize, &Conductor<Lobe, 1>)| {
            let back = Retroreflective::new(one.clone(), SHARES[1 + i]);
            assert_eq!(back.is_ok(), lobe.is_symmetric() || lobe.is_effectively_smooth());
            back.ok()
        };
        let back = conductors.iter().enumerate().filter_map(back).collect();
        let glass = |lobe: Lobe| {
            let glass = Dielectric::new(lobe, 1.5, settings).expect("an index in the range");
            glass.with_channels()
        };
        let hazy_glass = Haze::at_hit(glass(lobe.clone()), glass(wide()), 0.3);
        let dielectric = |(i, eta): (usize, f64)| {
            let settings = settings.with_masking(Masking::ALL[i % 2]);
            let dielectric = Dielectric::new(lobe.clone(), eta, settings);
            let dielectric = dielectric.expect("an index in the range").with_channels();
            (dielectric.eta() as f32, dielectric)
        };
        let dielectrics = ETAS.into_iter().enumerate().map(dielectric).collect();
        let plastic = Plastic::new(Smooth, 1.5, [1.0], settings).expect("an index in the range");
        Self { conductors, dielectrics, plastic, hazy: hazy.into(), back, hazy_glass }
    }
}
