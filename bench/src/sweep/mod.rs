//! The time of every public function over the whole domain, not of one material alone: a renderer's
//! frame waits for its slowest material.
//!
//! A cell is one function, one material, one class of views and one of random numbers. Its time is
//! the median over a few short batches. A cell that another program disturbed would look slow, so
//! the whole domain is timed twice, and the lesser time counts.

pub(crate) mod domain;
mod functions;
mod summary;

use std::time::Instant;

use glam::Vec3;
use microfacet_sampler::{Ggx, MicrofacetDistribution, Skew, Tables};
use serde::Serialize;

use self::domain::{ELLIPSOIDS, GAMMAS, Numbers, RANDOM, SIGMAS, Views};
use self::functions::{Cases, Function, common, of_bounded};
pub(crate) use self::summary::{Summary, summaries};
use crate::clock::median;
use crate::files::shape;
use crate::settings::Settings;

/// One cell and its time: a line of `sweep.csv`.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(crate) struct Cell {
    /// The lobe and its function.
    pub(crate) function: String,
    #[serde(serialize_with = "shape")]
    pub(crate) gamma: f64,
    /// Roughness along x and y.
    pub(crate) sigma: [f64; 2],
    /// Turns of an ellipsoid about x, y and z, in radians.
    pub(crate) turns: [f64; 3],
    pub(crate) views: &'static str,
    /// The class of random numbers; "-" where the function does not depend on them.
    pub(crate) numbers: &'static str,
    /// Nanoseconds a call.
    pub(crate) ns: f64,
}

impl Cell {
    /// The columns of `sweep.csv`.
    pub(crate) const COLUMNS: [&str; 10] = [
        "function", "gamma", "sigma_x", "sigma_y", "turn_x", "turn_y", "turn_z", "views",
        "numbers", "ns",
    ];

    /// A material, before anything of it is measured.
    fn of(lobe: &str, gamma: f64, sigma: [f64; 2], turns: [f64; 3]) -> Self {
        Self { function: lobe.into(), gamma, sigma, turns, views: NONE, numbers: NONE, ns: 0.0 }
    }

    /// Whether its inputs are what most calls of a renderer have.
    fn is_common(&self) -> bool {
        self.views == RANDOM && [RANDOM, NONE].contains(&self.numbers)
    }
}

/// The class of numbers of a function that does not depend on them.
const NONE: &str = "-";

pub(crate) fn cells(set: &Tables, settings: &Settings) -> Vec<Cell> {
    let mut all = pass(set, settings);
    for (cell, again) in all.iter_mut().zip(pass(set, settings)) {
        cell.ns = cell.ns.min(again.ns);
    }
    all
}

/// Times all cells once, always in the same order.
fn pass(set: &Tables, settings: &Settings) -> Vec<Cell> {
    let mut sweep = Sweep::new(settings);
    for sigma in SIGMAS {
        let lobe = Ggx::new(sigma).expect("sigmas in range");
        sweep.lobe(&lobe, &lobe, &Cell::of("Ggx", 2.0, sigma, [0.0; 3]), &common(), []);
    }
    for gamma in GAMMAS {
        for sigma in SIGMAS {
            let lobe = set.student_t(sigma, gamma).expect("the set covers all shapes");
            let material = |lobe| Cell::of(lobe, gamma, sigma, [0.0; 3]);
            sweep.lobe(&lobe, &lobe, &material("StudentT"), &common(), []);
            let bounded = lobe.clone().bounded();
            sweep.lobe(&lobe, &bounded, &material("Bounded"), &of_bounded(), []);
        }
        for (sigma, turns) in ELLIPSOIDS {
            let skew = Skew::new(sigma, turns).expect("lobes that can be tilted so far");
            let lobe = set.ellipsoid(skew, gamma).expect("the set covers all shapes");
            let material = Cell::of("Ellipsoid", gamma, sigma, turns);
            sweep.lobe(&lobe, &lobe, &material, &common(), Views::below_lobe(skew));
        }
    }
    sweep.cells
}

/// The inputs of all cells, by class, how much is measured of each, and what was measured.
struct Sweep {
    seed: u64,
    batches: usize,
    calls: usize,
    views: Vec<(&'static str, Vec<Vec3>)>,
    numbers: Vec<(&'static str, Vec<[f32; 2]>)>,
    cells: Vec<Cell>,
}

impl Sweep {
    fn new(settings: &Settings) -> Self {
        let &Settings { seed, sweep_batches: batches, sweep_calls: calls, .. } = settings;
        let count = batches * calls;
        let views = Views::all().map(|views| (views.name, views.draw(seed, count))).into();
        let numbers = Numbers::ALL.map(|(name, of)| (name, of.draw(seed, count))).into();
        Self { seed, batches, calls, views, numbers, cells: Vec::new() }
    }

    /// Times functions of `subject` over all classes, and over `more` classes of views; `lobe`
    /// draws the normals of their arguments.
    fn lobe<L>(
        &mut self,
        lobe: &impl MicrofacetDistribution,
        subject: &L,
        material: &Cell,
        functions: &[Function<L>],
        more: impl IntoIterator<Item = Views>,
    ) {
        let count = self.batches * self.calls;
        let more = more.into_iter().map(|views| (views.name, views.draw(self.seed, count)));
        let more: Vec<_> = more.collect();
        let mut cells = Vec::new();
        for (views, v) in self.views.iter().chain(&more) {
            for (i, (numbers, u)) in self.numbers.iter().enumerate() {
                let cases = &mut Cases::new(lobe, v, u);
                for function in functions.iter().filter(|function| function.reads_numbers || i == 0)
                {
                    cells.push(Cell {
                        function: format!("{}::{}", material.function, function.name),
                        views,
                        numbers: if function.reads_numbers { numbers } else { NONE },
                        ns: self.ns(subject, function, cases),
                        ..*material
                    });
                }
            }
        }
        self.cells.extend(cells);
    }

    /// The median time of a call.
    fn ns<L>(&self, subject: &L, function: &Function<L>, cases: &mut Cases) -> f64 {
        // Brings code and tables into the caches.
        (function.run)(subject, cases, 0..self.calls.div_ceil(4));
        let times = (0..self.batches).map(|i| {
            // Other inputs each time: a branch predictor would learn a short batch.
            let at = i * self.calls..(i + 1) * self.calls;
            let start = Instant::now();
            (function.run)(subject, cases, at);
            start.elapsed().as_nanos() as f64 / self.calls as f64
        });
        median(times.collect())
    }
}
