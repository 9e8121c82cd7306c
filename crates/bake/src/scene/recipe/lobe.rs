//! The lobe of a material: its roughness, shape and tilt, or the distribution that replaces them.

use std::f64::consts::{FRAC_PI_2, TAU};
use std::fmt::Display;
use std::path::Path;

use microfacet_model::Skew;
use microfacet_model::classic::Marginal;
use microfacet_tables::Interval;

use super::write::range;
use super::{Beside, Entry, LOBE_KEYS, MEASURED_KEYS};
use crate::distribution::{Distribution, DistributionKind, Named};
use crate::input;
use crate::input::angles::Angles;
use crate::input::normals::{MeasuredError, read_csv};
use crate::scene::{LobeSpec, Roughness, SceneError, limits};
use crate::table_spec::GAMMA_MIN;

type Lobe = LobeSpec<Distribution>;

impl Entry<'_> {
    /// The lobe that a table describes beside its other keys; without a `gamma` of its own it has
    /// that of `core`.
    pub(super) fn lobe(
        self,
        [before, after]: Beside,
        core: Option<Interval>,
    ) -> Result<Lobe, SceneError> {
        if let Some(distribution) = self.field("distribution") {
            let common = [before, &["distribution"], after].concat();
            return distribution.distribution(self, &common);
        }
        self.only_keys(&[before, &LOBE_KEYS, after].concat())?;
        let roughness = self.required("sigma", "0.3")?.sigma()?;
        let gamma = match (self.field("gamma"), core) {
            (None, Some(core)) => core,
            _ => self.required("gamma", "2.0")?.gamma()?,
        };
        let theta = match (self.field("theta"), self.field("degrees")) {
            (Some(theta), _) => Some(theta.theta(self.angles()?, roughness, gamma)?),
            (None, Some(degrees)) => {
                return degrees.invalid(format!(
                    "degrees is the unit of theta, and the {} has no `theta`; remove degrees",
                    self.key
                ));
            }
            (None, None) => None,
        };
        Ok(Lobe { theta, ..Lobe::family(roughness, gamma) })
    }

    /// The lobe of a table with a `distribution`; of the family if the distribution is a member.
    fn distribution(self, material: Self, common: &[&str]) -> Result<Lobe, SceneError> {
        let distribution = if let Some(name) = self.text() {
            let kind = DistributionKind::by_name(name).or_else(|why| self.invalid(why))?;
            material.only_keys(&[common, kind.parameters()].concat())?;
            let parameter = |key: &&'static str| match material.field(key) {
                Some(value) => value.number(),
                // The example is of an exponent, or else of a width or a shape.
                None => self.invalid(format!(
                    "distribution \"{name}\" has no `{key}`; add for example {key} = {}",
                    if *key == "n" { "50" } else { "0.3" }
                )),
            };
            let values = kind.parameters().iter().map(parameter).collect::<Result<_, _>>()?;
            Distribution::Named(Named { kind, values })
        } else {
            material.only_keys(common)?;
            self.measured()?
        };
        let built = distribution.build().or_else(|why| self.invalid(why))?;
        let lobe = |sigma, gamma, distribution| {
            let [sigma, gamma] = [sigma, gamma].map(Interval::point);
            Lobe { distribution, ..Lobe::family(Roughness::isotropic(sigma), gamma) }
        };
        if let Some(t) = built.student_t() {
            return Ok(lobe(t.sigma_x(), t.shape().gamma(), None));
        }
        if !self.source.distributions.take(1) {
            return self.invalid(format!(
                "the recipe has more than {} materials with a distribution outside the Student-t \
                 family; split it",
                limits::DISTRIBUTIONS
            ));
        }
        Ok(lobe(Marginal::new(&*built).sigma(), 2.0, Some(distribution)))
    }

    /// The distribution in a file, relative to the recipe's folder.
    fn measured(self) -> Result<Distribution, SceneError> {
        self.only_keys(&MEASURED_KEYS)?;
        let Some(file) = self.field("measured").and_then(Entry::text) else {
            return self.expected(
                "a name in quotes or { measured = \"file.csv\" }, in which degrees = true is for \
                 angles in degrees",
            );
        };
        let angles = self.angles()?;
        let path = self.source.file.parent().unwrap_or(Path::new("")).join(file);
        let in_file = |why: &dyn Display| self.error(format!("{}: {why}", path.display()));
        let bytes = input::read(&path, limits::MEASURED).map_err(|why| in_file(&why))?;
        if !self.source.measured.take(bytes.len() as u64) {
            return self.invalid(format!(
                "the measured distributions of the recipe have more than {} MiB; split it",
                limits::MEASURED >> 20
            ));
        }
        let table = read_csv(&bytes[..], angles).map_err(|why| match why {
            MeasuredError::Degrees(_) => {
                in_file(&format!("{why}: {{ measured = \"..\", degrees = true }}"))
            }
            why => in_file(&why),
        })?;
        Ok(Distribution::Measured { file: file.to_owned(), angles, table })
    }

    fn sigma(self) -> Result<Roughness, SceneError> {
        let one = |value: Self| {
            let sigma = value.interval()?;
            if sigma.min >= 0.0 && sigma.max < f64::INFINITY {
                return Ok(sigma);
            }
            value.out_of_range("finite and 0 (smooth) or more")
        };
        if self.list().is_none() {
            return Ok(Roughness::isotropic(one(self)?));
        }
        let Some([x, y]) = self.list_of() else {
            return self.expected("a number, or [x, y] for an anisotropic roughness");
        };
        let (x, y) = (one(x)?, one(y)?);
        let roughness = Roughness::anisotropic(x, y);
        // A lobe that is rough along one axis only has no density: the distribution degenerates to
        // a line.
        if !roughness.is_isotropic() && (x.max == 0.0 || y.max == 0.0) {
            return self.invalid(
                "sigma is 0 along one axis alone; make both more than 0, or write sigma = 0 for a \
                 smooth surface",
            );
        }
        Ok(roughness)
    }

    fn gamma(self) -> Result<Interval, SceneError> {
        let gamma = self.interval()?;
        if gamma.min > 1.5 {
            return Ok(gamma);
        }
        self.out_of_range(&format!(
            "more than 1.5, where the projected area diverges, up to \"inf\" (Beckmann); tables \
             cover it from {GAMMA_MIN} on"
        ))
    }

    /// The angles of an ellipsoid in radians, checked together with its σ and γ.
    fn theta(
        self,
        unit: Angles,
        roughness: Roughness,
        gamma: Interval,
    ) -> Result<[f64; 3], SceneError> {
        let Some([x, y, z]) = self.list_of() else {
            return self.expected(
                "three angles about x, y and z, in radians or with degrees = true in degrees, such \
                 as theta = [0.1, -0.2, 0.5]",
            );
        };
        let theta = [x.number()?, y.number()?, z.number()?].map(|angle| unit.to_radians(angle));
        let (x, y) = (roughness.x(), roughness.y());
        for (key, interval) in [("sigma", x), ("sigma", y), ("gamma", gamma)] {
            if !interval.is_point() {
                return self.invalid(format!(
                    "theta with a range of {key}, {}: an ellipsoid needs single numbers; give \
                     {key} one",
                    range(interval)
                ));
            }
        }
        let doubt = (unit == Angles::Radians && look_like_degrees(theta)).then_some(
            "more than a quarter turn about x or y, or a whole turn about z; if it is in degrees, \
             add the line degrees = true",
        );
        let written = self.written();
        if let Err(why) = Skew::new([x.min, y.min], theta) {
            let doubt = doubt.map_or(String::new(), |doubt| format!(" ({doubt})"));
            return self.invalid(format!("theta = {written} with its sigma: {why}{doubt}"));
        }
        if let Some(doubt) = doubt {
            let warning = format!("{}: theta = {written} radians is {doubt}", self.place());
            self.source.warnings.borrow_mut().push(warning);
        }
        Ok(theta)
    }

    /// The unit of the angles in a table, by its key `degrees`.
    fn angles(self) -> Result<Angles, SceneError> {
        let Some(degrees) = self.field("degrees") else { return Ok(Angles::Radians) };
        match degrees.value.get_ref().as_bool() {
            Some(false) => Ok(Angles::Radians),
            Some(true) => Ok(Angles::Degrees),
            None => degrees.expected("true, or false for radians, without quotes"),
        }
    }
}

/// Whether angles in radians are larger than needed: an ellipsoid is the same after half a turn.
fn look_like_degrees([x, y, z]: [f64; 3]) -> bool {
    let above = |angle: f64, most: f64| angle.is_finite() && angle.abs() > most + 1e-3;
    above(x, FRAC_PI_2) || above(y, FRAC_PI_2) || above(z, TAU)
}
