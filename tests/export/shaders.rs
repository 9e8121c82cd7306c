//! Modules of shaders, the kit for real time, and the data that they read.

use std::collections::BTreeMap;
use std::fs;

use crate::common::{names, ok, refused};
use crate::{colours, image, json};
use glam::Vec3;
use microfacet_export::{Host, Language, realtime_text};
use microfacet_sampler::{Masking, Tables};

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
