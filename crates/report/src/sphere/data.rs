//! What the page's script is given: tables of shapes and albedos, metals and materials.

use std::io::Write;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use flate2::Compression;
use flate2::write::DeflateEncoder;
use glam::Vec3;
use half::f16;
use microfacet_baker::escape;
use microfacet_core::Masking;
use microfacet_export::texture::{Along, Place, TexelAxis, place, shader_coordinates};
use microfacet_export::{Shape, WIDTH, append_some};
use microfacet_sampler::{ConductorFresnel, MaterialError, Metal, StudentT, Tables};
use microfacet_tables::{MaterialEntry, Reflectance};
use rayon::prelude::*;
use serde::Serialize;
use serde_json::{Value, json};

use super::super::subjects::{Shown, Subjects, shape};
use super::super::texts;
use super::scene::Look;

pub(super) const SIGMA: [f64; 2] = [0.01, 1.0];
/// Texels of albedos along roughness and view.
const TEXELS: [usize; 2] = [32, 48];
/// Averages along √σ from 1/48 on: at σ = 0, a mirror, nothing is lost.
const AVERAGES: usize = 48;
/// The metal of lobes that state no reflectance.
pub(super) const UNSTATED: Metal = Metal::Gold;

/// All that the script reads.
pub(super) struct Data {
    /// The names of reflectances, in their order.
    pub(super) reflectances: Vec<String>,
    /// JSON with `<` escaped, so that it cannot end its element.
    pub(super) json: String,
}

#[derive(Serialize)]
struct Choice {
    name: String,
    /// The complex index of refraction eta + i k; or F0 in `eta`, with k below 0.
    eta: [f64; 3],
    k: [f64; 3],
    /// The average of the reflectance over the hemisphere.
    average: [f32; 3],
}

pub(super) fn label(gamma: f64) -> String {
    match gamma {
        2.0 => format!("GGX ({})", shape(gamma)),
        f64::INFINITY => format!("Beckmann ({})", shape(gamma)),
        _ => shape(gamma),
    }
}

/// The shape that normals are drawn from for a stop: of the same or the next heavier tails.
fn drawn(subjects: &Subjects, gamma: f64) -> f64 {
    let mut heavier = subjects.slices.iter().copied().filter(|slice| *slice <= gamma);
    heavier.next_back().unwrap_or(gamma)
}

/// The index of the first stop that is not below γ, or of the last stop.
fn stop(subjects: &Subjects, gamma: f64) -> usize {
    subjects.stops.iter().position(|&stop| stop >= gamma).unwrap_or(subjects.stops.len() - 1)
}

/// Whether a lobe is shown with a reflectance that its material does not state.
pub(super) fn is_unstated(shown: &Shown) -> bool {
    shown.entry.as_ref().and_then(reflecting).is_none()
}

/// Whether a lobe is that of a dielectric, of which the sphere shows what it reflects.
pub(super) fn is_dielectric(shown: &Shown) -> bool {
    let states = shown.entry.as_ref().and_then(|entry| entry.fresnel);
    states.is_some_and(|fresnel| fresnel.middle_index().is_some())
}

/// The reflectance that a material states; of a dielectric, Schlick's with the same F0.
fn reflecting(entry: &MaterialEntry) -> Option<Reflectance> {
    let fresnel = entry.fresnel.filter(|fresnel| fresnel.side().is_none())?;
    Some(fresnel.middle_index().map_or(fresnel, |eta| {
        let root = (eta - 1.0) / (eta + 1.0);
        Reflectance::Schlick([root * root; 3])
    }))
}

/// The metal that a name mentions: "brushed aluminium".
pub(super) fn metal_of(name: &str) -> Option<Metal> {
    let name = name.to_lowercase();
    name.split(|c: char| !c.is_alphabetic()).find_map(|word| word.parse().ok())
}

/// The reflectance on the sphere: the material's own, of the metal in its name, or [`UNSTATED`].
fn fresnel(shown: &Shown) -> Reflectance {
    let own = shown.entry.as_ref().and_then(reflecting);
    own.unwrap_or_else(|| metal_of(&shown.name).unwrap_or(UNSTATED).into())
}

