//! Albedos as textures. `clients/lut/run` opens them with other programs, and `clients/gpu/run`
//! reads them by a filter of hardware; the tests here need neither.

use std::fs;
use std::path::Path;

use crate::common::{names, ok, refused, run};
use crate::{colours, image, json};
use microfacet_baker::bake::albedo::weights;
use microfacet_baker::progress::Stage;
use microfacet_export::texture::engine::{LAYOUTS, Layout};
use microfacet_export::texture::{
    Channels, Checks, Deviation, Format, Made, Place, Shapes, Texture, TextureSpec, check, files,
    known,
};
use microfacet_model::{AlbedoIntegrator, Shape};
use microfacet_sampler::Masking;
use microfacet_study::engines::shipped;
use microfacet_tables::axis::LogShape;

const CORRELATED: Masking = Masking::HeightCorrelated;

/// A texture of height-correlated masking, and that of its averages.
fn specs(shapes: Shapes, sigma_max: f64, size: &[usize], channels: Channels) -> [TextureSpec; 2] {
    TextureSpec::of_shapes("lut", shapes, sigma_max, size, CORRELATED, channels)
}

fn made(spec: &TextureSpec) -> Texture {
    spec.make(&Stage::unwatched()).unwrap()
}

fn checked(spec: &TextureSpec) -> (Texture, Checks) {
    spec.make_checked([&Stage::unwatched(); 2]).unwrap()
}

fn errors(spec: &TextureSpec) -> Vec<Deviation> {
    let (texture, checks) = checked(spec);
    checks.of(&texture, |_| true)
}

#[test]
fn errors_are_as_promised() {
    let of = |shapes, sigma_max, size: [usize; 2], channels| {
        specs(shapes, sigma_max, &size, channels).map(|spec| move || errors(&spec))
    };
    let [small, average] = of(Shapes::One(2.0), 1.0, [32, 32], Channels::E).map(|of| of());
    assert!(small[0].largest < 6.1e-4 && average[0].largest < 1.6e-4, "{small:?}, {average:?}");
    // Steps of 1/256 are too fine to matter here.
    assert!(small[0].coarse < 1.1 * small[0].largest, "{small:?}");
    let large = of(Shapes::One(2.0), 1.0, [64, 64], Channels::E)[0]();
    assert!(large[0].largest < 1.5e-4, "{large:?}");
    let heavy = of(Shapes::One(1.6), 3.0, [64, 64], Channels::E)[0]();
    assert!(heavy[0].largest < 6.9e-4, "{heavy:?}");
    let split = of(Shapes::One(f64::INFINITY), 3.0, [16, 16], Channels::ScaleBias)[0]();
    let quantities: Vec<&str> = split.iter().map(|found| found.quantity).collect();
    assert_eq!(quantities, ["e", "bias", "scale"]);
    let [e, bias, scale] = [0, 1, 2].map(|i| split[i].largest);
    assert!(e < 1.1e-2 && bias < 1.4e-2 && scale < e + bias, "{split:?}");
}

/// The stated errors of a volume hold at other points than those of the certificate.
#[test]
fn a_volume_errs_by_what_it_states() {
    let [spec, average] = specs(Shapes::DownTo(1.6), 3.0, &[4, 12, 12], Channels::E);
    let made = [(spec, 3000), (average, 100)].map(|(spec, count)| {
        let (texture, checks) = checked(&spec);
        let stated = checks.of(&texture, |_| true)[0].largest;
        (spec, texture, stated, count)
    });
    // At and near the middles of cells.
    let last = LogShape::BAKED.coordinate(1.6);
    for (i, cell) in [0.5, 1.45, 2.5, 2.6].into_iter().enumerate() {
        let gamma = LogShape::BAKED.quantity(last * cell / 3.0);
        let place = |j: i32, view: bool| {
            let [a, b] = [0.618_034, 0.414_214].map(|step| (f64::from(j) * step).fract());
            let cos = view.then_some(1e-4_f64.powf(a));
            Place { gamma, sigma: (3.0 * b * b).max(1e-8), eta: None, cos }
        };
        for (spec, texture, stated, count) in &made {
            let view = spec.is_directional();
            let places: Vec<Place> = (0..*count).map(|j| place(i as i32 + j, view)).collect();
            let known = known(&places, CORRELATED, &Stage::unwatched()).unwrap();
            let found = Checks::at(spec, &known).of(texture, |_| true)[0].largest;
            assert!(found < 1.05 * stated, "{gamma}: {found} of {stated}");
        }
    }
}

