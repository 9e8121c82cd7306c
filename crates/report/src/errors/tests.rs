use std::time::Instant;

use microfacet_tables::{Kind, Provenance};

use super::*;
use crate::tests::baked;

fn html(set: &Tables, meter: &Meter) -> String {
    let source = Source { name: "a set", set, validation: None };
    section(&source, meter).unwrap().into_string()
}

fn drawn(set: &Tables) -> String {
    html(set, &Meter::default())
}

fn figures(html: &str) -> Vec<&str> {
    html.split("<figure").skip(1).map(|rest| rest.split("</figure>").next().unwrap()).collect()
}

#[test]
fn of_the_default_set_each_table_has_a_map_that_is_small_and_keeps_to_its_certificate() {
    let set = Tables::embedded();
    let html = drawn(&set);
    let figures = figures(&html);
    assert_eq!(figures.len(), 12);
    for table in set.tables() {
        let name = format!("<code>{}</code>", texts::name(&table.name).0);
        assert!(figures.iter().any(|figure| figure.contains(&name)), "{name}");
    }
    for figure in figures {
        assert!(figure.contains("; measured at ") && !figure.contains(" errors in "), "{figure}");
        assert!(figure.len() < 6000, "{} bytes: {figure}", figure.len());
        assert!(!figure.contains("more than its certificate"), "{figure}");
    }
    assert!(html.contains("5 more are left out"), "{html}");
}

#[test]
fn progress_ends_when_the_section_does_and_its_estimate_is_of_the_right_size() {
    let set = Tables::embedded();
    let meter = Meter::default();
    let expected = seconds(&set);
    meter.expect(expected);
    let start = Instant::now();
    html(&set, &meter);
    assert!((meter.share() - 1.0).abs() < 1e-6, "{}", meter.share());
    // Other tests run at the same time, and machines differ.
    let took = start.elapsed().as_secs_f64();
    assert!((0.02..50.0).contains(&(took / expected)), "{took} s, of {expected} s");
}

#[test]
fn one_shape_has_curves_and_names_of_a_set_are_text() {
    let baked = baked("[[material]]\nname = \"a\"\nsigma = 0.3\ngamma = 3\n");
    let mut tables = baked.tables().to_vec();
    tables.iter_mut().for_each(|table| table.name = format!("<script>&\"{}", table.name));
    let set = Tables::from_tables(baked.provenance().clone(), tables).unwrap();
    let html = drawn(&set);
    assert_eq!(figures(&html).len(), set.tables().len(), "{html}");
    assert!(html.contains("<polyline") && html.contains("&lt;script&gt;&amp;"), "{html}");
    assert!(!html.contains("<script>"), "{html}");
    let largest = figures(&html).iter().map(|figure| figure.len()).max().unwrap();
    assert!(largest < 6000, "{largest} bytes");
}

#[test]
fn a_table_that_cannot_be_measured_is_said_in_words() {
    let default = Tables::embedded();
    let table = default.tables().iter().find(|table| table.kind == Kind::VisibleSlope).unwrap();
    let set = Tables::from_tables(Provenance::default(), vec![table.clone()]).unwrap();
    let html = drawn(&set);
    assert!(figures(&html).is_empty());
    assert!(html.contains("Largest error of the CDF of visible normals: 2.44e-5"), "{html}");
    assert_eq!(drawn(&Tables::from_tables(Provenance::default(), Vec::new()).unwrap()), "");
}

#[test]
fn a_library_shows_the_largest_errors() {
    // Five shapes, each with masking, slopes and slopes across; of draft quality.
    let recipe: String = [2.5, 3.0, 4.0, 5.0, 7.0]
        .map(|gamma| format!("[[material]]\nname = \"{gamma}\"\nsigma = 0.3\ngamma = {gamma}\n"))
        .concat();
    let set = baked(&recipe);
    let chosen = Chosen::of(&set);
    assert_eq!(chosen.maps.len(), 12);
    assert_eq!(chosen.left_out, set.tables().len() - 12);
    let error = |table: &Table| table.certificate.worst();
    let is_shown = |table: &&Table| chosen.maps.iter().any(|(shown, _)| shown.name == table.name);
    let least = chosen.maps.iter().map(|(table, _)| error(table)).fold(f64::INFINITY, f64::min);
    let others = set.tables().iter().filter(|table| !is_shown(table));
    assert!(others.map(error).all(|error| error <= least));
}
