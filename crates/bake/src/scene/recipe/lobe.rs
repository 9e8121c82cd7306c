//! The lobe of a material: its roughness, shape and tilt, or the distribution that replaces them.

use std::f64::consts::{FRAC_PI_2, TAU};
use std::fmt::Display;
use std::path::Path;

use crate::scene::limits;
use microfacet_model::Skew;
use microfacet_model::classic::Marginal;
use microfacet_tables::Interval;

use super::write::range;
use super::{MATERIAL_KEYS, MEASURED_KEYS, Source, Table, Value};
use crate::distribution::{Distribution, DistributionKind, Named};
use crate::input;
use crate::input::angles::Angles;
use crate::input::normals::{MeasuredError, read_csv};
use crate::scene::{LobeSpec, Place, Roughness, SceneError};
use crate::table_spec::GAMMA_MIN;

/// What a material says of its normals.
pub(super) type Lobe = LobeSpec<Distribution>;

impl Source<'_> {
    pub(super) fn lobe(&self, place: &Place, table: &Table<'_>) -> Result<Lobe, SceneError> {
        if let Some(value) = table.get("distribution") {
            return self.distribution(table, value);
        }
        self.only_keys(table, &MATERIAL_KEYS)?;
        let roughness = self.sigma(self.required(place, table, "sigma", "0.3")?)?;
        let gamma = self.gamma(self.required(place, table, "gamma", "2.0")?)?;
        let theta = match (table.get("theta"), table.get("degrees")) {
            (Some(value), _) => Some(self.theta(table, value, roughness, gamma)?),
            (None, Some(degrees)) => {
                return Err(self.place(degrees.span()).invalid(
                    "degrees is the unit of theta, and the material has no `theta`; remove degrees",
                ));
            }
            (None, None) => None,
        };
        Ok(Lobe { theta, ..Lobe::family(roughness, gamma) })
    }

    /// The lobe of a material with a named distribution; as a Student-t if it is one.
    fn distribution(&self, table: &Table<'_>, value: &Value<'_>) -> Result<Lobe, SceneError> {
        let place = self.place(value.span());
        let common = ["name", "distribution", "fresnel", "masking"];
        let distribution = if let Some(name) = value.get_ref().as_str() {
            let kind = DistributionKind::by_name(name).map_err(|e| place.invalid(e.to_string()))?;
            let keys: Vec<&str> = common.iter().chain(kind.parameters()).copied().collect();
            self.only_keys(table, &keys)?;
            let parameter = |key: &&str| {
                let value = table.get(*key).ok_or_else(|| {
                    place.invalid(format!(
                        "distribution \"{name}\" has no `{key}`; add for example {key} = {}",
                        // An exponent, or a width or a shape.
                        if *key == "n" { "50" } else { "0.3" }
                    ))
                })?;
                self.number(value, key)
            };
            let values = kind.parameters().iter().map(parameter).collect::<Result<_, _>>()?;
            Distribution::Named(Named { kind, values })
        } else {
            let forms = "distribution must be a name in quotes or { measured = \"file.csv\" }, in \
                         which degrees = true is for angles in degrees";
            let source = value.get_ref().as_table().ok_or_else(|| place.invalid(forms))?;
            self.only_keys(table, &common)?;
            self.only_keys(source, &MEASURED_KEYS)?;
            let angles = self.angles(source)?;
            let file = source.get("measured").and_then(|file| file.get_ref().as_str());
            let file = file.ok_or_else(|| place.invalid(forms))?;
            // Relative to the recipe's folder.
            let path = self.file.parent().unwrap_or(Path::new("")).join(file);
            let in_file = |why: &dyn Display| place.invalid(format!("{}: {why}", path.display()));
            let bytes = input::read(&path, limits::MEASURED).map_err(|e| in_file(&e))?;
            if !self.measured.take(bytes.len() as u64) {
                return Err(place.invalid(format!(
                    "the measured distributions of the recipe have more than {} MiB; split it",
                    limits::MEASURED >> 20
                )));
            }
            let measured = read_csv(&bytes[..], angles).map_err(|why| match why {
                MeasuredError::Degrees(_) => {
                    in_file(&format!("{why}: {{ measured = \"..\", degrees = true }}"))
                }
                why => in_file(&why),
            })?;
            Distribution::Measured { file: file.to_owned(), angles, table: measured }
        };
        let built = distribution.build().map_err(|e| place.invalid(e.to_string()))?;
        let lobe = |sigma, gamma, distribution| {
            let [sigma, gamma] = [sigma, gamma].map(Interval::point);
            Lobe { distribution, ..Lobe::family(Roughness::isotropic(sigma), gamma) }
        };
        Ok(match built.student_t() {
            Some(t) => lobe(t.sigma_x(), t.shape().gamma(), None),
            None => {
                if !self.distributions.take(1) {
                    return Err(place.invalid(format!(
                        "the recipe has more than {} materials with a distribution outside the \
                         Student-t family; split it",
                        limits::DISTRIBUTIONS
                    )));
                }
                lobe(Marginal::new(&*built).sigma(), 2.0, Some(distribution))
            }
        })
    }

    fn sigma(&self, value: &Value<'_>) -> Result<Roughness, SceneError> {
        let valid = |value: &Value<'_>| {
            let sigma = self.interval(value, "sigma")?;
            if sigma.min >= 0.0 && sigma.max < f64::INFINITY {
                Ok(sigma)
            } else {
                Err(self.place(value.span()).invalid(format!(
                    "sigma = {} is out of range; the roughness must be finite and 0 (smooth) or more",
                    range(sigma)
                )))
            }
        };
        let Some(pair) = value.get_ref().as_array() else {
            return Ok(Roughness::isotropic(valid(value)?));
        };
        let place = self.place(value.span());
        let [x, y] = &pair[..] else {
            return Err(place.invalid(format!(
                "sigma has {} values; an anisotropic roughness is [x, y]",
                pair.len()
            )));
        };
        let (x, y) = (valid(x)?, valid(y)?);
        match Roughness::anisotropic(x, y) {
            // A lobe that is rough along one axis only has no density: the distribution degenerates
            // to a line.
            Roughness::Anisotropic { .. } if x.max == 0.0 || y.max == 0.0 => Err(place.invalid(
                "sigma is 0 along one axis alone; make both more than 0, or write sigma = 0 for a smooth surface",
            )),
            roughness => Ok(roughness),
        }
    }

    fn gamma(&self, value: &Value<'_>) -> Result<Interval, SceneError> {
        let gamma = self.interval(value, "gamma")?;
        if gamma.min > 1.5 {
            return Ok(gamma);
        }
        Err(self.place(value.span()).invalid(format!(
            "gamma = {} is out of range; the shape must be more than 1.5, where the projected area \
             diverges, up to \"inf\" (Beckmann); tables cover it from {GAMMA_MIN} on",
            range(gamma)
        )))
    }

    /// The angles of an ellipsoid in radians, checked together with its σ and γ.
    fn theta(
        &self,
        table: &Table<'_>,
        value: &Value<'_>,
        roughness: Roughness,
        gamma: Interval,
    ) -> Result<[f64; 3], SceneError> {
        let place = self.place(value.span());
        let written = match value.get_ref().as_array().map(|array| &array[..]) {
            Some([x, y, z]) => {
                [self.number(x, "theta")?, self.number(y, "theta")?, self.number(z, "theta")?]
            }
            _ => {
                return Err(place.invalid(
                    "theta must be three angles about x, y and z, such as theta = [0.1, -0.2, 0.5] in radians; \
                     with degrees = true they are in degrees",
                ));
            }
        };
        let angles = self.angles(table)?;
        let theta = written.map(|angle| angles.to_radians(angle));
        let (x, y) = (roughness.x(), roughness.y());
        for (key, interval) in [("sigma", x), ("sigma", y), ("gamma", gamma)] {
            if !interval.is_point() {
                return Err(place.invalid(format!(
                    "theta with a range of {key}, {}: an ellipsoid needs single numbers; give {key} one",
                    range(interval)
                )));
            }
        }
        let doubt = (angles == Angles::Radians && look_like_degrees(theta)).then_some(
            "more than a quarter turn about x or y, or a whole turn about z; if it is in degrees, \
             add the line degrees = true",
        );
        let text = self.text.get(value.span()).unwrap_or("theta");
        if let Err(why) = Skew::new([x.min, y.min], theta) {
            let doubt = doubt.map_or(String::new(), |doubt| format!(" ({doubt})"));
            return Err(place.invalid(format!("theta = {text} with its sigma: {why}{doubt}")));
        }
        if let Some(doubt) = doubt {
            self.warn(&place, format!("theta = {text} radians is {doubt}"));
        }
        Ok(theta)
    }

    /// The unit of the angles in a table, by its key `degrees`.
    fn angles(&self, table: &Table<'_>) -> Result<Angles, SceneError> {
        match table.get("degrees").map(|value| (value, value.get_ref().as_bool())) {
            None | Some((_, Some(false))) => Ok(Angles::Radians),
            Some((_, Some(true))) => Ok(Angles::Degrees),
            Some((value, None)) => Err(self
                .place(value.span())
                .invalid("degrees must be true, or false for radians, without quotes")),
        }
    }
}

/// Whether angles in radians are larger than anyone needs: an ellipsoid looks the same half a turn
/// on.
fn look_like_degrees([x, y, z]: [f64; 3]) -> bool {
    let above = |angle: f64, most: f64| angle.is_finite() && angle.abs() > most + 1e-3;
    above(x, FRAC_PI_2) || above(y, FRAC_PI_2) || above(z, TAU)
}
