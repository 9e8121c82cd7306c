//! Colours and dashes: each follows from what a curve is, so that it means one thing in every
//! figure, in print without colours as well.

use microfacet_baker::distribution::DistributionKind;

pub(super) type Color = [u8; 3];

pub(super) const BLACK: Color = [0, 0, 0];
pub(super) const WHITE: Color = [255, 255, 255];
pub(super) const GRID: Color = [220, 220, 220];

/// What a curve or a point is; its colour follows, and the dash of a curve.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Key {
    /// A distribution of this kind.
    Kind(DistributionKind),
    /// The family at this γ, where a figure compares shapes.
    Gamma(f64),
    /// The family at this σ, where a figure compares roughnesses.
    Sigma(f64),
    /// One of a figure's own list, by its index there; colours repeat after ten.
    Nth(usize),
}

/// The dash of a curve; curves that cover each other have different dashes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Dash {
    /// Without gaps.
    #[default]
    Solid,
    /// Long dashes, drawn over solid curves.
    LongDashed,
    /// Dashes, drawn over longer ones.
    Dashed,
    /// Dashes and dots in turn.
    DashDotted,
    /// Dashes with two dots after each.
    DashDotDotted,
    /// Dots, drawn over all lines with dashes.
    Dotted,
    /// No line, but a small dot at each point: what was drawn at random, or measured.
    Points,
}

impl Dash {
    /// In the order in which curves are drawn, the last over all others.
    pub(super) const ORDER: [Self; 7] = [
        Self::Solid,
        Self::LongDashed,
        Self::Dashed,
        Self::DashDotted,
        Self::DashDotDotted,
        Self::Dotted,
        Self::Points,
    ];

    /// Lengths of dashes and gaps in turn, in widths of the line; none if there are no gaps.
    pub(super) fn lengths(self) -> &'static [f64] {
        match self {
            Self::Solid | Self::Points => &[],
            Self::LongDashed => &[7.0, 2.0],
            Self::Dashed => &[3.5, 2.0],
            Self::DashDotted => &[5.0, 1.6, 1.2, 1.6],
            Self::DashDotDotted => &[5.0, 1.4, 1.2, 1.4, 1.2, 1.4],
            Self::Dotted => &[1.2, 1.5],
        }
    }
}

// The palette of Okabe and Ito 2008, made for all kinds of colour vision, with its yellow darkened
// for white paper; three of Tol's, and a brown.
const BLUE: Color = [0, 114, 178];
const SKY: Color = [86, 180, 233];
const GREEN: Color = [0, 158, 115];
const ORANGE: Color = [230, 159, 0];
const VERMILLION: Color = [213, 94, 0];
const PURPLE: Color = [204, 121, 167];
const OLIVE: Color = [150, 140, 0];
const WINE: Color = [136, 34, 85];
const GREY: Color = [110, 110, 110];
const INDIGO: Color = [51, 34, 136];
const BROWN: Color = [120, 70, 20];

/// γ from dark to light through the hues of viridis, its yellow darkened.
const GAMMAS: [Color; 5] =
    [[60, 0, 90], [45, 85, 190], [0, 150, 150], [85, 170, 60], [250, 170, 40]];
/// σ from dark to light, in hues that no γ has.
const SIGMAS: [Color; 5] =
    [[50, 10, 20], [125, 15, 40], [195, 35, 70], [230, 95, 125], [245, 165, 180]];

/// The colours of a list whose entries have no colour elsewhere.
const NTH: [Color; 10] = [BLUE, VERMILLION, GREEN, PURPLE, ORANGE, SKY, OLIVE, WINE, BLACK, GREY];

/// False colours from black through violet and orange to a pale yellow, each lighter than the last.
const FALSE: [Color; 5] =
    [[0, 0, 4], [80, 18, 123], [182, 54, 121], [251, 136, 97], [252, 253, 191]];

/// The false colour of NaN: a hue that no number has.
pub(super) const NOT_A_NUMBER: Color = SKY;

/// The false colour at a fraction of a scale; beyond its ends, that of the end.
pub(super) fn false_color(fraction: f64) -> Color {
    between(&FALSE, fraction)
}

impl Key {
    /// Of the tables of this project, in a list of ways to compute something.
    pub const TABLE: Self = Self::Nth(0);
    /// Of what is in no list.
    pub const OTHER: Self = Self::Nth(9);

    pub(super) fn color(self) -> Color {
        match self {
            Self::Kind(kind) => match kind {
                DistributionKind::Beckmann => BLACK,
                DistributionKind::Gauss => BLUE,
                DistributionKind::TrowbridgeReitz => VERMILLION,
                DistributionKind::Gtr => INDIGO,
                DistributionKind::BlinnPhong => GREEN,
                DistributionKind::Schlick => SKY,
                DistributionKind::Sawicki => PURPLE,
                DistributionKind::StudentT => WINE,
                DistributionKind::HyperCauchy => ORANGE,
                DistributionKind::AshikhminShirley => GREY,
                DistributionKind::Haze => OLIVE,
                DistributionKind::Abc => BROWN,
            },
            // In ln(γ − 3/2) shapes near the pole are as far apart as those near Beckmann's limit.
            Self::Gamma(gamma) => {
                let place = (libm::log10((gamma - 1.5).max(1e-3)) + 1.3) / 3.3;
                between(&GAMMAS, place)
            }
            Self::Sigma(sigma) => between(&SIGMAS, sigma / 1.2),
            Self::Nth(i) => NTH[i % NTH.len()],
        }
    }

