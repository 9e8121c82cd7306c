//! `sample`: draws normals of one material and view into a safetensors file.

use std::io::{self, BufWriter, IsTerminal, Write};
use std::path::PathBuf;

use clap::{ArgGroup, ValueEnum};
use glam::Vec3;
use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};
use safetensors::Dtype;
use safetensors::tensor::{Metadata, TensorInfo};

use microfacet_baker::progress::Stage;
use microfacet_baker::store::replace_with;
use microfacet_model as model;
use microfacet_model::MicrofacetDistribution as _;
use microfacet_sampler::lobe::Tabulated as _;
use microfacet_validate::configuration::Configuration;

use super::view::View;
use super::{
    Context, Result, ensure, interrupt, is_stream, note, summarize, tables, unwritable, values,
    watched,
};

/// Draw normals for one material and view into a safetensors file: `normals` [N,3], `pdf` [N], f32.
#[derive(clap::Args)]
#[command(after_help = "Examples:
  microfacet-bake sample --sigma 0.454 --gamma 3 --theta 1 --count 1e5 --out normals.safetensors
  microfacet-bake sample --sigma 0.454 --gamma 3 --ndf --count 1e5 --out normals.safetensors")]
#[command(group(ArgGroup::new("of").args(["theta", "ndf"]).required(true)))]
pub(super) struct Args {
    /// Roughness, `X` or `X,Y`.
    #[arg(long, value_name = "X[,Y]", value_parser = values::sigma)]
    sigma: [f64; 2],
    /// Shape.
    #[arg(long, value_name = "G", value_parser = values::gamma)]
    gamma: f64,
    #[command(flatten)]
    view: View,
    /// Number of normals.
    #[arg(long, value_name = "N", value_parser = values::count::<usize>(1..=1_000_000_000))]
    count: usize,
    /// Seed of everything random.
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = values::seed)]
    seed: u64,
    /// Which normals of the view are drawn, and how; also decides the density that is written.
    #[arg(long, value_enum, default_value = "table")]
    method: Method,
    /// Draw normals of D, eq. 16-17 and 19-20, with density D(m) (m.n), for which no view is
    /// needed.
    #[arg(long, conflicts_with_all = ["theta", "phi", "degrees", "method", "tables"])]
    ndf: bool,
    /// A table file, or a folder with one; the embedded default if absent.
    #[arg(long)]
    tables: Option<PathBuf>,
    /// File to write, `-` for standard output.
    #[arg(long, short, value_name = "FILE")]
    out: PathBuf,
}

#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Method {
    /// From tables, with the density that the table samples.
    Table,
    /// By the model's sampler, with the analytic density.
    Exact,
    /// Normals of D brought to the viewer's side, pseudo-visible, with their density.
    Pseudo,
}

/// Draws a normal, with its density.
type Draw = Box<dyn Fn(&mut StdRng) -> (Vec3, f32)>;

fn source(args: &Args) -> Result<Draw> {
    let [sigma_x, sigma_y] = args.sigma;
    let truth = model::StudentT::new([sigma_x, sigma_y], args.gamma)?;
    let Some([theta, phi]) = args.view.angles()? else {
        return Ok(Box::new(move |random| {
            let m = truth.sample_ndf([random.random(), random.random()]);
            (m.as_vec3(), (truth.d(m) * m.z) as f32)
        }));
    };
    let (gamma, seed) = (args.gamma, args.seed);
    let v = Configuration { sigma_x, sigma_y, gamma, theta, phi, seed }.view();
    match args.method {
        Method::Table => {
            values::tabulated(&[gamma], ", or draw exact normals with --method exact")?;
            let lobe = tables(args.tables.as_deref())?.lobe(args.sigma, gamma)?;
            Ok(Box::new(move |random| {
                let u = [random.random(), random.random()];
                let (m, density) = lobe.sample_with_table_pdf(v, u);
                (m.into(), density)
            }))
        }
        Method::Exact => {
            without_tables(args, "exact")?;
            let v = v.as_dvec3();
            Ok(Box::new(move |random| {
                let m = truth.sample_visible_by_rejection(v, &mut || random.random());
                (m.as_vec3(), truth.visible_normal_pdf(v, m) as f32)
            }))
        }
        Method::Pseudo => {
            without_tables(args, "pseudo")?;
            let v = v.as_dvec3();
            Ok(Box::new(move |random| {
                let m = truth.sample_pseudo_visible_normal(v, [random.random(), random.random()]);
                (m.as_vec3(), truth.pseudo_visible_normal_pdf(v, m) as f32)
            }))
        }
    }
}

