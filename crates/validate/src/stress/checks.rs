//! The rules, each named by a function and what must not happen to its result.

use glam::{DVec3, Vec3};

use microfacet_model::MicrofacetDistribution as _;
use microfacet_model::{self as model, SignedSlope, VisibleSlope};
use microfacet_sampler::lobe::{Batch, Reflecting, Tabulated};
use microfacet_sampler::{Ggx, Lobe, Masking, MaterialError, Skew, StudentT, Tables};
use microfacet_tables::axis::half_tangent::half_tangent;

use super::bsdfs::Bsdfs;
use super::per_hit::{Families, per_hit};
use super::{Point, Region, Report, direction};

/// Four ulp of a unit vector's components.
pub(super) const ULP4: f64 = 4.0 * f32::EPSILON as f64;
/// One view in this many also tests the model's inverse CDFs, which cost a hundred lookups.
const MODEL_EVERY: usize = 8;
/// One view in this many also tests complete BSDFs.
const COMPLETE_EVERY: usize = 4;
/// One view in this many also tests batches, bounded normals, ellipsoids and albedo.
const DERIVED_EVERY: usize = 4;

/// Position in [`LOBES`](super::LOBES).
const BOUND: usize = 0;

/// The tilt towards the viewer in unit space.
struct Tilt {
    /// Unit slope.
    slope: f64,
    /// tan(α/2) ∈ [−1, 1].
    half_tangent: f64,
    /// The error of the half tangent from four ulp of m: large where m is tilted mostly across.
    rounding: f64,
}

pub(super) struct Checker<'a, L> {
    pub(super) lobe: L,
    /// Position in [`LOBES`](super::LOBES).
    kind: usize,
    rises: bool,
    exact: model::StudentT,
    report: &'a mut Report,
}

/// Tests a material at `views`, each a list of points that differ in `u` only, `u[0]` ascending;
/// GGX also by its closed forms.
pub(super) fn check(
    tables: &Tables,
    families: &Families,
    sigma: [f32; 2],
    gamma: f64,
    views: Vec<Vec<Point>>,
    report: &mut Report,
) -> Result<(), MaterialError> {
    if gamma == 2.0 {
        let ggx = Lobe::from(Ggx::new(sigma)?);
        let mut checker = Checker::new(ggx, BOUND, sigma, gamma, false, report)?;
        checker.views(&views);
        checker.complete(tables, &views);
    }
    if !tables.tabulates(gamma) {
        return Ok(());
    }
    let tabulated = tables.student_t(sigma, gamma)?;
    // A table whose heavy part is peeled holds less than all normals at grazing.
    let rises = tabulated.tabulated_share(Vec3::X) == 1.0;
    let shape = tables.student_t(1.0, gamma)?;
    per_hit(families, &shape, sigma, gamma, rises, &views, report)?;
    let bounded = shape.bounded();
    let lobe = Lobe::from(tabulated.clone());
    let mut checker = Checker::new(lobe, BOUND, sigma, gamma, rises, report)?;
    checker.tabulated_share(&tabulated, &views);
    checker.views(&views);
    checker.complete(tables, &views);
    // The matrix is arbitrary: `ellipsoids` replaces it.
    let lobe = tables.ellipsoid(Skew::new([1.0, 1.0], [0.0; 3])?, gamma)?;
    let forms = Masking::ALL;
    // A roughness outside the table, or a set without albedo, has none to check.
    let albedos: Vec<_> =
        forms.iter().filter_map(|form| tables.albedo(sigma[0].into(), gamma, *form).ok()).collect();
    for points in views.iter().step_by(DERIVED_EVERY) {
        checker.bounded(bounded.with_roughness(sigma), points);
        checker.ellipsoids(&lobe, points);
        for albedo in &albedos {
            checker.albedo(albedo, &points[points.len() / 2]);
        }
    }
    Ok(())
}

impl<'a> Checker<'a, Lobe> {
    /// Tests the BSDFs of the lobe at some views.
    fn complete(&mut self, tables: &Tables, views: &[Vec<Point>]) {
        let bsdfs = Bsdfs::new(&self.lobe, tables);
        // From the second view on: the derived tests take the first of each four.
        for (i, points) in views.iter().enumerate().skip(1).step_by(COMPLETE_EVERY) {
            self.bsdfs(&bsdfs, points, i);
        }
    }

    fn tabulated_share(&mut self, lobe: &StudentT, views: &[Vec<Point>]) {
        for points in views {
            let share = lobe.tabulated_share(points[0].view());
            self.share(share, "tabulated_share outside [0, 1]", &points[0]);
        }
    }
}

