//! Tables in the layouts of engines, exact at their texels.

use std::fs;

use crate::common::run;
use microfacet_baker::bake::albedo::weights;
use microfacet_baker::progress::Stage;
use microfacet_export::texture::engine::{LAYOUTS, Layout};
use microfacet_export::texture::{Checks, Place, Texture, TextureSpec, known};
use microfacet_model::fresnel::Dielectric;
use microfacet_model::{AlbedoIntegrator, Shape};
use microfacet_study::engines::shipped;

fn made(spec: &TextureSpec) -> Texture {
    spec.make(&Stage::unwatched()).unwrap()
}

/// Numbers from the tables that engines ship, where these are right, by row and column:
/// Cycles 97dbe6f (Apache-2.0), openpbr-bsdf a29da96 (Apache-2.0), three.js 0.187.0 (MIT).
#[test]
fn layouts_are_those_of_engines() {
    let written = |name: &str| {
        let layout = Layout::find(name).unwrap();
        let specs = layout.specs(2.0, layout.size, false);
        let textures: Vec<Texture> = specs.iter().map(made).collect();
        let files = layout.files(&textures).unwrap();
        (textures, shipped::written(layout, layout.size, &files).remove(0), files)
    };
    let (textures, cycles, files) = written("cycles");
    let text = String::from_utf8(files[0].contents.clone()).unwrap();
    assert!(text.starts_with("/* Albedo of gamma 2, height-correlated masking, 32x32, exact"));
    assert!(text.contains("static const float table_ggx_E[1024] = {\n  1.000000f, 0.98"), "{text}");
    assert!(text.contains("static const float table_ggx_Eavg[32] = {\n  1.000000f, "));
    for (row, column, value) in [
        (1, 5, 0.891678),
        (5, 10, 0.889039),
        (16, 16, 0.847421),
        (31, 31, 0.306853),
        (8, 24, 0.727744),
        (31, 5, 0.999296),
    ] {
        let found = cycles.values[32 * row + column];
        assert!((found - value).abs() < 2.1e-6, "{row}, {column}: {found}");
    }
    for (i, value) in [(5, 0.997199), (16, 0.870874), (31, 0.409137)] {
        assert!((textures[1].values[i] - value).abs() < 4e-6, "{i}: {}", textures[1].values[i]);
    }

    let (_, openpbr, files) = written("openpbr");
    assert_eq!(files[1].name, "openpbr_ideal_metal_avg_energy_complement_data.h");
    for (row, column, value) in
        [(16, 16, 10152.0), (20, 5, 14115.0), (31, 31, 45425.0), (24, 10, 22312.0)]
    {
        let found = 65535.0 * openpbr.values[32 * row + column];
        // Shipped values are within 4e-5 of exact ones here.
        assert!((found - value).abs() < 3.0, "{row}, {column}: {found}");
    }

    let (_, three, _) = written("three");
    for (row, column, scale, bias) in [(15, 15, 0.3452, 7.051e-5), (12, 4, 0.9893, 0.001015)] {
        let found = &three.values[2 * (16 * row + column)..][..2];
        // From 4,096 samples.
        let near = (found[0] - scale).abs() < 3e-4 && (found[1] - bias).abs() < 3e-5;
        assert!(near, "{row}, {column}: {found:?}");
    }
}

/// σ, cos θ and the index of a texel of a table, as its engine reads it, by formulas that are
/// written independently here.
fn read_at(layout: &str, table: usize, texel: &[usize], size: &[usize]) -> (f64, f64, Option<f64>) {
    let end = |axis: usize| texel[axis] as f64 / (size[axis] - 1) as f64;
    let middle = |axis: usize| (texel[axis] as f64 + 0.5) / size[axis] as f64;
    let square = |x: f64| x * x;
    let angle = |axis: usize| (end(axis) * std::f64::consts::FRAC_PI_2).cos();
    match layout {
        "cycles" => (square(end(1)), end(0), None),
        "openpbr" => (square(end(0)), end(1), None),
        "osl" => (square(end(0)), square(end(1)), None),
        "filament" | "babylon" | "bevy" | "gltf" => (square(middle(0)), middle(1), None),
        "three" => (square(middle(1)), middle(0), None),
        "eevee" => (square(end(1)), 1.0 - square(end(0)), None),
        "mdl" if table == 0 => (end(0), angle(1), None),
        "mdl" => {
            let n = 1.125 + 1.875 * end(0);
            (end(1), angle(2), Some(if table == 1 { n } else { 1.0 / n }))
        }
        "cycles-glass" => {
            let f0 = end(0).min(0.99).powi(4);
            let n = (1.0 + f0.sqrt()) / (1.0 - f0.sqrt());
            (square(end(2)), end(1), Some(if table == 0 { n } else { 1.0 / n }))
        }
        "openpbr-dielectric" if table == 0 => {
            (square(end(1)), end(2), Some(1.0 / (1.0 + 1.5 * (1.0 - end(0)))))
        }
        "openpbr-dielectric" => (square(end(1)), end(2), Some(1.0 + 1.5 * end(0))),
        other => panic!("{other} has no formula here"),
    }
}

