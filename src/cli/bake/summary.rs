//! The summary that `bake` prints.

use std::path::Path;

use serde_json::{Value, json};

use microfacet_baker::plan::Verdict;
use microfacet_baker::store::Written;
use microfacet_baker::table_set::Baked;
use microfacet_report::has_page;
use microfacet_sampler::Tables;
use microfacet_tables::{Axis, Kind, Table};
use microfacet_validate::configuration::shapes;
use microfacet_validate::furnace::has_furnace;

use super::files;
use crate::cli::escape;
use crate::cli::plan::Outline;
use crate::cli::words::{columns, count, error, exact_bytes, first, seconds, shell, wrapped};

/// A bake that is done.
pub(super) struct Summary<'a> {
    pub(super) outline: Outline<'a>,
    pub(super) result: &'a Baked,
    pub(super) written: &'a [Written],
    /// The folder, as it was given.
    pub(super) out: &'a Path,
    pub(super) exr: bool,
    /// Images of single tables, which are no set.
    pub(super) split: bool,
    pub(super) seconds: f64,
}

/// Files that are listed; `--json` has them all.
const SHOWN: usize = 6;

impl Summary<'_> {
    pub(super) fn text(&self) -> String {
        let tables = self.result.set.tables();
        let mut text = self.outline.lines(["baked", "skipped"], |_| String::new());
        if tables.is_empty() {
            let image = if self.exr { " and so no image; it is in tables.safetensors" } else { "" };
            let lists = match self.result.set.provenance().materials.len() {
                0 => "no material",
                _ => "the materials in use",
            };
            text += &format!("\nThe set has no tables{image}; it lists {lists}.\n");
        } else {
            text += "\nlargest error of\n";
            text += &largest_errors(tables);
        }
        let wrote = |what: &str, bytes| format!("wrote {what}, {}\n", exact_bytes(bytes));
        let file =
            |file: &Written| wrote(&escape::line(&file.path.display().to_string()), file.bytes);
        let others = |more: &[Written]| {
            let bytes = more.iter().map(|file| file.bytes).sum();
            wrote(&format!("{} more", count(more.len(), "file")), bytes)
        };
        let files = first(self.written, SHOWN, file, others);
        format!("{text}\n{files}{}\nnext:\n{}", self.time(), self.next())
    }

    fn time(&self) -> String {
        let Self { result, .. } = self;
        let (all, baked) = (result.set.tables().len(), result.baked);
        let cached = all - baked;
        let what = match (baked, cached) {
            (0, 0) => "no tables".into(),
            (0, 1) => "the table came from the cache".into(),
            (0, _) => format!("all {all} tables came from the cache"),
            (_, 0) => format!("{} baked", count(all, "table")),
            _ => format!("{} baked, {cached} from the cache", count(baked, "table")),
        };
        let mut text = format!("{what}, in {}", seconds(self.seconds));
        if baked > 0 && self.outline.has_albedos() {
            let [normals, albedo] = result.seconds.map(seconds);
            text += &format!(" (visible normals {normals}, albedo {albedo})");
        }
        text + "\n"
    }

    /// The commands to run next.
    fn next(&self) -> String {
        let set = &self.result.set;
        if let (true, [image, ..]) = (self.split && !set.tables().is_empty(), self.written) {
            return format!("  microfacet-bake inspect {}\n", shell(&image.path));
        }
        let out = shell(self.out);
        let report = match has_page(set) {
            true => format!("  microfacet-bake report {out}\n"),
            false => String::new(),
        };
        let inspect = format!("  microfacet-bake inspect {out}\n{report}");
        if is_testable(set) {
            return format!("  microfacet-bake validate {out}\n{inspect}");
        }
        if !set.tables().is_empty() {
            let why = "validate has no test for such tables; their certificates are there";
            let inspect = format!("  microfacet-bake inspect {out} --details\n{report}");
            return inspect + &wrapped("  ", why, 2);
        }
        let why = if self.outline.has(&Verdict::Embedded) {
            "the default set serves its materials: `microfacet-bake validate` tests that one"
        } else if self.outline.has(&Verdict::ClosedForm) {
            "closed forms have no error to validate; --tabulate-ggx bakes tables instead, for a \
             renderer without them"
        } else if self.outline.is_doubtful() {
            "no material that was read is rough; warnings name what was not read"
        } else {
            "no material in use is rough, so that there is nothing to validate"
        };
        inspect + &wrapped("  ", why, 2)
    }

    pub(super) fn json(&self) -> Value {
        let Self { outline, result, written, seconds, .. } = self;
        let axis = |axis: &Axis| json!({ "name": axis.name, "length": axis.len() });
        let table = |table: &Table| {
            json!({
                "name": table.name, "kind": table.kind.name(), "precision": table.precision,
                "axes": table.axes.iter().map(axis).collect::<Value>(),
                "certificate": table.certificate,
            })
        };
        let [normals, albedo] = result.seconds;
        json!({
            "tables": result.set.tables().iter().map(table).collect::<Value>(),
            "baked": result.baked, "files": files(written), "seconds": seconds,
            "seconds_of": { "visible normals": normals, "albedo": albedo },
            "materials": outline.materials(), "ignored": outline.ignored(),
            "warnings": outline.scene.warnings, "offered": outline.offered(),
        })
    }
}

/// Whether `validate` has something to test: visible normals from tables, or a white furnace.
fn is_testable(set: &Tables) -> bool {
    // A set without tables is tested as GGX alone.
    !set.tables().is_empty() && (!shapes(set).is_empty() || has_furnace(set))
}

/// The largest error of each quantity, with the table that has it.
fn largest_errors(tables: &[Table]) -> String {
    let quantity = |kind: Kind| match kind {
        Kind::Shadowing | Kind::RadialShadowing => "G1",
        Kind::RadialDensity => "D/D(0)",
        kind if kind.is_albedo() => "albedo",
        _ => "CDF of visible normals",
    };
    let mut rows = Vec::new();
    for of in ["G1", "CDF of visible normals", "D/D(0)", "albedo"] {
        let tables = tables.iter().filter(|table| quantity(table.kind) == of);
        // NaN, and an error that was not measured, count as the largest.
        let largest =
            |table: &Table| table.certificate.largest().map_or(f64::NAN, |(_, largest)| largest);
        if let Some(table) = tables.max_by(|a, b| largest(a).total_cmp(&largest(b))) {
            let figure = table
                .certificate
                .largest()
                .map_or("not measured".into(), |(_, largest)| error(largest));
            let place = format!("in {}", escape::line(&table.name));
            rows.push(vec![format!("  {of}"), figure, place]);
        }
    }
    columns(&rows).iter().map(|line| format!("{line}\n")).collect()
}
