//! The certificate of albedo tables for any lobe and reflectance: errors of the run-time lookup
//! against the model's quadrature, at the points that [`points`](super::points) lists.

use glam::Vec3;
use rayon::prelude::*;

use microfacet_core::shape::s_of_gamma;
use microfacet_model::Albedo;
use microfacet_sampler::albedo::{Albedo as TabulatedAlbedo, Moments, ViewCurve};
use microfacet_sampler::{Masking, MaterialError, Tables};
use microfacet_tables::{
    Axis, Certificate, Coordinate, Errors, Kind, LobeForm, Quantity, Reflectance, Table,
};

use super::certificate::round_up;
use super::climb::{self, At, climbed};
use super::points::{Point, crease, edges, interior, middles, of_averages, smooth};
use crate::bake::albedo::{AlbedoError, AlbedoSpec, CHANNELS, Integrand, Models, Site};
use crate::progress::Stage;

/// Accuracy of the model's values that tables are compared with, as a multiple of that of a node.
const FINER: f64 = 0.1;
/// [`FINER`] of tilted lobes, to whose errors the estimates of the model's own are added.
const AS_FINE: f64 = 1.0;
/// Smallest tolerance for a reflectance with a kink: a smaller one would take seconds.
const FINEST_OF_KINKS: f64 = 1e-6;

/// The model's values for one material and view.
#[derive(Clone)]
pub struct Reference {
    /// With the site after rounding to the sampler's inputs.
    point: Point,
    v: Vec3,
    exact: Albedo<CHANNELS>,
    /// How far off E of the isotropic stand-in is, or the worse of a dielectric's shares, if there
    /// is one, by form of masking.
    shortcut: Option<[f64; 2]>,
}

/// The model's values at the interior points, which do not depend on the number of nodes. Each
/// point is one step of the stage.
///
/// # Errors
/// [`AlbedoError`] for a lobe outside the domain.
pub fn interior_references(
    spec: &AlbedoSpec,
    stage: &Stage,
) -> Result<Vec<Reference>, AlbedoError> {
    let points = interior(spec);
    stage.split(points.len());
    references(spec, points, true, stage)
}

/// The model's values at corners, in the middle of every cell along every edge, of smooth surfaces,
/// in the middles of cells over azimuths, and on the crease of a tilted lobe, for which `tables`
/// tell the cells that matter. Each point is one step of the stage.
///
/// # Errors
/// [`AlbedoError`] for a lobe outside the domain, or if a table does not cover its own domain.
pub fn edge_references(
    spec: &AlbedoSpec,
    tables: &[Table],
    stage: &Stage,
) -> Result<Vec<Reference>, AlbedoError> {
    let mut middles = middles(spec);
    if is_bound(spec) {
        middles = likely(spec, tables, middles)?;
    }
    let points = [edges(spec), smooth(spec), middles, crease(spec)].concat();
    stage.split(points.len());
    references(spec, points, true, stage)
}

/// Whether errors are upper bounds, which include what the model's values may be off: those of
/// tilted lobes take long, and their tables err by far more.
pub(crate) fn is_bound(spec: &AlbedoSpec) -> bool {
    spec.lobe.form() == LobeForm::Ellipsoid
}

