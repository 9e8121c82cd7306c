//! Bakes a certified set from a plan and a target.
//!
//! [`bake_with`] splits the plan into table groups, tables that are refined together. With
//! [`Target::Quality`] each group is baked at that quality; for the other targets a search chooses
//! the levels. The tables of a group are baked, certified and cached together.

mod group;
mod job;
mod need;
mod refine;
mod search;

use std::io;

use microfacet_sampler::{Masking, MaterialError, Tables};
use microfacet_tables::{LoadError, Precision, Side, Subject, Table};

use crate::bake;
use crate::cache::Cache;
use crate::memory::{self, TooLarge, Values};
use crate::plan::{Cost, Known, Plan, bare_bytes};
use crate::progress::Meter;
use crate::table_spec::Quality;

use group::TableGroup;
use job::Job;
use search::Search;

pub use need::{Need, NotANeed};
pub use search::smallest_bytes;

/// The accuracy or size that the tables are to have.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Target {
    /// The numbers of nodes of a quality.
    Quality(Quality, Precision),
    /// The smallest tables found with no larger error: absolute, of G1, of the CDF of slopes, of
    /// D/D(0) and of albedos.
    MaxError(f64),
    /// The most accurate tables found whose safetensors file has no more bytes.
    MaxBytes(usize),
}

impl Target {
    /// The quality; the default one where tables are chosen by a budget.
    pub fn quality(&self) -> Quality {
        if let Self::Quality(quality, _) = self { *quality } else { Quality::Default }
    }
}

impl Default for Target {
    fn default() -> Self {
        Self::Quality(Quality::Default, Precision::F32)
    }
}

/// Cache, limits and progress report of a bake.
#[derive(Clone, Debug)]
pub struct Settings {
    /// Where finished tables are cached; by default nowhere.
    pub cache: Cache,
    /// Bytes of memory that the bake may take; a larger bake is refused before any is taken. By
    /// default 4 GiB.
    pub max_memory: u64,
    /// Whether to choose tables even if that takes more than three times as long as a bake at
    /// default quality, and more than [`PATIENCE`] seconds. By default not.
    pub patient: bool,
    /// Counts the work in planned seconds of one thread; the caller can read a clone of it.
    pub progress: Meter,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            cache: Cache::none(),
            max_memory: 4 << 30,
            patient: false,
            progress: Meter::default(),
        }
    }
}

/// Seconds that choosing tables may take even if the bake at default quality is faster.
pub const PATIENCE: f64 = 10.0;

/// A set, and counts of its bake.
#[derive(Debug)]
pub struct Baked {
    /// The set.
    pub set: Tables,
    /// Number of its tables that were baked; the others come from the cache.
    pub baked: usize,
    /// Why the cache could not keep some tables.
    pub cache_error: Option<io::Error>,
    /// Seconds spent on visible normals, and on albedos.
    pub seconds: [f64; 2],
}

/// Why no set could be made.
#[derive(thiserror::Error)]
pub enum BakeError {
    /// The tables do not make a set: a fault of the plan.
    #[error(transparent)]
    Set(#[from] LoadError),
    /// Baking would take too much memory.
    #[error(transparent)]
    Memory(#[from] TooLarge),
    /// [`Target::MaxError`] is not above 0.
    #[error("an error of {0} cannot be asked for: it must be above 0, such as 1e-4")]
    NoError(f64),
    /// [`Target::MaxError`] is too small for some tables.
    #[error(
        "no resolution meets an error of {max_error:e}: {name} reaches {reached:.1e} at best; \
         allow that much"
    )]
    OutOfReach {
        /// The error that was asked for.
        max_error: f64,
        /// The tables that do not meet it.
        name: String,
        /// Their smallest measured error.
        reached: f64,
    },
    /// [`Target::MaxBytes`] is too small.
    #[error(
        "no set of these materials fits into {max_bytes} bytes: the smallest, of the coarsest \
         tables, has {}{smallest}",
        if *planned { "about " } else { "" }
    )]
    TooSmall {
        /// The bytes that were allowed.
        max_bytes: usize,
        /// The bytes of the smallest set.
        smallest: usize,
        /// Whether `smallest` is an estimate, before anything was baked.
        planned: bool,
    },
    /// Choosing the tables would take long, and [`Settings::patient`] is not set.
    #[error(
        "choosing these tables would take about {search:.0} s, the bake of default quality about \
         {default_seconds:.0} s: allow a larger error or fewer bytes, or let it take its time"
    )]
    TooSlow {
        /// Estimated seconds to choose the tables.
        search: f64,
        /// Estimated seconds of a bake at default quality.
        default_seconds: f64,
    },
    /// [`Target::MaxBytes`], which all tables of a plan share, for needs that are baked one by one.
    #[error(
        "the bytes of a set are divided among all of its tables, which so cannot be baked one by \
         one: choose a quality or a largest error instead"
    )]
    Inseparable,
    /// Tables of a need could not be cached.
    #[error("finished tables cannot be kept: {0}")]
    NotKept(io::Error),
    /// An albedo that is invalid, or not accurate enough.
    #[error(transparent)]
    Albedo(#[from] bake::albedo::AlbedoError),
}

