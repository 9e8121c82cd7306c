//! The members of a shape's description and its tables, by name, which lookups read; every target
//! writes them in this order.

use microfacet_core::shape::s_of_gamma;
use microfacet_sampler::port::ShapeTables;
use microfacet_tables::axis::ViewBlend;

use super::{AlbedoTable, Shape, TurningAlbedo};

pub(super) struct Member {
    pub(super) name: &'static str,
    pub(super) value: Value,
}

pub(super) enum Value {
    /// Yes or no.
    Flag(bool),
    /// A number of nodes.
    Count(usize),
    /// Any number.
    Number(f32),
    /// A table of the shape by name, or none.
    Table(Option<String>),
}

impl Value {
    /// The value as a number, a flag as 0 or 1; `None` for a table.
    pub(super) fn number(&self) -> Option<f32> {
        match *self {
            Self::Flag(flag) => Some(f32::from(u8::from(flag))),
            Self::Count(count) => Some(count as f32),
            Self::Number(number) => Some(number),
            Self::Table(_) => None,
        }
    }
}

/// A table of a shape: rows of [`Part::columns`] numbers.
#[derive(Clone, Debug)]
pub struct Part<'a> {
    /// Its name, such as `masking` or `albedo_height_correlated`.
    pub name: String,
    /// Its rows, one after another.
    pub values: &'a [f32],
    /// Numbers in a row.
    pub columns: usize,
}

/// Prefixes of the names in each list of [`Shape::lists`], where the lists are joined.
pub(super) const PREFIXES: [&str; 3] = ["", "uncorrelated.", "height_correlated."];

impl Shape {
    /// Its members as shaders read them: of the lobe, and of albedos by form of masking.
    pub(super) fn lists(&self) -> [Vec<Member>; 3] {
        let [a, b] = &self.albedos;
        [lobe(self), albedo(a), albedo(b)]
    }

    /// The numbers of its description by name, as `student_t.json` has them (`docs/shaders.md`);
    /// offsets of tables are not among them. A flag is 0 or 1.
    pub fn numbers(&self) -> Vec<(String, f32)> {
        let of = |(prefix, list): (&str, Vec<Member>)| -> Vec<(String, f32)> {
            let named = |Member { name, value }| Some((format!("{prefix}{name}"), value.number()?));
            list.into_iter().filter_map(named).collect()
        };
        PREFIXES.into_iter().zip(self.lists()).flat_map(of).collect()
    }

    /// Its tables.
    pub fn parts(&self) -> Vec<Part<'_>> {
        fn part<const N: usize>(name: impl Into<String>, values: &[[f32; N]]) -> Part<'_> {
            Part { name: name.into(), values: values.as_flattened(), columns: N }
        }
        let mut parts = Vec::new();
        if let Some(tables) = &self.tables {
            parts.push(part("masking", &tables.masking));
            parts.push(part("slopes", &tables.slopes));
            parts.push(part("across", &tables.across));
            parts.extend(tables.heavy.as_ref().map(|heavy| part("heavy", &heavy.shares)));
        }
        for table in self.albedos.iter().filter(|table| !table.values.is_empty()) {
            let [values, averages] = names(table);
            parts.extend([part(values, &table.values), part(averages, &table.averages)]);
        }
        parts
    }
}

