//! The figures: their materials in rows and columns, and how these are made.

use std::error::Error;
use std::fmt::Write;

use clap::ValueEnum;
use microfacet_baker::cache::Cache;
use microfacet_baker::plan::{Options, Plan};
use microfacet_baker::progress::Meter;
use microfacet_baker::scene::Scene as Materials;
use microfacet_baker::table_set::{Settings, Target, bake_with};
use microfacet_baker::table_spec::Quality;
use microfacet_report::plot::{Content, Sheet, Tile, shape_name};
use microfacet_sampler::{
    AnyBsdf, BindError, BsdfSettings, Compensation, Conductor, ConductorFresnel, Dielectric,
    Masking, Metal, Plastic, Tables,
};
use microfacet_tables::Precision;

use crate::spheres::scene::{COLOURED, Floor, GREY, Scene};
use crate::spheres::sky::Sky;

/// A figure of Ribardière et al. 2017 (doi:10.1111/cgf.13137), or one of the tails.
#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum Figure {
    /// Aluminium, shape γ across, roughness σ down
    #[value(name = "7")]
    Roughness,
    /// Gold, plastic, diamond and aluminium, shape γ across; tilted lobes
    #[value(name = "8")]
    Materials,
    /// Light that one bounce returns of a white furnace, roughness σ across, shape γ down
    #[value(name = "9")]
    Energy,
    /// Gold under one small lamp, shape γ across
    Tails,
}

pub(crate) struct Spheres {
    /// The page, with captions and without pictures.
    pub(crate) sheet: Sheet,
    /// What its pictures show, row by row.
    pub(crate) scenes: Vec<Scene>,
    /// Whether radiance is shown as it is, with 1 as white, or under a shoulder.
    pub(crate) is_linear: bool,
}

/// The name of a row, and a sphere with its caption for each column.
type Row = (String, Vec<(Scene, String)>);

impl Spheres {
    fn new(
        groups: Vec<(usize, String)>,
        columns: Vec<String>,
        rows: Vec<Row>,
        is_linear: bool,
    ) -> Self {
        let mut scenes = Vec::new();
        let rows = rows.into_iter().map(|(name, spheres)| {
            let tile = |(scene, caption)| {
                scenes.push(scene);
                Tile { content: Content::Colors(Vec::new()), caption }
            };
            (name, spheres.into_iter().map(tile).collect())
        });
        let rows = rows.collect();
        let sheet = Sheet { groups, columns, rows, scale: None, edge: 0.0 };
        Self { sheet, scenes, is_linear }
    }
}

const SHAPES: [f64; 6] = [1.51, 1.65, 2.0, 4.0, 10.0, 50.0];
/// The number of shapes, from the first, that lose much light after one bounce.
const COMPENSATED: usize = 3;
const SIGMA: f64 = 0.3;
/// Brushed: rough around the vertical axis, smoother along it.
const BRUSHED: [f64; 2] = [0.7, 0.3];
/// Radians by which scales are turned about the horizontal.
const TILT: f64 = 0.5;
/// Indices of refraction.
const COAT: f64 = 1.5;
const DIAMOND: f64 = 2.42;
/// Albedo of the base under the coat.
const RED: [f32; 3] = [0.65, 0.04, 0.03];

impl Figure {
    pub(crate) fn spheres(self, meter: &Meter) -> Result<Spheres, Box<dyn Error>> {
        Ok(match self {
            Self::Roughness => roughness(&Tables::embedded())?,
            Self::Materials => materials(&tables(meter)?)?,
            Self::Energy => energy(&Tables::embedded())?,
            Self::Tails => tails(&Tables::embedded())?,
        })
    }
}

fn label(gamma: f64) -> String {
    format!("γ = {gamma}")
}

type Sphere = Result<(Scene, String), BindError>;

fn studio(material: impl Into<AnyBsdf>, floor: [[f32; 3]; 2]) -> Sphere {
    under(Sky::studio(), material, floor)
}

fn under(sky: Sky, material: impl Into<AnyBsdf>, floor: [[f32; 3]; 2]) -> Sphere {
    let floor = Some(Floor::new(floor)?);
    Ok((Scene { material: material.into(), floor, sky }, String::new()))
}

/// The embedded tables, and what they lack: albedos of dielectrics and of lobes that are not round.
/// Those are kept in the user's cache, so only the first run bakes.
fn tables(meter: &Meter) -> Result<Tables, Box<dyn Error>> {
    let mut recipe = String::new();
    let [x, y] = BRUSHED;
    for (i, gamma) in SHAPES.into_iter().enumerate() {
        // The albedo of a lobe that is not compensated is not needed.
        let is_compensated = i < COMPENSATED;
        if is_compensated {
            for eta in [COAT, DIAMOND] {
                write!(
                    recipe,
                    "[[material]]\nname = \"η {eta} γ {gamma}\"\nsigma = {SIGMA}\ngamma = {gamma:?}\n\
                     fresnel = {{ dielectric = {eta} }}\n"
                )?;
            }
        }
        let fresnel = if is_compensated { "fresnel = \"mirror\"\n" } else { "" };
        for tilt in [0.0, TILT] {
            let theta =
                if tilt > 0.0 { format!("theta = [{tilt}, 0, 0]\n") } else { String::new() };
            write!(
                recipe,
                "[[material]]\nname = \"{}\"\nsigma = [{x}, {y}]\ngamma = {gamma:?}\n{theta}{fresnel}",
                brushed(tilt, gamma)
            )?;
        }
    }
    let options = Options { embedded: true, ..Options::default() };
    let plan = Plan::new(&Materials::from_recipe_str(&recipe)?, options)?;
    let settings =
        Settings { cache: Cache::user(), progress: meter.clone(), ..Settings::default() };
    let target = Target::Quality(Quality::Draft, Precision::F32);
    Ok(bake_with(&plan, target, settings)?.set.with_fallback(&Tables::embedded()))
}

