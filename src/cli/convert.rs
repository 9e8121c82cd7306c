//! `convert`: replaces one distribution by another.

use std::error::Error;
use std::fmt::Write;

use clap::ValueEnum;

use microfacet_bake::convert::{ConvertError, Form, Replacement, Target, by_formula};
use microfacet_bake::distribution::{DistributionKind, Named};
use microfacet_bake::progress::{Meter, Stage};

use super::{Done, Failure, Outcome, print, progress, values};

/// How the replacement is chosen.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum By {
    /// Equal angle at which D falls to half.
    HalfAngle,
    /// Least root mean square error over a uniform grid of angles.
    Rmse,
    /// The published formula, where there is one.
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
#[command(after_help = "Example:\n  microfacet-bake convert --from blinn-phong:50 --to beckmann")]
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
    /// Print replacements of 17 Beckmanns by Blinn-Phong, Gauss, Schlick and Trowbridge-Reitz.
    #[arg(long, conflicts_with_all = ["from", "to", "by", "shape"])]
    table: bool,
}

pub(super) fn run(args: Args) -> Outcome {
    let text = args.text().map_err(Failure::from)?;
    print(&text)?;
    Ok(Done::Ok)
}

impl Args {
    fn form(&self) -> Form {
        self.on.unwrap_or(On::Relative).into()
    }

    fn text(&self) -> Result<String, Box<dyn Error>> {
        match (&self.from, &self.to) {
            (Some(from), Some(to)) => self.pair(&from.parse()?, DistributionKind::by_name(to)?),
            _ => table(self.form()),
        }
    }

    fn pair(&self, from: &Named, to: DistributionKind) -> Result<String, Box<dyn Error>> {
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
        let replace = |by| match by {
            By::HalfAngle => target.by_half_angle(to, self.shape),
            By::Rmse => target.by_rmse(to, self.form(), &meter.stage(work)),
            By::Formula => by_formula(from, to),
        };
        let mut text = format!(
            "{:<12}{:<40}{:>14}{:>16}\n",
            "by", "replacement", "RMSE of D/D(0)", "RMSE of D, 1/sr"
        );
        let mut line = |name: &str, found: &Replacement| {
            writeln!(
                text,
                "{name:<12}{:<40}{:>14.4e}{:>16.4e}{}",
                found.to.to_string(),
                found.rmse[0],
                found.rmse[1],
                ends(&found.ends_at)
            )
        };
        let (mut lines, mut refusals) = (0, Vec::new());
        for by in By::value_variants().iter().filter(|by| self.by.is_none_or(|only| only == **by)) {
            let name = by.to_possible_value().expect("no variant is skipped");
            match replace(*by) {
                Ok(found) => {
                    line(name.get_name(), &found)?;
                    lines += 1;
                }
                // Without a choice, the ways that do not apply to this pair are left out.
                Err(ConvertError::NoFormula(..) | ConvertError::ShapeNeeded(_))
                    if self.by.is_none() => {}
                // Neither does one that fails take the others with it.
                Err(e) => refusals.push((name.get_name().to_owned(), e)),
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

/// Least-error replacements of Beckmann with m from 0.05 to 0.45.
fn table(form: Form) -> Result<String, Box<dyn Error>> {
    let kinds = [
        DistributionKind::BlinnPhong,
        DistributionKind::Gauss,
        DistributionKind::Schlick,
        DistributionKind::TrowbridgeReitz,
    ];
    /// Roughnesses, and how long each takes: `microfacet-bake convert --table` took 0.84 s.
    const ROWS: u32 = 17;
    const SECONDS: f64 = 0.05;
    let meter = Meter::default();
    meter.expect(f64::from(ROWS) * SECONDS);
    let _bar = progress::show(&meter, "searching");
    let mut text = format!("{:>8}", "m");
    for kind in kinds {
        let name = format!("{} {}", kind.name(), kind.parameters()[0]);
        write!(text, "{name:>20}{:>10}", "RMSE")?;
    }
    text.push('\n');
    for i in 0..ROWS {
        let _stage = meter.stage(SECONDS);
        let m = 0.05 + 0.025 * f64::from(i);
        let built = DistributionKind::Beckmann.build(&[m])?;
        let target = Target::new(&*built);
        write!(text, "{m:>8.3}")?;
        for kind in kinds {
            let found = target.by_rmse(kind, form, &Stage::unwatched())?;
            write!(
                text,
                "{:>20.5}{:>10.2e}",
                found.to.values[0],
                found.rmse[usize::from(form == Form::Density)]
            )?;
        }
        text.push('\n');
    }
    Ok(text)
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
        line.args.text().map_err(|e| e.to_string())
    }

    #[test]
    fn prints_all_ways_or_one() {
        let all = run("--from blinn-phong:50 --to beckmann").unwrap();
        assert!(
            all.contains("half-angle") && all.contains("rmse") && all.contains("formula"),
            "{all}"
        );
        assert_eq!(run("--from blinn-phong:50 --to student-t").unwrap().lines().count(), 2);
        assert!(
            run("--from gauss:0.1 --to schlick --by formula").unwrap_err().contains("no formula")
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
    fn narrow_lobes_are_found_and_the_end_of_a_search_is_said() {
        // m = √(2/(N+2)).
        for (exponent, m) in [("1e9", 4.472e-5), ("1e5", 4.472e-3), ("1e12", 1.4142e-6)] {
            let text = run(&format!("--from blinn-phong:{exponent} --to beckmann --by rmse"));
            let text = text.unwrap();
            let found: f64 = text.split("beckmann:").nth(1).unwrap()[..10].trim().parse().unwrap();
            assert!((found / m - 1.0).abs() < 1e-3 && !text.contains("at the end"), "{text}");
        }
        // Two parameters as well; and what no double holds is refused.
        let narrow = run("--from beckmann:1e-5 --to student-t --by rmse").unwrap();
        assert!(narrow.contains("student-t:1.0000"), "{narrow}");
        let error = run("--from student-t:1e300,2.5 --to beckmann --by rmse").unwrap_err();
        assert!(error.contains("too large"), "{error}");
        let flat = run("--from blinn-phong:0 --to gauss --by rmse").unwrap();
        assert!(flat.contains("m at the end of the range searched"), "{flat}");
        let beckmann = run("--from beckmann:0.2 --to student-t --by rmse").unwrap();
        assert!(!beckmann.contains("at the end"), "{beckmann}");
    }
}
