//! Options that `plan` and `bake` share: quality, and what the renderer has already.

use std::path::Path;

use microfacet_baker::library::{Library, PER_SET};
use microfacet_baker::plan::{AlbedoWish, Options, Plan};
use microfacet_baker::scene::Scene;
use microfacet_baker::table_spec::Quality;
use microfacet_sampler::Tables;
use microfacet_tables::{Precision, Reflectance, Table};

use super::values::{self, Named, named};
use super::words::count;
use super::{Result, bail, ensure};

const PRECISIONS: [Named<Precision>; 3] = [
    ("f32", "Single precision", Precision::F32),
    ("f16", "Half precision", Precision::F16),
    ("u16", "Sixteen-bit fixed point", Precision::U16),
];

const QUALITIES: [Named<Quality>; 3] = [
    ("draft", "Small, inaccurate tables", Quality::Draft),
    ("default", "CDF error below 3e-5 (gamma >= 1.8), G1 error below 1e-5", Quality::Default),
    (
        "high",
        "CDF error below 3e-6 (gamma >= 1.8), G1 error below 2e-6; eight times the bytes",
        Quality::High,
    ),
];

#[derive(Clone, clap::Args)]
pub(super) struct Request {
    /// Precision of the stored values.
    #[arg(long, value_parser = named(&PRECISIONS), default_value = "f32")]
    precision: Precision,
    /// Quality: how fine the tables are.
    #[arg(long, value_parser = named(&QUALITIES), default_value = "default")]
    quality: Quality,
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
    /// Skip what the sampler crate's default set covers (`Tables::with_fallback`).
    #[arg(long, requires = "scene")]
    embedded: bool,
    /// Most materials of one set; a scene with more becomes numbered sets with an index.
    #[arg(long, requires = "scene", value_name = "N", value_parser = values::count::<usize>(1..=PER_SET as u64), default_value_t = PER_SET)]
    per_set: usize,
}

impl Request {
    pub(super) fn quality(&self) -> Quality {
        self.quality
    }

    pub(super) fn precision(&self) -> Precision {
        self.precision
    }

    /// The options as they were typed, each with a space before it; those by default are left out.
    pub(super) fn repeated(&self) -> String {
        let quality = values::name(&QUALITIES, &self.quality);
        let precision = values::name(&PRECISIONS, &self.precision);
        let all = [
            (self.quality != Quality::Default, format!(" --quality {quality}")),
            (self.precision != Precision::F32, format!(" --precision {precision}")),
            (self.per_set != PER_SET, format!(" --per-set {}", self.per_set)),
            (self.tabulate_ggx, " --tabulate-ggx".into()),
            (self.albedo, " --albedo".into()),
            (self.no_albedo, " --no-albedo".into()),
            (self.strict, " --strict".into()),
            (self.embedded, " --embedded".into()),
        ];
        all.into_iter().filter_map(|(is_set, option)| is_set.then_some(option)).collect()
    }

    /// Reads a scene; `--strict` refuses one of which anything is doubtful.
    pub(super) fn scene(&self, path: &Path) -> Result<Scene> {
        let scene = microfacet_scene::load(path)?;
        if self.strict
            && let mut doubts = scene.doubts()
            && let Some(first) = doubts.next()
        {
            let more = match doubts.count() {
                0 => String::new(),
                more => format!("; and {}", count(more, "further doubt")),
            };
            bail!("{first}{more}. Without --strict the rest is planned");
        }
        Ok(scene)
    }

    pub(super) fn is_strict(&self) -> bool {
        self.strict
    }

    /// The plan of the general set, or of the default set, which has common glass as well.
    pub(super) fn general_plan(&self, with_glass: bool) -> Plan {
        let mut plan = if with_glass { Plan::default_set() } else { Plan::general() };
        if self.no_albedo {
            plan.albedos.clear();
        }
        plan
    }

    /// The scene divided into sets, and their plans; `max_error` is the budget of error, if any.
    pub(super) fn library(&self, scene: Scene, max_error: Option<f64>) -> Result<Library> {
        Ok(Library::new(scene, self.per_set, self.options(max_error)?)?)
    }

    /// What a survey plans with: materials of a set, and options.
    pub(super) fn planning(&self) -> Result<(usize, Options)> {
        Ok((self.per_set, self.options(None)?))
    }

    /// Options that leave tables out, each with the planning options that it gives.
    pub(super) fn without(&self) -> Vec<(&'static str, Options)> {
        let add = |name, change: fn(&mut Self)| {
            let mut request = self.clone();
            change(&mut request);
            Some((name, request.options(None).ok()?))
        };
        let all = [
            (!self.embedded).then(|| add("--embedded", |it| it.embedded = true)),
            (!self.no_albedo && !self.albedo).then(|| add("--no-albedo", |it| it.no_albedo = true)),
        ];
        all.into_iter().flatten().flatten().collect()
    }

    fn options(&self, max_error: Option<f64>) -> Result<Options> {
        Ok(Options {
            tabulate_ggx: self.tabulate_ggx,
            embedded: self.embedded,
            embedded_albedo: self.embedded && self.embedded_serves(max_error)?,
            albedo: match (self.albedo, self.no_albedo) {
                (true, _) => AlbedoWish::All,
                (_, true) => AlbedoWish::None,
                _ => AlbedoWish::Auto,
            },
            quality: self.quality,
            strict: self.strict,
        })
    }

    /// Refuses the embedded set if its normals are not accurate enough, and returns whether its
    /// albedos are; if not, albedos are baked.
    fn embedded_serves(&self, max_error: Option<f64>) -> Result<bool> {
        ensure!(
            self.quality != Quality::High,
            "--embedded: the set compiled in is of default quality; drop --quality high"
        );
        let embedded = Tables::embedded();
        let (albedos, others): (Vec<&Table>, Vec<&Table>) =
            embedded.tables().iter().partition(|table| table.kind.is_albedo());
        // Those of dielectrics are baked for every scene that asks for them.
        let is_mirror = |table: &&&Table| table.subject.reflectance == Some(Reflectance::Mirror);
        let albedos: Vec<&Table> = albedos.iter().filter(is_mirror).copied().collect();
        let worst = |tables: &[&Table]| {
            tables.iter().map(|table| table.certificate.worst()).fold(0.0, f64::max)
        };
        let allows = |error: f64| max_error.is_none_or(|max| max >= error);
        let worst_of_others = worst(&others);
        ensure!(
            allows(worst_of_others),
            "--embedded: the set compiled in has an error of {worst_of_others:.1e}; allow as much"
        );
        Ok(!albedos.is_empty() && allows(worst(&albedos)))
    }
}
