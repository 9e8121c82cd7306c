//! How good the planner's seconds and bytes are: bakes materials of all kinds on one thread, and
//! prints what each takes beside its estimate.
//!
//! ```sh
//! cargo run --profile dist -p microfacet-study -- planner_seconds
//! cargo run --profile dist -p microfacet-study -- planner_seconds 20
//! ```
//!
//! The argument is the number of random materials of each kind, by default 2; corners come on top.
//! Ratios are those of what was measured to the estimate. Seconds are those of the processor where
//! the system counts them for a thread (Linux), so that other programs matter little.

use std::error::Error;
use std::time::Instant;

use microfacet_baker::bake::albedo::{AlbedoLobe, AlbedoSpec};
use microfacet_baker::plan::{AlbedoWish, Options, Plan, albedo_cost, set_cost};
use microfacet_baker::scene::Scene;
use microfacet_baker::table_set::{Target, bake};
use microfacet_baker::table_spec::Quality;
use microfacet_sampler::Masking;
use microfacet_tables::{Precision, Reflectance, encode};

const KINDS: [&str; 8] = [
    "normals",
    "distribution",
    "round",
    "range",
    "dielectric",
    "conductor",
    "anisotropic",
    "tilted",
];

struct Case {
    kind: &'static str,
    quality: Quality,
    /// The material in a recipe, without its name.
    material: String,
}

/// Prints what the module's page says.
pub fn run(arguments: &[String]) -> Result<(), Box<dyn Error>> {
    let count = match arguments.first() {
        Some(text) => text.parse()?,
        None => 2,
    };
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build()?;
    println!(
        "{:<12} {:<8} {:>9} {:>9} {:>6} {:>6}  material",
        "kind", "quality", "seconds", "estimate", "ratio", "bytes"
    );
    let mut ratios: Vec<(&str, [f64; 2])> = Vec::new();
    for case in corners().into_iter().chain(random(count)) {
        let ([seconds, estimate], bytes) =
            pool.install(|| measured(&case)).map_err(|why| why.to_string())?;
        let Case { kind, quality, material } = case;
        println!(
            "{kind:<12} {:<8} {seconds:9.3} {estimate:9.3} {:6.2} {bytes:6.2}  {}",
            format!("{quality:?}").to_lowercase(),
            seconds / estimate,
            material.trim().replace('\n', ", ")
        );
        ratios.push((kind, [seconds / estimate, bytes]));
    }
    println!(
        "\n{:<12} {:>5} {:>7} {:>7} {:>7} {:>12}",
        "", "cases", "median", "least", "most", "bytes"
    );
    for kind in KINDS.into_iter().chain(["all"]) {
        let of: Vec<[f64; 2]> = ratios
            .iter()
            .filter(|(other, _)| kind == "all" || *other == kind)
            .map(|(_, ratios)| *ratios)
            .collect();
        summary(kind, &of);
    }
    println!("\nan estimate of the slowest kind takes {:.0} microseconds", estimating()?);
    Ok(())
}

/// Microseconds to estimate the albedo of a lobe that is doubled along both axes.
fn estimating() -> Result<f64, Box<dyn Error>> {
    const TIMES: usize = 1000;
    let lobe =
        AlbedoLobe { theta: Some([0.3, 0.0, 0.0]), ..AlbedoLobe::student_t([0.1, 0.3], 3.0) };
    let maskings = vec![Masking::HeightCorrelated];
    let (quality, precision) = (Quality::Default, Precision::F32);
    let spec = AlbedoSpec::new(lobe, Reflectance::Mirror, maskings, quality, precision)?;
    let clock = Clock::start();
    let all: f64 = (0..TIMES).map(|_| albedo_cost(&spec).seconds).sum();
    assert!(all > 0.0);
    Ok(1e6 * clock.seconds() / TIMES as f64)
}

