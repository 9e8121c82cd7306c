//! Distributions by name, as recipes and the command line give them: `blinn-phong:50`,
//! `student-t:0.3,2.5`.

use std::fmt;
use std::str::FromStr;

use microfacet_core::shape::gamma_of_s;
use microfacet_model::classic::{
    Abc, AshikhminShirley, Gauss, Gtr, Haze, Isotropic, Member, Sawicki, Schlick, Tabulated,
};

use crate::input::angles::Angles;

/// The largest s = 1/(γ−1) of a search: γ = 1.5025.
pub const S_MAX: f64 = 1.99;

/// A named distribution of one to three parameters.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum DistributionKind {
    /// Beckmann, slope parameter m.
    Beckmann,
    /// Gaussian of the angle (Torrance–Sparrow), width m in radians.
    Gauss,
    /// Trowbridge–Reitz (GGX), C.
    TrowbridgeReitz,
    /// Generalised Trowbridge–Reitz, C and γ.
    Gtr,
    /// Blinn–Phong, exponent N.
    BlinnPhong,
    /// Schlick's rational distribution, m.
    Schlick,
    /// Sawicki's rational distribution, exponent N.
    Sawicki,
    /// Student-t, σ and γ.
    StudentT,
    /// Hyper-Cauchy, σ₀ and γ.
    HyperCauchy,
    /// Ashikhmin–Shirley, exponents along x and y; isotropic only where they are equal.
    AshikhminShirley,
    /// The normals of two GGX: their σ, and the share of the second.
    Haze,
    /// Löw and others' ABC, B and C.
    Abc,
}

/// A distribution with its parameters.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Named {
    /// The kind.
    pub kind: DistributionKind,
    /// Its parameters, in the order of [`DistributionKind::parameters`].
    pub values: Vec<f64>,
}

/// A distribution outside the Student-t family that a material may have.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Distribution {
    /// Given by name and parameters.
    Named(Named),
    /// Read from a file of angles and D.
    Measured {
        /// The file as the recipe names it.
        file: String,
        /// The unit of the angles in it.
        angles: Angles,
        /// The angles and D that it holds.
        table: Tabulated,
    },
}

impl Distribution {
    /// Builds the distribution, with the errors of [`DistributionKind::build`].
    pub fn build(&self) -> Result<Box<dyn Isotropic>, DistributionError> {
        match self {
            Self::Named(named) => named.build(),
            Self::Measured { table, .. } => Ok(Box::new(table.clone())),
        }
    }

    /// The distribution as text, with every digit: `gtr:0.2,1.5` or `measured:steel.csv`, or
    /// `measured-degrees:steel.csv` where the angles in the file are in degrees.
    pub fn label(&self) -> String {
        match self {
            Self::Named(named) => {
                let values: Vec<String> = named.values.iter().map(|x| format!("{x}")).collect();
                format!("{}:{}", named.kind.name(), values.join(","))
            }
            Self::Measured { file, angles, .. } => format!("{}:{file}", measured(*angles)),
        }
    }

    /// The file, and the unit of the angles in it, of the label of a measured distribution.
    pub fn measured_of(label: &str) -> Option<(&str, Angles)> {
        let (kind, file) = label.split_once(':')?;
        let mut units = [Angles::Radians, Angles::Degrees].into_iter();
        Some((file, units.find(|angles| measured(*angles) == kind)?))
    }
}

/// The prefix of the label of a measured distribution.
const fn measured(angles: Angles) -> &'static str {
    match angles {
        Angles::Radians => "measured",
        Angles::Degrees => "measured-degrees",
    }
}

/// Why a distribution could not be made.
#[derive(Clone, PartialEq, thiserror::Error)]
pub enum DistributionError {
    /// No distribution has this name.
    #[error(
        "distribution `{}` is not known; there are {}",
        .0,
        DistributionKind::ALL.map(DistributionKind::name).join(", ")
    )]
    Unknown(String),
    /// The wrong number of parameters, or a parameter that is not a number.
    #[error(
        "`{}`: {} is written {}:{}, each a number", .1, .0, .0, .0.parameters().join(",")
    )]
    Parameters(DistributionKind, String),
    /// A parameter outside its range, with the model's message.
    #[error("{0}: {1}")]
    Range(DistributionKind, String),
    /// An anisotropic distribution where an isotropic one is required.
    #[error(
        "ashikhmin-shirley with exponents {0} and {1} is anisotropic: its D depends on two angles \
         and that of the others on one; give equal exponents, or treat each axis as a blinn-phong"
    )]
    Dimension(f64, f64),
}

microfacet_core::debug_in_words!(DistributionError);

impl fmt::Display for DistributionKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl DistributionKind {
    /// All kinds.
    pub const ALL: [Self; 12] = [
        Self::Beckmann,
        Self::Gauss,
        Self::TrowbridgeReitz,
        Self::Gtr,
        Self::BlinnPhong,
        Self::Schlick,
        Self::Sawicki,
        Self::StudentT,
        Self::HyperCauchy,
        Self::AshikhminShirley,
        Self::Haze,
        Self::Abc,
    ];

