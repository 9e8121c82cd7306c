//! The view of one configuration, for `validate` and `sample`.

use clap::ArgGroup;

use super::values::{Unit, finite};
use super::{Result, warn};

/// Options for the direction of a view, next to `--sigma`.
#[derive(clap::Args)]
#[command(group(ArgGroup::new("unit").arg("degrees").requires("theta")))]
pub(super) struct View {
    /// Polar angle of the view, from the macro normal: 0 to pi/2, or to 90 with --degrees.
    #[arg(long, value_name = "T", value_parser = finite, requires = "sigma")]
    theta: Option<f64>,
    /// Azimuth of the view, from the x axis.
    #[arg(long, value_name = "P", value_parser = finite, default_value_t = 0.0, requires = "theta")]
    phi: f64,
    #[command(flatten)]
    unit: Unit,
}

impl View {
    /// theta and phi in radians; `None` without a theta. Warns if phi looks like degrees.
    pub(super) fn angles(&self) -> Result<Option<[f64; 2]>> {
        let Some(theta) = self.theta else { return Ok(None) };
        let angles = [self.unit.theta(theta)?, self.unit.phi(self.phi)?];
        self.unit.doubt(self.phi).iter().for_each(warn);
        Ok(Some(angles))
    }
}
