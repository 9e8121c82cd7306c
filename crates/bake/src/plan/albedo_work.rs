//! Estimates the work of albedo tables: seconds of one thread, with the doublings that
//! `table_set` is expected to make.
//!
//! The seconds are those of a node times a number of nodes, to which places of the certificate are
//! converted. What a node takes is the exponential of a linear form in the shape s, the aspect and
//! the roughness: rays are long for heavy tails, more of them are needed for an elongated lobe, and
//! the branch point of Λ at l = n takes panels of its own on rough surfaces. The coefficients are
//! fitted to the processor time of some 200 bakes on one thread.
//! `crates/study/src/planner_seconds.rs` shows how well they meet other materials.

use microfacet_core::shape::s_of_gamma;
use microfacet_tables::{LobeForm, Mapping, Reflectance};

use crate::bake::albedo::{AlbedoLobe, AlbedoSpec};
use crate::certify::albedo::climbed_count;
use crate::certify::points;
use crate::distribution::{Distribution, DistributionKind, Named};

/// A place of the certificate, a decade more accurate than a node, in nodes.
const PLACE: f64 = 1.6;
/// Share of the places on the way uphill that lie in the promised range.
const CLIMBED: f64 = 0.8;
/// How much longer places of a range of shapes take along edges and uphill: each has a shape of its
/// own, which takes longer to prepare than a view of it, unless the reflectance is a dielectric's.
const OF_RANGE: [f64; 2] = [4.5, 6.0];

/// The seconds of one thread for albedo tables without doublings, by what they are spent on.
pub(crate) struct AlbedoWork {
    pub(crate) nodes: f64,
    /// The certificate's places inside, along edges and creases, and on the way uphill.
    pub(crate) interior: f64,
    pub(crate) edges: f64,
    pub(crate) climbs: f64,
}

impl AlbedoWork {
    pub(crate) fn new(spec: &AlbedoSpec) -> Self {
        let node = 1e-6 * node_microseconds(spec);
        let is_range = matches!(spec.axes[0].mapping, Mapping::LogShape(_))
            && spec.axes[0].len() > 1
            && spec.reflectance.indices().is_none();
        let [edge, climb] = if is_range { OF_RANGE } else { [1.0; 2] };
        // Nobody climbs along an axis of one node.
        let moving = spec.axes.iter().filter(|axis| axis.len() > 1).count() as f64;
        let climbed = CLIMBED * climbed_count(spec) as f64 * moving / spec.axes.len() as f64;
        let place = place_seconds(spec);
        Self {
            nodes: node * spec.nodes() as f64,
            interior: place * points::interior_count(spec) as f64,
            edges: place
                * (edge * points::edge_count(spec) as f64
                    + points::middle_count(spec) as f64
                    + points::crease_count(spec) as f64
                    + points::smooth(spec).len() as f64),
            climbs: place * climb * climbed * spec.maskings.len() as f64,
        }
    }

    pub(crate) fn total(&self) -> f64 {
        self.interior + self.doubling()
    }

    /// The part that each doubling repeats.
    pub(crate) fn doubling(&self) -> f64 {
        self.nodes + self.edges + self.climbs
    }
}

/// Seconds of one thread for a place of the certificate, of a shape that was prepared.
pub fn place_seconds(spec: &AlbedoSpec) -> f64 {
    1e-6 * PLACE * node_microseconds(spec)
}

/// Seconds of one thread to bake and to certify albedo tables, with the doublings expected.
pub(crate) fn albedo_seconds(spec: &AlbedoSpec) -> f64 {
    let again = |(share, spec): (f64, AlbedoSpec)| share * AlbedoWork::new(&spec).doubling();
    AlbedoWork::new(spec).total() + doublings(spec).into_iter().map(again).sum::<f64>()
}

/// Bytes of the values of albedo tables, with the doublings expected.
pub(super) fn expected_bytes(spec: &AlbedoSpec) -> f64 {
    let mut before = spec.bytes() as f64;
    let mut bytes = before;
    for (share, finer) in doublings(spec) {
        let now = finer.bytes() as f64;
        bytes += share * (now - before);
        before = now;
    }
    bytes
}

/// The doublings that may be needed, in order, and how likely each is: so the work of a material
/// near a threshold is between that on either side.
fn doublings(spec: &AlbedoSpec) -> Vec<(f64, AlbedoSpec)> {
    let most = f64::from(spec.doublings());
    let [azimuths, views] = expected(spec);
    let views = views.clamp(0.0, most);
    let azimuths = azimuths.clamp(0.0, most - views);
    let mut axes = [(0, azimuths), (spec.axes.len() - 1, views)];
    // The likelier first: the other begins with what it leaves.
    axes.sort_by(|a, b| b.1.total_cmp(&a.1));
    let refinable = spec.refinable();
    let mut all = Vec::new();
    let mut spec = spec.clone();
    for (axis, mut number) in axes {
        while number > 0.0 && refinable.contains(&axis) {
            spec = spec.refined(axis);
            all.push((number.min(1.0), spec.clone()));
            number -= 1.0;
        }
    }
    all
}

