//! The whole bake: needs in, a certified set out; what is finished already is taken from the cache.

use std::collections::BTreeMap;
use std::fmt;
use std::io;

use microfacet_model::classic::Marginal;
use microfacet_sampler::{BindError, LoadError, MaterialEntry, Precision, Provenance, Table, Tables};

use crate::bake::albedo::AlbedoSpec;
use crate::bake::{self, NUMERICS};
use crate::budget::{self, Memo, OutOfReach};
use crate::cache::Cache;
use crate::family::Distribution;
use crate::graded::{Choice, Graded};
use crate::plan::{AlbedoNeed, Need};
use crate::spec::{Quality, TableSpec, general_set};
use crate::validate::albedo;
use crate::validate::certificate::certify;
use crate::validate::radial;

/// Points measured at each γ for a certificate.
pub(crate) const CERTIFICATE_POINTS: usize = 4000;

/// How good the tables are to be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Target {
    /// Fixed numbers of nodes.
    Quality(Quality, Precision),
    /// The smallest tables with no larger error: of G1, absolute, of the CDF of slopes, of D/D(0) and of albedos.
    MaxError(f64),
}

/// A set, and what was done for it.
#[derive(Debug)]
pub struct Baked {
    /// The set.
    pub set: Tables,
    /// How many of its tables were baked now; the others come from the cache.
    pub baked: usize,
    /// Why the cache could not keep something.
    pub cache_error: Option<io::Error>,
}

/// Why there is no set.
#[derive(Debug)]
pub enum BakeError {
    /// The tables do not make a set; a fault of the plan.
    Set(LoadError),
    /// [`Target::MaxError`] is too small.
    OutOfReach(OutOfReach),
    /// A byte budget is too small.
    TooSmall {
        /// What was allowed.
        max_bytes: usize,
        /// What the smallest set takes.
        smallest: usize,
    },
    /// An albedo that is not sound, or not accurate enough.
    Albedo(bake::albedo::BakeError),
    /// Albedos, or a distribution outside the family, whose tables err by more than [`Target::MaxError`] at every quality; name and error.
    TooCoarse(String, f64),
}

impl BakeError {
    pub(crate) fn invalid(why: impl Into<String>) -> Self {
        Self::Set(LoadError::Invalid(why.into()))
    }
}

impl From<LoadError> for BakeError {
    fn from(why: LoadError) -> Self {
        Self::Set(why)
    }
}

impl From<BindError> for BakeError {
    fn from(why: BindError) -> Self {
        Self::invalid(why.to_string())
    }
}

impl fmt::Display for BakeError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Set(why) => why.fmt(f),
            Self::OutOfReach(why) => why.fmt(f),
            Self::Albedo(why) => why.fmt(f),
            Self::TooCoarse(name, error) => {
                write!(f, "the tables of {name} err by {error:.1e} at the highest quality: allow that much")
            }
            Self::TooSmall { max_bytes, smallest } => write!(
                f,
                "no set of these materials fits into {max_bytes} bytes: the smallest, of the coarsest tables, has {smallest}"
            ),
        }
    }
}

impl std::error::Error for BakeError {}

/// Bakes the tables of all needs and certifies them, calling `progress` after each table and each certificate.
///
/// Each need that is finished goes into the cache, and so does each table of a range, until its need is finished: a bake that
/// was interrupted goes on where it was.
///
/// # Errors
/// [`BakeError`] for a target that cannot be met.
pub fn generate(
    needs: &[Need],
    target: Target,
    provenance: Provenance,
    cache: &Cache,
    mut progress: impl FnMut(),
) -> Result<Baked, BakeError> {
    let mut job = Job { cache, baked: 0, cache_error: None };
    let tables = match target {
        Target::Quality(quality, precision) => {
            let general = general_set(quality, precision);
            let each = needs.iter().map(|need| job.at(need, &need.specs(&general), &mut progress));
            each.collect::<Result<Vec<_>, _>>()?.concat()
        }
        Target::MaxError(max_error) => {
            let mut memo = Memo::default();
            let each = needs.iter().map(|need| {
                let key = format!("{need:?}, error at most {max_error:?}");
                let tables = job.kept(&key, || budget::smallest(need, max_error, &mut memo));
                progress();
                tables.map_err(BakeError::OutOfReach)
            });
            each.collect::<Result<Vec<_>, _>>()?.concat()
        }
    };
    let set = Tables::from_tables(provenance, tables).map_err(BakeError::Set)?;
    Ok(Baked { set, baked: job.baked, cache_error: job.cache_error })
}

