//! A plan as JSON.

use serde_json::{Value, json};

use microfacet_baker::distribution::Distribution;
use microfacet_baker::plan::{AlbedoVerdict, StandIn, Verdict, entry};
use microfacet_baker::scene::{Ignored, Material};
use microfacet_baker::table_spec::TableSpec;
use microfacet_report::words::verdict::{albedo_reason, reason};
use microfacet_tables::{Axis, Interval, Kind, LobeSpec, MaterialEntry, Reflectance};

use super::Report;
use super::words::{OWN_TABLES, Outline, Part, Tables};

impl Outline<'_> {
    /// The verdict on each material of the scene.
    pub(in crate::cli) fn materials(&self) -> Vec<Value> {
        let Self { scene, plan, .. } = self;
        let verdicts = plan.verdicts.iter().zip(&plan.albedo_verdicts);
        let material = |(material, (verdict, albedo)): (&Material, (_, &AlbedoVerdict))| {
            let [short, long] = reason(verdict);
            let other = match *verdict {
                Verdict::Same { as_material: i, .. } | Verdict::Within { of_material: i, .. } => {
                    Some(&scene.materials[i].name)
                }
                _ => None,
            };
            // The name is that of the scene.
            let MaterialEntry {
                lobe: LobeSpec { distribution, theta, .. }, masking, fresnel, ..
            } = entry(material);
            let of_family = distribution.is_none();
            let stand_in = StandIn::of(material)
                .filter(|_| matches!(albedo, AlbedoVerdict::Bake(_) | AlbedoVerdict::Embedded));
            json!({
                "name": material.name, "lobe": material.origin.lobe, "place": material.origin.place.to_string(),
                "sigma": material.lobe.sigmas(),
                "gamma": of_family.then(|| texts(material.lobe.gamma)),
                "distribution": distribution, "theta": theta, "masking": masking, "fresnel": fresnel,
                "verdict": short, "why": long, "shapes": verdict.need(),
                "shares_with": other, "albedo": albedo_reason(albedo), "stand_in": stand_in,
            })
        };
        scene.materials.iter().zip(verdicts).map(material).collect()
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
        let Self { outline, general, milliseconds } = self;
        let (mut shapes, mut distributions, mut albedos) = (Vec::new(), Vec::new(), Vec::new());
        for Part { tables, cost, names, .. } in &outline.parts {
            match tables {
                Tables::Shapes(need, specs) => {
                    let table = |spec: &TableSpec| {
                        json!({
                            "name": spec.name, "kind": spec.kind.name(),
                            "shapes": spec.shapes.nodes.len(), "views": spec.views,
                            "numbers": spec.numbers,
                        })
                    };
                    let tables: Vec<_> = specs.iter().map(table).collect();
                    shapes.push(json!({
                        "gamma": texts(need.gamma()), "s": need.s(), "tables": tables,
                        "cost": cost, "materials": names,
                    }));
                }
                Tables::Own(own) => distributions.push(json!({
                    "distribution": own.label(), "tables": OWN_TABLES, "cost": cost,
                    "materials": names,
                })),
                Tables::Albedo(spec) => {
                    let name = |&masking: &_| spec.name(Kind::Albedo, masking);
                    let axis = |axis: &Axis| json!({ "name": axis.name, "length": axis.len() });
                    let LobeSpec { distribution, theta, .. } = spec.lobe.map(Distribution::label);
                    albedos.push(json!({
                        "names": spec.maskings.iter().map(name).collect::<Vec<_>>(),
                        "sigma": spec.lobe.sigmas(),
                        "gamma": distribution.is_none().then(|| texts(spec.lobe.gamma)),
                        "distribution": distribution, "theta": theta, "masking": spec.maskings,
                        "reflectance": reflectance(&spec.reflectance),
                        "axes": spec.axes.iter().map(axis).collect::<Vec<_>>(),
                        "cost": cost, "materials": names,
                    }));
                }
            }
        }
        json!({
            "shapes": shapes, "distributions": distributions, "albedo": albedos,
            "materials": outline.materials(), "ignored": outline.ignored(),
            "warnings": outline.scene.warnings, "offered": outline.offered(),
            "total": outline.total, "general_set": general,
            "milliseconds": { "reading": milliseconds[0], "planning": milliseconds[1] },
        })
    }
}