    /// The dash of a curve that no figure chooses otherwise: GGX is dashed and Beckmann dotted,
    /// whether they are a shape γ or a distribution by name, and shapes between have their own.
    pub(super) fn dash(self) -> Dash {
        match self {
            Self::Kind(DistributionKind::TrowbridgeReitz) => Dash::Dashed,
            Self::Kind(DistributionKind::Beckmann) => Dash::Dotted,
            Self::Gamma(gamma) if gamma < 2.0 => Dash::Solid,
            Self::Gamma(2.0) => Dash::Dashed,
            Self::Gamma(gamma) if gamma <= 4.0 => Dash::DashDotted,
            Self::Gamma(gamma) if gamma.is_finite() => Dash::LongDashed,
            Self::Gamma(_) => Dash::Dotted,
            _ => Dash::Solid,
        }
    }
}

/// The colour on a dark page that replaces one on white: the darker it is, the more white is mixed
/// in, so that ramps keep their order.
pub(super) fn on_dark(color: Color) -> Color {
    /// The share of white that is mixed into black.
    const WHITE: f64 = 0.42;
    let [r, g, b] = color.map(f64::from);
    let light = (0.2126 * r + 0.7152 * g + 0.0722 * b) / 255.0;
    let part = WHITE * (1.0 - light);
    color.map(|c| (f64::from(c) + (255.0 - f64::from(c)) * part).round() as u8)
}

/// The colour of a ramp from its first stop at 0 to its last at 1; beyond, of the nearer end.
fn between(stops: &[Color; 5], place: f64) -> Color {
    let at = place.clamp(0.0, 1.0) * 4.0;
    let cell = (at as usize).min(3);
    let t = at - cell as f64;
    std::array::from_fn(|i| {
        let [a, b] = [stops[cell][i], stops[cell + 1][i]].map(f64::from);
        (a + (b - a) * t).round() as u8
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Relative luminance of WCAG 2, with the 0.05 that its contrast adds.
    fn luminance(color: Color) -> f64 {
        let linear = color.map(|c| {
            let c = f64::from(c) / 255.0;
            if c <= 0.04045 { c / 12.92 } else { ((c + 0.055) / 1.055).powf(2.4) }
        });
        0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2] + 0.05
    }

    /// Contrast with white paper.
    fn contrast(color: Color) -> f64 {
        1.05 / luminance(color)
    }

    #[test]
    fn kinds_differ_in_colour_and_stand_out_from_paper() {
        let kinds = DistributionKind::ALL.map(|kind| Key::Kind(kind).color());
        for (i, a) in kinds.iter().enumerate() {
            assert!(kinds[..i].iter().all(|b| a != b), "{:?}", DistributionKind::ALL[i]);
        }
        let ramps = [0.0, 0.2, 0.4, 0.6, 0.8, 1.0, 1.2].map(|x| Key::Sigma(x).color());
        let gammas = [1.5, 1.6, 2.0, 3.0, 40.0, f64::INFINITY].map(|x| Key::Gamma(x).color());
        for color in kinds.into_iter().chain(ramps).chain(gammas) {
            assert!(contrast(color) > 1.8, "{color:?}: {}", contrast(color));
        }
    }

    #[test]
    fn colours_for_dark_paper_stand_out_from_it_and_differ() {
        let steps = || (0..=40).map(|i| f64::from(i) / 40.0);
        let gammas = steps().map(|x| Key::Gamma(1.5 + libm::exp10(4.0 * x - 2.0)));
        let kinds = DistributionKind::ALL.map(Key::Kind).map(Key::color);
        let keys =
            gammas.chain(steps().map(|x| Key::Sigma(1.2 * x))).chain((0..NTH.len()).map(Key::Nth));
        for color in keys.map(Key::color).chain(kinds) {
            let contrast = luminance(on_dark(color)) / luminance([0x11; 3]);
            assert!(contrast >= 3.0, "{color:?}: {contrast}");
        }
        for (i, a) in kinds.iter().enumerate() {
            assert!(kinds[..i].iter().all(|b| on_dark(*a) != on_dark(*b)), "{a:?}");
        }
        for ramp in [GAMMAS, SIGMAS] {
            let light: Vec<f64> = steps().map(|x| luminance(on_dark(between(&ramp, x)))).collect();
            assert!(light.windows(2).all(|pair| pair[0] < pair[1]), "{light:?}");
        }
    }

    #[test]
    fn ramps_grow_lighter_so_that_they_are_read_without_hues() {
        for ramp in [GAMMAS, SIGMAS, FALSE] {
            let light: Vec<f64> =
                (0..=40).map(|i| 1.0 / contrast(between(&ramp, f64::from(i) / 40.0))).collect();
            assert!(light.windows(2).all(|pair| pair[0] < pair[1]), "{light:?}");
        }
    }

    #[test]
    fn shapes_are_told_apart_by_dashes_and_a_distribution_has_that_of_its_shape() {
        let shapes = [1.6, 2.0, 4.0, 5.0, f64::INFINITY].map(|gamma| Key::Gamma(gamma).dash());
        for (i, dash) in shapes.iter().enumerate() {
            assert!(!shapes[..i].contains(dash), "{dash:?}");
        }
        let kinds = [DistributionKind::TrowbridgeReitz, DistributionKind::Beckmann];
        assert_eq!(kinds.map(|kind| Key::Kind(kind).dash()), [shapes[1], shapes[4]]);
        assert!(Dash::ORDER.iter().all(|dash| dash.lengths().len().is_multiple_of(2)));
    }

    #[test]
    fn ramps_go_from_their_first_colour_to_their_last() {
        let ends = [1.5, f64::INFINITY].map(|gamma| Key::Gamma(gamma).color());
        assert_eq!(ends, [GAMMAS[0], GAMMAS[4]]);
        assert_eq!([0.0, 9.0].map(|sigma| Key::Sigma(sigma).color()), [SIGMAS[0], SIGMAS[4]]);
    }
}
