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
    /// What albedos would add to that which were not asked for ([`Library::offered`]).
    pub offered: BTreeMap<String, Need>,
}

/// One file of a [`Survey`].
#[derive(Clone, Debug)]
pub struct File {
    /// Its path.
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

/// A file that was read, before it is known which others include it.
struct Read {
    file: File,
    needs: Needs,
    included: Vec<PathBuf>,
}

/// What a scene needs, and what was not asked for.
#[derive(Default)]
struct Needs {
    all: Vec<(String, Need)>,
    offered: Vec<(String, Need)>,
}

impl Survey {
    /// Reads and plans all scenes below `folder`. Links and hidden files are passed over.
    ///
    /// With [`Options::strict`] a scene with any [doubt](Scene::doubts) is refused.
    pub fn new(
        folder: &Path,
        (per_set, options): (usize, Options),
        target: Target,
        meter: &Meter,
    ) -> Self {
        let mut paths: Vec<PathBuf> = Vec::new();
        let mut unread: Vec<Read> = Vec::new();
        let hidden = |name: &std::ffi::OsStr| name.as_encoded_bytes().starts_with(b".");
        let all = WalkDir::new(folder).sort_by_file_name().into_iter();
        // The folder itself may be named "." or "..".
        for entry in all.filter_entry(|entry| entry.depth() == 0 || !hidden(entry.file_name())) {
            match entry {
                Ok(entry) if entry.file_type().is_file() => paths.push(entry.into_path()),
                Ok(_) => {}
                Err(why) => unread
                    .push(Read::refused(why.path().unwrap_or(folder).to_owned(), why.to_string())),
            }
        }
        paths.retain(|path| Format::of(path).is_some());
        meter.expect(paths.len() as f64);
        let stage = meter.stage(paths.len() as f64);
        stage.split(paths.len());
        let read = paths.into_par_iter().map(|path| {
            let read = Read::new(path, per_set, options, target);
            stage.step();
            read
        });
        let mut read: Vec<Read> = read.collect();
        read.append(&mut unread);
        let included: HashSet<PathBuf> =
            read.iter_mut().flat_map(|read| std::mem::take(&mut read.included)).collect();
        let mut survey = Self::default();
        for Read { mut file, needs, .. } in read {
            if file.path.canonicalize().is_ok_and(|path| included.contains(&path)) {
                file.outcome = Outcome::Part;
            } else {
                survey.needs.extend(needs.all);
                survey.offered.extend(needs.offered);
            }
            survey.files.push(file);
        }
        // Where a scene takes long another may need the same anyway.
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

impl Read {
    fn refused(path: PathBuf, why: String) -> Self {
        let file = File { path, outcome: Outcome::Refused(why) };
        Self { file, needs: Needs::default(), included: Vec::new() }
    }

    fn new(path: PathBuf, per_set: usize, options: Options, target: Target) -> Self {
        let scene = match crate::load(&path) {
            Ok(scene) => scene,
            Err(error) if matches!(error.kind, SceneErrorKind::Foreign(_)) => {
                let outcome = Outcome::Foreign(error.to_string());
                let file = File { path, outcome };
                return Self { file, needs: Needs::default(), included: Vec::new() };
            }
            Err(error) => return Self::refused(path, error.to_string()),
        };
        let included = scene.included.clone();
        if let Some(doubt) = scene.doubts().next().filter(|_| options.strict) {
            return Self { included, ..Self::refused(path, doubt) };
        }
        match Planned::new(scene, per_set, options, target) {
            Ok((planned, needs)) => {
                let file = File { path, outcome: Outcome::Planned(planned) };
                Self { file, needs, included }
            }
            Err(why) => Self { included, ..Self::refused(path, why) },
        }
    }
}

impl Planned {
    /// A scene as it is planned, with what it needs; the error says why it is refused.
    fn new(
        scene: Scene,
        per_set: usize,
        options: Options,
        target: Target,
    ) -> Result<(Self, Needs), String> {
        let library = Library::new(scene, per_set, options).map_err(|why| why.to_string())?;
        let needs = Needs {
            all: library.needs(target).map_err(|why| why.to_string())?,
            // What no table can hold is refused where it is asked for.
            offered: library.offered(target).unwrap_or_default(),
        };
        let ids = |needs: &[(String, Need)]| needs.iter().map(|(id, _)| id.clone()).collect();
        let (all, offered) = (ids(&needs.all), ids(&needs.offered));
        let mut planned = Self { needs: all, offered, ..Self::default() };
        for (scene, plan) in library.plans() {
            planned.warnings.extend(scene.warnings.iter().cloned());
            for material in &scene.ignored {
                if material.understood {
                    planned.without_lobe += 1;
                } else {
                    planned.not_understood.push(material.clone());
                }
            }
            for verdict in &plan.verdicts {
                *planned.lobes.entry(group(verdict)).or_default() += 1;
            }
            for why in plan.not_covered() {
                let name = why.material().unwrap_or_default().to_owned();
                planned.not_covered.push([name, why.reason()]);
            }
        }
        Ok((planned, needs))
    }
}