/// So do those of a texture of one shape, at five points in each cell along each axis, and of the
/// smallest cosine.
#[test]
fn a_texture_errs_by_what_it_states() {
    for (gamma, sigma_max) in [(1.55, 3.0), (2.0, 1.0), (f64::INFINITY, 3.0)] {
        let shape = Shapes::One(gamma);
        for spec in specs(shape, sigma_max, &[16, 16], Channels::ScaleBias) {
            let (texture, checks) = checked(&spec);
            let stated = checks.of(&texture, |_| true);
            let steps = if spec.is_directional() { 75 } else { 600 };
            let along = |i: usize| i as f64 / steps as f64;
            let mut places = Vec::new();
            for rough in (0..=steps).map(along) {
                if !spec.is_directional() {
                    places.push(spec.place(&[rough]));
                    continue;
                }
                for view in (0..=steps).map(along) {
                    let place = spec.place(&[rough, view]);
                    let cos = place.cos.map(|cos| cos.max(1e-4));
                    // The smallest cosine runs through all coordinates of the view below 1e-2.
                    let horizon = Place { sigma: 1e-6_f64.powf(rough) * 1e-2, cos, ..place };
                    places.push(Place { cos, ..place });
                    places.extend((view == 0.0).then_some(horizon));
                }
            }
            let known = known(&places, CORRELATED, &Stage::unwatched()).unwrap();
            let found = Checks::at(&spec, &known).of(&texture, |_| true);
            for (found, stated) in found.iter().zip(&stated) {
                let (most, of) = (1.03 * stated.largest, stated.quantity);
                assert!(found.largest < most, "{gamma}, {of}: {found:?} of {stated:?}");
            }
        }
    }
}

#[test]
fn a_wrong_texel_is_seen() {
    let [spec, _] = specs(Shapes::One(3.0), 1.0, &[16, 16], Channels::OneMinusE);
    let (good, checks) = checked(&spec);
    let largest = |texture: &Texture| checks.of(texture, |_| true)[0].largest;
    let before = largest(&good);
    for texel in [0, 15, 7 * 16 + 9, 255] {
        let mut bad = good.clone();
        bad.values[texel] += 0.02;
        let found = largest(&bad);
        // The texel of the smallest σ at the horizon is below the smallest cosine that counts.
        assert_eq!(found > 0.01 + before / 2.0, texel != 0, "{texel}: {found}");
    }
}

/// Values at the texels, where a texture is too large to fit.
#[test]
fn exact_texels_are_those_of_the_model() {
    let [spec, _] = specs(Shapes::One(2.0), 1.0, &[8, 16], Channels::E);
    let spec = TextureSpec { fitted: false, ..spec };
    let texture = made(&spec);
    assert_eq!(texture.values.len(), 128);
    // The last row is σ = 1, and its last texel E at the normal.
    assert!((texture.values[127] - 0.306_853).abs() < 1e-6, "{}", texture.values[127]);
    let fitted = TextureSpec { fitted: true, ..spec.clone() };
    let [exact, fitted] = [&spec, &fitted].map(|spec| errors(spec)[0].largest);
    assert!(fitted < 0.7 * exact, "{fitted} of {exact}");
}

/// The shape and the bytes of an array of NumPy, by its specification (NEP 1): a magic number, the
/// version 1.0, and a dictionary of Python that ends with a line, at a multiple of 64.
fn array(path: &Path, kind: &str) -> (Vec<usize>, Vec<u8>) {
    let file = fs::read(path).unwrap();
    let rest = file.strip_prefix(b"\x93NUMPY\x01\x00").unwrap();
    let length = usize::from(u16::from_le_bytes([rest[0], rest[1]]));
    assert!((10 + length).is_multiple_of(64));
    let (text, values) = rest[2..].split_at(length);
    let start = format!("{{'descr': '{kind}', 'fortran_order': False, 'shape': (");
    let text = str::from_utf8(text).unwrap().strip_prefix(&start).unwrap();
    let (shape, padding) = text.split_once("), }").unwrap();
    assert!(!shape.ends_with(' '), "{shape}");
    assert_eq!(padding.trim_start_matches(' '), "\n");
    let edges = shape.trim_end_matches(',').split(", ").map(|edge| edge.parse().unwrap());
    (edges.collect(), values.to_vec())
}

