//! The figures: which materials stand where, and how they are made.

use std::error::Error;
use std::fmt::Write;

use clap::ValueEnum;
use microfacet_baker::cache::Cache;
use microfacet_baker::plan::{Options, Plan};
use microfacet_baker::progress::Meter;
use microfacet_baker::scene::Scene as Materials;
use microfacet_baker::table_set::{Settings, Target, bake_with};
use microfacet_baker::table_spec::Quality;
use microfacet_sampler::{
    AnyBsdf, BindError, Compensation, Conductor, ConductorFresnel, Dielectric, Masking, Metal,
    Plastic, StandIn, Tables,
};
use microfacet_tables::Precision;

use crate::spheres::scene::{Floor, Scene};
use crate::spheres::sky::Sky;

/// A figure of Ribardière et al. 2017 (doi:10.1111/cgf.13137).
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
}

/// Spheres in rows and columns.
pub(crate) struct Sheet {
    pub(crate) columns: Vec<String>,
    /// Columns that stand together, from the left: how many, and their heading.
    pub(crate) groups: Vec<(usize, String)>,
    pub(crate) rows: Vec<Row>,
    /// Whether radiance is shown as it is, with 1 as white, or under a shoulder.
    pub(crate) is_linear: bool,
}

/// A row: a name, a line below it, and a sphere for each column.
pub(crate) struct Row {
    pub(crate) name: String,
    pub(crate) detail: String,
    pub(crate) cells: Vec<Cell>,
}

/// A sphere, and what stands below it.
pub(crate) struct Cell {
    pub(crate) scene: Scene,
    pub(crate) caption: String,
}

const SHAPES: [f64; 6] = [1.51, 1.65, 2.0, 4.0, 10.0, 50.0];
/// Of these one bounce loses much.
const COMPENSATED: usize = 3;
const SIGMA: f64 = 0.3;
/// Brushed: rough around the vertical axis, smoother along it.
const BRUSHED: [f64; 2] = [0.7, 0.3];
/// Radians by which scales are turned about the horizontal.
const TILT: f64 = 0.5;
/// Indices of refraction.
const COAT: f64 = 1.5;
const DIAMOND: f64 = 2.42;
/// Under the coat.
const RED: [f32; 3] = [0.65, 0.04, 0.03];

impl Figure {
    /// The figure, with a meter of the bake that some need.
    pub(crate) fn sheet(self, meter: &Meter) -> Result<Sheet, Box<dyn Error>> {
        Ok(match self {
            Self::Roughness => roughness(&Tables::embedded())?,
            Self::Materials => materials(&tables(meter)?)?,
            Self::Energy => energy(&Tables::embedded())?,
        })
    }
}

fn label(gamma: f64) -> String {
    format!("γ = {gamma}")
}

fn studio(material: impl Into<AnyBsdf>, floor: Floor) -> Cell {
    let scene = Scene { material: material.into(), floor: Some(floor), sky: Sky::studio() };
    Cell { scene, caption: String::new() }
}

