//! Metals by name: their measured complex indices of refraction.

use core::fmt;
use core::str::FromStr;

use microfacet_tables::Reflectance;

/// A metal with its measured complex index of refraction, eta + i k.
///
/// [`eta`](Self::eta) and [`k`](Self::k) are triples for the red, green and blue of linear light,
/// relative to vacuum (or air, which differs by 0.03 %). They are the index at three single
/// wavelengths, 650, 550 and 450 nm, not averages over bands. Each is interpolated linearly in the
/// wavelength between the two nearest rows of the published table, and rounded to three decimals,
/// halves up.
///
/// The tables are those of <https://refractiveindex.info> (CC0), by shelf, book and page:
///
/// | metals | shelf, book, page | publication |
/// | --- | --- | --- |
/// | gold, silver, copper | main, Au Ag Cu, Johnson | Johnson and Christy 1972, <https://doi.org/10.1103/PhysRevB.6.4370> |
/// | iron, chromium, titanium, nickel, cobalt | main, Fe Cr Ti Ni Co, Johnson | Johnson and Christy 1974, <https://doi.org/10.1103/PhysRevB.9.5056> |
/// | aluminium | main, Al, Rakic | Rakić 1995, <https://doi.org/10.1364/AO.34.004755> |
/// | platinum, tungsten | main, Pt W, Rakic-BB (a Brendel-Bormann model fitted to several measurements) | Rakić, Djurišić, Elazar and Majewski 1998, <https://doi.org/10.1364/AO.37.005271> |
/// | brass, of 70 % copper and 30 % zinc | other, Cu-Zn, Querry-Cu70Zn30 | Querry 1985, report CRDC-CR-85034, <https://apps.dtic.mil/sti/citations/ADA158623> |
///
/// ```
/// use microfacet_sampler::Metal;
///
/// let gold: Metal = "gold".parse()?;
/// let reflectance = |(eta, k): (f64, f64)| {
///     ((eta - 1.0).powi(2) + k * k) / ((eta + 1.0).powi(2) + k * k)
/// };
/// let red = reflectance((gold.eta()[0], gold.k()[0]));
/// assert!((red - 0.956).abs() < 1e-3);
/// # Ok::<(), microfacet_sampler::UnknownMetal>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Metal {
    /// Au.
    Gold,
    /// Ag.
    Silver,
    /// Cu.
    Copper,
    /// Al.
    Aluminium,
    /// Fe.
    Iron,
    /// Cr.
    Chromium,
    /// Ti.
    Titanium,
    /// Ni.
    Nickel,
    /// Pt.
    Platinum,
    /// An alloy of 70 % copper and 30 % zinc.
    Brass,
    /// Co.
    Cobalt,
    /// W.
    Tungsten,
}

const JOHNSON_1972: &str = "https://doi.org/10.1103/PhysRevB.6.4370";
const JOHNSON_1974: &str = "https://doi.org/10.1103/PhysRevB.9.5056";
const QUERRY_1985: &str = "https://apps.dtic.mil/sti/citations/ADA158623";
const RAKIC_1995: &str = "https://doi.org/10.1364/AO.34.004755";
const RAKIC_1998: &str = "https://doi.org/10.1364/AO.37.005271";

impl Metal {
    /// All metals.
    pub const ALL: [Self; 12] = [
        Self::Gold,
        Self::Silver,
        Self::Copper,
        Self::Aluminium,
        Self::Iron,
        Self::Chromium,
        Self::Titanium,
        Self::Nickel,
        Self::Platinum,
        Self::Brass,
        Self::Cobalt,
        Self::Tungsten,
    ];

