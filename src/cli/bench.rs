//! `bench`: run time against error, on the terminal and as files.

use std::path::{Path, PathBuf};

use serde_json::{Value, json};

use microfacet_bake::bench::{self, Approximation, Figure, Quantity, Row, Settings, Slices, Timing};
use microfacet_bake::store::replace;

use super::{Done, Failure, Outcome, print, print_json};

/// Time the samplers and the forms of G1 there are, and say how wrong each is.
///
/// One thread; views evenly over the hemisphere and uniform random numbers, drawn beforehand; times are medians over batches of rivals that
/// take turns. Close other programs: ratios are steadier than times, but not immune.
#[derive(clap::Args)]
#[command(after_help = "Example:\n  microfacet-bake bench --quick --out bench")]
pub(super) struct Args {
    /// Fewer batches: some seconds instead of a minute.
    #[arg(long)]
    quick: bool,
    /// Different inputs to call with.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(16..=bench::COUNT as i64))]
    calls: Option<u32>,
    /// Seed of views and random numbers.
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Folder for bench.csv, bench.json, bench.svg and, after Ribardière et al. 2017, the times by gamma and sigma (figure-4.csv, .svg) and the error of the
    /// rational approximation (figure-5.csv, .svg).
    #[arg(long, value_name = "FOLDER")]
    out: Option<PathBuf>,
    /// Print JSON instead of tables.
    #[arg(long)]
    json: bool,
}

pub(super) fn run(args: Args) -> Outcome {
    let settings = if args.quick { Settings::QUICK } else { Settings::FULL };
    let settings = Settings { seed: args.seed, ..settings };
    let settings = args.calls.map_or(settings, |calls| settings.with_calls(calls as usize));
    if let Some(folder) = &args.out {
        // Before the work, not after it.
        std::fs::create_dir_all(folder)
            .map_err(|why| Failure(format!("making the folder {}: {why}", folder.display())))?;
    }
    let slices = Slices::bake();
    let rows = bench::rows(&slices, &settings);
    let approximation = bench::approximation(slices.whole());
    let figures = bench::figures(&rows, &approximation, &slices, &settings);
    let document = document(&settings, &rows, &figures);
    if let Some(folder) = &args.out {
        let times = bench::times(slices.whole(), &settings);
        write(folder, "bench.csv", csv(&ROW, rows.iter().map(row_fields))?)?;
        write(folder, "bench.json", format!("{document:#}\n").into_bytes())?;
        write(folder, "bench.svg", bench::svg(&rows)?.into_bytes())?;
        write(folder, "figure-4.csv", csv(&TIMING, times.iter().map(timing_fields))?)?;
        write(folder, "figure-4.svg", bench::times_svg(&times)?.into_bytes())?;
        write(folder, "figure-5.csv", csv(&APPROXIMATION, approximation.iter().map(approximation_fields))?)?;
        write(folder, "figure-5.svg", bench::approximation_svg(&approximation)?.into_bytes())?;
    }
    if args.json {
        print_json(&document)?;
    } else {
        print(&(table(&rows) + "\n" + &block(&figures)))?;
    }
    Ok(Done::Ok)
}

fn write(folder: &Path, name: &str, bytes: Vec<u8>) -> Result<(), Failure> {
    let path = folder.join(name);
    replace(&path, &bytes).map_err(|why| Failure(format!("writing {}: {why}", path.display())))
}

const ROW: [&str; 10] = [
    "quantity",
    "name",
    "gamma",
    "ns",
    "bytes",
    "stored_bytes",
    "error_max",
    "error_rms",
    "furnace_variance",
    "variance_ns",
];
const TIMING: [&str; 6] = ["quantity", "by", "method", "gamma", "sigma", "ns"];
const APPROXIMATION: [&str; 5] = ["gamma", "theta_degrees", "g1", "rational_error", "table_error"];

fn csv<const N: usize>(
    header: &[&str; N],
    records: impl Iterator<Item = [String; N]>,
) -> Result<Vec<u8>, Failure> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    writer.write_record(header)?;
    for record in records {
        writer.write_record(&record)?;
    }
    Ok(writer.into_inner()?)
}

fn optional(x: Option<f64>) -> String {
    x.map_or(String::new(), |x| format!("{x:e}"))
}

