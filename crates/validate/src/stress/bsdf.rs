//! The rules of complete BSDFs: what is drawn and evaluated is finite, in range and on its side.

use glam::Vec3;

use microfacet_sampler::{Bsdf, BsdfSample, Event, Lobe, Transport};

use super::bsdfs::Bsdfs;
use super::checks::Checker;
use super::{Point, direction};

/// What rounding may add to a bound of a weight, and take from the length of a light.
const ROUNDING: f64 = 1e-5;

impl Checker<'_, Lobe> {
    /// Tests the BSDFs at one view; `turn` chooses the index of refraction.
    pub(super) fn bsdfs(&mut self, bsdfs: &Bsdfs, points: &[Point], turn: usize) {
        let v = points[0].view();
        let count = bsdfs.dielectrics.len();
        for (i, at) in points.iter().enumerate() {
            for (form, conductor) in bsdfs.conductors.iter().enumerate() {
                // A compensation gives back more than one sample's own light.
                let most = if form == 0 { 1.0 } else { f64::from(f32::MAX) };
                self.bsdf(conductor, v, at, i, Transport::Radiance, [most, 0.0]);
                self.black(conductor, -v, at);
            }
            self.bsdf(&bsdfs.plastic, v, at, i, Transport::Radiance, [f64::from(f32::MAX), 0.0]);
            self.black(&bsdfs.plastic, -v, at);
            self.pairs(bsdfs, v, at, i);
            let (eta, dielectric) = &bsdfs.dielectrics[(turn + i) % count];
            for v in [v, -v] {
                let relative = f64::from(if v.z > 0.0 { *eta } else { 1.0 / *eta });
                let radiance = [1.0, 1.0 / (relative * relative)];
                self.bsdf(dielectric, v, at, i, Transport::Radiance, radiance);
                self.bsdf(dielectric, v, at, i + 1, Transport::Importance, [1.0; 2]);
            }
        }
    }

    /// Tests haze and light that goes back.
    fn pairs(&mut self, bsdfs: &Bsdfs, v: Vec3, at: &Point, i: usize) {
        for hazy in &bsdfs.hazy[i % bsdfs.hazy.len()] {
            self.bsdf(hazy, v, at, i, Transport::Radiance, [1.0, 0.0]);
            self.black(hazy, -v, at);
        }
        for (form, back) in bsdfs.back.iter().enumerate() {
            let most = if form == 0 { 1.0 } else { f64::from(f32::MAX) };
            self.bsdf(back, v, at, i, Transport::Radiance, [most, 0.0]);
            self.black(back, -v, at);
        }
        for v in [v, -v] {
            self.bsdf(&bsdfs.hazy_glass, v, at, i, Transport::Importance, [1.0; 2]);
        }
    }

    /// Tests a sample and values of one BSDF; `most` are the largest weights of what is reflected
    /// and of what is transmitted.
    fn bsdf(
        &mut self,
        bsdf: &impl Bsdf<1>,
        v: Vec3,
        at: &Point,
        turn: usize,
        transport: Transport,
        most: [f64; 2],
    ) {
        let choices = [at.u[1], 0.0, 1.0, at.u[0], f32::NAN, 0.5];
        let choice = choices[turn % choices.len()];
        let sample = bsdf.sample_with_pdf(v, choice, at.u, transport);
        let l = direction(3.2 * f64::from(at.u[1]), at.phi + 2.0);
        let mut lights = vec![l, v, -v, Vec3::new(-v.x, -v.y, v.z), Vec3::X, Vec3::NAN];
        if let Some((sample, pdf)) = sample {
            self.sample(&sample, pdf, v, at, most, bsdf.is_delta());
            lights.push(sample.l.into());
        }
        let same = bsdf.sample(v, choice, at.u, transport) == sample.map(|(sample, _)| sample);
        self.require(same, "bsdf samples differ with and without pdf", 0.0, at);
        for l in lights {
            let ([f], pdf) = bsdf.eval_pdf(v, l, transport);
            self.density(f, "bsdf f negative, NaN or inf", at);
            self.density(pdf, "bsdf pdf negative, NaN or inf", at);
            let nothing = bsdf.is_delta() && f + pdf > 0.0;
            self.require(!nothing, "delta bsdf with f or pdf above 0", f, at);
        }
        let none = bsdf.sample(Vec3::NAN, choice, at.u, transport).is_none();
        self.require(none, "bsdf samples a view of NaN", 0.0, at);
    }

    fn sample(
        &mut self,
        sample: &BsdfSample<1>,
        pdf: f32,
        v: Vec3,
        at: &Point,
        most: [f64; 2],
        is_delta: bool,
    ) {
        let &BsdfSample { l, weight: [weight], event, delta, .. } = sample;
        let l = Vec3::from(l);
        self.unit(l.as_dvec3(), ROUNDING, "bsdf light not of unit length", at);
        let side = ((v.z > 0.0) == (l.z > 0.0) && l.z != 0.0) == (event == Event::Reflection);
        self.require(side, "bsdf light not on the side of its event", l.z, at);
        let weight = f64::from(weight);
        let most = most[usize::from(event == Event::Transmission)];
        let bound = most + ROUNDING * most;
        self.require(weight >= 0.0 && weight <= bound, "bsdf weight out of range", weight, at);
        self.density(pdf, "bsdf sample's pdf negative, NaN or inf", at);
        self.require(!delta || pdf == 0.0, "bsdf delta with a pdf", pdf, at);
        self.require(!is_delta || delta, "delta bsdf without a delta", pdf, at);
    }

    /// Tests that a conductor or plastic is black from below.
    fn black(&mut self, bsdf: &impl Bsdf<1>, v: Vec3, at: &Point) {
        if v.z > 0.0 {
            return;
        }
        let none = bsdf.sample(v, at.u[1], at.u, Transport::Radiance).is_none();
        let zero = bsdf.eval_pdf(v, Vec3::Z, Transport::Radiance) == ([0.0], 0.0);
        self.require(none && zero, "bsdf not black from below", v.z, at);
    }
}
