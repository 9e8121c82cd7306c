//! Exports of shapes. `clients/c/run` and `clients/gpu/run` compile them and compare their
//! functions with the crate's; the tests here need no compiler.

use std::collections::BTreeMap;
use std::fs;

use crate::common::{names, ok, refused, run};
use crate::json;
use glam::Vec3;
use microfacet_sampler::{Masking, MicrofacetDistribution, Tables};
use microfacet_tables::axis::LogRoughness;

/// The numbers of each array in a header, by name.
fn arrays(header: &str) -> BTreeMap<String, Vec<f32>> {
    let definitions = header.split("STUDENT_T_DATA float ").skip(1);
    let array = |text: &str| {
        let (name, rest) = text.split_once('[').unwrap();
        let (count, rest) = rest.split_once("] = {").unwrap();
        let items = rest.split_once('}').unwrap().0.split(',').map(str::trim);
        let numbers: Vec<f32> = items
            .filter(|item| !item.is_empty())
            .map(|item| item.strip_suffix('f').unwrap().parse().unwrap())
            .collect();
        assert_eq!(count, numbers.len().to_string(), "{name}");
        (name.to_owned(), numbers)
    };
    definitions.map(array).collect()
}

#[test]
fn a_shape_is_a_small_header_beside_the_functions() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    let gammas = ["3,1.65", "inf", "1.501", "2", "3.0", "1e300"].map(|gamma| ["--gamma", gamma]);
    ok(at, &[&["export", "c", "--out", "out"], gammas.as_flattened()].concat());
    let out = at.join("out");
    let shapes =
        ["1e300", "1p501", "1p65", "2", "3", "inf"].map(|g| format!("student_t_gamma_{g}.h"));
    let [functions, materials] =
        [&["student_t.h", "student_t.hpp", "student_t_closed.h"][..], &["student_t_materials.h"]]
            .map(|names| names.iter().map(|&name| name.to_owned()).collect::<Vec<_>>());
    assert_eq!(names(&out), [&functions[..], &shapes, &materials].concat());
    for name in names(&out) {
        let text = fs::read_to_string(out.join(&name)).unwrap();
        assert!(text.is_ascii() && text.ends_with("#endif\n"), "{name}");
        assert!(text.contains("SPDX-License-Identifier: CC0-1.0 OR MIT"), "{name}");
        let widest = text.lines().max_by_key(|line| line.len()).unwrap();
        assert!(widest.len() <= 100, "{name}: {widest}");
        assert!(text.len() < 300_000, "{name}: {}", text.len());
    }
    // Closed forms leave only albedos.
    let ggx = arrays(&fs::read_to_string(out.join("student_t_gamma_2.h")).unwrap());
    assert!(ggx.keys().all(|name| name.contains("albedo") || name.contains("averages")), "{ggx:?}");
    assert_eq!(ggx.len(), 4);
}

#[test]
fn an_index_without_tables_is_refused_with_what_adds_them() {
    let folder = tempfile::tempdir().unwrap();
    let why = refused(folder.path(), &["export", "c", "--eta", "2.4", "--out", "out"]);
    assert!(why.contains("fresnel = { dielectric = 2.4 }"), "{why}");
    assert!(!folder.path().join("out").exists());
    refused(folder.path(), &["export", "c", "--out", "out"]);
}