/// Adds the tables of distributions outside the family, four each, to a set whose provenance lists their materials.
///
/// # Errors
/// [`BakeError`] for a target that cannot be met.
pub fn add_distributions(
    baked: Baked,
    distributions: &[Distribution],
    target: Target,
    cache: &Cache,
    mut progress: impl FnMut(),
) -> Result<Baked, BakeError> {
    let provenance = baked.set.provenance().clone();
    let families: Vec<Graded> = distributions
        .iter()
        .map(|distribution| Graded::distribution(distribution, &provenance))
        .collect::<Result<_, _>>()?;
    add(baked, &families, target, provenance.clone(), cache, &mut progress)
}

/// Adds albedo tables to a set, calling `progress` after those of each need.
///
/// # Errors
/// [`BakeError`] for a target that cannot be met, or an albedo that is not sound.
pub fn add_albedos(
    baked: Baked,
    needs: &[AlbedoNeed],
    target: Target,
    cache: &Cache,
    mut progress: impl FnMut(),
) -> Result<Baked, BakeError> {
    let mut provenance = baked.set.provenance().clone();
    if !needs.is_empty() {
        add_albedo_conventions(&mut provenance);
    }
    let families: Vec<Graded> = needs.iter().map(Graded::Albedo).collect();
    add(baked, &families, target, provenance, cache, &mut progress)
}

fn add(
    baked: Baked,
    families: &[Graded],
    target: Target,
    provenance: Provenance,
    cache: &Cache,
    progress: &mut impl FnMut(),
) -> Result<Baked, BakeError> {
    let mut tables = baked.set.tables().to_vec();
    let mut job = Job { cache, baked: baked.baked, cache_error: baked.cache_error };
    for family in families {
        tables.extend(match target {
            Target::Quality(quality, precision) => family.bake(quality, &[precision], &mut job)?.concat(),
            Target::MaxError(max_error) => {
                let mut choice = Choice::new(family);
                let found = choice.smallest(max_error, usize::MAX, &mut job)?;
                found.ok_or_else(|| BakeError::TooCoarse(family.name(), choice.least_error()))?
            }
        });
        progress();
    }
    Ok(Baked {
        set: Tables::from_tables(provenance, tables)?,
        baked: job.baked,
        cache_error: job.cache_error,
    })
}

/// Where views are all there is to refine, twice as many are kept if they err by no more than this share of what half as many do: else the error
/// stands elsewhere, such as on an axis of the material. Six-point polynomials on a smooth curve would come to a sixtieth; of indices near 1
/// (`docs/albedo.md`) 5.94e-3 became 5.89e-3.
const WORTH: f64 = 0.8;

/// The certified albedo tables of a specification in each of some precisions, with as many nodes of the view as the quality's error takes.
pub(crate) fn albedo_tables(
    spec: &AlbedoSpec,
    precisions: &[Precision],
) -> Result<Vec<Vec<Table>>, BakeError> {
    let interior = albedo::interior_references(spec).map_err(BakeError::Albedo)?;
    // Single precision decides, which hardly rounds; it is certified once where it is asked for, too.
    let mut all = vec![Precision::F32];
    all.extend(precisions.iter().filter(|precision| **precision != Precision::F32));
    let asked = |sets: Vec<Vec<Table>>| {
        let of = |precision| all.iter().position(|other| other == precision).map(|i| sets[i].clone());
        precisions.iter().filter_map(of).collect()
    };
    let mut spec = spec.clone();
    let mut coarser: Option<(f64, Vec<Vec<Table>>)> = None;
    for doubling in 0.. {
        let edges = albedo::edge_references(&spec).map_err(BakeError::Albedo)?;
        let references = [&interior[..], &edges].concat();
        let baked = bake::albedo::bake_in(&spec, &all).map_err(BakeError::Albedo)?;
        let certify = |tables| albedo::certified(&spec, tables, &references).map_err(BakeError::Albedo);
        let sets = baked.into_iter().map(certify).collect::<Result<Vec<_>, BakeError>>()?;
        let full = sets[0].clone();
        let error = full.iter().map(worst_error).fold(0.0, f64::max);
        let refinable = spec.refinable();
        match coarser.take() {
            Some((before, coarser)) if refinable.len() == 1 && error > WORTH * before => {
                return Ok(asked(coarser));
            }
            _ if error <= spec.target() || doubling == spec.doublings() => return Ok(asked(sets)),
            _ => coarser = Some((error, sets)),
        }
        let mut coarsest = (0.0, spec.axes.len() - 1);
        for &axis in refinable.iter().filter(|_| refinable.len() > 1) {
            let missed = albedo::missed_by_half(&spec, &full[0], axis)?;
            if missed > coarsest.0 {
                coarsest = (missed, axis);
            }
        }
        spec = spec.refined(coarsest.1);
    }
    unreachable!("the last doubling returns")
}

