//! The live sphere: data, shaders and pictures of it.
//!
//! The page draws with the functions that `export glsl-es` writes and the tables of the set, and
//! shows pictures of the same scene where there is no WebGL 2. `studio` lights it, `scene` draws it
//! in Rust, `data` is what the script gets; `sphere.frag` draws it in a browser.

mod data;
mod lobe;
mod random;
mod scene;
mod studio;
mod tone;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use jpeg_encoder::{ColorType, Encoder};
use maud::{Markup, PreEscaped, html};
use microfacet_baker::progress::{Meter, Stage};
use microfacet_export::for_webgl;
use microfacet_sampler::{BindError, Masking, Tables};

use super::scripts::verbatim;
use super::subjects::{Shown, Subjects};
use super::texts;
use super::{ReportError, Source};
use data::{Data, SIGMA, UNSTATED, is_dielectric, is_unstated, label, look};
use scene::Scene;
pub use scene::{Film, Look, tangent_frame};
pub use tone::srgb;

/// Pictures of lobes, one of which replaces the sphere where there is no WebGL 2. With 96 samples
/// the page of the default set takes a third longer, and the noise is four fifths as large.
const PICTURE: Film = Film { size: 240, samples: SAMPLES, seed: 1 };
/// Quality of JPEG, below which the encoder halves the resolution of colours.
const QUALITY: u8 = 90;
/// Pictures take most of the time of a page; unit tests check none.
const SAMPLES: u32 = if cfg!(test) { 3 } else { 64 };
/// Seconds of a picture on one processor, and of the tables of a shape.
const SECONDS: [f64; 2] = [1.7, 0.05];

/// What the section of the sphere is made of.
pub(super) struct Parts {
    /// Canvas, controls and pictures.
    pub(super) body: Markup,
    /// What the script reads, at the end of the page.
    pub(super) data: Markup,
    /// The script.
    pub(super) script: &'static str,
}

/// The estimated seconds of [`parts`] on the current threads.
pub(super) fn seconds(set: &Tables) -> f64 {
    let subjects = Subjects::of(set);
    let work = [subjects.shown.len(), subjects.stops.len()];
    let seconds: f64 = work.iter().zip(SECONDS).map(|(&n, each)| n as f64 * each).sum();
    seconds / rayon::current_num_threads() as f64
}

/// The section of the sphere; `None` for a set without a lobe of the family.
///
/// # Errors
/// [`ReportError::Material`] for a set that lacks what it declares to cover.
pub(super) fn parts(
    source: &Source,
    subjects: &Subjects,
    meter: &Meter,
) -> Result<Option<Parts>, ReportError> {
    if subjects.shown.is_empty() || subjects.stops.is_empty() {
        return Ok(None);
    }
    let tables = source.set.clone().with_fallback(&Tables::embedded());
    let stage = meter.stage(seconds(source.set));
    stage.split(subjects.shown.len());
    let data = Data::new(&tables, subjects)?;
    let pictures = pictures(&tables, subjects, &stage)?;
    let first = &subjects.shown[subjects.opening()];
    let stills = lobe::stills(&tables, &look(subjects, first), &first.name)?;
    let body = html! {
        div.look {
            (stage_of(&pictures[subjects.opening()], &first.name))
            div.panel {
                (controls(subjects, &data))
                div.lobe { (lobe::live()) (stills) }
            }
        }
        (gallery(subjects, &pictures))
        (differences(subjects))
    };
    Ok(Some(Parts { body, data: data_of(&data), script: SCRIPT }))
}

/// Pictures as data URLs, one for each lobe.
fn pictures(
    tables: &Tables,
    subjects: &Subjects,
    stage: &Stage,
) -> Result<Vec<String>, ReportError> {
    let picture = |shown| {
        let scene = Scene::new(tables, &look(subjects, shown)).map_err(unbound)?;
        let mut file = Vec::new();
        let size = PICTURE.size as u16;
        Encoder::new(&mut file, QUALITY)
            .encode(scene.picture(PICTURE).as_flattened(), size, size, ColorType::Rgb)
            .expect("whole lines, in memory");
        stage.step();
        Ok(format!("data:image/jpeg;base64,{}", STANDARD.encode(file)))
    };
    subjects.shown.iter().map(picture).collect()
}

/// Round lobes stand in for others, so that a metal fails to bind for a missing shape only.
fn unbound(why: BindError) -> ReportError {
    match why {
        BindError::Material(why) => ReportError::Material(why),
        other => panic!("a metal of a round lobe is always bound: {other}"),
    }
}

/// The picture of the sphere, and over it the canvas that takes its place once it is as clean.
fn stage_of(picture: &str, name: &str) -> Markup {
    html! {
        div.stage {
            img #sphere-still src=(picture) alt={ "A sphere of " (texts::short(name)) }
                width=(PICTURE.size) height=(PICTURE.size) data-samples=(SAMPLES);
            canvas #sphere .waiting role="img" aria-label={ "A sphere of " (texts::short(name)) } hidden
                width=(PICTURE.size) height=(PICTURE.size) {}
            p #sphere-samples .samples {}
        }
    }
}

