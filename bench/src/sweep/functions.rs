//! The functions that are swept, as calls over a range of cases.

use std::hint::black_box;
use std::ops::Range;

use glam::Vec3;

use microfacet_sampler::lobe::Bounded;
use microfacet_sampler::{Masking, MicrofacetDistribution};

/// The arguments of one call.
#[derive(Clone, Copy, Debug)]
pub(super) struct Case {
    /// The view.
    v: Vec3,
    /// The random numbers.
    u: [f32; 2],
    /// The normal that the lobe draws from them.
    m: Vec3,
    /// The light that is reflected off it.
    l: Vec3,
}

/// All cases of a cell, and room for results.
pub(super) struct Cases {
    each: Vec<Case>,
    v: Vec<Vec3>,
    u: Vec<[f32; 2]>,
    normals: Vec<Vec3>,
    values: Vec<f32>,
}

impl Cases {
    /// Of these views and numbers, seen by a lobe.
    pub(super) fn new(lobe: &impl MicrofacetDistribution, v: &[Vec3], u: &[[f32; 2]]) -> Self {
        let case = |(&v, &u): (&Vec3, &[f32; 2])| {
            let m = lobe.sample_visible_normal(v, u);
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

    /// Calls a scalar function for each case of a range; each result is used by itself.
    #[inline(always)]
    fn values(&mut self, at: Range<usize>, one: impl Fn(&Case) -> f32) {
        for (case, value) in self.each[at.clone()].iter().zip(&mut self.values[at]) {
            *value = black_box(one(case));
        }
    }

    /// The same for a function that gives a normal.
    #[inline(always)]
    fn normals(&mut self, at: Range<usize>, one: impl Fn(&Case) -> Vec3) {
        for (case, normal) in self.each[at.clone()].iter().zip(&mut self.normals[at]) {
            *normal = black_box(one(case));
        }
    }
}

/// A public function of a lobe.
pub(super) struct Function<L> {
    /// Its name.
    pub(super) name: &'static str,
    /// Whether its arguments depend on the random numbers, as normals and lights do.
    pub(super) reads_numbers: bool,
    /// Calls it for each case of a range.
    pub(super) run: fn(&L, &mut Cases, Range<usize>),
}

impl<L> Function<L> {
    /// A function of the view alone.
    fn of_view(name: &'static str, run: fn(&L, &mut Cases, Range<usize>)) -> Self {
        Self { name, reads_numbers: false, run }
    }

    /// A function of the random numbers, too, or of the normal or the light that they give.
    fn of_numbers(name: &'static str, run: fn(&L, &mut Cases, Range<usize>)) -> Self {
        Self { name, reads_numbers: true, run }
    }
}

/// Those of every lobe.
pub(super) fn common<L: MicrofacetDistribution>() -> Vec<Function<L>> {
    const G2: Masking = Masking::HeightCorrelated;
    vec![
        Function::of_numbers("d", |lobe: &L, cases, at| cases.values(at, |case| lobe.d(case.m))),
        Function::of_view("g1", |lobe: &L, cases, at| cases.values(at, |case| lobe.g1(case.v))),
        Function::of_view("lambda", |lobe: &L, cases, at| {
            cases.values(at, |case| lobe.lambda(case.v));
        }),
        Function::of_numbers("g2", |lobe: &L, cases, at| {
            cases.values(at, |case| lobe.g2(case.v, case.l, G2));
        }),
        Function::of_numbers("reflection_weight", |lobe: &L, cases, at| {
            cases.values(at, |case| lobe.reflection_weight(case.v, case.l, G2));
        }),
        Function::of_numbers("sample_visible_normal", |lobe: &L, cases, at| {
            cases.normals(at, |case| lobe.sample_visible_normal(case.v, case.u));
        }),
        Function::of_numbers("sample_with_pdf", |lobe: &L, cases, at| {
            cases.normals(at, |case| {
                let (m, pdf) = lobe.sample_with_pdf(case.v, case.u);
                black_box(pdf);
                m
            });
        }),
        Function::of_numbers("visible_normal_pdf", |lobe: &L, cases, at| {
            cases.values(at, |case| lobe.visible_normal_pdf(case.v, case.m));
        }),
        Function::of_numbers("table_pdf", |lobe: &L, cases, at| {
            cases.values(at, |case| lobe.table_pdf(case.v, case.m));
        }),
        Function::of_numbers("sample_batch", |lobe: &L, cases, at| {
            let Cases { v, u, normals, .. } = cases;
            lobe.sample_batch(&v[at.clone()], &u[at.clone()], &mut normals[at])
                .expect("of one length");
        }),
        Function::of_view("g1_batch", |lobe: &L, cases, at| {
            lobe.g1_batch(&cases.v[at.clone()], &mut cases.values[at]).expect("of one length");
        }),
    ]
}

/// Those of a Student-t bounded to reflections.
pub(super) fn of_bounded() -> Vec<Function<Bounded>> {
    vec![
        Function::of_numbers("at, drawn once", |bounded: &Bounded, cases, at| {
            cases.normals(at, |case| bounded.at(case.v).sample(case.u));
        }),
        Function::of_numbers("sample_batch", |bounded, cases, at| {
            let Cases { v, u, normals, values, .. } = cases;
            let (normals, shares) = (&mut normals[at.clone()], &mut values[at.clone()]);
            bounded.sample_batch(&v[at.clone()], &u[at], normals, shares).expect("of one length");
        }),
    ]
}
