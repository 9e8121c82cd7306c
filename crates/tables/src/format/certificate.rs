//! The errors that a bake measured on a table between its nodes.

use alloc::borrow::ToOwned;
use alloc::collections::BTreeMap;
use alloc::format;
use alloc::string::String;

use serde::Serialize;

/// A quantity that is read from tables, the most important first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Quantity {
    /// Smith's G1.
    G1,
    /// The cumulative distribution of visible normals.
    Cdf,
    /// The normal distribution function, relative to that of the macro normal.
    Density,
    /// The directional albedo with F = 1.
    E,
    /// The factor of Schlick's F0.
    Scale,
    /// The factor of Schlick's F90.
    Bias,
    /// The factor of the tint at 82 degrees.
    F82,
    /// The directional albedo of one conductor, red.
    Red,
    /// The directional albedo of one conductor, green.
    Green,
    /// The directional albedo of one conductor, blue.
    Blue,
    /// The share of light that a dielectric reflects.
    Reflection,
    /// The share of light that a dielectric transmits.
    Transmission,
}

impl Quantity {
    /// All, in order.
    pub const ALL: [Self; 12] = [
        Self::G1,
        Self::Cdf,
        Self::Density,
        Self::E,
        Self::Scale,
        Self::Bias,
        Self::F82,
        Self::Red,
        Self::Green,
        Self::Blue,
        Self::Reflection,
        Self::Transmission,
    ];

    /// Its name in files, which of an albedo is that of a channel.
    pub fn name(self) -> &'static str {
        match self {
            Self::G1 => "g1",
            Self::Cdf => "cdf",
            Self::Density => "d",
            Self::E => "e",
            Self::Scale => "scale",
            Self::Bias => "bias",
            Self::F82 => "f82",
            Self::Red => "red",
            Self::Green => "green",
            Self::Blue => "blue",
            Self::Reflection => "reflection",
            Self::Transmission => "transmission",
        }
    }

    /// The quantity of this name.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|quantity| quantity.name() == name)
    }
}

/// A coordinate of the point at which an error was measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Coordinate {
    /// s = 1/(γ−1).
    S,
    /// Roughness.
    Sigma,
    /// Relative index of refraction.
    Eta,
    /// Azimuth of the view in radians.
    Phi,
    /// cot θ/σ of the view.
    Cotangent,
    /// cos θ of the view.
    Cosine,
    /// The random number.
    U,
}

impl Coordinate {
    const ALL: [Self; 7] =
        [Self::S, Self::Sigma, Self::Eta, Self::Phi, Self::Cotangent, Self::Cosine, Self::U];

    fn key(self) -> &'static str {
        match self {
            Self::S => "worst_s",
            Self::Sigma => "worst_sigma",
            Self::Eta => "worst_eta",
            Self::Phi => "worst_phi",
            Self::Cotangent => "worst_view_cotangent",
            Self::Cosine => "worst_cos_theta",
            Self::U => "worst_u",
        }
    }
}

/// Absolute errors of one quantity of a table.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Errors {
    /// The largest within the domain for which a bake states errors; rounded up.
    pub largest: f64,
    /// The root mean square within that domain.
    pub rms: Option<f64>,
    /// The largest outside that domain, where the table reaches further.
    pub outside: Option<f64>,
}

/// Errors measured on a table by the bake that made it, off its nodes, through the run-time lookup
/// and against the f64 model. All are finite and not negative; empty where nothing was measured.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
#[serde(into = "Figures")]
pub struct Certificate {
    /// The errors of each quantity.
    pub errors: BTreeMap<Quantity, Errors>,
    /// The point of the largest error of all. An infinite coordinate is left out.
    pub at: BTreeMap<Coordinate, f64>,
    /// Number of points at which errors were measured.
    pub points: Option<u32>,
    /// Estimated error of the values at the nodes themselves.
    pub quadrature: Option<f64>,
    /// The error of E if an isotropic lobe of roughness √(σx σy) is used instead of this lobe.
    pub stand_in: Option<f64>,
}

impl Certificate {
    /// The quantity with the largest error, and that error; of equal ones the most important.
    pub fn largest(&self) -> Option<(Quantity, f64)> {
        let errors = self.errors.iter().map(|(quantity, errors)| (*quantity, errors.largest));
        // A NaN counts as the worst.
        errors.reduce(|a, b| if b.1.total_cmp(&a.1).is_gt() { b } else { a })
    }

    /// The largest error of any quantity; ∞ if none was measured.
    pub fn worst(&self) -> f64 {
        self.largest().map_or(f64::INFINITY, |(_, error)| error)
    }

    /// The largest error of a quantity.
    pub fn error(&self, of: Quantity) -> Option<f64> {
        self.errors.get(&of).map(|errors| errors.largest)
    }

    /// Checks that all figures are finite, and that no error is negative.
    pub(super) fn check(&self) -> Result<(), String> {
        let lies = |(key, figure): &(&String, &f64)| {
            !figure.is_finite() || key.contains(ERROR) && **figure < 0.0
        };
        match Figures::from(self.clone()).iter().find(lies) {
            Some((key, figure)) => Err(format!(
                "`{key}` of its certificate is {figure}; it must be finite, and an error 0 or more"
            )),
            None => Ok(()),
        }
    }
}

