//! What a Student-t by tables costs beside GGX, as bars.

use microfacet_report::plot::{Axis, Bar, Bars, Key};

use crate::plot::Point;
use crate::rows::Quantity;
use crate::sampler::{BATCH, CAPS, LANES};
use crate::settings::GAMMA;
use crate::tables::TABLE;
use crate::{Failure, page, values};

/// Bars of a visible normal, one at a time and in lanes, of G1, and of a picture, of what a page
/// says.
pub(crate) fn svg(text: &str, points: &[Point]) -> Result<String, Failure> {
    let ns = |quantity: Quantity, name: &str| {
        let found = points.iter().find(|at| at.quantity == quantity && at.name == name);
        let missing = || Failure(format!("no row `{name}` in the table of {quantity:?}"));
        found.map(|at| at.ns).ok_or_else(missing)
    };
    let both = |quantity, [ggx, own]: [&str; 2]| -> Result<[f64; 2], Failure> {
        Ok([ns(quantity, ggx)?, ns(quantity, own)?])
    };
    let [_, (eight, _)] = LANES;
    let pictures = page::pictures(text)?.map(|seconds| 1e3 * seconds);
    let times = [
        (
            format!("a visible normal, γ = {GAMMA}"),
            ("ns", 1),
            both(Quantity::Normal, [CAPS, TABLE])?,
        ),
        ("the same, 8 lanes at a time".into(), ("ns", 1), both(Quantity::Normal, [eight, BATCH])?),
        (format!("masking G₁, γ = {GAMMA}"), ("ns", 1), both(Quantity::G1, [values::GGX, TABLE])?),
        ("a picture with σ and γ textured".into(), ("ms", 0), pictures),
    ];
    let groups = times.map(|(name, (unit, digits), [ggx, own])| {
        let bar = |key, name: &str, to, value| Bar { key, name: name.into(), to, value };
        // As many digits as rounded times give.
        let ratio = own / ggx;
        let bars = vec![
            bar(Key::OTHER, "GGX", 1.0, format!("{ggx:.digits$} {unit}")),
            bar(Key::TABLE, "Student-t", ratio, format!("{own:.digits$} {unit}, {ratio:.1} ×")),
        ];
        (name, bars)
    });
    let longest = groups.iter().flat_map(|(_, bars)| bars).map(|bar| bar.to).fold(1.0, f64::max);
    // Room for the value of the longest.
    let x = Axis::linear("run time, GGX = 1", 0.0, 1.5 * longest);
    let bars = Bars { title: "Run time beside GGX".into(), x, groups: groups.into() };
    Ok(bars.drawing().svg())
}

#[cfg(test)]
mod tests {
    use super::*;

    const PAGE: &str = include_str!("../../docs/benchmark.md");

    fn drawn(page: &str) -> Result<[String; 2], String> {
        let points = page::points(page).map_err(|why| why.0)?;
        let cost = svg(page, &points).map_err(|why| why.0)?;
        Ok([crate::plot::svg(&points), cost])
    }

    #[test]
    fn the_pictures_of_the_documentation_are_those_of_its_tables() {
        let [benchmark, cost] = drawn(PAGE).unwrap();
        assert!(benchmark == include_str!("../../docs/benchmark.svg"), "docs/benchmark.svg is old");
        assert!(cost == include_str!("../../docs/idea/cost.svg"), "docs/idea/cost.svg is old");
    }

    #[test]
    fn what_is_missing_is_named() {
        for (row, why) in [
            ("table, default, batch ", "no row `table, default, batch` in the table of Normal"),
            ("GGX, closed form  ", "no row `GGX, closed form` in the table of G1"),
            ("| GGX, σ textured ", "no row `| GGX, σ textured | SECONDS`"),
            ("D                 ", "no table that begins with `D` and `gamma`"),
        ] {
            let lines = PAGE.lines().filter(|line| !line.starts_with(row));
            let said = drawn(&lines.collect::<Vec<_>>().join("\n")).unwrap_err();
            assert!(said.starts_with(why), "{said}");
        }
        let torn = PAGE.replace("11.20       0", "11.2O       0");
        assert!(drawn(&torn).unwrap_err().contains("is no row of `G1`"));
    }
}
