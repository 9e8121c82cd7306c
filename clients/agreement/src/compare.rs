//! Compares the results of exported functions with the crate's.

use std::collections::BTreeMap;

use glam::Vec3;

use microfacet_sampler::albedo::{Albedo, Moments};
use microfacet_sampler::{Ggx, Lobe, Masking, MicrofacetDistribution, Tables};

use crate::lookup::{Answer, Point};
use crate::points::Group;

/// Limits of the differences.
pub struct Limits {
    /// Masking, weights and albedos.
    pub share: f64,
    /// Coordinates of normals.
    pub normal: f64,
    /// Normals of σ above [`ROUGH`].
    pub rough: Rough,
    /// Normals for γ < 1.8: of views within 1e-6 of the horizon, and of all views of lobes with σ
    /// above [`ROUGH`], in units of σ. There nearly all normals are in the heavy part, whose
    /// smallest slopes are the root of 1 less a share of the light close to 1, of which single
    /// precision has few digits.
    pub heavy: f64,
    /// Averages of albedos.
    pub average: f64,
    /// Relative differences of densities: a constant, and one for each unit of |ln(D σx σy)|.
    pub density: [f64; 2],
    /// Albedos for γ below [`SLOW`] and cosines below 1e-6, and below 1e-20. Albedos approach their
    /// limit with a power of about 0.002 of the cosine, by which both sides extrapolate in single
    /// precision from two albedos that differ in their last digits.
    pub extrapolated: [f64; 2],
    /// Whether NaN arguments must give numbers; otherwise points with NaN are left out.
    pub of_nan: bool,
    /// The largest Λ, that of the horizon.
    pub lambda: f32,
}

/// How normals of rough lobes are compared: at grazing views the last digits of a slope turn them.
pub enum Rough {
    /// By their coordinates, with this limit: for the same operations in the same order.
    Coordinates(f64),
    /// With the limits of other normals, by their coordinates or by those of the normals of σ = 1
    /// that they are stretched from, where they are closer: the last digits of its slope turn a
    /// flat normal much, and the last digits of its coordinates change the slope of a steep one
    /// much.
    Stretched,
}

const ROUGH: f32 = 10.0;
const SLOW: f64 = 1.6;
const HEAVY: f64 = 1.8;
/// Below it single precision loses digits.
pub(crate) const SMALLEST: f64 = 1.2e-38;

impl Limits {
    /// The relative difference that is allowed for a density.
    pub(crate) fn density(&self, d: f64, sigma: [f32; 2]) -> f64 {
        let log = (d.max(1e-38) * f64::from(sigma[0]) * f64::from(sigma[1])).ln().abs();
        self.density[0] + self.density[1] * log
    }
}

/// The largest differences by quantity, as shares of what is allowed, and where they are.
pub(crate) struct Worst<'a> {
    limits: &'a Limits,
    seen: BTreeMap<&'static str, (f64, f64, String)>,
}

impl<'a> Worst<'a> {
    pub(crate) fn new(limits: &'a Limits) -> Self {
        Self { limits, seen: BTreeMap::new() }
    }

    /// Prints the table, and returns whether all are within what is allowed.
    pub(crate) fn print(&self) -> bool {
        for (name, (share, difference, at)) in &self.seen {
            let verdict = if *share <= 1.0 { "" } else { "  TOO FAR" };
            println!("  {name:20} {difference:.1e}, {share:.2} of what is allowed{verdict}; {at}");
        }
        self.seen.values().all(|(share, ..)| *share <= 1.0)
    }

    /// Compares a language's answers at points of one shape; returns how many were compared.
    pub(crate) fn group(
        &mut self,
        tables: &Tables,
        gamma: f64,
        group: &Group,
        language: &str,
        answers: &[Answer],
    ) -> usize {
        let (sigma, mut count) = (group.points[0].sigma, 0);
        let (lobe, albedos) = (lobe(tables, sigma, gamma), albedos(tables, sigma, gamma));
        for (point, answer) in group.points.iter().zip(answers) {
            if has_nan(point) && !self.limits.of_nan {
                continue;
            }
            count += 1;
            let (limits, at) = (self.limits, [language, group.name]);
            let mut case = Case { limits, seen: &mut self.seen, at, gamma, point, answer };
            if is_odd(point) {
                case.ranges();
            } else {
                case.numbers();
                case.directions(&lobe);
                case.densities(&lobe);
                case.shares(albedos.as_ref());
            }
        }
        count
    }
}

/// A point with the answer of a language.
struct Case<'a> {
    limits: &'a Limits,
    seen: &'a mut BTreeMap<&'static str, (f64, f64, String)>,
    at: [&'a str; 2],
    gamma: f64,
    point: &'a Point,
    answer: &'a Answer,
}

