//! The plan of a folder: a summary over all scenes in it.

use std::collections::BTreeMap;
use std::path::Path;
use std::time::Instant;

use rayon::current_num_threads;
use serde_json::{Value, json};

use microfacet_bake::progress::Meter;
use microfacet_bake::survey::{Outcome, Planned, Survey};
use microfacet_bake::table_set::Target;

use super::doubts::Reasons;
use super::{Args, Request};
use crate::cli::words::{columns, count, list, seconds, wrapped};
use crate::cli::{Done, Failure, Outcome as Result, escape, print, print_json, progress, report};

/// Files, and reasons, that are listed; `--json` has all.
const SHOWN: usize = 20;

pub(super) fn run(args: &Args) -> Result {
    let start = Instant::now();
    let request: &Request = &args.request;
    let target = Target::Quality(request.quality(), request.precision());
    let meter = Meter::default();
    let bar = progress::show(&meter, "reading scenes");
    let survey = Survey::new(&args.scene, request.planning()?, target, &meter);
    drop(bar);
    if survey.files.is_empty() {
        return Err(Failure(format!(
            "{}: no file in this folder is named as a scene: .toml, .pbrt, .pbrt.gz, .xml, .gltf, \
             .glb, .mtlx",
            args.scene.display()
        )));
    }
    let time = start.elapsed().as_secs_f64();
    if args.json {
        print_json(&json(&survey, time))?;
    } else {
        print(&text(&survey, &args.scene, time))?;
    }
    warn(&survey);
    Ok(Done::Ok)
}

/// Names of what is counted, with how often it was.
type Counts<'a> = BTreeMap<&'a str, usize>;

/// Files by what became of them, in the order in which they are told.
fn outcomes(survey: &Survey) -> [(&'static str, &'static str, usize); 4] {
    let number = |of: fn(&Outcome) -> bool| survey.files.iter().filter(|f| of(&f.outcome)).count();
    [
        ("planned", "", number(|it| matches!(it, Outcome::Planned(_)))),
        ("parts", "of other scenes, which include them", number(|it| matches!(it, Outcome::Part))),
        ("no scenes", "other kinds of documents", number(|it| matches!(it, Outcome::Foreign(_)))),
        ("refused", "", number(|it| matches!(it, Outcome::Refused(_)))),
    ]
}

/// Lobes by the group of their verdict.
fn lobes(survey: &Survey) -> Counts<'_> {
    let mut counts = Counts::new();
    for (_, planned) in survey.planned() {
        planned.lobes.iter().for_each(|(&group, n)| *counts.entry(group).or_default() += n);
    }
    counts
}