/// Tables hold the model's values where engines read their texels, and so do their averages.
#[test]
fn texels_of_layouts_are_where_engines_read_them() {
    let integrator = AlbedoIntegrator::new(Shape::new(2.0).unwrap(), 1e-7);
    for layout in &LAYOUTS {
        let size: &[usize] = if layout.size.len() == 3 { &[4, 5, 6] } else { &[9, 14] };
        let metal: &[&str] = match layout.name {
            "filament" | "babylon" => &["bias", "e", ""],
            "three" | "bevy" => &["scale", "bias"],
            "gltf" => &["scale", "bias", ""],
            "eevee" => &["scale", "bias", "tint"],
            "openpbr" | "osl" => &["lost"],
            "openpbr-dielectric" => &["lost", "not reflected"],
            _ => &["e"],
        };
        let (tables, averages): (Vec<_>, Vec<_>) =
            layout.specs(2.0, size, false).into_iter().partition(TextureSpec::is_directional);
        let wanted = |place: (f64, Option<f64>, Option<f64>), channel: &str| {
            let (sigma, cos, eta) = place;
            let uncorrelated =
                ["openpbr", "openpbr-dielectric", "mdl", "eevee"].contains(&layout.name);
            let [e, reflected, scale, bias, tint] = if let Some(eta) = eta {
                let interface = Dielectric::new(eta).unwrap();
                let of = match cos {
                    Some(cos) => integrator.interface(sigma, cos, interface),
                    None => integrator.interface_average(sigma, interface),
                };
                let of = of.unwrap();
                let [r, t] = if uncorrelated { of.uncorrelated } else { of.height_correlated };
                [r + t, r, f64::NAN, f64::NAN, f64::NAN]
            } else {
                let of = match cos {
                    Some(cos) => integrator.reflection(sigma, cos, weights),
                    None => integrator.average(sigma, weights),
                };
                let of = of.unwrap();
                let [scale, bias, tint] =
                    if uncorrelated { of.uncorrelated } else { of.height_correlated };
                [scale + bias, scale + bias, scale, bias, tint]
            };
            match channel {
                "e" => e,
                "lost" => 1.0 - e,
                "not reflected" => 1.0 - reflected,
                "scale" => scale,
                "bias" => bias,
                // Without the factor 7^7/6^6 of F82.
                "tint" => tint / (7_f64.powi(7) / 6_f64.powi(6)),
                _ => 0.0,
            }
        };
        for (table, spec) in tables.iter().enumerate() {
            let [texture, average] = [Some(spec), averages.get(table)].map(|spec| spec.map(made));
            let texture = texture.unwrap();
            let own = texture.size();
            let texels: [&[usize]; 2] =
                if own.len() == 3 { [&[2, 4, 3], &[1, 2, 5]] } else { [&[2, 4], &[7, 3]] };
            for texel in texels {
                let texel: Vec<usize> = texel.iter().zip(&own).map(|(i, n)| i % n).collect();
                let (sigma, cos, eta) = read_at(layout.name, table, &texel, &own);
                let index = texel.iter().zip(&own).fold(0, |sum, (i, n)| sum * n + i);
                let check = |texture: &Texture, index: usize, cos: Option<f64>, allowed: f64| {
                    let channels = texture.spec.channels.len();
                    for (k, channel) in metal.iter().take(channels).enumerate() {
                        let channel =
                            if layout.name == "mdl" && cos.is_none() { "lost" } else { channel };
                        let want = wanted((sigma, cos, eta), channel);
                        let found = f64::from(texture.values[index * channels + k]);
                        let near = (found - want).abs() < allowed;
                        assert!(near, "{} {table} {channel}: {found} for {want}", layout.name);
                    }
                };
                check(&texture, index, Some(cos), 2e-6);
                if let Some(average) = &average {
                    let at = spec.axes.iter().zip(texel.iter().zip(&own));
                    let index = at
                        .filter(|(axis, _)| !axis.along.is_view())
                        .fold(0, |sum, (_, (i, n))| sum * n + i);
                    check(average, index, None, 1e-5);
                }
            }
        }
    }
}