fn brushed(tilt: f64, gamma: f64) -> String {
    format!("brushed, tilt {tilt}, γ {gamma}")
}

fn row<T: Copy>(
    name: String,
    columns: &[T],
    sphere: impl Fn(T) -> Sphere,
) -> Result<Row, BindError> {
    Ok((name, columns.iter().map(|&column| sphere(column)).collect::<Result<_, _>>()?))
}

fn materials(tables: &Tables) -> Result<Spheres, BindError> {
    let settings = |compensation| BsdfSettings::new().compensated(compensation, tables);
    let gold = |(gamma, compensation)| {
        let lobe = tables.lobe(SIGMA, gamma)?;
        studio(Conductor::new(lobe, Metal::Gold, settings(compensation))?, GREY)
    };
    let plastic = |(gamma, compensation)| {
        let coat = tables.lobe(SIGMA, gamma)?;
        studio(Plastic::new(coat, COAT, RED, settings(compensation))?, GREY)
    };
    let diamond = |(gamma, compensation)| {
        let lobe = tables.lobe(SIGMA, gamma)?;
        studio(Dielectric::new(lobe, DIAMOND, settings(compensation))?, COLOURED)
    };
    let aluminium = |tilt| {
        move |(gamma, compensation)| {
            let lobe = tables.material(&brushed(tilt, gamma))?;
            studio(Conductor::new(lobe, Metal::Aluminium, settings(compensation))?, GREY)
        }
    };

    let single = SHAPES.map(|gamma| (gamma, Compensation::None));
    let compensated = SHAPES[..COMPENSATED].iter().map(|&gamma| (gamma, Compensation::KullaConty));
    let columns: Vec<_> = single.into_iter().chain(compensated).collect();
    let [x, y] = BRUSHED;
    let rows = vec![
        row(format!("Gold\nσ = {SIGMA}"), &columns, gold)?,
        row(format!("Plastic\nσ = {SIGMA}, η = {COAT}"), &columns, plastic)?,
        row(format!("Diamond\nσ = {SIGMA}, η = {DIAMOND}"), &columns, diamond)?,
        row(format!("Aluminium\nσ = ({x}, {y})"), &columns, aluminium(0.0))?,
        row(format!("Tilted\nthe same, by {TILT}"), &columns, aluminium(TILT))?,
    ];
    let groups = vec![
        (SHAPES.len(), "one bounce".into()),
        (COMPENSATED, "all bounces (Kulla–Conty)".into()),
    ];
    let headings = columns.iter().map(|(gamma, _)| label(*gamma)).collect();
    Ok(Spheres::new(groups, headings, rows, false))
}

fn roughness(tables: &Tables) -> Result<Spheres, BindError> {
    let each = |sigma: f64| {
        row(format!("σ = {sigma}"), &SHAPES, |gamma| {
            let lobe = tables.lobe(sigma, gamma)?;
            studio(Conductor::new(lobe, Metal::Aluminium, BsdfSettings::new())?, GREY)
        })
    };
    let rows = [0.05, 0.1, 0.3, 0.6, 1.0].into_iter().map(each).collect::<Result<_, _>>()?;
    let groups = vec![(SHAPES.len(), "Aluminium, one bounce".into())];
    Ok(Spheres::new(groups, SHAPES.map(label).into(), rows, false))
}

fn energy(tables: &Tables) -> Result<Spheres, BindError> {
    const SIGMAS: [f64; 6] = [0.01, 0.1, 0.3, 0.6, 1.0, 2.0];
    // As in the paper.
    let masking = Masking::Uncorrelated;
    let settings = BsdfSettings::new().with_masking(masking);
    let each = |gamma| {
        row(label(gamma), &SIGMAS, |sigma| {
            let lobe = tables.lobe(sigma, gamma)?;
            let material = Conductor::new(lobe, ConductorFresnel::mirror(), settings)?.into();
            let average = tables.albedo(sigma, gamma, masking)?.albedo_average();
            Ok((Scene { material, floor: None, sky: Sky::white() }, format!("{average:.3}")))
        })
    };
    let rows = SHAPES.into_iter().map(each).collect::<Result<_, _>>()?;
    let groups = vec![(SIGMAS.len(), "light that one bounce returns, F = 1".into())];
    let columns = SIGMAS.map(|sigma| format!("σ = {sigma}"));
    Ok(Spheres::new(groups, columns.into(), rows, true))
}

/// Shapes of one roughness, so that the core of the highlight is the same and the tail is not.
fn tails(tables: &Tables) -> Result<Spheres, BindError> {
    const SIGMA: f64 = 0.1;
    let shapes = [1.6, 2.0, 4.0, f64::INFINITY];
    let gold = |gamma| {
        let lobe = tables.lobe(SIGMA, gamma)?;
        under(Sky::one_lamp(), Conductor::new(lobe, Metal::Gold, BsdfSettings::new())?, GREY)
    };
    let rows = vec![row("Gold".into(), &shapes, gold)?];
    let groups = vec![(shapes.len(), format!("one roughness, σ = {SIGMA}"))];
    Ok(Spheres::new(groups, shapes.map(shape_name).into(), rows, false))
}
