//! Values of options and columns as people write them: counts, sizes, sigma, gamma and angles.

use std::f64::consts::TAU;
use std::ops::RangeInclusive;

use bytesize::ByteSize;
use clap::builder::UnknownArgumentValueParser;

use microfacet_baker::input::angles::Angles;
use microfacet_baker::scene::did_you_mean_key;
use microfacet_baker::table_spec::GAMMA_MIN;
use microfacet_sampler::Ggx;

/// Parses a whole number as `100000` or `1e5`, and checks its range.
pub(super) fn count<T: TryFrom<u64>>(
    range: RangeInclusive<u64>,
) -> impl Fn(&str) -> Result<T, String> + Clone {
    move |text| {
        let n = whole(text).filter(|n| range.contains(n)).and_then(|n| T::try_from(n).ok());
        n.ok_or_else(|| {
            format!(
                "\"{text}\" must be a whole number in [{}, {}], such as {}",
                power(*range.start()),
                power(*range.end()),
                // The largest power of ten up to a million that the range holds.
                (0..=6)
                    .rev()
                    .map(|n| 10_u64.pow(n))
                    .find(|n| range.contains(n))
                    .map_or_else(|| power(*range.start()), power)
            )
        })
    }
}

/// Parses the seed of a random number generator.
pub(super) fn seed(text: &str) -> Result<u64, String> {
    count(0..=u64::MAX)(text)
}

/// Parses a number, and checks its range; `hint` says what its ends mean.
pub(super) fn number(
    range: RangeInclusive<f64>,
    hint: &'static str,
) -> impl Fn(&str) -> Result<f64, String> + Clone {
    move |text| match text.trim().parse() {
        Ok(x) if range.contains(&x) => Ok(x),
        _ => Err(format!(
            "\"{text}\" must be a number in [{}, {}]; {hint}",
            range.start(),
            range.end()
        )),
    }
}

/// Parses a number of any size; whoever uses it knows its range.
pub(super) fn finite(text: &str) -> Result<f64, String> {
    let x = text.trim().parse().ok().filter(|x: &f64| x.is_finite());
    x.ok_or_else(|| format!("\"{text}\" must be a finite number"))
}

/// A whole number, with an exponent or without.
fn whole(text: &str) -> Option<u64> {
    let text = text.trim();
    if let Ok(n) = text.parse() {
        return Some(n);
    }
    // Below 2⁶⁴; a power of ten up to 1e19 is a double without rounding.
    let x: f64 = text.parse().ok()?;
    (x.fract() == 0.0 && (0.0..1.8446744073709552e19).contains(&x)).then_some(x as u64)
}

/// A large power of ten as people write it.
fn power(n: u64) -> String {
    match n.checked_ilog10() {
        Some(e) if e > 4 && n == 10_u64.pow(e) => format!("1e{e}"),
        _ => n.to_string(),
    }
}

/// Parses a number of bytes: `65536`, `1e6`, `10K` or `10KB` (10,000), `4GiB` (4 · 2³⁰).
pub(super) fn size(text: &str) -> Result<u64, String> {
    let bytes = whole(text).or_else(|| text.trim().parse().ok().map(|ByteSize(bytes)| bytes));
    bytes.filter(|&bytes| bytes > 0).ok_or_else(|| {
        format!("\"{text}\" must be a number of bytes, such as 65536, 10K (10,000), 4GB or 4GiB")
    })
}

/// Parses σ as `X` or `X,Y`.
pub(super) fn sigma(text: &str) -> Result<[f64; 2], String> {
    let parts: Vec<&str> = text.split(',').collect();
    let one = |part: &str| {
        let sigma = part.trim().parse::<f64>().map_err(|_| {
            format!("sigma \"{part}\" must be a number; give X, or X,Y for an anisotropic material")
        })?;
        // Every lobe has the same range, and GGX needs no table to say it.
        Ggx::new(sigma).map(|_| sigma).map_err(|why| why.to_string())
    };
    match parts[..] {
        [both] => Ok([one(both)?; 2]),
        [x, y] => Ok([one(x)?, one(y)?]),
        _ => Err(format!("\"{text}\" has {} values; give X, or X,Y", parts.len())),
    }
}

