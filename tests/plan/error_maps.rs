//! Maps of errors: what they find is in the certificate, and where a table is wrong they show it.

use std::sync::LazyLock;

use microfacet_baker::plan::{AlbedoWish, Options, Plan};
use microfacet_baker::progress::{Meter, Stage};
use microfacet_baker::scene::Scene;
use microfacet_baker::store;
use microfacet_baker::table_set::{Target, bake};
use microfacet_baker::table_spec::Quality;
use microfacet_core::shape::s_of_gamma;
use microfacet_report::error_map::{ErrorMap, Quantity, Sides, measure, sides};
use microfacet_sampler::Tables;
use microfacet_tables::axis::MirroredRoot;
use microfacet_tables::{Kind, Mapping, Precision, Provenance, Table};

/// Lobes of one shape and of a range, of either kind of normals, and albedos of each kind that is
/// quick to bake.
const RECIPE: &str = "
    [[material]]
    name = \"range\"
    sigma = { min = 0.2, max = 0.4 }
    gamma = { min = 1.7, max = 3 }
    fresnel = \"mirror\"
    [[material]]
    name = \"brushed\"
    sigma = [0.1, 0.3]
    gamma = 5
    fresnel = \"mirror\"
    masking = \"uncorrelated\"
    [[material]]
    name = \"glass\"
    sigma = 0.3
    gamma = 5
    fresnel = { dielectric = 1.5 }
    [[material]]
    name = \"gold\"
    sigma = 0.2
    gamma = \"inf\"
    fresnel = { conductor = { eta = [0.2, 0.4, 1.3], k = [3.9, 2.4, 2.2] } }
    [[material]]
    name = \"gauss\"
    distribution = \"gauss\"
    m = 0.3
    fresnel = \"mirror\"
";

fn baked(recipe: &str, quality: Quality) -> Tables {
    let scene = Scene::from_recipe_str(recipe).unwrap();
    let options = Options { albedo: AlbedoWish::All, ..Options::default() };
    let plan = Plan::new(&scene, options).unwrap();
    bake(&plan, Target::Quality(quality, Precision::F32)).unwrap().set
}

static SET: LazyLock<Tables> = LazyLock::new(|| baked(RECIPE, Quality::Draft));

fn measured(set: &Tables, table: &Table, sides: Sides) -> ErrorMap {
    measure(set, table, sides, &Stage::unwatched())
        .unwrap_or_else(|why| panic!("{}: {why}", table.name))
}

fn maps(set: &Tables) -> Vec<(&Table, ErrorMap)> {
    let of =
        |table| sides(table).into_iter().map(move |sides| (table, measured(set, table, sides)));
    set.tables().iter().flat_map(of).collect()
}

/// No error of a map is above what its table was certified to, and where the map has the
/// certificate's place it finds nearly that.
fn agree(set: &Tables) {
    for (table, map) in maps(set) {
        let (largest, certified) = (map.largest(), table.certificate.worst());
        let name = &table.name;
        assert!(largest <= certified, "{name}: {largest:e} above {certified:e}");
        // A certificate adds a margin of rounding, and rounds up.
        if map.worst.is_some() {
            let least = 0.97 * certified - 1e-7;
            assert!(largest >= least, "{name}: {largest:e} misses {certified:e}");
        }
        assert!(map.errors.len().is_multiple_of(map.columns), "{name}");
        assert!(map.errors.iter().all(|error| *error >= 0.0), "{name}");
    }
}

#[test]
fn of_the_default_set() {
    agree(&Tables::embedded());
}

#[test]
fn of_a_recipe() {
    agree(&SET);
}

/// The largest errors of neighbouring cells are alike here.
#[test]
fn of_single_shapes_with_heavy_tails() {
    for gamma in [1.55, 1.6, 1.65, 1.7, 1.75] {
        let recipe = format!("[[material]]\nname = \"one\"\nsigma = 0.3\ngamma = {gamma}\n");
        agree(&baked(&recipe, Quality::Default));
    }
}

#[test]
fn every_kind_of_table_has_a_map() {
    let maps = maps(&SET);
    for kind in Kind::ALL {
        assert!(maps.iter().any(|(table, _)| table.kind == kind), "{kind:?}");
    }
    // One shape has no axis of shapes, and a range has.
    let of = |name: &str| {
        let (_, map) = maps.iter().find(|(table, _)| table.name == name).unwrap();
        (map.x.quantity, map.y.as_ref().map(|y| y.quantity))
    };
    assert_eq!(of("shadowing_gamma_5"), (Quantity::Cotangent, None));
    assert_eq!(of("visible_slope_gamma_5"), (Quantity::Cotangent, Some(Quantity::Number)));
    assert_eq!(of("visible_slope_gamma_1.7_to_3"), (Quantity::Cotangent, Some(Quantity::Gamma)));
}

