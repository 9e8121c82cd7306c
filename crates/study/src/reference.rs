//! Test vectors for readers of tables in other languages: `docs/reference.csv`.
//!
//! `cargo run --release -p microfacet-study -- reference docs/reference.csv` writes them. Every row
//! is one material, one view, one pair of random numbers and one normal, with the values of the
//! model in double precision (columns `…_exact`) and those of the sampler from the embedded tables
//! in single precision (`…_table`). Inputs except γ are single-precision numbers, written so that
//! they are read back unchanged. `docs/format.md` defines the columns.

use std::collections::HashMap;
use std::fmt::{Debug, Write};

use glam::{DVec3, Vec3};
use microfacet_core::Masking::{self, HeightCorrelated, Uncorrelated};
use microfacet_core::schlick::{f82_weight, schlick_weight};
use microfacet_model::{Albedo, AlbedoIntegrator, MicrofacetDistribution as _, StudentT};
use microfacet_sampler::albedo::Moments;
use microfacet_sampler::{MicrofacetDistribution, Tables};

use crate::Outcome;

const USAGE: &str =
    "usage: cargo run --release -p microfacet-study -- reference docs/reference.csv";

/// Runs the study that the module describes.
pub fn run(arguments: &[String]) -> Outcome {
    let [path] = arguments else { return Err(USAGE.into()) };
    Ok(std::fs::write(path, text()).map_err(|why| format!("{path}: {why}"))?)
}

/// Columns of a row's inputs.
const INPUTS: &str = "case,sigma_x,sigma_y,gamma,masking,vx,vy,vz,u1,u2,mx,my,mz,lx,ly,lz";
/// Columns of the results, once with the suffix `_exact` and once with `_table`: of directions,
/// then of albedos.
const RESULTS: [&str; 14] = [
    "g1", "g2", "d", "nx", "ny", "nz", "density", "e", "scale", "bias", "f82", "e_avg", "bias_avg",
    "f82_avg",
];

/// Tolerance of the quadrature of exact albedos.
const TOLERANCE: f64 = 1e-11;

/// The contents of the file.
pub fn text() -> String {
    let tables = Tables::embedded();
    let mut truth = Truth::default();
    let columns = |suffix| RESULTS.map(|name| format!("{name}_{suffix}")).join(",");
    let mut text = format!("{INPUTS},{},{}\n", columns("exact"), columns("table"));
    for row in rows() {
        let Row { case, sigma: [sx, sy], gamma, masking, v, u: [u1, u2], m } = row;
        write!(text, "{case},{sx:?},{sy:?},{gamma:?},{},", masking.name()).expect("memory");
        let inputs = [v.to_array(), [u1, u2, m.x], [m.y, m.z, row.light().x]].concat();
        text.push_str(&joined(inputs.into_iter().chain([row.light().y, row.light().z]).map(Some)));
        let exact = truth.of(&row).into_iter().map(|x| x.map(Digits));
        writeln!(text, ",{},{}", joined(exact), joined(read(&tables, &row))).expect("memory");
    }
    text
}

/// A double with all its digits.
struct Digits(f64);

impl Debug for Digits {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{:.16e}", self.0)
    }
}

/// Cells of the file; `None` is left blank.
fn joined(cells: impl IntoIterator<Item = Option<impl Debug>>) -> String {
    let cell = |x: Option<_>| x.map_or(String::new(), |x| format!("{x:?}"));
    cells.into_iter().map(cell).collect::<Vec<_>>().join(",")
}

/// The inputs of a row.
#[derive(Clone, Copy)]
struct Row {
    /// What the row tests.
    case: &'static str,
    sigma: [f32; 2],
    gamma: f64,
    masking: Masking,
    v: Vec3,
    u: [f32; 2],
    m: Vec3,
}

impl Row {
    /// v reflected at m, rounded once.
    fn light(&self) -> Vec3 {
        let (v, m) = (self.v.as_dvec3(), self.m.as_dvec3());
        (2.0 * v.dot(m) * m - v).as_vec3()
    }

