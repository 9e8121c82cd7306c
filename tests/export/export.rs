//! Exports of shapes. `clients/c/run` and `clients/gpu/run` compile them and compare their
//! functions with the crate's; the tests here need no compiler.

use std::collections::BTreeMap;
use std::fs;

use crate::common::{names, ok, refused, run};
use crate::{colours, image, json};
use glam::Vec3;
use microfacet_export::{Host, Language, realtime_text};
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

/// Functions of lobes, in all shader modules.
const SHADER_FUNCTIONS: [&str; 17] = [
    "student_t_lobe_d(",
    "student_t_lobe_masking(",
    "student_t_lobe_lambda(",
    "student_t_lobe_masking_shadowing(",
    "student_t_lobe_eval_pdf(",
    "student_t_lobe_sample_visible_normal(",
    "student_t_lobe_visible_normal_pdf(",
    "student_t_reflect(",
    "student_t_lobe_reflection_weight(",
    "student_t_lobe_reflection_pdf(",
    "student_t_effectively_smooth(",
    "student_t_lobe_albedo(",
    "student_t_lobe_albedo_parts(",
    "student_t_lobe_albedo_average(",
    "student_t_lobe_albedo_average_parts(",
    "student_t_lobe_compensation(",
    "student_t_compensation_from(",
];

#[test]
fn every_language_has_all_functions_a_sample_and_data() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    let cases = [
        ("wgsl", "student_t.wgsl", "student_t_sample.wgsl", true),
        ("glsl", "student_t.glsl", "student_t_sample.comp", true),
        ("glsl-es", "student_t.glsl", "student_t_sample.frag", false),
        ("hlsl", "student_t.hlsl", "student_t_sample.hlsl", true),
        ("msl", "student_t.metal", "student_t_sample.metal", true),
        ("slang", "student_t.slang", "student_t_sample.slang", true),
    ];
    for (language, module, sample, has_buffers) in cases {
        let mut data: Vec<Vec<u8>> = Vec::new();
        let kinds =
            [("student_t", ["--gamma", "3,1.65"].as_slice()), ("student_t_family", &["--family"])];
        for ((name, what), textures) in
            kinds.into_iter().flat_map(|kind| [(kind, false), (kind, true)])
        {
            let out = format!("{name}-{language}-{textures}");
            let mut export = [&["export", language, "--out", &out], what].concat();
            export.extend(textures.then_some("--textures"));
            ok(at, &export);
            let [module, sample] = [module, sample].map(|file| file.replace("student_t", name));
            let ends = ["bin", "exr", "json"].map(|end| format!("{name}.{end}"));
            let mut files = [&[module.clone(), sample.clone()], &ends[..]].concat();
            files.retain(|file| file != "student_t_family.exr");
            files.extend((language == "wgsl").then(|| "student_t_closed.wgsl".into()));
            files.sort();
            assert_eq!(names(&at.join(&out)), files);
            let text = |name: &str| fs::read_to_string(at.join(&out).join(name)).unwrap();
            let (module, sample) = (text(&module), text(&sample));
            assert!(module.is_ascii() && sample.is_ascii(), "{out}");
            assert!(module.starts_with("// SPDX-License-Identifier: CC0-1.0"), "{out}");
            let [other, maker] = match name {
                "student_t" => ["student_t_lobe_at(", "student_t_lobe_of("],
                _ => ["student_t_lobe_of(", "student_t_lobe_at("],
            };
            for function in SHADER_FUNCTIONS.iter().chain([&maker]) {
                // Once in the list at the top, and once defined.
                assert!(module.matches(function).count() >= 2, "{out}: {function}");
            }
            assert!(!module.contains(other) && sample.contains(maker), "{out}");
            // The calls by shape that came first.
            for function in SHADER_FUNCTIONS.iter().filter(|name| name.contains("_lobe_")) {
                let by_shape = format!(" {}", function.replace("_lobe", ""));
                let is_there = name == "student_t" && !function.contains("eval_pdf");
                assert_eq!(module.contains(&by_shape), is_there, "{out}: {by_shape}");
            }
            // The code has no names of the translator and no entry point.
            let code: String = module.lines().filter(|line| !line.starts_with("//")).collect();
            for foreign in ["naga", "fake", "impl_entry", "_group_", "main(", "#version", "sizes"] {
                assert!(!code.contains(foreign), "{out}: {foreign}");
            }
            assert!(sample.lines().count() <= 55, "{out}");
            let words = ["texture", "Texture2D", "sampler2D"];
            let uses_texture = words.iter().any(|word| code.contains(word));
            assert_eq!(uses_texture, textures || !has_buffers, "{out}");
            data.push(fs::read(at.join(&out).join(format!("{name}.bin"))).unwrap());
        }
        // Buffers and textures have the same bytes.
        assert!(data[0] == data[1] && data[2] == data[3], "{language}");
    }

    ok(at, &["export", "spirv", "--gamma", "3", "--out", "spirv"]);
    let data = ["student_t.bin", "student_t.exr", "student_t.json"];
    let files = [&data[..], &["student_t.spv", "student_t_sample.wgsl"]].concat();
    assert_eq!(names(&at.join("spirv")), files);
    let words = fs::read(at.join("spirv/student_t.spv")).unwrap();
    assert_eq!(words[..4], 0x0723_0203_u32.to_le_bytes());
    let entry = b"reflect_views";
    assert!(words.windows(entry.len()).any(|window| window == entry));
}

