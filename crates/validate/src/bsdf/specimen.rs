//! BSDFs as data: they can be made, printed, and have their albedos baked.

use std::fmt;

use microfacet_baker::plan::{Options, Plan};
use microfacet_baker::scene::Scene;
use microfacet_baker::table_set::{Settings, Target, bake_with};
use microfacet_baker::table_spec::{GAMMA_MIN, Quality};
use microfacet_sampler::lobe::Smooth;
use microfacet_sampler::{
    AnyBsdf, BindError, BsdfSettings, Compensation, Conductor, ConductorFresnel, Dielectric, Ggx,
    Haze, Lobe, Masking, MaterialError, Metal, Plastic, Retroreflective, Skew, StandIn, Tables,
};
use microfacet_tables::Precision;

/// The lobe of a specimen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LobeOf {
    /// From the default tables.
    StudentT,
    /// From the default tables, with normals bounded for reflection.
    Bounded,
    /// In closed form; γ is 2.
    Ggx,
    /// Tilted and turned by three angles, radians.
    Ellipsoid([f64; 3]),
    /// σ = 0.
    Smooth,
}

/// The kind of a surface, with its reflectance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Surface {
    /// A conductor with F = 1.
    Mirror,
    /// A conductor with Schlick's reflectance.
    Schlick([f32; 3]),
    /// A conductor by Fresnel's equations.
    Metal(Metal),
    /// A dielectric of an index of refraction.
    Dielectric(f64),
    /// A coat of an index over a base.
    Plastic(f64, [f32; 3]),
}

/// Haze around a specimen: another lobe of the same kind and γ, a Student-t around a smooth core.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HazeOf {
    /// Its weight.
    pub weight: f32,
    /// σx and σy of its lobe.
    pub sigma: [f32; 2],
}

/// A BSDF as data.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Specimen {
    /// The lobe.
    pub lobe: LobeOf,
    /// σx and σy, as single precision has them.
    pub sigma: [f32; 2],
    /// γ.
    pub gamma: f64,
    /// The surface.
    pub surface: Surface,
    /// The form of masking.
    pub masking: Masking,
    /// The compensation.
    pub compensation: Compensation,
    /// Haze around it, if any.
    pub haze: Option<HazeOf>,
    /// The share of the light that goes back to where it came from.
    pub back: f32,
}

/// Why a specimen or its tables cannot be made.
#[derive(Debug, thiserror::Error)]
#[error("{0}")]
pub struct Unmade(String);

impl Unmade {
    pub(super) fn new(specimen: &Specimen, why: &dyn fmt::Display) -> Self {
        Self(format!("{specimen}: {why}"))
    }
}

impl Specimen {
    /// The lobe, from the default tables.
    ///
    /// # Errors
    /// [`Unmade`] for a shape that they do not cover.
    pub fn lobe_of_tables(&self) -> Result<Lobe, Unmade> {
        self.lobe().map_err(|why| Unmade::new(self, &why))
    }

    fn lobe(&self) -> Result<Lobe, MaterialError> {
        let tables = Tables::embedded();
        let sigma = self.sigma.map(f64::from);
        Ok(match self.lobe {
            LobeOf::StudentT => tables.student_t(sigma, self.gamma)?.into(),
            LobeOf::Bounded => tables.student_t(sigma, self.gamma)?.bounded().into(),
            LobeOf::Ggx => Ggx::new(self.sigma)?.into(),
            LobeOf::Ellipsoid(theta) => {
                let skew = Skew::new(sigma, theta).expect("angles within a right angle");
                tables.ellipsoid(skew, self.gamma)?.into()
            }
            LobeOf::Smooth => Smooth.into(),
        })
    }

    /// The specimen with γ times `factor`, within the family; GGX becomes a Student-t.
    #[must_use]
    pub fn reshaped(self, factor: f64) -> Self {
        let lobe = if self.lobe == LobeOf::Ggx { LobeOf::StudentT } else { self.lobe };
        // At least the smallest γ of the default tables; γ = ∞ stays ∞.
        Self { lobe, gamma: (self.gamma * factor).max(GAMMA_MIN), ..self }
    }

    /// Its facets alone, without a base and without compensation; of a plastic, none of whose light
    /// goes back, since they transmit.
    #[must_use]
    pub fn facets(self) -> Self {
        let (surface, back) = match self.surface {
            Surface::Plastic(eta, _) => (Surface::Dielectric(eta), 0.0),
            other => (other, self.back),
        };
        Self { surface, back, compensation: Compensation::None, ..self }
    }

    /// The parts that it is a mixture of, with the share of each: itself, or a core and its haze.
    /// Light that goes back does so from both.
    pub fn parts(self) -> Vec<(f32, Self)> {
        let core = Self { haze: None, back: 0.0, ..self };
        let Some(HazeOf { weight, sigma }) = self.haze else { return vec![(1.0, core)] };
        let lobe = if self.lobe == LobeOf::Smooth { LobeOf::StudentT } else { self.lobe };
        vec![(1.0 - weight, core), (weight, Self { lobe, sigma, ..core })]
    }

    /// The BSDF, with a dielectric's albedos from `tables`, a conductor's and the lobe from the
    /// default ones. The albedo of a round lobe stands in.
    ///
    /// # Errors
    /// [`Unmade`] where tables or parameters do not allow it.
    pub fn bsdf(&self, tables: &Tables) -> Result<AnyBsdf, Unmade> {
        self.bound(tables).map_err(|why| Unmade::new(self, &why))
    }