    /// Whether tables treat the view as normal incidence, for which they take any azimuth, although
    /// it has an azimuth.
    fn is_upright(&self) -> bool {
        let across = self.v.x.abs().max(self.v.y.abs());
        across > 0.0 && across < 1e-18
    }

    /// The roughness of a round lobe that the embedded albedos cover; `None` for other lobes.
    fn round_sigma(&self) -> Option<f64> {
        let [x, y] = self.sigma;
        (x == y && x <= 3.0).then_some(f64::from(x))
    }
}

/// The results of a row from tables.
fn read(tables: &Tables, row: &Row) -> Vec<Option<f32>> {
    let material = tables.student_t(row.sigma, row.gamma).expect("embedded tables cover it");
    let [x, y, z] = material.sample_visible_normal(row.v, row.u);
    let directional = [
        material.g1(row.v),
        material.g2(row.v, row.light(), row.masking),
        material.d(row.m),
        x,
        y,
        z,
        material.visible_normal_pdf(row.v, row.m),
    ];
    all(directional, row.round_sigma().map(|sigma| read_albedo(tables, sigma, row)))
}

/// E, scale, bias and F82 of the view, and the averages of E, bias and F82.
fn read_albedo(tables: &Tables, sigma: f64, row: &Row) -> [f32; 7] {
    let (gamma, masking) = (row.gamma, row.masking);
    let albedo = tables.albedo(sigma, gamma, masking).expect("embedded tables cover it");
    let average = tables.average_moments(sigma, gamma, masking).expect("embedded tables cover it");
    let Moments { scale, bias, f82, .. } = albedo.moments(row.v);
    let e = albedo.albedo(row.v);
    [e, scale, bias, f82, average.total(), average.bias, average.f82]
}

fn all<T: Copy>(directional: [T; 7], albedo: Option<[T; 7]>) -> Vec<Option<T>> {
    let albedo = albedo.map_or([None; 7], |albedo| albedo.map(Some));
    [directional.map(Some), albedo].concat()
}

/// The model, with a cache of prepared shapes and of averages, by the bits of γ and σ.
#[derive(Default)]
struct Truth {
    integrators: HashMap<u64, AlbedoIntegrator>,
    averages: HashMap<[u64; 2], Albedo<3>>,
}

impl Truth {
    fn of(&mut self, row: &Row) -> Vec<Option<f64>> {
        let [sx, sy] = row.sigma.map(f64::from);
        let model = StudentT::new([sx, sy], row.gamma).expect("a Student-t");
        let (v, m, l) = (row.v.as_dvec3(), row.m.as_dvec3(), row.light().as_dvec3());
        let n = model.sample_visible_normal(v, row.u.map(f64::from));
        let seen = DVec3::new(v.x, v.y, v.z.max(0.0));
        let directional = [
            model.g1(v),
            model.g2(v, l, row.masking),
            model.d(m),
            n.x,
            n.y,
            n.z,
            v.dot(m).max(0.0) * model.d(m) * model.inverse_area(seen),
        ];
        let albedo = row.round_sigma().map(|sigma| self.albedo(&model, sigma, row));
        let mut all = all(directional, albedo);
        if row.gamma < PEELED_BELOW || row.is_upright() {
            all[3..6].fill(None);
        }
        all
    }

    fn albedo(&mut self, model: &StudentT, sigma: f64, row: &Row) -> [f64; 7] {
        let bits = row.gamma.to_bits();
        let prepare = || AlbedoIntegrator::new(*model.shape(), TOLERANCE);
        let integrator = self.integrators.entry(bits).or_insert_with(prepare);
        let weights = |cos: f64| [1.0, schlick_weight(cos), f82_weight(cos)];
        let cos = f64::from(row.v.z).clamp(0.0, 1.0);
        let seen = integrator.reflection(sigma, cos, weights).expect("in range");
        let [e, bias, f82] = seen.of(row.masking);
        let average = self.averages.entry([bits, sigma.to_bits()]);
        let average =
            average.or_insert_with(|| integrator.average(sigma, weights).expect("in range"));
        let [e_avg, bias_avg, f82_avg] = average.of(row.masking);
        [e, e - bias, bias, f82, e_avg, bias_avg, f82_avg]
    }
}