impl BakeError {
    fn invalid(why: impl Into<String>) -> Self {
        Self::Set(LoadError::Invalid(why.into()))
    }
}

impl From<MaterialError> for BakeError {
    fn from(why: MaterialError) -> Self {
        Self::invalid(why.to_string())
    }
}

microfacet_core::debug_in_words!(BakeError);

/// The expected costs of a set of this quality: of each of [`Plan::shapes`],
/// [`Plan::distributions`] and [`Plan::albedos`], and last of the description of the set itself.
///
/// # Errors
/// [`BakeError::Albedo`] for an albedo that no table can hold.
pub fn costs(plan: &Plan, quality: Quality, precision: Precision) -> Result<Vec<Cost>, BakeError> {
    let mut known = Known::default();
    let groups = TableGroup::whole(plan)?;
    let parts = groups.iter().map(|group| group.cost(quality.into(), precision, &mut known));
    let bare = Cost { bytes: bare_bytes(&plan.provenance()), seconds: 0.0 };
    parts.chain([Ok(bare)]).collect()
}

/// Bakes and certifies the tables of a plan, in memory, with the default [`Settings`].
///
/// ```
/// use microfacet_baker::plan::{Options, Plan};
/// use microfacet_baker::scene::Scene;
/// use microfacet_baker::table_set::{Target, bake};
/// use microfacet_sampler::MicrofacetDistribution;
///
/// let recipe = "[[material]]\nname = \"glass\"\nsigma = 0.454\ngamma = 3.0\n";
/// let plan = Plan::new(&Scene::from_recipe_str(recipe).unwrap(), Options::default()).unwrap();
/// let tables = bake(&plan, Target::MaxError(1e-3)).unwrap().set;
/// let glass = tables.student_t(0.454, 3.0).unwrap();
/// assert!(glass.g1(glam::Vec3::Z) == 1.0);
/// ```
///
/// # Errors
/// [`BakeError`] for a target that cannot be met, or not within the default time limit.
pub fn bake(plan: &Plan, target: Target) -> Result<Baked, BakeError> {
    bake_with(plan, target, Settings::default())
}

/// Bakes and certifies the tables of a plan with a cache, limits, and a report of the progress.
///
/// Finished table groups go into the cache, and so does each table of a range of shapes until the
/// group is done, so that an interrupted bake resumes where it stopped. The bytes of a set do not
/// depend on the cache or the number of threads.
///
/// # Errors
/// [`BakeError`] for a target that cannot be met within the settings.
pub fn bake_with(plan: &Plan, target: Target, settings: Settings) -> Result<Baked, BakeError> {
    let provenance = plan.provenance();
    let mut job = Job::new(settings);
    let tables: Vec<Table> = match target {
        Target::Quality(quality, precision) => {
            let groups = TableGroup::whole(plan)?;
            let values = groups.iter().map(|group| group.values(quality.into()));
            memory::check(Values::at_once(values), job.max_memory)?;
            job.progress.expect(groups.iter().map(|group| group.work(quality.into(), 1)).sum());
            let mut tables = Vec::new();
            for group in &groups {
                let sets = group.bake(quality.into(), &[precision], &mut job)?;
                tables.extend(sets.into_iter().flatten());
            }
            in_layouts(tables)
        }
        Target::MaxError(max_error) if !(max_error > 0.0) => {
            return Err(BakeError::NoError(max_error));
        }
        Target::MaxError(max_error) => {
            Search::new(TableGroup::apart(plan)?).meeting(max_error, &mut job)?
        }
        Target::MaxBytes(max_bytes) => {
            Search::new(TableGroup::apart(plan)?).within(max_bytes, &provenance, &mut job)?
        }
    };
    let baked = job.baked_of(&tables);
    let set = Tables::from_tables(provenance, tables)?;
    Ok(Baked { set, baked, cache_error: job.cache_error, seconds: job.seconds })
}

/// Tables in the order of a set: albedos of one layout together, so that a file describes them
/// once.
fn in_layouts(mut tables: Vec<Table>) -> Vec<Table> {
    tables.sort_by_cached_key(layout);
    tables
}

/// The common properties of albedos of one layout; `None` for other tables, which so come first, in
/// their order.
fn layout(table: &Table) -> impl Ord + use<> {
    let Subject { masking, reflectance, .. } = &table.subject;
    let masking = Masking::ALL.iter().position(|form| Some(*form) == *masking);
    let side = reflectance.and_then(|of| of.side()).map(Side::name);
    let of = || (table.kind, masking, side, table.channels.clone(), table.shape());
    table.kind.is_albedo().then(of)
}
