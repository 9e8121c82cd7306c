//! Documents as they are: included, not well formed, with images in tiles.

use super::document;
use crate::{Folder, assert_close, assert_refused, assert_warned, load, names, png};

const TEXTURED: &str = r#"<image name="i" type="float"><input name="file" value="a.png"/></image>
    <gltf_pbr name="a" type="surfaceshader"><input name="roughness" nodename="i"/></gltf_pbr>"#;

#[test]
fn an_included_document_keeps_its_folder_and_its_prefix() {
    let roots = [
        // The prefix of one document, in the folder of the other, and both.
        ("fileprefix=\"maps/\"", "", "sub/a.png"),
        ("", "fileprefix=\"maps/\"", "sub/maps/a.png"),
        ("fileprefix=\"other/\"", "fileprefix=\"maps/\"", "sub/maps/a.png"),
    ];
    for (outer, inner, image) in roots {
        let include = format!(
            "<materialx {outer} xmlns:xi=\"http://www.w3.org/2001/XInclude\"><xi:include href=\"sub/b.mtlx\"/></materialx>"
        );
        let folder = Folder::new(&[("a.mtlx", include)]);
        std::fs::create_dir_all(folder.path("sub/maps")).unwrap();
        std::fs::write(
            folder.path("sub/b.mtlx"),
            format!("<materialx {inner}>{TEXTURED}</materialx>"),
        )
        .unwrap();
        std::fs::write(folder.path(image), png()).unwrap();
        let scene = folder.load("a.mtlx").unwrap();
        assert_eq!(scene.warnings, [""; 0], "{outer} {inner}");
        assert_close(scene.materials[0].roughness, [0.04, 0.16], [0.04, 0.16]);
    }
}

#[test]
fn an_included_document_that_cannot_be_used_costs_itself_alone() {
    let load = |href: &str| {
        let include = |href: &str| format!("\n<xi:include href=\"{href}\"/>");
        let sound = "<gltf_pbr name=\"a\" type=\"surfaceshader\"/>";
        let broken = "<materialx>\n<gltf_pbr></materialx>";
        let folder = Folder::new(&[
            ("a.mtlx", document(&(include(href) + sound + &include("c.mtlx")))),
            ("b.mtlx", broken.to_owned()),
            ("c.mtlx", document("<gltf_pbr name=\"c\" type=\"surfaceshader\"/>")),
        ]);
        let scene = folder.load("a.mtlx").unwrap();
        assert_eq!(names(&scene), ["a", "c"]);
        scene
    };
    for folder in [".", ""] {
        let named = format!("\"{folder}\" is a folder");
        assert_warned(&load(folder), "a.mtlx:2:1", &[&named, "are not seen"]);
    }
    let parts = ["b.mtlx is not well formed", "b.mtlx:2:11: expected 'gltf_pbr' tag"];
    assert_warned(&load("b.mtlx"), "a.mtlx:2:1", &parts);
}

#[test]
fn tiles_count_together() {
    let text = |file: &str| document(&TEXTURED.replace("a.png", file));
    let dark = image::RgbImage::from_pixel(1, 1, image::Rgb([0, 0, 0]));
    for (token, names) in [
        ("<UDIM>", ["a.1001.png", "a.1012.png", "a.0999.png", "a.10010.png"]),
        ("<UVTILE>", ["a.u1_v1.png", "a.u2_v12.png", "a.u_v1.png", "a.1001.png"]),
    ] {
        // Raw, as renderers accept it, and as XML asks for it.
        for token in [token.to_owned(), token.replace('<', "&lt;")] {
            let folder = Folder::new(&[
                ("a.mtlx", text(&format!("a.{token}.png")).into_bytes()),
                (names[0], png()),
            ]);
            let check = |r: [f64; 2]| {
                let scene = folder.load("a.mtlx").unwrap();
                assert_eq!(scene.warnings, [""; 0]);
                assert_close(scene.materials[0].roughness, r, r);
            };
            check([0.04, 0.16]);
            // What is no tile is not read.
            for name in &names[2..] {
                dark.save(folder.path(name)).unwrap();
            }
            check([0.04, 0.16]);
            dark.save(folder.path(names[1])).unwrap();
            check([0.0, 0.16]);
        }
    }
    let none = load("a.mtlx", &text("a.<UDIM>.png"));
    assert!(none.warnings[0].contains("has no tile; it is assumed to cover [0, 1]"));
}