/// The crate's albedos of one roughness, for both forms of masking: those of the stand-in, with σ
/// clamped to the range of the tables. `None` for σ ≤ 0, which exports take for a mirror.
fn albedos(tables: &Tables, sigma: [f32; 2], gamma: f64) -> Option<[Albedo; 2]> {
    if !sigma.iter().all(|sigma| *sigma > 0.0) {
        return None;
    }
    let [x, y] = clamped(sigma).map(f64::from);
    let sigma = (x * y).sqrt().clamp(1e-8, 3.0);
    Some(Masking::ALL.map(|masking| tables.albedo(sigma, gamma, masking).unwrap()))
}

/// The roughness that exports use.
fn clamped(sigma: [f32; 2]) -> [f32; 2] {
    // NaN becomes the smallest.
    sigma.map(|sigma| if sigma > 1e-8 { sigma.min(1e6) } else { 1e-8 })
}

/// The lobe that draws normals as the export does: for GGX by closed forms.
fn lobe(tables: &Tables, sigma: [f32; 2], gamma: f64) -> Lobe {
    let sigma = clamped(sigma).map(f64::from);
    if gamma == 2.0 {
        Ggx::new(sigma).unwrap().into()
    } else {
        tables.student_t(sigma, gamma).unwrap().into()
    }
}

fn has_nan(point: &Point) -> bool {
    let directions = [point.v, point.l, point.m];
    let scalars = point.u.iter().chain(&point.sigma);
    directions.as_flattened().iter().chain(scalars).any(|x| x.is_nan())
}

fn far(a: f32, b: f32) -> f64 {
    (f64::from(a) - f64::from(b)).abs()
}

/// Whether a direction has NaN, or a view is neither null nor of length 1: then results must only
/// be in their ranges.
fn is_odd(point: &Point) -> bool {
    let has_nan = [point.v, point.l, point.m].as_flattened().iter().any(|x| x.is_nan());
    let length = point.v.iter().map(|&x| f64::from(x).powi(2)).sum::<f64>().sqrt();
    has_nan || length > 0.0 && (length - 1.0).abs() > 1e-6
}

/// The normal of σ = 1 from which this one is stretched.
fn unstretched([x, y, z]: [f32; 3], [sigma_x, sigma_y]: [f32; 2]) -> [f32; 3] {
    let [x, y, z] = [x, y, z].map(f64::from);
    let m = [x / f64::from(sigma_x), y / f64::from(sigma_y), z];
    let length = m.iter().map(|x| x * x).sum::<f64>().sqrt();
    m.map(|x| (x / length) as f32)
}

/// The largest difference of a coordinate; ∞ for NaN, which a maximum would ignore.
fn apart(a: [f32; 3], b: [f32; 3]) -> f64 {
    let apart = [far(a[0], b[0]), far(a[1], b[1]), far(a[2], b[2])];
    let most = apart.into_iter().fold(0.0, f64::max);
    if apart.iter().any(|x| x.is_nan()) { f64::INFINITY } else { most }
}

fn in_order(Moments { scale, bias, f82, .. }: Moments) -> [f32; 3] {
    [scale, bias, f82]
}