fn controls(subjects: &Subjects, data: &Data) -> Markup {
    html! {
        form #sphere-controls .controls hidden autocomplete="off" {
            div.row {
                label for="material" { "Material" }
                select #material {
                    option value="-1" { "as set below" }
                    @for (i, shown) in subjects.shown.iter().enumerate() {
                        option value=(i) { (texts::short(&shown.name)) }
                    }
                }
            }
            div.row {
                label for="shape" { "Shape" }
                output #shape-value for="shape" {}
                @if subjects.is_range {
                    input #shape type="range" min="0" max=(subjects.stops.len() - 1) step="1";
                } @else {
                    select #shape {
                        @for (i, &gamma) in subjects.stops.iter().enumerate() {
                            option value=(i) { (label(gamma)) }
                        }
                    }
                }
            }
            @for (axis, along) in [("x", "along the parallels"), ("y", "along the meridians")] {
                div.row {
                    label for={ "sigma-" (axis) } {
                        "Roughness σ" (axis) " " span.muted { (along) }
                    }
                    output id={ "sigma-" (axis) "-value" } for={ "sigma-" (axis) } {}
                    input id={ "sigma-" (axis) } type="range" min="0" max=(slider_steps()) step="1";
                }
            }
            div.check {
                input #sigma-link type="checkbox" checked;
                label for="sigma-link" { "σx and σy together" }
            }
            div.row {
                label for="metal" { "Reflectance" }
                select #metal {
                    @for (i, name) in data.reflectances.iter().enumerate() {
                        option value=(i) { (name) }
                    }
                }
            }
            div.check {
                input #compensation type="checkbox" checked;
                label for="compensation" { "Light of further bounces (Kulla–Conty)" }
            }
            p #stand-in .note hidden {
                "For σx ≠ σy the albedo of the round lobe of √(σx σy) stands in: too much light may \
                 come back, or too little."
            }
        }
    }
}

/// A hundred steps for each decade of σ.
fn slider_steps() -> usize {
    (100.0 * (SIGMA[1] / SIGMA[0]).log10()).round() as usize
}

/// Pictures of lobes, as buttons that show a lobe on the sphere; none if there is one lobe.
fn gallery(subjects: &Subjects, pictures: &[String]) -> Markup {
    html! {
        @if pictures.len() > 1 { div.gallery {
            @for (i, (shown, picture)) in subjects.shown.iter().zip(pictures).enumerate() {
                figure.card {
                    button type="button" data-material=(i) aria-label={ "Show " (texts::short(&shown.name)) } {
                        img src=(picture) alt="" width=(PICTURE.size) height=(PICTURE.size);
                    }
                    figcaption {
                        strong { (texts::name(&shown.name)) } br;
                        (shown.description())
                        @if is_dielectric(shown) { ", its reflection alone" }
                    }
                }
            }
        } }
        @if subjects.left_out > 0 {
            p.note { "And " (subjects.left_out) " more, without a picture." }
        }
    }
}

/// Notes on where the sphere and the pictures differ from what a material states.
fn differences(subjects: &Subjects) -> Markup {
    let is_beyond = |shown: &Shown| shown.sigma.iter().any(|x| !(SIGMA[0]..=SIGMA[1]).contains(x));
    let is_other = |shown: &Shown| {
        shown.entry.as_ref().is_some_and(|entry| entry.masking() != Masking::HeightCorrelated)
    };
    let any = |what: &dyn Fn(&Shown) -> bool| subjects.shown.iter().any(what);
    html! {
        p.note {
            "Masking is height-correlated"
            @if any(&is_other) { ", also of materials that state another" }
            ". "
            @if any(&is_unstated) {
                "A material without a Fresnel term is shown in the metal of its name, or in "
                (UNSTATED.name()) ". "
            }
            @if any(&is_dielectric) {
                "Of glass and the like the sphere shows what is reflected, with Schlick’s term, and \
                 nothing of what is transmitted. "
            }
            @if any(&is_beyond) { "σ is kept within " (SIGMA[0]) " and " (SIGMA[1]) "." }
        }
    }
}

/// The script of the sphere, without its data.
const SCRIPT: &str = concat!(
    include_str!("gl.js"),
    include_str!("sphere.js"),
    include_str!("lobe.js"),
    include_str!("controls.js"),
);

/// Shaders, and what the script is given.
fn data_of(data: &Data) -> Markup {
    let common =
        format!("{}{}{}", studio::constants(), random::constants(), data::albedo_coordinates());
    let scene = format!(
        "{common}{}{}",
        include_str!("studio.glsl"),
        include_str!("sphere.frag").replace(
            "out vec4 color;",
            &format!("out vec4 color;\n\n{}", include_str!("fresnel.glsl"))
        ),
    );
    let shaders = [
        ("sphere-module", for_webgl().into()),
        ("sphere-scene", scene),
        ("sphere-lobe", include_str!("lobe.frag").into()),
        ("sphere-present", include_str!("present.frag").into()),
    ];
    html! {
        @for (id, text) in &shaders {
            script id=(id) type="x-shader/x-fragment" { (verbatim(text)) }
        }
        script #sphere-data type="application/json" { (PreEscaped(&data.json)) }
    }
}

/// The sphere of a page as RGB, row by row from the upper left, by the sampler's BSDFs.
///
/// # Errors
/// [`BindError`] for a shape that neither the set nor the default set covers.
pub fn picture(set: &Tables, look: &Look, film: Film) -> Result<Vec<[u8; 3]>, BindError> {
    Ok(Scene::new(&set.clone().with_fallback(&Tables::embedded()), look)?.picture(film))
}

#[cfg(test)]
mod tests;
