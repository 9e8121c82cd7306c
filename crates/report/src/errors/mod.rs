//! Heat maps of tables' errors over their axes, measured again for the page.

mod drawing;
mod ticks;
mod words;

use maud::{Markup, PreEscaped, html};

use microfacet_baker::plan::on_threads;
use microfacet_baker::progress::Meter;
use microfacet_sampler::Tables;
use microfacet_tables::Table;

use super::drawing::SIZE;
use super::texts;
use super::{ReportError, Source};
use crate::error_map;
use crate::error_map::{ErrorMap, Sides, Unmeasured, measure, sides};
use crate::plot::{Axis, bar};

/// Most tables without a map whose certificates are stated in words.
const IN_WORDS: usize = 12;

/// Most maps of a page.
const MOST: usize = 12;

struct Chosen<'a> {
    /// Tables and axes, in the order of the set.
    maps: Vec<(&'a Table, Sides)>,
    /// Maps that there is no room for.
    left_out: usize,
    /// Tables without an axis to show.
    single: Vec<&'a Table>,
}

impl<'a> Chosen<'a> {
    /// First maps of tables come before second ones, larger certified errors before smaller ones.
    fn of(set: &'a Tables) -> Self {
        let tables = set.tables();
        let mut all: Vec<(usize, usize, Sides)> = Vec::new();
        for (i, table) in tables.iter().enumerate() {
            all.extend(sides(table).into_iter().enumerate().map(|(nth, sides)| (nth, i, sides)));
        }
        let single = tables.iter().filter(|table| sides(table).is_empty()).collect();
        let error = |i: usize| tables[i].certificate.worst();
        all.sort_by(|a, b| a.0.cmp(&b.0).then(error(b.1).total_cmp(&error(a.1))));
        let left_out = all.len().saturating_sub(MOST);
        all.truncate(MOST);
        all.sort_by_key(|&(nth, i, _)| (i, nth));
        let maps = all.into_iter().map(|(_, i, sides)| (&tables[i], sides)).collect();
        Self { maps, left_out, single }
    }
}

/// The estimated seconds of [`section`] on the current threads.
pub(super) fn seconds(set: &Tables) -> f64 {
    let seconds = Chosen::of(set).maps.into_iter().map(|(table, sides)| of_map(table, sides));
    seconds.sum()
}

fn of_map(table: &Table, sides: Sides) -> f64 {
    on_threads(error_map::seconds(table, sides))
}

/// A table with the map that was measured of it, or why there is none.
type Measured<'a> = (&'a Table, Result<ErrorMap, Unmeasured>);

pub(super) fn section(source: &Source, meter: &Meter) -> Result<Markup, ReportError> {
    let chosen = Chosen::of(source.set);
    let map = |&(table, sides): &(_, Sides)| -> Measured<'_> {
        let stage = meter.stage(of_map(table, sides));
        (table, measure(source.set, table, sides, &stage))
    };
    let measured: Vec<Measured<'_>> = chosen.maps.iter().map(map).collect();
    let drawn = || measured.iter().filter_map(|(table, map)| Some((*table, map.as_ref().ok()?)));
    let missing: Vec<(&Table, String)> = measured
        .iter()
        .filter_map(|(table, map)| Some((*table, map.as_ref().err()?.to_string())))
        .chain(chosen.single.iter().map(|table| (*table, Unmeasured::NoAxes.to_string())))
        .collect();
    let scale = drawing::scale(drawn().map(|(_, map)| map.largest()));
    if drawn().next().is_none() && missing.is_empty() {
        return Ok(html! {});
    }
    Ok(html! {
        @if drawn().next().is_some() {
            p {
                "Measured anew when this page was made: differences of G1, of the CDF of the slopes "
                "drawn, and of the share of light in an albedo. Each pixel is the largest of the "
                "errors measured in it; black is about the rounding of single precision."
            }
            @let bar = bar(&scale, SIZE[0]).inline_svg("the scale of the errors");
            div class="scale" style="max-width: 24rem" { (PreEscaped(bar)) }
            div class="figures" {
                @for (table, map) in drawn() { (figure(table, map, &scale)) }
            }
        }
        @if chosen.left_out > 0 {
            p class="note" {
                "The maps are those of the largest errors; "
                (chosen.left_out)
                @if chosen.left_out == 1 { " more is" } @else { " more are" }
                " left out."
            }
        }
        @if !missing.is_empty() {
            p { "Without a map, by their certificates:" }
            ul {
                @for (table, why) in missing.iter().take(IN_WORDS) {
                    li {
                        code { (texts::name(&table.name)) } ": " (words::sentence(why)) @for line in words::lines(table) { " " (line) }
                    }
                }
                @if missing.len() > IN_WORDS { li { (missing.len() - IN_WORDS) " more" } }
            }
        }
    })
}

fn figure(table: &Table, map: &ErrorMap, scale: &Axis) -> Markup {
    html! {
        figure class="map" {
            (PreEscaped(drawing::drawn(table, map, scale)))
            figcaption {
                strong { (words::what(table)) } " " code { (texts::name(&table.name)) } ". "
                (words::certified(table)) " " (words::map(table, map))
            }
        }
    }
}

#[cfg(test)]
mod tests;