#[test]
fn files_hold_the_same_values() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    let export = ["export", "lut", "--format", "npy,dds,ktx2,exr,json,c,npy", "--out", "out"];
    ok(at, &[&export[..], &["--gamma-min", "1.8", "--size", "4x5x6", "--half"]].concat());
    let out = at.join("out");
    let forms = ["dds", "exr", "h", "json", "ktx2", "npy"];
    let expected = ["lut", "lut_average"].map(|name| forms.map(|form| format!("{name}.{form}")));
    assert_eq!(names(&out), expected.concat());
    let json = json(&out.join("lut.json"));
    let values: Vec<f32> = serde_json::from_value(json["data"].clone()).unwrap();
    assert_eq!(values.len(), 4 * 5 * 6);
    assert!(json["largest_rounding_to_f16"].as_f64().unwrap() <= 2.5e-4);

    let bytes = fs::read(out.join("lut.dds")).unwrap();
    let dds = ddsfile::Dds::read(&bytes[..]).unwrap();
    assert_eq!((dds.get_width(), dds.get_height(), dds.get_depth()), (6, 5, 4));
    assert!(dds.header.caps2.contains(ddsfile::Caps2::VOLUME));
    assert_eq!(dds.get_dxgi_format(), Some(ddsfile::DxgiFormat::R16_Float));
    let halves = dds.get_data(0).unwrap().as_chunks().0.iter();
    let read: Vec<f32> = halves.map(|&x| half::f16::from_le_bytes(x).to_f32()).collect();
    assert_eq!(read, values);

    let (shape, halves) = array(&out.join("lut.npy"), "<f2");
    assert_eq!(shape, [4, 5, 6]);
    let halves = halves.as_chunks().0.iter().map(|&x| half::f16::from_le_bytes(x).to_f32());
    assert!(halves.eq(values.iter().copied()));

    let ktx = fs::read(out.join("lut.ktx2")).unwrap();
    let ktx = ktx2::Reader::new(&ktx[..]).unwrap();
    let header = ktx.header();
    assert_eq!((header.pixel_width, header.pixel_height, header.pixel_depth), (6, 5, 4));
    assert_eq!(header.format, Some(ktx2::Format::R16_SFLOAT));
    let halves: Vec<u8> =
        values.iter().flat_map(|&x| half::f16::from_f32(x).to_le_bytes()).collect();
    assert_eq!(ktx.levels().next().unwrap().data, halves);
}

/// Each side of an interface and its averages, in two channels.
#[test]
fn interfaces_are_written_from_both_sides() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    let export = ["export", "lut", "--gamma", "2", "--eta", "1.3..1.6", "--sigma-max", "1"];
    ok(at, &[&export[..], &["--size", "4x4x5", "--format", "npy", "--out", "out"]].concat());
    let out = at.join("out");
    for side in ["outside", "inside"] {
        let [views, averages] = ["", "_average"].map(|of| out.join(format!("lut_{side}{of}.npy")));
        assert_eq!(array(&views, "<f4").0, [4, 4, 5, 2]);
        assert_eq!(array(&averages, "<f4").0, [4, 4, 2]);
        let told = json(&out.join(format!("lut_{side}.json")));
        assert_eq!(told["side"], side);
        assert_eq!(told["axes_slowest_first"][0]["eta_max"], 1.6);
    }
}

