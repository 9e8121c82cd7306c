//! Instructions of the hot paths, counted by Callgrind and compared with the committed counts.

use std::hint::black_box;

use glam::Vec3;
use gungraun::{
    Callgrind, EventKind, LibraryBenchmarkConfig, library_benchmark, library_benchmark_group, main,
};
use microfacet_guard::{CALLS, Inputs};
use microfacet_sampler::lobe::{Batch, Bounded, Tabulated};
use microfacet_sampler::{
    Bsdf, Conductor, Ellipsoid, Family, Ggx, MicrofacetDistribution, StudentT, Transport,
};

/// The baseline: instructions per call at this commit. A count 1 % above it fails, which is one
/// instruction in the short paths.
fn at_most(instructions: f64) -> LibraryBenchmarkConfig {
    const TOLERANCE: f64 = 1.01;
    let limit = (instructions * TOLERANCE * CALLS as f64) as u64;
    let mut config = LibraryBenchmarkConfig::default();
    config.tool(Callgrind::default().hard_limits([(EventKind::Ir, limit)]));
    config
}

/// A family, the γ of all hits, and their other inputs.
type Hits = (Family, f32, Inputs<StudentT>);

/// The sum of normals, each of which is computed.
#[inline(always)]
fn sum(normals: impl Iterator<Item = [f32; 3]>) -> Vec3 {
    black_box(normals.map(|m| Vec3::from(black_box(m))).sum())
}

// Nothing is allocated, and inputs are returned, not freed: the cost of an allocation depends on
// the earlier ones.

// `common` shapes read the tables alone; `heavy` ones draw the tail that their tables leave out
// from its closed form, and D of `power_law` ones is not read from a table.

#[library_benchmark]
#[bench::common(args = (2.5), setup = Inputs::new, config = at_most(191.6))]
#[bench::heavy(args = (1.6), setup = Inputs::new, config = at_most(268.8))]
fn sample_visible_normal(inputs: Inputs<StudentT>) -> (Vec3, Inputs<StudentT>) {
    let calls = inputs.v.iter().zip(&inputs.u);
    (sum(calls.map(|(v, u)| inputs.lobe.sample_visible_normal(*v, *u))), inputs)
}

#[library_benchmark]
#[bench::common(args = (2.5), setup = Inputs::new, config = at_most(85.5))]
#[bench::heavy(args = (1.6), setup = Inputs::new, config = at_most(108.6))]
fn sample_batch(mut inputs: Inputs<StudentT>) -> Inputs<StudentT> {
    inputs.lobe.sample_batch(&inputs.v, &inputs.u, &mut inputs.m).expect("equal lengths");
    black_box(inputs)
}

/// σ of a hit.
fn roughness(u: &[f32; 2]) -> [f32; 2] {
    black_box([0.2 + u[0], 0.3])
}

#[library_benchmark]
#[bench::common(args = (2.5), setup = Inputs::new, config = at_most(209.6))]
#[bench::heavy(args = (1.6), setup = Inputs::new, config = at_most(288.4))]
fn sample_with_roughness(inputs: Inputs<StudentT>) -> (Vec3, Inputs<StudentT>) {
    let calls = inputs.v.iter().zip(&inputs.u);
    let one = |(v, u): (&Vec3, &[f32; 2])| {
        inputs.lobe.with_roughness(roughness(u)).sample_visible_normal(*v, *u)
    };
    (sum(calls.map(one)), inputs)
}

#[library_benchmark]
#[bench::common(args = (2.5), setup = microfacet_guard::family, config = at_most(409.3))]
#[bench::heavy(args = (1.6), setup = microfacet_guard::family, config = at_most(511.6))]
fn sample_of_family((family, gamma, inputs): Hits) -> (Vec3, Hits) {
    let calls = inputs.v.iter().zip(&inputs.u);
    let one = |(v, u): (&Vec3, &[f32; 2])| {
        family.at(roughness(u), black_box(gamma)).sample_visible_normal(*v, *u)
    };
    (sum(calls.map(one)), (family, gamma, inputs))
}

#[library_benchmark]
#[bench::common(args = (2.5), setup = microfacet_guard::family, config = at_most(156.2))]
fn g1_of_family((family, gamma, inputs): Hits) -> (f32, Hits) {
    let calls = inputs.v.iter().zip(&inputs.u);
    let one =
        |(v, u): (&Vec3, &[f32; 2])| black_box(family.at(roughness(u), black_box(gamma)).g1(*v));
    (black_box(calls.map(one).sum()), (family, gamma, inputs))
}

#[library_benchmark]
#[bench::common(args = (2.5), setup = Inputs::new, config = at_most(37.1))]
#[bench::heavy(args = (1.6), setup = Inputs::new, config = at_most(42.1))]
fn g1(inputs: Inputs<StudentT>) -> (f32, Inputs<StudentT>) {
    (black_box(inputs.v.iter().map(|v| black_box(inputs.lobe.g1(*v))).sum()), inputs)
}

#[library_benchmark]
#[bench::common(args = (2.5), setup = Inputs::new, config = at_most(15.9))]
fn g1_batch(mut inputs: Inputs<StudentT>) -> Inputs<StudentT> {
    inputs.lobe.g1_batch(&inputs.v, &mut inputs.g1).expect("equal lengths");
    black_box(inputs)
}

#[library_benchmark]
#[bench::common(args = (2.5), setup = Inputs::new, config = at_most(62.1))]
#[bench::power_law(args = (40.0), setup = Inputs::new, config = at_most(84.1))]
fn d(inputs: Inputs<StudentT>) -> (f32, Inputs<StudentT>) {
    (black_box(inputs.m.iter().map(|m| black_box(inputs.lobe.d(*m))).sum()), inputs)
}

