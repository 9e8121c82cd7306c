//! `convert`: replaces one distribution by another.

mod table;

use std::fmt::Write;

use microfacet_baker::distribution::{DistributionKind, Named as Distribution};
use microfacet_fit::convert::{ConvertError, Form, Formula, Replacement, Target, by_formula};

use super::values::{self, Named, named};
use super::{Result, bail, ensure, print, watched, words};

/// How the replacement is chosen.
#[derive(Clone, Copy, PartialEq, Eq)]
enum By {
    HalfAngle,
    Rmse,
    Variation,
    Formula,
}

const WAYS: [Named<By>; 4] = [
    ("half-angle", "Equal angle at which D falls to half", By::HalfAngle),
    ("rmse", "Least root mean square error over a uniform grid of angles", By::Rmse),
    ("variation", "Least total variation of the densities of slopes", By::Variation),
    ("formula", "The published formulas, each by its source, where there are any", By::Formula),
];

/// The quantity whose error is minimised.
pub(super) const FORMS: [Named<Form>; 2] = [
    ("relative", "D/D(0), the shape of the highlight", Form::Relative),
    ("density", "D itself", Form::Density),
];

/// Replace one distribution of normals by another, and print how much they differ.
///
/// RMSE is over a uniform grid of angles. TV is the total variation of the densities of slopes,
/// half of the integral of |difference|: the share of the projected area, from 0 to 1, whose
/// normals differ. The column `reflection` is the largest difference of D G2/(4 cos cos) over the
/// largest value of the distribution that is replaced, for a light at 45 degrees from the normal,
/// views in the plane of incidence at most 80 degrees from it, and height-correlated masking.
#[derive(clap::Args)]
#[command(
    after_help = "Examples:\n  microfacet-bake convert --from blinn-phong:50 --to beckmann\n  \
                  microfacet-bake convert --from ggx:0.2 --to sawicki --by formula\n  \
                  microfacet-bake convert --from haze:0.1,0.4,0.3 --to student-t --by variation"
)]
pub(super) struct Args {
    /// Distribution to be replaced, such as `blinn-phong:50` or `student-t:0.3,2.5`.
    #[arg(long, value_name = "DISTRIBUTION", required_unless_present = "table")]
    from: Option<String>,
    /// Distribution to replace it with, such as `beckmann`.
    #[arg(long, value_name = "DISTRIBUTION", required_unless_present = "table")]
    to: Option<String>,
    /// Use only this way of choosing; by default all that apply.
    #[arg(long, value_parser = named(&WAYS))]
    by: Option<By>,
    /// Set the second parameter of a distribution that has two, for `half-angle`.
    #[arg(long, value_name = "X", value_parser = values::finite)]
    shape: Option<f64>,
    /// Quantity whose error `rmse` minimises; `relative` by default.
    #[arg(long, value_parser = named(&FORMS))]
    on: Option<Form>,
    /// Print table 2 of Sawicki 2021, the least errors to 17 Beckmanns, ours beside the printed.
    ///
    /// Errors are those of D/D(0) on the grids of the printed table, which end near 4 m; those of
    /// --by rmse are on a grid of [0, pi/2), which makes them smaller and C_TR up to 0.5 % other.
    #[arg(long, conflicts_with_all = ["from", "to", "by", "shape", "on"])]
    table: bool,
}

pub(super) fn run(args: &Args) -> Result<()> {
    print(&args.text()?)
}

impl Args {
    fn text(&self) -> Result<String> {
        match (&self.from, &self.to) {
            (Some(from), Some(to)) => {
                if let Some((name, _)) = to.split_once(':') {
                    bail!("--to {to}: give a name alone, {name}; its parameters are found");
                }
                self.pair(&from.parse()?, DistributionKind::by_name(to)?)
            }
            _ => table::text(),
        }
    }