/// All names in a header have a suffix, so that a texture may be named by a keyword of C.
#[test]
fn headers_are_named_by_any_word() {
    for (name, channels) in [("int", Channels::E), ("sigma", Channels::ScaleBias)] {
        let specs =
            TextureSpec::of_shapes(name, Shapes::One(2.0), 1.0, &[4, 4], CORRELATED, channels);
        for spec in specs.map(|spec| TextureSpec { fitted: false, ..spec }) {
            let one = Made {
                texture: made(&spec),
                errors: Vec::new(),
                edges: Vec::new(),
                before_rounding: None,
            };
            let header = files(&[Format::C], &[one]).unwrap().remove(0).contents;
            let header = String::from_utf8(header).unwrap();
            let name = &spec.name;
            let qualified = format!("{}_", name.to_uppercase());
            let declared = header.lines().filter_map(|line| line.strip_prefix(&qualified));
            let declared: Vec<&str> =
                declared.map(|line| line.split(['[', '(']).next().unwrap()).collect();
            let kind = if channels == Channels::E { "float" } else { "void" };
            let [texels, read] =
                [format!("DATA float {name}_texels"), format!("FUNCTION {kind} {name}_read")];
            assert_eq!(declared, [texels, read]);
            // Nothing reads the array by another name.
            assert_eq!(header.matches(&format!("{name}[")).count(), 0, "{header}");
        }
    }
}

#[test]
fn files_do_not_depend_on_threads() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    let export = ["export", "lut", "--gamma", "3", "--size", "12x9", "--format", "json,exr,ktx2"];
    ok(at, &[&export[..], &["--out", "a", "--threads", "1"]].concat());
    ok(at, &[&export[..], &["--out", "b", "--threads", "7"]].concat());
    for name in names(&at.join("a")) {
        let [a, b] = ["a", "b"].map(|out| fs::read(at.join(out).join(&name)).unwrap());
        assert!(a == b, "{name}");
    }
}

/// Numbers from the tables that engines ship, where these are right, by row and column:
/// Cycles 97dbe6f (Apache-2.0), openpbr-bsdf a29da96 (Apache-2.0), three.js 0.187.0 (MIT).
#[test]
fn layouts_are_those_of_engines() {
    let written = |name: &str| {
        let layout = Layout::find(name).unwrap();
        let specs = layout.specs(2.0, layout.size, false);
        let textures: Vec<Texture> = specs.iter().map(made).collect();
        (layout, textures.clone(), layout.files(&textures).unwrap())
    };
    let (layout, textures, files) = written("cycles");
    let cycles = shipped::decode(layout, &files[0].contents);
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

    let (layout, _, files) = written("openpbr");
    assert_eq!(files[1].name, "openpbr_ideal_metal_avg_energy_complement_data.h");
    let openpbr = shipped::decode(layout, &files[0].contents);
    for (row, column, value) in
        [(16, 16, 10152.0), (20, 5, 14115.0), (31, 31, 45425.0), (24, 10, 22312.0)]
    {
        let found = 65535.0 * openpbr.values[32 * row + column];
        // Shipped values are within 4e-5 of exact ones here.
        assert!((found - value).abs() < 3.0, "{row}, {column}: {found}");
    }

    let (layout, _, files) = written("three");
    let three = shipped::decode(layout, &files[0].contents);
    for (row, column, scale, bias) in [(15, 15, 0.3452, 7.051e-5), (12, 4, 0.9893, 0.001015)] {
        let found = &three.values[2 * (16 * row + column)..][..2];
        // From 4,096 samples.
        let near = (found[0] - scale).abs() < 3e-4 && (found[1] - bias).abs() < 3e-5;
        assert!(near, "{row}, {column}: {found:?}");
    }
}

