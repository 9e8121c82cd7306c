//! `fit --merl`: compares fits to measured materials.

use std::fmt::Write;
use std::path::{Path, PathBuf};

use microfacet_baker::distribution::DistributionKind;
use microfacet_fit::merl;
use microfacet_fit::merl::{Comparison, Fitted, Fitter, Measured};

use crate::cli::convert::ends;
use crate::cli::recipe::check_new;
use crate::cli::words::count;
use crate::cli::{Context, Result, is_stream, print, summarize, watched, write, write_file};

pub(super) fn run(files: &[PathBuf], recipe: Option<&Path>) -> Result<()> {
    let prints = recipe.is_some_and(is_stream);
    let recipe_file = recipe.filter(|_| !prints);
    recipe_file.map_or(Ok(()), check_new)?;
    let names = merl::names(files.iter().map(PathBuf::as_path));
    let width = names.iter().map(|name| name.chars().count()).max().unwrap_or(0).max(8);
    let work = files.len() as f64 * Fitter::SECONDS;
    let found = watched("fitting", work, |meter| -> Result<_> {
        let fitter = Fitter::default();
        // All files are checked before the first fit, which takes long.
        for path in files.iter().filter(|_| files.len() > 1) {
            let check = || fitter.check(&Measured::read(path)?);
            check().with_context(|| path.display().to_string())?;
        }
        let mut found = Vec::with_capacity(files.len());
        for (path, name) in files.iter().zip(&names) {
            let fit = || fitter.fit(&Measured::read(path)?, meter);
            let fits = fit().with_context(|| path.display().to_string())?;
            if !prints {
                let head = if found.is_empty() { head(width) } else { String::new() };
                print(&(head + &rows(name, width, &fits)?))?;
            }
            found.push(fits);
        }
        Ok(found)
    })?;
    if !prints && found.len() > 1 {
        print(&summary(&found)?)?;
    }
    if recipe.is_none() {
        return Ok(());
    }
    let text =
        merl::recipe(names.iter().zip(&found).map(|(name, fits)| (&**name, &fits.student_t)));
    let Some(path) = recipe_file else { return write(text.as_bytes()) };
    write_file(path, text.as_bytes())?;
    summarize(&format!("{}\n", path.display()))
}

fn head(width: usize) -> String {
    format!(
        "{:<width$}  {:>8} {:>7}  {:>7} {:>7}  {:>9} {:>7} {:>7}  {:>6} {:>6} best\n",
        "material",
        "Beckmann",
        "sigma",
        "GGX",
        "sigma",
        "Student-t",
        "sigma",
        "gamma",
        "haze",
        "abc"
    )
}

/// The row of a material, and below it the parameters that have no column.
fn rows(name: &str, width: usize, fits: &Comparison) -> Result<String, std::fmt::Error> {
    let Comparison { beckmann, ggx, student_t, haze, abc } = fits;
    let [sigma, gamma] = student_t.sigma_gamma().map(short);
    let mut text = format!(
        "{name:<width$}  {:>8.4} {:>7}  {:>7.4} {:>7}  {:>9.4} {sigma:>7} {gamma:>7}  {:>6.4} \
         {:>6.4} {}\n",
        beckmann.error,
        short(beckmann.sigma_gamma()[0]),
        ggx.error,
        short(ggx.sigma_gamma()[0]),
        student_t.error,
        haze.error,
        abc.error,
        label(fits.best()),
    );
    let rgb = |[r, g, b]: [f64; 3]| format!("{r:.3} {g:.3} {b:.3}");
    writeln!(
        text,
        "    Student-t: F0 {}, Lambert {}{}",
        rgb(student_t.f0),
        rgb(student_t.lambert),
        ends(&student_t.ends_at)
    )?;
    writeln!(text, "    {}{}, {}{}", haze.lobe, ends(&haze.ends_at), abc.lobe, ends(&abc.ends_at))?;
    for other in [beckmann, ggx].into_iter().filter(|other| !other.ends_at.is_empty()) {
        // They have one parameter, whatever its name.
        writeln!(text, "    {}:{}", label(other), ends(&["sigma"]))?;
    }
    Ok(text)
}

/// How often each fit is best, and the factors between its error and that of Student-t.
fn summary(found: &[Comparison]) -> Result<String, std::fmt::Error> {
    let times = |kind| found.iter().filter(|fits| fits.best().lobe.kind == kind).count();
    let mut text = format!(
        "\nbest for {}: Student-t {}, GGX {}, Beckmann {}, haze {}, abc {}\n(GGX or Beckmann where \
         Student-t gains less than {} %, or {:e} of the error)\n",
        count(found.len(), "material"),
        times(DistributionKind::StudentT),
        times(DistributionKind::TrowbridgeReitz),
        times(DistributionKind::Beckmann),
        times(DistributionKind::Haze),
        times(DistributionKind::Abc),
        100.0 * Comparison::EQUAL,
        Comparison::EXACT
    );
    let gains = |of: fn(&Comparison) -> &Fitted| -> Vec<f64> {
        found.iter().map(|fits| fits.gain(of(fits))).collect()
    };
    let others = [
        ("GGX", gains(|fits| &fits.ggx)),
        ("Beckmann", gains(|fits| &fits.beckmann)),
        ("haze", gains(|fits| &fits.haze)),
        ("abc", gains(|fits| &fits.abc)),
    ];
    for (name, factors) in others {
        let least = factors.iter().copied().fold(f64::INFINITY, f64::min);
        let most = factors.iter().copied().fold(0.0, f64::max);
        let logs: f64 = factors.iter().map(|factor| factor.ln()).sum();
        let mean = (logs / factors.len() as f64).exp();
        writeln!(
            text,
            "error of {name} over that of Student-t: {least:.3} to {most:.3}, geometric mean \
             {mean:.3}"
        )?;
    }
    Ok(text)
}

fn label(fitted: &Fitted) -> &'static str {
    match fitted.lobe.kind {
        DistributionKind::Beckmann => "Beckmann",
        DistributionKind::TrowbridgeReitz => "GGX",
        DistributionKind::Haze => "haze",
        DistributionKind::Abc => "abc",
        _ => "Student-t",
    }
}

/// A parameter in seven characters.
fn short(x: f64) -> String {
    match x {
        0.01..99.99995 | f64::INFINITY => format!("{x:.4}"),
        _ => format!("{x:.1e}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parameters_fit_their_columns() {
        let shown = [0.01, 0.00123, 99.99, 99.99996, 12345.6, 1e-4, f64::INFINITY].map(short);
        assert_eq!(shown, ["0.0100", "1.2e-3", "99.9900", "1.0e2", "1.2e4", "1.0e-4", "inf"]);
    }
}
