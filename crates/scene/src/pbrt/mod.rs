//! pbrt-v4 scenes.
//!
//! Conventions, from the [file format's description][format] and pbrt's sources
//! (`materials.cpp`, `materials.h`, `util/scattering.h`, `textures.cpp`):
//!
//! - `conductor`, `dielectric`, `coateddiffuse` and `subsurface` take `uroughness` and
//!   `vroughness`, each of which defaults to `roughness`, which defaults to 0. `coatedconductor`
//!   takes `interface.` and `conductor.` before these names, and has two rough interfaces.
//!   `thindielectric` is smooth.
//! - α = √roughness unless `remaproughness` is false. The distribution is Trowbridge-Reitz: γ = 2,
//!   σ = α. When both α are below 1e-3 the surface is smooth, else both are at least 1e-4.
//! - G2 is height-correlated.
//! - A conductor has `eta` and `k`, each an `rgb` triple or a named spectrum (`"metal-Au-eta"`,
//!   `"metal-Au-k"`), for which [`microfacet_sampler::Metal`] stands; each is copper's by default.
//!   Instead it may have an `rgb` `reflectance` r: eta = 1 and k = 2 √(r/(1 − r)), r ≤ 0.9999. In a
//!   `coatedconductor` eta and k are divided by the coat's index, `interface.eta`. A dielectric has
//!   a `float` `eta`, 1.33 by default in `subsurface` and else 1.5, or is a glass by name
//!   (`"glass-BK7"`), which has its index at 587.56 nm: dispersion is left out. Spectra of samples,
//!   textures and colours of dielectrics leave the Fresnel term open; other names of spectra, and
//!   of files with them, do so with a warning.
//! - `interface`, "none" and an empty type are the boundary of a medium, without a surface.
//! - `mix` uses two named materials; `Attribute "material"` gives defaults to the ones that follow.
//! - A float image texture is the mean of red, green and blue, or opacity where the file has any
//!   below 1 (`MIPMap::Bilerp<Float>` and `CreateFromFile` in `util/mipmap.cpp`); `filter` "point"
//!   reads the first channel (`Texel<Float>`), and "ewa" either. All channels, opacity too, are
//!   first decoded from sRGB where the samples are integers, except in a PNG whose `encoding` is
//!   "linear" (`util/image.cpp`). The value is multiplied by `scale`; `invert` makes it 1 minus
//!   that. Left out: what covers less than a pixel on the screen is the first channel's average
//!   under any filter, and a palette's transparency, which pbrt drops, counts as opacity.
//! - Included files are looked up in the folder of the scene's own file. `Import` is an `Include`
//!   that leaves the graphics state unchanged.
//!
//! pbrt refuses a scene with a material that is not defined or is defined twice, has an impossible
//! value, or has a parameter that its class does not have or has with another type. Here such a
//! material gives a warning or is listed as not understood, and the rest is read; of two
//! definitions the first counts, and a number is read whatever its type is. Directives of pbrt-v1
//! and v2 are skipped with a warning. Materials that pbrt-v3 has and v4 does not are listed as not
//! understood; mixtures of v3 are followed. pbrt-v3 maps the roughness of `subsurface` differently,
//! which gives a warning.
//!
//! Everything that belongs to shapes is skipped without being read.
//!
//! [format]: https://pbrt.org/fileformat-v4

mod definition;
mod fresnel;
mod materials;
mod parameters;
mod references;
mod syntax;
mod textures;

use std::collections::{BTreeMap, HashMap};
use std::path::{Path, PathBuf};
use std::rc::Rc;

use microfacet_baker::scene::{Format, Place, Scene, did_you_mean};

use self::definition::{Definition, Parameter};
use self::parameters::{MATERIALS, TEXTURES};
use self::syntax::{Token, Tokens};
use crate::Result;
use crate::builder::{Builder, check_count, has_word, shortened};
use crate::include::Includes;
use crate::limits;
use crate::references::Memo;

