//! A plan as JSON.

use serde_json::{Value, json};

use microfacet_baker::distribution::Distribution;
use microfacet_baker::plan::{Cost, Verdict, entry};
use microfacet_baker::scene::Ignored;
use microfacet_report::words::verdict::{albedo_reason, reason};
use microfacet_tables::{Interval, Kind, LobeSpec, MaterialEntry, Reflectance};

use super::Report;
use super::words::{OWN_TABLES, Offer, Outline};

impl Outline<'_> {
    /// The verdict on each material of the scene.
    pub(in crate::cli) fn materials(&self) -> Vec<Value> {
        let Self { scene, plan, .. } = self;
        let verdicts = plan.verdicts.iter().zip(&plan.albedo_verdicts);
        let material = |(material, (verdict, albedo)): (
            &microfacet_baker::scene::Material,
            (_, _),
        )| {
            let [short, long] = reason(verdict);
            let other = match *verdict {
                Verdict::Same { as_material: i, .. } | Verdict::Within { of_material: i, .. } => {
                    Some(&scene.materials[i].name)
                }
                _ => None,
            };
            // Without the name, which is the scene's.
            let MaterialEntry {
                lobe: LobeSpec { distribution, theta, .. }, masking, fresnel, ..
            } = entry(material);
            let of_family = distribution.is_none();
            json!({
                "name": material.name, "lobe": material.origin.lobe, "place": material.origin.place.to_string(),
                "sigma": material.lobe.sigmas(),
                "gamma": of_family.then(|| texts(material.lobe.gamma)),
                "distribution": distribution, "theta": theta, "masking": masking, "fresnel": fresnel,
                "verdict": short, "why": long, "shapes": verdict.need(),
                "shares_with": other, "albedo": albedo_reason(albedo),
            })
        };
        scene.materials.iter().zip(verdicts).map(material).collect()
    }

    /// What `--albedo` would add.
    pub(in crate::cli) fn offered(&self) -> Option<Value> {
        self.offered.as_ref().map(Offer::json)
    }

    /// The materials that no lobe describes.
    pub(in crate::cli) fn ignored(&self) -> Vec<Value> {
        self.scene.ignored.iter().map(ignored).collect()
    }
}

/// A material that no lobe describes.
pub(super) fn ignored(it: &Ignored) -> Value {
    json!({
        "name": it.name, "kind": it.kind, "why": it.reason, "understood": it.understood,
        "place": it.place.to_string(),
    })
}

/// A range as texts, since JSON has no infinity.
fn texts(Interval { min, max }: Interval) -> [String; 2] {
    [min, max].map(|x| x.to_string())
}

/// The reflectance of an albedo, without infinity.
fn reflectance(of: &Reflectance) -> Value {
    match of {
        Reflectance::Interface { side, index } => {
            let index = texts(*index);
            json!({ "interface": { "side": side, "index": index } })
        }
        other => json!(other),
    }
}

impl Report<'_> {
    pub(super) fn json(&self) -> Value {
        let Self { outline, .. } = self;
        let plan = outline.plan;
        let cost = |cost: &Cost| json!({ "bytes": cost.bytes, "seconds": cost.seconds });
        let mut costs = self.costs.iter().map(cost);
        let mut next = || costs.next().unwrap_or_default();
        let users = &outline.users;
        let shapes = plan.shapes.iter().zip(&outline.tables).zip(&users.shapes);
        let shapes: Vec<_> = shapes.map(|((need, specs), names)| {
            let tables: Vec<_> = specs
                .iter()
                .map(|spec| json!({ "name": spec.name, "kind": spec.kind.name(), "shapes": spec.shapes.nodes.len(), "views": spec.views, "numbers": spec.numbers }))
                .collect();
            json!({ "gamma": texts(need.gamma()), "s": need.s(), "tables": tables, "cost": next(), "materials": names })
        }).collect();
        let distributions: Vec<_> = plan
            .distributions
            .iter()
            .zip(&users.distributions)
            .map(|(own, names)| {
                json!({ "distribution": own.label(), "tables": OWN_TABLES, "cost": next(), "materials": names })
            })
            .collect();
        let albedos: Vec<_> = outline.albedos.iter().zip(&users.albedos).map(|(spec, names)| {
            let tables: Vec<_> = spec.maskings.iter().map(|&masking| spec.name(Kind::Albedo, masking)).collect();
            let nodes: Vec<_> = spec.axes.iter().map(|axis| json!({ "name": axis.name, "length": axis.len() })).collect();
            let LobeSpec { distribution, theta, .. } = spec.lobe.map(Distribution::label);
            json!({
                "names": tables, "sigma": spec.lobe.sigmas(),
                "gamma": distribution.is_none().then(|| texts(spec.lobe.gamma)),
                "distribution": distribution, "theta": theta, "masking": spec.maskings,
                "reflectance": reflectance(&spec.reflectance), "axes": nodes, "cost": next(), "materials": names,
            })
        }).collect();
        json!({
            "shapes": shapes, "distributions": distributions, "albedo": albedos,
            "materials": outline.materials(), "ignored": outline.ignored(), "warnings": outline.scene.warnings,
            "offered": outline.offered(),
            "total": cost(&self.total), "general_set": cost(&self.general),
            "milliseconds": { "reading": self.reading, "planning": self.planning },
        })
    }
}
