//! Materials in words.

use microfacet_tables::{Haze, LobeSpec, MaterialEntry, Reflectance};

use super::{number, range};

/// What a material is: its roughness and shape or distribution, its haze and the share of
/// retroreflection if it has them, the masking that its albedo has, and the Fresnel term that it
/// states.
pub fn material(entry: &MaterialEntry) -> String {
    let mut parts = vec![lobe(&entry.lobe)];
    if let Some(Haze { weight, lobe: of }) = &entry.haze {
        parts.push(format!("haze of weight {} ({})", range(*weight), lobe(of)));
    }
    if entry.is_retroreflecting() {
        parts.push(format!("retroreflection {}", range(entry.retroreflection)));
    }
    // If no masking is stated the default applies, but smooth lobes have none.
    if entry.masking.is_some() || !entry.lobes().all(LobeSpec::is_smooth) {
        parts.push(format!("{} masking", entry.masking()));
    }
    parts.push(fresnel(entry.fresnel.as_ref()));
    parts.join(", ")
}

/// A lobe by its roughness and shape, or its distribution.
fn lobe(of: &LobeSpec) -> String {
    let mut parts = Vec::new();
    if of.is_smooth() {
        parts.push("smooth".into());
    } else if let Some(label) = &of.distribution {
        parts.push(label.clone());
    } else {
        let [x, y] = of.sigmas().map(range);
        // Equal ranges along both axes may vary independently.
        let is_one = of.roughness.is_isotropic();
        parts.push(if is_one { format!("sigma {x}") } else { format!("sigma {x} and {y}") });
        parts.push(format!("gamma {}", range(of.gamma)));
    }
    parts.extend(of.theta.map(|theta| format!("theta {}", theta.map(number).join(", "))));
    parts.join(", ")
}

/// The reflectance of a material's facets.
pub fn fresnel(entry: Option<&Reflectance>) -> String {
    match entry {
        None => "no Fresnel term".into(),
        Some(Reflectance::Mirror) => "F = 1".into(),
        Some(other) => of(other),
    }
}

/// The reflectance of an albedo in words.
pub fn reflectance(reflectance: &Reflectance) -> String {
    match reflectance {
        Reflectance::Mirror => "for F = 1 and every Schlick term".into(),
        other => format!("for a {}", of(other)),
    }
}

fn of(reflectance: &Reflectance) -> String {
    match reflectance {
        Reflectance::Mirror => "mirror".into(),
        Reflectance::Schlick([r, g, b]) if r == g && g == b => {
            format!("Schlick with F0 {}", number(*r))
        }
        Reflectance::Schlick(f0) => format!("Schlick with F0 {}", f0.map(number).join(", ")),
        Reflectance::Conductor { eta, k } => {
            let [eta, k] = [eta, k].map(|rgb| rgb.map(number).join(", "));
            format!("conductor with eta {eta} and k {k}")
        }
        Reflectance::Dielectric(index) => {
            format!("dielectric of index {}", range(*index))
        }
        Reflectance::Interface { side, index } => {
            let index = range(*index);
            format!("dielectric of index {index} from its {} side", side.name())
        }
    }
}