/// Prints the median factor by which estimates are off, either way, the extreme ratios of seconds
/// and those of bytes.
fn summary(kind: &str, ratios: &[[f64; 2]]) {
    let ends = |i: usize| {
        let each = || ratios.iter().map(|ratios| ratios[i]);
        [each().fold(f64::INFINITY, f64::min), each().fold(0.0, f64::max)]
    };
    let mut off: Vec<f64> = ratios.iter().map(|&[ratio, _]| ratio.max(1.0 / ratio)).collect();
    off.sort_by(f64::total_cmp);
    let median = off.get(off.len() / 2).copied().unwrap_or(f64::NAN);
    let [[least, most], [fewest, largest]] = [ends(0), ends(1)];
    println!(
        "{kind:<12} {:5} {median:7.2} {least:7.2} {most:7.2}  {fewest:5.2}-{largest:.2}",
        ratios.len()
    );
}

/// Measured seconds and those estimated, and the ratio of the bytes.
fn measured(case: &Case) -> Result<([f64; 2], f64), String> {
    let say = |why: &dyn std::fmt::Display| format!("{}: {why}", case.material);
    let text = format!("[[material]]\nname = \"m\"\n{}\n", case.material);
    let scene = Scene::from_recipe_str(&text).map_err(|why| say(&why))?;
    let whole = |albedo| Plan::new(&scene, Options { albedo, ..Options::default() });
    // One kind of table at a time.
    let plan = match case.kind {
        "normals" | "distribution" => whole(AlbedoWish::None).map_err(|why| say(&why))?,
        _ => {
            let plan = whole(AlbedoWish::All).map_err(|why| say(&why))?;
            Plan { shapes: Vec::new(), distributions: Vec::new(), ..plan }
        }
    };
    let (quality, precision) = (case.quality, Precision::F32);
    let estimate = set_cost(&plan, quality, precision).map_err(|why| say(&why))?;
    let clock = Clock::start();
    let baked = bake(&plan, Target::Quality(quality, precision)).map_err(|why| say(&why))?;
    let seconds = clock.seconds();
    let bytes = encode(baked.set.provenance(), baked.set.tables()).map_err(|why| say(&why))?.len();
    Ok(([seconds, estimate.seconds], bytes as f64 / estimate.bytes as f64))
}

/// Processor time of this thread; where the system does not tell, time that passed.
struct Clock {
    busy: Option<f64>,
    start: Instant,
}

impl Clock {
    fn start() -> Self {
        Self { busy: busy(), start: Instant::now() }
    }

    fn seconds(&self) -> f64 {
        let passed = self.start.elapsed().as_secs_f64();
        busy().zip(self.busy).map_or(passed, |(now, then)| now - then)
    }
}

fn busy() -> Option<f64> {
    let text = std::fs::read_to_string("/proc/thread-self/schedstat").ok()?;
    Some(1e-9 * text.split_whitespace().next()?.parse::<f64>().ok()?)
}

const GAMMAS: [&str; 8] = ["1.52", "1.6", "1.75", "2", "2.5", "4", "10", "inf"];
const GOLD: &str = "fresnel = { conductor = { eta = [0.2, 0.4, 1.3], k = [3.9, 2.4, 2.2] } }";

