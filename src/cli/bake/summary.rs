//! What `bake` says when it is done.

use std::path::Path;

use serde_json::json;

use microfacet_baker::plan::Verdict;
use microfacet_baker::store::Written;
use microfacet_baker::table_set::Baked;
use microfacet_report::has_page;
use microfacet_sampler::Tables;
use microfacet_tables::{Kind, Table};
use microfacet_validate::configuration::shapes;
use microfacet_validate::furnace::has_furnace;

use crate::cli::escape;
use crate::cli::plan::Outline;
use crate::cli::words::{columns, count, error, exact_bytes, seconds, shell, wrapped};

/// A bake that is done.
pub(super) struct Summary<'a> {
    pub(super) outline: Outline<'a>,
    pub(super) result: &'a Baked,
    pub(super) written: &'a [Written],
    /// The folder, as it was given.
    pub(super) out: &'a Path,
    /// An image was asked for.
    pub(super) exr: bool,
    /// Images of single tables were asked for, which are no set.
    pub(super) split: bool,
    pub(super) seconds: f64,
}

/// The two parts that [`Baked::seconds`] are of.
const FAMILIES: [&str; 2] = ["visible normals", "albedo"];

/// [`Baked::seconds`] as JSON.
pub(super) fn families(seconds: [f64; 2]) -> serde_json::Value {
    let named = FAMILIES.iter().zip(seconds);
    named.map(|(&name, seconds)| (name.to_owned(), json!(seconds))).collect()
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
        text += "\n";
        text += &self.files();
        text += &self.time();
        text + "\n" + &self.next()
    }

    fn files(&self) -> String {
        let mut text = String::new();
        for file in self.written.iter().take(SHOWN) {
            let path = file.path.display().to_string();
            text += &format!("wrote {}, {}\n", escape::line(&path), exact_bytes(file.bytes));
        }
        if let Some(more @ [_, ..]) = self.written.get(SHOWN..) {
            let bytes = more.iter().map(|file| file.bytes).sum();
            text += &format!("wrote {} more, {}\n", count(more.len(), "file"), exact_bytes(bytes));
        }
        text
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
        if baked > 0 && !self.outline.albedos().is_empty() {
            let parts = FAMILIES.iter().zip(result.seconds);
            let parts: Vec<String> =
                parts.map(|(name, time)| format!("{name} {}", seconds(time))).collect();
            text += &format!(" ({})", parts.join(", "));
        }
        text + "\n"
    }

    /// The commands that people run next.
    fn next(&self) -> String {
        let set = &self.result.set;
        if let (true, [image, ..]) = (self.split && !set.tables().is_empty(), self.written) {
            return format!("next:\n  microfacet-bake inspect {}\n", shell(&image.path));
        }
        let out = shell(self.out);
        let report = match has_page(set) {
            true => format!("  microfacet-bake report {out}\n"),
            false => String::new(),
        };
        let inspect = format!("  microfacet-bake inspect {out}\n{report}");
        let commands = if is_testable(set) {
            format!("  microfacet-bake validate {out}\n{inspect}")
        } else if set.tables().is_empty() {
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
        } else {
            format!("  microfacet-bake inspect {out} --details\n{report}")
                + &wrapped(
                    "  ",
                    "validate has no test for such tables; their certificates are there",
                    2,
                )
        };
        format!("next:\n{commands}")
    }

    pub(super) fn json(&self) -> serde_json::Value {
        let Self { result, written, seconds, .. } = self;
        let table = |table: &Table| {
            let axes: Vec<_> = table
                .axes
                .iter()
                .map(|axis| json!({ "name": axis.name, "length": axis.len() }))
                .collect();
            json!({
                "name": table.name, "kind": table.kind.name(), "axes": axes, "precision": table.precision,
                "certificate": table.certificate,
            })
        };
        let tables: Vec<_> = result.set.tables().iter().map(table).collect();
        let files: Vec<_> = written
            .iter()
            .map(|file| json!({ "path": file.path.display().to_string(), "bytes": file.bytes }))
            .collect();
        json!({
            "tables": tables, "baked": result.baked, "files": files, "seconds": seconds, "seconds_of": families(result.seconds),
            "materials": self.outline.materials(), "ignored": self.outline.ignored(), "warnings": self.outline.scene.warnings,
            "offered": self.outline.offered(),
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
        // A NaN, and an error that was not measured, are the worst.
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