#[library_benchmark]
#[bench::common(args = (2.5), setup = Inputs::new, config = at_most(129.1))]
fn visible_normal_pdf(inputs: Inputs<StudentT>) -> (f32, Inputs<StudentT>) {
    let calls = inputs.v.iter().zip(&inputs.m);
    (black_box(calls.map(|(v, m)| black_box(inputs.lobe.visible_normal_pdf(*v, *m))).sum()), inputs)
}

#[library_benchmark]
#[bench::common(args = (2.5), setup = Inputs::new, config = at_most(1000.3))]
#[bench::heavy(args = (1.6), setup = Inputs::new, config = at_most(1169.6))]
fn table_pdf(inputs: Inputs<StudentT>) -> (f32, Inputs<StudentT>) {
    let calls = inputs.v.iter().zip(&inputs.m);
    (black_box(calls.map(|(v, m)| black_box(inputs.lobe.table_pdf(*v, *m))).sum()), inputs)
}

#[library_benchmark]
#[bench::common(args = (2.5), setup = Inputs::bounded, config = at_most(330.6))]
fn bounded(inputs: Inputs<Bounded>) -> (Vec3, Inputs<Bounded>) {
    let calls = inputs.v.iter().zip(&inputs.u);
    (sum(calls.map(|(v, u)| inputs.lobe.at(*v).sample(*u))), inputs)
}

#[library_benchmark]
#[bench::common(args = (2.5), setup = Inputs::bounded, config = at_most(267.1))]
fn bounded_batch(mut inputs: Inputs<Bounded>) -> Inputs<Bounded> {
    let Inputs { lobe, v, u, m, g1 } = &mut inputs;
    lobe.sample_reflecting_batch(v, u, m, g1).expect("equal lengths");
    black_box(inputs)
}

// By what the compiler happens to inline, a normal of a view below the lobe's horizon takes this
// count, or 2 % fewer.

#[library_benchmark]
#[bench::below_the_lobe(args = (2.5), setup = Inputs::below, config = at_most(185.1))]
fn ellipsoid_g1(inputs: Inputs<Ellipsoid>) -> (f32, Inputs<Ellipsoid>) {
    (black_box(inputs.v.iter().map(|v| black_box(inputs.lobe.g1(*v))).sum()), inputs)
}

#[library_benchmark]
#[bench::below_the_lobe(args = (2.5), setup = Inputs::below, config = at_most(720.0))]
fn ellipsoid_sample_visible_normal(inputs: Inputs<Ellipsoid>) -> (Vec3, Inputs<Ellipsoid>) {
    let calls = inputs.v.iter().zip(&inputs.u);
    (sum(calls.map(|(v, u)| inputs.lobe.sample_visible_normal(*v, *u))), inputs)
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
#[bench::closed_form(setup = closed_form, config = at_most(141.1))]
fn ggx_sample_visible_normal(inputs: Inputs<Ggx>) -> (Vec3, Inputs<Ggx>) {
    let calls = inputs.v.iter().zip(&inputs.u);
    (sum(calls.map(|(v, u)| inputs.lobe.sample_visible_normal(*v, *u))), inputs)
}

// With Schlick's reflectance and without compensation; the light that is evaluated is another
// view's.

type Conductors = (Conductor<StudentT>, Inputs<StudentT>);

#[library_benchmark]
#[bench::common(args = (2.5), setup = microfacet_guard::conductor, config = at_most(357.5))]
#[bench::heavy(args = (1.6), setup = microfacet_guard::conductor, config = at_most(401.4))]
fn conductor_sample((conductor, inputs): Conductors) -> (f32, Conductors) {
    let calls = inputs.v.iter().zip(&inputs.u);
    let one = |(v, u): (&Vec3, &[f32; 2])| {
        let path = black_box(conductor.sample(*v, 0.5, *u, Transport::Radiance));
        path.map_or(0.0, |path| path.weight[0])
    };
    (black_box(calls.map(one).sum()), (conductor, inputs))
}

#[library_benchmark]
#[bench::common(args = (2.5), setup = microfacet_guard::conductor, config = at_most(402.0))]
#[bench::heavy(args = (1.6), setup = microfacet_guard::conductor, config = at_most(430.7))]
fn conductor_sample_with_pdf((conductor, inputs): Conductors) -> (f32, Conductors) {
    let calls = inputs.v.iter().zip(&inputs.u);
    let one = |(v, u): (&Vec3, &[f32; 2])| {
        let path = black_box(conductor.sample_with_pdf(*v, 0.5, *u, Transport::Radiance));
        path.map_or(0.0, |(_, pdf)| pdf)
    };
    (black_box(calls.map(one).sum()), (conductor, inputs))
}

#[library_benchmark]
#[bench::common(args = (2.5), setup = microfacet_guard::conductor, config = at_most(220.1))]
fn conductor_eval_pdf((conductor, inputs): Conductors) -> (f32, Conductors) {
    let calls = inputs.v.iter().zip(inputs.v.iter().rev());
    let one = |(v, l): (&Vec3, &Vec3)| black_box(conductor.eval_pdf(*v, *l, Transport::Radiance)).1;
    (black_box(calls.map(one).sum()), (conductor, inputs))
}

library_benchmark_group!(
    name = hot,
    benchmarks = [
        sample_visible_normal,
        sample_batch,
        sample_with_roughness,
        sample_of_family,
        g1_of_family,
        g1,
        g1_batch,
        d,
        visible_normal_pdf,
        table_pdf,
        bounded,
        bounded_batch,
        ellipsoid_g1,
        ellipsoid_sample_visible_normal,
        conductor_sample,
        conductor_sample_with_pdf,
        conductor_eval_pdf,
        ggx_g1,
        ggx_sample_visible_normal,
    ]
);
main!(library_benchmark_groups = hot);