/// The members of the lobe; those that GGX does not need are 0.
fn lobe(shape: &Shape) -> Vec<Member> {
    let tables = shape.tables.as_ref();
    let heavy = tables.and_then(|tables| tables.heavy.as_ref());
    let crowded = tables.is_some_and(|tables| tables.masking_crowded);
    let number = |of: fn(&ShapeTables) -> f32| Value::Number(tables.map_or(0.0, of));
    let table = |name: &str| Value::Table(tables.map(|_| name.into()));
    let [d_s, d_power] = tables.map_or([1.0, 0.0], |tables| tables.normals);
    let members = [
        ("is_ggx", Value::Flag(tables.is_none())),
        ("s", Value::Number(s_of_gamma(shape.gamma) as f32)),
        ("d_s", Value::Number(d_s)),
        ("d_power", Value::Number(d_power)),
        ("kappa", number(|tables| tables.kappa)),
        ("masking_crowded", Value::Flag(crowded)),
        ("masking_cells", number(|tables| tables.masking_cells)),
        ("masking", table("masking")),
        ("rows", number(|tables| tables.lines.cells)),
        ("rows_first", number(|tables| tables.lines.slopes[0])),
        ("rows_second", number(|tables| tables.lines.slopes[1])),
        ("rows_second_end", number(|tables| tables.lines.second)),
        ("rows_third", number(|tables| tables.lines.slopes[2])),
        ("numbers", Value::Count(tables.map_or(0, |tables| tables.numbers))),
        ("along_scale", number(|tables| tables.scales[0])),
        ("slopes", table("slopes")),
        ("across_scale", number(|tables| tables.scales[1])),
        ("across", table("across")),
        ("heavy_per_row", Value::Number(heavy.map_or(0.0, |heavy| heavy.cells_per_row))),
        ("heavy", Value::Table(heavy.map(|_| "heavy".into()))),
        ("heavy_exponent", Value::Number(heavy.map_or(0.0, |heavy| heavy.exponent))),
        ("heavy_root_s", Value::Number(heavy.map_or(0.0, |heavy| heavy.root_s))),
    ];
    members.map(|(name, value)| Member { name, value }).into()
}

fn albedo(table: &AlbedoTable) -> Vec<Member> {
    let ([values, averages], here) = (names(table), !table.values.is_empty());
    let [first, last] = table.ends;
    let (sigma, view) = (table.roughness, table.view);
    let number = |x: f64| Value::Number(x as f32);
    let members = [
        ("values", Value::Table(here.then_some(values))),
        ("averages", Value::Table(here.then_some(averages))),
        ("sigmas", Value::Count(table.sigmas)),
        ("average_sigmas", Value::Count(table.averages.len())),
        ("views", Value::Count(table.views)),
        ("offset", number(sigma.offset)),
        ("first", number(sigma.first)),
        ("slow", number(sigma.slow)),
        ("linear", number(sigma.linear)),
        ("start", number(first)),
        ("range", number(last - first)),
        ("sigma_min", number(table.sigma[0])),
        ("sigma_max", number(table.sigma[1])),
    ];
    let of_view = of_view(&view).map(|(name, x)| (name, number(x)));
    members.into_iter().chain(of_view).map(|(name, value)| Member { name, value }).collect()
}

/// The members of a table by azimuth, in the order of those by roughness, of which it has none.
pub(super) fn turning(table: &TurningAlbedo, [values, averages]: [String; 2]) -> Vec<Member> {
    let view = table.view;
    let number = |x: f64| Value::Number(x as f32);
    let members = [
        ("values", Value::Table(Some(values))),
        ("averages", Value::Table(Some(averages))),
        ("sigmas", Value::Count(table.azimuths)),
        ("average_sigmas", Value::Count(1)),
        ("views", Value::Count(table.views)),
    ];
    let of_sigma =
        ["offset", "first", "slow", "linear", "start", "range", "sigma_min", "sigma_max"];
    let of_sigma = of_sigma.map(|name| (name, Value::Number(0.0)));
    let of_view = of_view(&view).map(|(name, x)| (name, number(x)));
    let all = members.into_iter().chain(of_sigma).chain(of_view);
    all.map(|(name, value)| Member { name, value }).collect()
}

/// The parameters of a coordinate of views.
fn of_view(view: &ViewBlend) -> [(&'static str, f64); 7] {
    [
        ("weight", view.weight),
        ("normal", view.normal),
        ("share", view.share),
        ("kappa", view.scale),
        ("spread", view.spread),
        ("floor", view.floor),
        ("slope", view.slope),
    ]
}

/// Names of the tables of albedos and of averages.
fn names(table: &AlbedoTable) -> [String; 2] {
    let masking = table.masking.name().replace('-', "_");
    ["albedo", "averages"].map(|part| format!("{part}_{masking}"))
}
