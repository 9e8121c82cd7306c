//! `fit`: fits σ and γ to a measured distribution.

use std::fmt::Write;
use std::path::PathBuf;

use microfacet_bake::fit::{self, Angles};
use microfacet_bake::input::{MAX_TEXT, open_or_stdin, shown};
use microfacet_bake::progress::Meter;

use super::convert::{On, ends};
use super::{Done, Outcome, print, progress};

/// Fit a Student-t to a measured distribution of normals (a CSV with the columns angle and D).
#[derive(clap::Args)]
#[command(after_help = "Example:\n  microfacet-bake fit --input measured.csv --degrees")]
pub(super) struct Args {
    /// The CSV file, `-` for standard input.
    #[arg(long)]
    input: PathBuf,
    /// Angles are in degrees instead of radians.
    #[arg(long)]
    degrees: bool,
    /// Quantity whose error the fit minimises.
    #[arg(long, default_value = "relative")]
    on: On,
}

pub(super) fn run(args: Args) -> Outcome {
    let path = shown(&args.input);
    let file = open_or_stdin(&args.input, MAX_TEXT).map_err(|e| format!("{path}: {e}"))?;
    let angles = if args.degrees { Angles::Degrees } else { Angles::Radians };
    let measured = fit::read_csv(file, angles).map_err(|e| format!("{path}: {e}"))?;
    let meter = Meter::default();
    let bar = progress::show(&meter, "fitting");
    let found = fit::fit(&measured, args.on.into(), &meter)?;
    drop(bar);
    let mut text = String::new();
    let (first, last) = measured.assumed();
    if first > 0.0 {
        writeln!(
            text,
            "nothing below {:.3} degrees: D is taken as constant there",
            first.to_degrees()
        )?;
    }
    if last < std::f64::consts::FRAC_PI_2 - 0.01 {
        writeln!(text, "nothing above {:.3} degrees: D is taken as zero there", last.to_degrees())?;
    }
    writeln!(text, "{:<44}{:>14}{:>16}", "fit", "RMSE of D/D(0)", "RMSE of D, 1/sr")?;
    for found in [&found.student_t, &found.beckmann, &found.ggx] {
        writeln!(
            text,
            "{:<44}{:>14.4e}{:>16.4e}{}",
            found.to.to_string(),
            found.rmse[0],
            found.rmse[1],
            ends(found)
        )?;
    }
    print(&text)?;
    Ok(Done::Ok)
}