/// The model's values, and those of the isotropic stand-in if asked for.
fn references(
    spec: &AlbedoSpec,
    points: Vec<Point>,
    with_stand_in: bool,
    stage: &Stage,
) -> Result<Vec<Reference>, AlbedoError> {
    let integrand = Integrand::new(&spec.reflectance)?;
    let finest = if spec.reflectance.indices().is_some() { FINEST_OF_KINKS } else { 0.0 };
    let finer = if is_bound(spec) { AS_FINE } else { FINER };
    let tolerance = (finer * spec.tolerance).max(finest);
    let gammas = points.iter().map(|point| point.site.gamma);
    // A round lobe of the family stands in for lobes of the family that are not round.
    let has_stand_in = with_stand_in
        && !matches!(spec.reflectance, Reflectance::Conductor { .. })
        && matches!(spec.lobe.form(), LobeForm::StudentT | LobeForm::Ellipsoid);
    let round = {
        let (sigma, gamma) = (spec.lobe.round_sigma(), spec.lobe.gamma.min);
        Site { sigma, gamma, ..Site::new(&[], &[]) }
    };
    let stand_ins = has_stand_in.then_some(round.gamma);
    let round_lobe = spec.lobe.round();
    let prepared = |models: &Models<'_>, stand_ins: &Models<'_>| {
        let one = |point: &Point| {
            let site = &point.site;
            let model = models.at(site);
            let v = site.view();
            let phi = if v.z < 1.0 { libm::atan2(v.y.into(), v.x.into()) } else { site.phi };
            let site = Site { cos: v.z.into(), phi, ..*site };
            let exact = integrand.at(model, &site)?;
            let stand_in = || {
                let site = Site { cos: site.cos, eta: site.eta, ..round };
                integrand.at(stand_ins.at(&site), &site)
            };
            let round = has_stand_in.then(stand_in).transpose()?;
            let off = |round: Albedo<CHANNELS>| {
                Masking::ALL.map(|form| {
                    let [round, exact] = [&round, &exact].map(|albedo| albedo.of(form));
                    let off = [0, 1].map(|i| round[i] - exact[i]);
                    match spec.reflectance {
                        // E = scale + bias.
                        Reflectance::Mirror => (off[0] + off[1]).abs(),
                        _ => off[0].abs().max(off[1].abs()),
                    }
                })
            };
            stage.step();
            let mut point = point.clone();
            point.site = site;
            Ok(Reference { point, v, exact, shortcut: round.map(off) })
        };
        points.par_iter().map(one).collect()
    };
    Models::with(&spec.lobe, gammas, tolerance, |models| {
        Models::with(&round_lobe, stand_ins, tolerance, |stand_ins| prepared(models, stand_ins))
    })
}

/// The tables with their certificates: errors of every quantity, inside the promised domain and
/// outside, and the error of the isotropic stand-in. The quadrature error of the bake is kept.
///
/// # Errors
/// [`AlbedoError`] if a table does not cover its own domain.
pub fn certified(
    spec: &AlbedoSpec,
    tables: Vec<Table>,
    references: &[Reference],
    stage: &Stage,
) -> Result<Vec<Table>, AlbedoError> {
    let directional: Vec<Table> =
        tables.iter().filter(|table| table.kind == Kind::Albedo).cloned().collect();
    let of_form = |table: &Table| {
        let same = |other: &&Table| other.subject.masking == table.subject.masking;
        directional.iter().find(same).ok_or_else(|| {
            AlbedoError::Lobe(format!("table `{}` has no directional albedo", table.name))
        })
    };
    stage.split(directional.len() * climbed_count(spec));
    let certified = |table: Table| {
        let found = match table.kind {
            Kind::Albedo => directional_certificate(spec, &table, references, stage)?,
            _ => averages(spec, &table, of_form(&table)?)?,
        };
        let certificate =
            Certificate { quadrature: table.certificate.quadrature.map(round_up), ..found };
        Ok(table.with_certificate(certificate))
    };
    tables.into_iter().map(certified).collect()
}

fn directional_certificate(
    spec: &AlbedoSpec,
    table: &Table,
    references: &[Reference],
    stage: &Stage,
) -> Result<Certificate, AlbedoError> {
    let masking = table.subject.masking.unwrap_or_default();
    let reader = Reader::new(spec, table, references.first())?;
    let errors = measured_at(references, |at| reader.errors(at))?;
    let measured = |points: Vec<Point>| {
        let references = self::references(spec, points, true, stage)?;
        Ok(measured_at(&references, |at| reader.errors(at))?)
    };
    let mut found = climbed(spec, &errors, true, measured)?;
    found.extend(climbed(spec, &errors, false, measured)?);
    let form = Masking::ALL.iter().position(|form| *form == masking).unwrap_or(0);
    let shortcuts = references.iter().filter(|at| at.point.promised).filter_map(|at| at.shortcut);
    let stand_in = shortcuts.map(|forms| forms[form]).reduce(f64::max).map(round_up);
    Ok(Certificate { stand_in, ..summary(spec, &errors, &found) })
}

/// Reads one table of directional albedos.
struct Reader<'a> {
    spec: &'a AlbedoSpec,
    table: &'a Table,
    /// The reading of a table of a single lobe, which serves all points.
    own: Option<Reading>,
}

