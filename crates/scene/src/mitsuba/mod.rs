//! Mitsuba 3 scenes (XML).
//!
//! Conventions, from the [plugins' documentation][bsdfs] and Mitsuba's sources
//! (`render/microfacet.h`, `render/ior.h`, `bsdfs/principledhelpers.h`):
//!
//! - `roughconductor`, `roughdielectric`, `roughplastic` and `pplastic` take `alpha` (default 0.1)
//!   or `alpha_u` and `alpha_v`, as written and at least 1e-4. `distribution` is `beckmann` by
//!   default (γ = ∞), or `ggx` (γ = 2); σ = α in both.
//! - `principled` takes `roughness` r (default 0.5) and `anisotropic` a (default 0): with A = √(1 −
//!   0.9 a) its GGX lobe has αx = r²/A and αy = r² A, each at least 1e-3. Its clearcoat is GTR1,
//!   which has heavier tails than any Student-t distribution (γ = 1) and is listed as ignored.
//! - `principledthin` has the same reflection lobe, and one for transmission with r (0.65 η − 0.35)
//!   instead of r; both only if `spec_trans` is not 0.
//! - `conductor`, `dielectric`, `thindielectric` and `plastic` are smooth.
//! - `roughcoating` and the smooth `coating` of Mitsuba 0.6 are a lobe "coating" each, in addition
//!   to the BSDF inside them.
//! - A metal's reflectance is read from `eta` and `k`, each an `rgb` triple or a single number, or
//!   from the preset `material`, where [`microfacet_sampler::Metal`] has that metal; `none`, which
//!   is the default, is a mirror.
//! - `pplastic` takes `eta` instead of `int_ior` and `ext_ior`.
//! - G2 is uncorrelated (`MicrofacetDistribution::G`).
//! - `twosided`, `mask`, `bumpmap`, `normalmap`, `blendbsdf` and `mixturebsdf` (0.6) stand for
//!   the BSDFs inside them.
//! - A `bitmap` texture is decoded from sRGB unless it is `raw`; its luminance is used.
//! - `$name` in an attribute stands for the value that `<default>` gives it.
//!
//! Scenes of Mitsuba 0.6 are read where their names are those of Mitsuba 3, or older spellings of
//! them, such as `intIOR` and `alphaU`. The distributions `phong` and `as` and the BSDFs `phong`,
//! `ward` and `sssbrdf` are not read. Where the scene's own `version` begins with 0, a conductor is
//! copper by default.
//!
//! Mitsuba refuses a property that a plugin does not have. Here such a property of a BSDF with
//! lobes, or of a texture of its roughness, gives a warning, and the rest is read.
//!
//! A BSDF with an impossible value is listed as not understood, and the rest is read. A bad index
//! of refraction leaves the lobe without its Fresnel term. References to what does not exist, and
//! references in a circle, give a warning.
//!
//! [bsdfs]: https://mitsuba.readthedocs.io/en/stable/src/plugin_reference/plugins_bsdfs.html

mod bsdf;
mod expand;
mod fresnel;
mod value;

use std::collections::{BTreeMap, HashSet};
use std::path::{Path, PathBuf};

use microfacet_baker::scene::{Format, Scene};

use crate::Result;
use crate::builder::Builder;
use crate::references::{Memo, circle};
use crate::xml::Element;
use expand::Expansion;

pub(super) fn load(path: &Path) -> Result<Scene> {
    let mut builder = Builder::new(Format::Mitsuba);
    let folder = path.parent().unwrap_or(Path::new(""));
    let mut expansion = Expansion::new(folder, &mut builder);
    let mut root = expansion.xml.open(path, &["scene", "bsdf"], "a Mitsuba scene")?;
    expansion.element(&mut root, 0)?;
    let Expansion { incomplete, folders, xml, .. } = expansion;

    let mut reader = Reader {
        ids: ids(&root),
        builder,
        folders,
        incomplete,
        is_older: root.attribute("version").is_some_and(|version| version.starts_with("0.")),
        ranges: Memo::default(),
    };
    reader.check_circles(&root);
    let used = reader.used(&root);
    reader.bsdfs(&root, None, &used)?;
    Ok(reader.builder.finish(xml.includes.found()))
}

