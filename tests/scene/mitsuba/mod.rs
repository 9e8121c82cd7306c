//! Mitsuba 3 scenes.

mod fresnel;

use microfacet_baker::scene::{Format, Masking, Reflectance, Roughness};
use microfacet_sampler::Metal;
use microfacet_tables::Interval;

use crate::{Folder, anisotropic, assert_close, assert_warned, isotropic, load, named, names, png};

fn scene(content: &str) -> String {
    format!("<scene version='3.0.0'>{content}</scene>")
}

fn bsdf(class: &str, properties: &str) -> String {
    scene(&format!("<bsdf type='{class}' id='a'>{properties}</bsdf>"))
}

#[test]
fn rough_plugins_take_alpha_as_written() {
    let scene = load(
        "a.xml",
        &scene(
            r#"
            <bsdf type="roughconductor" id="brushed">
                <string name="material" value="Au"/>
                <string name="distribution" value="beckmann"/>
                <float name="alpha_u" value="0.04"/>
                <float name="alpha_v" value="0.2"/>
            </bsdf>
            <bsdf type="roughdielectric" id="glass">
                <string name="int_ior" value="water"/>
                <float name="ext_ior" value="1"/>
                <string name="distribution" value="GGX"/>
            </bsdf>
            <bsdf type="roughplastic" id="plastic">
                <float name="alpha" value="0.3"/>
                <string name="distribution" value="ggx"/>
            </bsdf>
            <bsdf type="conductor" id="mirror">
                <string name="material" value="none"/>
            </bsdf>
            <bsdf type="roughconductor" id="copper">
                <rgb name="eta" value="0.2, 0.9, 1.1"/>
                <rgb name="k" value="3.9 2.4 2.2"/>
            </bsdf>
            <bsdf type="diffuse" id="wall"/>
            "#,
        ),
    );
    let names_wanted = ["brushed", "glass", "plastic", "mirror", "copper"];
    assert_eq!(names(&scene), names_wanted);
    for material in &scene.materials {
        assert_eq!(material.masking, Some(Masking::Uncorrelated));
        assert_eq!(material.origin.format, Format::Mitsuba);
        assert!(material.used);
    }
    let brushed = named(&scene, "brushed");
    assert_eq!(brushed.lobe.roughness, anisotropic(0.04, 0.2));
    assert_eq!(brushed.lobe.gamma, Interval::point(f64::INFINITY));
    assert_eq!(brushed.fresnel, Some(Metal::Gold.into()));
    assert_eq!(brushed.origin.place.line, Some(2));
    let glass = named(&scene, "glass");
    assert_eq!(glass.lobe.roughness, isotropic(0.1));
    assert_eq!(glass.lobe.gamma, Interval::point(2.0));
    assert_eq!(glass.fresnel, Some(Reflectance::dielectric(1.333)));
    let plastic = named(&scene, "plastic");
    assert_eq!(plastic.lobe.roughness, isotropic(0.3));
    assert_eq!(plastic.fresnel, Some(Reflectance::dielectric(1.49 / 1.000_277)));
    let mirror = named(&scene, "mirror");
    assert_eq!(mirror.lobe.roughness, Roughness::Smooth);
    assert_eq!(mirror.fresnel, Some(Reflectance::Mirror));
    let copper = named(&scene, "copper");
    assert_eq!(copper.lobe.gamma, Interval::point(f64::INFINITY), "the default distribution");
    let (eta, k) = ([0.2, 0.9, 1.1], [3.9, 2.4, 2.2]);
    assert_eq!(copper.fresnel, Some(Reflectance::Conductor { eta, k }));
    assert_eq!(scene.ignored[0].kind, "diffuse");
    assert_eq!(scene.warnings, [""; 0]);
}

#[test]
fn principled_squares_the_roughness() {
    let first = |class: &str, properties: &str| load("a.xml", &bsdf(class, properties));
    let default = first("principled", "");
    assert_eq!(default.materials[0].lobe.roughness, isotropic(0.25));
    assert_eq!(default.materials[0].lobe.gamma, Interval::point(2.0));
    // The documented default, specular = 0.5, is an index of 1.5.
    let Some(Reflectance::Dielectric(Interval { min: eta, .. })) = default.materials[0].fresnel
    else {
        panic!("{:?}", default.materials[0].fresnel)
    };
    assert!((eta - 1.5).abs() < 1e-15, "{eta}");

    let smooth = first("principled", "<float name='roughness' value='0'/>");
    assert_eq!(smooth.materials[0].lobe.roughness, isotropic(1e-3), "raised, as Mitsuba does");

    let stretched = first(
        "principled",
        "<float name='roughness' value='0.6'/><float name='anisotropic' value='0.4'/>
         <float name='metallic' value='1'/><float name='clearcoat' value='0.5'/>",
    );
    // aspect = sqrt(1 - 0.9 * 0.4) = 0.8
    assert_close(stretched.materials[0].lobe.roughness, [0.45; 2], [0.288; 2]);
    assert_eq!(stretched.materials[0].fresnel, None);
    assert_eq!(stretched.ignored[0].name, "a.clearcoat");
    assert!(stretched.ignored[0].reason.contains("GTR1"));

    let thin = first(
        "principledthin",
        "<float name='roughness' value='0.6'/><float name='spec_trans' value='1'/>
         <float name='eta' value='2'/>",
    );
    assert_eq!(names(&thin), ["a", "a.transmission"]);
    assert_close(thin.materials[0].lobe.roughness, [0.36; 2], [0.36; 2]);
    // 0.65 * 2 - 0.35 = 0.95
    assert_close(thin.materials[1].lobe.roughness, [0.3249; 2], [0.3249; 2]);
    assert_eq!(first("principledthin", "").materials, []);
}