#[test]
fn what_is_mended_moves_no_place() {
    let odd = "<materialx version=\"1.39\" ns:a=\"1\" ms:a=\"<UDIM>\">\n<q:x r:y=\"<UDIM>\"/>\n";
    let scene =
        load("a.mtlx", &format!("{odd}<gltf_pbr name=\"a\" type=\"surfaceshader\"/></materialx>"));
    assert_eq!(names(&scene), ["a"]);
    assert_eq!(scene.materials[0].origin.place.line, Some(3));
    assert_eq!(scene.materials[0].origin.place.column, Some(1));
    // Also behind it on one line, and for what the parser refuses.
    let one = odd.replace('\n', "");
    let scene =
        load("a.mtlx", &format!("{one}<gltf_pbr name=\"a\" type=\"surfaceshader\"/></materialx>"));
    assert_eq!(scene.materials[0].origin.place.column, Some(1 + one.len() as u32));
    assert_refused("a.mtlx", &format!("{odd}<a></b>"), ":3:4", &["expected 'a' tag"]);
    let raw = "<materialx>\n<a b=\"1 < 2\"/></materialx>";
    assert_refused("a.mtlx", raw, ":2:9", &["'<'"]);
    let many: String = (0..300).map(|i| format!(" x{i}=\"<UDIM>\"")).collect();
    let many = format!("<materialx>\n<a{many}/></materialx>");
    assert_refused("a.mtlx", &many, ":2:2", &["256 attributes"]);
    // An include whose prefix is not declared is one.
    let include = "<materialx><xi:include href=\"b.mtlx\"/></materialx>";
    assert!(load("a.mtlx", include).warnings[0].contains("b.mtlx is missing"));
}

#[test]
fn an_ampersand_may_be_a_character() {
    let text = "<materialx doc=\"this & that, &nbsp; & <UDIM>&\">\n<a b=\"R&amp;D &#38; &\"/>\
        <gltf_pbr name=\"x&y&amp;&#x7a;\" type=\"surfaceshader\"/></materialx>";
    let scene = load("a.mtlx", text);
    assert_eq!(names(&scene), ["x&y&z"]);
    assert_eq!(scene.materials[0].origin.place.column, Some(25));
    // Numbers of what is no character of XML.
    for number in ["0", "xFFFF", "xD800", "99999999999999"] {
        let text = format!(
            "<materialx doc=\"&#{number};\"><gltf_pbr name=\"a\" type=\"surfaceshader\"/></materialx>"
        );
        assert_eq!(names(&load("a.mtlx", &text)), ["a"], "{number}");
    }
    // What else is wrong has its own place.
    let text = "<materialx doc=\"this & that\">\n<a b=\"&\"></c></materialx>";
    assert_refused("a.mtlx", text, ":2:10", &["expected 'a' tag"]);
}

#[test]
fn materials_of_one_shader_have_their_own_names() {
    let text = document(
        r#"<gltf_pbr name="s" type="surfaceshader"><input name="clearcoat" value="1"/></gltf_pbr>
        <surfacematerial name="m"><input name="surfaceshader" nodename="s"/></surfacematerial>
        <nodegraph name="g"><gltf_pbr name="t" type="surfaceshader"/>
          <output name="first" type="surfaceshader" nodename="u"/>
          <gltf_pbr name="u" type="surfaceshader"/>
          <output name="second" type="surfaceshader" nodename="t"/></nodegraph>
        <surfacematerial name="n"><input name="surfaceshader" nodename="s"/>
          <input name="backsurfaceshader" nodename="s"/></surfacematerial>
        <surfacematerial name="o"><input name="surfaceshader" nodegraph="g" output="second"/></surfacematerial>
        <surfacematerial name="p"><input name="surfaceshader" nodename="absent"/></surfacematerial>
        <surfacematerial name="q"/>"#,
    );
    let scene = load("a.mtlx", &text);
    assert_eq!(names(&scene), ["m", "m.clearcoat", "n", "n.clearcoat", "o", "u"]);
    let ignored: Vec<_> = scene.ignored.iter().map(|i| (&i.name[..], i.understood)).collect();
    assert_eq!(ignored, [("p", false), ("q", true)]);
}

#[test]
fn shaders_that_others_are_made_of_are_no_materials() {
    let text = document(
        r#"<gltf_pbr name="a" type="surfaceshader"/><UsdPreviewSurface name="b" type="surfaceshader"/>
        <mix name="m" type="surfaceshader"><input name="fg" type="surfaceshader" nodename="a"/>
          <input name="bg" type="surfaceshader" nodename="b"/><input name="mix" value="0.5"/></mix>"#,
    );
    assert_eq!(names(&load("a.mtlx", &text)), ["m", "m (2)"]);
}
