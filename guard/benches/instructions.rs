//! Instructions of the hot paths, counted by Callgrind, against the committed ones.

use std::hint::black_box;

use glam::Vec3;
use gungraun::{
    Callgrind, EventKind, LibraryBenchmarkConfig, library_benchmark, library_benchmark_group, main,
};
use microfacet_guard::{CALLS, Inputs};
use microfacet_sampler::StudentT;

/// The baseline: instructions a call that this commit takes. A count 1 % above it fails, which is one instruction in the short paths.
fn at_most(instructions: f64) -> LibraryBenchmarkConfig {
    const TOLERANCE: f64 = 1.01;
    let limit = (instructions * TOLERANCE * CALLS as f64) as u64;
    let mut config = LibraryBenchmarkConfig::default();
    config.tool(Callgrind::default().hard_limits([(EventKind::Ir, limit)]));
    config
}

// `common` shapes read the tables alone; `heavy` ones draw the tail that their tables leave out from its closed form.

#[library_benchmark]
#[bench::common(args = (2.5), setup = Inputs::new, config = at_most(170.5))]
#[bench::heavy(args = (1.6), setup = Inputs::new, config = at_most(447.4))]
fn sample_visible_normal(inputs: Inputs) -> Vec3 {
    let calls = inputs.v.iter().zip(&inputs.u);
    black_box(calls.map(|(v, u)| black_box(inputs.material.sample_visible_normal(*v, *u))).sum())
}

#[library_benchmark]
#[bench::common(args = (2.5), setup = Inputs::new, config = at_most(108.3))]
fn sample_batch(inputs: Inputs) -> Vec<Vec3> {
    let mut m = vec![Vec3::ZERO; CALLS];
    inputs.material.sample_batch(&inputs.v, &inputs.u, &mut m).expect("equal lengths");
    black_box(m)
}

#[library_benchmark]
#[bench::common(args = (2.5), setup = Inputs::new, config = at_most(49.1))]
#[bench::heavy(args = (1.6), setup = Inputs::new, config = at_most(54.0))]
fn g1(inputs: Inputs) -> f32 {
    black_box(inputs.v.iter().map(|v| black_box(inputs.material.g1(*v))).sum())
}

#[library_benchmark]
#[bench::common(args = (2.5), setup = Inputs::new, config = at_most(35.9))]
fn g1_batch(inputs: Inputs) -> Vec<f32> {
    let mut g1 = vec![0.0; CALLS];
    inputs.material.g1_batch(&inputs.v, &mut g1).expect("equal lengths");
    black_box(g1)
}

#[library_benchmark]
#[bench::common(args = (2.5), setup = Inputs::new, config = at_most(290.1))]
fn visible_normal_pdf(inputs: Inputs) -> f32 {
    let calls = inputs.v.iter().zip(&inputs.m);
    black_box(calls.map(|(v, m)| black_box(inputs.material.visible_normal_pdf(*v, *m))).sum())
}

#[library_benchmark]
#[bench::common(args = (2.5), setup = Inputs::new, config = at_most(2515.5))]
fn table_pdf(inputs: Inputs) -> f32 {
    let calls = inputs.v.iter().zip(&inputs.m);
    black_box(calls.map(|(v, m)| black_box(inputs.material.table_pdf(*v, *m))).sum())
}

/// GGX without tables.
fn closed_form() -> Inputs {
    Inputs::of(StudentT::ggx(microfacet_guard::SIGMA).expect("in range"))
}

#[library_benchmark]
#[bench::closed_form(setup = closed_form, config = at_most(34.5))]
fn ggx_g1(inputs: Inputs) -> f32 {
    black_box(inputs.v.iter().map(|v| black_box(inputs.material.g1(*v))).sum())
}

#[library_benchmark]
#[bench::closed_form(setup = closed_form, config = at_most(193.3))]
fn ggx_sample_visible_normal(inputs: Inputs) -> Vec3 {
    let calls = inputs.v.iter().zip(&inputs.u);
    black_box(calls.map(|(v, u)| black_box(inputs.material.sample_visible_normal(*v, *u))).sum())
}

library_benchmark_group!(
    name = hot,
    benchmarks = [
        sample_visible_normal,
        sample_batch,
        g1,
        g1_batch,
        visible_normal_pdf,
        table_pdf,
        ggx_g1,
        ggx_sample_visible_normal,
    ]
);
main!(library_benchmark_groups = hot);