/// Materials at the ends of the domain.
fn corners() -> Vec<Case> {
    use Quality::{Default, Draft, High};
    let case = |kind, quality, material: &str| Case { kind, quality, material: material.into() };
    vec![
        case("normals", Default, "sigma = 0.3\ngamma = 1.501"),
        case("normals", High, "sigma = 0.3\ngamma = inf"),
        case("normals", Default, "sigma = 0.3\ngamma = { min = 1.501, max = inf }"),
        case("distribution", Default, "distribution = \"gtr\"\nc = 0.3\ngamma = 4"),
        case("distribution", High, "distribution = \"gauss\"\nm = 0.01"),
        case("round", Default, "sigma = 1e-4\ngamma = 1.501"),
        case("round", High, "sigma = 3\ngamma = inf"),
        case("round", Draft, "distribution = \"gtr\"\nc = 0.9\ngamma = 1.1"),
        case("range", Default, "sigma = { min = 0, max = 3 }\ngamma = 1.501"),
        case("range", Draft, "sigma = { min = 0, max = 3 }\ngamma = { min = 1.501, max = inf }"),
        case("dielectric", Default, "sigma = 3\ngamma = 1.501\nfresnel = { dielectric = 1.5 }"),
        case("dielectric", Default, "sigma = 1e-4\ngamma = inf\nfresnel = { dielectric = 1.1 }"),
        case(
            "dielectric",
            Draft,
            "sigma = 0.2\ngamma = 3\nfresnel = { dielectric = { min = 1.3, max = 1.8 } }",
        ),
        case("conductor", Draft, &format!("sigma = [0.3, 0.1]\ngamma = 1.501\n{GOLD}")),
        case("conductor", Default, &format!("sigma = 1e-4\ngamma = 3\n{GOLD}")),
        case("anisotropic", Draft, "sigma = [1e-4, 3e-4]\ngamma = 1.501"),
        case("anisotropic", Default, "sigma = [0.01, 1]\ngamma = inf"),
        case("anisotropic", Draft, "sigma = [0.5, 0.005]\ngamma = 1.7"),
        case("anisotropic", Draft, "sigma = [3, 0.03]\ngamma = 3"),
        case("anisotropic", Default, "sigma = [3, 1]\ngamma = 1.501"),
        case("anisotropic", High, "sigma = [0.2, 0.4]\ngamma = 3"),
        case("tilted", Draft, "sigma = [0.2, 0.2]\ngamma = 1.501\ntheta = [0.3, 0, 0]"),
        case("tilted", Draft, "sigma = [1.0, 0.1]\ngamma = inf\ntheta = [0.3, 0.2, 0]"),
    ]
}

/// Random materials, the same in every run.
fn random(count: usize) -> Vec<Case> {
    let mut state = 1;
    let mut each = Vec::new();
    for i in 0..count {
        for kind in KINDS {
            // Tables of tilted lobes take minutes in default quality.
            let quality = match (kind, i % 3) {
                ("tilted", _) | (_, 1) => Quality::Draft,
                _ => Quality::Default,
            };
            each.push(Case { kind, quality, material: material(kind, &mut state) });
        }
    }
    each
}

fn material(kind: &str, state: &mut u64) -> String {
    let mut uniform = || number(state);
    let mut between = |low: f64, high: f64| low * libm::pow(high / low, uniform());
    let sigma = between(0.01, 1.0);
    let aspect = between(1.2, 12.0);
    let eta = between(1.1, 2.4);
    let share = between(1.0, 8.0) - 1.0;
    let theta = [0.5, 0.5, 3.0].map(|most| most * (between(1.0, 3.0) - 1.5));
    let gamma = GAMMAS[((share / 7.0) * GAMMAS.len() as f64) as usize];
    let isotropic = format!("sigma = {sigma:.4}\ngamma = {gamma}");
    let sides = format!("sigma = [{sigma:.4}, {:.4}]\ngamma = {gamma}", (sigma * aspect).min(3.0));
    match kind {
        "normals" => isotropic,
        "distribution" => match theta[0] > 0.0 {
            true => format!("distribution = \"gauss\"\nm = {sigma:.3}"),
            false => format!("distribution = \"gtr\"\nc = {sigma:.3}\ngamma = {eta:.2}"),
        },
        "round" => format!("{isotropic}\nfresnel = \"mirror\""),
        "range" => format!(
            "sigma = {{ min = {sigma:.4}, max = {:.4} }}\ngamma = {gamma}",
            (sigma * aspect).min(3.0)
        ),
        "dielectric" => format!("{isotropic}\nfresnel = {{ dielectric = {eta:.3} }}"),
        "conductor" if share > 3.0 => format!("{sides}\n{GOLD}"),
        "conductor" => format!("{isotropic}\n{GOLD}"),
        "anisotropic" => sides,
        _ => {
            let [x, y, z] = theta;
            format!("{sides}\ntheta = [{x:.3}, {y:.3}, {z:.3}]")
        }
    }
}

/// A random number in [0, 1), by SplitMix64.
fn number(state: &mut u64) -> f64 {
    *state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
    let mut z = *state;
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
}