/// Materials for which nothing could be done, with the files they are in.
fn lost<'a>(planned: &'a [(String, &'a Planned)]) -> Reasons<'a> {
    let mut all = Reasons::default();
    for (path, Planned { not_understood, not_covered, .. }) in planned {
        for [_, kind, reason] in not_understood {
            all.add(Some(kind), reason, path);
        }
        for [_, reason] in not_covered {
            all.add(Some("not covered"), reason, path);
        }
    }
    all
}

fn total(survey: &Survey, of: impl Fn(&Planned) -> usize) -> usize {
    survey.planned().map(|(_, planned)| of(planned)).sum()
}

/// Seconds that all needs take together on the current threads.
fn work(survey: &Survey) -> f64 {
    let seconds: f64 = survey.needs.values().map(|need| need.seconds()).sum();
    seconds / current_num_threads() as f64
}

fn text(survey: &Survey, folder: &Path, time: f64) -> String {
    let files = count(survey.files.len(), "file");
    let name = folder.display().to_string();
    let mut text = format!("{files} in {}, read in {}\n", escape::line(&name), seconds(time));
    let row = |(what, more, n): &(&str, &str, usize)| {
        vec![format!("  {what}"), n.to_string(), (*more).to_owned()]
    };
    let rows: Vec<_> = outcomes(survey).iter().map(row).collect();
    columns(&rows).iter().for_each(|line| text += &format!("{line}\n"));
    let lobes = lobes(survey);
    text += &format!("{}\n", count(lobes.values().sum(), "lobe"));
    let mut rows: Vec<Vec<String>> =
        lobes.iter().map(|(group, n)| vec![format!("  {group}"), n.to_string()]).collect();
    let without = total(survey, |planned| planned.without_lobe);
    rows.push(vec!["materials without a lobe".into(), without.to_string()]);
    let unknown = total(survey, |planned| planned.not_understood.len());
    rows.push(vec!["materials not understood".into(), unknown.to_string()]);
    let warnings = total(survey, |planned| planned.warnings.len());
    rows.push(vec!["warnings, which --json has".into(), warnings.to_string()]);
    columns(&rows).iter().for_each(|line| text += &format!("{line}\n"));

    let within = |path: &Path| path.strip_prefix(folder).unwrap_or(path).display().to_string();
    let planned: Vec<(String, &Planned)> =
        survey.planned().map(|(path, planned)| (within(path), planned)).collect();
    let lost = lost(&planned);
    let told = lost.by_number().into_iter().map(|(reason, lost)| {
        let first = lost.names.first().copied().unwrap_or_default();
        let n = lost.names.len();
        format!("{n} {}{}; first in {}", line(&lost.kinds()), line(reason), line(first))
    });
    text += &section("not understood, or not covered", told);
    let refused = survey.files.iter().filter_map(|file| match &file.outcome {
        Outcome::Refused(why) => Some(line(why)),
        _ => None,
    });
    text += &section("refused", refused);
    text + &format!(
        "distinct needs of all: {}, about {} on {}\n",
        survey.needs.len(),
        seconds(work(survey)),
        count(current_num_threads(), "thread")
    )
}

fn line(text: &str) -> String {
    escape::line(text).into()
}

/// A heading with the first lines under it; empty if there are none.
fn section(heading: &str, lines: impl Iterator<Item = String>) -> String {
    let lines: Vec<String> = lines.collect();
    let mut text = String::new();
    for (i, line) in lines.iter().take(SHOWN).enumerate() {
        if i == 0 {
            text += &format!("{heading}:\n");
        }
        text += &wrapped("  ", line, 4);
    }
    if let Some(more @ [_, ..]) = lines.get(SHOWN..) {
        text += &format!("  and {} more; --json lists all\n", more.len());
    }
    text
}

fn json(survey: &Survey, time: f64) -> Value {
    let file = |file: &microfacet_bake::survey::File| {
        let path = file.path.display().to_string();
        match &file.outcome {
            Outcome::Planned(planned) => {
                let unknown = planned
                    .not_understood
                    .iter()
                    .map(|[name, kind, why]| json!({ "name": name, "kind": kind, "why": why }));
                let uncovered = planned
                    .not_covered
                    .iter()
                    .map(|[name, why]| json!({ "name": name, "why": why }));
                json!({
                    "path": path, "outcome": "planned", "lobes": planned.lobes,
                    "without_lobe": planned.without_lobe, "not_understood": unknown.collect::<Vec<_>>(),
                    "not_covered": uncovered.collect::<Vec<_>>(), "warnings": planned.warnings,
                    "needs": planned.needs,
                })
            }
            Outcome::Part => json!({ "path": path, "outcome": "part" }),
            Outcome::Foreign(why) => json!({ "path": path, "outcome": "no scene", "why": why }),
            Outcome::Refused(why) => json!({ "path": path, "outcome": "refused", "why": why }),
        }
    };
    let needs = survey.needs.iter().map(|(id, need)| {
        json!({ "id": id, "name": need.name(), "seconds_of_one_thread": need.seconds() })
    });
    let counts: BTreeMap<&str, usize> =
        outcomes(survey).iter().map(|&(what, _, n)| (what, n)).collect();
    json!({
        "files": survey.files.iter().map(file).collect::<Vec<_>>(), "counts": counts,
        "lobes": lobes(survey), "needs": needs.collect::<Vec<_>>(), "seconds": time,
    })
}

/// What is said last.
fn warn(survey: &Survey) {
    let refused = survey.files.iter().filter(|it| matches!(it.outcome, Outcome::Refused(_)));
    let refused: Vec<String> = refused.map(|file| file.path.display().to_string()).collect();
    if !refused.is_empty() {
        let names = list(refused.iter().map(String::as_str));
        report("warning", format!("{} refused: {names}", count_was(refused.len(), "scene")));
    }
    let unknown = total(survey, |planned| planned.not_understood.len());
    if unknown > 0 {
        let many = survey.planned().filter(|(_, it)| !it.not_understood.is_empty()).count();
        let scenes = count(many, "scene");
        let was = count_was(unknown, "material");
        report("warning", format!("{was} not understood, in {scenes}"));
    }
}

/// `1 scene was`, `3 scenes were`.
fn count_was(n: usize, what: &str) -> String {
    format!("{} {}", count(n, what), if n == 1 { "was" } else { "were" })
}
