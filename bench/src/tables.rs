//! Tables of several sizes and precisions, for one shape.

use microfacet_baker::plan::{Options, Plan};
use microfacet_baker::scene::Scene;
use microfacet_baker::table_set::{Target, bake};
use microfacet_baker::table_spec::Quality;
use microfacet_sampler::albedo::FamilyAlbedo;
use microfacet_sampler::{Family, Masking, Tables};
use microfacet_tables::Precision;

use crate::settings::{GAMMA, SIGMA};

/// Sets by name: slices at [`GAMMA`], and the compiled-in set for all shapes, with its family.
pub(crate) struct Slices {
    sets: Vec<(&'static str, Tables)>,
    family: Family,
    albedo: FamilyAlbedo,
}

/// Names that figures refer to.
pub(crate) const TABLE: &str = "table, default";
pub(crate) const HIGH: &str = "table, high";
const WHOLE: &str = "table, default, of all gamma";

impl Slices {
    /// Bakes them; a fraction of a second.
    pub(crate) fn bake() -> Self {
        let slice = |name, quality, precision| (name, slice(quality, precision));
        let whole = Tables::embedded();
        let family = whole.family().expect("it has every shape");
        let albedo = whole.family_albedo(Masking::HeightCorrelated).expect("and every moment");
        let sets = vec![
            slice("table, draft", Quality::Draft, Precision::F32),
            slice(TABLE, Quality::Default, Precision::F32),
            slice(HIGH, Quality::High, Precision::F32),
            slice("table, default, f16", Quality::Default, Precision::F16),
            slice("table, default, u16", Quality::Default, Precision::U16),
            (WHOLE, whole),
        ];
        Self { sets, family, albedo }
    }

    pub(crate) fn get(&self, name: &str) -> &Tables {
        &self.sets.iter().find(|(of, _)| *of == name).expect("a name of the list").1
    }

    /// The slice of default quality.
    pub(crate) fn default(&self) -> &Tables {
        self.get(TABLE)
    }

    /// The compiled-in set.
    pub(crate) fn whole(&self) -> &Tables {
        self.get(WHOLE)
    }

    /// The lobes of every σ and γ of the compiled-in set.
    pub(crate) fn family(&self) -> &Family {
        &self.family
    }

    /// The albedos of every σ and γ of the compiled-in set.
    pub(crate) fn albedo(&self) -> &FamilyAlbedo {
        &self.albedo
    }

    pub(crate) fn each(&self) -> impl Iterator<Item = &(&'static str, Tables)> {
        self.sets.iter()
    }
}

/// The set of one material, as any scene with that material gets it.
fn slice(quality: Quality, precision: Precision) -> Tables {
    let recipe = format!("[[material]]\nname = \"it\"\nsigma = {SIGMA}\ngamma = {GAMMA}\n");
    let scene = Scene::from_recipe_str(&recipe).expect("a sound recipe");
    let plan = Plan::new(&scene, Options::default()).expect("gamma is covered");
    bake(&plan, Target::Quality(quality, precision)).expect("a quality is always met").set
}
