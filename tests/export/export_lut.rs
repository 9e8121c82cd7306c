//! Albedos as textures. `clients/lut/run` opens them with other programs, and `clients/gpu/run`
//! reads them by a filter of hardware; the tests here need neither.

use std::fs;
use std::path::Path;

use crate::common::{names, ok, refused};
use crate::{colours, image, json};
use microfacet_baker::progress::Stage;
use microfacet_export::texture::{
    Channels, Checks, Deviation, Format, Made, Place, Shapes, Texture, TextureSpec, check, files,
    known,
};
use microfacet_sampler::Masking;
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
        (&["--layout", "unreal"], "cycles, cycles-glass, openpbr, openpbr-dielectric, mdl, eevee"),
        (&["--layout", "cycles", "--format", "npy"], "cannot be used with"),
        (&["--layout", "cycles", "--size", "8x8x8"], "has 2 sizes"),
        (&["--layout", "mdl", "--size", "8x8"], "has 3 sizes: indices first, as 16x32x32"),
        (&["--layout", "cycles-glass", "--size", "3x8x8"], "a size of 3 must lie in [4, 4096]"),
        (&["--layout", "unity"], "cycles, cycles-glass, openpbr"),
        (&["--gamma", "2", "--format", "npy", "--fit"], "--layout"),
    ] {
        let message = refused(at, &[&lut[..], more].concat());
        assert!(message.contains(says), "{more:?}: {message}");
    }
    assert!(!at.join("out").exists());
    assert_eq!(check(Shapes::One(2.0), 1.0, &[4, 4096]), Ok(()));
}
