//! `fit`: fits σ and γ to a measured distribution, or to measured materials.

mod merl;

use std::f64::consts::FRAC_PI_2;
use std::fmt::Write;
use std::path::{Path, PathBuf};

use microfacet_baker::input::angles::Angles;
use microfacet_baker::input::normals::read_csv;
use microfacet_baker::input::{MAX_TEXT, open_or_stdin, shown};
use microfacet_fit::convert::Form;

use super::convert::{FORMS, ends};
use super::values::{Unit, named};
use super::words::number;
use super::{Context, Result, bail, print, watched};

/// Fit a Student-t to a measured distribution of normals, or to measured materials.
///
/// --input reads a CSV of two columns, an angle from the macro normal and D there in any unit, with
/// or without a header, and fits sigma and gamma; beside them, for comparison, Beckmann, GGX, two
/// GGX (haze) and the ABC of Loew et al. 2012. --merl reads files of the MERL database (Matusik et
/// al. 2003; isotropic reflectances, .binary), and fits to each a Lambert term and a Cook-Torrance
/// lobe of each of these: an albedo and an F0 (Schlick) for red, green and blue, a sigma and a
/// gamma for all, with uncorrelated masking. The error is the sum of |measured - fitted| cos
/// theta_l over that of measured cos theta_l, with view and light less than 80 degrees from the
/// normal.
#[derive(clap::Args)]
#[command(after_help = "Examples:
  printf 'theta,D\\n0,10\\n5,8.7\\n10,5.6\\n20,1.3\\n' | microfacet-bake fit --input - --degrees
  microfacet-bake fit --merl gold-metallic-paint.binary chrome.binary --recipe fitted.toml")]
pub(super) struct Args {
    /// CSV file, `-` for standard input.
    #[arg(long, value_name = "CSV")]
    input: Option<PathBuf>,
    #[command(flatten)]
    unit: Unit,
    /// Quantity whose error the fit minimises.
    #[arg(long, value_parser = named(&FORMS), default_value = "relative")]
    on: Form,
    /// Files of the MERL database, each fitted by itself.
    #[arg(
        long,
        value_name = "FILE",
        num_args = 1..,
        conflicts_with_all = ["input", "degrees", "on"]
    )]
    merl: Vec<PathBuf>,
    /// Recipe to write of the Student-t fits to --merl, which must not exist yet; `-` prints it
    /// instead of the table.
    #[arg(long, value_name = "FILE", conflicts_with = "input")]
    recipe: Option<PathBuf>,
}

pub(super) fn run(args: &Args) -> Result<()> {
    match &args.input {
        Some(input) => {
            let text = normals(input, args).with_context(|| shown(input).to_string())?;
            print(&text)
        }
        None if args.merl.is_empty() => {
            bail!("give --input with a CSV, or --merl with files of the MERL database")
        }
        None => merl::run(&args.merl, args.recipe.as_deref()),
    }
}

/// Fits to a distribution of normals.
fn normals(input: &Path, args: &Args) -> Result<String> {
    let angles = args.unit.angles();
    let measured = read_csv(open_or_stdin(input, MAX_TEXT)?, angles)?;
    let found = watched("fitting", 0.0, |meter| microfacet_fit::fit(&measured, args.on, meter))?;
    let mut text = String::new();
    let (first, last) = measured.assumed();
    if first > 0.0 {
        let first = angle(first, angles);
        writeln!(text, "nothing below {first}: D is taken as constant there")?;
    }
    if last < FRAC_PI_2 - 0.01 {
        let last = angle(last, angles);
        writeln!(text, "nothing above {last}: D is taken as zero there")?;
    }
    writeln!(text, "{:<44}{:>14}{:>17}", "fit", "RMSE of D/D(0)", "RMSE of D, 1/sr")?;
    for found in found.all() {
        let ([relative, density], to) = (found.rmse, found.to.to_string());
        let ends = ends(&found.ends_at);
        writeln!(text, "{to:<44}{relative:>14.4e}{density:>17.4e}{ends}")?;
    }
    Ok(text)
}

/// An angle in radians, however small, in the unit of the input.
fn angle(radians: f64, unit: Angles) -> String {
    format!("{} {}", number(unit.from_radians(radians)), unit.name())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn angles_keep_their_digits_and_their_unit() {
        for degrees in ["89.9", "0.25", "1e-5", "10"] {
            let radians = degrees.parse::<f64>().unwrap().to_radians();
            assert_eq!(angle(radians, Angles::Degrees), format!("{degrees} degrees"));
        }
        assert_eq!(angle(1.0 / 3.0, Angles::Radians), "0.3333333 radians");
    }
}