    /// Name, η, k, and where they were published.
    const fn row(self) -> (&'static str, [f64; 3], [f64; 3], &'static str) {
        match self {
            Self::Gold => ("gold", [0.156, 0.424, 1.383], [3.602, 2.472, 1.916], JOHNSON_1972),
            Self::Silver => ("silver", [0.052, 0.060, 0.040], [4.409, 3.597, 2.648], JOHNSON_1972),
            Self::Copper => ("copper", [0.238, 1.007, 1.240], [3.626, 2.582, 2.393], JOHNSON_1972),
            Self::Aluminium => {
                ("aluminium", [1.558, 1.015, 0.633], [7.712, 6.627, 5.454], RAKIC_1995)
            }
            Self::Iron => ("iron", [2.911, 2.950, 2.585], [3.089, 2.932, 2.767], JOHNSON_1974),
            Self::Chromium => {
                ("chromium", [3.107, 3.181, 2.323], [3.331, 3.329, 3.135], JOHNSON_1974)
            }
            Self::Titanium => {
                ("titanium", [2.741, 2.542, 2.267], [3.814, 3.435, 3.039], JOHNSON_1974)
            }
            Self::Nickel => ("nickel", [1.990, 1.921, 1.729], [4.209, 3.616, 2.944], JOHNSON_1974),
            Self::Platinum => {
                ("platinum", [2.376, 2.085, 1.845], [4.265, 3.715, 3.136], RAKIC_1998)
            }
            Self::Brass => ("brass", [0.444, 0.527, 1.094], [3.695, 2.765, 1.829], QUERRY_1985),
            Self::Cobalt => ("cobalt", [2.237, 2.052, 1.737], [4.236, 3.824, 3.275], JOHNSON_1974),
            Self::Tungsten => {
                ("tungsten", [3.652, 3.506, 3.313], [2.795, 2.758, 2.605], RAKIC_1998)
            }
        }
    }

    /// The name in English, in lower case.
    #[must_use]
    pub const fn name(self) -> &'static str {
        self.row().0
    }

    /// The chemical symbol, of brass CuZn, as renderers name their spectra.
    #[must_use]
    pub const fn symbol(self) -> &'static str {
        match self {
            Self::Gold => "Au",
            Self::Silver => "Ag",
            Self::Copper => "Cu",
            Self::Aluminium => "Al",
            Self::Iron => "Fe",
            Self::Chromium => "Cr",
            Self::Titanium => "Ti",
            Self::Nickel => "Ni",
            Self::Platinum => "Pt",
            Self::Brass => "CuZn",
            Self::Cobalt => "Co",
            Self::Tungsten => "W",
        }
    }

    /// Index of refraction at 650, 550 and 450 nm: for red, green and blue.
    #[must_use]
    pub const fn eta(self) -> [f64; 3] {
        self.row().1
    }

    /// Extinction coefficient at 650, 550 and 450 nm: for red, green and blue.
    #[must_use]
    pub const fn k(self) -> [f64; 3] {
        self.row().2
    }

    /// The address of the publication: a DOI where it has one.
    #[must_use]
    pub const fn source(self) -> &'static str {
        self.row().3
    }
}

impl From<Metal> for Reflectance {
    fn from(metal: Metal) -> Self {
        Self::Conductor { eta: metal.eta(), k: metal.k() }
    }
}

impl fmt::Display for Metal {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

/// The error for a text that names no [`Metal`].
#[derive(Clone, Copy, PartialEq, Eq)]
pub struct UnknownMetal;

impl fmt::Display for UnknownMetal {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("the metal must be one of ")?;
        let [others @ .., last] = &Metal::ALL;
        for metal in others {
            write!(f, "{metal}, ")?;
        }
        write!(f, "{last}")
    }
}

microfacet_core::debug_in_words!(UnknownMetal);

impl core::error::Error for UnknownMetal {}

impl FromStr for Metal {
    type Err = UnknownMetal;

    /// The metal of that [`name`](Self::name) or [`symbol`](Self::symbol); "aluminum" is aluminium.
    fn from_str(name: &str) -> Result<Self, UnknownMetal> {
        if name == "aluminum" {
            return Ok(Self::Aluminium);
        }
        let of = |metal: &Self| metal.name() == name || metal.symbol() == name;
        Self::ALL.into_iter().find(of).ok_or(UnknownMetal)
    }
}

