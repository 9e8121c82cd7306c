//! What is compared: a function with its name, its shape and its tables, as the clock runs it.

use std::hint::black_box;

use glam::Vec3;
use microfacet_sampler::lobe::Tabulated;
use microfacet_sampler::{StudentT, Tables};
use microfacet_tables::Table;

use crate::clock::Calls;
use crate::inputs::Inputs;
use crate::settings::SIGMA;
use crate::tables::Slices;

/// A rival of one material, of roughness [`SIGMA`].
pub(crate) struct Rival<F> {
    pub(crate) name: &'static str,
    /// The shape; ∞ is Beckmann, NaN any.
    pub(crate) gamma: f64,
    /// Bytes of table that lookups touch; 0 for closed forms.
    pub(crate) bytes: usize,
    /// Bytes of those tables as stored in a file.
    pub(crate) stored: usize,
    pub(crate) run: F,
}

impl<F> Rival<F> {
    /// A rival without tables.
    pub(crate) fn form(name: &'static str, gamma: f64, run: F) -> Self {
        Self { name, gamma, bytes: 0, stored: 0, run }
    }

    /// The rival, with the bytes of the tables of a set.
    pub(crate) fn of(self, set: &Tables) -> Self {
        Self { bytes: lobe(set, self.gamma).bytes(), stored: stored(set), ..self }
    }

    /// The rival, with the bytes of the tables over all γ that a family reads.
    pub(crate) fn of_family(self, slices: &Slices) -> Self {
        Self { bytes: slices.family().bytes(), stored: stored(slices.whole()), ..self }
    }
}

/// Bytes of a set's tables of lobes as stored in a file.
fn stored(set: &Tables) -> usize {
    let lookups = set.tables().iter().filter(|table| !table.kind.is_albedo());
    lookups.map(Table::stored_bytes).sum()
}

/// Normals for views and random numbers, as many as there are views.
pub(crate) type Draw<'a> = Box<dyn Fn(&[Vec3], &[[f32; 2]], &mut [Vec3]) + 'a>;

/// A function of directions, as many as the output slice holds.
pub(crate) type Evaluate<'a> = Box<dyn Fn(&[Vec3], &mut [f32]) + 'a>;

/// One call after the other. Each result is used by itself, so that the compiler neither drops a
/// call nor vectorises the loop: the calls of a path tracer lie apart.
pub(crate) fn each<'a, M: Into<Vec3>>(one: impl Fn(Vec3, [f32; 2]) -> M + 'a) -> Draw<'a> {
    in_a_loop(move |v, u| black_box(one(v, u)))
}

/// Calls in a loop over arrays, which the compiler may vectorise: it does that with closed forms
/// that have no branches, and not with lookups.
pub(crate) fn in_a_loop<'a, M: Into<Vec3>>(one: impl Fn(Vec3, [f32; 2]) -> M + 'a) -> Draw<'a> {
    Box::new(move |v, u, m| {
        for ((v, u), m) in v.iter().zip(u).zip(m) {
            *m = one(*v, *u).into();
        }
    })
}

/// One call after the other, as for [`each`].
pub(crate) fn each_value<'a>(one: impl Fn(Vec3) -> f32 + 'a) -> Evaluate<'a> {
    Box::new(move |w, values| {
        for (w, value) in w.iter().zip(values) {
            *value = black_box(one(*w));
        }
    })
}

/// A sampler as the clock runs it.
pub(crate) fn normals<'a>(
    draw: impl Fn(&[Vec3], &[[f32; 2]], &mut [Vec3]) + 'a,
    inputs: &'a Inputs,
) -> Calls<'a> {
    let mut normals = vec![Vec3::ZERO; inputs.views.len()];
    Box::new(move |at| {
        draw(&inputs.views[at.clone()], &inputs.numbers[at.clone()], &mut normals[at]);
        black_box(&mut normals);
    })
}

/// A function of directions as the clock runs it.
pub(crate) fn values<'a>(evaluate: &'a Evaluate<'a>, inputs: &'a Inputs) -> Calls<'a> {
    let mut values = vec![0.0; inputs.views.len()];
    Box::new(move |at| {
        evaluate(&inputs.views[at.clone()], &mut values[at]);
        black_box(&mut values);
    })
}

/// The lobe of γ from a set that covers it.
pub(crate) fn lobe(set: &Tables, gamma: f64) -> StudentT {
    set.student_t(SIGMA, gamma).expect("the sets were made for this shape")
}