/// Below this γ the embedded tables lack the heavy part, and u₁ is not mapped by the whole CDF.
const PEELED_BELOW: f64 = 1.8;

const BOTH: [Masking; 2] = [Uncorrelated, HeightCorrelated];
const INFINITE: f64 = f64::INFINITY;

fn rows() -> Vec<Row> {
    let mut rows = Rows::default();
    // Ordinary views and normals.
    for gamma in [1.55, 1.65, 2.0, 3.0, 10.0, INFINITE] {
        for sigma in [0.1, 0.5, 1.5] {
            let cos = if sigma == 0.5 { 0.3 } else { 0.75 };
            for masking in BOTH {
                rows.round("middle", sigma, gamma, masking, cos);
            }
        }
    }
    // Grazing views that the albedo's axis reaches.
    for (gamma, masking) in [(1.55, BOTH[0]), (1.8, BOTH[1]), (2.0, BOTH[0]), (INFINITE, BOTH[1])] {
        for sigma in [0.1, 0.7] {
            for cos in [0.02, 1e-3, 5e-5] {
                rows.round("grazing", sigma, gamma, masking, cos);
            }
        }
    }
    // Views below the first node of the albedo's axis, down to the horizon and below.
    for gamma in [1.55, 2.0, INFINITE] {
        for masking in BOTH {
            for sigma in [0.05, 1.0] {
                for cos in [1e-5, 1e-7] {
                    rows.round("below mu_0", sigma, gamma, masking, cos);
                }
            }
            rows.round("horizon", 0.3, gamma, masking, 0.0);
        }
        rows.round("below the horizon", 0.3, gamma, HeightCorrelated, -0.1);
    }
    // Normal incidence, and views close to it.
    for gamma in [1.55, 2.0, 5.0, INFINITE] {
        for (sigma, masking) in [(0.01, BOTH[0]), (0.5, BOTH[1])] {
            rows.round("normal incidence", sigma, gamma, masking, 1.0);
        }
        rows.seen("near the normal", 0.4, gamma, Vec3::new(3e-4, -4e-4, 1.0));
        rows.seen("nearly normal incidence", 0.4, gamma, Vec3::new(0.0, 1e-20, 1.0));
    }
    // Two roughnesses: no albedos of these are embedded.
    for gamma in [1.55, 1.7, 1.8, 2.0, 4.0, INFINITE] {
        for (i, sigma) in [[0.3, 0.6], [0.02, 0.5], [2.0, 0.25]].into_iter().enumerate() {
            let row = rows.next("anisotropic", sigma, gamma, BOTH[i % 2]);
            let cos = [0.6, 0.1, 0.95][i];
            rows.push(Row { v: direction(cos, 0.9 + 2.1 * i as f64), ..row });
        }
    }
    // The ends of both random numbers, and their middle, where halves of the tables meet.
    const LAST: f32 = 1.0 - f32::EPSILON / 2.0;
    let ends = [[0.0, 0.3], [1.0, 0.3], [LAST, 0.6], [1e-9, 0.6], [0.3, 0.0], [0.3, 1.0]];
    let middles = [[0.5, 0.5], [0.5 + f32::EPSILON, 0.5 - f32::EPSILON / 2.0]];
    for gamma in [1.65, 2.0, INFINITE] {
        for u in ends.into_iter().chain(middles) {
            let row = rows.next("ends of u", [0.4; 2], gamma, HeightCorrelated);
            rows.push(Row { v: direction(0.5, 2.5), u, ..row });
        }
    }
    let row = rows.next("u out of range", [0.4; 2], 3.0, HeightCorrelated);
    rows.push(Row { v: direction(0.5, 2.5), u: [-0.5, 1.5], ..row });
    // The ends of the shape axis, the seam of two tables, and the shapes with names.
    for gamma in [1.501, 1.502, 1.51, 1.799_999, 1.8, 2.0, 1e9, INFINITE] {
        for masking in BOTH {
            rows.round("shape", 0.35, gamma, masking, 0.4);
        }
    }
    // The heavy part of the distribution, just beyond what is tabulated.
    for (gamma, u) in [(1.501, [0.046, 0.45]), (1.51, [0.316, 0.6])] {
        let row = rows.next("heavy part", [0.35; 2], gamma, HeightCorrelated);
        rows.push(Row { v: direction(0.9, 5.0), u, ..row });
    }
    // A slope between nodes that has to be limited.
    let row = rows.next("limited slope", [0.4; 2], 31.78, HeightCorrelated);
    rows.push(Row { v: direction(0.948, 1.0), u: [1e-6, 0.4], ..row });
    // The ends of the roughness axis; beyond its end there are no albedos.
    for (i, sigma) in [1e-8, 1e-4, 0.01, 3.0, 10.0, 1e4].into_iter().enumerate() {
        let case = if sigma < 1.0 { "small sigma" } else { "large sigma" };
        rows.round(case, sigma, 1.6, BOTH[i % 2], 0.2);
        rows.round(case, sigma, INFINITE, BOTH[i % 2], 0.2);
        rows.round(case, sigma, 2.0, BOTH[1 - i % 2], 0.9);
    }
    // Normals close to the horizon, and of unit slopes close to 0.
    for gamma in [1.55, 2.0, 2.5] {
        for z in [1e-2, 1e-6, 1e-18] {
            let row = rows.next("normal near the horizon", [0.5; 2], gamma, Uncorrelated);
            rows.push(Row { v: direction(0.2, 1.0), m: direction(z, 1.3), ..row });
        }
        if gamma <= 2.0 {
            let row = rows.next("normal below the horizon", [0.5; 2], gamma, Uncorrelated);
            rows.push(Row { v: direction(0.2, 1.0), m: direction(-0.1, 1.3), ..row });
        }
    }
    rows.0
}

