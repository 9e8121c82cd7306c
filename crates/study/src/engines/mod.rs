//! Errors of the albedos of GGX that engines read from their tables.
//!
//! `cargo run --release -p microfacet-study -- engines shipped` prints the tables in
//! `docs/engines.md`, where `shipped` is a folder with files of engines, as that page names them;
//! names of layouts after it print those alone. Shipped files that are absent are not measured.
//! Each cell is the largest error and the root mean square, as the engine reads its table. Metals
//! are measured over √σ = 1/400 … 1 and 500 cosines from 1e-3 to 1; the largest error also over 120
//! cosines up to 0.1, even in their logarithms. Dielectrics are measured over 12 indices from 1.02
//! to 2.5, even in their logarithms, √σ = 1/16 … 1 and 40 cosines, with 20 up to 0.1. Relative
//! errors are divided by the exact value.

pub mod shipped;

use std::collections::HashMap;
use std::path::PathBuf;

use microfacet_baker::progress::Stage;
use microfacet_export::texture::engine::{LAYOUTS, Layout};
use microfacet_export::texture::{
    Channels, Checks, Deviation, Known, Place, Shapes, Texture, TextureSpec, known,
};

use crate::{Outcome, print_head};

const HORIZON: f64 = 1e-3;
/// Least cosine of the comparisons without grazing views.
const ABOVE: f64 = 0.02;
/// The indices of dielectrics.
const INDICES: [f64; 2] = [1.02, 2.5];
/// Tables of dielectrics with more texels are not fitted here, which would take very long.
const MOST_FITTED: usize = 1 << 13;

/// Places in rows of one material, first those of evenly spaced cosines, then those that are dense
/// at the horizon.
struct Grid {
    even: usize,
    row: usize,
    places: Vec<Place>,
}

/// From `first` to `last`, even in their logarithms.
fn logarithmic([first, last]: [f64; 2], of: usize) -> impl Iterator<Item = f64> {
    (0..of).map(move |i| first * (last / first).powf(i as f64 / (of - 1) as f64))
}

impl Grid {
    fn new([even, low]: [usize; 2], roughs: i32, etas: &[Option<f64>]) -> Self {
        let share = |i: usize| i as f64 / (even - 1) as f64;
        let spaced = (0..even).map(|i| HORIZON + (1.0 - HORIZON) * share(i));
        let cosines: Vec<f64> = spaced.chain(logarithmic([HORIZON, 0.1], low)).collect();
        let mut places = Vec::new();
        for &eta in etas {
            for k in 1..=roughs {
                let sigma = (f64::from(k) / f64::from(roughs)).powi(2);
                let place = |&cos: &f64| Place { gamma: 2.0, sigma, eta, cos: Some(cos) };
                places.extend(cosines.iter().map(place));
            }
        }
        Self { even, row: even + low, places }
    }

    /// Metals, or dielectrics seen from inside or outside.
    fn of(inside: Option<bool>) -> Self {
        let Some(inside) = inside else {
            return Self::new([500, 120], 400, &[None]);
        };
        let eta = |n: f64| Some(if inside { n.recip() } else { n });
        Self::new([40, 20], 16, &logarithmic(INDICES, 12).map(eta).collect::<Vec<_>>())
    }
}

/// Whether a texture is of dielectrics that are seen from inside; none for metals.
fn inside(spec: &TextureSpec) -> Option<bool> {
    spec.axes.iter().find_map(|axis| axis.along.inside())
}

struct What {
    title: &'static str,
    quantity: &'static str,
    dielectric: bool,
    relative: bool,
    least_cos: f64,
    least_sigma: f64,
}

impl What {
    fn counts(&self, place: &Place) -> bool {
        place.cos.is_some_and(|cos| cos >= self.least_cos) && place.sigma >= self.least_sigma
    }
}

const E: What = What {
    title: "E",
    quantity: "e",
    dielectric: false,
    relative: false,
    least_cos: HORIZON,
    least_sigma: 0.0,
};
const BOTH: What = What { title: "R + T", dielectric: true, ..E };
const REFLECTED: What = What { title: "R", quantity: "reflected", ..BOTH };
const TABLES: [What; 11] = [
    E,
    What { title: "E, cos θ ≥ 0.02", least_cos: ABOVE, ..E },
    What { title: "bias", quantity: "bias", ..E },
    What { title: "E, cos θ ≥ 0.02, relative", relative: true, least_cos: ABOVE, ..E },
    What {
        title: "E, cos θ ≥ 0.02, α = 1, relative",
        relative: true,
        least_cos: ABOVE,
        least_sigma: 1.0,
        ..E
    },
    BOTH,
    What { title: "R + T, cos θ ≥ 0.02", least_cos: ABOVE, ..BOTH },
    What { title: "R + T, cos θ ≥ 0.02, relative", relative: true, least_cos: ABOVE, ..BOTH },
    REFLECTED,
    What { title: "R, cos θ ≥ 0.02", least_cos: ABOVE, ..REFLECTED },
    What { title: "R, cos θ ≥ 0.02, relative", relative: true, least_cos: ABOVE, ..REFLECTED },
];

/// Places of a grid with their exact values.
type Exact = (Grid, Vec<Known>);

