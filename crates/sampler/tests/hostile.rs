//! Hostile bytes and arguments: damaged, truncated and inconsistent table files; directions and
//! numbers out of their domain.

use glam::Vec3;

use microfacet_core::shape::gamma_of_s;
use microfacet_sampler::lobe::{Batch, Reflecting};
use microfacet_sampler::{Ggx, Lobe, Masking, MaterialError, MicrofacetDistribution, Skew, Tables};
use microfacet_tables::axis::{HalfTangent, Rational};
use microfacet_tables::{
    Axis, Certificate, Errors, Interpolation, Interval, Kind, LoadError, LobeSpec, Mapping,
    MaterialEntry, OLDEST_VERSION, Precision, Provenance, Quantity, Reflectance, Roughness, Side,
    Subject, Table, VERSION, encode, seal,
};

fn axis(name: &str, mapping: Mapping, interpolation: Interpolation, nodes: &[f64]) -> Axis {
    Axis::new(name, mapping, interpolation, nodes.to_vec())
}

fn table(kind: Kind, precision: Precision, mut axes: Vec<Axis>, values: &[f32]) -> Table {
    axes.insert(0, axis("gamma", Mapping::InverseShape, Interpolation::Nodes, &[1.0]));
    let certificate = Certificate {
        errors: [(Quantity::G1, Errors { largest: 0.5, ..Errors::default() })].into(),
        ..Certificate::default()
    };
    Table::new(kind.name(), kind, Subject::shapes([1.0, 1.0]), axes, values.to_vec())
        .with_certificate(certificate)
        .rounded(precision)
}

/// The smallest set that serves GGX, with each way of storing values.
fn small_tables() -> Vec<Table> {
    let view = Mapping::Rational(Rational::BAKED);
    vec![
        table(
            Kind::Shadowing,
            Precision::F32,
            vec![axis("view", view, Interpolation::Hermite, &[0.0, 0.5, 1.0])],
            &[0.9, 0.05, 0.95, 0.05, 1.0, 0.05],
        ),
        table(
            Kind::VisibleSlope,
            Precision::U16,
            vec![
                axis(
                    "view",
                    Mapping::HalfTangent(HalfTangent::default()),
                    Interpolation::Linear,
                    &[0.0, 1.0],
                ),
                axis("u1", Mapping::MirroredRoot, Interpolation::Hermite, &[0.0, 1.0]),
            ],
            &[1.0, 0.2, 1.4, 0.2, 0.0, 0.2, 0.6, 0.2, 0.0, 0.5, 1.0, 0.5, 0.0, 0.5, 1.0, 0.5],
        ),
        table(
            Kind::VisibleSlopeConditional,
            Precision::F16,
            vec![axis("u2", Mapping::OddRoot, Interpolation::Hermite, &[0.0, 0.5, 1.0])],
            &[0.0, 0.25, 0.5, 0.25, 1.0, 0.25],
        ),
    ]
}

/// A material of each form, with numbers that tell the fields apart.
fn materials() -> Vec<MaterialEntry> {
    let material = |name: &str, theta, sigma: [[f64; 2]; 2], s: [f64; 2], fresnel| {
        let [x, y] = sigma.map(Interval::from);
        let gamma = Interval::from(s).map_falling(gamma_of_s);
        let lobe = LobeSpec { theta, ..LobeSpec::family(Roughness::anisotropic(x, y), gamma) };
        MaterialEntry {
            name: name.into(),
            lobe,
            haze: None,
            retroreflection: MaterialEntry::SPECULAR,
            masking: None,
            fresnel: Some(fresnel),
        }
    };
    let [tilted, metal] = [[[0.25; 2], [0.375; 2]], [[0.0, 0.5], [0.125, 0.625]]];
    let theta = Some([0.1, -0.2, 0.5]);
    let conductor = Reflectance::Conductor { eta: [0.2, 0.9, 1.1], k: [3.9, 2.4, 2.2] };
    let range = Reflectance::Dielectric([1.25, 2.5].into());
    vec![
        material("tilted", theta, tilted, [0.8; 2], Reflectance::Schlick([0.04; 3])),
        material("metal", None, metal, [0.0, 1.6], conductor),
        material("pane", None, [[0.5; 2]; 2], [1.0; 2], Reflectance::dielectric(1.75)),
        material("panes", None, [[0.5; 2]; 2], [1.0; 2], range),
    ]
}

