//! How fine tables are: three named qualities, and levels between and beyond them.

/// A named quality of tables.
#[derive(
    Clone, Copy, Debug, Default, PartialEq, Eq, Hash, serde::Serialize, serde::Deserialize,
)]
#[serde(rename_all = "snake_case")]
pub enum Quality {
    /// Small and rough: previews, tests.
    Draft,
    /// CDF error below 3e-5 where γ ≥ 1.8, G1 below 1e-5.
    #[default]
    Default,
    /// CDF error below 3e-6 where γ ≥ 1.8, G1 below 2e-6.
    High,
}

/// A level on the scale of qualities, in sixteenths of the step from one to the next:
/// [`Quality::Draft`] is level 0, [`Quality::Default`] 16 and [`Quality::High`] 32.
///
/// The numbers of nodes of the qualities were found by measuring; those of a level between two
/// qualities are geometric means, and beyond them they continue with the same ratio, so that the
/// axes of a table stay in balance.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Level(pub i32);

impl Level {
    /// Levels from one quality to the next.
    pub const STEP: i32 = 16;
    /// The level of [`Quality::Draft`].
    pub const DRAFT: Self = Self(0);
    /// The level of [`Quality::Default`].
    pub const DEFAULT: Self = Self(Self::STEP);

    /// Number of nodes at this level of an axis that has `counts` in the three qualities, but at
    /// least `least`.
    pub fn nodes(self, counts: [usize; 3], least: usize) -> usize {
        let count = self.between(counts.map(|count| count as f64)).round();
        (count as usize).max(least)
    }

    /// The geometric mean at this level of a quantity whose values in the three qualities are `at`.
    pub fn between(self, at: [f64; 3]) -> f64 {
        let first = usize::from(self.0 >= Self::STEP);
        let t = f64::from(self.0 - first as i32 * Self::STEP) / f64::from(Self::STEP);
        match t {
            // `pow` would round.
            0.0 => at[first],
            1.0 => at[first + 1],
            _ => at[first] * libm::pow(at[first + 1] / at[first], t),
        }
    }

    /// The finest quality that is no finer than this level, or [`Quality::Draft`].
    pub fn quality(self) -> Quality {
        match self.0 / Self::STEP {
            ..=0 => Quality::Draft,
            1 => Quality::Default,
            _ => Quality::High,
        }
    }

    /// Numbers of nodes of the family's tables.
    pub fn resolution(self) -> Resolution {
        Resolution {
            shapes: self.nodes([9, 21, 33], 5),
            peeled_shapes: self.nodes([7, 9, 13], 5),
            shadowing_shapes: self.nodes([17, 25, 49], 5),
            across_shapes: self.nodes([17, 33, 65], 5),
            shadowing_views: self.nodes([65, 97, 193], 9),
            peeled_shadowing_views: self.nodes([97, 161, 321], 9),
            // A multiple of eight cells, since knots of the axis are at eighths.
            views: self.nodes([24, 88, 320], 8).next_multiple_of(8) + 1,
            numbers: self.nodes([11, 21, 37], 5),
            across_numbers: self.nodes([17, 33, 65], 5),
        }
    }
}

impl From<Quality> for Level {
    fn from(quality: Quality) -> Self {
        Self(quality as i32 * Self::STEP)
    }
}

/// Numbers of nodes at a level.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Resolution {
    /// γ nodes where the whole distribution is tabulated.
    pub shapes: usize,
    /// γ nodes where the heavy part is peeled.
    pub peeled_shapes: usize,
    /// γ nodes of either shadowing table.
    pub shadowing_shapes: usize,
    /// γ nodes of the table of slopes across.
    pub across_shapes: usize,
    /// View nodes of the shadowing table where the whole distribution is tabulated.
    pub shadowing_views: usize,
    /// View nodes of the shadowing table where the heavy part is peeled: more of them, since for
    /// lobes next to γ = 3/2 most lie beyond the views at which masking changes.
    pub peeled_shadowing_views: usize,
    /// View nodes of the slope tables.
    pub views: usize,
    /// Nodes of one half of u₁.
    pub numbers: usize,
    /// Nodes of one half of u₂.
    pub across_numbers: usize,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn levels_meet_the_qualities_and_rise_between_and_beyond() {
        for (quality, views) in [(Quality::Draft, 25), (Quality::Default, 89), (Quality::High, 321)]
        {
            assert_eq!(Level::from(quality).resolution().views, views);
            assert_eq!(Level::from(quality).quality(), quality);
        }
        let views: Vec<usize> = (-64..64).map(|level| Level(level).resolution().views).collect();
        assert!(views.is_sorted() && views[0] == 9 && views[127] > 1000);
        assert_eq!(Level(8).nodes([25, 100, 400], 5), 50);
        // A level between qualities belongs to the coarser one.
        assert_eq!(
            [Level(-1), Level(15), Level(31)].map(Level::quality),
            [0, 0, 1].map(|q| [Quality::Draft, Quality::Default][q])
        );
    }
}