/// Texels are where engines read them, by formulas that are written independently here.
#[test]
fn texels_of_layouts_are_where_engines_read_them() {
    let middle = |i: usize, n: usize| (i as f64 + 0.5) / n as f64;
    let end = |i: usize, n: usize| i as f64 / (n - 1) as f64;
    // √α and μ of a row and a column, and which channels are E, scale and bias.
    type At = fn(&dyn Fn(usize, usize) -> f64, [usize; 2], [usize; 2]) -> [f64; 2];
    let rough_first: At = |c, [i, j], [rows, columns]| [c(i, rows), c(j, columns)];
    let view_first: At = |c, [i, j], [rows, columns]| [c(j, columns), c(i, rows)];
    let size = [9, 14];
    let integrator = AlbedoIntegrator::new(Shape::new(2.0).unwrap(), 1e-8);
    for layout in &LAYOUTS {
        let (at, channels): (At, &[&str]) = match layout.name {
            "cycles" => (view_first, &["e"]),
            "openpbr" | "osl" => (rough_first, &["lost"]),
            "filament" | "unity" | "babylon" => (rough_first, &["bias", "e", ""]),
            "three" => (view_first, &["scale", "bias"]),
            "bevy" => (rough_first, &["scale", "bias"]),
            "materialx" | "gltf" => (rough_first, &["scale", "bias", ""]),
            other => panic!("{other} has no formula here"),
        };
        let ends = ["cycles", "openpbr", "osl", "unity"].contains(&layout.name);
        let texture = made(&layout.specs(2.0, size, false)[0]);
        for texel in [[2, 11], [7, 3]] {
            let coordinate: &dyn Fn(usize, usize) -> f64 = if ends { &end } else { &middle };
            let [root, cos] = at(coordinate, texel, size);
            let sigma = if layout.name == "materialx" { root } else { root * root };
            let cos = if ["osl", "unity"].contains(&layout.name) { cos * cos } else { cos };
            let albedo = integrator.reflection(sigma, cos, weights).unwrap();
            let uncorrelated = layout.name == "openpbr";
            let of = if uncorrelated { albedo.uncorrelated } else { albedo.height_correlated };
            for (k, channel) in channels.iter().enumerate() {
                let want = match *channel {
                    "e" => of[0] + of[1],
                    "lost" => 1.0 - of[0] - of[1],
                    "scale" => of[0],
                    "bias" => of[1],
                    _ => 0.0,
                };
                let index = (texel[0] * size[1] + texel[1]) * channels.len() + k;
                let found = f64::from(texture.values[index]);
                assert!((found - want).abs() < 1e-6, "{}: {found} for {want}", layout.name);
            }
        }
    }
}

