//! Instructions of the hot paths, counted by Callgrind and compared with the committed counts.

use std::hint::black_box;

use glam::Vec3;
use gungraun::{
    Callgrind, EventKind, LibraryBenchmarkConfig, library_benchmark, library_benchmark_group, main,
};
use microfacet_guard::{CALLS, Inputs};
use microfacet_sampler::{Bounded, Ellipsoid, Ggx, MicrofacetDistribution, StudentT};

/// The baseline: instructions per call at this commit. A count 1 % above it fails, which is one
/// instruction in the short paths.
fn at_most(instructions: f64) -> LibraryBenchmarkConfig {
    const TOLERANCE: f64 = 1.01;
    let limit = (instructions * TOLERANCE * CALLS as f64) as u64;
    let mut config = LibraryBenchmarkConfig::default();
    config.tool(Callgrind::default().hard_limits([(EventKind::Ir, limit)]));
    config
}

// Nothing is allocated, and inputs are returned, not freed: the cost of an allocation depends on
// the earlier ones.

// `common` shapes read the tables alone; `heavy` ones draw the tail that their tables leave out
// from its closed form.

#[library_benchmark]
#[bench::common(args = (2.5), setup = Inputs::new, config = at_most(178.6))]
#[bench::heavy(args = (1.6), setup = Inputs::new, config = at_most(304.2))]
fn sample_visible_normal(inputs: Inputs<StudentT>) -> (Vec3, Inputs<StudentT>) {
    let calls = inputs.v.iter().zip(&inputs.u);
    (
        black_box(calls.map(|(v, u)| black_box(inputs.lobe.sample_visible_normal(*v, *u))).sum()),
        inputs,
    )
}

#[library_benchmark]
#[bench::common(args = (2.5), setup = Inputs::new, config = at_most(175.5))]
#[bench::heavy(args = (1.6), setup = Inputs::new, config = at_most(222.3))]
fn sample_batch(mut inputs: Inputs<StudentT>) -> Inputs<StudentT> {
    inputs.lobe.sample_batch(&inputs.v, &inputs.u, &mut inputs.m).expect("equal lengths");
    black_box(inputs)
}

#[library_benchmark]
#[bench::common(args = (2.5), setup = Inputs::new, config = at_most(37.1))]
#[bench::heavy(args = (1.6), setup = Inputs::new, config = at_most(42.1))]
fn g1(inputs: Inputs<StudentT>) -> (f32, Inputs<StudentT>) {
    (black_box(inputs.v.iter().map(|v| black_box(inputs.lobe.g1(*v))).sum()), inputs)
}

#[library_benchmark]
#[bench::common(args = (2.5), setup = Inputs::new, config = at_most(23.6))]
fn g1_batch(mut inputs: Inputs<StudentT>) -> Inputs<StudentT> {
    inputs.lobe.g1_batch(&inputs.v, &mut inputs.g1).expect("equal lengths");
    black_box(inputs)
}

#[library_benchmark]
#[bench::common(args = (2.5), setup = Inputs::new, config = at_most(280.2))]
fn visible_normal_pdf(inputs: Inputs<StudentT>) -> (f32, Inputs<StudentT>) {
    let calls = inputs.v.iter().zip(&inputs.m);
    (black_box(calls.map(|(v, m)| black_box(inputs.lobe.visible_normal_pdf(*v, *m))).sum()), inputs)
}

#[library_benchmark]
#[bench::common(args = (2.5), setup = Inputs::new, config = at_most(883.5))]
#[bench::heavy(args = (1.6), setup = Inputs::new, config = at_most(1057.5))]
fn table_pdf(inputs: Inputs<StudentT>) -> (f32, Inputs<StudentT>) {
    let calls = inputs.v.iter().zip(&inputs.m);
    (black_box(calls.map(|(v, m)| black_box(inputs.lobe.table_pdf(*v, *m))).sum()), inputs)
}

#[library_benchmark]
#[bench::common(args = (2.5), setup = Inputs::bounded, config = at_most(304.6))]
fn bounded(inputs: Inputs<Bounded>) -> (Vec3, Inputs<Bounded>) {
    let calls = inputs.v.iter().zip(&inputs.u);
    (black_box(calls.map(|(v, u)| black_box(inputs.lobe.at(*v).sample(*u))).sum()), inputs)
}

#[library_benchmark]
#[bench::common(args = (2.5), setup = Inputs::bounded, config = at_most(295.9))]
fn bounded_batch(mut inputs: Inputs<Bounded>) -> Inputs<Bounded> {
    let Inputs { lobe, v, u, m, g1 } = &mut inputs;
    lobe.sample_batch(v, u, m, g1).expect("equal lengths");
    black_box(inputs)
}

#[library_benchmark]
#[bench::below_the_lobe(args = (2.5), setup = Inputs::below, config = at_most(198.2))]
fn ellipsoid_g1(inputs: Inputs<Ellipsoid>) -> (f32, Inputs<Ellipsoid>) {
    (black_box(inputs.v.iter().map(|v| black_box(inputs.lobe.g1(*v))).sum()), inputs)
}

#[library_benchmark]
#[bench::below_the_lobe(args = (2.5), setup = Inputs::below, config = at_most(697.0))]
fn ellipsoid_sample_visible_normal(inputs: Inputs<Ellipsoid>) -> (Vec3, Inputs<Ellipsoid>) {
    let calls = inputs.v.iter().zip(&inputs.u);
    (
        black_box(calls.map(|(v, u)| black_box(inputs.lobe.sample_visible_normal(*v, *u))).sum()),
        inputs,
    )
}

/// GGX without tables.
fn closed_form() -> Inputs<Ggx> {
    Inputs::of(Ggx::new(microfacet_guard::SIGMA).expect("in range"))
}

#[library_benchmark]
#[bench::closed_form(setup = closed_form, config = at_most(23.0))]
fn ggx_g1(inputs: Inputs<Ggx>) -> (f32, Inputs<Ggx>) {
    (black_box(inputs.v.iter().map(|v| black_box(inputs.lobe.g1(*v))).sum()), inputs)
}

#[library_benchmark]
#[bench::closed_form(setup = closed_form, config = at_most(138.1))]
fn ggx_sample_visible_normal(inputs: Inputs<Ggx>) -> (Vec3, Inputs<Ggx>) {
    let calls = inputs.v.iter().zip(&inputs.u);
    (
        black_box(calls.map(|(v, u)| black_box(inputs.lobe.sample_visible_normal(*v, *u))).sum()),
        inputs,
    )
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
        bounded,
        bounded_batch,
        ellipsoid_g1,
        ellipsoid_sample_visible_normal,
        ggx_g1,
        ggx_sample_visible_normal,
    ]
);
main!(library_benchmark_groups = hot);