/// Parses γ ∈ (1.5, ∞], `inf` included.
pub(super) fn gamma(text: &str) -> Result<f64, String> {
    match text.trim().parse::<f64>() {
        Ok(gamma) if gamma > 1.5 => Ok(gamma),
        _ => Err(format!(
            "gamma \"{text}\" must be a number in (1.5, inf]; 2 is GGX, inf is Beckmann"
        )),
    }
}

/// Refuses a γ of the family that no table covers, of this set or any other; with what else helps.
pub(super) fn tabulated(gamma: f64, remedy: &str) -> Result<(), String> {
    if gamma >= GAMMA_MIN {
        return Ok(());
    }
    Err(format!(
        "gamma = {gamma} is below {GAMMA_MIN}, the smallest shape that tables cover; raise it{remedy}"
    ))
}

/// The names that others have for sigma: refused, with the relation.
#[derive(clap::Args)]
#[allow(dead_code, reason = "no value of these is ever accepted")]
pub(super) struct OtherNames {
    #[arg(long, hide = true, value_name = "X", value_parser = other_name("alpha"))]
    alpha: Option<String>,
    #[arg(long, hide = true, value_name = "X", value_parser = other_name("roughness"))]
    roughness: Option<String>,
    #[arg(short, alias = "m", hide = true, value_name = "X", value_parser = other_name("m"))]
    m: Option<String>,
}

fn other_name(word: &str) -> UnknownArgumentValueParser {
    let hint = did_you_mean_key(word, &["--sigma"]);
    UnknownArgumentValueParser::suggest(hint.trim_start_matches("; ").replace('`', ""))
}

/// The parameters of a material, which commands that read recipes do not take as options.
#[derive(clap::Args)]
#[allow(dead_code, reason = "no value of these is ever accepted")]
pub(super) struct InRecipe {
    #[arg(long, hide = true, value_name = "X", value_parser = in_recipe())]
    sigma: Option<String>,
    #[arg(long, hide = true, value_name = "X", value_parser = in_recipe())]
    gamma: Option<String>,
    #[arg(long, hide = true, value_name = "X", value_parser = in_recipe())]
    alpha: Option<String>,
    #[arg(long, hide = true, value_name = "X", value_parser = in_recipe())]
    roughness: Option<String>,
    #[arg(long, hide = true, value_name = "X", value_parser = in_recipe())]
    theta: Option<String>,
    #[arg(long, hide = true, value_name = "X", value_parser = in_recipe())]
    fresnel: Option<String>,
}

fn in_recipe() -> UnknownArgumentValueParser {
    UnknownArgumentValueParser::suggest(
        "materials are described in a file: `microfacet-bake recipe` prints one to start from",
    )
}

/// The unit of the angles that a command reads.
#[derive(clap::Args, Clone, Copy, Debug, Default)]
pub(super) struct Unit {
    /// Read angles in degrees instead of radians.
    #[arg(long)]
    degrees: bool,
}

impl Unit {
    pub(super) fn angles(self) -> Angles {
        if self.degrees { Angles::Degrees } else { Angles::Radians }
    }

    /// A polar angle in [0, π/2], in radians.
    pub(super) fn theta(self, x: f64) -> Result<f64, String> {
        let of =
            |why| format!("theta = {x} must be an angle {why}, measured from the macro normal");
        self.angles().polar(x).map_err(|(why, doubted)| {
            of(why) + if doubted { "; if it is in degrees, add --degrees" } else { "" }
        })
    }

