//! Shading models, against the graphs that define them.

use microfacet_baker::scene::{Material, Reflectance, Roughness};
use microfacet_tables::Interval;

use super::{coloured, document, shader};
use crate::{anisotropic, assert_close, isotropic, load, names};

#[track_caller]
fn assert_schlick(material: &Material, f0: f64) {
    let Some(Reflectance::Schlick(found)) = material.fresnel else {
        panic!("{:?}", material.fresnel)
    };
    assert!(found.iter().all(|found| (found - f0).abs() < 1e-12), "{found:?} is not {f0}");
}

/// n and k of a metal with the reflectance r at normal incidence, for edge colours 0 and 1.
fn gulbrandsen(r: f64, edge: f64) -> [f64; 2] {
    let n = if edge == 0.0 { (1.0 + r.sqrt()) / (1.0 - r.sqrt()) } else { (1.0 - r) / (1.0 + r) };
    // r = ((n - 1)^2 + k^2) / ((n + 1)^2 + k^2)
    [n, ((r * (n + 1.0).powi(2) - (n - 1.0).powi(2)) / (1.0 - r)).max(0.0).sqrt()]
}

#[track_caller]
fn assert_conductor(material: &Material, expected: [f64; 2]) {
    let Some(Reflectance::Conductor { eta, k }) = material.fresnel else {
        panic!("{:?}", material.fresnel)
    };
    for i in 0..3 {
        assert!((eta[i] - expected[0]).abs() < 1e-12 && (k[i] - expected[1]).abs() < 1e-12);
    }
}

#[test]
fn gltf_pbr() {
    let default = shader("gltf_pbr", &[]);
    assert_eq!(default.materials[0].lobe.roughness, isotropic(1.0));
    assert_schlick(&default.materials[0], 1.0);

    let dielectric = |inputs: &[(&str, f64)]| {
        shader("gltf_pbr", &[&[("metallic", 0.0), ("roughness", 0.5)], inputs].concat())
    };
    let plain = dielectric(&[]);
    assert_eq!(plain.materials[0].lobe.roughness, isotropic(0.25));
    assert_schlick(&plain.materials[0], 0.04);
    assert_schlick(&dielectric(&[("ior", 3.0)]).materials[0], 0.25);
    for (input, value) in [("specular", 0.5), ("iridescence", 1.0), ("metallic", 0.5)] {
        let scene = shader("gltf_pbr", &[(input, value)]);
        let fresnel = dielectric(&[(input, value)]).materials[0].fresnel;
        assert!(fresnel.is_none() || input == "metallic", "{input}: {fresnel:?}");
        assert!(scene.materials[0].fresnel.is_none() || input == "specular", "{input}");
    }
    // Along the tangent, the mixture of r^2 = 0.25 and 1 by 0.6^2.
    let brushed = dielectric(&[("anisotropy_strength", 0.6)]);
    assert_close(brushed.materials[0].lobe.roughness, [0.25 + 0.75 * 0.36; 2], [0.25; 2]);

    let coated = dielectric(&[("clearcoat", 1.0), ("clearcoat_roughness", 0.3)]);
    assert_eq!(names(&coated), ["a", "a.clearcoat"]);
    assert_close(coated.materials[1].lobe.roughness, [0.09; 2], [0.09; 2]);
    assert_eq!(coated.materials[1].fresnel, Some(Reflectance::dielectric(1.5)));

    assert!(dielectric(&[("specular", 0.0)]).ignored[0].reason.contains("diffuse"));
    let fabric = coloured("gltf_pbr", &[("sheen_color", "0, 0, 0.5")]);
    assert_eq!(fabric.ignored[0].name, "a.sheen_color");
    assert_schlick(&coloured("gltf_pbr", &[("base_color", "0.5, 0.5, 0.5")]).materials[0], 0.5);
}

#[test]
fn usd_preview_surface() {
    let default = shader("UsdPreviewSurface", &[]);
    assert_eq!(default.materials[0].lobe.roughness, isotropic(0.25));
    assert_schlick(&default.materials[0], 0.04);

    let inputs = [("useSpecularWorkflow", "1"), ("specularColor", "0.3, 0.3, 0.3")];
    assert_schlick(&coloured("UsdPreviewSurface", &inputs).materials[0], 0.3);
    let inputs = [("metallic", "1"), ("diffuseColor", "0, 0, 0")];
    assert_conductor(&coloured("UsdPreviewSurface", &inputs).materials[0], gulbrandsen(0.0, 0.0));
    assert_eq!(shader("UsdPreviewSurface", &[("metallic", 0.5)]).materials[0].fresnel, None);

    let coated = shader("UsdPreviewSurface", &[("clearcoat", 1.0), ("ior", 3.0)]);
    assert_close(coated.materials[1].lobe.roughness, [1e-4; 2], [1e-4; 2]);
    assert_schlick(&coated.materials[1], 0.25);
}