impl<'a> Reader<'a> {
    fn new(
        spec: &'a AlbedoSpec,
        table: &'a Table,
        first: Option<&Reference>,
    ) -> Result<Self, MaterialError> {
        let first = first.filter(|_| !spec.lobe.is_family());
        let own = first.map(|at| Reading::from_table(table, at.point.site)).transpose()?;
        Ok(Self { spec, table, own })
    }

    fn errors(
        &self,
        Reference { point, v, exact, .. }: &Reference,
    ) -> Result<Vec<f64>, MaterialError> {
        let got = match &self.own {
            Some(own) => own.at(*v),
            None => read(self.table, point.site, *v)?,
        };
        let unsure = if is_bound(self.spec) { exact.error } else { 0.0 };
        let exact = exact.of(self.table.subject.masking.unwrap_or_default());
        let exact = match self.spec.reflectance {
            Reflectance::Mirror => [&exact[..], &[exact[0] + exact[1]]].concat(),
            _ => exact.to_vec(),
        };
        Ok(got.iter().zip(&exact).map(|(got, exact)| (got - exact).abs() + unsure).collect())
    }
}

/// Whether the certificate of any directional table will state an error above `limit`, because one
/// of these references finds it.
///
/// # Errors
/// [`AlbedoError`] if a table does not cover its own domain.
pub fn exceeds(
    spec: &AlbedoSpec,
    tables: &[Table],
    references: &[Reference],
    limit: f64,
) -> Result<bool, AlbedoError> {
    let promised: Vec<Reference> =
        references.iter().filter(|at| at.point.promised).cloned().collect();
    for table in tables.iter().filter(|table| table.kind == Kind::Albedo) {
        let reader = Reader::new(spec, table, promised.first())?;
        let errors = measured_at(&promised, |at| reader.errors(at))?;
        if errors.iter().any(|(_, errors)| largest(errors) > limit) {
            return Ok(true);
        }
    }
    Ok(false)
}

/// The largest error of any quantity of one table at each of some points; each point is one step of
/// the stage.
pub fn errors_at(
    spec: &AlbedoSpec,
    table: &Table,
    points: Vec<Point>,
    stage: &Stage,
) -> Result<Vec<f64>, AlbedoError> {
    let references = references(spec, points, false, stage)?;
    let reader = Reader::new(spec, table, references.first())?;
    let errors = measured_at(&references, |at| reader.errors(at))?;
    Ok(errors.iter().map(|(_, errors)| largest(errors)).collect())
}

/// The largest error of any quantity of averages at a site, against the directional table from
/// which they were integrated; `set` holds only the averages.
pub fn average_error(set: &Tables, directional: &Table, site: &Site) -> Result<f64, MaterialError> {
    Ok(largest(&average_errors(set, directional, site)?))
}

/// The largest of some errors; NaN counts as the largest.
fn largest(errors: &[f64]) -> f64 {
    errors.iter().copied().max_by(f64::total_cmp).unwrap_or(0.0)
}

fn average_errors(
    set: &Tables,
    directional: &Table,
    &Site { sigma, gamma, .. }: &Site,
) -> Result<Vec<f64>, MaterialError> {
    let masking = directional.subject.masking.unwrap_or_default();
    let got = all(set.average_moments(sigma, gamma, masking)?);
    let exact = all(TabulatedAlbedo::from_table(directional, sigma, gamma)?.average_moments());
    Ok(got.iter().zip(exact).map(|(got, exact)| (got - exact).abs()).collect())
}

/// The largest number of points that climbs measure for the certificate of one directional table.
pub(crate) fn climbed_count(spec: &AlbedoSpec) -> usize {
    climb::count(spec, quantities(spec).len())
}

fn measured_at(
    references: &[Reference],
    measured: impl Fn(&Reference) -> Result<Vec<f64>, MaterialError> + Send + Sync,
) -> Result<Vec<At>, MaterialError> {
    let one = |at: &Reference| measured(at).map(|errors| (at.point.clone(), errors));
    references.par_iter().map(one).collect()
}