/// The certified tables of one distribution outside the family, in each of some precisions.
pub(crate) fn radial_tables(
    distribution: &Distribution,
    entry: &MaterialEntry,
    quality: Quality,
    precisions: &[Precision],
) -> Result<Vec<Vec<Table>>, BakeError> {
    let built = distribution.build().map_err(|why| LoadError::Invalid(why.to_string()))?;
    let marginal = Marginal::new(&*built);
    let full = bake::bake_radial(&marginal, &entry.distribution, quality, Precision::F32);
    let certified = |&precision| {
        let mut tables: Vec<Table> = full.iter().map(|table| table.clone().rounded(precision)).collect();
        radial::certify(&mut tables, entry, &marginal)?;
        Ok(tables)
    };
    precisions.iter().map(certified).collect()
}

/// The largest error of any quantity that a table's certificate promises; ∞ if there is none.
pub fn worst_error(table: &Table) -> f64 {
    let promised = |key: &str| key.ends_with("_max_error") && !key.starts_with("shortcut");
    let figures = table.certificate.iter().filter(|(key, _)| promised(key)).map(|(_, figure)| *figure);
    figures.reduce(f64::max).unwrap_or(f64::INFINITY)
}

/// What is being done for a set.
pub(crate) struct Job<'a> {
    pub(crate) cache: &'a Cache,
    pub(crate) baked: usize,
    pub(crate) cache_error: Option<io::Error>,
}

impl Job<'_> {
    /// The tables under a key, or else new ones, which are then kept.
    pub(crate) fn kept<E>(
        &mut self,
        key: &str,
        make: impl FnOnce() -> Result<Vec<Table>, E>,
    ) -> Result<Vec<Table>, E> {
        Ok(self.kept_each(&[key.into()], || Ok(vec![make()?]))?.concat())
    }

    /// The same for several keys whose tables are made together.
    pub(crate) fn kept_each<E>(
        &mut self,
        keys: &[String],
        make: impl FnOnce() -> Result<Vec<Vec<Table>>, E>,
    ) -> Result<Vec<Vec<Table>>, E> {
        if let Some(tables) = keys.iter().map(|key| self.cache.get(key)).collect() {
            return Ok(tables);
        }
        let made = make()?;
        for (key, tables) in keys.iter().zip(&made) {
            self.baked += tables.len();
            self.keep(key, tables);
        }
        Ok(made)
    }

    pub(crate) fn keep(&mut self, key: &str, tables: &[Table]) {
        if let Err(why) = self.cache.put(key, tables) {
            self.cache_error.get_or_insert(why);
        }
    }

    /// The tables of a need with the given specifications.
    fn at(
        &mut self,
        need: &Need,
        specs: &[TableSpec],
        progress: &mut impl FnMut(),
    ) -> Result<Vec<Table>, BakeError> {
        let key = format!("{specs:?}, {CERTIFICATE_POINTS} points at s in {:?}", need.certified_s());
        if let Some(tables) = self.cache.get(&key) {
            (0..=specs.len()).for_each(|_| progress());
            return Ok(tables);
        }
        let mut tables = Vec::new();
        let mut waiting = Vec::new();
        for spec in specs {
            // Kept in full precision, which storing does not change.
            let full = TableSpec { precision: Precision::F32, ..spec.clone() };
            let key = format!("{full:?}");
            let table = self.cache.get(&key).and_then(|mut tables| tables.pop());
            let table = table.unwrap_or_else(|| {
                let table = bake::bake(&full);
                self.baked += 1;
                // A slice is baked again as fast as it is read.
                if !need.gamma().is_point() {
                    self.keep(&key, std::slice::from_ref(&table));
                }
                table
            });
            waiting.push(key);
            tables.push(table.rounded(spec.precision));
            progress();
        }
        let mut set = Tables::from_tables(Provenance::default(), tables).map_err(BakeError::Set)?;
        certify(&mut set, CERTIFICATE_POINTS, need.certified_s())
            .map_err(|why| BakeError::Set(LoadError::Invalid(why.to_string())))?;
        progress();
        self.keep(&key, set.tables());
        waiting.iter().for_each(|key| self.cache.remove(key));
        Ok(set.tables().to_vec())
    }
}