const FOLLOWED: &str = "Attribute AttributeBegin AttributeEnd Import Include MakeNamedMaterial \
                        Material NamedMaterial ObjectBegin ObjectEnd Shape Texture";

/// Directives that do not concern materials.
const PASSED_OVER: &str = "Accelerator AreaLightSource Camera ColorSpace ConcatTransform \
                           CoordSysTransform CoordinateSystem Film Identity Integrator LightSource \
                           LookAt MakeNamedMedium MediumInterface ObjectInstance Option PixelFilter \
                           ReverseOrientation Rotate Sampler Scale TransformBegin TransformEnd \
                           Transform TransformTimes Translate WorldBegin WorldEnd";

/// What converts scenes of older versions.
const UPGRADE: &str = "`pbrt --upgrade old.pbrt > new.pbrt` of pbrt-v4 converts scenes of pbrt-v3";

/// The last version that has a directive which pbrt-v4 does not have.
fn older(directive: &str) -> Option<&'static str> {
    match directive {
        "SearchPath" => Some("pbrt-v1"),
        "Renderer" | "SurfaceIntegrator" | "Volume" | "VolumeIntegrator" => Some("pbrt-v2"),
        _ => None,
    }
}

pub(super) fn load(path: &Path) -> Result<Scene> {
    let mut reader = Reader {
        folder: path.parent().unwrap_or(Path::new("")).to_owned(),
        builder: Builder::new(Format::Pbrt),
        includes: Includes::new(limits::PBRT),
        state: State::default(),
        saved: Vec::new(),
        slots: Vec::new(),
        names: HashMap::new(),
        defined: Vec::new(),
        held: 0,
        textures: BTreeMap::new(),
        ranges: Memo::default(),
        shapes: false,
        incomplete: false,
        older: false,
        of_v3: false,
    };
    let text = reader.includes.open(path)?;
    reader.statements(&mut Tokens::new(&text, path))?;
    reader.finish()
}

/// The part of pbrt's graphics state that decides which material a shape uses.
#[derive(Clone, Default)]
struct State {
    /// Index in `slots`.
    material: Option<usize>,
    /// Parameters from `Attribute "material"`, each name once.
    attributes: Vec<Rc<Parameter>>,
}

/// A material that is defined or referred to.
struct Slot {
    used: bool,
    definition: Option<Definition>,
    /// Where it was first mentioned.
    place: Place,
}

struct Reader {
    /// The folder that relative file names start from.
    folder: PathBuf,
    builder: Builder,
    includes: Includes,
    state: State,
    /// States to return to, each with the place of the directive that saved it.
    saved: Vec<(State, Place)>,
    slots: Vec<Slot>,
    /// Slots of the named materials.
    names: HashMap<String, usize>,
    /// Slots in the order of their definition.
    defined: Vec<usize>,
    /// Bytes of the materials and textures.
    held: u64,
    /// Float textures by name.
    textures: BTreeMap<String, Rc<Definition>>,
    /// Ranges of the textures that were evaluated.
    ranges: Memo<String>,
    shapes: bool,
    /// Whether an included file is missing.
    incomplete: bool,
    /// Whether a directive of an older version was passed over.
    older: bool,
    /// Whether a material is defined that only pbrt-v3 has.
    of_v3: bool,
}

impl Reader {
    fn statements(&mut self, tokens: &mut Tokens<'_>) -> Result<()> {
        while let Some(token) = tokens.next()? {
            let Token::Word(directive) = token else {
                return Err(tokens.place().syntax(format!(
                    "expected a directive such as Material or Shape, not \"{}\"",
                    token.shown()
                )));
            };
            self.statement(&directive, tokens)?;
        }
        Ok(())
    }