/// What textures are compared with: exact values by the form of masking and the side that
/// dielectrics are seen from, and our own textures by their size.
#[derive(Default)]
struct Judge {
    exact: HashMap<(&'static str, Option<bool>), Exact>,
    ours: HashMap<(Vec<usize>, &'static str), Texture>,
}

impl Judge {
    /// Largest error and root mean square of a quantity; none if the texture does not have it.
    fn of(&mut self, texture: &Texture, what: &What) -> Option<String> {
        let spec = &texture.spec;
        let key = (spec.masking.name(), inside(spec));
        let (grid, all) = self.exact.entry(key).or_insert_with(|| {
            let grid = Grid::of(key.1);
            let known = known(&grid.places, spec.masking, &Stage::unwatched());
            (grid, known.expect("in the domain"))
        });
        let found = |known: &[Known]| {
            let found = Checks::at(spec, known).of(texture, |place| what.counts(place));
            let found = found.into_iter().find(|found| found.quantity == what.quantity)?;
            let of = |found: Deviation| [found.largest, found.rms];
            Some(if what.relative { found.relative } else { of(found) })
        };
        let even: Vec<Known> =
            all.chunks(grid.row).flat_map(|row| row[..grid.even].to_vec()).collect();
        Some(format!("{:.1e} / {:.1e}", found(all)?[0], found(&even)?[1]))
    }

    /// Our own texture of metals of the same size, fitted.
    fn ours(&mut self, like: &Texture) -> Option<Texture> {
        if inside(&like.spec).is_some() {
            return None;
        }
        let (size, masking) = (like.size(), like.spec.masking);
        let make = || {
            let [spec, _] = TextureSpec::of_shapes(
                "lut",
                Shapes::One(2.0),
                1.0,
                &size,
                masking,
                Channels::ScaleBias,
            );
            spec.make(&Stage::unwatched()).expect("in the domain")
        };
        Some(self.ours.entry((size.clone(), masking.name())).or_insert_with(make).clone())
    }
}

/// The tables of a layout as its engine reads them from the files that are written.
fn written(layout: &Layout, fitted: bool) -> Vec<Texture> {
    let make = |spec: &TextureSpec| spec.make(&Stage::unwatched()).expect("in the domain");
    let specs = layout.specs(2.0, layout.size, fitted);
    let textures: Vec<Texture> = specs.iter().map(make).collect();
    shipped::written(layout, layout.size, &layout.files(&textures).expect("files"))
}

/// A table of a layout: as shipped, with exact values, with fitted ones, and our own.
struct Row {
    name: String,
    textures: [Option<Texture>; 4],
}

impl Row {
    fn of_layout(layout: &Layout, folder: Option<&PathBuf>, judge: &mut Judge) -> Vec<Self> {
        let shipped = folder.and_then(|folder| {
            shipped::decode(layout, layout.size, |name| std::fs::read(folder.join(name)).ok())
        });
        let exact = written(layout, false);
        let large = |texture: &Texture| {
            inside(&texture.spec).is_some()
                && texture.size().iter().product::<usize>() > MOST_FITTED
        };
        let fitted = (!exact.iter().any(large)).then(|| written(layout, true));
        let one = |(i, exact): (usize, Texture)| {
            let view = match inside(&exact.spec) {
                Some(true) => ", from inside",
                Some(false) => ", from outside",
                None => "",
            };
            let [shipped, fitted] = [&shipped, &fitted].map(|all| Some(all.as_ref()?[i].clone()));
            let ours = judge.ours(&exact);
            let name = format!("{}{view}", layout.name);
            Self { name, textures: [shipped, Some(exact), fitted, ours] }
        };
        exact.into_iter().enumerate().map(one).collect()
    }
}

/// Runs the study that the module describes.
pub fn run(arguments: &[String]) -> Outcome {
    let folder = arguments.first().map(PathBuf::from);
    let chosen = |layout: &&Layout| {
        arguments.len() < 2 || arguments[1..].iter().any(|name| name == layout.name)
    };
    let mut judge = Judge::default();
    let layouts = LAYOUTS.iter().filter(chosen);
    let rows: Vec<Row> =
        layouts.flat_map(|layout| Row::of_layout(layout, folder.as_ref(), &mut judge)).collect();
    for what in &TABLES {
        let mut printed = false;
        for Row { name, textures } in &rows {
            let [_, Some(exact), ..] = textures else { continue };
            if inside(&exact.spec).is_some() != what.dielectric {
                continue;
            }
            let mut cell = |texture: &Option<Texture>| judge.of(texture.as_ref()?, what);
            let cells = textures.each_ref().map(&mut cell);
            if cells[1].is_none() {
                continue;
            }
            if !printed {
                println!("\n{}:\n", what.title);
                let sources = ["shipped", "exact values", "fitted values", "our coordinates"];
                print_head(&[&["layout", "texels"], &sources[..]].concat());
                printed = true;
            }
            let size: Vec<String> = exact.size().iter().map(usize::to_string).collect();
            let cells = cells.map(|cell| cell.unwrap_or_else(|| "–".into()));
            println!("| {name} | {} | {} |", size.join(" × "), cells.join(" | "));
        }
    }
    Ok(())
}
