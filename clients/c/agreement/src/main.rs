//! Compares exported shapes, compiled as C and as C++, with the Rust crate: at random points, at
//! corners, and with the rows of `docs/reference.csv`; then times both in turns.
//!
//! `clients/c/run` exports the shapes and starts it: with the number of random points and the path
//! of the rows as arguments. Exit status 1 if something differs by more than is allowed.

mod compare;
mod foreign;
mod points;
mod reference;
mod timing;

use std::process::ExitCode;

use compare::Worst;
use microfacet_sampler::Tables;

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [count, reference] = &arguments[..] else {
        eprintln!("usage: student-t-agreement POINTS REFERENCE.csv");
        return ExitCode::from(2);
    };
    let count: usize = count.parse().expect("a number of points");
    let (tables, gammas) = (Tables::embedded(), foreign::gammas());
    let each = count.div_ceil(gammas.len());
    let mut good = true;
    for (title, corners) in [("random points", false), ("corners", true)] {
        let mut worst = Worst::default();
        let mut all = 0;
        for (shape, &gamma) in gammas.iter().enumerate() {
            let groups =
                if corners { points::corners() } else { points::random(each, shape as u64) };
            for group in groups {
                all += group.points.len();
                compare::group(&mut worst, &tables, shape, gamma, &group);
            }
        }
        println!("largest differences at {all} {title} of gamma {gammas:?}");
        good &= worst.print();
    }
    good &= reference::compare(reference, &gammas);
    println!("times in relation to the crate's, sigma 0.5");
    for gamma in [3.0, 1.65, 2.0] {
        if let Some(shape) = gammas.iter().position(|&g| g == gamma) {
            timing::print(&tables, shape, gamma);
        }
    }
    println!("{}", if good { "C and C++ agree with the crate." } else { "They differ." });
    ExitCode::from(u8::from(!good))
}