    fn statement(&mut self, directive: &str, tokens: &mut Tokens<'_>) -> Result<()> {
        let place = tokens.place();
        match directive {
            "Shape" => {
                self.shapes = true;
                if let Some(slot) = self.state.material {
                    self.slots[slot].used = true;
                }
                tokens.skip_arguments()
            }
            "AttributeBegin" | "ObjectBegin" => {
                check_count(self.saved.len(), "blocks in each other", &place)?;
                self.saved.push((self.state.clone(), place));
                tokens.skip_arguments()
            }
            "AttributeEnd" | "ObjectEnd" => {
                let unmatched = || place.syntax(format!("{directive} without its beginning"));
                (self.state, _) = self.saved.pop().ok_or_else(unmatched)?;
                tokens.skip_arguments()
            }
            "Attribute" => {
                let target = tokens.text("the target of the attributes")?;
                let parameters = tokens.parameters()?;
                if target == "material" {
                    self.hold(&parameters, &place)?;
                    self.check_attributes(&parameters);
                    self.attributes(parameters, &place)?;
                }
                Ok(())
            }
            "Include" | "Import" => {
                let name = tokens.text("the name of a file")?;
                let state = self.state.clone();
                self.include(&name, &place)?;
                if directive == "Import" {
                    self.state = state;
                }
                Ok(())
            }
            "Material" => {
                let class = tokens.text("the type of the material")?;
                let own = tokens.parameters()?;
                self.hold(&own, &place)?;
                self.check_parameters(&MATERIALS, &class, &own);
                // The empty type is an older name of "interface".
                let class = if class.is_empty() { "interface".to_owned() } else { class };
                let name = self.by_place(&class, &place);
                let slot = self.slot(&place)?;
                self.define(slot, name, class, own, place);
                self.state.material = Some(slot);
                Ok(())
            }
            "MakeNamedMaterial" => {
                let name = tokens.text("the name of the material")?;
                let own = tokens.parameters()?;
                self.hold(&own, &place)?;
                let class = own.iter().chain(&self.state.attributes).find(|p| p.name == "type");
                let class = class.and_then(|p| p.values.last().cloned()).unwrap_or_default();
                self.check_parameters(&MATERIALS, &class, &own);
                let slot = self.named(&name, &place)?;
                if let Some(first) = &self.slots[slot].definition {
                    let warning = format!(
                        "material \"{name}\" is defined twice, first at {}, which is kept; rename one \
                         of them",
                        first.place
                    );
                    self.builder.warn(&place, warning);
                    return Ok(());
                }
                let name =
                    if name.trim().is_empty() { self.by_place(&class, &place) } else { name };
                self.define(slot, name, class, own, place);
                Ok(())
            }
            "NamedMaterial" => {
                let name = tokens.text("the name of a material")?;
                self.state.material = Some(self.named(&name, &place)?);
                // A parameter list is allowed by the grammar here, and has no meaning.
                tokens.parameters().map(drop)
            }
            "Texture" => {
                let name = tokens.text("the name of the texture")?;
                let kind = tokens.text("the type of the texture, \"float\" or \"spectrum\"")?;
                let class = tokens.text("the class of the texture")?;
                let parameters = tokens.parameters()?;
                if kind == "float" {
                    self.hold(&parameters, &place)?;
                    self.check_parameters(&TEXTURES, &class, &parameters);
                    check_count(self.textures.len(), "textures", &place)?;
                    let texture = Definition { name: name.clone(), class, parameters, place };
                    self.textures.insert(name, Rc::new(texture));
                }
                Ok(())
            }
            // Its argument is a word, without quotes.
            "ActiveTransform" => tokens.next().map(drop),
            other if has_word(PASSED_OVER, other) => tokens.skip_arguments(),
            other => {
                let Some(version) = older(other) else {
                    let known: Vec<&str> =
                        PASSED_OVER.split(' ').chain(FOLLOWED.split(' ')).collect();
                    let (word, hint) = (shortened(other), did_you_mean(other, &known));
                    return Err(place.syntax(format!("unknown directive {word}{hint}")));
                };
                // The first older directive shows the version.
                if !std::mem::replace(&mut self.older, true) {
                    let warning = format!(
                        "{other} is a directive of {version}; such ones are passed over, and \
                         materials are read as those of pbrt-v4; {UPGRADE}"
                    );
                    self.builder.warn(&place, warning);
                }
                tokens.skip_arguments()
            }
        }
    }