/// Functions of the kit for real time.
const REALTIME_FUNCTIONS: [&str; 14] = [
    "student_t_surface(",
    "student_t_surface_d(",
    "student_t_surface_masking_at(",
    "student_t_surface_albedo_at(",
    "student_t_surface_area(",
    "student_t_surface_eval(",
    "student_t_surface_pdf(",
    "student_t_schlick(",
    "student_t_f82_tint(",
    "student_t_schlick_average(",
    "student_t_f82_tint_average(",
    "student_t_schlick_albedo(",
    "student_t_f82_tint_albedo(",
    "student_t_further_bounces(",
];

#[test]
fn the_kit_for_real_time_has_functions_and_textures() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    ok(at, &["export", "wgsl", "--realtime", "--import-path", "kit", "--out", "out"]);
    let out = at.join("out");
    let ends = ["_albedo.ktx2", "_masking.ktx2", "_sample.wgsl", ".json", ".wgsl"];
    let mut files = ends.map(|end| format!("student_t_realtime{end}"));
    files.sort();
    assert_eq!(names(&out), files);
    let module = fs::read_to_string(out.join("student_t_realtime.wgsl")).unwrap();
    assert!(module.starts_with("#define_import_path kit\n"));

    // The texels are where the description says, and begin and end as they must.
    let told = json(&out.join("student_t_realtime.json"));
    let texels = |name: &str| {
        let one = &told["textures"][name];
        let number = |key: &str| one[key].as_u64().unwrap() as usize;
        let bytes = fs::read(out.join(one["file"].as_str().unwrap())).unwrap();
        let of_level = ktx2::Reader::new(&bytes[..]).unwrap().levels().next().unwrap().data.len();
        let texels = bytes[number("offset")..][..number("bytes")].to_vec();
        assert_eq!(texels.len(), of_level);
        assert_eq!(bytes.len(), number("offset") + of_level);
        let halves = texels.chunks_exact(2).map(|two| half::f16::from_le_bytes([two[0], two[1]]));
        let size: Vec<u64> =
            one["size"].as_array().unwrap().iter().map(|n| n.as_u64().unwrap()).collect();
        (size, halves.map(f32::from).collect::<Vec<f32>>())
    };
    let (size, masking) = texels("masking");
    assert_eq!((&size[..], masking.len()), (&[64, 32][..], 64 * 32));
    // At the normal Λ = 0, for every gamma.
    assert!(masking.chunks(64).all(|row| row[63] == 0.25));
    let (size, albedo) = texels("albedo");
    assert_eq!((&size[..], albedo.len()), (&[48, 32, 32][..], 4 * 48 * 32 * 32));
    // Of the roughest Beckmann, from the normal, as the crate has it; and of a mirror nothing.
    let exact = Tables::embedded().family_albedo(Masking::HeightCorrelated).unwrap();
    let at = exact.at(1.0, f32::INFINITY);
    let texel = &albedo[4 * (48 * 31 + 47)..][..4];
    assert!((texel[0].powi(2) - at.lost(Vec3::Z)).abs() < 1e-3, "{texel:?}");
    assert!((texel[3].powi(2) - at.lost_average()).abs() < 1e-3, "{texel:?}");
    assert!(albedo[4 * 47..][..4].iter().all(|x| x.abs() < 1e-3));

    // The other languages have the same functions, and programs.
    for language in [
        Language::Wgsl,
        Language::Glsl,
        Language::GlslEs,
        Language::Hlsl,
        Language::Msl,
        Language::Slang,
    ] {
        let mut files = realtime_text(language, &Host::default()).into_iter();
        let [module, sample] =
            [0; 2].map(|_| String::from_utf8(files.next().unwrap().contents).unwrap());
        for function in REALTIME_FUNCTIONS {
            assert!(module.matches(function).count() >= 2, "{language:?}: {function}");
        }
        let code: String = module.lines().filter(|line| !line.starts_with("//")).collect();
        for foreign in ["naga", "impl_entry", "_group_", "main(", "#version", "sampler"] {
            assert!(!code.contains(foreign), "{language:?}: {foreign}");
        }
        assert!(module.is_ascii() && sample.is_ascii() && sample.lines().count() <= 60);
        assert!(sample.contains("student_t_further_bounces("), "{language:?}");
    }
}

