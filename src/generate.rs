//! The whole bake: needs in, a certified set out; what is finished already is taken from the cache.

use std::collections::BTreeMap;
use std::fmt;
use std::io;

use microfacet_model::classic::Marginal;
use microfacet_sampler::{
    FresnelEntry, Kind, LoadError, MaterialEntry, Precision, Provenance, Table, Tables, encode,
};

use crate::bake::albedo::AlbedoSpec;
use crate::bake::dielectric_albedo::Side;
use crate::bake::fresnel_albedo::Metal;
use crate::bake::{self, NUMERICS};
use crate::budget::{self, Memo, OutOfReach};
use crate::cache::Cache;
use crate::family::Distribution;
use crate::plan::{AlbedoNeed, Need};
use crate::spec::{Quality, TableSpec, general_set};
use crate::validate::certificate::certify;
use crate::validate::radial;
use crate::validate::{albedo, fresnel_albedo};

/// Points measured at each γ for a certificate.
pub(crate) const CERTIFICATE_POINTS: usize = 4000;

/// How good the tables are to be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Target {
    /// Fixed numbers of nodes.
    Quality(Quality, Precision),
    /// The smallest tables with no larger error: of G1, absolute, and of the CDF of slopes.
    MaxError(f64),
    /// The most accurate set in a file of no more bytes.
    MaxBytes(usize),
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
    /// [`Target::MaxBytes`] is too small.
    TooSmall {
        /// What was allowed.
        max_bytes: usize,
        /// What the smallest set takes.
        smallest: usize,
    },
    /// A byte budget with a distribution outside the family, which has no sizes to choose from; its name.
    NoByteBudget(String),
    /// A byte budget with albedo tables, which have no sizes to choose from.
    NoAlbedoBudget,
    /// An albedo that is not sound, or not accurate enough.
    Albedo(bake::albedo::BakeError),
    /// Albedos, or a distribution outside the family, whose tables err by more than [`Target::MaxError`] at every quality; name and error.
    TooCoarse(String, f64),
}

impl From<LoadError> for BakeError {
    fn from(why: LoadError) -> Self {
        Self::Set(why)
    }
}

