//! Fresnel terms.

use microfacet_baker::scene::Reflectance;
use microfacet_sampler::Metal;
use microfacet_tables::Interval;

use crate::{anisotropic, assert_warned, isotropic, load, names};

/// The Fresnel term of the last lobe of a material.
fn fresnel(material: &str) -> Option<Reflectance> {
    let scene = load("a.pbrt", &format!("Material {material}"));
    assert_eq!(scene.warnings, [""; 0]);
    scene.materials.last().unwrap().fresnel
}

/// A conductor relative to a coat of this index.
fn over(coat: f64, eta: [f64; 3], k: [f64; 3]) -> Reflectance {
    Reflectance::Conductor { eta: eta.map(|x| x / coat), k: k.map(|x| x / coat) }
}

const SILVER: &str = "'spectrum conductor.eta' 'metal-Ag-eta'
    'spectrum conductor.k' 'metal-Ag-k'";

#[test]
fn layered_materials_have_two_interfaces() {
    let scene = load(
        "a.pbrt",
        r#"MakeNamedMaterial "car" "string type" "coatedconductor"
            "float interface.roughness" 0.01 "float interface.eta" 1.6
            "float conductor.uroughness" 0.25 "float conductor.vroughness" 0.36
            "rgb conductor.eta" [ 0.2 0.9 1.1 ] "rgb conductor.k" [ 3.9 2.4 2.2 ]
           MakeNamedMaterial "skin" "string type" "subsurface" "float roughness" 0.16"#,
    );
    assert_eq!(names(&scene), ["car.interface", "car.conductor", "skin"]);
    let [interface, conductor, skin] = &scene.materials[..] else { unreachable!() };
    assert_eq!(interface.lobe.roughness, isotropic(0.1));
    assert_eq!(interface.fresnel, Some(Reflectance::dielectric(1.6)));
    assert_eq!(interface.origin.lobe, Some("interface"));
    assert_eq!(conductor.lobe.roughness, anisotropic(0.5, 0.6));
    let fresnel = over(1.6, [0.2, 0.9, 1.1], [3.9, 2.4, 2.2]);
    assert_eq!(conductor.fresnel, Some(fresnel), "relative to the coat");
    assert_eq!(skin.lobe.roughness, isotropic(0.4));
    assert_eq!(skin.fresnel, Some(Reflectance::dielectric(1.33)));
}

#[test]
fn a_coat_divides_the_index_of_its_conductor() {
    let coated = |parameters: &str| fresnel(&format!("'coatedconductor' {parameters}"));
    let silver = |coat| over(coat, Metal::Silver.eta(), Metal::Silver.k());
    assert_eq!(coated(SILVER), Some(silver(1.5)));
    assert_eq!(coated(&format!("{SILVER} 'float interface.eta' 1")), Some(Metal::Silver.into()));
    assert_eq!(coated(&format!("{SILVER} 'float interface.eta' 2")), Some(silver(2.0)));
    // A coat whose index is not one number leaves both open.
    assert_eq!(coated(&format!("{SILVER} 'spectrum interface.eta' [ 400 1.5 700 1.4 ]")), None);
    assert_eq!(coated(""), Some(over(1.5, Metal::Copper.eta(), Metal::Copper.k())));
    let grey = "'rgb reflectance' [ 0.5 0.5 0.5 ]";
    assert_eq!(coated(grey), Some(over(1.5, [1.0; 3], [2.0; 3])));
}

#[test]
fn eta_and_k_are_colours_or_names_and_copper_by_default() {
    let index = |parameters: &str| fresnel(&format!("'conductor' {parameters}"));
    let pair = |eta: &str, k: &str| index(&format!("'spectrum eta' {eta} 'spectrum k' {k}"));
    let (gold, silver, copper) = (Metal::Gold, Metal::Silver, Metal::Copper);
    assert_eq!(pair("'metal-CuZn-eta'", "[ 'metal-CuZn-k' ]"), Some(Metal::Brass.into()));
    assert_eq!(pair("'metal-Au-eta'", "'metal-Ag-k'"), Some(over(1.0, gold.eta(), silver.k())));
    assert_eq!(index(""), Some(copper.into()));
    assert_eq!(index("'spectrum eta' 'metal-Au-eta'"), Some(over(1.0, gold.eta(), copper.k())));
    let colour = [3.5, 2.5, 1.5];
    assert_eq!(index("'rgb k' [ 3.5 2.5 1.5 ]"), Some(over(1.0, copper.eta(), colour)));
    // Spectra of the scene's own, and textures.
    assert_eq!(pair("[ 400 1.2 700 1.1 ]", "[ 400 3 700 4 ]"), None);
    assert_eq!(index("'spectrum eta' [ 400 1.2 700 1.1 ]"), None);
    assert_eq!(index("'texture k' 'map'"), None);
    let text = "Material 'conductor' 'string eta' 'metal-Au-eta'";
    let other = load("a.pbrt", text);
    assert_eq!(other.materials[0].fresnel, None);
    assert_warned(&other, ":1:22", &["eta of conductor has the type string", "rgb, spectrum"]);
}

#[test]
fn a_reflectance_is_that_at_normal_incidence() {
    let index = |parameters: &str| fresnel(&format!("'conductor' {parameters}"));
    let Some(Reflectance::Conductor { eta, k }) = index("'rgb reflectance' [ 0.2 0 1 ]") else {
        panic!("no conductor")
    };
    assert_eq!(eta, [1.0; 3]);
    // With eta = 1, F = k²/(k² + 4). pbrt lowers 1 to 0.9999, for a finite k.
    let reflected = k.map(|k| k * k / (k * k + 4.0));
    for (reflected, wanted) in reflected.into_iter().zip([0.2, 0.0, 0.9999]) {
        assert!((reflected - wanted).abs() < 1e-12, "{reflected} is not {wanted}");
    }
    assert_eq!(index("'texture reflectance' 'map'"), None);
}

#[test]
fn glasses_have_their_index_at_the_d_line() {
    // The rows of pbrt's tables on either side of 587.56 nm.
    for (name, [from, below], [to, above]) in [
        ("BK7", [586.0, 1.516_865_556_749], [608.0, 1.515_984_669_181_6]),
        ("BAF10", [586.0, 1.670_107_353_046_2], [608.0, 1.668_616_016_824_9]),
        ("FK51A", [577.0, 1.486_875_258_765], [599.0, 1.486_217_243_501]),
        ("LASF9", [583.0, 1.850_865_855_6], [604.0, 1.848_114_809_928_5]),
        ("F5", [583.0, 1.673_192_892_990_8], [604.0, 1.671_024_823_474_3]),
        ("F10", [570.0, 1.730_532_456_282_9], [592.0, 1.727_715_181_802_6]),
        ("F11", [583.0, 1.785_426_602_677_4], [604.0, 1.782_278_668_315_6]),
    ] {
        let parameter = format!("eta' 'glass-{name}'");
        let Some(Reflectance::Dielectric(Interval { min: eta, .. })) =
            fresnel(&format!("'dielectric' 'spectrum {parameter}"))
        else {
            panic!("{name}")
        };
        let read = below + (587.56 - from) / (to - from) * (above - below);
        assert!((eta - read).abs() < 6e-6, "{name}: {eta} is not {read}");
        let under = fresnel(&format!("'coatedconductor' 'spectrum interface.{parameter}"));
        assert_eq!(under, Some(over(eta, Metal::Copper.eta(), Metal::Copper.k())));
    }
}
