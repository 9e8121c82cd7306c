//! `convert`: replaces one distribution by another.

mod table;

use std::fmt::Write;

use clap::ValueEnum;

use microfacet_baker::distribution::{DistributionKind, Named};
use microfacet_baker::progress::Meter;
use microfacet_fit::convert::{ConvertError, Form, Formula, Replacement, Target, by_formula};

use super::{Done, Failure, Outcome, print, progress, values, words};

/// How the replacement is chosen.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum By {
    /// Equal angle at which D falls to half.
    HalfAngle,
    /// Least root mean square error over a uniform grid of angles.
    Rmse,
    /// The published formulas, each by its source, where there are any.
    Formula,
}

/// The quantity whose error is minimised.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(super) enum On {
    /// D/D(0), the shape of the highlight.
    Relative,
    /// D itself.
    Density,
}

impl From<On> for Form {
    fn from(on: On) -> Self {
        match on {
            On::Relative => Self::Relative,
            On::Density => Self::Density,
        }
    }
}

/// Replace one distribution of normals by another, and print how much they differ.
#[derive(clap::Args)]
#[command(
    after_help = "Examples:\n  microfacet-bake convert --from blinn-phong:50 --to beckmann\n  \
                  microfacet-bake convert --from ggx:0.2 --to sawicki --by formula"
)]
pub(super) struct Args {
    /// Distribution to be replaced, such as `blinn-phong:50` or `student-t:0.3,2.5`.
    #[arg(long, value_name = "DISTRIBUTION", required_unless_present = "table")]
    from: Option<String>,
    /// Distribution to replace it with, such as `beckmann`.
    #[arg(long, value_name = "DISTRIBUTION", required_unless_present = "table")]
    to: Option<String>,
    /// Use only this way of choosing; by default all that apply.
    #[arg(long, value_enum)]
    by: Option<By>,
    /// Set the second parameter of a distribution that has two, for `half-angle`.
    #[arg(long, value_name = "X", value_parser = values::finite)]
    shape: Option<f64>,
    /// Quantity whose error `rmse` minimises; `relative` by default.
    #[arg(long, value_enum)]
    on: Option<On>,
    /// Print table 2 of Sawicki 2021, the least errors to 17 Beckmanns, ours beside the printed.
    ///
    /// Errors are those of D/D(0) on the grids of the printed table, which end near 4 m; those of
    /// --by rmse are on a grid of [0, pi/2), which makes them smaller and C_TR up to 0.5 % other.
    #[arg(long, conflicts_with_all = ["from", "to", "by", "shape", "on"])]
    table: bool,
}

pub(super) fn run(args: Args) -> Outcome {
    print(&args.text()?)?;
    Ok(Done::Ok)
}

impl Args {
    fn form(&self) -> Form {
        self.on.unwrap_or(On::Relative).into()
    }

    fn text(&self) -> Result<String, Failure> {
        match (&self.from, &self.to) {
            (Some(_), Some(to)) if to.contains(':') => {
                let name = to.split(':').next().unwrap_or(to);
                Err(format!("--to {to}: give a name alone, {name}; its parameters are found")
                    .into())
            }
            (Some(from), Some(to)) => self.pair(&from.parse()?, DistributionKind::by_name(to)?),
            _ => table::text(),
        }
    }