impl Case<'_> {
    fn see(&mut self, name: &'static str, difference: f64, allowed: f64) {
        let difference = if difference.is_nan() { f64::INFINITY } else { difference };
        let entry = self.seen.entry(name).or_default();
        if difference / allowed > entry.0 || entry.2.is_empty() {
            let [language, group] = self.at;
            let at = format!("{language}, gamma {}, {group} {:?}", self.gamma, self.point);
            *entry = (difference / allowed, difference, at);
        }
    }

    /// A condition, as a difference of 0 or ∞.
    fn holds(&mut self, name: &'static str, holds: bool) {
        self.see(name, if holds { 0.0 } else { f64::INFINITY }, 1.0);
    }

    /// Results are numbers, and those that must vanish are 0.
    fn numbers(&mut self) {
        let (point, answer) = (self.point, self.answer);
        let mut all = bytemuck::cast_slice::<_, f32>(std::slice::from_ref(answer)).iter();
        let finite = all.all(|x| x.is_finite() || *x == answer.lambda);
        let lambda = (0.0..=self.limits.lambda).contains(&answer.lambda);
        let behind = Vec3::from(point.v).dot(Vec3::from(point.m)) < -1e-6 || !(point.m[2] > 0.0);
        let vanishes = !behind || answer.reflection_pdf == 0.0 && answer.pdf == 0.0;
        self.holds("numbers", finite && lambda && vanishes && answer.reflection_pdf >= 0.0);
    }

    fn ranges(&mut self) {
        let answer = self.answer;
        let parts = [answer.parts, answer.average_parts];
        let shares = [answer.g2, answer.weight, answer.albedo, answer.average];
        let shares = shares.as_flattened().iter().chain(parts.as_flattened().as_flattened());
        let mut sound = shares.chain([&answer.g1]).all(|x| (0.0..=1.0).contains(x));
        let densities = [answer.d, answer.pdf, answer.reflection_pdf];
        sound &= densities.iter().chain(&answer.compensation).all(|x| *x >= 0.0 && x.is_finite());
        sound &= answer.lambda >= 0.0;
        sound &= (Vec3::from(answer.normal).length() - 1.0).abs() < 1e-6 && answer.normal[2] > 0.0;
        self.holds("range elsewhere", sound);
    }

    fn directions(&mut self, lobe: &Lobe) {
        let (limits, point, answer) = (self.limits, self.point, self.answer);
        let sigma = clamped(point.sigma);
        let [v, l, m] = [point.v, point.l, point.m].map(Vec3::from);
        self.see("g1", far(answer.g1, lobe.g1(v)), limits.share);
        self.see("lambda, by G1", far(1.0 / (1.0 + answer.lambda), lobe.g1(v)), limits.share);
        for (k, masking) in Masking::ALL.into_iter().enumerate() {
            self.see("g2", far(answer.g2[k], lobe.g2(v, l, masking)), limits.share);
            let weight = lobe.reflection_weight(v, l, masking);
            self.see("reflection_weight", far(answer.weight[k], weight), limits.share);
        }
        let normal = lobe.sample_visible_normal(v, point.u);
        let is_rough = sigma[0].max(sigma[1]) > ROUGH;
        let heavy = self.gamma < HEAVY && (is_rough || v.z < 1e-6);
        let (mut name, mut allowed) =
            if heavy { ("normal, heavy", limits.heavy) } else { ("normal", limits.normal) };
        let mut difference = apart(answer.normal, normal);
        match limits.rough {
            Rough::Coordinates(limit) if is_rough => (name, allowed) = ("normal, rough", limit),
            Rough::Stretched if is_rough && difference.is_finite() => {
                let [a, b] = [answer.normal, normal].map(|m| unstretched(m, sigma));
                difference = difference.min(apart(a, b));
            }
            _ => (),
        }
        self.see(name, difference, allowed);
        let light = 2.0 * v.dot(m) * m - v;
        self.see("reflect", apart(answer.light, light.to_array()), limits.share);
        self.holds("normal above", answer.normal[2] > 0.0);
    }

    fn densities(&mut self, lobe: &Lobe) {
        let answer = self.answer;
        let [v, m] = [self.point.v, self.point.m].map(Vec3::from);
        let d = lobe.d(m);
        let allowed = self.limits.density(f64::from(d), clamped(self.point.sigma));
        for (name, got, want) in
            [("d", answer.d, d), ("visible_normal_pdf", answer.pdf, lobe.visible_normal_pdf(v, m))]
        {
            let difference = far(got, want);
            if difference.is_nan() || difference > SMALLEST {
                self.see(name, difference / f64::from(want), allowed);
            }
        }
        let facing = v.dot(m);
        // Elsewhere the quotient loses its digits, or has overflowed.
        if facing > 0.0 && (1e-30..1e37).contains(&answer.pdf) {
            let quotient = f64::from(answer.pdf) / (4.0 * f64::from(facing));
            let difference = (f64::from(answer.reflection_pdf) - quotient).abs();
            if difference > SMALLEST && quotient < 1e37 {
                self.see("reflection_pdf", difference / quotient, self.limits.density[0]);
            }
        }
    }

    fn shares(&mut self, albedos: Option<&[Albedo; 2]>) {
        let (limits, answer) = (self.limits, self.answer);
        let [v, l] = [self.point.v, self.point.l].map(Vec3::from);
        let (name, parts, share) = match v.z {
            z if self.gamma < SLOW && z < 1e-20 => {
                ("albedo, at horizon", "parts, at horizon", limits.extrapolated[1])
            }
            z if self.gamma < SLOW && z < 1e-6 => {
                ("albedo, close to it", "parts, close to it", limits.extrapolated[0])
            }
            _ => ("albedo", "albedo_parts", limits.share),
        };
        let Some(albedos) = albedos else {
            let whole = [answer.albedo, answer.average].as_flattened().iter().all(|e| *e == 1.0);
            self.holds("mirror", whole && answer.compensation == [0.0; 2]);
            return;
        };
        for (k, albedo) in albedos.iter().enumerate() {
            self.see(name, far(answer.albedo[k], albedo.albedo(v)), share);
            let average = far(answer.average[k], albedo.albedo_average());
            self.see("albedo_average", average, limits.average);
            self.see(parts, apart(answer.parts[k], in_order(albedo.moments(v))), share);
            let average = apart(answer.average_parts[k], in_order(albedo.average_moments()));
            self.see("albedo_average_parts", average, limits.average);
            if !(v.z > 0.0 && l.z > 0.0) {
                self.see("compensation", f64::from(answer.compensation[k]), limits.share);
                continue;
            }
            let [v, l, average] = [albedo.lost(v), albedo.lost(l), albedo.lost_average()];
            let [v, l, average] = [v, l, average].map(f64::from);
            let both = v * l * std::f64::consts::FRAC_1_PI;
            let difference = (f64::from(answer.compensation[k]) - both / average).abs();
            // The limit follows from those of the factors. An average close to 0 has few digits.
            if average > 1e-3 {
                let allowed = (both * limits.average / average + 2.0 * limits.share) / average;
                self.see("compensation", difference, allowed);
            }
        }
    }
}
