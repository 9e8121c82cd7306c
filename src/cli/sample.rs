//! `sample`: draws visible normals of one material and view into a safetensors file.

use std::io::{self, IsTerminal};
use std::path::PathBuf;

use clap::ValueEnum;
use glam::Vec3;
use rand::{RngExt, SeedableRng};
use safetensors::Dtype;
use safetensors::tensor::TensorView;

use microfacet_bake::store::replace;
use microfacet_bake::validate::configuration::Configuration;
use microfacet_model as model;
use microfacet_model::MicrofacetDistribution as _;
use microfacet_sampler::MicrofacetDistribution as _;

use super::{Done, Failure, Outcome, print, report, tables, values, write};

/// Draw normals for one material and view into a safetensors file: `normals` [N,3], `pdf` [N], f32.
#[derive(clap::Args)]
#[command(
    after_help = "Example:\n  microfacet-bake sample --sigma 0.454 --gamma 3 --theta 1.0 --count 100000 --out normals.safetensors"
)]
pub(super) struct Args {
    /// Roughness, `X` or `X,Y`.
    #[arg(long, value_name = "X[,Y]", allow_negative_numbers = true, value_parser = values::sigma)]
    sigma: [f64; 2],
    /// Shape.
    #[arg(long, value_name = "G", allow_negative_numbers = true, value_parser = values::gamma)]
    gamma: f64,
    /// Polar angle of the view.
    #[arg(long, value_name = "T", allow_negative_numbers = true)]
    theta: f64,
    /// Azimuth of the view.
    #[arg(long, value_name = "P", default_value = "0", allow_negative_numbers = true)]
    phi: f64,
    #[command(flatten)]
    unit: values::Unit,
    /// Number of normals.
    #[arg(long, value_name = "N", value_parser = values::count(1..=1_000_000_000))]
    count: u64,
    /// Seed of the random numbers.
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// How normals are drawn; also decides the density that is written.
    #[arg(long, value_enum, default_value = "table")]
    method: Method,
    /// Tables to draw from; the embedded default if absent.
    #[arg(long, value_name = "PATH")]
    tables: Option<PathBuf>,
    /// File to write, `-` for standard output.
    #[arg(long, value_name = "FILE.safetensors")]
    out: PathBuf,
}

#[derive(Clone, Copy, ValueEnum)]
enum Method {
    /// Visible normals from tables, with the density that the table samples.
    Table,
    /// Visible normals by the model's sampler, with the analytic density.
    Exact,
    /// Normals of D, eq. 16-17 and 19-20, with density D(m) (m.n); the view is not used.
    Ndf,
}

pub(super) fn run(args: Args) -> Outcome {
    let [sigma_x, sigma_y] = args.sigma;
    let truth = model::StudentT::new([sigma_x, sigma_y], args.gamma)?;
    let at = Configuration {
        sigma_x,
        sigma_y,
        gamma: args.gamma,
        theta: args.unit.theta(args.theta)?,
        phi: args.unit.phi(args.phi)?,
        seed: args.seed,
    };
    let to_stdout = args.out.as_os_str() == "-";
    if to_stdout && io::stdout().is_terminal() {
        return Err(Failure(
            "standard output is a terminal, and safetensors are binary: pipe them to a program, or name a file"
                .into(),
        ));
    }
    let v = at.view();
    let mut random = rand::rngs::StdRng::seed_from_u64(args.seed);
    let mut draw: Box<dyn FnMut() -> (Vec3, f32)> = match args.method {
        Method::Table => {
            values::tabulated(args.gamma, ", or draw exact normals with --method exact")?;
            let lobe = tables(args.tables.as_deref())?.lobe(args.sigma, args.gamma)?;
            Box::new(move || {
                let m = lobe.sample_visible_normal(v, [random.random(), random.random()]);
                (m, lobe.table_pdf(v, m))
            })
        }
        Method::Exact => Box::new(move || {
            let m = truth.sample_visible_by_rejection(v.as_dvec3(), &mut || random.random());
            (m.as_vec3(), truth.visible_normal_pdf(v.as_dvec3(), m) as f32)
        }),
        Method::Ndf => Box::new(move || {
            let m = truth.sample_ndf([random.random(), random.random()]);
            (m.as_vec3(), (truth.d(m) * m.z) as f32)
        }),
    };
    let count = usize::try_from(args.count)?;
    let (mut normals, mut pdf) = (Vec::with_capacity(12 * count), Vec::with_capacity(4 * count));
    for _ in 0..count {
        let (m, density) = draw();
        m.to_array().iter().for_each(|x| normals.extend(x.to_le_bytes()));
        pdf.extend(density.to_le_bytes());
    }
    let bytes = safetensors::serialize(
        [
            ("normals", TensorView::new(Dtype::F32, vec![count, 3], &normals)?),
            ("pdf", TensorView::new(Dtype::F32, vec![count], &pdf)?),
        ],
        None,
    )?;
    if to_stdout {
        write(&bytes)?;
        report("note", format!("{count} normals on standard output"));
        return Ok(Done::Ok);
    }
    replace(&args.out, &bytes).map_err(|why| {
        let hint = if why.kind() == io::ErrorKind::InvalidInput {
            ", or `--out -` for standard output"
        } else {
            ""
        };
        Failure(format!("{}: {why}{hint}", args.out.display()))
    })?;
    print(&format!("{} ({count} normals)\n", args.out.display()))?;
    Ok(Done::Ok)
}