fn small_file() -> Vec<u8> {
    let materials = materials();
    let provenance = Provenance { generator: "test".into(), materials, ..Provenance::default() };
    encode(&provenance, &small_tables()).unwrap()
}

#[test]
fn every_truncation_is_refused() {
    let file = small_file();
    assert!(Tables::from_bytes(&file).unwrap().student_t(0.3, 2.0).is_ok());
    for length in 0..file.len() {
        let read = Tables::from_bytes(&file[..length]);
        assert!(matches!(read, Err(LoadError::Invalid(_))), "{length} bytes");
    }
    let longer = [&file[..], &[0]].concat();
    assert!(Tables::from_bytes(&longer).is_err());
}

#[test]
fn every_flipped_bit_is_refused() {
    let mut file = small_file();
    for bit in 0..8 * file.len() {
        file[bit / 8] ^= 1 << (bit % 8);
        assert!(Tables::from_bytes(&file).is_err(), "bit {bit} of {}", 8 * file.len());
        file[bit / 8] ^= 1 << (bit % 8);
    }
    assert!(Tables::from_bytes(&file).is_ok());
}

/// The file with every `from` in its header replaced, and a checksum that fits again.
fn forge(from: &str, to: &str) -> Vec<u8> {
    let file = small_file();
    let length = u64::from_le_bytes(file[..8].try_into().unwrap()) as usize;
    let header = String::from_utf8(file[8..8 + length].to_vec()).unwrap();
    assert!(header.contains(from), "no {from} in {header}");
    let mut header = header.replace(from, to);
    while !header.len().is_multiple_of(8) {
        header.push(' ');
    }
    let mut forged = (header.len() as u64).to_le_bytes().to_vec();
    forged.extend(header.as_bytes());
    forged.extend(&file[8 + length..]);
    seal(&mut forged);
    forged
}

/// A lie is two lines of a text: what stands in the header, and what is put in its place. The words
/// that refuse the file stand below; `SNAPSHOTS=overwrite cargo test` writes them anew.
#[cfg(not(target_family = "wasm"))]
#[test]
fn lying_headers_and_descriptions_are_refused_by_name() {
    use snapbox::{Assert, Data};

    let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/lies.txt");
    let (mut told, mut from) = (String::new(), String::new());
    for line in std::fs::read_to_string(&path).unwrap().lines() {
        if line.starts_with("! ") {
            continue;
        }
        told += &format!("{line}\n");
        if let Some(stands) = line.strip_prefix("- ") {
            from = stands.into();
        } else if let Some(to) = line.strip_prefix("+ ") {
            let error = Tables::from_bytes(&forge(&from, to)).expect_err(to);
            told += &format!("! {error}\n");
        }
    }
    Assert::new().action_env("SNAPSHOTS").eq(told, Data::read_from(&path, None).raw());
    // The forgery itself loads.
    assert!(Tables::from_bytes(&forge("microfacet-tables", "microfacet-tables")).is_ok());
}