    fn bound(&self, tables: &Tables) -> Result<AnyBsdf, BindError> {
        let whole = match self.parts()[..] {
            [(_, core), (weight, haze)] => {
                Haze::new(core.part(tables)?, haze.part(tables)?, weight)?.into()
            }
            _ => self.part(tables)?,
        };
        match self.back {
            0.0 => Ok(whole),
            back => Ok(Retroreflective::new(whole, back)?.into()),
        }
    }

    fn part(&self, tables: &Tables) -> Result<AnyBsdf, BindError> {
        let lobe = self.lobe()?;
        let settings = BsdfSettings::new().with_masking(self.masking).with_stand_in(StandIn::Round);
        let dielectric = settings.compensated(self.compensation, tables);
        let fresnel = match self.surface {
            Surface::Mirror => ConductorFresnel::mirror(),
            Surface::Schlick(f0) => ConductorFresnel::schlick(f0)?,
            Surface::Metal(metal) => metal.into(),
            Surface::Dielectric(eta) => return Ok(Dielectric::new(lobe, eta, dielectric)?.into()),
            Surface::Plastic(eta, base) => {
                return Ok(Plastic::new(lobe, eta, base, dielectric)?.into());
            }
        };
        let tables = Tables::embedded();
        let conductor = settings.compensated(self.compensation, &tables);
        Ok(Conductor::new(lobe, fresnel, conductor)?.into())
    }

    /// σ and η of the albedos that are needed, of a round lobe; `None` if none are.
    fn wanted(&self) -> Option<[f64; 2]> {
        let eta = match self.surface {
            _ if self.compensation == Compensation::None => return None,
            Surface::Dielectric(eta) | Surface::Plastic(eta, _) => eta,
            _ => return None,
        };
        let [x, y] = self.sigma.map(f64::from);
        let area = match self.lobe {
            LobeOf::Smooth => return None,
            LobeOf::Ellipsoid(theta) => {
                let Skew { p, r, .. } = Skew::new([x, y], theta).ok()?;
                f64::from(p as f32) * f64::from(r as f32)
            }
            _ if x == y => return Some([x, eta]),
            _ => x * y,
        };
        Some([area.sqrt(), eta])
    }
}

/// The recipe of the dielectric albedos that some specimens need.
pub fn recipe(specimens: &[Specimen]) -> String {
    let material = |(i, ([sigma, eta], specimen)): (usize, ([f64; 2], &Specimen))| {
        let Specimen { gamma, masking, .. } = specimen;
        format!(
            "[[material]]\nname = \"{i}\"\nsigma = {sigma}\ngamma = {gamma}\n\
             fresnel = {{ dielectric = {eta} }}\nmasking = \"{masking}\"\n"
        )
    };
    // Specimens may share an interface, whose albedos are baked once.
    let mut wanted: Vec<([f64; 2], &Specimen)> = Vec::new();
    let parts: Vec<Specimen> =
        specimens.iter().flat_map(|one| one.parts()).map(|(_, part)| part).collect();
    for specimen in &parts {
        let Some(interface) = specimen.wanted() else { continue };
        let same = |(of, other): &([f64; 2], &Specimen)| {
            (*of, other.gamma, other.masking) == (interface, specimen.gamma, specimen.masking)
        };
        if !wanted.iter().any(same) {
            wanted.push((interface, specimen));
        }
    }
    wanted.into_iter().enumerate().map(material).collect()
}

/// The albedos that some specimens need, baked at a quality.
///
/// # Errors
/// [`Unmade`] if they cannot be baked.
pub fn tables(
    specimens: &[Specimen],
    quality: Quality,
    settings: Settings,
) -> Result<Tables, Unmade> {
    let recipe = recipe(specimens);
    if recipe.is_empty() {
        return Ok(Tables::embedded());
    }
    let failed = |why: &dyn fmt::Display| Unmade(format!("albedos of dielectrics: {why}"));
    let scene = Scene::from_recipe_str(&recipe).map_err(|why| failed(&why))?;
    // Their lobes are in the default set.
    let options = Options { embedded: true, ..Options::default() };
    let plan = Plan::new(&scene, options).map_err(|why| failed(&why))?;
    let target = Target::Quality(quality, Precision::F32);
    Ok(bake_with(&plan, target, settings).map_err(|why| failed(&why))?.set)
}

/// Prints the parameters by the names of a recipe.
impl fmt::Display for Specimen {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { lobe, sigma: [x, y], gamma, surface, masking, compensation, haze, back } = self;
        match surface {
            Surface::Mirror => f.write_str("mirror")?,
            Surface::Schlick(f0) => write!(f, "conductor of f0 {f0:?}")?,
            Surface::Metal(metal) => f.write_str(metal.name())?,
            Surface::Dielectric(eta) => write!(f, "dielectric of eta {eta}")?,
            Surface::Plastic(eta, base) => write!(f, "plastic of eta {eta} and base {base:?}")?,
        }
        if let Some(HazeOf { weight, sigma: [x, y] }) = haze {
            write!(f, " with haze of weight {weight} and sigma {x},{y}")?;
        }
        if *back > 0.0 {
            write!(f, ", {back} of it sent back")?;
        }
        match lobe {
            LobeOf::StudentT => f.write_str(", Student-t")?,
            LobeOf::Bounded => f.write_str(", bounded")?,
            LobeOf::Ggx => f.write_str(", GGX in closed form")?,
            LobeOf::Ellipsoid(theta) => write!(f, ", theta {theta:?}")?,
            LobeOf::Smooth => return f.write_str(", smooth"),
        }
        write!(f, ", sigma {x},{y}, gamma {gamma}, {masking}, {compensation:?}")
    }
}
