//! Compares exported shapes, compiled as C and as C++, with the Rust crate: at random points, at
//! corners, and with the rows of `docs/reference.csv`; then times both in turns.
//!
//! `clients/c/run` exports the shapes and starts this program with the number of random points and
//! the paths of the rows, of a family's file, and of the set whose dielectrics were exported as
//! arguments. Exit status 1 if something differs by more than is allowed.

mod conductors;
mod families;
mod foreign;
mod interfaces;
mod picture;
mod prefilter;
mod timing;

use std::process::ExitCode;

use microfacet_sampler::Tables;
use student_t_agreement::{Limits, Rough, agree};

/// The limits that the documentation of exports states.
const LIMITS: Limits = Limits {
    share: 2e-6,
    normal: 1e-5,
    rough: Rough::Coordinates(1e-3),
    heavy: 1e-5,
    average: 3e-5,
    density: [1e-5, 2e-6],
    extrapolated: [2e-5, 2e-4],
    of_nan: true,
    lambda: f32::INFINITY,
};

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [count, reference, family, glass] = &arguments[..] else {
        eprintln!("usage: student-t-in-c POINTS REFERENCE.csv FAMILY.bin GLASS.safetensors");
        return ExitCode::from(2);
    };
    let count: usize = count.parse().expect("a number of points");
    let (tables, gammas) = (Tables::embedded(), foreign::gammas());
    let good = agree(&mut foreign::Compiled, &LIMITS, &gammas, count, reference);
    let good = families::agree(count, family) & good;
    let good = interfaces::agree(&gammas, count, Some(glass)) & good;
    let good = conductors::agree(&gammas, count.div_ceil(4)) & good;
    let good = prefilter::agree(count) & good;
    let good = picture::agree() & good;
    println!("times in relation to the crate's, sigma 0.5");
    for gamma in [3.0, 1.65, 2.0] {
        if let Some(shape) = gammas.iter().position(|&g| g == gamma) {
            timing::print(&tables, shape, gamma);
        }
    }
    println!("{}", if good { "C and C++ agree with the crate." } else { "They differ." });
    ExitCode::from(u8::from(!good))
}