    fn pair(&self, from: &Distribution, to: DistributionKind) -> Result<String> {
        ensure!(
            self.shape.is_none() || to.parameters().len() == 2,
            "--shape is for a distribution of two parameters, and {} has {}: drop it",
            to.name(),
            if to.parameters().len() == 1 { "one" } else { "three" }
        );
        for (option, given, way) in [
            ("--shape", self.shape.is_some(), By::HalfAngle),
            ("--on", self.on.is_some(), By::Rmse),
        ] {
            let name = values::name(&WAYS, &way);
            ensure!(
                !given || self.by.is_none_or(|by| by == way),
                "{option} is for --by {name} only: drop one of the two"
            );
        }
        let built = from.build()?;
        let target = Target::new(&*built);
        let is_taken = |way: By| self.by.is_none_or(|by| by == way);
        let work = |way, seconds| if is_taken(way) { seconds } else { 0.0 };
        let rmse = work(By::Rmse, target.seconds(to));
        let variation = work(By::Variation, target.seconds_of_variation(to));
        let found: Vec<_> = watched("searching", rmse + variation, |meter| {
            // The replacements of each way; the published formulas may give several.
            let replace = |by| match by {
                By::HalfAngle => vec![target.by_half_angle(to, self.shape).map(Line::plain)],
                By::Rmse => {
                    let form = self.on.unwrap_or(Form::Relative);
                    vec![target.by_rmse(to, form, &meter.stage(rmse)).map(Line::plain)]
                }
                By::Variation => {
                    vec![target.by_variation(to, &meter.stage(variation)).map(Line::plain)]
                }
                By::Formula => match by_formula(from, to) {
                    Ok(all) => {
                        all.into_iter().map(|f| Line::of_formula(f, from.values[0])).collect()
                    }
                    Err(why) => vec![Err(why)],
                },
            };
            let ways = WAYS.iter().filter(|(.., way)| is_taken(*way));
            ways.flat_map(|(name, _, way)| replace(*way).into_iter().map(move |one| (name, one)))
                .collect()
        });
        let mut text = format!(
            "{:<12}{:<36}{:>14}{:>17}{:>14}{:>14}  {}\n",
            "by",
            "replacement",
            "RMSE of D/D(0)",
            "RMSE of D, 1/sr",
            "TV of slopes",
            "reflection",
            "source"
        );
        let (mut lines, mut refusals) = (0, Vec::new());
        for (name, result) in found {
            match result {
                Ok(Line { found, remark }) => {
                    let [relative, density] = found.rmse;
                    let to = found.to.to_string();
                    let Replacement { variation, reflection, .. } = found;
                    let line = format!(
                        "{name:<12}{to:<36}{relative:>14.4e}{density:>17.4e}{variation:>14.4e}\
                         {reflection:>14.4e}  {remark}"
                    );
                    writeln!(text, "{}", line.trim_end())?;
                    lines += 1;
                }
                // Without a choice, the ways that do not apply to this pair are left out.
                Err(
                    ConvertError::NoFormula(..)
                    | ConvertError::ShapeNeeded(_)
                    | ConvertError::OfThree(_),
                ) if self.by.is_none() => {}
                // A way that fails is reported after the others.
                Err(why) => refusals.push((name, why)),
            }
        }
        if lines == 0
            && let Some((_, why)) = refusals.pop()
        {
            return Err(why.into());
        }
        for (name, why) in refusals {
            writeln!(text, "{name:<12}none: {why}")?;
        }
        Ok(text)
    }
}

/// A replacement, with a remark on its source or its search.
struct Line {
    found: Replacement,
    remark: String,
}

impl Line {
    fn plain(found: Replacement) -> Self {
        Self { remark: ends(&found.ends_at).trim_start().into(), found }
    }

    /// What a formula gives of the parameter `x`, or why it gives nothing.
    fn of_formula(
        (formula, found): (Formula, Result<Replacement, ConvertError>),
        x: f64,
    ) -> Result<Self, ConvertError> {
        let mut remark = formula.source.to_owned();
        if let Some(fitted) = formula.beyond(x) {
            let name = formula.from.parameters()[0];
            remark += &format!(" (fitted to {name} = {})", words::range(fitted));
        }
        found.map(|found| Self { found, remark })
    }
}

/// A remark for parameters that were found at the end of their search.
pub(super) fn ends(at: &[&str]) -> String {
    if at.is_empty() {
        return String::new();
    }
    format!(
        "  ({} at the end of the range searched: a better value may lie beyond)",
        at.join(" and ")
    )
}

#[cfg(test)]
mod tests {
    use clap::Parser;

    use super::*;
    use crate::cli::remedy;

    #[derive(Parser)]
    struct Line {
        #[command(flatten)]
        args: Args,
    }

    /// What is printed, or why nothing is.
    fn run(line: &str) -> Result<String, String> {
        let words = std::iter::once("convert").chain(line.split(' '));
        let line = Line::try_parse_from(words).map_err(|why| why.to_string())?;
        line.args.text().map_err(|why| remedy::told(&why))
    }