fn conductor(fresnel: Reflectance) -> ConductorFresnel {
    let made = match fresnel {
        Reflectance::Schlick(f0) => ConductorFresnel::schlick(f0.map(|f0| f0 as f32)),
        Reflectance::Conductor { eta, k } => ConductorFresnel::exact(eta, k),
        _ => Ok(ConductorFresnel::mirror()),
    };
    made.expect("files are checked when they are read")
}

impl Choice {
    fn new(name: &str, fresnel: Reflectance) -> Self {
        let (eta, k) = match fresnel {
            Reflectance::Schlick(f0) => (f0, [-1.0; 3]),
            Reflectance::Conductor { eta, k } => (eta, k),
            _ => ([1.0; 3], [-1.0; 3]),
        };
        Self { name: name.into(), eta, k, average: conductor(fresnel).average() }
    }

    fn is_same(&self, other: &Self) -> bool {
        (self.eta, self.k) == (other.eta, other.k)
    }
}

pub(super) fn look(subjects: &Subjects, shown: &Shown) -> Look {
    let gamma = subjects.stops[stop(subjects, shown.gamma)];
    Look {
        gamma,
        drawn: drawn(subjects, gamma),
        sigma: shown.sigma.map(|sigma| sigma.clamp(SIGMA[0], SIGMA[1])),
        fresnel: conductor(fresnel(shown)),
        compensated: true,
    }
}

/// The axes of albedos: roughness, then views.
pub(super) fn axes() -> [TexelAxis; 2] {
    let along = [Along::Roughness { largest: SIGMA[1] }, Along::view(3.0, 0.5)];
    std::array::from_fn(|i| TexelAxis::to_ends(along[i], TEXELS[i]))
}

pub(super) fn albedo_coordinates() -> String {
    let at = shader_coordinates(&axes(), f64::NAN, ["vec", ""]);
    format!(
        "vec2 albedo_coordinates(float gamma, float sigma, float mu) {{\n    return {at};\n}}\n"
    )
}

/// √(1 − E) of a shape at the texels, views fastest, and ln(1 − E_avg).
fn albedos(tables: &Tables, gamma: f64) -> Result<(Vec<f16>, Vec<f32>), MaterialError> {
    let masking = Masking::HeightCorrelated;
    let axes = axes();
    let mut lost = Vec::with_capacity(TEXELS.iter().product());
    for &s in &axes[0].texels {
        // One σ a row: binding an albedo takes as long as hundreds of lookups.
        let sigma = place(&axes, Place::of_shape(gamma), &[s, 0.0]).sigma.max(StudentT::SIGMAS[0]);
        let albedo = tables.albedo(sigma, gamma, masking)?;
        for &t in &axes[1].texels {
            let cos = place(&axes, Place::of_shape(gamma), &[s, t]).cos.unwrap_or(1.0) as f32;
            let v = Vec3::new((1.0 - cos * cos).max(0.0).sqrt(), 0.0, cos);
            lost.push(f16::from_f32(albedo.lost(v).sqrt()));
        }
    }
    let average = |i: usize| {
        let root = i as f64 / AVERAGES as f64;
        let albedo = tables.albedo(SIGMA[1] * root * root, gamma, masking)?;
        Ok(albedo.lost_average().max(f32::MIN_POSITIVE).ln())
    };
    Ok((lost, (1..=AVERAGES).map(average).collect::<Result<_, MaterialError>>()?))
}