    /// The name in recipes and on the command line.
    pub const fn name(self) -> &'static str {
        self.words().0
    }

    /// Names of its parameters.
    pub const fn parameters(self) -> &'static [&'static str] {
        self.words().1
    }

    const fn words(self) -> (&'static str, &'static [&'static str]) {
        match self {
            Self::Beckmann => ("beckmann", &["m"]),
            Self::Gauss => ("gauss", &["m"]),
            Self::TrowbridgeReitz => ("trowbridge-reitz", &["c"]),
            Self::Gtr => ("gtr", &["c", "gamma"]),
            Self::BlinnPhong => ("blinn-phong", &["n"]),
            Self::Schlick => ("schlick", &["m"]),
            Self::Sawicki => ("sawicki", &["n"]),
            Self::StudentT => ("student-t", &["sigma", "gamma"]),
            Self::HyperCauchy => ("hyper-cauchy", &["sigma0", "gamma"]),
            Self::AshikhminShirley => ("ashikhmin-shirley", &["nx", "ny"]),
            Self::Haze => ("haze", &["sigma_core", "sigma_haze", "weight"]),
            Self::Abc => ("abc", &["b", "c"]),
        }
    }

    /// The kind of this name; `ggx` and `torrance-sparrow` are understood too.
    ///
    /// # Errors
    /// [`DistributionError::Unknown`], listing the names.
    pub fn by_name(name: &str) -> Result<Self, DistributionError> {
        let known = match name {
            "ggx" => "trowbridge-reitz",
            "torrance-sparrow" => "gauss",
            other => other,
        };
        let found = Self::ALL.into_iter().find(|kind| kind.name() == known);
        found.ok_or_else(|| DistributionError::Unknown(name.into()))
    }

    /// Builds the distribution with these parameters.
    ///
    /// # Errors
    /// [`DistributionError`] for a wrong number of parameters, one out of range, or anisotropy.
    pub fn build(self, values: &[f64]) -> Result<Box<dyn Isotropic>, DistributionError> {
        match (self, values) {
            (Self::Beckmann, &[m]) => self.boxed(Member::beckmann(m)),
            (Self::TrowbridgeReitz, &[c]) => self.boxed(Member::trowbridge_reitz(c)),
            (Self::BlinnPhong, &[n]) => self.boxed(Member::blinn_phong(n)),
            (Self::StudentT, &[sigma, gamma]) => self.boxed(Member::student_t(sigma, gamma)),
            (Self::HyperCauchy, &[sigma, gamma]) => self.boxed(Member::hyper_cauchy(sigma, gamma)),
            (Self::Gauss, &[m]) => self.boxed(Gauss::new(m)),
            (Self::Schlick, &[m]) => self.boxed(Schlick::new(m)),
            (Self::Sawicki, &[n]) => self.boxed(Sawicki::new(n)),
            (Self::Gtr, &[c, gamma]) => self.boxed(Gtr::new(c, gamma)),
            (Self::Haze, &[core, haze, weight]) => self.boxed(Haze::new(core, haze, weight)),
            (Self::Abc, &[b, c]) => self.boxed(Abc::new(b, c)),
            (Self::AshikhminShirley, &[nx, ny]) => {
                self.in_range(AshikhminShirley::new(nx, ny))?;
                if nx != ny {
                    return Err(DistributionError::Dimension(nx, ny));
                }
                self.boxed(Member::blinn_phong(nx))
            }
            _ => Err(DistributionError::Parameters(self, format!("{values:?}"))),
        }
    }

    fn in_range<D>(self, made: Result<D, impl fmt::Display>) -> Result<D, DistributionError> {
        made.map_err(|e| DistributionError::Range(self, e.to_string()))
    }

    fn boxed<D: Isotropic + 'static>(
        self,
        made: Result<D, impl fmt::Display>,
    ) -> Result<Box<dyn Isotropic>, DistributionError> {
        Ok(Box::new(self.in_range(made)?))
    }

    /// Parameters at a point of the search space [0, 1]ⁿ: logarithmic in the width; in s = 1/(γ−1)
    /// (Student-t, with Beckmann at 0), ln γ (GTR) or ln C (ABC) for the shape. A haze is 1 to 100
    /// times as rough as its core.
    ///
    /// All widths are scaled by `narrow` ∈ (0, 1], so that the search for a narrow lobe has the
    /// same steps as for any other.
    pub fn at(self, point: &[f64], narrow: f64) -> Vec<f64> {
        let log = |y: f64, low: f64, high: f64| {
            (low * (y.clamp(0.0, 1.0) * (high / low).ln()).exp()).clamp(low, high)
        };
        let width = |y, low, high| log(y, low, high) * narrow;
        let exponent = |y| log(y, 1e-2, 1e6) / (narrow * narrow);
        let gamma = |y: f64| gamma_of_s(S_MAX * y.clamp(0.0, 1.0));
        match (self, point) {
            (Self::Beckmann | Self::Gauss, &[y]) => vec![width(y, 1e-3, 10.0)],
            (Self::TrowbridgeReitz, &[y]) => vec![width(y, 1e-4, 10.0)],
            (Self::Schlick, &[y]) => vec![width(y, 1e-6, 1.0)],
            (Self::BlinnPhong | Self::Sawicki, &[y]) => vec![exponent(y)],
            (Self::AshikhminShirley, &[y]) => vec![exponent(y); 2],
            (Self::StudentT, &[y, z]) => vec![width(y, 1e-4, 10.0), gamma(z)],
            // No Beckmann limit: σ₀ would diverge.
            (Self::HyperCauchy, &[y, z]) => vec![width(y, 1e-4, 1e3), gamma(z.max(1e-4))],
            (Self::Gtr, &[y, z]) => vec![width(y, 1e-5, 1.0), log(z, 0.1, 100.0)],
            (Self::Haze, &[y, z, weight]) => {
                let core = width(y, 1e-4, 10.0);
                vec![core, core * log(z, 1.0, 100.0), weight.clamp(0.0, 1.0)]
            }
            (Self::Abc, &[y, z]) => vec![width(y, 1e-5, 10.0).powi(-2), log(z, 0.1, 100.0)],
            _ => unreachable!("points have `dimension` coordinates"),
        }
    }

    /// The names of the parameters that are at an end of the range of [`at`](Self::at), except the
    /// limits γ = ∞ of the Student-t and the single GGX of a haze.
    pub fn ends_at(self, point: &[f64]) -> Vec<&'static str> {
        let at_end = |y: f64| !(1e-4..=1.0 - 1e-4).contains(&y);
        let is_limit = |i: usize| match self {
            Self::StudentT => i == 1 && point[i] < 0.5,
            Self::Haze => i == 2 || i == 1 && point[i] < 0.5,
            _ => false,
        };
        let ends = (0..point.len()).filter(|&i| at_end(point[i]) && !is_limit(i));
        ends.map(|i| self.parameters()[i]).collect()
    }

    /// Number of parameters of its isotropic members.
    pub fn dimension(self) -> usize {
        if self == Self::AshikhminShirley { 1 } else { self.parameters().len() }
    }
}

