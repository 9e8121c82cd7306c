//! Errors of the albedos of GGX that engines read from their tables.
//!
//! `cargo run --release -p microfacet-study -- engines shipped` prints the tables in
//! `docs/engines.md`, where `shipped` is a folder with files of engines, as that page names them;
//! without it, shipped files are not measured. Each cell is the largest error and the root mean
//! square, as the engine reads its table: over √σ = 1/400 … 1 and 500 cosines from 1e-3 to 1; the
//! largest error also over 120 cosines up to 0.1, even in their logarithms. Relative errors are
//! divided by the exact value.

pub mod shipped;

use std::collections::HashMap;
use std::path::PathBuf;

use microfacet_baker::progress::Stage;
use microfacet_export::texture::engine::{LAYOUTS, Layout};
use microfacet_export::texture::{
    Channels, Checks, Deviation, Known, Place, Shapes, Texture, TextureSpec, known,
};
use microfacet_sampler::Masking;

use crate::{Outcome, print_head};

/// Numbers of evenly spaced cosines, and of those that are dense at the horizon.
const EVEN: usize = 500;
const LOW: usize = 120;
const HORIZON: f64 = 1e-3;
/// Least cosine of the comparisons without grazing views.
const ABOVE: f64 = 0.02;

fn places() -> Vec<Place> {
    let share = |i: usize, of: usize| i as f64 / (of - 1) as f64;
    let even = (0..EVEN).map(|i| HORIZON + (1.0 - HORIZON) * share(i, EVEN));
    let low = (0..LOW).map(|i| HORIZON * 100_f64.powf(share(i, LOW)));
    let cosines: Vec<f64> = even.chain(low).collect();
    let rough = (1..=400).map(|k| (f64::from(k) / 400.0).powi(2));
    let of = |sigma| {
        let place = move |&cos: &f64| Place { gamma: 2.0, sigma, eta: None, cos: Some(cos) };
        cosines.iter().map(place).collect::<Vec<_>>()
    };
    rough.flat_map(of).collect()
}

struct What {
    title: &'static str,
    quantity: &'static str,
    relative: bool,
    least_cos: f64,
    least_sigma: f64,
}

impl What {
    fn counts(&self, place: &Place) -> bool {
        place.cos.is_some_and(|cos| cos >= self.least_cos) && place.sigma >= self.least_sigma
    }
}

const ERRORS: What =
    What { title: "E", quantity: "e", relative: false, least_cos: HORIZON, least_sigma: 0.0 };
const TABLES: [What; 5] = [
    ERRORS,
    What { title: "E, cos θ ≥ 0.02", least_cos: ABOVE, ..ERRORS },
    What { title: "bias", quantity: "bias", ..ERRORS },
    What { title: "E, cos θ ≥ 0.02, relative", relative: true, least_cos: ABOVE, ..ERRORS },
    What {
        title: "E, cos θ ≥ 0.02, α = 1, relative",
        relative: true,
        least_cos: ABOVE,
        least_sigma: 1.0,
        ..ERRORS
    },
];

/// What textures are compared with: exact values by the form of masking, and our own textures.
struct Judge {
    all: HashMap<&'static str, Vec<Known>>,
    ours: HashMap<(Vec<usize>, &'static str), Texture>,
}

impl Judge {
    fn new() -> Self {
        let known = |masking: Masking| {
            let known = known(&places(), masking, &Stage::unwatched()).expect("in the domain");
            (masking.name(), known)
        };
        Self { all: Masking::ALL.map(known).into(), ours: HashMap::new() }
    }

    /// Largest error and root mean square.
    fn of(&self, texture: &Texture, what: &What) -> String {
        let all = &self.all[texture.spec.masking.name()];
        let found = |known: &[Known]| {
            let found = Checks::at(&texture.spec, known).of(texture, |place| what.counts(place));
            let of = |found: &Deviation| found.quantity == what.quantity;
            let found = found.into_iter().find(of).expect("a quantity");
            if what.relative { found.relative } else { [found.largest, found.rms] }
        };
        let even: Vec<Known> =
            all.chunks(EVEN + LOW).flat_map(|row| row[..EVEN].to_vec()).collect();
        format!("{:.1e} / {:.1e}", found(all)[0], found(&even)[1])
    }

    /// Our own texture of the same size, fitted.
    fn ours(&mut self, layout: &Layout, channels: Channels) -> Texture {
        let masking = layout.specs(2.0, layout.size, false)[0].masking;
        let key = (layout.size.to_vec(), masking.name());
        let make = || {
            let [spec, _] = TextureSpec::of_shapes(
                "lut",
                Shapes::One(2.0),
                1.0,
                &layout.size,
                masking,
                channels,
            );
            spec.make(&Stage::unwatched()).expect("in the domain")
        };
        self.ours.entry(key).or_insert_with(make).clone()
    }
}

/// The texture of a layout as its engine reads it from the file that is written.
fn written(layout: &Layout, fitted: bool) -> Texture {
    let make = |spec: &TextureSpec| spec.make(&Stage::unwatched()).expect("in the domain");
    let textures: Vec<Texture> = layout.specs(2.0, layout.size, fitted).iter().map(make).collect();
    let files = layout.files(&textures).expect("a file");
    shipped::decode(layout, &files[0].contents)
}

/// Runs the study that the module describes.
pub fn run(arguments: &[String]) -> Outcome {
    let folder = arguments.first().map(PathBuf::from);
    let mut judge = Judge::new();
    let tables = LAYOUTS.each_ref().map(|layout| {
        let found = folder.as_ref().zip(shipped::file_of(layout)).and_then(|(folder, name)| {
            let bytes = std::fs::read(folder.join(name)).ok()?;
            Some(shipped::decode(layout, &bytes))
        });
        let [exact, fitted] = [false, true].map(|fitted| written(layout, fitted));
        (layout, [found, Some(exact), Some(fitted), Some(judge.ours(layout, Channels::ScaleBias))])
    });
    for what in &TABLES {
        println!("\n{}:\n", what.title);
        let sources = ["shipped", "exact values", "fitted values", "our coordinates"];
        print_head(&[&["layout", "texels"], &sources[..]].concat());
        for (layout, textures) in &tables {
            let has = |texture: &Texture| {
                let spec = &texture.spec;
                what.quantity == "e" || spec.channels.iter().any(|channel| channel.name() == "bias")
            };
            if what.quantity == "bias" && !textures[1].as_ref().is_some_and(has) {
                continue;
            }
            let [rows, columns] = layout.size;
            let cell = |texture: &Option<Texture>| {
                let cell = texture.as_ref().map(|texture| judge.of(texture, what));
                cell.unwrap_or_else(|| "–".into())
            };
            let cells: Vec<String> = textures.iter().map(cell).collect();
            println!("| {} | {rows} × {columns} | {} |", layout.name, cells.join(" | "));
        }
    }
    Ok(())
}
