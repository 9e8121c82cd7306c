use super::*;
use crate::Interval;
use crate::axis::{Axis, Azimuth, Interpolation, LogRoughness, LogShape, Mapping, ViewBlend};
use crate::format::{Provenance, decode, describe, encode};

const SIX: Interpolation = Interpolation::Lagrange6;

/// An albedo of one material, whose values tell it from others.
fn table(subject: Subject, axes: Vec<Axis>) -> Table {
    let subject = Subject { masking: Some(Masking::Uncorrelated), ..subject };
    let channels = subject.reflectance.unwrap().channels().iter().map(|&name| name.into());
    let channels: Vec<String> = channels.collect();
    let count = axes.iter().map(Axis::len).product::<usize>() * channels.len();
    let first = subject.name(Kind::Albedo).len() as f32 / 512.0;
    let table = Table {
        name: subject.name(Kind::Albedo),
        kind: Kind::Albedo,
        subject,
        axes,
        channels,
        values: (0..count).map(|i| first + i as f32 / 4096.0).collect(),
        precision: Precision::U16,
        certificate: Certificate { quadrature: Some(f64::from(first)), ..Default::default() },
    };
    table.rounded(Precision::U16)
}

fn view(mapping: ViewBlend) -> Axis {
    Axis::placed("view", Mapping::ViewBlend(mapping), SIX, 7)
}

/// A round lobe.
fn round(sigma: f64, gamma: f64, reflectance: Reflectance) -> Table {
    let axis = |name, mapping, node| Axis::new(name, mapping, SIX, vec![node]);
    let (shape, rough) = (LogShape::BAKED, LogRoughness::BAKED);
    let axes = vec![
        axis("gamma", Mapping::LogShape(shape), shape.coordinate(gamma)),
        axis("sigma", Mapping::LogRoughness(rough), rough.coordinate(sigma)),
        view(ViewBlend::BAKED),
    ];
    let lobe = LobeSpec::student_t([sigma; 2], gamma);
    table(Subject { reflectance: Some(reflectance), ..Subject::of(lobe) }, axes)
}

/// An anisotropic lobe.
fn brushed(sigma: [f64; 2], gamma: f64) -> Table {
    let azimuth = Mapping::Azimuth(Azimuth { sigma, turn: 0.0, fold: true });
    let axes =
        vec![Axis::placed("azimuth", azimuth, SIX, 3), view(ViewBlend::BAKED.of_shape(gamma))];
    let lobe = LobeSpec::student_t(sigma, gamma);
    table(Subject { reflectance: Some(Reflectance::Mirror), ..Subject::of(lobe) }, axes)
}

fn tables() -> Vec<Table> {
    let gold = Reflectance::Conductor { eta: [0.2, 0.9, 1.1], k: [3.9, 2.4, 2.2] };
    let silver = Reflectance::Conductor { eta: [0.1, 0.2, 0.3], k: [4.0, 3.0, 2.0] };
    let pane =
        |side| Reflectance::Interface { side, index: Interval { min: 1.5, max: f64::INFINITY } };
    let moments = Reflectance::Mirror;
    let mut dielectric = round(0.4, f64::INFINITY, pane(Side::Thin));
    let eta = Axis::new("eta", Mapping::ReflectanceRoot, SIX, crate::axis::even_nodes(0.0, 1.0, 6));
    dielectric.axes.insert(2, eta);
    dielectric.values = vec![0.25; 6 * dielectric.values.len()];
    vec![
        round(0.1, 2.43, moments),
        round(0.25, 1.7320508075688772, moments),
        brushed([0.1, 0.3], 2.43),
        brushed([0.2, 0.5], 3.1),
        round(0.1, 2.43, gold),
        round(0.3, 5.0, silver),
        dielectric,
    ]
}

#[test]
fn tables_of_one_layout_share_a_tensor_and_are_the_same_again() {
    let tables = tables();
    let bytes = encode(&Provenance::default(), &tables).unwrap();
    assert_eq!(decode(&bytes, true).unwrap().1, tables);
    let (axes, stacks) = stacked(&tables);
    let counts: Vec<_> = stacks.iter().map(|stack| (&stack.name[..], stack.count)).collect();
    assert_eq!(
        counts,
        [
            ("albedo_uncorrelated_1", Some(2)),
            ("albedo_uncorrelated_2", Some(2)),
            ("albedo_uncorrelated_conductors_1", Some(2)),
            (&tables[6].name[..], None),
        ]
    );
    // Those of γ, σ, the view of all, the azimuth and η.
    assert_eq!(axes.len(), 5);
}

#[test]
fn a_table_of_another_name_stands_alone() {
    let mut tables = tables();
    tables[1].name = "albedo_uncorrelated_1".into();
    let (_, stacks) = stacked(&tables[..4]);
    let names: Vec<_> = stacks.iter().map(|stack| (&stack.name[..], stack.len())).collect();
    let first = (&tables[0].name[..], 1);
    assert_eq!(names, [first, ("albedo_uncorrelated_1", 1), ("albedo_uncorrelated_2", 2)]);
    let bytes = encode(&Provenance::default(), &tables).unwrap();
    assert_eq!(decode(&bytes, true).unwrap().1, tables);
}

#[test]
fn columns_without_what_a_lobe_needs_are_refused_by_name() {
    let json = describe(&Provenance::default(), &tables()).unwrap();
    for (from, to, why) in [
        (r#""gamma":[2.43,1.7320508075688772]"#, r#""gamma":[2.43]"#, "`gamma` has 1 entries"),
        (
            r#""gamma":[2.43,1.7320508075688772],"sigma":[0.1,0.25]"#,
            r#""gamma":[2.43,2.43],"sigma":[0.1,0.1]"#,
            "named twice",
        ),
        (r#""sigma":[0.1,0.25]"#, r#""sigma":[0.1,[0.2,0.3]]"#, "the form StudentT, not"),
        (r#""gamma":[2.43,3.1],"#, "", "no `gamma`"),
        (r#""k":[[3.9,2.4,2.2],[4.0,3.0,2.0]],"#, "", "no `k`"),
        (r#""eta":[{"min":1.5}]"#, r#""eta":[[1.0,2.0,3.0]]"#, "no `eta`"),
        (r#""side":"thin","#, "", "no `side`"),
        (r#""quadrature_error":[0.0"#, r#""quadrature_error":[0.5,0.0"#, "has 3 entries"),
    ] {
        assert!(json.contains(from), "no {from} in {json}");
        let mut values = tables().into_iter().map(|table| Ok(table.values));
        let read = crate::reassemble(&json.replacen(from, to, 1), || values.next().unwrap());
        let got = format!("{}", read.unwrap_err());
        assert!(got.contains(why), "{to}: {got}");
    }
}
