//! Values of options and columns as they are written: counts, sizes, sigma, gamma and angles.

use std::f64::consts::TAU;
use std::ops::RangeInclusive;

use bytesize::ByteSize;
use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};

use microfacet_baker::input::angles::Angles;
use microfacet_baker::table_spec::GAMMA_MIN;
use microfacet_sampler::{Ggx, Masking};

use super::{Result, anyhow, bail, ensure};

/// The name of a value of an option, its text in `--help`, and the value. An entry without a text
/// is a hidden second name.
pub(super) type Named<T> = (&'static str, &'static str, T);

/// The name of a value.
pub(super) fn name<T: PartialEq>(all: &[Named<T>], value: &T) -> &'static str {
    all.iter().find(|(.., listed)| listed == value).map_or("", |(name, ..)| name)
}

/// Parses a name as its value.
pub(super) fn named<T: Copy + Send + Sync>(
    all: &'static [Named<T>],
) -> impl TypedValueParser<Value = T> {
    let shown =
        |&(name, help, _): &Named<T>| PossibleValue::new(name).help(help).hide(help.is_empty());
    PossibleValuesParser::new(all.iter().map(shown)).map(|typed| {
        let found = all.iter().find(|(name, ..)| name.eq_ignore_ascii_case(&typed));
        found.expect("one of the possible values").2
    })
}

/// Parses a form of masking.
pub(super) fn masking() -> impl TypedValueParser<Value = Masking> {
    PossibleValuesParser::new(Masking::ALL.map(Masking::name))
        .try_map(|name| name.parse::<Masking>())
}

/// Parses a whole number as `100000` or `1e5`, and checks its range.
pub(super) fn count<T: TryFrom<u64>>(
    range: RangeInclusive<u64>,
) -> impl Fn(&str) -> Result<T, String> + Clone {
    move |text| {
        let n = whole(text).filter(|n| range.contains(n)).and_then(|n| T::try_from(n).ok());
        n.ok_or_else(|| {
            let [low, high] = [*range.start(), *range.end()];
            // The largest power of ten up to a million that the range holds.
            let example = (0..=6).rev().map(|n| 10_u64.pow(n)).find(|n| range.contains(n));
            let [low, high, example] = [low, high, example.unwrap_or(low)].map(power);
            format!("\"{text}\" must be a whole number in [{low}, {high}], such as {example}")
        })
    }
}

/// Parses the seed of a random number generator.
pub(super) fn seed(text: &str) -> Result<u64, String> {
    count(0..=u64::MAX)(text)
}

/// Parses a number that is allowed; `must` describes the allowed numbers in errors.
pub(super) fn number(
    is_allowed: fn(&f64) -> bool,
    must: &'static str,
) -> impl Fn(&str) -> Result<f64, String> + Clone {
    move |text| {
        let x = text.trim().parse().ok().filter(is_allowed);
        x.ok_or_else(|| format!("\"{text}\" must be {must}"))
    }
}

/// Parses a number of any size; its range is checked where it is used.
pub(super) fn finite(text: &str) -> Result<f64, String> {
    number(|x| x.is_finite(), "a finite number")(text)
}