#[test]
fn disney_principled() {
    let brushed = shader("disney_principled", &[("roughness", 0.6), ("anisotropic", 0.36)]);
    // The aspect is sqrt(1 - 0.36) = 0.8.
    assert_close(brushed.materials[0].lobe.roughness, [0.45; 2], [0.288; 2]);
    assert_eq!(brushed.materials[0].fresnel, None);
    let metal = coloured("disney_principled", &[("metallic", "1"), ("baseColor", "0.7, 0.7, 0.7")]);
    assert_schlick(&metal.materials[0], 0.7);

    let coated = shader("disney_principled", &[("clearcoat", 1.0), ("clearcoatGloss", 0.75)]);
    assert_eq!(names(&coated), ["a", "a.clearcoat"]);
    assert_eq!(coated.materials[1].lobe.roughness, isotropic(0.0625));
    let glossy = shader("disney_principled", &[("clearcoat", 1.0)]);
    assert_eq!(glossy.materials[1].lobe.roughness, Roughness::Smooth);

    assert_eq!(shader("disney_principled", &[("sheen", 1.0)]).ignored[0].name, "a.sheen");
    assert_eq!(shader("disney_principled", &[("specular", 0.0)]).materials, []);
}

#[test]
fn a_specular_weight_changes_the_index() {
    let weighted = |inputs: &[(&str, f64)]| shader("open_pbr_surface", inputs);
    let fresnel = |weight: f64, ior: f64| {
        let inputs = [("specular_weight", weight), ("specular_ior", ior)];
        let Some(Reflectance::Dielectric(Interval { min: eta, .. })) =
            weighted(&inputs).materials[0].fresnel
        else {
            panic!("no dielectric")
        };
        eta
    };
    // F0 of 1.5 is 0.04, of which half is that of (1 + sqrt(0.02)) / (1 - sqrt(0.02)).
    let close = |a: f64, b: f64| assert!((a - b).abs() < 1e-12, "{a} is not {b}");
    let half = (1.0 + 0.02f64.sqrt()) / (1.0 - 0.02f64.sqrt());
    close(fresnel(0.5, 1.5), half);
    close(fresnel(0.5, 1.0 / 1.5), 1.0 / half);
    assert_eq!(fresnel(1.0, 1.5), 1.5);
    // 0.04 times 4 is 0.16 = 0.4^2; no F0 is above 0.99999.
    close(fresnel(4.0, 1.5), 1.4 / 0.6);
    let most = 0.99999f64.sqrt();
    assert!((fresnel(100.0, 1.5) * (1.0 - most) / (1.0 + most) - 1.0).abs() < 1e-9);

    let text = document(
        r#"<image name="i" type="float"><input name="file" value="absent.png"/></image>
        <open_pbr_surface name="a" type="surfaceshader">
          <input name="specular_weight" type="float" nodename="i"/></open_pbr_surface>"#,
    );
    assert_eq!(load("a.mtlx", &text).materials[0].fresnel, None, "it varies");

    // Without weight the dielectric has no interface, and the metal no lobe.
    let none = |more: &[(&str, f64)]| weighted(&[&[("specular_weight", 0.0)], more].concat());
    assert_eq!(none(&[]).materials, []);
    let metal = ("base_metalness", 1.0);
    assert_eq!(none(&[metal]).materials, []);
    let glass = ("transmission_weight", 1.0);
    assert_eq!(none(&[metal, glass]).materials, []);
    assert_eq!(none(&[glass]).materials[0].fresnel, Some(Reflectance::dielectric(1.0)));
    assert_eq!(names(&none(&[("base_metalness", 0.5), glass])), ["a"]);
    assert_schlick(&weighted(&[metal, ("specular_weight", 0.5)]).materials[0], 0.8);
}

#[test]
fn metals_have_the_reflectance_of_their_colour() {
    let metal = |inputs: &[(&str, &str)]| {
        coloured("standard_surface", &[&[("metalness", "1")], inputs].concat()).materials[0].clone()
    };
    assert_conductor(&metal(&[]), gulbrandsen(0.8, 1.0));
    let dark = [("base", "0.5"), ("base_color", "0.5 0.5 0.5"), ("specular", "0")];
    assert_conductor(&metal(&dark), gulbrandsen(0.25, 0.0));
    assert_eq!(coloured("standard_surface", &[("metalness", "0.5")]).materials[0].fresnel, None);
    assert_eq!(metal(&[("thin_film_thickness", "300")]).fresnel, None);

    let open = |inputs: &[(&str, &str)]| {
        coloured("open_pbr_surface", &[&[("base_metalness", "1")], inputs].concat())
    };
    assert_schlick(&open(&[]).materials[0], 0.8);
    assert_eq!(open(&[("specular_color", "0.9, 0.9, 0.9")]).materials[0].fresnel, None);
    let copper = open(&[("base_weight", "0.5"), ("base_color", "0.9, 0.6, 0.3")]);
    assert_eq!(copper.materials[0].fresnel, Some(Reflectance::Schlick([0.45, 0.3, 0.15])));
    // No F0 exceeds 1.
    assert_eq!(open(&[("base_color", "1.2, 0.6, 0.3")]).materials[0].fresnel, None);
    assert_ne!(open(&[]).materials[0].lobe.roughness, anisotropic(0.09, 0.09));
}
