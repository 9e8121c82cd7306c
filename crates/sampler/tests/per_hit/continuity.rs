//! Nothing jumps where γ passes from a table to another, between nodes, or to Beckmann: textures
//! of γ leave no edges.

use microfacet_model::MicrofacetDistribution as _;
use microfacet_sampler::MicrofacetDistribution as _;

use super::*;

const SIGMA: [f32; 2] = [0.3, 0.7];

/// G1 and, at one normal, the densities.
fn values(family: &Family, gamma: f32, v: Vec3, m: Vec3) -> [f64; 3] {
    let lobe = family.at(SIGMA, gamma);
    [lobe.g1(v), lobe.d(m), lobe.visible_normal_pdf(v, m)].map(f64::from)
}

fn exact(gamma: f64, v: Vec3, m: Vec3) -> [f64; 3] {
    let lobe = model::StudentT::new(SIGMA.map(f64::from), gamma).unwrap();
    let (v, m) = (v.as_dvec3(), m.as_dvec3());
    [lobe.g1(v), lobe.d(m), lobe.visible_normal_pdf(v, m)]
}

/// How much more than the model's three values change between two γ: of G1 absolutely, of
/// densities relative to them and to their exponents.
fn jumps(family: &Family, from: f32, to: f32, v: Vec3, m: Vec3) -> [f64; 3] {
    let [a, b] = [from, to].map(|gamma| values(family, gamma, v, m));
    let [p, q] = [from, to].map(|gamma| exact(f64::from(gamma), v, m));
    std::array::from_fn(|i| {
        let jump = (b[i] - a[i]).abs() - (q[i] - p[i]).abs();
        match i {
            0 => jump,
            // Smaller densities have no digits.
            _ if p[i] < 1e-30 => 0.0,
            _ => jump / (p[i] * exponent(SIGMA, p[i])),
        }
    })
}

/// The lobe of one γ, and those that find the numbers of its normals.
struct At<'a> {
    lobe: FamilyLobe<'a>,
    bound: StudentT,
    truth: model::StudentT,
}

impl<'a> At<'a> {
    fn new(family: &'a Family, gamma: f32) -> Self {
        let lobe = family.at(SIGMA, gamma);
        let (bound, truth) = bound(&Tables::embedded(), &lobe);
        Self { lobe, bound, truth }
    }

    /// The numbers at which the model gives the normal that is drawn at u. The first is 0 beside
    /// the limit between two parts of the distribution, and on the horizon, where cosines end.
    fn drawn(&self, v: Vec3, u: f32) -> [f64; 2] {
        let m = Vec3::from(self.lobe.sample_visible_normal(v, [u, 0.3]));
        let split = self.bound.tabulated_share(v);
        let ([along, across], beside) = numbers_of(&self.truth, v, m, u, split);
        [if beside || m.z < 1e-17 { 0.0 } else { along }, across]
    }
}

fn apart(a: [f64; 2], b: [f64; 2]) -> f64 {
    (a[0] - b[0]).abs().max((a[1] - b[1]).abs())
}

fn cases() -> impl Iterator<Item = (Vec3, Vec3, f32)> {
    let mut random = random();
    (0..200).map(move |i| {
        let z = if i % 4 == 0 { COSINES[i / 4 % COSINES.len()].max(1e-6) } else { random.random() };
        let v = view(z, random.random_range(-3.0..3.0));
        let m = loop {
            let m = view(random.random(), random.random_range(-3.0..3.0));
            if v.dot(m) > 0.01 && m.z > 0.01 {
                break m;
            }
        };
        (v, m, random.random())
    })
}

