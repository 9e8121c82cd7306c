//! Units of angles.

use std::f64::consts::FRAC_PI_2;

/// Unit of the angles in a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Angles {
    /// Radians.
    Radians,
    /// Degrees.
    Degrees,
}

impl Angles {
    /// The name of the unit, in the plural.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Radians => "radians",
            Self::Degrees => "degrees",
        }
    }

    /// An angle of this unit in radians.
    pub const fn to_radians(self, angle: f64) -> f64 {
        match self {
            Self::Radians => angle,
            Self::Degrees => angle.to_radians(),
        }
    }

    /// A polar angle in [0, π/2], in radians. An angle up to 1e-5 above π/2, such as 1.5708, counts
    /// as a rounded π/2.
    ///
    /// # Errors
    /// The range of the angle, and whether it may have been meant in degrees.
    pub fn polar(self, angle: f64) -> Result<f64, (&'static str, bool)> {
        let radians = self.to_radians(angle);
        if (0.0..=FRAC_PI_2 + 1e-5).contains(&radians) {
            return Ok(radians.min(FRAC_PI_2));
        }
        Err(match self {
            Self::Radians => ("in [0, pi/2 = 1.5708] radians", (0.0..=90.0).contains(&angle)),
            Self::Degrees => ("in [0, 90] degrees", false),
        })
    }

    /// An angle in radians as one of this unit.
    pub const fn from_radians(self, angle: f64) -> f64 {
        match self {
            Self::Radians => angle,
            Self::Degrees => angle.to_degrees(),
        }
    }
}
