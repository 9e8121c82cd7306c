//! Compares lights of a view along the normal with the distribution of normals: the share of them
//! up to a light, by the closed form in double precision, is the random number, and their density
//! is that of normals over 4, by the crate's D.

use microfacet_model::MicrofacetDistribution as _;
use microfacet_model::StudentT;
use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};

type Lights = unsafe extern "C" fn(usize, *const f32, *const f32, *const f32, *mut f32, *mut f32);

unsafe extern "C" {
    fn c_prefilter(n: usize, u: *const f32, s: *const f32, g: *const f32, l: *mut f32, p: *mut f32);
    fn cpp_prefilter(
        n: usize,
        u: *const f32,
        s: *const f32,
        g: *const f32,
        l: *mut f32,
        p: *mut f32,
    );
}

/// How far random numbers, as shares of the distance to the nearer end, and densities, as
/// shares of themselves, may be off.
const ALLOWED: [f64; 2] = [1e-5, 1e-5];

/// A random number, a σ and a γ.
type Query = ([f32; 2], f32, f32);

pub fn agree(count: usize) -> bool {
    let mut rng = StdRng::seed_from_u64(9);
    let mut queries: Vec<Query> = (0..count)
        .map(|_| {
            let gamma = 1.501 + 1.0 / rng.random_range(0.01..2.0_f32) - 0.5;
            ([rng.random(), rng.random()], 10.0_f32.powf(rng.random_range(-3.0..0.5)), gamma)
        })
        .collect();
    for u in [0.0, 1e-30, 1e-7, 0.5, 0.99999994, 1.0] {
        for sigma in [1e-8, 0.01, 0.3, 3.0, 1e6] {
            for gamma in [1.501, 1.55, 2.0, 3.0, 40.0, 1e9, f32::INFINITY] {
                queries.push(([u, 0.3], sigma, gamma));
            }
        }
    }
    let bad = [f32::NAN, -1.0, 2.0, f32::INFINITY];
    let special = bad.map(|x| [([x, x], 0.3, 2.0), ([0.4, 0.4], x, 2.0), ([0.4, 0.4], 0.3, x)]);
    let mut good = true;
    for (language, function) in [("C", c_prefilter as Lights), ("C++", cpp_prefilter)] {
        let (mut worst, mut at) = ([0.0_f64; 2], [queries[0]; 2]);
        for (query, (l, pdf)) in queries.iter().zip(lights(function, &queries)) {
            let off = differences(query, l, f64::from(pdf));
            for i in 0..2 {
                // What is not a number is larger than any other.
                if !(off[i] <= worst[i]) {
                    (worst[i], at[i]) = (off[i], *query);
                }
            }
        }
        let sound = lights(function, special.as_flattened())
            .iter()
            .all(|(l, pdf)| l.iter().all(|x| x.is_finite()) && pdf.is_finite() && *pdf >= 0.0);
        let holds = sound && worst[0] <= ALLOWED[0] && worst[1] <= ALLOWED[1];
        let verdict = if holds { "" } else { "  TOO FAR" };
        println!(
            "lights of a view along the normal, {language}: numbers to {:.1e} at {:?}, densities to \
             {:.1e} at {:?}{verdict}",
            worst[0], at[0], worst[1], at[1]
        );
        good &= holds;
    }
    good
}

fn lights(function: Lights, queries: &[Query]) -> Vec<([f32; 3], f32)> {
    let u: Vec<[f32; 2]> = queries.iter().map(|query| query.0).collect();
    let sigma: Vec<f32> = queries.iter().map(|query| query.1).collect();
    let gamma: Vec<f32> = queries.iter().map(|query| query.2).collect();
    let (mut l, mut pdf) = (vec![[0.0; 3]; u.len()], vec![0.0; u.len()]);
    // SAFETY: all are of the length passed, in pairs and triples as `families.c` has them.
    unsafe {
        let (u, l) = (u.as_flattened().as_ptr(), l.as_flattened_mut().as_mut_ptr());
        function(queries.len(), u, sigma.as_ptr(), gamma.as_ptr(), l, pdf.as_mut_ptr());
    }
    l.into_iter().zip(pdf).collect()
}

/// Those of the random number and of the density.
fn differences(&(u, sigma, gamma): &Query, l: [f32; 3], pdf: f64) -> [f64; 2] {
    let [x, y, z] = l.map(f64::from);
    if !(x * x + y * y + z * z - 1.0).abs().is_finite() {
        return [f64::INFINITY; 2];
    }
    // The tangent of half the angle, by what keeps its digits.
    let sine = x.hypot(y);
    let slope = if z > 0.0 { sine / (1.0 + z) } else { (1.0 - z) / sine };
    let (sigma, gamma, u) = (f64::from(sigma), f64::from(gamma), f64::from(u[0].min(0.999_999_94)));
    let part = (slope / sigma).powi(2);
    let logarithm =
        if gamma == f64::INFINITY { -part } else { (1.0 - gamma) * (part / (gamma - 1.0)).ln_1p() };
    let share = -logarithm.exp_m1();
    let rest = logarithm.exp();
    let off_share = if u < 0.5 {
        (share - u).abs() / u.max(1e-12)
    } else {
        (rest - (1.0 - u)).abs() / (1.0 - u)
    };
    let model = StudentT::new([sigma; 2], gamma).unwrap();
    let cos = 1.0 / slope.hypot(1.0);
    let want = model.d([slope * cos, 0.0, cos].into()) / 4.0;
    let off_pdf = if pdf == 0.0 && want < 1e-37 { 0.0 } else { (pdf - want).abs() / want };
    [off_share, off_pdf]
}