fn row_fields(row: &Row) -> [String; 10] {
    [
        row.quantity.name().into(),
        row.name.clone(),
        row.gamma.to_string(),
        format!("{:.3}", row.ns),
        row.bytes.to_string(),
        row.stored.to_string(),
        optional(row.error.map(|error| error.max)),
        optional(row.error.map(|error| error.rms)),
        optional(row.variance),
        optional(row.cost()),
    ]
}

fn timing_fields(at: &Timing) -> [String; 6] {
    let by = if at.by_gamma { "gamma" } else { "sigma" };
    [
        at.quantity.name().into(),
        by.into(),
        at.method.into(),
        at.gamma.to_string(),
        at.sigma.to_string(),
        format!("{:.3}", at.ns),
    ]
}

fn approximation_fields(at: &Approximation) -> [String; 5] {
    [
        at.gamma.to_string(),
        at.degrees.to_string(),
        at.g1.to_string(),
        format!("{:e}", at.rational_error),
        format!("{:e}", at.table_error),
    ]
}

fn document(settings: &Settings, rows: &[Row], figures: &[Figure]) -> Value {
    let row = |row: &Row| {
        json!({
            "quantity": row.quantity.name(), "name": row.name,
            // Infinity is no JSON number.
            "gamma": if row.gamma.is_finite() { json!(row.gamma) } else { json!("inf") },
            "ns": row.ns, "bytes": row.bytes, "stored_bytes": row.stored,
            "error_max": row.error.map(|error| error.max), "error_rms": row.error.map(|error| error.rms),
            "furnace_variance": row.variance, "variance_ns": row.cost(),
        })
    };
    let figure = |figure: &Figure| {
        json!({
            "name": figure.name, "unit": figure.unit,
            "must": figure.must, "aim": figure.aim, "reached": figure.reached,
        })
    };
    json!({
        "sigma": bench::SIGMA, "gamma": bench::GAMMA,
        "inputs": "views evenly over the hemisphere, random numbers uniform in [0, 1)",
        "calls": settings.calls, "rounds": settings.rounds, "seed": settings.seed,
        "rows": rows.iter().map(row).collect::<Vec<_>>(),
        "figures": figures.iter().map(figure).collect::<Vec<_>>(),
    })
}

fn table(rows: &[Row]) -> String {
    let mut text = format!("sigma {}; errors are of the CDFs, or of G1, absolute\n", bench::SIGMA);
    for quantity in [Quantity::Normal, Quantity::G1] {
        let title = if quantity == Quantity::Normal { "visible normals" } else { "G1" };
        text += &format!(
            "\n{title:42} {:>5} {:>9} {:>8} {:>8} {:>9} {:>9}",
            "gamma", "ns", "bytes", "stored", "max", "rms"
        );
        text += if quantity == Quantity::Normal { "  variance  var x ns\n" } else { "\n" };
        for row in rows.iter().filter(|row| row.quantity == quantity) {
            let error = |x: Option<f64>| x.map_or("-".into(), |x| format!("{x:.1e}"));
            text += &format!(
                "{:42} {:>5} {:>9.2} {:>8} {:>8} {:>9} {:>9}",
                row.name,
                row.gamma,
                row.ns,
                row.bytes,
                row.stored,
                error(row.error.map(|error| error.max)),
                error(row.error.map(|error| error.rms)),
            );
            if let (Some(variance), Some(cost)) = (row.variance, row.cost()) {
                text += &format!(" {variance:>9.5} {cost:>9.3}");
            }
            text.push('\n');
        }
    }
    text
}

fn block(figures: &[Figure]) -> String {
    let mut text =
        format!("{:48} {:>9} {:>9} {:>9}\n", "figures (smaller is better)", "must", "aim", "reached");
    for figure in figures {
        let number = |x: f64| if x < 0.01 { format!("{x:.1e}") } else { format!("{x:.3}") };
        let name = match figure.unit {
            "" => figure.name.into(),
            unit => format!("{}, {unit}", figure.name),
        };
        let reached = figure.reached.map_or("-".into(), number);
        let verdict = match figure.reached {
            Some(x) if x <= figure.aim => "aim",
            Some(x) if x <= figure.must => "must",
            Some(_) => "MISSED",
            None => "",
        };
        text += &format!(
            "{name:48} {:>9} {:>9} {reached:>9}  {verdict}\n",
            number(figure.must),
            number(figure.aim)
        );
    }
    text
}