/// A certificate in a file: figures by key.
pub(super) type Figures = BTreeMap<String, f64>;

const ERROR: &str = "_error";
const LARGEST: &str = "_max_error";
const RMS: &str = "_rms_error";
const OUTSIDE: &str = "_max_error_outside";
const POINTS: &str = "points";
const QUADRATURE: &str = "quadrature_error";
const STAND_IN: &str = "shortcut_max_error";

impl From<Certificate> for Figures {
    fn from(certificate: Certificate) -> Self {
        let Certificate { errors, at, points, quadrature, stand_in } = certificate;
        let of_quantity = |(quantity, errors): (Quantity, Errors)| {
            let Errors { largest, rms, outside } = errors;
            [(LARGEST, Some(largest)), (RMS, rms), (OUTSIDE, outside)]
                .map(|(end, figure)| (format!("{}{end}", quantity.name()), figure))
        };
        let whole =
            [(POINTS, points.map(f64::from)), (QUADRATURE, quadrature), (STAND_IN, stand_in)];
        let whole = whole.map(|(key, figure)| (key.to_owned(), figure));
        let at = at.into_iter().map(|(coordinate, x)| (coordinate.key().to_owned(), Some(x)));
        let all = errors.into_iter().flat_map(of_quantity).chain(whole).chain(at);
        all.filter_map(|(key, figure)| Some((key, figure?))).collect()
    }
}

impl TryFrom<Figures> for Certificate {
    type Error = String;

    fn try_from(mut figures: Figures) -> Result<Self, String> {
        let mut certificate = Self::default();
        for quantity in Quantity::ALL {
            let mut take = |end| figures.remove(&format!("{}{end}", quantity.name()));
            if let Some(largest) = take(LARGEST) {
                let errors = Errors { largest, rms: take(RMS), outside: take(OUTSIDE) };
                certificate.errors.insert(quantity, errors);
            }
        }
        for coordinate in Coordinate::ALL {
            if let Some(x) = figures.remove(coordinate.key()) {
                certificate.at.insert(coordinate, x);
            }
        }
        if let Some(points) = figures.remove(POINTS) {
            let whole = points as u32;
            if f64::from(whole) != points {
                return Err(format!("a certificate counts {points} points"));
            }
            certificate.points = Some(whole);
        }
        certificate.quadrature = figures.remove(QUADRATURE);
        certificate.stand_in = figures.remove(STAND_IN);
        match figures.first_key_value() {
            Some((key, _)) => Err(format!("a certificate has no figure `{key}`")),
            None => Ok(certificate),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn whole() -> Certificate {
        let errors = Errors { largest: 2e-5, rms: Some(1e-6), outside: Some(3e-5) };
        Certificate {
            errors: Quantity::ALL.map(|quantity| (quantity, errors)).into(),
            at: Coordinate::ALL.map(|coordinate| (coordinate, -0.25)).into(),
            points: Some(4000),
            quadrature: Some(1e-7),
            stand_in: Some(0.1),
        }
    }

    #[test]
    fn figures_are_those_of_the_file_and_none_is_lost() {
        let figures = Figures::from(whole());
        assert_eq!(figures.len(), 3 * Quantity::ALL.len() + Coordinate::ALL.len() + 3);
        assert_eq!(figures["e_max_error_outside"], 3e-5);
        assert_eq!(Certificate::try_from(figures), Ok(whole()));
        assert_eq!(Figures::from(Certificate::default()), Figures::new());
    }

    #[test]
    fn other_figures_are_refused() {
        for (key, figure) in
            [("h_max_error", 0.1), ("e_rms_error", 0.1), ("points", 0.5), ("points", -1.0)]
        {
            let figures = Figures::from([(key.to_owned(), figure)]);
            let why = Certificate::try_from(figures).unwrap_err();
            assert!(why.contains("points") || why.contains(&format!("`{key}`")), "{why}");
        }
    }

    #[test]
    fn lies_are_named() {
        assert_eq!(whole().check(), Ok(()));
        for lie in [f64::NAN, f64::INFINITY, -1.0] {
            let mut certificate = whole();
            certificate.errors.get_mut(&Quantity::Blue).unwrap().outside = Some(lie);
            let why = certificate.check().unwrap_err();
            assert!(why.contains(&format!("`blue_max_error_outside` of its certificate is {lie}")));
        }
        let mut certificate = whole();
        certificate.at.insert(Coordinate::U, f64::NAN);
        assert!(certificate.check().unwrap_err().contains("worst_u"));
    }

    #[test]
    fn of_equal_errors_the_most_important_is_the_largest() {
        let mut certificate = whole();
        assert_eq!(certificate.largest(), Some((Quantity::G1, 2e-5)));
        certificate.errors.get_mut(&Quantity::Blue).unwrap().largest = 3e-5;
        assert_eq!(certificate.largest(), Some((Quantity::Blue, 3e-5)));
        assert_eq!(certificate.worst(), 3e-5);
        assert_eq!(Certificate::default().worst(), f64::INFINITY);
    }
}
