//! Remedies for errors of the libraries: options and recipes, which only the command knows. The
//! errors themselves say what is wrong and what is allowed.

use anyhow::Error;

use microfacet_baker::input::normals::MeasuredError;
use microfacet_baker::memory::TooLarge;
use microfacet_baker::store::StoreError;
use microfacet_baker::table_set::BakeError;
use microfacet_fit::convert::ConvertError;
use microfacet_fit::merl::MerlError;
use microfacet_report::ReportError;
use microfacet_sampler::{BindError, MaterialError};

/// The message of an error, with its context and its remedy.
pub(super) fn told(error: &Error) -> String {
    let mut text = String::new();
    for cause in error.chain().map(ToString::to_string) {
        // The message of a library's error has its cause already.
        if text.is_empty() {
            text = cause;
        } else if !text.contains(&cause) {
            text += &format!(": {cause}");
        }
    }
    text + &of(error).unwrap_or_default()
}

/// The remedy that follows the message of an error.
fn of(error: &Error) -> Option<String> {
    let fixed = if let Some(why) = error.downcast_ref() {
        match why {
            BakeError::Memory(_) => " (--max-memory)",
            BakeError::TooSlow { .. } => " (--patient)",
            _ => return None,
        }
    } else if error.is::<TooLarge>() {
        " (--max-memory)"
    } else if let Some(StoreError::TooLarge(..)) = error.downcast_ref() {
        " (--per-set)"
    } else if let Some(MeasuredError::Degrees(_)) = error.downcast_ref() {
        " (--degrees)"
    } else if let Some(ConvertError::ShapeNeeded(_)) = error.downcast_ref() {
        " (--shape)"
    } else if let Some(MerlError::Dimensions(_)) = error.downcast_ref() {
        "; --input reads a CSV of angles and D"
    } else if let Some(ReportError::OtherSet { .. }) = error.downcast_ref() {
        ": what `microfacet-bake validate SET --json` prints"
    } else {
        return match error.downcast_ref() {
            Some(BindError::Material(why)) => of_material(why),
            Some(BindError::NoAlbedoOf(_)) => Some(
                ": state its `fresnel` in its recipe, or bake albedos of all materials (--albedo)"
                    .into(),
            ),
            Some(BindError::NoSuchMaterial { name, .. }) => Some(format!(
                "; to add it, append to its recipe, with its own roughness and shape, and bake \
                 again:\n[[material]]\nname = \"{name}\"\nsigma = 0.3\ngamma = 3.0"
            )),
            Some(_) => None,
            None => error.downcast_ref().and_then(of_material),
        };
    };
    Some(fixed.into())
}

/// The remedy where a set lacks a material.
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
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use microfacet_baker::distribution::DistributionKind;
    use microfacet_sampler::{BsdfSettings, Compensation, Conductor, Metal, Tables};

    use super::*;

    #[test]
    fn a_remedy_follows_each_error_that_an_option_or_a_recipe_helps_against() {
        let set = Tables::embedded();
        let large = || TooLarge { values: 1, needed: 1 << 30, limit: 1 << 20 };
        let lobe = set.student_t([0.4, 0.1], 3.0).unwrap();
        let settings = BsdfSettings::new().compensated(Compensation::Turquin, &set);
        let unbound = Conductor::<_>::new(lobe, Metal::Gold, settings).unwrap_err();
        let uncovered =
            |gamma| Error::from(MaterialError::NotCovered { gamma, nearest: [None; 2] });
        let cases: [(Error, &str); 11] = [
            (large().into(), "(--max-memory)"),
            (BakeError::Memory(large()).into(), "(--max-memory)"),
            (BakeError::TooSlow { search: 99.0, default_seconds: 10.0 }.into(), "(--patient)"),
            (StoreError::TooLarge("out".into(), "9 bytes of 8".into()).into(), "(--per-set)"),
            (ConvertError::ShapeNeeded(DistributionKind::StudentT).into(), "(--shape)"),
            (MerlError::Dimensions([1, 2, 3]).into(), "--input"),
            (BindError::NoAlbedoOf("silent".into()).into(), "(--albedo)"),
            (unbound.into(), "\n[[material]]\nname = \"another name\"\nsigma = [0.4, 0.1]\n"),
            (set.material("silver").unwrap_err().into(), "\n[[material]]\nname = \"silver\"\n"),
            (uncovered(3.0), "recipe line `gamma = 3`"),
            // No bake has tables of it.
            (uncovered(1.5005), "or more"),
        ];
        for (error, says) in cases {
            let told = told(&error.context("set"));
            let at = told.find(says).unwrap_or_else(|| panic!("no {says} in {told}"));
            assert!(at > 20 && !told[..at].contains("--"), "{told}");
            assert!(told.starts_with("set: "), "{told}");
        }
    }
}