/// Neighbours in single precision around every node of every table, and around 2.
#[test]
fn neighbours_differ_by_rounding() {
    let family = family();
    let mut gammas: Vec<f32> = vec![2.0, 1.9, 3.3, 7.0, 1e5];
    for table in Tables::embedded().tables() {
        if table.axes[0].interpolation == Interpolation::Lagrange4 {
            gammas.extend(table.axes[0].nodes.iter().map(|&s| gamma_of_s(s) as f32));
        }
    }
    let [mut normals, mut g1s, mut ds, mut pdfs] = std::array::from_fn(|_| Worst::default());
    let cases: Vec<_> = cases().collect();
    for (i, gamma) in gammas.into_iter().enumerate() {
        for (from, to) in [(gamma.next_down(), gamma), (gamma, gamma.next_up())] {
            // Two parts meet there, of which each has errors of its own.
            if !(from >= 1.501 && to < 1e17) || (from < 1.8) != (to < 1.8) {
                continue;
            }
            let lobes = [from, to].map(|gamma| At::new(&family, gamma));
            for &(v, m, u) in cases.iter().skip(i % 7).step_by(7) {
                let what = || format!("{from:?} {to:?} {v:?} {m:?} {u}");
                let [g1, d, pdf] = jumps(&family, from, to, v, m);
                g1s.see(g1, what);
                ds.see(d, what);
                pdfs.see(pdf, what);
                let [a, b] = lobes.each_ref().map(|at| at.drawn(v, u));
                normals.see(apart(a, b), what);
            }
        }
    }
    normals.allowed(1e-6);
    g1s.allowed(4e-7);
    ds.allowed(4e-7);
    pdfs.allowed(5e-7);
}

/// From 1.8 down another table is read, and the heavy part by its closed form.
#[test]
fn the_parts_meet_at_the_seam() {
    let family = family();
    let (below, above) = (1.8_f32.next_down(), 1.8_f32);
    let [mut g1s, mut ds, mut pdfs, mut quantiles] = std::array::from_fn(|_| Worst::default());
    for (i, (v, m, across)) in cases().enumerate() {
        let what = || format!("{v:?} {m:?}");
        let [g1, d, pdf] = jumps(&family, below, above, v, m);
        g1s.see(g1, what);
        ds.see(d, what);
        pdfs.see(pdf, what);
        if i % 16 == 0 {
            // The numbers of the two parts are in another order; the normals are the same.
            const COUNT: usize = 16384;
            let sorted = |gamma: f32| {
                let lobe = family.at(SIGMA, gamma);
                let truth = model::StudentT::new(SIGMA.map(f64::from), 1.8).unwrap();
                let at = |i: usize| {
                    let u = [(i as f32 + 0.5) / COUNT as f32, across];
                    let m = Vec3::from(lobe.sample_visible_normal(v, u));
                    truth.invert_visible_normal(v.as_dvec3(), m.as_dvec3())[0]
                };
                let mut all: Vec<f64> = (0..COUNT).map(at).collect();
                all.sort_by(f64::total_cmp);
                all
            };
            for (a, b) in sorted(below).iter().zip(sorted(above)) {
                quantiles.see((a - b).abs(), what);
            }
        }
    }
    // The errors that the certificates of both parts state.
    g1s.allowed(4e-6);
    ds.allowed(4e-7);
    pdfs.allowed(2e-6);
    // Their numbers are a grid's, whose halves are sorted into each other.
    quantiles.allowed(1.0 / 16384.0 + 2e-5);
}

#[test]
fn large_gamma_becomes_beckmann() {
    let family = family();
    let [mut normals, mut g1s, mut ds, mut pdfs] = std::array::from_fn(|_| Worst::default());
    let cases: Vec<_> = cases().collect();
    for gamma in [1e8, 1e12, 1e16, 1e17, 1e18, f32::MAX] {
        let lobes = [gamma, INF].map(|gamma| At::new(&family, gamma));
        for &(v, m, u) in &cases {
            let what = || format!("{gamma} {v:?} {m:?} {u}");
            let [g1, d, pdf] = jumps(&family, gamma, INF, v, m);
            g1s.see(g1, what);
            ds.see(d, what);
            pdfs.see(pdf, what);
            let [a, b] = lobes.each_ref().map(|at| at.drawn(v, u));
            normals.see(apart(a, b), what);
        }
    }
    for (v, m, _) in cases {
        let [a, b] = [1e18, INF].map(|gamma| values(&family, gamma, v, m).map(f64::to_bits));
        assert_eq!(a, b);
    }
    normals.allowed(6e-7);
    g1s.allowed(3e-7);
    ds.allowed(2e-7);
    pdfs.allowed(2e-7);
}
