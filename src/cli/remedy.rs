//! What helps against an error of a library, in the words of the command. The libraries say what is
//! wrong, with numbers and what is allowed; only the command knows its options and its recipes.

use std::any::Any;
use std::fmt::Display;

use microfacet_baker::input::normals::MeasuredError;
use microfacet_baker::memory::TooLarge;
use microfacet_baker::store::StoreError;
use microfacet_baker::table_set::BakeError;
use microfacet_fit::convert::ConvertError;
use microfacet_fit::merl::MerlError;
use microfacet_report::ReportError;
use microfacet_sampler::{BindError, MaterialError};

/// An error, and what helps.
pub(super) fn told<E: Display + Any>(error: &E) -> String {
    format!("{error}{}", of(error).unwrap_or_default())
}

/// What follows the message of an error, if anything.
fn of(error: &dyn Any) -> Option<String> {
    let option = |name: &str| Some(format!(" ({name})"));
    if error.is::<TooLarge>() {
        return option("--max-memory");
    }
    if let Some(why) = error.downcast_ref::<BakeError>() {
        return match why {
            BakeError::Memory(why) => of(why),
            BakeError::TooSlow { .. } => option("--patient"),
            _ => None,
        };
    }
    if let Some(StoreError::TooLarge(..)) = error.downcast_ref() {
        return option("--per-set");
    }
    if let Some(MeasuredError::Degrees(_)) = error.downcast_ref() {
        return option("--degrees");
    }
    if let Some(ConvertError::ShapeNeeded(_)) = error.downcast_ref() {
        return option("--shape");
    }
    if let Some(MerlError::Dimensions(_)) = error.downcast_ref() {
        return Some("; --input reads a CSV of angles and D".into());
    }
    if let Some(ReportError::OtherSet { .. }) = error.downcast_ref() {
        return Some(": what `microfacet-bake validate SET --json` prints".into());
    }
    if let Some(why) = error.downcast_ref::<BindError>() {
        return match why {
            BindError::Material(why) => of_material(why),
            why => why.recipe().map(|recipe| format!("; add to a recipe:\n{recipe}")),
        };
    }
    error.downcast_ref().and_then(of_material)
}

/// What helps where a set lacks what was asked for.
fn of_material(why: &MaterialError) -> Option<String> {
    let set = |recipe: String, general: &str| {
        let without = "`microfacet-bake bake` without a recipe";
        Some(format!("; bake a set that does: {recipe}, or {without} for {general}"))
    };
    match why {
        MaterialError::NotCovered { gamma, .. } if *gamma >= microfacet_tables::GAMMA_MIN => {
            set(format!("a recipe line `gamma = {gamma}`"), "all of [1.501, inf]")
        }
        MaterialError::MaskingNotCovered { masking, .. } => set(
            format!("a recipe's material with `fresnel` and `masking = \"{masking}\"`"),
            "both forms",
        ),
        MaterialError::AlbedoNotCovered { .. } => {
            set("a recipe's material with `fresnel`".into(), "all")
        }
        MaterialError::DielectricNotCovered { eta, masking, .. } => Some(format!(
            "; add `fresnel = {{ dielectric = {eta} }}` and `masking = \"{masking}\"` to a \
             material of the recipe that covers them, and bake it again"
        )),
        MaterialError::NoAlbedo(_) => Some(
            ": state its `fresnel` in its recipe, or bake albedos of all materials (--albedo)"
                .into(),
        ),
        MaterialError::NoSuchMaterial { name, .. } => Some(format!(
            "; to add it, append to its recipe, with its own roughness and shape, and bake again:\n\
             [[material]]\nname = \"{name}\"\nsigma = 0.3\ngamma = 3.0"
        )),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use microfacet_baker::distribution::DistributionKind;
    use microfacet_sampler::bsdf::Metal;
    use microfacet_sampler::{Compensation, Conductor, StandIn, Tables};

    use super::*;

    #[test]
    fn a_remedy_follows_each_error_that_an_option_or_a_recipe_helps_against() {
        let set = Tables::embedded();
        let large = || TooLarge { values: 1, needed: 1 << 30, limit: 1 << 20 };
        let slow = BakeError::TooSlow { search: 99.0, default_seconds: 10.0 };
        let lobe = set.student_t([0.4, 0.1], 3.0).unwrap();
        let gold: Conductor<_> = Conductor::new(lobe, Metal::Gold);
        let unbound = gold.compensated(&set, Compensation::Turquin, StandIn::Refused).unwrap_err();
        let covered = || "none".to_string();
        for (told, says) in [
            (told(&large()), "(--max-memory)"),
            (told(&BakeError::Memory(large())), "(--max-memory)"),
            (told(&slow), "(--patient)"),
            (
                told(&StoreError::TooLarge("out".into(), "9 bytes, and 8 are read".into())),
                "(--per-set)",
            ),
            (told(&ConvertError::ShapeNeeded(DistributionKind::StudentT)), "(--shape)"),
            (told(&MerlError::Dimensions([1, 2, 3])), "--input"),
            (told(&MaterialError::NoAlbedo("silent".into())), "(--albedo)"),
            (told(&unbound), "\n[[material]]\nname = \"another name\"\nsigma = [0.4, 0.1]\n"),
            (told(&set.material("silver").unwrap_err()), "\n[[material]]\nname = \"silver\"\n"),
            (
                told(&MaterialError::NotCovered { gamma: 3.0, covered: covered() }),
                "recipe line `gamma = 3`",
            ),
            // No bake has tables of it.
            (told(&MaterialError::NotCovered { gamma: 1.5005, covered: covered() }), "or more"),
        ] {
            let at = told.find(says).unwrap_or_else(|| panic!("no {says} in {told}"));
            assert!(at > 20 && !told[..at].contains("--"), "{told}");
        }
    }
}