/// Every layout is read back as it was made, except for the rounding of its format.
#[test]
fn layouts_are_read_back() {
    for layout in &LAYOUTS {
        let size: &[usize] = if layout.size.len() == 3 { &[4, 5, 6] } else { &[12, 12] };
        let textures: Vec<Texture> = layout.specs(2.0, size, false).iter().map(made).collect();
        let files = layout.files(&textures).unwrap();
        let back = shipped::written(layout, size, &files);
        // Six decimals, sixteen bits, eight bits, and eight bits of a power.
        let allowed = match layout.name {
            "cycles" | "cycles-glass" | "eevee" => 6e-7,
            "openpbr" | "openpbr-dielectric" => 8e-6,
            "filament" | "three" | "bevy" => 2.5e-4,
            "gltf" => 2e-3,
            "babylon" => 4.4e-3,
            _ => 0.0,
        };
        let tables = textures.iter().filter(|texture| texture.spec.is_directional());
        assert_eq!(back.len(), tables.clone().count(), "{}", layout.name);
        for (back, table) in back.iter().zip(tables) {
            assert_eq!((back.size(), back.values.len()), (table.size(), table.values.len()));
            // Light passes straight through where indices are equal.
            let straight = if layout.name == "cycles-glass" { 5 * 6 } else { 0 };
            assert!(back.values[..straight].iter().all(|&x| x == 1.0));
            for (got, want) in back.values.iter().zip(&table.values).skip(straight) {
                assert!((got - want).abs() <= allowed, "{}: {got} for {want}", layout.name);
            }
        }
    }
}

/// Texels at the middles are clamped beyond the last, at α = 1: this, not the cosine, darkens rough
/// metal in three.js, whose shader divides by E.
#[test]
fn a_clamp_at_the_last_middle_shows_at_full_roughness() {
    let worst = |name: &str, root: f64| {
        let layout = Layout::find(name).unwrap();
        let spec = &layout.specs(2.0, layout.size, false)[0];
        let cos = |i: i32| Some(0.05 + 0.95 * f64::from(i) / 99.0);
        let at = |i| Place { gamma: 2.0, sigma: root * root, eta: None, cos: cos(i) };
        let places: Vec<Place> = (0..100).map(at).collect();
        let known = known(&places, spec.masking, &Stage::unwatched()).unwrap();
        let found = Checks::at(spec, &known).of(&made(spec), |_| true);
        found.iter().find(|found| found.quantity == "e").unwrap().relative
    };
    let [largest, rms] = worst("three", 1.0);
    let [percent, mean] = [largest, rms].map(|share| 100.0 * share);
    println!("three.js, alpha 1: E too large by {percent:.1} %, root mean square {mean:.1} %");
    assert!((0.12..0.13).contains(&largest) && (0.06..0.07).contains(&rms), "{largest} {rms}");
    for (name, root) in [("three", 31.0 / 32.0), ("cycles", 1.0)] {
        let [largest, _] = worst(name, root);
        println!("{name}, sqrt(alpha) {root}: {:.1} %", 100.0 * largest);
        assert!(largest < 0.02, "{name}: {largest}");
    }
}

