//! A survey of all scenes in a folder: what would be planned for each, and what was not read.

use std::collections::{BTreeMap, HashSet};
use std::path::{Path, PathBuf};

use rayon::prelude::*;
use walkdir::WalkDir;

use microfacet_baker::library::Library;
use microfacet_baker::plan::{Options, Verdict};
use microfacet_baker::progress::Meter;
use microfacet_baker::scene::{Format, Ignored, Scene, SceneErrorKind};
use microfacet_baker::table_set::{Need, Target};

/// The files of a folder, and of all folders in it, whose names end as those of scenes do.
#[derive(Clone, Debug, Default)]
pub struct Survey {
    /// The files, sorted by their path.
    pub files: Vec<File>,
    /// What all planned scenes need, each thing once, with its [`Need::id`].
    pub needs: BTreeMap<String, Need>,
    /// What albedos that were not asked for would add ([`Library::offered`]).
    pub offered: BTreeMap<String, Need>,
}

/// One file of a [`Survey`].
#[derive(Clone, Debug)]
pub struct File {
    /// The path of the file.
    pub path: PathBuf,
    /// What became of it.
    pub outcome: Outcome,
}

/// What became of a file.
#[derive(Clone, Debug)]
pub enum Outcome {
    /// It was read and planned.
    Planned(Planned),
    /// It is a part of another scene, which includes it.
    Part,
    /// It is another kind of document than a scene, and why.
    Foreign(String),
    /// It was refused, and why.
    Refused(String),
}

/// A scene that was planned.
#[derive(Clone, Debug, Default)]
pub struct Planned {
    /// How many of its lobes have each of the verdicts, by [`group`].
    pub lobes: BTreeMap<&'static str, usize>,
    /// Materials for which there is nothing to bake.
    pub without_lobe: usize,
    /// Materials that were not understood.
    pub not_understood: Vec<Ignored>,
    /// Lobes and albedos that nothing covers: name, reason.
    pub not_covered: Vec<[String; 2]>,
    /// Warnings on what was assumed.
    pub warnings: Vec<String>,
    /// The [`Need::id`]s of what it needs.
    pub needs: Vec<String>,
    /// The [`Need::id`]s of albedos that were not asked for.
    pub offered: Vec<String>,
}

/// The verdicts that a survey tells apart: what has tables, what needs none, and what gets none.
#[must_use]
pub fn group(verdict: &Verdict) -> &'static str {
    match verdict {
        Verdict::Bake(_) | Verdict::Same { .. } | Verdict::Within { .. } | Verdict::Own => "tables",
        Verdict::ClosedForm => "closed form",
        Verdict::Embedded => "embedded",
        Verdict::NotRough => "smooth",
        Verdict::NotUsed => "not used",
        Verdict::NotCovered(_) => "not covered",
    }
}

/// What reading a file gave besides its outcome.
#[derive(Default)]
struct Read {
    needs: Vec<(String, Need)>,
    /// Needs of albedos that were not asked for.
    offered: Vec<(String, Need)>,
    included: Vec<PathBuf>,
}