impl fmt::Display for BakeError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Set(why) => why.fmt(f),
            Self::OutOfReach(why) => why.fmt(f),
            Self::NoByteBudget(name) => write!(
                f,
                "{name} has tables of its own, which no byte budget covers: choose --quality or --max-error, or bake it apart"
            ),
            Self::NoAlbedoBudget => write!(
                f,
                "no byte budget covers albedo tables: choose --quality or --max-error, or leave them out with --no-albedo"
            ),
            Self::Albedo(why) => why.fmt(f),
            Self::TooCoarse(name, error) => {
                write!(f, "the tables of {name} err by {error:.1e} at the highest quality: allow that much")
            }
            Self::TooSmall { max_bytes, smallest } => write!(
                f,
                "no set of these materials fits into {max_bytes} bytes: the smallest, with an error of 0.1, has {smallest}"
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
        Target::MaxBytes(max_bytes) => {
            let size = |tables: &[Table]| encode(&provenance, tables).map_or(usize::MAX, |bytes| bytes.len());
            let key = format!("{needs:?}, {max_bytes} bytes at most, besides {} bytes", size(&[]));
            let found =
                job.kept(&key, || budget::most_accurate(needs, max_bytes, size).map(|(tables, _)| tables));
            found.map_err(|smallest| BakeError::TooSmall { max_bytes, smallest })?
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
    let mut tables = baked.set.tables().to_vec();
    let mut job = Job { cache, baked: baked.baked, cache_error: baked.cache_error };
    for distribution in distributions {
        let label = distribution.label();
        let entry = provenance.materials.iter().find(|entry| entry.distribution == label);
        let entry =
            entry.ok_or_else(|| LoadError::Invalid(format!("no material has the distribution {label}")))?;
        let mut at = |quality, precision| {
            // Its values, too: two measured files may have the same name.
            let key = format!("{distribution:?}, {label}, {quality:?}, {precision:?}");
            job.kept(&key, || radial_tables(distribution, entry, quality, precision))
        };
        let own = match target {
            Target::Quality(quality, precision) => at(quality, precision)?,
            Target::MaxBytes(_) => return Err(BakeError::NoByteBudget(label)),
            Target::MaxError(max_error) => within(max_error, &label, |quality| at(quality, Precision::F32))?,
        };
        tables.extend(own);
        progress();
    }
    Ok(Baked {
        set: Tables::from_tables(provenance, tables)?,
        baked: job.baked,
        cache_error: job.cache_error,
    })
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
    let mut tables = baked.set.tables().to_vec();
    let mut job = Job { cache, baked: baked.baked, cache_error: baked.cache_error };
    for need in needs {
        let mut at = |quality, precision| {
            let spec = need.spec(&AlbedoSpec::general(quality, precision));
            job.kept(&format!("{spec:?}"), || albedo_tables(&spec))
        };
        tables.extend(match target {
            Target::Quality(quality, precision) => at(quality, precision)?,
            Target::MaxBytes(_) => return Err(BakeError::NoAlbedoBudget),
            Target::MaxError(max_error) => {
                within(max_error, "albedo", |quality| at(quality, Precision::F32))?
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

/// The certified albedo tables of a specification.
fn albedo_tables(spec: &AlbedoSpec) -> Result<Vec<Table>, BakeError> {
    if let Some(fresnel) = &spec.fresnel {
        return fresnel_tables(spec, fresnel);
    }
    let mut set =
        Tables::from_tables(Provenance::default(), bake::albedo::bake(spec).map_err(BakeError::Albedo)?)?;
    albedo::certify(&mut set, spec.domain)
        .map_err(|why| BakeError::Set(LoadError::Invalid(why.to_string())))?;
    Ok(set.tables().to_vec())
}

/// The certified tables of an exact reflectance: of a conductor, or of both sides of a dielectric.
fn fresnel_tables(spec: &AlbedoSpec, fresnel: &FresnelEntry) -> Result<Vec<Table>, BakeError> {
    if let Some(metal) = Metal::new(fresnel).map_err(|why| BakeError::Albedo(why.into()))? {
        return refined(spec, fresnel, |spec| bake::fresnel_albedo::bake(spec, fresnel, &metal));
    }
    // Without a difference of indices both sides are one.
    let sides = if fresnel.indices() == Some([1.0; 2]) { &Side::ALL[..1] } else { &Side::ALL };
    let of_side =
        |side: &Side| refined(spec, fresnel, |spec| bake::dielectric_albedo::bake(spec, fresnel, *side));
    Ok(sides.iter().map(of_side).collect::<Result<Vec<_>, _>>()?.concat())
}

/// The certified tables that `bake` makes, with as many view nodes as the quality's error takes: total reflection inside a dielectric sets in within
/// the roughness, which on a smooth surface is narrower than the cells that serve everything else.
fn refined(
    spec: &AlbedoSpec,
    fresnel: &FresnelEntry,
    bake: impl Fn(&AlbedoSpec) -> Result<Vec<Table>, bake::albedo::BakeError>,
) -> Result<Vec<Table>, BakeError> {
    const DOUBLINGS: usize = 2;
    let mut spec = spec.clone();
    for doubling in 0.. {
        let tables = bake(&spec).map_err(BakeError::Albedo)?;
        let certified = |table: Table| {
            fresnel_albedo::certified(table.rounded(spec.precision), spec.domain, fresnel)
                .map_err(|why| BakeError::Set(LoadError::Invalid(why.to_string())))
        };
        let tables = tables.into_iter().map(certified).collect::<Result<Vec<_>, _>>()?;
        let error = tables.iter().map(worst_error).fold(0.0, f64::max);
        // Three hundred times the error of a node is what a quality's tables of moments err by.
        if error <= 300.0 * spec.tolerance || doubling == DOUBLINGS {
            return Ok(tables);
        }
        spec.views = 2 * spec.views - 1;
    }
    unreachable!("the last doubling returns")
}

/// The tables of the lowest quality at which none errs by more than `max_error`.
fn within(
    max_error: f64,
    name: &str,
    mut at: impl FnMut(Quality) -> Result<Vec<Table>, BakeError>,
) -> Result<Vec<Table>, BakeError> {
    let mut smallest = f64::INFINITY;
    for quality in [Quality::Draft, Quality::Default, Quality::High] {
        let tables = at(quality)?;
        let error = tables.iter().map(worst_error).fold(0.0, f64::max);
        if error <= max_error {
            return Ok(tables);
        }
        smallest = smallest.min(error);
    }
    Err(BakeError::TooCoarse(name.into(), smallest))
}

/// The certified tables of one distribution outside the family.
fn radial_tables(
    distribution: &Distribution,
    entry: &MaterialEntry,
    quality: Quality,
    precision: Precision,
) -> Result<Vec<Table>, BakeError> {
    let built = distribution.build().map_err(|why| LoadError::Invalid(why.to_string()))?;
    let marginal = Marginal::new(&*built);
    let mut tables = bake::bake_radial(&marginal, &entry.table_suffix(), quality, precision);
    radial::certify(&mut tables, entry, &marginal)?;
    Ok(tables)
}

/// The largest error that a table's certificate states, of albedos over all moments; ∞ if there is none.
pub fn worst_error(table: &Table) -> f64 {
    let keys = match table.kind {
        Kind::Albedo | Kind::AlbedoAverage | Kind::FresnelAlbedo | Kind::DielectricAlbedo => {
            &["e_max_error", "scale_max_error", "bias_max_error", "f82_max_error"][..]
        }
        _ => &["g1_max_error", "cdf_max_error", "d_max_error"],
    };
    let figures = keys.iter().filter_map(|key| table.certificate.get(*key).copied());
    figures.reduce(f64::max).unwrap_or(f64::INFINITY)
}

struct Job<'a> {
    cache: &'a Cache,
    baked: usize,
    cache_error: Option<io::Error>,
}

impl Job<'_> {
    /// The tables under a key, or else new ones, which are then kept.
    fn kept<E>(&mut self, key: &str, make: impl FnOnce() -> Result<Vec<Table>, E>) -> Result<Vec<Table>, E> {
        if let Some(tables) = self.cache.get(key) {
            return Ok(tables);
        }
        let tables = make()?;
        self.baked += tables.len();
        self.keep(key, &tables);
        Ok(tables)
    }

    fn keep(&mut self, key: &str, tables: &[Table]) {
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
            "E is the share of light that one bounce with F = 1 returns: the integral of G2/G1(v) over visible normals that reflect upwards. Channels: \
             e = E-1; bias and f82, the same integral weighted with (1-v.m)^5 and 7^7/6^6 v.m (1-v.m)^6, less E times that weight at v.n. The \
             weight 1-(1-v.m)^5 has E less the whole of bias. A sigma below the first node is a mirror",
        ),
        (
            "albedo_average",
            "2 int_0^1 x mu dmu of what is read from the albedo table, less E_avg times that of a mirror for bias and f82",
        ),
        ("fresnel_albedo", "share of light that one bounce off a conductor reflects, by channel"),
        (
            "dielectric_albedo",
            "shares of light that one bounce off a dielectric reflects and transmits, seen from the thin and (_leaving) from the dense side; eta is \
             the index of the dense side over the other's",
        ),
        (
            "albedo_masking",
            "each albedo table names its form of G2: uncorrelated G1(v) G1(l), height-correlated 1/(1+lambda(v)+lambda(l))",
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
        ("shadowing", "value = G1/q, q = z/(z+kappa), z = cot(theta)/sigma"),
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