/// The quantities that a lookup gives, in the order of their errors.
fn quantities(spec: &AlbedoSpec) -> Vec<Quantity> {
    let channels = match spec.reflectance {
        Reflectance::Mirror => &["scale", "bias", "f82", "e"],
        _ => spec.reflectance.channels(),
    };
    // Without an entry the errors of the next quantities would get wrong names.
    let of = |name: &&str| Quantity::named(name).expect("every channel is a quantity");
    channels.iter().map(of).collect()
}

/// Largest and root-mean-square errors of each quantity, and the point of the largest of all; the
/// means leave out points on a crease, and those `found` by climbs.
fn summary(spec: &AlbedoSpec, errors: &[At], found: &[At]) -> Certificate {
    // The values of one material take hardly more bytes than all figures would.
    let is_range = spec.nodes_of_materials() > 1;
    let is_promised = |errors: &&At| errors.0.promised;
    let (mut inside, mut outside): (Vec<_>, Vec<_>) = errors.iter().partition(is_promised);
    let rms = |i: usize| {
        let spread = errors.iter().filter(|at| is_promised(at) && !at.0.on_crease);
        let squares: f64 = spread.clone().map(|errors| errors.1[i] * errors.1[i]).sum();
        round_up((squares / spread.count().max(1) as f64).sqrt())
    };
    inside.extend(found.iter().filter(is_promised));
    outside.extend(found.iter().filter(|errors| !is_promised(errors)));
    // `total_cmp` takes NaN for the largest error.
    let largest = |part: &[&At], i: usize| {
        part.iter().map(|errors| errors.1[i]).max_by(f64::total_cmp).map(round_up)
    };
    let of_quantity = |(i, quantity)| {
        let all = Errors {
            largest: largest(&inside, i)?,
            rms: Some(rms(i)),
            outside: largest(&outside, i),
        };
        Some((quantity, if is_range { all } else { Errors { rms: None, outside: None, ..all } }))
    };
    let by_quantity = quantities(spec).into_iter().enumerate().filter_map(of_quantity).collect();
    let worst = |errors: &At| errors.1.iter().copied().max_by(f64::total_cmp);
    let place =
        inside.iter().max_by(|a, b| worst(a).unwrap_or(0.0).total_cmp(&worst(b).unwrap_or(0.0)));
    let at = place.map(|(Point { site: Site { gamma, sigma, eta, phi, cos }, .. }, _)| {
        // A coordinate along an axis of a single node is the same at every point.
        let axis = |name: &str| spec.axes.iter().any(|axis| axis.name == name && axis.len() > 1);
        let all = [
            ("gamma", Coordinate::S, s_of_gamma(*gamma)),
            ("sigma", Coordinate::Sigma, *sigma),
            ("eta", Coordinate::Eta, *eta),
            ("azimuth", Coordinate::Phi, *phi),
            ("view", Coordinate::Cosine, *cos),
        ];
        let there = all.into_iter().filter(|(name, _, x)| axis(name) && x.is_finite());
        there.map(|(_, coordinate, x)| (coordinate, x)).collect()
    });
    Certificate {
        errors: by_quantity,
        at: at.filter(|_| is_range).unwrap_or_default(),
        points: Some((errors.len() + found.len()) as u32),
        ..Certificate::default()
    }
}

/// Errors of averages against quadrature of the tabulated directional albedo of the same material.
fn averages(
    spec: &AlbedoSpec,
    table: &Table,
    directional: &Table,
) -> Result<Certificate, AlbedoError> {
    let set = Tables::from_tables(Default::default(), vec![table.clone()])?;
    let one =
        |point: Point| average_errors(&set, directional, &point.site).map(|errors| (point, errors));
    let errors =
        of_averages(spec).into_par_iter().map(one).collect::<Result<Vec<At>, MaterialError>>()?;
    let mut certificate = summary(spec, &errors, &[]);
    certificate.at.remove(&Coordinate::Cosine);
    Ok(certificate)
}

fn all(moments: Moments) -> [f64; 4] {
    [moments.scale, moments.bias, moments.f82, moments.total()].map(f64::from)
}

/// The tabulated values of one material, as a renderer reads them.
enum Reading {
    Moments(TabulatedAlbedo),
    Shares(ViewCurve<CHANNELS>),
}