/// Numbers of doublings of azimuths and of views that are expected.
fn expected(spec: &AlbedoSpec) -> [f64; 2] {
    // Decades of accuracy beyond default quality, and short of it.
    let decades = libm::log10(1e-6 / spec.tolerance);
    let (finer, coarser) = (decades.max(0.0), (-decades).max(0.0));
    let lobe = &spec.lobe;
    match (lobe.form(), spec.reflectance) {
        (LobeForm::StudentT, _) => {
            let Features { s, aspect, rough, .. } = Features::of_single(lobe);
            // An aspect of 4 to 8 needs the first doubling, and each factor of 3.3 another.
            let azimuths = 0.5 + (aspect - 1.3 - 0.42 * s) / 1.2 + 0.6 * s * finer;
            // The few views of a draft miss the hump of rough lobes with short tails.
            [azimuths, 0.1 + 0.5 * s * finer + coarser * (1.5 * rough - 0.7 * s).max(0.0)]
        }
        (LobeForm::Ellipsoid, _) => {
            // Rough lobes with heavy tails are hardly clamped, and those that hardly lean.
            let Features { s, rough, heavy, .. } = Features::of_single(lobe);
            let ([x, y], [a, b, _]) = (lobe.sigma(), lobe.theta.unwrap_or_default());
            let lean = libm::hypot(a, b) / x.min(y);
            let leaning = (2.0 * lean).clamp(0.2, 1.0) * (1.0 - 0.8 * heavy);
            [leaning * (1.6 - 1.3 * s * rough).clamp(0.1, 1.0); 2]
        }
        (LobeForm::Family, Reflectance::Interface { .. }) => [0.0, 0.35],
        (LobeForm::Family, _) => [0.0; 2],
        (LobeForm::Distribution, _) => [0.0, 0.15],
    }
}

/// What the time of a node depends on.
struct Features {
    /// s of the shape.
    s: f64,
    /// Logarithm of the larger σ over the smaller.
    aspect: f64,
    /// From 0 for σ ≤ 0.1, where no panels are spent on the branch point, to 1 for σ ≥ 2.5.
    rough: f64,
    /// From 0 for γ ≥ 1.56 to 1 for γ = 1.5, where nearly all normals are at the horizon.
    heavy: f64,
}

impl Features {
    /// Of a single lobe.
    fn of_single(lobe: &AlbedoLobe) -> Self {
        Self::of(lobe.sigma(), lobe.gamma.min)
    }

    fn of([x, y]: [f64; 2], gamma: f64) -> Self {
        let s = s_of_gamma(gamma);
        let aspect = libm::fabs(libm::log(x / y)).min(libm::log(100.0));
        let rough = libm::log(10.0 * x.max(y)) / libm::log(25.0);
        Self { s, aspect, rough: rough.clamp(0.0, 1.0), heavy: (5.0 * (s - 1.8)).max(0.0) }
    }
}

/// Microseconds of one thread for a node.
fn node_microseconds(spec: &AlbedoSpec) -> f64 {
    // Time rises by this power of the accuracy.
    let accurate = |power: f64| libm::pow(1e-6 / spec.tolerance, power);
    // Three indices, each for three channels.
    let metal = matches!(spec.reflectance, Reflectance::Conductor { .. });
    let weights = if metal { 1.8 } else { 1.0 };
    let lobe = &spec.lobe;
    let node = match lobe.form() {
        LobeForm::Family if spec.reflectance.indices().is_some() => {
            // The mean of the ends of the range, of which one may dominate.
            let (gamma, sigma) = (lobe.gamma, lobe.roughness.x());
            let ends = [(gamma.min, sigma.max), (gamma.max, sigma.min)];
            let ends = ends.map(|(gamma, sigma)| {
                // A mirror, σ = 0, is as fast as the smoothest surface.
                let Features { s, rough, .. } = Features::of([sigma; 2], gamma);
                libm::exp(5.35 + 1.2 * s + 0.3 * s * s + rough * (1.8 - 1.1 * s))
            });
            0.5 * (ends[0] + ends[1]) * accurate(0.05)
        }
        LobeForm::Family => {
            // To prepare a shape of heavy tails takes longer, which many nodes of a range hide.
            let single = lobe.gamma.is_point();
            let heavy = single && s_of_gamma(lobe.gamma.min) > 1.25;
            accurate(0.08)
                * if heavy {
                    150.0
                } else if single {
                    105.0
                } else {
                    90.0
                }
        }
        LobeForm::StudentT => {
            let Features { s, aspect, rough, heavy } = Features::of_single(lobe);
            let smooth = 5.54 + 0.61 * s + (0.43 * s - 0.3 * heavy) * aspect;
            let long = aspect.min(1.5) + 0.25 * s.min(1.0) * (aspect - 1.5).max(0.0);
            let branch = rough * (0.93 + 0.82 * long - 0.97 * s);
            accurate(0.126 + 0.08 * s) * libm::exp(smooth + branch)
        }
        LobeForm::Ellipsoid => {
            // The kinks of clamped masking are searched for on every chord, and are many where the
            // lobe is narrow.
            let Features { s, rough, heavy, .. } = Features::of_single(lobe);
            let smooth = 7.15 + 2.2 * s.min(1.1).sqrt() - 1.2 * heavy;
            accurate(0.2) * libm::exp(smooth + rough * (0.9 - 1.4 * s))
        }
        LobeForm::Distribution => match &lobe.distribution {
            Some(Distribution::Named(Named { kind: DistributionKind::Gauss, .. })) => 480.0,
            Some(Distribution::Named(Named { kind: DistributionKind::Schlick, .. })) => 210.0,
            _ => 1350.0,
        },
    };
    weights * node
}