#[test]
fn the_numbers_are_those_of_the_crate() {
    let folder = tempfile::tempdir().unwrap();
    ok(folder.path(), &["export", "c", "--gamma", "3", "--out", "."]);
    let text = fs::read_to_string(folder.path().join("student_t_gamma_3.h")).unwrap();
    let arrays = arrays(&text);
    let array = |part: &str| &arrays[&format!("student_t_gamma_3_{part}")];
    let member = |name: &str| {
        let line = text.lines().find(|line| line.ends_with(&format!("/* {name} */"))).unwrap();
        line.trim().split_once("f,").unwrap().0.parse::<f32>().unwrap()
    };

    // G1 from the cubics.
    let tables = Tables::embedded();
    let lobe = tables.student_t(0.4, 3.0).unwrap();
    let (cubics, kappa) = (array("masking"), member("kappa"));
    let cells = cubics.len() / 4 - 1;
    assert_eq!(member("masking_cells"), cells as f32);
    for i in 1..=100 {
        let z = i as f32 / 100.0;
        let v = Vec3::new((1.0 - z * z).sqrt(), 0.0, z);
        let x = z / (z + kappa * 0.4 * v.x) * cells as f32;
        let cell = (x as usize).min(cells);
        let [a, b, c, d] = cubics[4 * cell..4 * cell + 4] else { unreachable!() };
        let w = x - cell as f32;
        let g1 = x * (a + w * (b + w * (c + w * d)));
        assert!((g1 - lobe.g1(v)).abs() < 2e-6, "{z}: {g1} for {}", lobe.g1(v));
    }

    // Averages at inner nodes.
    let averages = array("averages_height_correlated");
    let cells = averages.len() / 3 - 1;
    let ends = [1e-8, 3.0].map(|sigma| LogRoughness::BAKED.coordinate(sigma));
    for node in [cells / 3, cells / 2, cells - 1] {
        let t = ends[0] + (ends[1] - ends[0]) * node as f64 / cells as f64;
        let sigma = LogRoughness::BAKED.quantity(t);
        let albedo = tables.albedo(sigma, 3.0, Masking::HeightCorrelated).unwrap();
        let stored = averages[3 * node].exp();
        let lost = albedo.lost_average();
        assert!((stored / lost - 1.0).abs() < 1e-4, "{sigma}: {stored} for {lost}");
    }

    // Albedos at the largest roughness and normal incidence, and their averages.
    for masking in Masking::ALL {
        let name = masking.name().replace('-', "_");
        let albedo = tables.albedo(3.0, 3.0, masking).unwrap();
        let [e, bias, _] = *array(&format!("albedo_{name}")).last_chunk::<3>().unwrap();
        assert!((1.0 + e - albedo.albedo(Vec3::Z)).abs() < 1e-6, "{masking}");
        assert!((bias - albedo.moments(Vec3::Z).bias).abs() < 1e-6, "{masking}");
        let [lost, bias, f82] = *array(&format!("averages_{name}")).last_chunk::<3>().unwrap();
        let average = albedo.average_moments();
        assert!((1.0 - lost.exp() - average.total()).abs() < 1e-6, "{masking}");
        assert!((bias - average.bias).abs() < 1e-6 && (f82 - average.f82).abs() < 1e-6);
    }
}

/// One-sided functions need a rule for directions of the other side, in every language.
#[test]
fn texts_say_that_directions_of_the_other_side_are_negated() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    for (target, file) in [("c", "student_t.h"), ("wgsl", "student_t.wgsl")] {
        ok(at, &["export", target, "--gamma", "2", "--out", target]);
        let text = fs::read_to_string(at.join(target).join(file)).unwrap();
        let text = text.replace("\n// ", " ").replace("\n * ", " ");
        let rest = text.split_once("All is one-sided").expect(file).1;
        assert!(rest.starts_with(": negate a direction on the other side"), "{file}");
        assert!(text.contains("the alpha of GGX and Beckmann; shape gamma"), "{file}");
    }
}

#[test]
fn other_sets_are_exported_with_what_they_lack() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    fs::write(at.join("a.toml"), "[[material]]\nname = \"a\"\nsigma = 0.3\ngamma = 4.0\n").unwrap();
    ok(at, &["bake", "a.toml", "--out", "set", "--quality", "draft"]);
    let output = run(at, &["export", "c", "--gamma", "4", "--tables", "set", "--out", "out"]);
    let notes = String::from_utf8(output.stderr).unwrap();
    assert!(output.status.success() && notes.contains("default set"), "{notes}");
    let text = fs::read_to_string(at.join("out/student_t_gamma_4.h")).unwrap();
    assert!(text.contains("masking are those of the default set"), "{text}");
    ok(at, &["export", "wgsl", "--gamma", "4", "--tables", "set", "--out", "shader"]);
    let forms = &json(&at.join("shader/student_t.json"))["shapes"]["4"]["albedos_of_default_set"];
    assert_eq!(forms, &serde_json::json!(["uncorrelated", "height-correlated"]));
    // Draft tables are smaller.
    ok(at, &["export", "c", "--gamma", "4", "--out", "default"]);
    let default = fs::read_to_string(at.join("default/student_t_gamma_4.h")).unwrap();
    let count = |text: &str| arrays(text)["student_t_gamma_4_slopes"].len();
    assert!(2 * count(&text) < count(&default), "{} {}", count(&text), count(&default));

    let message =
        refused(at, &["export", "c", "--gamma", "5", "--tables", "set", "--out", "other"]);
    let words = ["the nearest that this set serves is 4;", "bake"];
    assert!(words.iter().all(|word| message.contains(word)), "{message}");
    assert!(!at.join("other").exists());
}