impl Named {
    /// Builds the distribution, with the errors of [`DistributionKind::build`].
    pub fn build(&self) -> Result<Box<dyn Isotropic>, DistributionError> {
        self.kind.build(&self.values)
    }
}

impl FromStr for Named {
    type Err = DistributionError;

    /// Parses `name:value`, with further values after commas; `inf` is a number.
    fn from_str(text: &str) -> Result<Self, DistributionError> {
        let (name, rest) = text.split_once(':').unwrap_or((text, ""));
        let kind = DistributionKind::by_name(name)?;
        let values: Result<Vec<f64>, _> = rest.split(',').map(|x| x.trim().parse()).collect();
        let values = values.map_err(|_| DistributionError::Parameters(kind, text.into()))?;
        if values.len() != kind.parameters().len() {
            return Err(DistributionError::Parameters(kind, text.into()));
        }
        Ok(Self { kind, values })
    }
}

impl fmt::Display for Named {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        // Six decimal places, or six significant digits where that would lose some.
        let number = |x: &f64| match x.abs() {
            1e-2..1e9 | 0.0 | f64::INFINITY => format!("{x:.6}"),
            _ => format!("{x:.5e}"),
        };
        let values: Vec<String> = self.values.iter().map(number).collect();
        write!(f, "{}:{}", self.kind.name(), values.join(","))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_parse_and_print() {
        for kind in DistributionKind::ALL {
            let point = vec![0.6; kind.dimension()];
            let named = Named { kind, values: kind.at(&point, 1.0) };
            let back: Named = named.to_string().parse().unwrap();
            assert_eq!(back.kind, kind);
            assert!(back.build().is_ok(), "{named}");
        }
        let beckmann: Named = "student-t:0.3,inf".parse().unwrap();
        assert!(beckmann.build().unwrap().student_t().unwrap().shape().is_beckmann());
        assert_eq!("ggx:0.1".parse::<Named>().unwrap().kind, DistributionKind::TrowbridgeReitz);
    }

    #[test]
    fn errors_name_the_remedy() {
        let message = |text: &str| match text.parse::<Named>() {
            Ok(named) => named.build().map(|_| ()).unwrap_err().to_string(),
            Err(e) => e.to_string(),
        };
        assert!(message("phong:3").contains("there are beckmann"));
        assert!(message("gtr:0.1").contains("gtr:c,gamma"));
        assert!(message("beckmann:x").contains("beckmann:m"));
        assert!(message("schlick:2").contains("(0, 1]"));
        assert!(message("sawicki:-1").contains("[0, inf)"));
        assert!(message("haze:0.1,0.4").contains("haze:sigma_core,sigma_haze,weight"));
        assert!(message("haze:0.1,0.4,1.5").contains("weight = 1.5: must lie in [0, 1]"));
        assert!(message("abc:10,-1").contains("c = -1"));
        assert!(message("ashikhmin-shirley:10,20").contains("anisotropic"));
    }
}