#[test]
fn the_kit_needs_a_set_that_covers_it() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    let recipe = "[[material]]\nname = \"a\"\nsigma = { min = 0.01, max = 0.5 }\n\
                  gamma = { min = 1.8, max = 4.0 }\nfresnel = \"mirror\"\n\
                  masking = \"height-correlated\"\n";
    fs::write(at.join("a.toml"), recipe).unwrap();
    ok(at, &["bake", "a.toml", "--out", "set", "--quality", "draft"]);
    let message = refused(at, &["export", "glsl", "--realtime", "--tables", "set", "--out", "out"]);
    for part in ["gamma = 1.6", "sigma [0.01, 0.5]", "gamma [1.8, 4]", "bake"] {
        assert!(message.contains(part), "{part}: {message}");
    }
    assert!(!at.join("out").exists());
}

#[test]
fn shaders_have_tables_where_the_host_says() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    let group = "#{MATERIAL_BIND_GROUP}";
    let bevy = ["--group", group, "--binding", "110", "--import-path", "student_t"];
    let export = |language: &str, out: &str, options: &[&str]| {
        let words = ["export", language, "--gamma", "2", "--out", out, "--no-albedo"];
        ok(at, &[&words, options].concat());
    };
    let text = |name: &str| fs::read_to_string(at.join(name)).unwrap();
    export("wgsl", "bevy", &bevy);
    let module = text("bevy/student_t.wgsl");
    assert!(module.starts_with("#define_import_path student_t\n// SPDX"), "{module}");
    let line = |binding: u32, rest: &str| {
        format!("@group(#{{MATERIAL_BIND_GROUP}}) @binding({binding}) var<{rest}")
    };
    let tables = line(110, "storage, read> student_t_tables:");
    assert!(module.contains(&tables) && !module.contains("@group(0)"), "{module}");
    let sample = text("bevy/student_t_sample.wgsl");
    for line in [line(111, "storage, read> queries"), line(112, "storage, read_write> answers")] {
        assert!(sample.contains(&line), "{sample}");
    }

    let place = ["--group", "1", "--binding", "1"];
    export("glsl", "glsl", &place);
    export("hlsl", "hlsl", &place);
    let cases = [
        ("glsl/student_t.glsl", &["STUDENT_T_BINDING layout(std430, set = 1, binding = 1)\n"][..]),
        (
            "glsl/student_t_sample.comp",
            &[
                "layout(std430, set = 1, binding = 2) readonly buffer",
                "layout(std430, set = 1, binding = 3) writeonly buffer",
            ],
        ),
        ("hlsl/student_t.hlsl", &["#define STUDENT_T_REGISTER t1, space1\n"]),
        ("hlsl/student_t_sample.hlsl", &["register(t2, space1)", "register(u3, space1)"]),
    ];
    for (name, parts) in cases {
        let text = text(name);
        assert!(parts.iter().all(|part| text.contains(part)), "{name}: {text}");
    }
    // OpenGL has no sets.
    export("glsl", "opengl", &["--binding", "3", "--textures"]);
    assert!(text("opengl/student_t.glsl").contains("STUDENT_T_BINDING layout(binding = 3)\n"));
    // As an argument the texture is the program's.
    for (language, files, tables) in [
        ("wgsl", ["student_t.wgsl", "student_t_sample.wgsl"], ": texture_2d<f32>"),
        ("glsl", ["student_t.glsl", "student_t_sample.comp"], "sampler2D "),
        ("glsl-es", ["student_t.glsl", "student_t_sample.frag"], "highp sampler2D "),
    ] {
        let out = format!("{language}-argument");
        export(language, &out, &["--argument"]);
        let [module, sample] = files.map(|name| text(&format!("{out}/{name}")));
        let parameter = match language {
            "wgsl" => format!(", student_t_tables{tables})"),
            _ => format!(", {tables}student_t_tables)"),
        };
        let maker = module
            .lines()
            .find(|line| line.contains("student_t_lobe_of(") && !line.starts_with("//"));
        assert!(maker.unwrap().contains(&parameter), "{module}");
        assert!(!module.contains("@group") && !module.contains("\nuniform"), "{module}");
        assert!(sample.contains("sigma, student_t_tables);"), "{sample}");
    }
    // The host's own precision is left as it is.
    export("glsl-es", "es", &[]);
    assert!(!text("es/student_t.glsl").lines().any(|line| line.starts_with("precision")));
}

