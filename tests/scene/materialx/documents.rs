//! Documents as they are: included, not well formed, with images in tiles.

use super::document;
use crate::{Folder, assert_close, assert_refused, load, names, png, png_of};

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
