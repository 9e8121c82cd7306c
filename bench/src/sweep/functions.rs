//! The functions that are swept, as calls over a range of cases.

use std::hint::black_box;
use std::ops::Range;

use glam::Vec3;

use microfacet_sampler::lobe::{Batch, Bounded, Reflecting, Tabulated};
use microfacet_sampler::{Masking, MicrofacetDistribution};

/// The arguments of one call.
#[derive(Clone, Copy, Debug)]
pub(super) struct Case {
    v: Vec3,
    u: [f32; 2],
    /// The normal that the lobe draws for `v` and `u`.
    m: Vec3,
    /// `v` reflected at `m`.
    l: Vec3,
}

/// All cases of a cell, and room for the results of batches.
pub(super) struct Cases {
    each: Vec<Case>,
    v: Vec<Vec3>,
    u: Vec<[f32; 2]>,
    normals: Vec<Vec3>,
    values: Vec<f32>,
}

impl Cases {
    pub(super) fn new(lobe: &impl MicrofacetDistribution, v: &[Vec3], u: &[[f32; 2]]) -> Self {
        let case = |(&v, &u): (&Vec3, &[f32; 2])| {
            let m = Vec3::from(lobe.sample_visible_normal(v, u));
            Case { v, u, m, l: 2.0 * v.dot(m) * m - v }
        };
        Self {
            each: v.iter().zip(u).map(case).collect(),
            v: v.to_vec(),
            u: u.to_vec(),
            normals: vec![Vec3::ZERO; v.len()],
            values: vec![0.0; v.len()],
        }
    }
}

/// A public function of a lobe.
pub(super) struct Function<L> {
    pub(super) name: &'static str,
    /// Whether its arguments depend on the random numbers, as normals and lights do.
    pub(super) reads_numbers: bool,
    pub(super) run: Run<L>,
}

/// Calls it for each case of a range.
type Run<L> = Box<dyn Fn(&L, &mut Cases, Range<usize>)>;

/// One call after the other; each result is used by itself.
fn each<L, R>(
    name: &'static str,
    reads_numbers: bool,
    one: impl Fn(&L, &Case) -> R + 'static,
) -> Function<L> {
    let run = move |lobe: &L, cases: &mut Cases, at: Range<usize>| {
        for case in &cases.each[at] {
            black_box(one(lobe, case));
        }
    };
    Function { name, reads_numbers, run: Box::new(run) }
}

/// The functions of every lobe.
pub(super) fn common<L: Batch + Reflecting + Tabulated + 'static>() -> Vec<Function<L>> {
    const G2: Masking = Masking::HeightCorrelated;
    vec![
        each("d", true, |lobe: &L, at| lobe.d(at.m)),
        each("g1", false, |lobe: &L, at| lobe.g1(at.v)),
        each("lambda", false, |lobe: &L, at| lobe.lambda(at.v)),
        each("g2", true, |lobe: &L, at| lobe.g2(at.v, at.l, G2)),
        each("reflection_weight", true, |lobe: &L, at| lobe.reflection_weight(at.v, at.l, G2)),
        each("sample_visible_normal", true, |lobe: &L, at| lobe.sample_visible_normal(at.v, at.u)),
        each("sample_with_pdf", true, |lobe: &L, at| lobe.sample_with_pdf(at.v, at.u)),
        each("visible_normal_pdf", true, |lobe: &L, at| lobe.visible_normal_pdf(at.v, at.m)),
        each("sample_reflected", true, |lobe: &L, at| lobe.sample_reflected(at.v, at.u, G2)),
        each("eval_pdf", true, |lobe: &L, at| lobe.eval_pdf(at.v, at.l, G2)),
        each("table_pdf", true, |lobe: &L, at| lobe.table_pdf(at.v, at.m)),
        each("sample_with_table_pdf", true, |lobe: &L, at| lobe.sample_with_table_pdf(at.v, at.u)),
        Function {
            name: "sample_batch",
            reads_numbers: true,
            run: Box::new(|lobe, Cases { v, u, normals, .. }, at| {
                lobe.sample_batch(&v[at.clone()], &u[at.clone()], &mut normals[at])
                    .expect("of one length");
            }),
        },
        Function {
            name: "g1_batch",
            reads_numbers: false,
            run: Box::new(|lobe, Cases { v, values, .. }, at| {
                lobe.g1_batch(&v[at.clone()], &mut values[at]).expect("of one length");
            }),
        },
    ]
}

/// The functions of a Student-t lobe bounded to reflections.
pub(super) fn of_bounded() -> Vec<Function<Bounded>> {
    vec![
        each("at, drawn once", true, |bounded: &Bounded, at| bounded.at(at.v).sample(at.u)),
        Function {
            name: "sample_batch",
            reads_numbers: true,
            run: Box::new(|bounded, Cases { v, u, normals, values, .. }, at| {
                let (normals, shares) = (&mut normals[at.clone()], &mut values[at.clone()]);
                bounded
                    .sample_reflecting_batch(&v[at.clone()], &u[at], normals, shares)
                    .expect("of one length");
            }),
        },
    ]
}