    /// Any finite angle, in radians.
    pub(super) fn phi(self, x: f64) -> Result<f64, String> {
        if x.is_finite() {
            Ok(self.angles().to_radians(x))
        } else {
            Err(format!("phi = {x} must be a finite angle"))
        }
    }

    /// What to say of an azimuth that may be in degrees: one of more than a turn.
    pub(super) fn doubt(self, phi: f64) -> Option<String> {
        (!self.degrees && phi.abs() > TAU + 1e-3).then(|| {
            format!(
                "phi = {phi} radians is {:.1} turns; if it is in degrees, add --degrees",
                phi.abs() / TAU
            )
        })
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::FRAC_PI_2;

    use super::*;

    #[test]
    fn numbers_are_checked_against_their_range() {
        let factor = number(0.5..=2.0, "1 leaves it");
        assert_eq!((factor("0.5"), factor(" 2 ")), (Ok(0.5), Ok(2.0)));
        for bad in ["0.49", "inf", "1e308", "nan", "-1", "", "x"] {
            assert!(factor(bad).unwrap_err().contains("[0.5, 2]; 1 leaves it"), "{bad}");
        }
        assert_eq!(finite("-1e300"), Ok(-1e300));
        assert!(["inf", "nan", "x", ""].iter().all(|bad| finite(bad).is_err()));
    }

    #[test]
    fn counts_are_whole_numbers_with_exponents_or_without() {
        let samples = count::<u64>(1_000..=10_000_000_000);
        for (text, n) in
            [("1000", 1_000), ("1e6", 1_000_000), ("2.5e3", 2_500), (" 1E10 ", 10_000_000_000)]
        {
            assert_eq!(samples(text), Ok(n), "{text}");
        }
        for bad in ["999", "1e11", "1e-3", "1000.5", "many", "", "-1e6", "nan", "inf", "1e400"] {
            let why = samples(bad).unwrap_err();
            assert!(why.contains("[1000, 1e10], such as 1e6"), "{bad}: {why}");
        }
        // Seeds keep every bit.
        assert_eq!(seed("18446744073709551615"), Ok(u64::MAX));
        assert!(count::<u16>(0..=70_000)("70000").is_err(), "more than the type holds");
    }

    #[test]
    fn sizes_take_the_units_of_both_kinds() {
        let sizes = [
            ("65536", 65_536),
            ("1e6", 1_000_000),
            ("10K", 10_000),
            ("10kB", 10_000),
            ("4GB", 4_000_000_000),
            ("4GiB", 4 << 30),
            ("1.5 MiB", 3 << 19),
        ];
        for (text, bytes) in sizes {
            assert_eq!(size(text), Ok(bytes), "{text}");
        }
        for bad in ["", "0", "-1", "4X", "GB", "nan", "inf", "4 G B"] {
            assert!(size(bad).unwrap_err().contains("4GB or 4GiB"), "{bad}");
        }
    }

    #[test]
    fn angles_that_look_like_degrees_are_doubted() {
        let [radians, degrees] = [false, true].map(|degrees| Unit { degrees });
        assert_eq!(degrees.theta(90.0), Ok(FRAC_PI_2));
        assert!(degrees.theta(91.0).unwrap_err().contains("[0, 90] degrees"));
        // As people type it; a view beyond would lie below the horizon.
        let quarter = finite("1.5708").unwrap();
        assert!(quarter > FRAC_PI_2 && radians.theta(quarter) == Ok(FRAC_PI_2));
        assert!(radians.theta(20.0).unwrap_err().contains("--degrees"));
        assert!(!radians.theta(-0.1).unwrap_err().contains("--degrees"));
        assert!(radians.theta(f64::NAN).is_err() && radians.phi(f64::INFINITY).is_err());
        assert!(radians.doubt(360.0).is_some_and(|why| why.contains("57.3 turns")));
        assert_eq!((radians.doubt(-TAU), degrees.doubt(360.0)), (None, None));
    }
}
