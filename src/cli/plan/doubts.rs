//! What is said last: the materials for which nothing could be done.

use std::collections::BTreeMap;

use microfacet_bake::plan::{NotCovered, Plan, Verdict};
use microfacet_bake::scene::Scene;

use crate::cli::report;
use crate::cli::words::{count, joined, list};

/// Reasons that are told; `plan` and `--json` have all.
const SHOWN: usize = 3;

/// Names by the reason.
#[derive(Default)]
struct Reasons<'a>(BTreeMap<String, Vec<&'a str>>);

impl<'a> Reasons<'a> {
    fn add(&mut self, reason: impl Into<String>, name: &'a str) {
        self.0.entry(reason.into()).or_default().push(name);
    }

    /// A sentence of all, if there are any; `what` completes "3 materials ...".
    fn sentence(&self, what: [&str; 2]) -> Option<String> {
        let all: usize = self.0.values().map(Vec::len).sum();
        let [one, many] = what;
        let what = if all == 1 { one } else { many };
        let mut reasons: Vec<(&String, &Vec<&str>)> = self.0.iter().collect();
        reasons.sort_by_key(|(_, names)| usize::MAX - names.len());
        let told = |(why, names): &(&String, &Vec<&str>)| {
            format!("{} ({why})", list(names.iter().copied()))
        };
        let mut told: Vec<String> = reasons.iter().take(SHOWN).map(told).collect();
        if let Some(more @ [_, ..]) = reasons.get(SHOWN..) {
            let names = more.iter().map(|(_, names)| names.len()).sum();
            told.push(format!("{} for other reasons", count(names, "more")));
        }
        (all > 0).then(|| format!("{} {what}: {}", count(all, "material"), joined(&told)))
    }
}

/// Warns of materials that were not understood, and of those that no table covers.
pub(in crate::cli) fn warn<'a>(parts: impl Iterator<Item = (&'a Scene, &'a Plan)>) {
    let (mut unknown, mut uncovered) = (Reasons::default(), Reasons::default());
    for (scene, plan) in parts {
        for ignored in scene.ignored.iter().filter(|ignored| !ignored.understood) {
            unknown.add(format!("{}: {}", ignored.kind, ignored.reason), &ignored.name);
        }
        for (material, verdict) in scene.materials.iter().zip(&plan.verdicts) {
            if let Verdict::NotCovered(why) = verdict {
                uncovered.add(NotCovered::reason(why), &material.name);
            }
        }
    }
    let all = [
        unknown.sentence(["was not understood", "were not understood"]),
        uncovered.sentence(["is not covered", "are not covered"]),
    ];
    all.into_iter().flatten().for_each(|sentence| report("warning", sentence));
}