#[test]
fn layouts_are_written() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    let notes = |more: &[&str]| {
        let output = run(at, &[&["export", "lut", "--out", "out", "--layout"], more].concat());
        assert!(output.status.success());
        String::from_utf8(output.stderr).unwrap()
    };
    let osl = notes(&["osl", "--fit"]);
    assert!(osl.contains("put the file in place of SPI/microfacet_tools_luts.h"), "{osl}");
    let text = fs::read_to_string(at.join("out/microfacet_tools_luts.h")).unwrap();
    assert!(text.contains("BSDL_INLINE_METHOD MiniMicrofacetGGX::Energy& "), "{text}");
    assert_eq!(text.matches("f,").count(), 256);
    let babylon = notes(&["babylon", "--size", "8x8"]);
    for needed in ["isRGBD = true", "noMipmap", "invertY", "CLAMP_ADDRESSMODE"] {
        assert!(babylon.contains(needed), "{babylon}");
    }
    let three = notes(&["three", "--size", "8x8", "--gamma", "3"]);
    assert!(three.contains("has 16x16 texels: change its constants"), "{three}");
    let glass = notes(&["cycles-glass", "--size", "4x5x6"]);
    assert!(glass.contains("put the four arrays") && glass.contains("has 16x16x16 texels"));
    let text = fs::read_to_string(at.join("out/shader_glass.tables")).unwrap();
    for (name, numbers) in [("E", 120), ("Eavg", 24), ("inv_E", 120), ("inv_Eavg", 24)] {
        let mark = format!("static const float table_ggx_glass_{name}[{numbers}] = {{\n");
        let body = text.split(&mark).nth(1).unwrap().split("};").next().unwrap();
        assert_eq!(body.matches("f,").count(), numbers, "{body}");
        // Blank lines between slices.
        assert_eq!(body.matches("\n\n").count(), if numbers == 120 { 3 } else { 0 }, "{body}");
    }
    notes(&["openpbr-dielectric", "--size", "4x5x6"]);
    for (name, numbers) in [
        ("ideal_dielectric_energy_complement", 240),
        ("opaque_dielectric_energy_complement", 240),
        ("ideal_dielectric_avg_energy_complement", 40),
        ("opaque_dielectric_avg_energy_complement", 40),
    ] {
        let text = fs::read_to_string(at.join(format!("out/openpbr_{name}_data.h"))).unwrap();
        let body = text.split("// clang-format off\n").nth(1).unwrap();
        let body = body.strip_suffix("\n// clang-format on\n").unwrap();
        let integers: Vec<u16> = body.split(", ").map(|x| x.parse().unwrap()).collect();
        assert_eq!(integers.len(), numbers, "{name}");
    }
    for (gamma, lobe) in [("2", "ggx"), ("inf", "beckmann")] {
        let mdl = notes(&["mdl", "--size", "4x5x6", "--gamma", gamma]);
        assert!(mdl.contains("multiscatter_tables") && !mdl.contains("as its lobe"), "{mdl}");
        let bytes = fs::read(at.join(format!("out/{lobe}_smith.bin"))).unwrap();
        assert_eq!(bytes.len(), 12 + 4 * (1 + 2 * 4) * 5 * (6 + 1));
        assert_eq!(bytes[..12], [5, 0, 0, 0, 6, 0, 0, 0, 4, 0, 0, 0]);
        // The engine divides by the number at the end of a row, of which a mirror's would be 0.
        let numbers: Vec<f32> =
            bytes[12..].as_chunks().0.iter().map(|&x| f32::from_le_bytes(x)).collect();
        assert!(numbers.iter().all(|&x| x > 0.0) && numbers[6] < 1e-4, "{}", numbers[6]);
        // π (1 − E_avg) at α = 1, uncorrelated.
        let rough = numbers[4 * 7 + 6];
        let [least, most] = if lobe == "ggx" { [1.95, 1.97] } else { [0.0, 1.9] };
        assert!((least..most).contains(&rough), "{rough}");
    }
    notes(&["eevee", "--size", "4x5"]);
    let text = fs::read_to_string(at.join("out/eevee_lut.cc")).unwrap();
    assert!(text.contains("const float brdf_ggx[4][5][3] = {\n    {{"), "{text}");
    assert_eq!((text.matches("f}").count(), text.matches("f,").count()), (20, 40));
    // The engine's own lobe and filter are another's.
    assert!(three.contains("GGX as its lobe") && three.contains("gamma = 3"), "{three}");
    assert!(!babylon.contains("GGX as its lobe"), "{babylon}");
}