#[test]
fn schlick_is_one_number_where_its_channels_are_equal() {
    // Both are read, and written again as the shorter.
    for (text, f0, again) in [
        (r#"{"schlick":0.04}"#, [0.04; 3], r#"{"schlick":0.04}"#),
        (r#"{"schlick":[0.5,0.5,0.5]}"#, [0.5; 3], r#"{"schlick":0.5}"#),
        (r#"{"schlick":[0.95,0.64,0.54]}"#, [0.95, 0.64, 0.54], r#"{"schlick":[0.95,0.64,0.54]}"#),
    ] {
        let entry: Reflectance = serde_json::from_str(text).unwrap();
        assert_eq!(entry, Reflectance::Schlick(f0));
        assert_eq!(serde_json::to_string(&entry).unwrap(), again);
    }
}

#[test]
fn what_would_be_refused_is_not_written() {
    let first = |change: &dyn Fn(&mut MaterialEntry)| {
        let mut materials = materials();
        change(&mut materials[0]);
        encode(&Provenance { materials, ..Provenance::default() }, &small_tables())
            .unwrap_err()
            .to_string()
    };
    let inf = f64::INFINITY;
    let interface = |side| Reflectance::Interface { side, index: [1.5; 2].into() };
    let changes: [&dyn Fn(&mut MaterialEntry); 7] = [
        &|of| of.lobe.roughness = Roughness::Isotropic([f64::NAN; 2].into()),
        &|of| of.lobe.roughness = Roughness::Isotropic([0.1, inf].into()),
        &|of| of.lobe.gamma.max = f64::NAN,
        &|of| of.lobe.roughness = Roughness::ALL,
        &|of| of.fresnel = Some(interface(Side::Thin)),
        &|of| of.lobe.theta = Some([f64::NAN; 3]),
        &|of| of.fresnel = Some(Reflectance::Schlick([0.5, f64::NAN, 0.5])),
    ];
    for why in changes.map(first) {
        assert!(why.contains("`tilted`"), "{why}");
    }
}

#[test]
fn an_albedo_of_what_cannot_be_is_refused() {
    let refused = |lobe: LobeSpec, reflectance: Reflectance, part: &str| {
        let (masking, reflectance) = (Some(Masking::Uncorrelated), Some(reflectance));
        let subject = Subject { lobe, masking, reflectance };
        let mut table = small_tables().remove(0);
        (table.kind, table.subject) = (Kind::Albedo, subject);
        let why = table.validate().unwrap_err().to_string();
        assert!(why.contains(part), "{why}");
    };
    let (moments, single) = (Reflectance::Mirror, LobeSpec::student_t);
    let tilted = |sigma, angle| LobeSpec { theta: Some([0.1, angle, 0.0]), ..single(sigma, 2.0) };
    refused(single([0.3, -0.3], 2.0), moments, "sigma = [-0.3, -0.3]");
    refused(single([0.3, 0.0], 2.0), moments, "single numbers more than 0");
    refused(single([0.3, 0.1], 1.5), moments, "gamma = [1.5, 1.5]");
    refused(tilted([0.3, -0.3], 0.1), moments, "sigma");
    refused(tilted([0.3, 0.3], f64::NAN), moments, "NaN");
    refused(LobeSpec::outside(String::new()), moments, "without a label");
    let any = LobeSpec::family(Roughness::ALL, [2.0; 2].into());
    refused(any, moments, "sigma = [0, inf]");
    let metal = Reflectance::Conductor { eta: [0.2, -0.9, 1.1], k: [3.9; 3] };
    refused(LobeSpec::GENERAL, metal, "eta must be more than 0");
    let inf = f64::INFINITY;
    for index in [[0.5, inf], [2.0, 1.5], [f64::NAN, inf], [1.5, f64::NAN], [inf, inf]] {
        let pane = Reflectance::Interface { side: Side::Thin, index: index.into() };
        refused(LobeSpec::GENERAL, pane, "indices of refraction");
    }
    for material in [Reflectance::Schlick([0.04; 3]), Reflectance::dielectric(1.5)] {
        refused(LobeSpec::GENERAL, material, "an albedo is of");
    }
    for gamma in [[f64::NAN, 2.0], [2.0, f64::NAN], [3.0, 2.0]] {
        let mut table = small_tables().remove(0);
        table.subject.lobe.gamma = gamma.into();
        assert!(table.validate().unwrap_err().to_string().contains("must ascend"));
    }
    let mut table = small_tables().remove(0);
    table.subject.lobe.roughness = Roughness::Isotropic([0.1; 2].into());
    assert!(table.validate().unwrap_err().to_string().contains("of every sigma"));
}

/// There are as many values as the axes then have, so that only the mapping is wrong.
#[test]
fn halves_of_numbers_that_a_kind_does_not_have_are_refused() {
    for (i, other) in [(1, Mapping::OddRoot), (2, Mapping::MirroredRoot)] {
        let mut tables = small_tables();
        let table = &mut tables[i];
        let axis = table.axes.last_mut().unwrap();
        let before = axis.len();
        axis.mapping = other;
        let count = table.values.len() * axis.len() / before;
        table.values.resize(count, 1.0);
        assert_eq!(table.shape().iter().product::<usize>(), table.values.len());
        let why = encode(&Provenance::default(), &tables).unwrap_err().to_string();
        assert!(why.contains(other.name()), "{why}");
    }
}

#[test]
fn a_newer_version_says_so() {
    // With a key that this version does not have.
    let now = format!(r#"\"version\":{OLDEST_VERSION}"#);
    let newer = forge(&now, &format!(r#"\"version\":{},\"weather\":\"fine\""#, VERSION + 1));
    let Err(LoadError::Unsupported(why)) = Tables::from_bytes(&newer) else { panic!("loaded") };
    assert!(
        why.contains(&format!("version {}", VERSION + 1))
            && why.contains(&format!("knows {OLDEST_VERSION} to {VERSION}")),
        "{why}"
    );
}

#[test]
fn values_that_no_lookup_survives_are_refused() {
    let last = small_file().len();
    // In all tensors, each value but those of fixed point is made NaN, infinite and negative in
    // turn.
    let mut refused = 0;
    for at in (last - 64..last).step_by(2) {
        for bits in [f32::NAN, f32::INFINITY, -1.0].map(f32::to_le_bytes) {
            let mut file = small_file();
            let end = (at + 4).min(last);
            file[at..end].copy_from_slice(&bits[..end - at]);
            seal(&mut file);
            match Tables::from_bytes(&file) {
                Err(_) => refused += 1,
                Ok(set) => assert!(set.tables().iter().all(|table| table.validate().is_ok())),
            }
        }
    }
    assert!(refused > 10, "{refused}");
}

#[test]
fn headers_longer_than_files_and_towers_of_brackets_are_refused() {
    for length in [0, 1, 8, 100, 1 << 20, 1 << 40, u64::MAX] {
        let mut file = small_file();
        file[..8].copy_from_slice(&length.to_le_bytes());
        assert!(Tables::from_bytes(&file).is_err(), "{length}");
    }
    let tower = "[".repeat(100_000);
    assert!(
        Tables::from_bytes(&forge(r#"\"tables\":["#, &format!(r#"\"tables\":[{tower}"#))).is_err()
    );
}

/// No argument causes a panic; finite views that are not too short give values in range and normals
/// above the horizon.
#[test]
fn directions_and_numbers_out_of_their_domain_are_answered() {
    let tables = Tables::embedded();
    let odd = [0.0, -0.0, 1e-45, -1e-45, 1e-38, 1e-20, 1e-10, 1.0, -1.0, f32::NAN];
    for gamma in [1.501, 1.7, 2.0, 3.0, f64::INFINITY, f64::NAN] {
        for sigma in [[1e-8_f32, 1e-8], [0.3, 0.3], [1e-8, 1e6], [1e6, 1e6]] {
            // NaN stands for the closed forms of GGX.
            let material: Lobe = if gamma.is_nan() {
                Ggx::new(sigma).unwrap().into()
            } else {
                tables.lobe(sigma, gamma).unwrap()
            };
            for v in odd
                .iter()
                .flat_map(|&x| odd.iter().flat_map(move |&y| odd.map(|z| Vec3::new(x, y, z))))
            {
                let v = if v.length() > 1e-3 { v.normalize() } else { v };
                let defined = v.is_finite() && v.length() > 1e-3;
                for u in [
                    [0.0, 0.5],
                    [1.0, 1.0],
                    [0.3, f32::NAN],
                    [f32::NAN, 0.3],
                    [f32::NEG_INFINITY, f32::INFINITY],
                    [-3.0, 7.0],
                ] {
                    let m = Vec3::from(material.sample_visible_normal(v, u));
                    let sound = (m.length() - 1.0).abs() < 5e-7 && m.z > 0.0;
                    assert!(sound || !defined, "{gamma} {sigma:?} {v} {u:?}: {m}");
                }
                let g1 = material.g1(v);
                if defined {
                    assert!((0.0..=1.0).contains(&g1), "{gamma} {sigma:?} {v}: {g1}");
                    // The smallest cosines times G1/cos may underflow.
                    assert!(
                        if v.z > 1e-30 { g1 > 0.0 } else { v.z > 0.0 || g1 == 0.0 },
                        "{gamma} {sigma:?} {v}: {g1}"
                    );
                    assert!(material.lambda(v) >= 0.0);
                    assert!(
                        material.d(v) >= 0.0 && material.d(v).is_finite(),
                        "{gamma} {sigma:?} {v}"
                    );
                    assert!((0.0..=1.0).contains(&material.g2(
                        v,
                        Vec3::Z,
                        Masking::HeightCorrelated
                    )));
                }
            }
        }
    }
}

/// Random numbers outside [0, 1] are those of the nearer end and NaN is 0, for every sampler.
#[test]
fn random_numbers_are_clamped() {
    let tables = Tables::embedded();
    let family = tables.family().unwrap();
    let ends = [(f32::NAN, 0.0), (f32::NEG_INFINITY, 0.0), (-1e-9, 0.0), (1.001, 1.0)];
    let ends = ends.into_iter().chain([(f32::INFINITY, 1.0), (2.0, 1.0)]);
    let pairs = |x: f32| [[x, 0.3], [0.3, x], [x, x]];
    let tilted = Skew::new([0.5, 0.2], [0.6, 0.1, 1.0]).unwrap();
    for (odd, end) in ends {
        for (u, clamped) in pairs(odd).into_iter().zip(pairs(end)) {
            for gamma in [1.501, 1.6, 1.79, 2.0, 3.0, f64::INFINITY] {
                let student_t = tables.student_t(0.5, gamma).unwrap();
                let bounded_lobe = student_t.clone().bounded();
                let ellipsoid = tables.ellipsoid(tilted, gamma).unwrap();
                // The last view is below the horizon of the ellipsoid's unit space.
                for v in [[0.6, 0.0, 0.8], [0.0, 0.0, 1.0], [-0.8, 0.6, 1e-4], [0.0, -0.99, 0.05]] {
                    let v = Vec3::from(v).normalize();
                    let lobes: [Lobe; 3] = [
                        student_t.clone().into(),
                        ellipsoid.clone().into(),
                        Ggx::new(0.5).unwrap().into(),
                    ];
                    for lobe in lobes {
                        let m = Vec3::from(lobe.sample_visible_normal(v, u));
                        assert_eq!(
                            m.to_array(),
                            lobe.sample_visible_normal(v, clamped),
                            "{gamma} {v} {u:?}"
                        );
                        let mut batch = [Vec3::ZERO; 5];
                        lobe.sample_batch(&[v; 5], &[u; 5], &mut batch).unwrap();
                        assert!(batch.iter().all(|b| b.distance(m) < 1e-6), "{gamma} {v} {u:?}");
                    }
                    let bounded = bounded_lobe.at(v);
                    assert_eq!(bounded.sample(u), bounded.sample(clamped), "{gamma} {v} {u:?}");
                    let per_hit = family.at(0.5, gamma as f32).bounded();
                    let [odd, of_end] =
                        [u, clamped].map(|u| per_hit.sample_reflecting_normal(v, u));
                    assert_eq!(odd, of_end, "{gamma} {v} {u:?}");
                }
            }
            let albedo = tables.albedo(0.5, 3.0, Masking::Uncorrelated).unwrap();
            let l = Vec3::from(albedo.sample_compensation(u));
            assert_eq!(l.to_array(), albedo.sample_compensation(clamped), "{u:?}");
            assert!((l.length() - 1.0).abs() < 5e-7 && l.z >= 0.0, "{u:?}: {l}");
        }
    }
}

#[test]
fn roughness_and_shape_out_of_range_are_refused_by_value() {
    let tables = Tables::embedded();
    for sigma in [0.0, -1.0, 1e-9, 9e-9, 2e6, 1e7, f64::INFINITY, f64::NAN] {
        let why = tables.student_t([0.3, sigma], 2.0).unwrap_err();
        assert!(matches!(why, MaterialError::Sigma { .. }));
        let text = why.to_string();
        assert!(text.contains("sigma") && text.contains("[1e-8, 1e6]"), "{text}");
        assert!(tables.student_t(sigma, 3.0).is_err());
        // At a hit nothing is refused: σ is clamped, NaN to a mirror.
        let shape = tables.student_t(0.3, 2.0).unwrap();
        let clamped = if sigma > 1.0 { 1e6 } else { 1e-8 };
        assert_eq!(shape.with_roughness(sigma as f32).sigma(), [clamped; 2], "{sigma}");
    }
    for gamma in [f64::NAN, 1.5, 1.0, 0.0, -3.0, f64::NEG_INFINITY] {
        let why = tables.student_t(0.3, gamma).unwrap_err();
        assert!(matches!(why, MaterialError::Gamma(_)) && why.to_string().contains("(1.5, inf]"));
    }
    // Legal, but with a heavier tail than any table.
    let why = tables.student_t(0.3, 1.5005).unwrap_err().to_string();
    for part in ["1.5005", "not covered", "take gamma = 1.501 or more"] {
        assert!(why.contains(part), "{why}");
    }
    assert!(tables.material("glass").unwrap_err().to_string().contains("no named materials"));
}
