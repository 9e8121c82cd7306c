//! A plan as JSON.

use serde_json::{Value, json};

use microfacet_baker::distribution::Distribution;
use microfacet_baker::plan::{AlbedoVerdict, Judged, StandIn, Verdict, entry};
use microfacet_baker::scene::{Ignored, Material};
use microfacet_baker::table_spec::TableSpec;
use microfacet_report::words::verdict::{albedo_reason, reason};
use microfacet_tables::{Axis, Interval, Kind, LobeSpec, MaterialEntry, Reflectance};

use super::Report;
use super::words::{OWN_TABLES, Outline, Part, Tables};

impl Outline<'_> {
    /// The verdict on each material of the scene, with that on its haze inside.
    pub(in crate::cli) fn materials(&self) -> Vec<Value> {
        let mut all: Vec<Value> = Vec::new();
        for judged in self.plan.judged(self.scene) {
            let Material { name, origin, haze, retroreflection, .. } = judged.material;
            let mut lobe = self.lobe(&judged);
            if judged.is_haze {
                lobe["weight"] = json!(haze.as_ref().map(|haze| haze.weight));
                if let Some(core) = all.last_mut() {
                    core["haze"] = lobe;
                }
                continue;
            }
            let MaterialEntry { masking, fresnel, .. } = judged.part.entry();
            for (key, value) in [
                ("name", json!(name)),
                ("lobe", json!(origin.lobe)),
                ("place", json!(origin.place.to_string())),
                ("masking", json!(masking)),
                ("fresnel", json!(fresnel)),
                ("haze", Value::Null),
                ("retroreflection", json!(retroreflection)),
            ] {
                lobe[key] = value;
            }
            all.push(lobe);
        }
        all
    }

    /// One lobe of a material, and the verdicts on it.
    fn lobe(&self, Judged { part, verdict, albedo, .. }: &Judged<'_>) -> Value {
        let [short, long] = reason(verdict);
        let other = match **verdict {
            Verdict::Same { as_material: i, .. } | Verdict::Within { of_material: i, .. } => {
                Some(&self.scene.materials[i].name)
            }
            _ => None,
        };
        let LobeSpec { distribution, theta, .. } = entry(part).lobe;
        let of_family = distribution.is_none();
        let stand_in = StandIn::of(part)
            .filter(|_| matches!(albedo, AlbedoVerdict::Bake(_) | AlbedoVerdict::Embedded));
        json!({
            "sigma": part.lobe.sigmas(),
            "gamma": of_family.then(|| texts(part.lobe.gamma)),
            "distribution": distribution, "theta": theta,
            "verdict": short, "why": long, "shapes": verdict.need(),
            "shares_with": other, "albedo": albedo_reason(albedo), "stand_in": stand_in,
        })
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