/// The rows so far; their number determines the random numbers of the next one.
#[derive(Default)]
struct Rows(Vec<Row>);

impl Rows {
    /// A row with a view along the normal, and random numbers and a normal of its own.
    fn next(&self, case: &'static str, sigma: [f32; 2], gamma: f64, masking: Masking) -> Row {
        // The additive sequence of the plastic number fills the square evenly.
        let i = self.0.len() as f64;
        let spread = |a: f64| (0.5 + a * i).fract();
        let [a, b, c, d] = [0.754_877_666, 0.569_840_291, 0.220_744_085, 0.618_033_989].map(spread);
        // Unit slopes from 0 to 3 at all azimuths.
        let (sin, cos) = libm::sincos(std::f64::consts::TAU * d);
        let [x, y] = sigma.map(f64::from);
        let m = DVec3::new(-3.0 * c * x * cos, -3.0 * c * y * sin, 1.0).normalize().as_vec3();
        Row { case, sigma, gamma, masking, v: Vec3::Z, u: [a as f32, b as f32], m }
    }

    fn push(&mut self, row: Row) {
        self.0.push(row);
    }

    /// Equal roughnesses, and a view at cos θ with an azimuth of its own.
    fn round(&mut self, case: &'static str, sigma: f32, gamma: f64, masking: Masking, cos: f64) {
        let v = direction(cos, 0.4 + 2.4 * self.0.len() as f64);
        self.push(Row { v, ..self.next(case, [sigma; 2], gamma, masking) });
    }

    fn seen(&mut self, case: &'static str, sigma: f32, gamma: f64, v: Vec3) {
        self.push(Row { v, ..self.next(case, [sigma; 2], gamma, HeightCorrelated) });
    }
}

/// The direction of a cosine and an azimuth.
fn direction(cos: f64, phi: f64) -> Vec3 {
    let sin = libm::sqrt((1.0 - cos) * (1.0 + cos));
    let (s, c) = libm::sincos(phi);
    DVec3::new(sin * c, sin * s, cos).as_vec3()
}
