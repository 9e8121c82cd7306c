//! Options that `plan` and `bake` share: quality, and what the renderer has already.

use std::path::Path;

use clap::ValueEnum;
use clap::builder::PossibleValue;

use microfacet_baker::library::{Library, PER_SET};
use microfacet_baker::plan::{AlbedoWish, Options, Plan};
use microfacet_baker::scene::Scene;
use microfacet_baker::table_spec::Quality;
use microfacet_sampler::Tables;
use microfacet_tables::{Precision, Table};

use super::Failure;
use super::values::{self, InRecipe};
use super::words::count;

#[derive(clap::Args)]
pub(super) struct Request {
    /// Precision of the stored values.
    #[arg(long, value_enum, default_value = "f32")]
    precision: PrecisionArg,
    /// Quality: how fine the tables are.
    #[arg(long, value_enum, default_value = "default")]
    quality: QualityArg,
    /// Tabulate GGX (gamma = 2) as well, for a renderer without its closed forms.
    #[arg(long, requires = "scene")]
    tabulate_ggx: bool,
    /// Bake directional albedos for every rough material of a scene; by default for those of a
    /// recipe that state `fresnel`, and for other scenes if that takes less than 2 s of one thread.
    #[arg(long, requires = "scene")]
    albedo: bool,
    /// Bake no directional albedos, which take most of the time.
    #[arg(long, conflicts_with = "albedo")]
    no_albedo: bool,
    /// Refuse a scene of which anything was not understood, is missing, is doubtful or cannot be
    /// covered by tables; by default that is left out with a warning.
    #[arg(long, requires = "scene")]
    strict: bool,
    /// Skip what the sampler crate's default set covers (`Tables::or_embedded`).
    #[arg(long, requires = "scene")]
    embedded: bool,
    /// Most materials of one set; a scene with more becomes numbered sets with an index.
    #[arg(long, requires = "scene", value_name = "N", value_parser = values::count::<usize>(1..=PER_SET as u64), default_value_t = PER_SET)]
    per_set: usize,
    #[command(flatten)]
    _others: InRecipe,
}

#[derive(Clone, Copy, ValueEnum)]
enum PrecisionArg {
    /// Single precision.
    F32,
    /// Half precision.
    F16,
    /// Sixteen-bit fixed point.
    U16,
}

#[derive(Clone, Copy, ValueEnum)]
enum QualityArg {
    /// Small, inaccurate tables.
    Draft,
    /// CDF error below 3e-5 (gamma >= 1.8), G1 error below 1e-5.
    Default,
    /// CDF error below 3e-6 (gamma >= 1.8), G1 error below 2e-6; eight times the bytes.
    High,
}

impl Request {
    pub(super) fn quality(&self) -> Quality {
        match self.quality {
            QualityArg::Draft => Quality::Draft,
            QualityArg::Default => Quality::Default,
            QualityArg::High => Quality::High,
        }
    }

    pub(super) fn precision(&self) -> Precision {
        match self.precision {
            PrecisionArg::F32 => Precision::F32,
            PrecisionArg::F16 => Precision::F16,
            PrecisionArg::U16 => Precision::U16,
        }
    }

    /// The options as they were typed, each with a space before it; those by default are left out.
    pub(super) fn repeated(&self) -> String {
        let mut all = String::new();
        let mut add = |option: &str, value: String| all += &format!(" {option}{value}");
        let name = |value: Option<PossibleValue>| {
            value.map_or(String::new(), |value| format!(" {}", value.get_name()))
        };
        if self.quality() != Quality::Default {
            add("--quality", name(self.quality.to_possible_value()));
        }
        if self.precision() != Precision::F32 {
            add("--precision", name(self.precision.to_possible_value()));
        }
        if self.per_set != PER_SET {
            add("--per-set", format!(" {}", self.per_set));
        }
        let flags = [
            (self.tabulate_ggx, "--tabulate-ggx"),
            (self.albedo, "--albedo"),
            (self.no_albedo, "--no-albedo"),
            (self.strict, "--strict"),
            (self.embedded, "--embedded"),
        ];
        for (_, flag) in flags.into_iter().filter(|(is_set, _)| *is_set) {
            add(flag, String::new());
        }
        all
    }

    /// Reads a scene; `--strict` refuses one of which anything is doubtful.
    pub(super) fn scene(&self, path: &Path) -> Result<Scene, Failure> {
        let scene = microfacet_scene::load(path)?;
        let doubts = || scene.doubts();
        if self.strict
            && let Some(first) = doubts().next()
        {
            let more = match doubts().count() - 1 {
                0 => String::new(),
                more => format!("; and {}", count(more, "further doubt")),
            };
            return Err(Failure(format!("{first}{more}. Without --strict the rest is planned")));
        }
        Ok(scene)
    }

    pub(super) fn is_strict(&self) -> bool {
        self.strict
    }

    /// The plan of the general set.
    pub(super) fn general_plan(&self) -> Plan {
        let mut plan = Plan::general();
        if self.no_albedo {
            plan.albedos.clear();
        }
        plan
    }

    /// The scene divided into sets, and their plans; `max_error` is the budget of error, if any.
    pub(super) fn library(&self, scene: Scene, max_error: Option<f64>) -> Result<Library, Failure> {
        Ok(Library::new(scene, self.per_set, self.options(max_error)?)?)
    }

    /// What a survey plans with: materials of a set, and options.
    pub(super) fn planning(&self) -> Result<(usize, Options), Failure> {
        Ok((self.per_set, self.options(None)?))
    }

    fn options(&self, max_error: Option<f64>) -> Result<Options, Failure> {
        let mut embedded_albedo = false;
        if self.embedded {
            let embedded = Tables::embedded();
            let (albedos, others): (Vec<&Table>, Vec<&Table>) =
                embedded.tables().iter().partition(|table| table.kind.is_albedo());
            let worst = |tables: &[&Table]| {
                tables.iter().map(|table| table.certificate.worst()).fold(0.0, f64::max)
            };
            if matches!(self.quality(), Quality::High) {
                return Err(Failure(
                    "--embedded: the set compiled in is of default quality; drop --quality high"
                        .into(),
                ));
            }
            let worst_of_others = worst(&others);
            if max_error.is_some_and(|max| max < worst_of_others) {
                return Err(Failure(format!(
                    "--embedded: the set compiled in has an error of {worst_of_others:.1e}; allow as much"
                )));
            }
            // If its albedos are not accurate enough, better ones are baked.
            embedded_albedo =
                !albedos.is_empty() && max_error.is_none_or(|max| max >= worst(&albedos));
        }
        Ok(Options {
            tabulate_ggx: self.tabulate_ggx,
            embedded: self.embedded,
            embedded_albedo,
            albedo: match (self.albedo, self.no_albedo) {
                (true, _) => AlbedoWish::All,
                (_, true) => AlbedoWish::None,
                _ => AlbedoWish::Auto,
            },
            quality: self.quality(),
            strict: self.strict,
        })
    }
}
