//! Materials in words.

use microfacet_tables::{MaterialEntry, Reflectance};

use super::{number, range};

/// What a material is: its roughness and shape or distribution, the masking that its albedo has,
/// and the Fresnel term that it states.
pub fn material(entry: &MaterialEntry) -> String {
    let mut parts = Vec::new();
    if entry.lobe.is_smooth() {
        parts.push("smooth".into());
    } else if let Some(label) = &entry.lobe.distribution {
        parts.push(label.clone());
    } else {
        let [x, y] = entry.lobe.sigmas().map(range);
        // Equal ranges along both axes may vary independently.
        let is_one = entry.lobe.roughness.is_isotropic();
        parts.push(if is_one { format!("sigma {x}") } else { format!("sigma {x} and {y}") });
        parts.push(format!("gamma {}", range(entry.lobe.gamma)));
    }
    parts.extend(entry.lobe.theta.map(|theta| format!("theta {}", theta.map(number).join(", "))));
    // If no masking is stated the default applies, but a smooth lobe has none.
    if entry.masking.is_some() || !entry.lobe.is_smooth() {
        parts.push(format!("{} masking", entry.masking()));
    }
    parts.push(fresnel(entry.fresnel.as_ref()));
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