impl Reading {
    fn from_table(
        table: &Table,
        Site { sigma, gamma, eta, .. }: Site,
    ) -> Result<Self, MaterialError> {
        Ok(match table.subject.reflectance {
            Some(Reflectance::Mirror) => {
                Self::Moments(TabulatedAlbedo::from_table(table, sigma, gamma)?)
            }
            _ => Self::Shares(ViewCurve::from_table(table, sigma, gamma, eta)?),
        })
    }

    fn at(&self, v: Vec3) -> Vec<f64> {
        match self {
            Self::Moments(albedo) => all(albedo.moments(v)).into(),
            Self::Shares(curve) => curve.eval(v).map(f64::from).into(),
        }
    }
}

/// What a table of the family gives at one view.
fn read(table: &Table, site: Site, v: Vec3) -> Result<Vec<f64>, MaterialError> {
    Ok(match table.subject.reflectance {
        Some(Reflectance::Mirror) => {
            let moments = TabulatedAlbedo::moments_of_table(table, site.sigma, site.gamma, v)?;
            all(moments).into()
        }
        _ => Reading::from_table(table, site)?.at(v),
    })
}

/// The error of a single lobe's table if every other node along an axis is left out: the axis with
/// the largest error is the coarsest.
///
/// # Errors
/// [`MaterialError`] if the table is invalid.
pub fn missed_by_half(spec: &AlbedoSpec, table: &Table, axis: usize) -> Result<f64, MaterialError> {
    let missed = missed(table, axis, &Site::all(&spec.axes))?;
    Ok(missed.iter().map(|errors| largest(errors)).fold(0.0, f64::max))
}

/// How much of each quantity a single lobe's table misses at some sites if every other node along
/// an axis is left out.
fn missed(table: &Table, axis: usize, sites: &[Site]) -> Result<Vec<Vec<f64>>, MaterialError> {
    let Some(first) = sites.first() else { return Ok(Vec::new()) };
    let half = half(table, axis);
    let [whole, half] = [Reading::from_table(table, *first)?, Reading::from_table(&half, *first)?];
    let missed = |site: &Site| {
        let (a, b) = (whole.at(site.view()), half.at(site.view()));
        a.iter().zip(b).map(|(a, b)| (a - b).abs()).collect()
    };
    Ok(sites.par_iter().map(missed).collect())
}

/// Of the middles of cells, one in this number is measured for each quantity and axis. With twice
/// as many the lobes of `tables/recipes/tilted-lobes.toml` are certified the same errors.
const ONE_IN: usize = 16;

/// Of some points, those at which a table of a single lobe with half of the nodes along an axis
/// misses most of a quantity: where it errs most, the whole table does.
fn likely(
    spec: &AlbedoSpec,
    tables: &[Table],
    points: Vec<Point>,
) -> Result<Vec<Point>, MaterialError> {
    let sites: Vec<Site> = points.iter().map(|point| point.site).collect();
    let mut is_likely = vec![false; points.len()];
    for table in tables.iter().filter(|table| table.kind == Kind::Albedo) {
        for axis in spec.refinable() {
            let missed = missed(table, axis, &sites)?;
            let of_quantity = |i: usize| {
                let mut order: Vec<usize> = (0..points.len()).collect();
                order.sort_by(|&a, &b| missed[b][i].total_cmp(&missed[a][i]));
                order.truncate(points.len() / ONE_IN);
                order
            };
            for at in (0..quantities(spec).len()).flat_map(of_quantity) {
                is_likely[at] = true;
            }
        }
    }
    Ok(points.into_iter().zip(is_likely).filter(|at| at.1).map(|at| at.0).collect())
}

/// A table with every other node along an axis.
fn half(table: &Table, axis: usize) -> Table {
    let mut thin = table.clone();
    thin.axes[axis].nodes = table.axes[axis].nodes.iter().copied().step_by(2).collect();
    let faster: usize = table.axes[axis + 1..].iter().map(Axis::len).product();
    let kept = |i: &usize| (i / faster % table.axes[axis].len()).is_multiple_of(2);
    let nodes =
        table.values.chunks_exact(table.channels.len()).enumerate().filter(|(i, _)| kept(i));
    thin.values = nodes.flat_map(|(_, node)| node.iter().copied()).collect();
    thin
}
