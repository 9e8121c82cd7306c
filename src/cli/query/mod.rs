//! `query`: table and exact values at points, which options name or a CSV file holds.

mod columns;
mod file;
mod output;
mod point;
mod quantities;

use std::path::PathBuf;

use clap::{Subcommand, ValueEnum};

use super::values::Unit;
use super::{Result, tables};
use point::{Average, Directed, Directional, Points, VisibleNormal};
use quantities::{Known, Quantity};

/// Print table and exact values at points, given by options or by the rows of a CSV file.
#[derive(clap::Args)]
#[command(after_help = "Examples:
  microfacet-bake query albedo --sigma 0.5 --gamma 2
  microfacet-bake query normal --sigma 0.3,0.1 --gamma 3 --theta 60 --degrees --u 0.2,0.7
  printf 'sigma_x,sigma_y,gamma,theta,phi\\n0.3,0.3,3,1.2,0\\n' | microfacet-bake query g1 --input -")]
pub(super) struct Args {
    #[command(subcommand)]
    what: What,
}

#[derive(Subcommand)]
enum What {
    /// The normal distribution function D of a microfacet normal. Columns: sigma_x, sigma_y, gamma,
    /// theta, phi.
    #[command(after_help = "Example:
  microfacet-bake query d --sigma 0.1 --gamma 1.6 --theta 0 --theta 0.3")]
    D(Directed),
    /// Smith's lambda and G1 of a view. Columns: sigma_x, sigma_y, gamma, theta, phi.
    #[command(after_help = "Example:
  microfacet-bake query g1 --sigma 0.5 --gamma 3 --theta 80 --degrees")]
    G1(Directed),
    /// The visible normal at random numbers u1, u2, and its density. Columns: those of g1, and u1,
    /// u2. Below gamma = 1.8 table and exact normals of the same u1 differ.
    #[command(after_help = "Example:
  microfacet-bake query normal --sigma 0.3,0.1 --gamma 3 --theta 1.2 --u 0.2,0.7")]
    Normal(VisibleNormal),
    /// Directional albedo with F = 1 and its Schlick parts. Columns: sigma, gamma, cos_theta,
    /// masking.
    #[command(after_help = "Examples:
  microfacet-bake query albedo --sigma 0.5 --gamma 2
  microfacet-bake query albedo --sigma 0.7 --perceptual --gamma 2 --cos-theta 0.1 --json")]
    Albedo(Directional),
    /// Cosine-weighted average of the albedo. Columns: sigma, gamma, masking.
    #[command(after_help = "Example:
  microfacet-bake query albedo-average --sigma 0.5 --gamma 2,inf")]
    AlbedoAverage(Average),
}

/// Where points come from, and where values go.
#[derive(clap::Args)]
struct Io {
    /// CSV file with named columns, `-` for standard input; other columns are passed through.
    #[arg(long, value_name = "CSV")]
    input: Option<PathBuf>,
    /// A table file, or a folder with one; the embedded default if absent.
    #[arg(long)]
    tables: Option<PathBuf>,
    /// Source of the values.
    #[arg(long, value_enum, value_delimiter = ',', default_value = "table,exact")]
    method: Vec<Method>,
    /// Print JSON: an array of an object for each point, with the names of the columns; infinity
    /// is the text "inf".
    #[arg(long)]
    json: bool,
}

#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Method {
    /// The sampler's, in single precision.
    Table,
    /// The model's, in double precision.
    Exact,
}

impl Method {
    /// Its name, and the end of its columns.
    const fn name(self) -> &'static str {
        match self {
            Self::Table => "table",
            Self::Exact => "exact",
        }
    }
}

pub(super) fn run(args: &Args) -> Result<()> {
    let (quantity, points): (_, &dyn Points) = match &args.what {
        What::D(at) => (Quantity::D, at),
        What::G1(at) => (Quantity::G1, at),
        What::Normal(at) => (Quantity::Normal, at),
        What::Albedo(at) => (Quantity::Albedo, at),
        What::AlbedoAverage(at) => (Quantity::AlbedoAverage, at),
    };
    let io = points.io();
    let known = Known::new(quantity, points.unit(), tables(io.tables.as_deref())?);
    match &io.input {
        Some(input) => file::answer(input, io, quantity, &known),
        None => point::answer(&points.rows()?, io, quantity, &known),
    }
}

/// The columns that a quantity appends, by each method.
fn appended(quantity: Quantity, methods: &[Method]) -> Vec<String> {
    let [_, outputs] = quantity.columns();
    let named = |method: &Method| {
        let end = method.name();
        outputs.iter().map(move |stem| format!("{stem}_{end}"))
    };
    methods.iter().flat_map(named).collect()
}