#[test]
fn bad_requests_are_refused_with_a_remedy_and_write_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    let cases: [(&[&str], &[&str]); 19] = [
        (&["wgsl", "--gamma", "3", "--tables", "nowhere"], &["nowhere", "no such file", "bake"]),
        (&["cobol", "--gamma", "3"], &["cobol", "they are c, wgsl, glsl, glsl-es, hlsl"]),
        (&["c", "--gamma", "3", "--textures"], &["--textures"]),
        (&["glsl", "--gamma", "3", "--group", "#{GROUP}"], &["#{GROUP} must be a number here"]),
        (&["wgsl", "--gamma", "3", "--group", "two"], &["'two'", "must be", "#{MATERIAL_BIND"]),
        (&["glsl-es", "--gamma", "3", "--binding", "2"], &["uniform student_t_tables"]),
        (&["msl", "--gamma", "3", "--group", "2"], &["argument of its functions"]),
        (&["hlsl", "--gamma", "3", "--argument"], &["leave out --argument"]),
        (&["hlsl", "--gamma", "3", "--import-path", "a"], &["leave out --import-path"]),
        (&["wgsl", "--gamma", "3", "--import-path", "a b"], &["'a b'", "must be names"]),
        (&["spirv", "--realtime"], &["SPIR-V has no functions", "export wgsl"]),
        (&["wgsl", "--realtime", "--gamma", "3"], &["--realtime", "--gamma"]),
        (&["wgsl", "--realtime", "--binding", "1"], &["--realtime", "--binding"]),
        (&["wgsl", "--gamma", "1.5001"], &["1.5001", "below 1.501", "raise"]),
        (&["c", "--gamma", "1.5"], &["(1.5, inf]"]),
        (&["c", "--gamma", "1.5001"], &["1.5001", "below 1.501", "raise"]),
        (&["c", "--gamma", "three"], &["three", "number"]),
        (&["c", "--gamma", "3", "--sigma", "0.3"], &["every roughness"]),
        (&["c"], &["--gamma"]),
    ];
    for (arguments, parts) in cases {
        let message = refused(at, &[&["export"], arguments, &["--out", "out"]].concat());
        for part in parts {
            assert!(message.contains(part), "{arguments:?}: {message}");
        }
        assert!(!at.join("out").exists(), "{arguments:?}");
    }
    // If one file cannot be written, the others stay as they were.
    fs::create_dir_all(at.join("out/student_t_gamma_3.h")).unwrap();
    fs::write(at.join("out/student_t.h"), "old").unwrap();
    let message = refused(at, &["export", "c", "--gamma", "3", "--out", "out"]);
    assert!(message.contains("student_t_gamma_3.h") && message.contains("folder"), "{message}");
    assert_eq!(fs::read_to_string(at.join("out/student_t.h")).unwrap(), "old");
    assert_eq!(names(&at.join("out")), ["student_t.h", "student_t_gamma_3.h"]);
    // Existing files are replaced.
    fs::remove_dir(at.join("out/student_t_gamma_3.h")).unwrap();
    ok(at, &["export", "c", "--gamma", "3", "--out", "out"]);
    assert!(fs::read_to_string(at.join("out/student_t.h")).unwrap().contains("STUDENT_T_H"));
}

#[test]
fn every_shape_is_one_header_or_one_file() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    let family = ["export", "c", "--family", "--out"];
    ok(at, &[&family[..], &["text"]].concat());
    ok(at, &[&family[..], &["bare", "--no-albedo"]].concat());
    ok(at, &[&family[..], &["bytes", "--binary"]].concat());
    let sizes =
        ["text/student_t_family.h", "bare/student_t_family.h", "bytes/student_t_family.bin"]
            .map(|name| fs::read(at.join(name)).unwrap().len());
    assert!(sizes[0] < 2_500_000 && sizes[1] < sizes[0] * 6 / 10, "{sizes:?}");
    // The file says its size.
    let bytes = fs::read(at.join("bytes/student_t_family.bin")).unwrap();
    let word = |i: usize| u32::from_le_bytes(bytes[4 * i..][..4].try_into().unwrap());
    assert_eq!(word(0).to_le_bytes(), *b"StuT");
    assert_eq!(word(2) as usize, bytes.len());
    for arguments in [["--family", "--gamma", "3"], ["--gamma", "3", "--binary"]] {
        refused(at, &[&["export", "c", "--out", "out"][..], &arguments].concat());
    }
    // Shaders read the same file, filled up to whole rows.
    ok(at, &["export", "wgsl", "--family", "--out", "shader"]);
    let filled = fs::read(at.join("shader/student_t_family.bin")).unwrap();
    assert!(filled.starts_with(&bytes) && filled[bytes.len()..].iter().all(|byte| *byte == 0));
    let description = json(&at.join("shader/student_t_family.json"));
    let number = |name: &str| description[name].as_u64().unwrap() as usize;
    assert_eq!(filled.len(), 4 * number("width") * number("height"));
    assert_eq!(number("layout"), word(1) as usize);
    // One shape without its albedos.
    ok(at, &["export", "c", "--gamma", "3", "--no-albedo", "--out", "one"]);
    let one = fs::read_to_string(at.join("one/student_t_gamma_3.h")).unwrap();
    assert!(arrays(&one).keys().all(|name| !name.contains("albedo")));
}