/// The embedded tables, and what they lack: albedos of dielectrics and of lobes that are not round.
/// Those are kept in the user's cache, so only the first run bakes.
fn tables(meter: &Meter) -> Result<Tables, Box<dyn Error>> {
    let mut recipe = String::new();
    let [x, y] = BRUSHED;
    for (i, gamma) in SHAPES.into_iter().enumerate() {
        for eta in [COAT, DIAMOND] {
            write!(
                recipe,
                "[[material]]\nname = \"η {eta} γ {gamma}\"\nsigma = {SIGMA}\ngamma = {gamma:?}\n\
                 fresnel = {{ dielectric = {eta} }}\n"
            )?;
        }
        // The albedo of a lobe that is not compensated is not needed.
        let fresnel = if i < COMPENSATED { "fresnel = \"mirror\"\n" } else { "" };
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
    Ok(bake_with(&plan, target, settings)?.set.or_embedded())
}

fn brushed(tilt: f64, gamma: f64) -> String {
    format!("brushed, tilt {tilt}, γ {gamma}")
}

/// A row of a sphere for each column.
fn row<T: Copy>(
    [name, detail]: [String; 2],
    columns: &[T],
    cell: impl Fn(T) -> Result<Cell, BindError>,
) -> Result<Row, BindError> {
    let cells = columns.iter().map(|&column| cell(column)).collect::<Result<_, _>>()?;
    Ok(Row { name, detail, cells })
}

fn materials(tables: &Tables) -> Result<Sheet, BindError> {
    let exact = StandIn::Refused;
    let gold = |(gamma, compensation)| {
        let gold = Conductor::new(tables.lobe(SIGMA, gamma)?, Metal::Gold);
        Ok(studio(gold.compensated(tables, compensation, exact)?, Floor::GREY))
    };
    let plastic = |(gamma, compensation)| {
        let coat = tables.lobe(SIGMA, gamma)?;
        Ok(studio(Plastic::new(coat, COAT, RED, tables, compensation, exact)?, Floor::GREY))
    };
    let diamond = |(gamma, compensation)| {
        let diamond = Dielectric::new(tables.lobe(SIGMA, gamma)?, DIAMOND)?;
        Ok(studio(diamond.compensated(tables, compensation, exact)?, Floor::COLOURED))
    };
    let aluminium = |tilt| {
        move |(gamma, compensation)| {
            let aluminium =
                Conductor::new(tables.material(&brushed(tilt, gamma))?, Metal::Aluminium);
            Ok(studio(aluminium.compensated(tables, compensation, exact)?, Floor::GREY))
        }
    };

    let single = SHAPES.map(|gamma| (gamma, Compensation::None));
    let compensated = SHAPES[..COMPENSATED].iter().map(|&gamma| (gamma, Compensation::KullaConty));
    let columns: Vec<_> = single.into_iter().chain(compensated).collect();
    let [x, y] = BRUSHED;
    let name = |name: &str, detail: String| [name.to_string(), detail];
    Ok(Sheet {
        rows: vec![
            row(name("Gold", format!("σ = {SIGMA}")), &columns, gold)?,
            row(name("Plastic", format!("σ = {SIGMA}, η = {COAT}")), &columns, plastic)?,
            row(name("Diamond", format!("σ = {SIGMA}, η = {DIAMOND}")), &columns, diamond)?,
            row(name("Aluminium", format!("σ = ({x}, {y})")), &columns, aluminium(0.0))?,
            row(name("Tilted", format!("the same, by {TILT}")), &columns, aluminium(TILT))?,
        ],
        columns: columns.iter().map(|(gamma, _)| label(*gamma)).collect(),
        groups: vec![
            (SHAPES.len(), "one bounce".into()),
            (COMPENSATED, "all bounces (Kulla–Conty)".into()),
        ],
        is_linear: false,
    })
}

fn roughness(tables: &Tables) -> Result<Sheet, BindError> {
    let each = |sigma: f64| {
        row([format!("σ = {sigma}"), String::new()], &SHAPES, |gamma| {
            Ok(studio(Conductor::new(tables.lobe(sigma, gamma)?, Metal::Aluminium), Floor::GREY))
        })
    };
    Ok(Sheet {
        columns: SHAPES.map(label).into(),
        groups: vec![(SHAPES.len(), "Aluminium, one bounce".into())],
        rows: [0.05, 0.1, 0.3, 0.6, 1.0].into_iter().map(each).collect::<Result<_, _>>()?,
        is_linear: false,
    })
}

fn energy(tables: &Tables) -> Result<Sheet, BindError> {
    const SIGMAS: [f64; 6] = [0.01, 0.1, 0.3, 0.6, 1.0, 2.0];
    // As the paper has it.
    let masking = Masking::Uncorrelated;
    let each = |gamma| {
        row([label(gamma), String::new()], &SIGMAS, |sigma| {
            let white = Conductor::new(tables.lobe(sigma, gamma)?, ConductorFresnel::mirror());
            let material = white.with_masking(masking).into();
            let average = tables.albedo(sigma, gamma, masking)?.albedo_average();
            let scene = Scene { material, floor: None, sky: Sky::white() };
            Ok(Cell { scene, caption: format!("{average:.3}") })
        })
    };
    Ok(Sheet {
        columns: SIGMAS.map(|sigma| format!("σ = {sigma}")).into(),
        groups: vec![(SIGMAS.len(), "light that one bounce returns, F = 1".into())],
        rows: SHAPES.into_iter().map(each).collect::<Result<_, _>>()?,
        is_linear: true,
    })
}