/// Parses a factor on γ that makes tests reject; one outside [0.5, 2] would reject any table.
pub(super) fn factor(text: &str) -> Result<f64, String> {
    number(|x| (0.5..=2.0).contains(x), "a number in [0.5, 2]; 1 leaves gamma as it is")(text)
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

/// A number, a large power of ten as `1e6`.
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
pub(super) fn sigma(text: &str) -> Result<[f64; 2]> {
    let one = |part: &str| -> Result<f64> {
        let sigma = part.trim().parse().map_err(|_| {
            anyhow!("sigma \"{part}\" must be a number; give X, or X,Y for an anisotropic material")
        })?;
        // The range of σ is the same for every lobe; `Ggx` checks it without a table.
        Ggx::new(sigma)?;
        Ok(sigma)
    };
    match text.split(',').collect::<Vec<_>>()[..] {
        [both] => Ok([one(both)?; 2]),
        [x, y] => Ok([one(x)?, one(y)?]),
        ref parts => bail!("\"{text}\" has {} values; give X, or X,Y", parts.len()),
    }
}

/// Parses γ ∈ (1.5, ∞], `inf` included.
pub(super) fn gamma(text: &str) -> Result<f64, String> {
    number(|&gamma| gamma > 1.5, "a number in (1.5, inf]; 2 is GGX, inf is Beckmann")(text)
}

/// Refuses a γ below the smallest that any table covers; `remedy` ends the message.
pub(super) fn tabulated(gammas: &[f64], remedy: &str) -> Result<()> {
    match gammas.iter().find(|&&gamma| gamma < GAMMA_MIN) {
        None => Ok(()),
        Some(gamma) => bail!(
            "gamma = {gamma} is below {GAMMA_MIN}, the smallest shape that tables cover; raise it\
             {remedy}"
        ),
    }
}

/// The unit of the angles that a command reads.
#[derive(clap::Args, Clone, Copy, Debug, Default)]
pub(super) struct Unit {
    /// Read angles in degrees instead of radians.
    #[arg(long)]
    pub(super) degrees: bool,
}

impl Unit {
    pub(super) fn angles(self) -> Angles {
        if self.degrees { Angles::Degrees } else { Angles::Radians }
    }

    /// A polar angle in [0, π/2], in radians.
    pub(super) fn theta(self, x: f64) -> Result<f64> {
        self.angles().polar(x).map_err(|(why, doubted)| {
            let hint = if doubted { "; if it is in degrees, add --degrees" } else { "" };
            anyhow!("theta = {x} must be an angle {why}, measured from the macro normal{hint}")
        })
    }

    /// Any finite angle, in radians.
    pub(super) fn phi(self, x: f64) -> Result<f64> {
        ensure!(x.is_finite(), "phi = {x} must be a finite angle");
        Ok(self.angles().to_radians(x))
    }

    /// A warning for an azimuth of more than a turn, which may be in degrees.
    pub(super) fn doubt(self, phi: f64) -> Option<String> {
        let turns = phi.abs() / TAU;
        (!self.degrees && phi.abs() > TAU + 1e-3).then(|| {
            format!("phi = {phi} radians is {turns:.1} turns; if it is in degrees, add --degrees")
        })
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::FRAC_PI_2;

    use super::*;

    #[test]
    fn numbers_are_checked_against_their_range() {
        assert_eq!((factor("0.5"), factor(" 2 ")), (Ok(0.5), Ok(2.0)));
        for bad in ["0.49", "inf", "1e308", "nan", "-1", "", "x"] {
            assert!(factor(bad).unwrap_err().contains("[0.5, 2]; 1 leaves gamma"), "{bad}");
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
        let refusal = |unit: Unit, theta| unit.theta(theta).unwrap_err().to_string();
        assert_eq!(degrees.theta(90.0).unwrap(), FRAC_PI_2);
        assert!(refusal(degrees, 91.0).contains("[0, 90] degrees"));
        // A rounded π/2; a view beyond would lie below the horizon.
        let quarter = finite("1.5708").unwrap();
        assert!(quarter > FRAC_PI_2 && radians.theta(quarter).unwrap() == FRAC_PI_2);
        assert!(refusal(radians, 20.0).contains("--degrees"));
        assert!(!refusal(radians, -0.1).contains("--degrees"));
        assert!(radians.theta(f64::NAN).is_err() && radians.phi(f64::INFINITY).is_err());
        assert!(radians.doubt(360.0).is_some_and(|why| why.contains("57.3 turns")));
        assert_eq!((radians.doubt(-TAU), degrees.doubt(360.0)), (None, None));
    }
}