#[test]
fn nested_bsdfs_are_found_and_used_where_shapes_refer_to_them() {
    let scene = load(
        "a.xml",
        &scene(
            r#"
            <bsdf type="twosided" id="door">
                <bsdf type="bumpmap">
                    <bsdf type="roughconductor"><float name="alpha" value="0.2"/></bsdf>
                </bsdf>
            </bsdf>
            <bsdf type="roughplastic" id="base"/>
            <bsdf type="mask" id="leaf"><ref id="base"/></bsdf>
            <bsdf type="roughplastic" id="spare"/>
            <alias id="leaf" as="leaves"/>
            <shape type="shapegroup" id="tree">
                <shape type="sphere"><ref id="leaves"/><ref name="texture" id="image"/></shape>
            </shape>
            <texture type="bitmap" id="image"/>
            <shape type="cube" id="box">
                <bsdf type="blendbsdf">
                    <bsdf type="roughconductor"/>
                    <bsdf type="roughdielectric"/>
                </bsdf>
            </shape>
            "#,
        ),
    );
    let used: Vec<_> = scene.materials.iter().map(|m| (&m.name[..], m.used)).collect();
    let expected =
        [("door", false), ("base", true), ("spare", false), ("box", true), ("box (2)", true)];
    assert_eq!(used, expected);
}

#[test]
fn parameters_and_includes_are_followed() {
    let folder = Folder::new(&[
        (
            "a.xml",
            scene(
                r#"<default name="rough" value="0.2"/><default name="roughness" value="0.4"/>
                   <path value="more"/>
                   <include filename="$file.xml"/>
                   <default name="file" value="b"/><include filename="$file.xml"/>
                   <bsdf type="roughconductor" id="a"><float name="alpha" value="$roughness"/></bsdf>"#,
            ),
        ),
        (
            "b.xml",
            scene(
                r#"<default name="rough" value="0.9"/>
                   <bsdf type="roughconductor" id="b"><float name="alpha" value="$rough"/></bsdf>
                   <shape type="sphere"><ref id="a"/></shape>"#,
            ),
        ),
    ]);
    let scene = folder.load("a.xml").unwrap();
    assert_eq!(named(&scene, "b").lobe.roughness, isotropic(0.2), "the first default holds");
    assert_eq!(named(&scene, "a").lobe.roughness, isotropic(0.4), "the longest name is meant");
    assert_eq!(scene.warnings.len(), 1);
    assert!(scene.warnings[0].contains("a.xml:3:20: $file.xml is missing"), "{:?}", scene.warnings);
    assert!(named(&scene, "b").used, "something is missing that may use it");
}

#[test]
fn textured_alpha_is_a_range() {
    let folder = Folder::new(&[
        ("grey.png", png()),
        (
            "a.xml",
            scene(
                r#"
                <texture type="bitmap" id="map">
                    <string name="filename" value="grey.png"/><boolean name="raw" value="true"/>
                </texture>
                <bsdf type="roughconductor" id="shared"><ref name="alpha" id="map"/></bsdf>
                <bsdf type="roughconductor" id="own">
                    <texture type="bitmap" name="alpha"><string name="filename" value="grey.png"/></texture>
                </bsdf>
                <bsdf type="roughconductor" id="board">
                    <float name="alpha_u" value="0.5"/>
                    <texture type="checkerboard" name="alpha_v"><float name="color0" value="0.3"/></texture>
                </bsdf>
                <bsdf type="roughconductor" id="absent">
                    <texture type="bitmap" name="alpha"><string name="filename" value="absent.png"/></texture>
                </bsdf>
                "#,
            )
            .into_bytes(),
        ),
    ]);
    let scene = folder.load("a.xml").unwrap();
    let dark = 0.2126 * 0.2 + 0.7152 * 0.4 + 0.0722;
    let light = 0.2126 * 0.4 + 0.7152 * 0.8;
    assert_close(named(&scene, "shared").lobe.roughness, [dark, light], [dark, light]);
    let decoded = |x: f64| ((x + 0.055) / 1.055f64).powf(2.4);
    let dark = 0.2126 * decoded(0.2) + 0.7152 * decoded(0.4) + 0.0722;
    let light = 0.2126 * decoded(0.4) + 0.7152 * decoded(0.8);
    assert_close(named(&scene, "own").lobe.roughness, [dark, light], [dark, light]);
    assert_close(named(&scene, "board").lobe.roughness, [0.5, 0.5], [0.2, 0.3]);
    assert_close(named(&scene, "absent").lobe.roughness, [1e-4, 1.0], [1e-4, 1.0]);
    assert!(scene.warnings.len() == 1 && scene.warnings[0].contains("absent.png"));
}

#[test]
fn an_included_file_of_another_encoding_costs_itself_alone() {
    let whole = scene("<include filename='b.xml'/><bsdf type='roughconductor' id='good'/>");
    let folder = Folder::new(&[("a.xml", whole.as_bytes()), ("b.xml", b"<scene a='\xff'/>")]);
    let scene = folder.load("a.xml").unwrap();
    assert_eq!((names(&scene), scene.included.len()), (vec!["good"], 1));
    assert_warned(&scene, "a.xml:1:24", &["b.xml is not well formed", "UTF-8", "are not seen"]);
}