impl<'a, L: Reflecting + Tabulated + Batch> Checker<'a, L> {
    /// `rises`: whether the tilt towards the viewer rises with `u[0]` and is its quantile.
    pub(super) fn new(
        lobe: L,
        kind: usize,
        sigma: [f32; 2],
        gamma: f64,
        rises: bool,
        report: &'a mut Report,
    ) -> Result<Self, MaterialError> {
        let exact = model::StudentT::new(sigma, gamma).map_err(|_| MaterialError::Gamma(gamma))?;
        Ok(Self { lobe, kind, rises, exact, report })
    }

    /// σx and σy.
    pub(super) fn sigma(&self) -> [f64; 2] {
        [self.exact.sigma_x(), self.exact.sigma_y()]
    }

    pub(super) fn views(&mut self, views: &[Vec<Point>]) {
        for (i, points) in views.iter().enumerate() {
            self.view(&points[0]);
            let mut last = f64::NEG_INFINITY;
            for at in points {
                self.normal(at, &mut last);
            }
            if i % MODEL_EVERY == 0 {
                self.model_normal(&points[i % points.len()]);
            }
            if i % DERIVED_EVERY == 0 {
                self.batch(points);
            }
        }
    }
}

impl<L: Reflecting + Tabulated + Batch> Checker<'_, L> {
    /// The region of a point.
    fn region(&mut self, at: &Point) -> &mut Region {
        self.report.region(self.kind, at)
    }

    /// Records a broken rule; `value` is the offending number.
    pub(super) fn require(
        &mut self,
        holds: bool,
        rule: &'static str,
        value: impl Into<f64>,
        at: &Point,
    ) {
        if !holds {
            let violation = self.region(at).violations.entry(rule).or_default();
            violation.count += 1;
            violation.worst.see(value.into().abs(), at);
        }
    }

    /// Requires a number in [0, 1].
    pub(super) fn share(&mut self, x: impl Into<f64>, rule: &'static str, at: &Point) {
        let x = x.into();
        self.require((0.0..=1.0).contains(&x), rule, x, at);
    }

    /// Requires a finite number that is not negative.
    pub(super) fn density(&mut self, x: impl Into<f64>, rule: &'static str, at: &Point) {
        let x = x.into();
        self.require((0.0..=f64::MAX).contains(&x), rule, x, at);
    }

    /// Requires a vector of length 1, within `slack`.
    pub(super) fn unit(&mut self, w: DVec3, slack: f64, rule: &'static str, at: &Point) {
        let off = w.length() - 1.0;
        self.require(off.abs() <= slack, rule, off, at);
    }

    /// Tests functions of directions alone.
    fn view(&mut self, at: &Point) {
        let v = at.view();
        let g1 = f64::from(self.lobe.g1(v));
        self.share(g1, "g1 outside [0, 1]", at);
        self.require((g1 > 0.0) == (v.z > 0.0), "g1 = 0 above the horizon, or not below", g1, at);
        let lambda = self.lobe.lambda(v);
        self.require(lambda >= 0.0, "lambda negative or NaN", lambda, at);

        let precise = v.as_dvec3();
        let truth = self.exact.g1(precise);
        self.share(truth, "model g1 outside [0, 1]", at);
        let lambda = self.exact.lambda(precise);
        self.require(lambda >= 0.0, "model lambda negative or NaN", lambda, at);
        let raised = precise.with_z(if v.z < 0.0 { 0.0 } else { precise.z });
        let area = self.exact.inverse_area(raised);
        self.density(area, "model inverse_area negative, NaN or inf", at);
        self.region(at).errors[0].see((g1 - truth).abs(), at);

        for factor in [1.0 + 1e-6, 1.01, 1.5] {
            let theta = (at.theta * factor).min(std::f64::consts::PI);
            let further = f64::from(self.lobe.g1(direction(theta, at.phi)));
            self.require(further <= g1 + ULP4, "g1 rises with theta", further - g1, at);
        }
        // The light is an arbitrary other direction.
        let l = direction(1.5 * f64::from(at.u[1]), at.phi + 2.0);
        for masking in Masking::ALL {
            let (g2, swapped) = (self.lobe.g2(v, l, masking), self.lobe.g2(l, v, masking));
            let limited = f64::from(g2) <= g1.min(self.lobe.g1(l).into()) * (1.0 + ULP4);
            self.require(g2 >= 0.0 && limited, "g2 outside [0, min g1]", g2, at);
            self.require(g2 == swapped, "g2 not symmetric", g2 - swapped, at);
        }
    }

    /// Tests a sampled normal and its densities. `last` is the tilt at the previous random number.
    fn normal(&mut self, at: &Point, last: &mut f64) {
        self.region(at).points += 1;
        let v = at.view();
        let m = Vec3::from(self.lobe.sample_visible_normal(v, at.u));
        self.unit_and_above(m, at);
        let (same, drawn) = self.lobe.sample_with_table_pdf(v, at.u);
        self.require(m == Vec3::from(same), "sample_with_table_pdf draws another normal", 0.0, at);
        let facing = v.as_dvec3().dot(m.as_dvec3());
        let seen = v.z < 0.0 || facing >= -ULP4;
        self.require(seen, "sampled normal faces away", facing, at);

        let Tilt { half_tangent, rounding, .. } = self.tilt(v, m);
        if self.rises {
            let fall = *last - half_tangent;
            self.require(!(half_tangent < *last - rounding), "tilt falls with u1", fall, at);
        }
        *last = half_tangent;

        let lobe = &self.lobe;
        let (d, pdf, table) = (lobe.d(m), lobe.visible_normal_pdf(v, m), lobe.table_pdf(v, m));
        self.density(d, "d negative, NaN or inf", at);
        self.density(pdf, "visible_normal_pdf negative, NaN or inf", at);
        for table in [table, drawn] {
            self.density(table, "table_pdf negative, NaN or inf", at);
        }
        let divides = table.min(drawn) > 0.0 || pdf == 0.0 || v.z <= 0.0;
        self.require(divides, "table_pdf 0 at a drawn normal", pdf, at);
        let truth =
            [self.exact.d(m.as_dvec3()), self.exact.visible_normal_pdf(v.as_dvec3(), m.as_dvec3())];
        self.density(truth[0], "model d negative, NaN or inf", at);
        self.density(truth[1], "model pdf negative, NaN or inf", at);
        for (i, (got, want)) in [d, pdf].into_iter().zip(truth).enumerate() {
            // Outside this range f32 cannot hold it; at the silhouette v·m is mostly rounding.
            if (1e-30..1e30).contains(&want) && (i == 0 || facing > 1e-3) {
                self.region(at).errors[1 + i].see((f64::from(got) / want - 1.0).abs(), at);
            }
        }
    }

    pub(super) fn unit_and_above(&mut self, m: Vec3, at: &Point) {
        self.unit(m.as_dvec3(), ULP4, "sampled normal not of unit length", at);
        self.require(m.z > 0.0, "sampled normal not above the horizon", m.z, at);
    }

    /// The tilt that was drawn, recovered from m.
    fn tilt(&self, v: Vec3, m: Vec3) -> Tilt {
        let [sx, sy] = self.sigma().map(|sigma| sigma as f32);
        let rho = ((sx * v.x) * (sx * v.x) + (sy * v.y) * (sy * v.y)).sqrt();
        let [sx, sy] = [sx, sy].map(f64::from);
        let (v, m) = (v.as_dvec3(), m.as_dvec3());
        // The sampler treats these views as the normal, whose azimuth is arbitrary.
        let (vx, vy) = if rho < 1e-18 { (1.0, 0.0) } else { (sx * v.x, sy * v.y) };
        let rho = vx.hypot(vy);
        let (x, y) = (m.x / sx, m.y / sy);
        let (along, across) = ((x * vx + y * vy) / rho, (y * vx - x * vy) / rho);
        let r = along.hypot(m.z);
        Tilt {
            slope: along / m.z,
            half_tangent: half_tangent(along, m.z),
            rounding: 2.0 * ULP4 * across.hypot(r) / r,
        }
    }

    /// Tests the model's own sampler, and the distance of the table's normal from the model's.
    fn model_normal(&mut self, at: &Point) {
        let v = at.view();
        let m = self.exact.sample_visible_normal(v.as_dvec3(), at.u.map(f64::from));
        let ulp4 = 4.0 * f64::EPSILON;
        self.unit(m, ulp4, "model normal not of unit length", at);
        self.require(m.z > 0.0, "model normal not above the horizon", m.z, at);
        let facing = v.as_dvec3().dot(m);
        let seen = v.z < 0.0 || facing >= -2.0 * ULP4 * ULP4 - ulp4;
        self.require(seen, "model normal faces away", facing, at);
        let pdf = self.exact.visible_normal_pdf(v.as_dvec3(), m);
        self.density(pdf, "model pdf negative, NaN or inf", at);
        self.cdf_error(at);
    }

    /// Difference between u₁ and the share of visible normals tilted less than the one drawn.
    fn cdf_error(&mut self, at: &Point) {
        let v = at.view();
        let tilt = self.tilt(v, self.lobe.sample_visible_normal(v, at.u).into());
        if !self.rises || tilt.rounding > 1e-5 {
            return;
        }
        let shape = self.exact.shape();
        let (view, _) = self.exact.unit_view(v.with_z(v.z.max(0.0)).as_dvec3());
        let x = SignedSlope { w: shape.asinh_slope(tilt.slope.abs()), sign: tilt.slope.signum() };
        let cdf = VisibleSlope::new(shape, view).cdf(x);
        self.region(at).errors[3].see((cdf - f64::from(at.u[0])).abs(), at);
    }
}