    fn include(&mut self, name: &str, place: &Place) -> Result<()> {
        let path = self.folder.join(name);
        let said = "its materials are not seen, and all others count as used";
        let text = self.includes.include((name, &path), place, &mut self.builder, said)?;
        let Some(text) = text else {
            self.incomplete = true;
            return Ok(());
        };
        self.statements(&mut Tokens::new(&text, &path))?;
        self.includes.leave();
        Ok(())
    }

    /// Counts the bytes that are kept of a directive at `place`.
    fn hold(&mut self, parameters: &[Rc<Parameter>], place: &Place) -> Result<()> {
        self.held += parameters.iter().map(|parameter| parameter.bytes() as u64).sum::<u64>();
        if self.held <= limits::PBRT_HELD {
            return Ok(());
        }
        Err(place.too_large(format!(
            "the materials and textures of the scene have more than {} MiB of parameters; split it",
            limits::PBRT_HELD >> 20
        )))
    }

    /// Puts parameters before those in force: the first of a name counts.
    fn attributes(&mut self, mut parameters: Vec<Rc<Parameter>>, place: &Place) -> Result<()> {
        parameters.append(&mut self.state.attributes);
        for parameter in parameters {
            let attributes = &mut self.state.attributes;
            if attributes.iter().any(|first| first.name == parameter.name) {
                continue;
            }
            if attributes.len() == limits::PARAMETERS {
                return Err(place.too_large(format!(
                    "more than {} attributes of materials are in force; remove those that pbrt does \
                     not read",
                    limits::PARAMETERS
                )));
            }
            attributes.push(parameter);
        }
        Ok(())
    }

    /// A name for a material that has none: its type, its file relative to the scene, its line.
    fn by_place(&self, class: &str, place: &Place) -> String {
        let class = if class.is_empty() { "material" } else { class };
        let file = place.file.strip_prefix(&self.folder).unwrap_or(&place.file);
        format!("{class} at {}:{}", file.display(), place.line.unwrap_or_default())
    }

    fn slot(&mut self, place: &Place) -> Result<usize> {
        check_count(self.slots.len(), "materials", place)?;
        self.slots.push(Slot { used: false, definition: None, place: place.clone() });
        Ok(self.slots.len() - 1)
    }

    fn named(&mut self, name: &str, place: &Place) -> Result<usize> {
        if let Some(&slot) = self.names.get(name) {
            return Ok(slot);
        }
        let slot = self.slot(place)?;
        self.names.insert(name.to_owned(), slot);
        Ok(slot)
    }

    fn define(
        &mut self,
        slot: usize,
        name: String,
        class: String,
        mut parameters: Vec<Rc<Parameter>>,
        place: Place,
    ) {
        // The first parameter of a name counts: a material's own comes before the default.
        parameters.extend(self.state.attributes.iter().cloned());
        let definition = Definition { name, class, parameters, place };
        self.of_v3 |= definition.is_of_v3();
        self.slots[slot].definition = Some(definition);
        self.defined.push(slot);
    }

    fn finish(mut self) -> Result<Scene> {
        if let Some((_, place)) = self.saved.pop() {
            return Err(place.syntax("this block has no end"));
        }
        self.follow_references();
        let everything = !self.shapes || self.incomplete;
        for slot in std::mem::take(&mut self.defined) {
            let used = everything || self.slots[slot].used;
            if let Some(definition) = self.slots[slot].definition.take() {
                self.lobes(&definition, used)?;
            }
        }
        Ok(self.builder.finish(self.includes.found()))
    }
}
