//! Final warnings: what was assumed of a scene, and the materials for which nothing could be done.

use std::collections::BTreeMap;

use microfacet_baker::plan::Plan;
use microfacet_baker::scene::Scene;

use crate::cli::report;
use crate::cli::words::{count, joined, list};

/// Reasons that are listed; `--json` has all.
const SHOWN: usize = 3;

/// Materials for which nothing could be done for one reason.
#[derive(Default)]
pub(super) struct Lost<'a> {
    /// How many there are of each kind, where a kind is the reason.
    kinds: BTreeMap<&'a str, usize>,
    /// Their names, or the files that they are in.
    pub(super) names: Vec<&'a str>,
}

impl Lost<'_> {
    /// `matte 3, uber 1`, or nothing.
    pub(super) fn kinds(&self) -> String {
        let one = |(kind, n): (&&str, &usize)| match n {
            1 => (*kind).to_owned(),
            n => format!("{kind} {n}"),
        };
        let kinds: Vec<String> = self.kinds.iter().map(one).collect();
        kinds.join(", ")
    }
}

/// Lost materials by the reason.
#[derive(Default)]
pub(super) struct Reasons<'a>(BTreeMap<String, Lost<'a>>);

impl<'a> Reasons<'a> {
    pub(super) fn add(&mut self, kind: Option<&'a str>, reason: &str, name: &'a str) {
        let lost = self.0.entry(reason.to_owned()).or_default();
        lost.names.push(name);
        if let Some(kind) = kind {
            *lost.kinds.entry(kind).or_default() += 1;
        }
    }

    /// All, those with most materials first.
    pub(super) fn by_number(&self) -> Vec<(&str, &Lost<'a>)> {
        let mut all: Vec<(&str, &Lost<'a>)> =
            self.0.iter().map(|(reason, lost)| (&reason[..], lost)).collect();
        all.sort_by_key(|(_, lost)| usize::MAX - lost.names.len());
        all
    }

    /// A sentence on all, if there are any: "3 materials", followed by `one` or `many`.
    fn sentence(&self, [one, many]: [&str; 2]) -> Option<String> {
        let reasons = self.by_number();
        let all: usize = reasons.iter().map(|(_, lost)| lost.names.len()).sum();
        let what = if all == 1 { one } else { many };
        let told = |(why, lost): &(&str, &Lost<'_>)| {
            let kinds = lost.kinds();
            let of = if kinds.is_empty() { kinds } else { format!("{kinds}: ") };
            format!("{} ({of}{why})", list(lost.names.iter().copied()))
        };
        let mut told: Vec<String> = reasons.iter().take(SHOWN).map(told).collect();
        if let Some(more @ [_, ..]) = reasons.get(SHOWN..) {
            let names: usize = more.iter().map(|(_, lost)| lost.names.len()).sum();
            told.push(format!("{names} more for other reasons, which --json has"));
        }
        (all > 0).then(|| format!("{} {what}: {}", count(all, "material"), joined(&told)))
    }
}

/// Warns of what was assumed where something is missing or wrong, of materials that were not
/// understood, and of those that no table covers.
pub(in crate::cli) fn warn<'a>(parts: impl Iterator<Item = (&'a Scene, &'a Plan)> + Clone) {
    let warnings = parts.clone().flat_map(|(scene, _)| &scene.warnings);
    warnings.for_each(|warning| report("warning", warning));
    warn_of_lost(parts);
}

/// [`warn()`] after long work that began with the warnings of the scene: these are only counted.
pub(in crate::cli) fn remind<'a>(parts: impl Iterator<Item = (&'a Scene, &'a Plan)> + Clone) {
    let warnings: usize = parts.clone().map(|(scene, _)| scene.warnings.len()).sum();
    if warnings > 0 {
        let came = format!("{} came first", count(warnings, "warning"));
        report("warning", format!("{came}: a part of the scene is assumed, or left out"));
    }
    warn_of_lost(parts);
}

fn warn_of_lost<'a>(parts: impl Iterator<Item = (&'a Scene, &'a Plan)>) {
    let (mut unknown, mut uncovered) = (Reasons::default(), Reasons::default());
    for (scene, plan) in parts {
        for ignored in scene.ignored.iter().filter(|ignored| !ignored.understood) {
            unknown.add(Some(&ignored.kind), &ignored.reason, &ignored.name);
        }
        for why in plan.not_covered() {
            uncovered.add(None, &why.reason(), why.material().unwrap_or_default());
        }
    }
    let all = [
        unknown.sentence(["was not understood", "were not understood"]),
        uncovered.sentence(["is not covered", "are not covered"]),
    ];
    all.into_iter().flatten().for_each(|sentence| report("warning", sentence));
}
