//! The rivals of `microfacet-bake bench`, one by one, under a statistics harness: `cargo bench --bench run_time`.

// What the harness's macro makes has no docs.
#![allow(missing_docs)]

use std::hint::black_box;

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use glam::Vec3;
use microfacet_bake::bench::{COUNT, Inputs, Slices, maskings, samplers};

fn visible_normals(criterion: &mut Criterion) {
    let (slices, inputs) = (Slices::bake(), Inputs::new(1, COUNT));
    let mut group = criterion.benchmark_group("visible normals");
    group.throughput(Throughput::Elements(COUNT as u64));
    let mut normals = vec![Vec3::ZERO; COUNT];
    for sampler in samplers(&slices, 1) {
        group.bench_function(&sampler.name, |bencher| {
            bencher.iter(|| {
                (sampler.draw)(&inputs.views, &inputs.numbers, &mut normals);
                black_box(&mut normals);
            });
        });
    }
}

fn g1(criterion: &mut Criterion) {
    let (slices, inputs) = (Slices::bake(), Inputs::new(1, COUNT));
    let mut group = criterion.benchmark_group("g1");
    group.throughput(Throughput::Elements(COUNT as u64));
    let mut values = vec![0.0; COUNT];
    for masking in maskings(&slices) {
        group.bench_function(&masking.name, |bencher| {
            bencher.iter(|| {
                (masking.evaluate)(&inputs.views, &mut values);
                black_box(&mut values);
            });
        });
    }
}

criterion_group! {
    name = run_time;
    config = Criterion::default().sample_size(20);
    targets = visible_normals, g1
}
criterion_main!(run_time);