fn without_tables(args: &Args, method: &str) -> Result<()> {
    ensure!(
        args.tables.is_none(),
        "--method {method} draws without tables: drop --tables, or give --method table"
    );
    Ok(())
}

/// Writes a safetensors file. All normals precede all densities in it, so they are drawn twice
/// rather than kept: a file of any length takes the same memory.
fn write(draw: &Draw, args: &Args, stage: &Stage, out: &mut dyn Write) -> io::Result<()> {
    let count = args.count;
    stage.split(2 * count);
    let mut out = BufWriter::new(out);
    out.write_all(&header(count)?)?;
    let mut random = StdRng::seed_from_u64(args.seed);
    for _ in 0..count {
        let (m, _) = draw(&mut random);
        m.to_array().iter().try_for_each(|x| out.write_all(&x.to_le_bytes()))?;
        stage.step();
    }
    let mut random = StdRng::seed_from_u64(args.seed);
    for _ in 0..count {
        let (_, pdf) = draw(&mut random);
        out.write_all(&pdf.to_le_bytes())?;
        stage.step();
    }
    out.flush()
}

/// The beginning of a safetensors file: the length of the description, and the description.
fn header(count: usize) -> io::Result<Vec<u8>> {
    let tensor = |shape: Vec<usize>, from: usize, to: usize| TensorInfo {
        dtype: Dtype::F32,
        shape,
        data_offsets: (from, to),
    };
    let tensors = vec![
        ("normals".to_owned(), tensor(vec![count, 3], 0, 12 * count)),
        ("pdf".to_owned(), tensor(vec![count], 12 * count, 16 * count)),
    ];
    let described = Metadata::new(None, tensors).map_err(io::Error::other)?;
    let mut text = serde_json::to_vec(&described)?;
    // Values begin at a multiple of eight bytes.
    text.resize(text.len().next_multiple_of(8), b' ');
    Ok([&(text.len() as u64).to_le_bytes()[..], &text].concat())
}

/// Approximate seconds for a normal; only the share of the whole counts.
const SECONDS: f64 = 1e-7;

pub(super) fn run(args: &Args) -> Result<()> {
    let to_stdout = is_stream(&args.out);
    ensure!(
        !(to_stdout && io::stdout().is_terminal()),
        "standard output is a terminal, and safetensors are binary: pipe them to a program, or \
         name a file"
    );
    let draw = source(args)?;
    let count = args.count;
    let seconds = SECONDS * count as f64;
    let write = |out: &mut dyn Write| {
        watched("drawing", seconds, |meter| write(&draw, args, &meter.stage(seconds), out))
    };
    if !to_stdout {
        replace_with(&args.out, write).map_err(|why| unwritable(&args.out, why))?;
        return summarize(&format!("{} ({count} normals)\n", args.out.display()));
    }
    interrupt::leaves_stream();
    match write(&mut io::stdout().lock()) {
        Err(why) if why.kind() == io::ErrorKind::BrokenPipe => note(format!(
            "the reader of standard output left before all {count} normals were written"
        )),
        written => {
            written.context("standard output")?;
            note(format!("{count} normals on standard output"));
        }
    }
    Ok(())
}
