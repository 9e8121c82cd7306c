//! The program that comes with an export.

use bytemuck::{Pod, Zeroable};
use glam::Vec3;
use microfacet_sampler::{Masking, MicrofacetDistribution, Tables};

use crate::device::{Bound, Gpu};
use crate::export::Export;

#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
struct Query {
    v: [f32; 3],
    shape: u32,
    sigma: [f32; 2],
    u: [f32; 2],
}

#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
struct Answer {
    l: [f32; 3],
    weight: f32,
    m: [f32; 3],
    pdf: f32,
    f: f32,
    albedo: f32,
    average: f32,
    masking: f32,
}

/// Runs the program at a few views of each shape, in one call; returns whether the crate agrees.
pub fn runs(gpu: &Gpu, export: &Export, tables_of_export: Bound) -> bool {
    let tables = Tables::embedded();
    let (sigma, gammas) = ([0.2_f32, 0.6], [1.65, 3.0]);
    let query = |i: usize| {
        let (z, u) = ((i as f32 + 0.5) / 64.0, (i as f32 * 0.618_034).fract());
        let r = ((1.0 - z * z) * 0.5).sqrt();
        Query { v: [r, r, z], shape: export.offset(gammas[i % 2]), sigma, u: [u, 1.0 - z] }
    };
    let queries: Vec<Query> = (0..64).map(query).collect();
    let wgsl = format!("{}{}", export.module, export.sample);
    let program = gpu.program(&wgsl, "reflect_views", tables_of_export);
    let size = size_of::<Answer>() * queries.len();
    let bytes = gpu.run(&program, bytemuck::cast_slice(&queries), None, size, 1);
    let answers: Vec<Answer> = bytemuck::pod_collect_to_vec(&bytes);

    let mut worst = 0.0_f32;
    for (i, (query, answer)) in queries.iter().zip(answers).enumerate() {
        let gamma = gammas[i % 2];
        let lobe = tables.student_t(sigma.map(f64::from), gamma).expect("a lobe");
        let mean = f64::from(sigma[0] * sigma[1]).sqrt();
        let albedo = tables.albedo(mean, gamma, Masking::HeightCorrelated).expect("albedos");
        let v = Vec3::from(query.v);
        let m = Vec3::from(lobe.sample_visible_normal(v, query.u));
        let l = 2.0 * v.dot(m) * m - v;
        let pdf = lobe.visible_normal_pdf(v, m) / (4.0 * v.dot(m));
        let f = if l.z > 0.0 { albedo.compensation(v, l) } else { 0.0 };
        let weight = lobe.reflection_weight(v, l, Masking::HeightCorrelated);
        let expected = [weight, f, albedo.albedo(v), albedo.albedo_average(), lobe.g1(v)];
        let got = [answer.weight, answer.f, answer.albedo, answer.average, answer.masking];
        let vectors = [(answer.l, l), (answer.m, m)];
        let mut differ = |got: f32, want: f32| {
            let difference = (got - want).abs();
            worst = worst.max(if difference.is_nan() { f32::INFINITY } else { difference });
        };
        expected.into_iter().zip(got).for_each(|(want, got)| differ(got, want));
        for (got, want) in vectors {
            (0..3).for_each(|k| differ(got[k], want[k]));
        }
        differ(answer.pdf / pdf, 1.0);
    }
    println!("the sample that comes with the export: 64 views to {worst:.1e}, of 1e-4 allowed");
    worst <= 1e-4
}
