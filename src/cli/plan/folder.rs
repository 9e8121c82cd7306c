//! The plan of a folder: a summary over all scenes in it.

use std::collections::BTreeMap;
use std::fs::read_dir;
use std::path::Path;
use std::time::Instant;

use rayon::current_num_threads;
use serde_json::{Value, json};

use microfacet_baker::progress::Meter;
use microfacet_baker::scene::Ignored;
use microfacet_baker::table_set::{Need, Target};
use microfacet_scene::survey::{File, Outcome, Planned, Survey};

use super::doubts::Reasons;
use super::json::ignored;
use super::{Args, Request};
use crate::cli::words::{columns, count, list, seconds, wrapped};
use crate::cli::{Done, Failure, Outcome as Result, escape, print, print_json, progress, report};

/// Files, and reasons, that are listed; `--json` has all.
const SHOWN: usize = 20;

/// Warnings that are listed: most are of missing files.
const WARNINGS: usize = 5;

pub(super) fn run(args: &Args) -> Result {
    let start = Instant::now();
    let request: &Request = &args.request;
    // The summary names the folders below that could not be read.
    let folder = args.scene.display();
    read_dir(&args.scene)
        .map_err(|why| Failure::msg(format!("{folder}: cannot be read: {why}")))?;
    let target = Target::Quality(request.quality(), request.precision());
    let meter = Meter::default();
    let bar = progress::show(&meter, "reading scenes");
    let survey = Survey::new(&args.scene, request.planning()?, target, &meter);
    drop(bar);
    if survey.files.is_empty() {
        return Err(Failure::msg(format!(
            "{}: no file in this folder is named as a scene: .toml, .pbrt, .pbrt.gz, .xml, .gltf, \
             .glb, .mtlx; hidden files and links are passed over",
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
    let is_refused = |file: &File| matches!(file.outcome, Outcome::Refused(_));
    Ok(Done::judged(!(request.is_strict() && survey.files.iter().any(is_refused))))
}

/// Counts by name.
type Counts<'a> = BTreeMap<&'a str, usize>;

/// Numbers of files by outcome, in the order of the summary.
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
        for Ignored { kind, reason, .. } in not_understood {
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

/// How many needs there are, and how long all take together on the current threads.
fn work(needs: &BTreeMap<String, Need>) -> String {
    if needs.is_empty() {
        return "none".into();
    }
    let time: f64 = needs.values().map(Need::seconds).sum();
    let threads = current_num_threads();
    let time = seconds(time / threads as f64);
    format!("{}, about {time} on {}", needs.len(), count(threads, "thread"))
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
    rows.push(vec!["warnings".into(), warnings.to_string()]);
    columns(&rows).iter().for_each(|line| text += &format!("{line}\n"));

    let within = |path: &Path| path.strip_prefix(folder).unwrap_or(path).display().to_string();
    let planned: Vec<(String, &Planned)> =
        survey.planned().map(|(path, planned)| (within(path), planned)).collect();
    let lost = lost(&planned);
    let told = lost.by_number().into_iter().map(|(reason, lost)| {
        let first = lost.names.first().copied().unwrap_or_default();
        let all = count(lost.names.len(), "material");
        format!("{all} ({}): {}; first in {}", line(&lost.kinds()), line(reason), line(first))
    });
    text += &section("not understood, or not covered", SHOWN, told);
    let warnings = survey.planned().flat_map(|(_, planned)| &planned.warnings);
    text += &section("warnings", WARNINGS, warnings.map(|warning| line(warning)));
    let refused = survey.files.iter().filter_map(|file| match &file.outcome {
        Outcome::Refused(why) => Some(line(why)),
        _ => None,
    });
    text += &section("refused", SHOWN, refused);
    text += &format!("distinct needs of all: {}\n", work(&survey.needs));
    let asking = survey.planned().filter(|(_, planned)| !planned.offered.is_empty()).count();
    if asking > 0 {
        let more = work(&survey.offered);
        let scenes = count(asking, "scene");
        text += &format!("--albedo adds those of {scenes} where albedos take long: {more}\n");
    }
    text
}

fn line(text: &str) -> String {
    escape::line(text).into()
}

/// A heading with the first lines under it; empty if there are none.
fn section(heading: &str, shown: usize, lines: impl Iterator<Item = String>) -> String {
    let lines: Vec<String> = lines.collect();
    let mut text = String::new();
    for (i, line) in lines.iter().take(shown).enumerate() {
        if i == 0 {
            text += &format!("{heading}:\n");
        }
        text += &wrapped("  ", line, 4);
    }
    if let Some(more @ [_, ..]) = lines.get(shown..) {
        text += &format!("  and {} more; --json lists all\n", more.len());
    }
    text
}

fn json(survey: &Survey, time: f64) -> Value {
    let file = |file: &microfacet_scene::survey::File| {
        let path = file.path.display().to_string();
        match &file.outcome {
            Outcome::Planned(planned) => {
                let unknown = planned.not_understood.iter().map(ignored);
                let uncovered = planned
                    .not_covered
                    .iter()
                    .map(|[name, why]| json!({ "name": name, "why": why }));
                json!({
                    "path": path, "outcome": "planned", "lobes": planned.lobes,
                    "without_lobe": planned.without_lobe, "not_understood": unknown.collect::<Vec<_>>(),
                    "not_covered": uncovered.collect::<Vec<_>>(), "warnings": planned.warnings,
                    "needs": planned.needs, "offered": planned.offered,
                })
            }
            Outcome::Part => json!({ "path": path, "outcome": "part" }),
            Outcome::Foreign(why) => json!({ "path": path, "outcome": "no scene", "why": why }),
            Outcome::Refused(why) => json!({ "path": path, "outcome": "refused", "why": why }),
        }
    };
    let needs = |needs: &BTreeMap<String, Need>| -> Value {
        let one = |(id, need): (&String, &Need)| json!({ "id": id, "name": need.name(), "seconds_of_one_thread": need.seconds() });
        needs.iter().map(one).collect()
    };
    let counts: BTreeMap<&str, usize> =
        outcomes(survey).iter().map(|&(what, _, n)| (what, n)).collect();
    json!({
        "files": survey.files.iter().map(file).collect::<Vec<_>>(), "counts": counts,
        "lobes": lobes(survey), "without_lobe": total(survey, |planned| planned.without_lobe),
        "not_understood": total(survey, |planned| planned.not_understood.len()),
        "not_covered": total(survey, |planned| planned.not_covered.len()),
        "warnings": total(survey, |planned| planned.warnings.len()),
        "needs": needs(&survey.needs), "offered": needs(&survey.offered), "seconds": time,
    })
}

/// The final warnings.
fn warn(survey: &Survey) {
    let refused = survey.files.iter().filter(|it| matches!(it.outcome, Outcome::Refused(_)));
    let refused: Vec<String> = refused.map(|file| file.path.display().to_string()).collect();
    if !refused.is_empty() {
        let names = list(refused.iter().map(String::as_str));
        report("warning", format!("{} refused: {names}", count_was(refused.len(), "scene")));
    }
    let tell = |of: fn(&Planned) -> usize, said: fn(usize) -> String| {
        let all = total(survey, of);
        if all > 0 {
            let scenes = survey.planned().filter(|(_, planned)| of(planned) > 0).count();
            report("warning", format!("{}, in {}", said(all), count(scenes, "scene")));
        }
    };
    tell(|it| it.warnings.len(), |n| format!("{} of what was read", count(n, "warning")));
    tell(|it| it.not_covered.len(), |n| format!("{} not covered", count_was(n, "material")));
    tell(|it| it.not_understood.len(), |n| format!("{} not understood", count_was(n, "material")));
}

/// `1 scene was`, `3 scenes were`.
fn count_was(n: usize, what: &str) -> String {
    format!("{} {}", count(n, what), if n == 1 { "was" } else { "were" })
}