/// Every layout is read back as it was made, except for the rounding of its format.
#[test]
fn layouts_are_read_back() {
    for layout in &LAYOUTS {
        let size = if ["cycles", "openpbr", "osl"].contains(&layout.name) {
            layout.size
        } else {
            [12, 12]
        };
        let textures: Vec<Texture> = layout.specs(2.0, size, false).iter().map(made).collect();
        let files = layout.files(&textures).unwrap();
        let back = shipped::decode(layout, &files[0].contents);
        // Six decimals, sixteen bits, eight bits, and eight bits of a power.
        let allowed = match layout.name {
            "cycles" => 6e-7,
            "openpbr" => 8e-6,
            "filament" | "three" | "bevy" => 2.5e-4,
            "gltf" => 2e-3,
            "babylon" => 4.4e-3,
            _ => 0.0,
        };
        for (got, want) in back.values.iter().zip(&textures[0].values) {
            assert!((got - want).abs() <= allowed, "{}: {got} for {want}", layout.name);
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

/// Images of two channels are refused by readers that want colours, such as three.js's.
#[test]
fn two_channels_are_written_as_three_colours() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    let export = ["export", "lut", "--gamma", "2", "--size", "4x5", "--format", "exr,npy"];
    ok(at, &[&export[..], &["--channels", "scale-bias", "--out", "out"]].concat());
    let (shape, floats) = array(&at.join("out/lut.npy"), "<f4");
    assert_eq!(shape, [4, 5, 2]);
    let values: Vec<f32> = floats.as_chunks().0.iter().map(|&x| f32::from_le_bytes(x)).collect();
    assert_eq!(image(&at.join("out/lut.exr")), ([5, 4], colours(&values)));
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
    // The engine's own lobe and filter are another's.
    assert!(three.contains("GGX as its lobe") && three.contains("gamma = 3"), "{three}");
    assert!(!babylon.contains("GGX as its lobe"), "{babylon}");
}

#[test]
fn what_cannot_be_made_is_refused_with_a_remedy() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    let lut = ["export", "lut", "--out", "out"];
    let npy = ["--format", "npy"];
    for (more, says) in [
        (&["--gamma", "2", "--size", "3x32"][..], "a size of 3 must lie in [4, 4096]"),
        (&["--gamma", "2", "--size", "32x5000"], "a size of 5000 must lie in [4, 4096]"),
        (&["--gamma", "2", "--size", "32"], "as 32x32 or 32x64x64"),
        (&["--gamma", "2", "--size", "32xx32"], "as 32x32 or 32x64x64"),
        (&["--gamma", "2", "--size", "8x8x8"], "has 2 sizes"),
        (&["--gamma-min", "2", "--size", "8x8"], "has 3 sizes"),
        (&["--gamma-min", "1.6", "--size", "512x4096x4096"], "more than 16777216"),
        (&["--gamma", "2", "--sigma-max", "0"], "(0, 3]"),
        (&["--gamma", "2", "--sigma-max", "-1"], "(0, 3]"),
        (&["--gamma", "2", "--sigma-max", "3.1"], "(0, 3]"),
        (&["--gamma", "2", "--sigma-max", "1e-12"], "below 0.0001"),
        (&["--gamma-min", "1e17"], "the one shape gamma = inf"),
        (&["--gamma", "2", "--sigma-max", "nan"], "finite"),
        (&["--gamma", "1.4"], "1.5"),
        (&["--gamma", "1.5005"], "1.501"),
        (&["--gamma-min", "inf"], "the one shape gamma = inf"),
        (&["--gamma-min", "3", "--gamma-max", "2"], "'2' for '--gamma-max <G>': a range of shapes"),
        (&["--gamma-min", "3", "--gamma-max", "4"], "--gamma-min to infinity: leave out"),
        (&["--gamma", "2", "--gamma-max", "3"], "leave out --gamma-max"),
        (&["--gamma", "2", "--gamma-min", "2"], "cannot be used with"),
        (&["--gamma", "2", "--name", "GGX"], "a-z, 0-9 and _"),
        (&["--gamma", "2", "--name", "../x"], "a-z, 0-9 and _"),
        (&["--gamma", "2", "--name", "_x"], "begins with a letter"),
        (&["--gamma", "2", "--name", "2x"], "begins with a letter"),
        (&["--gamma", "2", "--name", "a__b"], "C++ and GLSL reserve"),
        (&["--gamma", "2", "--name", "x_"], "C++ and GLSL reserve"),
        (&["--gamma", "2", "--name", "gl_x"], "C++ and GLSL reserve"),
        (&["--gamma", "2", "--name", "math", "--format", "c"], "as math_albedo"),
        (&[], "name a shape with --gamma"),
        (&["--eta", "1.5"], "name a shape with --gamma"),
        (&["--gamma", "2", "--eta", "0.66"], "eta = 0.66 must lie in [1.05, 3]"),
        (&["--gamma", "2", "--eta", "2..1.5"], "from a smaller to a larger index"),
        (&["--gamma", "2", "--eta", "1.5-2"], "as 1.5, or two with .. between them"),
        (&["--gamma", "2", "--eta", "1.5..2", "--size", "8x8"], "has 3 sizes: HxSxT"),
        (&["--gamma-min", "2", "--eta", "1.5"], "cannot be used with"),
        (&["--gamma", "2", "--eta", "1.5", "--channels", "e"], "cannot be used with"),
    ] {
        let message = refused(at, &[&lut[..], &npy, more].concat());
        assert!(message.contains(says), "{more:?}: {message}");
    }
    for (more, says) in [
        (&["--gamma", "2", "--format", "png"][..], "exr, dds, ktx2, npy, c, json"),
        (&["--gamma", "2"], "or an engine with --layout"),
        (&["--layout", "unreal"], "cycles, openpbr, osl, filament, three, bevy"),
        (&["--layout", "cycles", "--format", "npy"], "cannot be used with"),
        (&["--layout", "cycles", "--size", "8x8x8"], "has 2 sizes"),
        (&["--gamma", "2", "--format", "npy", "--fit"], "--layout"),
    ] {
        let message = refused(at, &[&lut[..], more].concat());
        assert!(message.contains(says), "{more:?}: {message}");
    }
    assert!(!at.join("out").exists());
    assert_eq!(check(Shapes::One(2.0), 1.0, &[4, 4096]), Ok(()));
}