#[test]
fn shapes_for_shaders_may_lack_albedos() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    ok(at, &["export", "wgsl", "--gamma", "3", "--out", "all"]);
    ok(at, &["export", "wgsl", "--gamma", "3", "--no-albedo", "--out", "bare"]);
    let size = |folder: &str| fs::metadata(at.join(folder).join("student_t.bin")).unwrap().len();
    assert!(size("bare") * 2 < size("all"), "{} of {}", size("bare"), size("all"));
    let tables = &json(&at.join("bare/student_t.json"))["shapes"]["3"]["tables"];
    assert!(tables.get("masking").is_some() && tables.get("albedo_uncorrelated").is_none());
}

#[test]
fn the_data_of_shaders_is_where_its_description_says() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    ok(at, &["export", "wgsl", "--gamma", "3,inf,2,1.65", "--out", "."]);
    let bytes = fs::read(at.join("student_t.bin")).unwrap();
    let numbers: Vec<f32> =
        bytes.chunks(4).map(|bytes| f32::from_le_bytes(bytes.try_into().unwrap())).collect();
    let description = json(&at.join("student_t.json"));
    let count = |value: &serde_json::Value| value.as_u64().unwrap() as usize;
    let (width, height) = (count(&description["width"]), count(&description["height"]));
    assert_eq!(numbers.len(), 2 * width * height);

    // The description lists checksums of the other files.
    let of = |name: &str| {
        let mut crc = flate2::Crc::new();
        crc.update(&fs::read(at.join(name)).unwrap());
        format!("{:08x}", crc.sum())
    };
    let others = [
        "student_t.bin",
        "student_t.exr",
        "student_t.wgsl",
        "student_t_closed.wgsl",
        "student_t_sample.wgsl",
    ];
    let listed: BTreeMap<&str, String> = others.map(|name| (name, of(name))).into();
    assert_eq!(description["crc32"], serde_json::to_value(listed).unwrap());

    // The image has the same numbers.
    assert!(image(&at.join("student_t.exr")) == ([width, height], colours(&numbers)));

    let shapes = description["shapes"].as_object().unwrap();
    assert_eq!(shapes.keys().collect::<Vec<_>>(), ["1.65", "2", "3", "inf"]);
    for (gamma, shape) in shapes {
        let start = 2 * count(&shape["offset"]);
        let member = |member: &serde_json::Value| {
            (member["name"].as_str().unwrap().to_owned(), member["value"].as_f64().unwrap() as f32)
        };
        let members: Vec<(String, f32)> =
            shape["members"].as_array().unwrap().iter().map(member).collect();
        for (i, (name, value)) in members.iter().enumerate() {
            assert_eq!(numbers[start + i], *value, "{gamma}: {name}");
        }
        let member = |name: &str| members.iter().find(|member| member.0 == name).unwrap().1;
        assert_eq!(member("is_ggx"), f32::from(u8::from(gamma == "2")));
        for (name, table) in shape["tables"].as_object().unwrap() {
            let pairs = count(&table["rows"]) * count(&table["columns"]).div_ceil(2);
            assert!(count(&table["offset"]) + pairs <= count(&shape["length"]), "{gamma}: {name}");
        }
        // The last albedo of a table is that of the largest roughness at normal incidence.
        let table = &shape["tables"]["albedo_height_correlated"];
        let last = 2 * (count(&table["offset"]) + 2 * (count(&table["rows"]) - 1));
        let sigma = f64::from(member("height_correlated.sigma_max"));
        let albedo = Tables::embedded()
            .albedo(sigma, gamma.parse().unwrap(), Masking::HeightCorrelated)
            .unwrap();
        let stored = 1.0 + numbers[start + last];
        assert!((stored - albedo.albedo(Vec3::Z)).abs() < 1e-6, "{gamma}: {stored}");
    }
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
