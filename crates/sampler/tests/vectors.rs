//! Renderers bring vectors of their own: arrays, glam of another version and nalgebra are taken and
//! given without a conversion; types are `Send` and `Sync`, and errors are `Copy`.

#![cfg(feature = "embedded")]

use glam_of_another_version as other;
use microfacet_sampler::lobe::{
    Batch, BatchError, Bounded, BoundedView, Facet, LobeKey, Radial, Reflecting, Smooth, Tabulated,
};
use microfacet_sampler::{
    AnyBsdf, BindError, Bsdf, BsdfSample, BsdfSettings, Conductor, ConductorFresnel, Dielectric,
    Ellipsoid, Ggx, LoadError, Lobe, Masking, MaterialError, Metal, MicrofacetDistribution,
    Plastic, StudentT, Tables, Transport, albedo,
};

/// What a renderer calls, with one type of vector in and out; bits of the results.
fn called<V>(v: V, l: V) -> Vec<u32>
where
    V: Copy + Into<[f32; 3]> + From<[f32; 3]>,
{
    let tables = Tables::embedded();
    let lobe = tables.student_t([0.3, 0.2], 2.5).unwrap();
    let m: V = lobe.sample_visible_normal(v, [0.3, 0.7]).into();
    let mut batch = [v; 4];
    lobe.sample_batch(&[v; 4], &[[0.3, 0.7]; 4], &mut batch).unwrap();
    let gold: Conductor<_> = Conductor::new(lobe, Metal::Gold, BsdfSettings::new()).unwrap();
    let sample = gold.sample(v, 0.5, [0.3, 0.7], Transport::Radiance).unwrap();
    let drawn: V = sample.l.into();
    let albedo = tables.albedo(0.3, 2.5, Masking::HeightCorrelated).unwrap();
    let [b, ..] = batch;
    let lobe = gold.lobe();
    [m, b, drawn]
        .into_iter()
        .flat_map(Into::into)
        .chain(sample.weight)
        .chain(gold.eval(v, l, Transport::Radiance))
        .chain([lobe.d(m), lobe.g1(v), lobe.g2(v, l, Masking::Uncorrelated), albedo.albedo(v)])
        .chain([lobe.table_pdf(v, m), lobe.eval_pdf(v, l, Masking::Uncorrelated).0])
        .map(f32::to_bits)
        .collect()
}

#[test]
fn any_vector_of_three_floats_serves() {
    let (v, l) = ([0.6, 0.0, 0.8], [0.0, 0.28, 0.96]);
    let expected = called(v, l);
    assert_eq!(called(glam::Vec3::from(v), l.into()), expected);
    assert_eq!(called(other::Vec3::from(v), l.into()), expected);
    assert_eq!(called(other::Vec3A::from(v), l.into()), expected);
    assert_eq!(called(nalgebra::Vector3::from(v), l.into()), expected);
    assert_eq!(called(nalgebra::Point3::from(v), l.into()), expected);
    // And without a name of its type.
    assert_eq!(Ggx::new(0.3).unwrap().g1([0.0, 0.0, 1.0]), 1.0);
}

#[test]
fn types_go_to_other_threads_and_errors_are_copied() {
    fn shared<T: Send + Sync + 'static>() {}
    fn copied<T: Copy + core::error::Error + Send + Sync + 'static>() {}
    fn error<T: Clone + core::error::Error + Send + Sync + 'static>() {}
    shared::<(Tables, StudentT, Ggx, Ellipsoid, Radial, Smooth, Bounded, BoundedView<'static>)>();
    shared::<(Lobe, LobeKey, Facet, BsdfSettings<'static>, BsdfSample, ConductorFresnel)>();
    shared::<(AnyBsdf, Conductor<Lobe>, Dielectric<Lobe>, Plastic<Lobe>)>();
    shared::<(albedo::Albedo, albedo::DielectricAlbedo, albedo::Moments, albedo::ViewCurve<3>)>();
    copied::<MaterialError>();
    copied::<BatchError>();
    error::<BindError>();
    error::<LoadError>();
}
