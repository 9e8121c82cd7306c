//! Documents as they are: included, not well formed, with images in tiles.

use super::document;
use crate::{Folder, assert_close, assert_refused, assert_warned, load, names, png, png_of};

const TEXTURED: &str = r#"<image name="i" type="float"><input name="file" value="a.png"/></image>
    <gltf_pbr name="a" type="surfaceshader"><input name="roughness" nodename="i"/></gltf_pbr>"#;

#[test]
fn an_included_document_keeps_its_folder_and_its_prefix() {
    let roots = [
        // The prefix of one document, in the folder of the other, and both.
        ("fileprefix='maps/'", "", "sub/a.png"),
        ("", "fileprefix='maps/'", "sub/maps/a.png"),
        ("fileprefix='other/'", "fileprefix='maps/'", "sub/maps/a.png"),
    ];
    for (outer, inner, image) in roots {
        let include = format!(
            "<materialx {outer} xmlns:xi='http://www.w3.org/2001/XInclude'><xi:include href='sub/b.mtlx'/></materialx>"
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
        assert_close(scene.materials[0].lobe.roughness, [0.04, 0.16], [0.04, 0.16]);
    }
}

#[test]
fn an_included_document_that_cannot_be_used_costs_itself_alone() {
    let load = |href: &str| {
        let include = |href: &str| format!("\n<xi:include href='{href}'/>");
        let sound = "<gltf_pbr name='a' type='surfaceshader'/>";
        let broken = "<materialx>\n<gltf_pbr></materialx>";
        let folder = Folder::new(&[
            ("a.mtlx", document(&(include(href) + sound + &include("c.mtlx")))),
            ("b.mtlx", broken.to_owned()),
            ("c.mtlx", document("<gltf_pbr name='c' type='surfaceshader'/>")),
        ]);
        let scene = folder.load("a.mtlx").unwrap();
        assert_eq!(names(&scene), ["a", "c"]);
        scene
    };
    for folder in [".", ""] {
        let named = format!("\"{folder}\" is a folder");
        assert_warned(&load(folder), "a.mtlx:2:1", &[&named, "are not seen"]);
    }
    let parts = ["b.mtlx is not well formed", "b.mtlx:2:11: expected `</gltf_pbr>`"];
    assert_warned(&load("b.mtlx"), "a.mtlx:2:1", &parts);
}

#[test]
fn tiles_count_together() {
    let text = |file: &str| document(&TEXTURED.replace("a.png", file));
    let dark = png_of(png::ColorType::Rgb, 1, &[0; 3]);
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
                assert_close(scene.materials[0].lobe.roughness, r, r);
            };
            check([0.04, 0.16]);
            // What is no tile is not read.
            for name in &names[2..] {
                folder.write(name, &dark);
            }
            check([0.04, 0.16]);
            folder.write(names[1], &dark);
            check([0.0, 0.16]);
        }
    }
    let none = load("a.mtlx", &text("a.<UDIM>.png"));
    assert!(none.warnings[0].contains("has no tile; it is assumed to cover [0, 1]"));
}

#[test]
fn what_is_not_well_formed_moves_no_place() {
    let tokens: String = (0..300).map(|i| format!(" x{i}='<UDIM>'")).collect();
    let odd = format!(
        "<materialx version='1.39' ns:a='1' ms:a='<UDIM>'>\
         <a b='1 < 2'/><a{tokens}/>\n<q:x r:y='<UDIM>'/>\n"
    );
    let scene =
        load("a.mtlx", &format!("{odd}<gltf_pbr name='a' type='surfaceshader'/></materialx>"));
    assert_eq!(names(&scene), ["a"]);
    assert_eq!(scene.materials[0].origin.place.line, Some(3));
    assert_eq!(scene.materials[0].origin.place.column, Some(1));
    // Also behind it on one line, and for what the parser refuses.
    let one = odd.replace('\n', "");
    let scene =
        load("a.mtlx", &format!("{one}<gltf_pbr name='a' type='surfaceshader'/></materialx>"));
    assert_eq!(scene.materials[0].origin.place.column, Some(1 + one.len() as u32));
    assert_refused("a.mtlx", &format!("{odd}<a></b>"), ":3:4", &["expected `</a>`"]);
    // An include whose prefix is not declared is one.
    let include = "<materialx><xi:include href='b.mtlx'/></materialx>";
    assert!(load("a.mtlx", include).warnings[0].contains("b.mtlx is missing"));
}