#[cfg(test)]
mod tests {
    use alloc::string::ToString;

    use super::Metal::*;
    use super::*;

    /// A metal, a wavelength in micrometres, and the rows of the published table on either side of
    /// it: wavelength, eta, k.
    #[expect(clippy::approx_constant, reason = "3.14 is measured")]
    const PUBLISHED: [(Metal, f64, [f64; 3], [f64; 3]); 36] = [
        (Gold, 0.65, [0.6168, 0.21, 3.272], [0.6595, 0.14, 3.697]),
        (Gold, 0.55, [0.5486, 0.43, 2.455], [0.5821, 0.29, 2.863]),
        (Gold, 0.45, [0.4305, 1.45, 1.948], [0.4509, 1.38, 1.914]),
        (Silver, 0.65, [0.6168, 0.06, 4.152], [0.6595, 0.05, 4.483]),
        (Silver, 0.55, [0.5486, 0.06, 3.586], [0.5821, 0.05, 3.858]),
        (Silver, 0.45, [0.4305, 0.04, 2.462], [0.4509, 0.04, 2.657]),
        (Copper, 0.65, [0.6168, 0.3, 3.205], [0.6595, 0.22, 3.747]),
        (Copper, 0.55, [0.5486, 1.02, 2.577], [0.5821, 0.7, 2.704]),
        (Copper, 0.45, [0.4305, 1.25, 2.305], [0.4509, 1.24, 2.397]),
        (Aluminium, 0.65, [0.61993, 1.366, 7.4052], [0.65225, 1.5724, 7.7354]),
        (Aluminium, 0.55, [0.5166, 0.8734, 6.2418], [0.56357, 1.0728, 6.7839]),
        (Aluminium, 0.45, [0.4428, 0.6079, 5.3676], [0.47687, 0.7278, 5.7781]),
        (Iron, 0.65, [0.617, 2.88, 3.05], [0.659, 2.92, 3.1]),
        (Iron, 0.55, [0.549, 2.95, 2.93], [0.582, 2.94, 2.99]),
        (Iron, 0.45, [0.431, 2.48, 2.71], [0.451, 2.59, 2.77]),
        (Chromium, 0.65, [0.617, 3.17, 3.3], [0.659, 3.09, 3.34]),
        (Chromium, 0.55, [0.549, 3.18, 3.33], [0.582, 3.22, 3.3]),
        (Chromium, 0.45, [0.431, 2.19, 3.04], [0.451, 2.33, 3.14]),
        (Titanium, 0.65, [0.617, 2.67, 3.72], [0.659, 2.76, 3.84]),
        (Titanium, 0.55, [0.549, 2.54, 3.43], [0.582, 2.6, 3.58]),
        (Titanium, 0.45, [0.431, 2.21, 3.01], [0.451, 2.27, 3.04]),
        (Nickel, 0.65, [0.617, 1.99, 4.02], [0.659, 1.99, 4.26]),
        (Nickel, 0.55, [0.549, 1.92, 3.61], [0.582, 1.96, 3.8]),
        (Nickel, 0.45, [0.431, 1.71, 2.82], [0.451, 1.73, 2.95]),
        (Platinum, 0.65, [0.64973, 2.3748, 4.2641], [0.66263, 2.4155, 4.3305]),
        (Platinum, 0.55, [0.54437, 2.0699, 3.683], [0.55518, 2.0984, 3.7451]),
        (Platinum, 0.45, [0.44722, 1.839, 3.1204], [0.4561, 1.8591, 3.1717]),
        (Brass, 0.65, [0.64, 0.444, 3.609], [0.65, 0.444, 3.695]),
        (Brass, 0.55, [0.54, 0.549, 2.668], [0.55, 0.527, 2.765]),
        (Brass, 0.45, [0.44, 1.191, 1.797], [0.45, 1.094, 1.829]),
        (Cobalt, 0.65, [0.617, 2.19, 4.11], [0.659, 2.25, 4.27]),
        (Cobalt, 0.55, [0.549, 2.05, 3.82], [0.582, 2.13, 3.96]),
        (Cobalt, 0.45, [0.431, 1.67, 3.17], [0.451, 1.74, 3.28]),
        (Tungsten, 0.65, [0.64973, 3.6517, 2.7955], [0.66263, 3.658, 2.7944]),
        (Tungsten, 0.55, [0.54437, 3.4949, 2.7528], [0.55518, 3.517, 2.7637]),
        (Tungsten, 0.45, [0.44722, 3.3086, 2.6004], [0.4561, 3.3227, 2.6154]),
    ];