impl Data {
    /// `tables` are those of the set, and of the default set where the set lacks them.
    pub(super) fn new(tables: &Tables, subjects: &Subjects) -> Result<Self, MaterialError> {
        let stops = &subjects.stops;
        let mut gammas = stops.clone();
        gammas.extend([2.0, f64::INFINITY].iter().filter(|gamma| !stops.contains(gamma)));
        let shapes: Vec<Shape> = gammas
            .par_iter()
            .map(|&gamma| Shape::bind(tables, gamma))
            .collect::<Result<_, MaterialError>>()?;
        let mut pairs = Vec::new();
        let places: Vec<usize> = shapes
            .iter()
            .map(|shape| {
                let is_slice = subjects.slices.contains(&shape.gamma);
                append_some(shape, |table| is_kept(table, is_slice), &mut pairs)
            })
            .collect();
        let place = |gamma| places[gammas.iter().position(|&g| g == gamma).expect("among them")];
        pairs.resize(pairs.len().next_multiple_of(WIDTH), [0.0; 2]);

        let made: Vec<(Vec<f16>, Vec<f32>)> = stops
            .par_iter()
            .map(|&gamma| albedos(tables, gamma))
            .collect::<Result<_, MaterialError>>()?;
        let (lost, averages): (Vec<_>, Vec<_>) = made.into_iter().unzip();

        let mut reflectances: Vec<Choice> =
            Metal::ALL.map(|metal| Choice::new(metal.name(), metal.into())).into();
        reflectances.push(Choice::new("mirror", Reflectance::Mirror));
        let material = |shown: &Shown| {
            let own = Choice::new(&texts::short(&shown.name), fresnel(shown));
            let known = reflectances.iter().position(|other| own.is_same(other));
            let reflectance = known.unwrap_or_else(|| {
                reflectances.push(own);
                reflectances.len() - 1
            });
            let (stop, sigma) = (stop(subjects, shown.gamma), look(subjects, shown).sigma);
            json!({ "stop": stop, "sigma": sigma, "reflectance": reflectance })
        };
        let materials: Vec<Value> = subjects.shown.iter().map(material).collect();
        let index = |gamma| stops.iter().position(|&stop| stop == gamma).expect("a slice");
        let of_stop = |&gamma: &f64| {
            json!({
                // None is ∞.
                "gamma": gamma.is_finite().then_some(gamma),
                "label": label(gamma),
                "shape": place(gamma),
                // The stop whose visible normals are drawn for it.
                "drawn": index(drawn(subjects, gamma)),
            })
        };
        let json = json!({
            // The width of the texture that holds the pairs of `export` for shaders.
            "width": WIDTH,
            "tables": packed(pairs.as_flattened().iter().map(|x| x.to_le_bytes())),
            "stops": stops.iter().map(of_stop).collect::<Vec<Value>>(),
            // Offsets of the tables of GGX and of Beckmann.
            "ggx": place(2.0),
            "beckmann": place(f64::INFINITY),
            "sigma": SIGMA,
            // √(1 − E) in half precision, by stop, roughness and view. For heavy tails 1 − E rises
            // as σ, so that the root is linear in the coordinate √σ.
            "lost": packed(lost.iter().flatten().map(|x| x.to_le_bytes())),
            "texels": TEXELS,
            // ln(1 − E_avg) by stop and at √(σ/σ_max) = 1/n, 2/n … 1.
            "averages": packed(averages.iter().flatten().map(|x| x.to_le_bytes())),
            "average_count": AVERAGES,
            "reflectances": reflectances,
            "materials": materials,
            "opening": subjects.opening(),
        });
        Ok(Self {
            json: escape::json(&json.to_string()).replace('<', "\\u003c"),
            reflectances: reflectances.into_iter().map(|choice| choice.name).collect(),
        })
    }
}

/// Which tables of a shape the page holds: all shapes are evaluated, but only slices are sampled.
fn is_kept(table: &str, is_slice: bool) -> bool {
    match table {
        "masking" => true,
        "slopes" | "across" | "heavy" => is_slice,
        _ => false,
    }
}

/// Numbers as text: deflated, with the bytes of equal weight together, in base64.
fn packed<const N: usize>(numbers: impl Iterator<Item = [u8; N]> + Clone) -> String {
    let planes = (0..N).flat_map(|i| numbers.clone().map(move |bytes| bytes[i]));
    let planes: Vec<u8> = planes.collect();
    let mut deflated = DeflateEncoder::new(Vec::new(), Compression::best());
    deflated.write_all(&planes).expect("memory");
    STANDARD.encode(deflated.finish().expect("memory"))
}