#[test]
fn an_ampersand_may_be_a_character() {
    let text = "<materialx doc='this & that, &nbsp; & <UDIM>&'>\n<a b='R&amp;D &#38; &'/>\
        <gltf_pbr name='x&y&amp;&#x7a;' type='surfaceshader'/></materialx>";
    let scene = load("a.mtlx", text);
    assert_eq!(names(&scene), ["x&y&z"]);
    assert_eq!(scene.materials[0].origin.place.column, Some(25));
    // Numbers of what is no character of XML.
    for number in ["0", "xFFFF", "xD800", "99999999999999"] {
        let text = format!(
            "<materialx doc='&#{number};'><gltf_pbr name='a' type='surfaceshader'/></materialx>"
        );
        assert_eq!(names(&load("a.mtlx", &text)), ["a"], "{number}");
    }
    // What else is wrong has its own place.
    let text = "<materialx doc='this & that'>\n<a b='&'></c></materialx>";
    assert_refused("a.mtlx", text, ":2:10", &["expected `</a>`"]);
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

#[test]
fn an_input_that_a_node_has_not_is_warned_of() {
    let case = |content: &str, parts: &[&str]| {
        let scene = load("a.mtlx", &document(&content.replace("<input", "\n<input")));
        assert_warned(&scene, "a.mtlx:2:1", parts);
        assert_eq!(scene.doubts().count(), 1);
    };
    let node = |class: &str, of_type: &str, input: &str| {
        format!("<{class} name='a' type='{of_type}'><input name='{input}' value='0.5'/></{class}>")
    };
    for (class, input, near) in [
        ("standard_surface", "specular_roughnes", "specular_roughness"),
        ("open_pbr_surface", "specular_IOR", "specular_ior"),
        ("gltf_pbr", "roughnes", "roughness"),
        ("UsdPreviewSurface", "clearcoatRoughnes", "clearcoatRoughness"),
        ("disney_principled", "rougness", "roughness"),
        ("surface", "bdsf", "bsdf"),
    ] {
        let parts = [&format!("{class} has no parameter `{input}`")[..], &format!("`{near}`?")];
        case(&node(class, "surfaceshader", input), &parts);
    }
    for (class, of_type, input) in [
        ("conductor_bsdf", "BSDF", "rouhgness"),
        ("generalized_schlick_bsdf", "BSDF", "rouhgness"),
        ("roughness_anisotropy", "vector2", "rouhgness"),
        ("surfacematerial", "material", "surface_shader"),
        ("image", "float", "fil"),
        ("multiply", "float", "in3"),
    ] {
        let part = format!("{class} has no parameter `{input}`");
        case(&node(class, of_type, input), &[&part]);
    }
    // A node that the document defines has the inputs of its definition, also inherited ones.
    let own = "<nodedef name='d' node='mine' inherit='e'/><nodedef name='e' node='other'>\
               <input name='rough'/><output name='o' type='float'/></nodedef>";
    let mine = node("mine", "float", "ruogh");
    let scene = load("a.mtlx", &document(&format!("{own}\n{mine}")));
    assert_warned(&scene, ":2:29", &["mine has no parameter `ruogh`", "`rough`?"]);
    for sound in [
        format!("{own}{}", node("mine", "float", "rough")),
        format!("{own}{}", node("mine", "float", "ruogh")).replace("name='e'", "name='f'"),
        node("noise2d", "float", "anything"),
        node("standard_surface", "surfaceshader", "coat_normal"),
        node("open_pbr_surface", "surfaceshader", "specular_haze_spread"),
    ] {
        assert_eq!(load("a.mtlx", &document(&sound)).warnings, [""; 0], "{sound}");
    }
}

#[test]
fn known_inputs_that_are_not_read_are_said_unless_they_are_zero() {
    let input = |name: &str, value: &str| {
        let text = format!("\n<input name='{name}' value='{value}'/>");
        let shader = "open_pbr_surface name='a' type='surfaceshader'";
        load("a.mtlx", &document(&format!("<{shader}>{text}</open_pbr_surface>")))
    };
    for name in ["specular_haze", "specular_retroreflectivity"] {
        let scene = input(name, "0.5");
        assert_warned(&scene, ":1:27", &[name, "is not read; the lobe is without it"]);
        assert_eq!(names(&scene), ["a"]);
        assert_eq!(input(name, "0").warnings, [""; 0]);
    }
    let retro = |value: &str| {
        let node = format!(
            "<conductor_bsdf name='c' type='BSDF'>\n\
            <input name='retroreflective' type='boolean' value='{value}'/></conductor_bsdf>"
        );
        let surface =
            "<surface name='a' type='surfaceshader'><input name='bsdf' nodename='c'/></surface>";
        load("a.mtlx", &document(&(node + surface)))
    };
    assert_warned(&retro("true"), ":2:1", &["retroreflective is not read"]);
    assert_eq!(retro("false").warnings, [""; 0]);
}

/// As in `pbrlib/multioutput` of MaterialX' own suite.
#[test]
fn an_output_alone_is_one_of_the_document() {
    let scene = |output: &str| {
        load(
            "a.mtlx",
            &document(&format!(
                "<constant name='c' type='color4'><input name='value' value='1, 0.25, 0.25, 0.42'/></constant>
                 <extract name='e' type='float'><input name='in' nodename='c'/><input name='index' value='3'/></extract>
                 <output name='alpha' type='float' nodename='e'/>
                 <standard_surface name='s' type='surfaceshader'>
                 <input name='specular_roughness' type='float' output='{output}'/></standard_surface>
                 <output name='shader' type='surfaceshader' nodename='s'/>
                 <surfacematerial name='m' type='material'><input name='surfaceshader' output='shader'/></surfacematerial>"
            )),
        )
    };
    let found = scene("alpha");
    assert_eq!((names(&found), &found.warnings[..]), (vec!["m"], &[][..]));
    assert_close(found.materials[0].lobe.roughness, [0.1764; 2], [0.1764; 2]);
    let none = scene("alhpa");
    assert!(none.ignored[0].reason.contains("there is no output \"alhpa\""), "{none:?}");
}