    #[test]
    fn indices_are_the_published_ones_interpolated() {
        assert_eq!(PUBLISHED.len(), 3 * Metal::ALL.len());
        let wanted = Metal::ALL.into_iter().flat_map(|metal| [0, 1, 2].map(|i| (metal, i)));
        for ((metal, i), (of, wavelength, below, above)) in wanted.zip(PUBLISHED) {
            assert_eq!((of, wavelength), (metal, [0.65, 0.55, 0.45][i]));
            let ([from, eta0, k0], [to, eta1, k1]) = (below, above);
            assert!(from <= wavelength && wavelength <= to, "{metal} at {wavelength}");
            let t = (wavelength - from) / (to - from);
            let (eta, k) = (eta0 + t * (eta1 - eta0), k0 + t * (k1 - k0));
            // Rounded to three decimals.
            let near = |got: f64, want: f64| (got - want).abs() < 0.000_500_1;
            assert!(near(metal.eta()[i], eta), "{metal} at {wavelength}: eta is {eta}");
            assert!(near(metal.k()[i], k), "{metal} at {wavelength}: k is {k}");
        }
    }

    fn colour(metal: Metal) -> [f64; 3] {
        let (eta, k) = (metal.eta(), metal.k());
        [0, 1, 2].map(|i| {
            let square = |x: f64| x * x + k[i] * k[i];
            square(eta[i] - 1.0) / square(eta[i] + 1.0)
        })
    }

    #[test]
    fn metals_have_the_colours_that_they_are_known_for() {
        for metal in Metal::ALL {
            assert!(metal.eta().iter().chain(&metal.k()).all(|&x| x > 0.0), "{metal}");
        }
        // Yellow and red metals reflect little blue, and copper little green as well.
        for metal in [Gold, Copper, Brass] {
            let [r, g, b] = colour(metal);
            assert!(r > 0.85 && r > g && g > b && b < 0.6, "{metal}: {:?}", colour(metal));
        }
        assert!(colour(Gold)[1] > 0.75 && colour(Brass)[1] > 0.75 && colour(Copper)[1] < 0.65);
        // White metals, of which silver is the brightest.
        let within = |metal, low, high| colour(metal).iter().all(|&r| low < r && r < high);
        assert!(within(Silver, 0.97, 1.0), "{:?}", colour(Silver));
        assert!(within(Aluminium, 0.9, 0.93), "{:?}", colour(Aluminium));
        // Grey metals.
        for metal in [Iron, Chromium, Titanium, Nickel, Platinum, Cobalt, Tungsten] {
            assert!(within(metal, 0.45, 0.71), "{metal}: {:?}", colour(metal));
        }
    }

    #[test]
    fn names_are_read_back() {
        for metal in Metal::ALL {
            assert_eq!(metal.name().parse(), Ok(metal));
            assert_eq!(metal.symbol().parse(), Ok(metal));
            assert_eq!(metal.to_string(), metal.name());
        }
        assert_eq!("aluminum".parse(), Ok(Aluminium));
        for unknown in ["", "Gold", "AU", "steel", "gold "] {
            assert_eq!(unknown.parse::<Metal>(), Err(UnknownMetal), "{unknown:?}");
        }
        assert_eq!(
            UnknownMetal.to_string(),
            "the metal must be one of gold, silver, copper, aluminium, iron, chromium, titanium, \
             nickel, platinum, brass, cobalt, tungsten"
        );
    }
}