    #[test]
    fn prints_all_ways_or_one() {
        let all = run("--from blinn-phong:50 --to beckmann").unwrap();
        for part in ["half-angle  ", "rmse  ", "Walter et al. 2007", "Ward 1996", "eq. 12"] {
            assert!(all.contains(part), "no {part} in\n{all}");
        }
        let formulas = run("--from beckmann:0.2 --to blinn-phong --by formula").unwrap();
        let rows: Vec<&str> = formulas.lines().skip(1).map(|line| &line[12..36]).collect();
        let of = |n: &str| format!("{:<24}", format!("blinn-phong:{n}"));
        assert_eq!(rows, ["48.000000", "50.000000", "47.500000"].map(of), "{formulas}");
        assert_eq!(run("--from blinn-phong:50 --to student-t").unwrap().lines().count(), 3);
        let tail = run("--from haze:0.1,0.4,0.3 --to student-t").unwrap();
        assert_eq!(tail.lines().count(), 3, "{tail}");
        assert!(tail.contains("\nvariation   student-t:0."), "{tail}");
        for (line, why) in [
            ("--from gauss:0.1 --to schlick --by formula", "no formula is"),
            ("--from gauss:0.1 --to student-t --by half-angle", "--shape"),
            ("--from gauss:0.1 --to haze --by half-angle", "has three: use rmse or variation"),
            ("--from gauss:0.1 --to haze --shape 2", "haze has three: drop it"),
            ("--from ashikhmin-shirley:10,90 --to gauss", "anisotropic"),
            ("--from gauss:0.1", "--to"),
            // D of this GGX nowhere falls to half of D(0).
            ("--from trowbridge-reitz:0.9 --to beckmann --by half-angle", "use rmse"),
            ("--from gauss:2 --to beckmann --by formula", "eq. 13 gives"),
            ("--from gauss:2 --to beckmann --by formula", "use half-angle"),
            // Values that overflow a double.
            ("--from student-t:1e300,2.5 --to beckmann --by rmse", "too large"),
            ("--from sawicki:1e300 --to gauss", "too large"),
        ] {
            let refusal = run(line).unwrap_err();
            assert!(refusal.contains(why), "{line}: no {why} in {refusal}");
        }
    }

    #[test]
    fn a_way_that_fails_does_not_take_the_others_with_it() {
        for (line, parts) in [
            ("trowbridge-reitz:0.9 --to beckmann", ["rmse        beckmann:0.849", "none: "]),
            (
                "beckmann:1.2 --to blinn-phong --by formula",
                ["blinn-phong:1.388889", "none: Walter"],
            ),
            // A formula beyond the range that it was fitted to.
            (
                "beckmann:0.6 --to gauss --by formula",
                ["gauss:", "eq. 13 (fitted to m = 0.004473 to 0.4473)"],
            ),
        ] {
            let text = run(&format!("--from {line}")).unwrap();
            assert!(parts.iter().all(|part| text.contains(part)), "{text}");
        }
    }

    #[test]
    fn narrow_lobes_are_found_and_the_end_of_a_search_is_said() {
        // m = √(2/(N+2)).
        for (exponent, m) in [("1e9", 4.472e-5), ("1e5", 4.472e-3), ("1e12", 1.4142e-6)] {
            let text = run(&format!("--from blinn-phong:{exponent} --to beckmann --by rmse"));
            let text = text.unwrap();
            let found: f64 = text.split("beckmann:").nth(1).unwrap()[..10].trim().parse().unwrap();
            assert!((found / m - 1.0).abs() < 1e-3 && !text.contains("at the end"), "{text}");
        }
        // Schlick's m is a width like the others'; two parameters as well.
        for (line, part) in [
            ("beckmann:1e-5 --to schlick", "schlick:"),
            ("beckmann:1e-5 --to student-t --by rmse", "student-t:1.0000"),
            ("beckmann:0.2 --to student-t --by rmse", "student-t:"),
        ] {
            let text = run(&format!("--from {line}")).unwrap();
            assert!(text.contains(part) && !text.contains("none"), "{text}");
            assert!(!text.contains("at the end"), "{text}");
        }
        let flat = run("--from blinn-phong:0 --to gauss --by rmse").unwrap();
        assert!(flat.contains("m at the end of the range searched"), "{flat}");
    }
}