/// Adds what albedo tables mean to the conventions of a set that holds some.
pub fn add_albedo_conventions(provenance: &mut Provenance) {
    let conventions = [
        (
            "albedo",
            "share of light that one bounce returns. Of reflectance `moments` E is that with F = 1, the integral of G2/G1(v) over visible normals \
             that reflect upwards. Channels: e = E-1; bias and f82, the same integral weighted with (1-v.m)^5 and 7^7/6^6 v.m (1-v.m)^6, less E times \
             that weight at v.n. The weight 1-(1-v.m)^5 has E less the whole of bias. A sigma below the first node is a mirror. Other \
             reflectances have the shares themselves; eta is the index of the dense side over the other's",
        ),
        (
            "albedo_average",
            "2 int_0^1 x mu dmu of what is read from the albedo table, less E_avg times that of a mirror for bias and f82",
        ),
        (
            "albedo_masking",
            "each albedo table names its form of G2: uncorrelated G1(v) G1(l), height-correlated 1/(1+lambda(v)+lambda(l))",
        ),
        (
            "albedo_azimuth",
            "of a lobe that is one material, over the azimuth of the view (radians, from the x axis) and the view; sigma in the view's coordinate is \
             the roughness seen from the azimuth. A channel `clamp` c = mu/(mu+A) above 1/2 scales the others' shares, 1+e for e, by (1-c)/c",
        ),
    ];
    provenance.conventions.extend(conventions.map(|(key, value)| (key.into(), value.into())));
}

/// Origin, licence and conventions of a set baked by this version.
pub fn provenance(recipe: String, materials: Vec<MaterialEntry>) -> Provenance {
    let conventions = [
        ("placement", "values sit at the nodes of the axes, not at cell centres"),
        (
            "gamma",
            "Student-t shape gamma > 3/2; the axis coordinate is s = 1/(gamma-1), 0 is Beckmann, 1 is GGX",
        ),
        (
            "sigma",
            "GGX and Beckmann roughness alpha; slopes are divided by sigma, nothing else, before a lookup",
        ),
        ("frame", "tangent space, n = +z; angles in radians; slopes positive towards the viewer"),
        (
            "masking",
            "shadowing tables hold Smith's G1 of one direction; how two are combined is the reader's choice",
        ),
        ("slope_channel", "derivative of `value` with respect to the node index of the last axis"),
        (
            "shadowing",
            "value = G1/q, q = z/(z+kappa) whether or not the axis is crowded, z = cot(theta)/sigma",
        ),
        (
            "visible_slope",
            "value = distance of h = x/(1+sqrt(1+x^2)) from the nearer end: 1+h for u <= 1/2, 1-h above",
        ),
        (
            "visible_slope_peeled",
            "as visible_slope, for the density without its term x sin(theta) p(x), x > 0",
        ),
        ("visible_slope_conditional", "value = 1-h of t = y/sqrt(1+s x^2) for u > 1/2; odd about u = 1/2"),
    ];
    Provenance {
        generator: concat!("microfacet-bake ", env!("CARGO_PKG_VERSION")).into(),
        numerics: NUMERICS,
        license: "CC0-1.0".into(),
        conventions: conventions
            .map(|(key, value)| (key.into(), value.into()))
            .into_iter()
            .collect::<BTreeMap<_, _>>(),
        recipe,
        materials,
    }
}