/// The file `name` in the first folder that has it, else in the first folder.
fn find(folders: &[PathBuf], name: &str) -> PathBuf {
    folders
        .iter()
        .map(|folder| folder.join(name))
        .find(|path| path.exists())
        .unwrap_or_else(|| folders[0].join(name))
}

/// Elements by their id; `<alias>` gives one a second id.
fn ids(root: &Element) -> BTreeMap<&str, &Element> {
    let mut ids = BTreeMap::new();
    root.walk(&mut |element| {
        if element.tag == "alias" {
            let (old, new) = (element.attribute("id"), element.attribute("as"));
            if let (Some(old), Some(new)) = (old.and_then(|id| ids.get(id).copied()), new) {
                ids.insert(new, old);
            }
        } else if element.tag != "ref"
            && let Some(id) = element.attribute("id")
        {
            ids.insert(id, element);
        }
    });
    ids
}

struct Reader<'a> {
    ids: BTreeMap<&'a str, &'a Element>,
    builder: Builder,
    folders: Vec<PathBuf>,
    incomplete: bool,
    /// Whether the scene is of Mitsuba 0.6 or before.
    is_older: bool,
    /// Ranges of the textures that were evaluated.
    ranges: Memo<&'a Element>,
}

impl<'a> Reader<'a> {
    /// The BSDFs that shapes use, directly or inside other BSDFs; `None` if that cannot be known.
    fn used(&mut self, root: &'a Element) -> Option<HashSet<&'a Element>> {
        if self.incomplete {
            return None;
        }
        // Without shapes every BSDF is followed, to find references to what does not exist.
        let mut pending = root.all("shape");
        let everything = pending.is_empty();
        if everything {
            pending = root.all("bsdf");
        }
        let mut used = HashSet::new();
        while let Some(element) = pending.pop() {
            for mut child in &element.children {
                if child.tag == "ref" {
                    match self.referred(child) {
                        Ok(found) => child = found,
                        Err(error) => self.builder.warn(&error.place, error.kind.to_string()),
                    }
                }
                if child.tag == "bsdf" && used.insert(child) {
                    pending.push(child);
                }
            }
        }
        (!everything).then_some(used)
    }

    /// Warns of an element that contains itself through a `<ref>`.
    fn check_circles(&mut self, root: &'a Element) {
        let inside = |element: &'a Element| {
            let id = element.attribute("id").filter(|_| element.tag == "ref");
            element.children.iter().chain(id.and_then(|id| self.ids.get(id).copied())).collect()
        };
        let Some(circle) = circle([root], inside) else {
            return;
        };
        let references = circle.into_iter().filter(|element| element.tag == "ref");
        // A circle has a reference, since without references elements are a tree.
        let last = references.clone().next_back().unwrap_or(root);
        let names: Vec<&str> =
            [last].into_iter().chain(references).filter_map(|e| e.attribute("id")).collect();
        let warning =
            format!("references go in a circle: {}; remove one of them", names.join(" -> "));
        self.builder.warn(&last.place, warning);
    }

    /// What a `<ref>` refers to.
    fn referred(&self, reference: &Element) -> Result<&'a Element> {
        let id = reference.required("id")?;
        self.ids.get(id).copied().ok_or_else(|| {
            let hint = self.builder.did_you_mean(id, self.ids.keys().copied());
            reference.place.invalid(format!("nothing has the id \"{id}\"{hint}"))
        })
    }

    /// Adds all BSDFs in `element`; those without an id are named after the outer one.
    fn bsdfs(
        &mut self,
        element: &'a Element,
        outer: Option<&'a str>,
        used: &Option<HashSet<&'a Element>>,
    ) -> Result<()> {
        let named = matches!(&element.tag[..], "bsdf" | "shape");
        let name = element.attribute("id").filter(|id| named && !id.is_empty()).or(outer);
        if element.tag == "bsdf" {
            let used = used.as_ref().is_none_or(|used| used.contains(element));
            self.bsdf(element, name, used)?;
        }
        element.children.iter().try_for_each(|child| self.bsdfs(child, name, used))
    }
}