    fn pair(&self, from: &Named, to: DistributionKind) -> Result<String, Failure> {
        if self.shape.is_some() && to.parameters().len() < 2 {
            let why = "--shape is for a distribution of two parameters";
            return Err(format!("{why}, and {} has one: drop it", to.name()).into());
        }
        // An option of a way that is not taken.
        for (option, given, way) in [
            ("--shape", self.shape.is_some(), By::HalfAngle),
            ("--on", self.on.is_some(), By::Rmse),
        ] {
            if given && self.by.is_some_and(|by| by != way) {
                let name = way.to_possible_value().expect("no variant is skipped");
                let why =
                    format!("{option} is for --by {} only: drop one of the two", name.get_name());
                return Err(why.into());
            }
        }
        let built = from.build()?;
        let target = Target::new(&*built);
        let meter = Meter::default();
        let searches = self.by.is_none_or(|by| by == By::Rmse);
        let work = if searches { target.seconds(to) } else { 0.0 };
        meter.expect(work);
        let _bar = progress::show(&meter, "searching");
        // What each way gives; the published formulas are several.
        let replace = |by| match by {
            By::HalfAngle => vec![target.by_half_angle(to, self.shape).map(Line::plain)],
            By::Rmse => {
                let found = target.by_rmse(to, self.form(), &meter.stage(work));
                vec![found.map(Line::plain)]
            }
            By::Formula => match by_formula(from, to) {
                Ok(all) => all.into_iter().map(|f| Line::of_formula(f, from.values[0])).collect(),
                Err(e) => vec![Err(e)],
            },
        };
        let ways = By::value_variants().iter();
        let ways = ways.filter(|by| self.by.is_none_or(|only| only == **by));
        let mut text = format!(
            "{:<12}{:<40}{:>14}{:>17}  {}\n",
            "by", "replacement", "RMSE of D/D(0)", "RMSE of D, 1/sr", "source"
        );
        let (mut lines, mut refusals) = (0, Vec::new());
        for (by, result) in ways.flat_map(|by| replace(*by).into_iter().map(move |one| (by, one))) {
            let way = by.to_possible_value().expect("no variant is skipped");
            let name = way.get_name();
            match result {
                Ok(Line { found, remark }) => {
                    let [relative, density] = found.rmse;
                    let to = found.to.to_string();
                    let line =
                        format!("{name:<12}{to:<40}{relative:>14.4e}{density:>17.4e}  {remark}");
                    writeln!(text, "{}", line.trim_end())?;
                    lines += 1;
                }
                // Without a choice, the ways that do not apply to this pair are left out.
                Err(ConvertError::NoFormula(..) | ConvertError::ShapeNeeded(_))
                    if self.by.is_none() => {}
                // Neither does one that fails take the others with it.
                Err(e) => refusals.push((name.to_owned(), e)),
            }
        }
        if lines == 0
            && let Some((_, e)) = refusals.pop()
        {
            return Err(e.into());
        }
        for (name, e) in refusals {
            writeln!(text, "{name:<12}none: {e}")?;
        }
        Ok(text)
    }
}

/// A replacement, and what stands behind it.
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
    use super::*;
    use clap::Parser;

    #[derive(Parser)]
    struct Line {
        #[command(flatten)]
        args: Args,
    }

    fn run(line: &str) -> Result<String, String> {
        let words = std::iter::once("convert").chain(line.split(' '));
        let line = Line::try_parse_from(words).map_err(|e| e.to_string())?;
        line.args.text().map_err(|Failure(why)| why)
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
        assert_eq!(run("--from blinn-phong:50 --to student-t").unwrap().lines().count(), 2);
        assert!(
            run("--from gauss:0.1 --to schlick --by formula")
                .unwrap_err()
                .contains("no formula is")
        );
        assert!(
            run("--from gauss:0.1 --to student-t --by half-angle").unwrap_err().contains("--shape")
        );
        assert!(
            run("--from ashikhmin-shirley:10,90 --to gauss").unwrap_err().contains("anisotropic")
        );
        assert!(run("--from gauss:0.1").is_err());
    }

    #[test]
    fn a_way_that_fails_does_not_take_the_others_with_it() {
        // D of this GGX nowhere falls to half of D(0).
        let wide = "--from trowbridge-reitz:0.9 --to beckmann";
        let all = run(wide).unwrap();
        assert!(all.contains("rmse        beckmann:0.849") && all.contains("none: "), "{all}");
        assert!(run(&format!("{wide} --by half-angle")).unwrap_err().contains("use rmse"));
    }

    #[test]
    fn formulas_out_of_range_are_named_and_beyond_their_fit_told() {
        let text = run("--from beckmann:1.2 --to blinn-phong --by formula").unwrap();
        assert!(text.contains("blinn-phong:1.388889") && text.contains("none: Walter"), "{text}");
        let wide = run("--from beckmann:0.6 --to gauss --by formula").unwrap();
        assert!(wide.contains("eq. 13 (fitted to m = 0.004473 to 0.4473)"), "{wide}");
        let error = run("--from gauss:2 --to beckmann --by formula").unwrap_err();
        assert!(error.contains("eq. 13 gives") && error.contains("use half-angle"), "{error}");
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
        // Schlick's m is a width like the others'.
        let schlick = run("--from beckmann:1e-5 --to schlick").unwrap();
        assert!(!schlick.contains("at the end") && !schlick.contains("none"), "{schlick}");
        // Two parameters as well; and what no double holds is refused.
        let narrow = run("--from beckmann:1e-5 --to student-t --by rmse").unwrap();
        assert!(narrow.contains("student-t:1.0000"), "{narrow}");
        for too_large in ["student-t:1e300,2.5 --to beckmann --by rmse", "sawicki:1e300 --to gauss"]
        {
            let error = run(&format!("--from {too_large}")).unwrap_err();
            assert!(error.contains("too large"), "{error}");
        }
        let flat = run("--from blinn-phong:0 --to gauss --by rmse").unwrap();
        assert!(flat.contains("m at the end of the range searched"), "{flat}");
        let beckmann = run("--from beckmann:0.2 --to student-t --by rmse").unwrap();
        assert!(!beckmann.contains("at the end"), "{beckmann}");
    }
}
