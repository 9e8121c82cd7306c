//! The line and column of an error are those that an editor shows, in every format.

use crate::{Folder, assert_not_understood, assert_refused, load};

/// Checks the line and column of an error: `$` in `marked` is taken out, and stands before the
/// error.
fn check(name: &str, marked: &str, message: &str) {
    let before = marked.split('$').next().unwrap();
    let line = 1 + before.matches('\n').count();
    let column = 1 + before.rsplit('\n').next().unwrap().chars().count();
    let place = format!(":{line}:{column}");
    let text = marked.replace('$', "");
    let ends: &[&str] =
        if name.ends_with("toml") { &["\n", "\r\n"] } else { &["\n", "\r\n", "\r"] };
    for mark in ["", "\u{feff}"] {
        for end in ends {
            let text = format!("{mark}{}", text.replace('\n', end));
            assert_refused(name, &text, &place, &[message]);
        }
    }
}

#[test]
fn in_recipes() {
    let material = "[[material]]\nname = \"é∞\"\nsigma = 0.3\n";
    check("r.toml", "x$", "key with no value");
    check("r.toml", "[[$materials]]\n", "did you mean `material`");
    check("r.toml", &format!("# é\n\n{material}gamma = $1"), "out of range");
    check("r.toml", &format!("{material}gamma = 2\n\n\n$\"é\" = 1"), "unknown key `é`");
    check("r.toml", &format!("{material}fresnel = {{ \"é∞\" = 1, x$"), "expected");
}

#[test]
fn in_pbrt_scenes() {
    check("s.pbrt", "$Foo", "unknown directive Foo");
    check("s.pbrt", "# é\n\nTexture \"é\" \"float\" \"constant\" $[1]", "not \"[\"");
    let list = "\"point P\" [1 2\n3 # é ]\n4\n]";
    check("s.pbrt", &format!("Shape \"mesh\" {list}\n\n  $Foo"), "unknown directive Foo");
    check("s.pbrt", "Material \"é∞\" $\"roughness\" 1", "declares no parameter");
    check("s.pbrt", "Material \"é\" \"string a\" $\"open\n", "no closing quote");
    check(
        "s.pbrt",
        "Shape \"mesh\" \"string é\" [\"é\" 1 2 \"∞\"] \"float b\" $[ 1\n\n",
        "bracket",
    );
}

#[test]
fn in_mitsuba_scenes() {
    check("s.xml", "$<s>\n</s>", "is not the root");
    // The reason why a BSDF is not understood has the line and column of the wrong element in it.
    let bsdf = "<bsdf id='a' type='roughconductor'><float name='alpha' value='x'/></bsdf>";
    let scene = load("s.xml", &format!("<scene>\n\n<!-- é\n-->é{bsdf}</scene>"));
    assert_not_understood(&scene, "a", ":4:5", &["s.xml:4:40: ", "number"]);
    check("s.xml", "<scene>\n\n<!-- é\n-->é<a>$</b>", "expected `</a>`");
    check("s.xml", "<scene>\n$< ", "tag not closed");
}

#[test]
fn in_xml_that_is_not_well_formed() {
    for (marked, message) in [
        ("<scene>\n\n  <bsdf type=$x id='a'/></scene>", "must be enclosed in"),
        ("<scene>\n<a b$/></scene>", "followed by `=`"),
        ("<scene>\n<a b=$/></scene>", "followed by an attribute value"),
        ("<scene>\n</scene>\n $é", "text stands outside the root"),
        ("$junk <scene/>", "text stands outside the root"),
        ("<!-- é -->\n$<![CDATA[ a ]]><scene/>", "text stands outside the root"),
        ("<scene/>\n$&amp;", "text stands outside the root"),
        ("<scene>\n<$></></scene>", "no name"),
        ("<scene>\n<a $b:='1'/></scene>", "no name"),
        ("<scene>\n<bsdf type='é' $type='b'/></scene>", "second attribute \"type\""),
        ("<scene>\n<a xmlns:b='1' $xmlns:b='2'/></scene>", "second attribute \"xmlns:b\""),
        ("\n$<!DOCTYPE scene [<!ENTITY x SYSTEM 'm.xml'>]><scene>&x;</scene>", "entities"),
        ("\n$<!DOCTYPE scene SYSTEM 'scene.dtd'><scene>&x;</scene>", "entities"),
    ] {
        check("s.xml", marked, message);
    }
    // Renderers do not check any of these.
    let metal = "<bsdf type='roughconductor'/>";
    for text in [
        format!("<scene>\0&nbsp; & <![CDATA[ & ]]>{metal}</scene>"),
        format!("<scene a='1'b='2'>{metal}</scene>"),
        format!("<!DOCTYPE scene>\n<scene><1/>{metal}</scene> \n"),
        format!("<scene x:a='1' y:a='2'>{metal}</scene>"),
    ] {
        assert_eq!(load("s.xml", &text).materials.len(), 1, "{text}");
    }
}

#[test]
fn in_materialx_documents() {
    check("s.mtlx", "$<s/>\n", "is not the root");
    check("s.mtlx", "<materialx version='1.38'>\n\n<!-- é\n-->é<a>$</b>", "expected `</a>`");
}

#[test]
fn in_gltf_scenes() {
    check("s.gltf", "$x", "expected value");
    check(
        "s.gltf",
        "{\"asset\": {\"version\": \"2.0\"},\n\n\"é∞\": 1, $x}\n",
        "key must be a string",
    );
    check("s.gltf", "{\n\"asset\": {\"version\": \"2.0\"$}", "EOF");
}

#[test]
fn what_is_no_file_is_said_before_its_format() {
    let folder = Folder::new(&[("scene", "")]);
    let message = folder.load("scene").unwrap_err().to_string();
    assert!(message.contains("no extension") && message.contains(".toml"), "{message}");
    for name in ["folder", "f.toml", "f.pbrt", "f.xml", "f.mtlx", "f.gltf", "f.glb", "f.txt"] {
        std::fs::create_dir(folder.path(name)).unwrap();
        let message = folder.load(name).unwrap_err().to_string();
        assert!(message.contains(&format!("{name}: cannot be read: is a folder")), "{message}");
    }
    let message = folder.load("absent").unwrap_err().to_string();
    assert!(message.contains("absent: cannot be read"), "{message}");
}

/// Columns of minified files are found at once: a million elements may stand on one line.
#[test]
fn a_long_line_has_columns() {
    let bsdf = "<bsdf type='diffuse'/>é";
    let text = format!("<scene>{}</scene>", bsdf.repeat(50_000));
    let scene = load("s.xml", &text);
    let place = &scene.ignored[49_999].place;
    let column = 8 + 49_999 * bsdf.chars().count();
    assert_eq!((place.line, place.column), (Some(1), u32::try_from(column).ok()));
}