/// The table with one value changed at these nodes.
fn planted(set: &Tables, name: &str, nodes: &[usize], by: f32) -> Tables {
    let mut tables = set.tables().to_vec();
    let table = tables.iter_mut().find(|table| table.name == name).unwrap();
    let index = nodes.iter().zip(&table.axes).fold(0, |i, (node, axis)| i * axis.len() + node);
    table.values[index * table.channels.len()] += by;
    let mut provenance = set.provenance().clone();
    provenance.conventions.clear();
    Tables::from_tables(provenance, tables).unwrap()
}

/// Where the largest error of a map is, in shares of its axes.
fn place(map: &ErrorMap) -> [f64; 2] {
    let rank = |i: &usize| map.errors[*i].to_bits();
    let at = (0..map.errors.len()).max_by_key(rank).unwrap();
    let rows = map.errors.len() / map.columns;
    let share = |i: usize, of: usize| (i as f64 + 0.5) / of as f64;
    [share(at % map.columns, map.columns), share(at / map.columns, rows)]
}

#[test]
fn a_wrong_value_shows_where_it_is() {
    let default = Tables::embedded();
    let cases: [(&str, &[usize], f32); 3] = [
        ("shadowing", &[6, 60], 0.01),
        ("visible_slope_conditional", &[20, 24], 0.05),
        ("albedo_height-correlated", &[0, 20, 16], 0.01),
    ];
    for (name, nodes, by) in cases {
        let wrong = planted(&default, name, nodes, by);
        let table = wrong.tables().iter().find(|table| table.name == name).unwrap();
        let map = measured(&wrong, table, sides(table)[0]);
        assert!(map.largest() > 5.0 * table.certificate.worst(), "{name}: {:e}", map.largest());
        // The node's place in the map, by its quantities.
        let material: Vec<f64> = nodes
            .iter()
            .zip(&table.axes)
            .filter_map(|(&node, axis)| axis.quantity(axis.nodes[node]))
            .collect();
        let (last, node) = (table.axes.last().unwrap(), nodes[nodes.len() - 1]);
        let t = last.nodes.get(node).copied().unwrap_or(0.0);
        let wanted = match last.mapping {
            Mapping::Rational(view) => {
                vec![view.quantity(t, view.kappa(s_of_gamma(material[0])))]
            }
            Mapping::ViewBlend(view) => vec![view.prepare(material[1], material[0]).quantity(t)],
            // The quantile is odd about a half.
            _ => [0.0, 1.0].map(|end| (end - MirroredRoot::number(t)).abs()).to_vec(),
        };
        let [x, y] = place(&map);
        let row = map.y.as_ref().unwrap();
        let want = row.fraction(material[material.len() - 1]).unwrap();
        assert!((y - want).abs() < 0.06, "{name}: {y}, planted at {want}");
        let wanted: Vec<f64> = wanted.iter().map(|&at| map.x.fraction(at).unwrap()).collect();
        assert!(wanted.iter().any(|want| (x - want).abs() < 0.06), "{name}: {x}, {wanted:?}");
    }
}

#[test]
fn a_table_alone_is_told_what_it_lacks() {
    let default = Tables::embedded();
    let alone = |kind: Kind| {
        let table = default.tables().iter().find(|table| table.kind == kind).unwrap();
        Tables::from_tables(Provenance::default(), vec![table.clone()]).unwrap()
    };
    for kind in [Kind::Shadowing, Kind::VisibleSlopeConditional, Kind::AlbedoAverage] {
        let set = alone(kind);
        let table = &set.tables()[0];
        let why = measure(&set, table, sides(table)[0], &Stage::unwatched()).err().unwrap();
        assert!(!why.to_string().is_empty(), "{kind:?}");
    }
    // Directional albedos are read by themselves.
    agree(&alone(Kind::Albedo));
}

#[test]
fn images_have_the_maps_of_the_set() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("set");
    store::write(&path, &SET, store::Format::Exr).unwrap();
    let read = store::read(&path).unwrap();
    let slopes = |set: &Tables| {
        let table = set.tables().iter().find(|table| table.kind == Kind::VisibleSlope).unwrap();
        measured(set, table, sides(table)[0]).errors
    };
    assert_eq!(slopes(&read), slopes(&SET));
}

#[test]
fn places_are_counted_once_each() {
    let set = Tables::embedded();
    let table = &set.tables()[0];
    let meter = Meter::default();
    meter.expect(1.0);
    let stage = meter.stage(1.0);
    measure(&set, table, sides(table)[0], &stage).unwrap();
    // Without the stage's end, which would count what is left.
    assert!((meter.share() - 1.0).abs() < 1e-9, "{}", meter.share());
}