impl Survey {
    /// Reads and plans all scenes below `folder`. Links and hidden files are skipped.
    ///
    /// With [`Options::strict`] a scene with any [doubt](Scene::doubts) is refused.
    pub fn new(
        folder: &Path,
        (per_set, options): (usize, Options),
        target: Target,
        meter: &Meter,
    ) -> Self {
        let mut paths: Vec<PathBuf> = Vec::new();
        let mut unread: Vec<File> = Vec::new();
        let hidden = |name: &std::ffi::OsStr| name.as_encoded_bytes().starts_with(b".");
        let all = WalkDir::new(folder).sort_by_file_name().into_iter();
        // The folder itself may be named "." or "..".
        for entry in all.filter_entry(|entry| entry.depth() == 0 || !hidden(entry.file_name())) {
            match entry {
                Ok(entry) if entry.file_type().is_file() => paths.push(entry.into_path()),
                Ok(_) => {}
                Err(why) => unread.push(File {
                    path: why.path().unwrap_or(folder).to_owned(),
                    outcome: Outcome::Refused(why.to_string()),
                }),
            }
        }
        paths.retain(|path| Format::of(path).is_some());
        meter.expect(paths.len() as f64);
        let stage = meter.stage(paths.len() as f64);
        stage.split(paths.len());
        let read = paths.into_par_iter().map(|path| {
            let (outcome, read) = read(&path, per_set, options, target);
            stage.step();
            (File { path, outcome }, read)
        });
        let mut read: Vec<(File, Read)> = read.collect();
        read.extend(unread.into_iter().map(|file| (file, Read::default())));
        let included: HashSet<PathBuf> =
            read.iter().flat_map(|(_, read)| read.included.iter().cloned()).collect();
        let mut survey = Self::default();
        for (mut file, Read { needs, offered, .. }) in read {
            if file.path.canonicalize().is_ok_and(|path| included.contains(&path)) {
                file.outcome = Outcome::Part;
            } else {
                survey.needs.extend(needs);
                survey.offered.extend(offered);
            }
            survey.files.push(file);
        }
        // An albedo that one scene did not ask for may be needed by another.
        let Self { needs, offered, .. } = &mut survey;
        offered.retain(|id, _| !needs.contains_key(id));
        survey
    }

    /// The scenes that were planned, with their files.
    pub fn planned(&self) -> impl Iterator<Item = (&Path, &Planned)> {
        self.files.iter().filter_map(|file| match &file.outcome {
            Outcome::Planned(planned) => Some((file.path.as_path(), planned)),
            _ => None,
        })
    }
}

fn read(path: &Path, per_set: usize, options: Options, target: Target) -> (Outcome, Read) {
    let mut read = Read::default();
    let outcome = match crate::load(path) {
        Ok(scene) => {
            read.included = scene.included.clone();
            let planned = planned(scene, per_set, options, target, &mut read);
            planned.map_or_else(Outcome::Refused, Outcome::Planned)
        }
        Err(error) => match error.kind {
            SceneErrorKind::Foreign(_) => Outcome::Foreign(error.to_string()),
            _ => Outcome::Refused(error.to_string()),
        },
    };
    (outcome, read)
}

/// A scene as it is planned, with what it needs in `read`; the error says why it is refused.
fn planned(
    scene: Scene,
    per_set: usize,
    options: Options,
    target: Target,
    read: &mut Read,
) -> Result<Planned, String> {
    if let Some(doubt) = scene.doubts().next().filter(|_| options.strict) {
        return Err(doubt);
    }
    let library = Library::new(scene, per_set, options).map_err(|why| why.to_string())?;
    read.needs = library.needs(target).map_err(|why| why.to_string())?;
    // An error here would concern only albedos that were not asked for.
    read.offered = library.offered(target).unwrap_or_default();
    let ids = |needs: &[(String, Need)]| needs.iter().map(|(id, _)| id.clone()).collect();
    let (needs, offered) = (ids(&read.needs), ids(&read.offered));
    let mut planned = Planned { needs, offered, ..Planned::default() };
    for (scene, plan) in library.plans() {
        planned.warnings.extend(scene.warnings.iter().cloned());
        let (understood, not_understood): (Vec<_>, Vec<_>) =
            scene.ignored.iter().cloned().partition(|material| material.understood);
        planned.without_lobe += understood.len();
        planned.not_understood.extend(not_understood);
        for verdict in &plan.verdicts {
            *planned.lobes.entry(group(verdict)).or_default() += 1;
        }
        for why in plan.not_covered() {
            let name = why.material().unwrap_or_default().to_owned();
            planned.not_covered.push([name, why.reason()]);
        }
    }
    Ok(planned)
}
