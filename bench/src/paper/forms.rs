//! The computations of G1 that are compared, each as the clock runs it, alone and as part of a
//! renderer.

use std::hint::black_box;
use std::rc::Rc;

use glam::Vec3;
use microfacet_model::printed;
use microfacet_sampler::MicrofacetDistribution as _;
use microfacet_sampler::{self as sampler, StudentT, Tables};
use microfacet_study::spheres::sky::Sky;

use super::method::Method;
use super::studio::Metal;
use crate::rival::{Evaluate, each_value};
use crate::rivals::lobe::Lobe;
use crate::rivals::rational::{LARGEST, Rational};
use crate::rivals::{beckmann, ggx};
use crate::settings::Film;

/// Makes the line of a picture with this number.
pub(crate) type Line<'a> = Box<dyn Fn(usize) + 'a>;

/// One computation of G1 for one material.
pub(crate) struct Form<'a> {
    pub(crate) method: Method,
    /// G1 alone.
    pub(crate) g1: Evaluate<'a>,
    /// Makes a line of a picture of rough gold.
    pub(crate) line: Line<'a>,
}

/// What the pictures have in common.
pub(crate) struct Stage {
    pub(crate) film: Film,
    pub(crate) sky: Sky,
    pub(crate) seed: u32,
}

impl Stage {
    fn form<'a>(
        &'a self,
        method: Method,
        lobe: &StudentT,
        g1: impl Fn(Vec3) -> f32 + Clone + 'a,
    ) -> Form<'a> {
        let gold = Metal::new(lobe.clone(), g1.clone(), sampler::Metal::Gold.into());
        let line = move |y| {
            self.film.line(y, &gold, &self.sky, self.seed).for_each(|pixel| {
                black_box(pixel);
            });
        };
        Form { method, g1: each_value(g1), line: Box::new(line) }
    }

    /// All computations for a Student-t lobe. Those of the paper are as printed, in double
    /// precision, except the rational approximation, whose dependence on γ is prepared.
    pub(crate) fn of_shape<'a>(&'a self, set: &Tables, gamma: f64, sigma: f64) -> Vec<Form<'a>> {
        let lobe = set.student_t(sigma, gamma).expect("the general set covers all shapes");
        // At normal incidence z is infinite, and a term of the printed formulas is 0 times z.
        let z = move |w: Vec3| {
            let z = f64::from(w.z) / (sigma * f64::from((w.x * w.x + w.y * w.y).sqrt()));
            z.min(f64::from(LARGEST))
        };
        let g1 = |lambda: f64| (1.0 / (1.0 + lambda)) as f32;
        let mut all = vec![self.form(Method::Hypergeometric, &lobe, move |w| {
            g1(printed::lambda_hypergeometric(gamma, z(w)))
        })];
        if printed::lambda_integer(gamma, 1.0).is_some() {
            let sum = move |w| g1(printed::lambda_integer(gamma, z(w)).unwrap_or(f64::NAN));
            all.push(self.form(Method::Integer, &lobe, sum));
        }
        if printed::lambda_half_integer(gamma, 1.0).is_some() {
            let sum = move |w| g1(printed::lambda_half_integer(gamma, z(w)).unwrap_or(f64::NAN));
            all.push(self.form(Method::HalfInteger, &lobe, sum));
        }
        let rational = Rational::new(sigma, gamma);
        all.push(self.form(Method::Rational, &lobe, move |w| rational.g1(w)));
        let beta = Rc::new(Lobe::any(sigma, gamma));
        all.push(self.form(Method::Beta, &lobe, move |w| beta.g1(w)));
        all.push(self.table(set, gamma, sigma));
        all
    }

    /// G1 of the table, for any shape.
    pub(crate) fn table<'a>(&'a self, set: &Tables, gamma: f64, sigma: f64) -> Form<'a> {
        let lobe = set.student_t(sigma, gamma).expect("the general set covers all shapes");
        let table = lobe.clone();
        self.form(Method::Table, &lobe, move |w| table.g1(w))
    }

    /// The closed forms that a renderer without the family has, with their shapes.
    pub(crate) fn references<'a>(&'a self, set: &Tables, sigma: f64) -> Vec<(f64, Form<'a>)> {
        let of = |gamma| set.student_t(sigma, gamma).expect("the general set covers all shapes");
        let single = sigma as f32;
        vec![
            (2.0, self.form(Method::Ggx, &of(2.0), move |w| ggx::g1(single, w))),
            (
                f64::INFINITY,
                self.form(Method::Beckmann, &of(f64::INFINITY), move |w| beckmann::g1(single, w)),
            ),
        ]
    }
}

#[cfg(test)]
mod tests {
    use microfacet_model as model;
    use microfacet_model::MicrofacetDistribution as _;

    use super::super::times::{GAMMAS, SIGMAS};
    use super::*;
    use crate::inputs::Inputs;

    #[test]
    fn every_form_is_g1_of_its_shape() {
        let set = Tables::embedded();
        let stage = Stage { film: Film { edge: 1, samples: 1 }, sky: Sky::studio(), seed: 1 };
        let mut views = Inputs::new(1, 500).views;
        views.push(Vec3::Z);
        let check = |gamma: f64, sigma: f64, form: Form| {
            let truth = model::StudentT::new(sigma, gamma).unwrap();
            let tolerance = if form.method == Method::Rational { 8e-3 } else { 5e-6 };
            let mut values = vec![0.0; views.len()];
            (form.g1)(&views, &mut values);
            for (v, got) in views.iter().zip(values) {
                let error = f64::from(got) - truth.g1(v.as_dvec3());
                assert!(
                    error.abs() < tolerance,
                    "{:?}, gamma {gamma}, sigma {sigma}, {v}: {error:e}",
                    form.method
                );
            }
        };
        for sigma in [SIGMAS[0], 0.5, SIGMAS[SIGMAS.len() - 1]] {
            for gamma in GAMMAS {
                stage.of_shape(&set, gamma, sigma).into_iter().for_each(|form| {
                    check(gamma, sigma, form);
                });
            }
            for (gamma, form) in stage.references(&set, sigma) {
                check(gamma, sigma, form);
            }
            check(f64::INFINITY, sigma, stage.table(&set, f64::INFINITY, sigma));
        }
    }
}
