//! `query`: table and exact values at points from a CSV file.

use std::fs::File;
use std::io::{self, Read};
use std::path::PathBuf;

use clap::{Subcommand, ValueEnum};
use glam::DVec3;

use microfacet_bake::validate::furnace::direction;
use microfacet_model as model;
use microfacet_model::fresnel::schlick_weight;
use microfacet_sampler::{Masking, Moments, StudentT, Tables};

use super::{Done, Failure, Outcome, tables};

/// Append table and exact values to the points of a CSV file.
#[derive(clap::Args)]
#[command(
    after_help = "Example:\n  printf 'sigma_x,sigma_y,gamma,theta,phi\\n0.3,0.3,3,1.2,0\\n' | microfacet-bake query g1 --input -"
)]
pub(super) struct Args {
    #[command(subcommand)]
    what: What,
}

#[derive(Subcommand)]
enum What {
    /// Smith's lambda and G1 of a view. Columns: sigma_x, sigma_y, gamma, theta, phi.
    G1(Io),
    /// The visible normal at random numbers u1, u2, and its density. Columns: those of g1, and u1, u2.
    Normal(Io),
    /// Directional albedo with F = 1 and its Schlick parts. Columns: sigma, gamma, cos_theta, masking.
    Albedo(Io),
    /// Cosine-weighted average of the albedo. Columns: sigma, gamma, masking.
    AlbedoAverage(Io),
}

#[derive(clap::Args)]
struct Io {
    /// CSV file with named columns, `-` for standard input; other columns are passed through.
    #[arg(long, value_name = "CSV")]
    input: PathBuf,
    /// Tables to ask; the embedded default if absent.
    #[arg(long, value_name = "PATH")]
    tables: Option<PathBuf>,
    /// Whose values to append.
    #[arg(long, value_enum, value_delimiter = ',', default_value = "table,exact")]
    method: Vec<Method>,
}

#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Method {
    /// The run-time crate's, in single precision.
    Table,
    /// The model's, in double precision.
    Exact,
}

pub(super) fn run(args: Args) -> Outcome {
    match &args.what {
        What::G1(io) => answer(io, &G1),
        What::Normal(io) => answer(io, &Normal),
        What::Albedo(io) => answer(io, &Albedo),
        What::AlbedoAverage(io) => answer(io, &AlbedoAverage),
    }
}

/// Passes the rows of a file through, with the quantity's values appended.
fn answer(io: &Io, quantity: &dyn Quantity) -> Outcome {
    let set = tables(io.tables.as_deref())?;
    let input: Box<dyn Read> = if io.input.as_os_str() == "-" {
        Box::new(io::stdin())
    } else {
        let open = File::open(&io.input);
        Box::new(open.map_err(|why| Failure(format!("{}: {why}", io.input.display())))?)
    };
    let mut reader = csv::ReaderBuilder::new().trim(csv::Trim::All).from_reader(input);
    let header = reader.headers()?.clone();
    let columns = quantity
        .inputs()
        .iter()
        .map(|name| find_column(&header, name, quantity.inputs()))
        .collect::<Result<Vec<_>, _>>()?;
    let mut writer = csv::Writer::from_writer(io::stdout());
    let names = io.method.iter().flat_map(|method| quantity.outputs(*method));
    let write = |writer: &mut csv::Writer<io::Stdout>, row: Vec<String>| match writer.write_record(&row) {
        Err(error) if is_broken_pipe(&error) => Ok(false),
        Err(error) => Err(Failure::from(error)),
        Ok(()) => Ok(true),
    };
    if !write(&mut writer, header.iter().map(String::from).chain(names).collect())? {
        return Ok(Done::Ok);
    }
    for record in reader.records() {
        let record = record?;
        let line = record.position().map_or(0, csv::Position::line);
        let at = |error: String| Failure(format!("line {line}: {error}"));
        let fields: Vec<&str> = columns.iter().map(|&column| &record[column]).collect();
        let mut row: Vec<String> = record.iter().map(String::from).collect();
        for &method in &io.method {
            row.extend(quantity.values(&fields, &set, method).map_err(at)?);
        }
        if !write(&mut writer, row)? {
            break;
        }
    }
    match writer.flush() {
        Err(error) if error.kind() != io::ErrorKind::BrokenPipe => Err(error.into()),
        _ => Ok(Done::Ok),
    }
}

fn is_broken_pipe(error: &csv::Error) -> bool {
    matches!(error.kind(), csv::ErrorKind::Io(error) if error.kind() == io::ErrorKind::BrokenPipe)
}

fn find_column(header: &csv::StringRecord, name: &str, all: &[&str]) -> Result<usize, Failure> {
    header.iter().position(|column| column == name).ok_or_else(|| {
        let have: Vec<&str> = header.iter().collect();
        Failure(format!(
            "no column `{name}`; needed are {}, the file has {}",
            all.join(", "),
            have.join(", ")
        ))
    })
}

fn parse(text: &str, name: &str) -> Result<f64, String> {
    let x: f64 = text.parse().map_err(|_| format!("{name} \"{text}\" is not a number"))?;
    let (low, high) = match name {
        "theta" => (0.0, std::f64::consts::FRAC_PI_2 + 1e-6),
        "u1" | "u2" | "cos_theta" => (0.0, 1.0),
        "phi" => (f64::MIN, f64::MAX),
        // σ and γ are judged, with their own messages, by the constructors.
        _ => return Ok(x),
    };
    if (low..=high).contains(&x) { Ok(x) } else { Err(format!("{name} = {x} must lie in [{low}, {high}]")) }
}

/// The fields of a row as numbers.
fn numbers(fields: &[&str], names: &[&str]) -> Result<Vec<f64>, String> {
    fields.iter().zip(names).map(|(text, name)| parse(text, name)).collect()
}

/// A material and a view, and for normals two random numbers.
struct Point<'a> {
    sigma: [f64; 2],
    gamma: f64,
    theta: f64,
    phi: f64,
    u: [f64; 2],
    set: &'a Tables,
}

impl<'a> Point<'a> {
    fn new(fields: &[&str], names: &[&str], set: &'a Tables) -> Result<Self, String> {
        let values = numbers(fields, names)?;
        let &[x, y, gamma, theta, phi, ref rest @ ..] = &values[..] else {
            unreachable!("five columns were found")
        };
        model::StudentT::anisotropic(x, y, gamma).map_err(|why| why.to_string())?;
        let u = if let &[a, b] = rest { [a, b] } else { [0.5; 2] };
        Ok(Self { sigma: [x, y], gamma, theta, phi, u, set })
    }

    fn view(&self) -> DVec3 {
        let (sin, cos) = self.theta.sin_cos();
        DVec3::new(sin * self.phi.cos(), sin * self.phi.sin(), cos)
    }

    fn bound(&self) -> Result<StudentT, String> {
        self.set.student_t(self.sigma, self.gamma).map_err(|why| why.to_string())
    }

    fn exact(&self) -> model::StudentT {
        model::StudentT::anisotropic(self.sigma[0], self.sigma[1], self.gamma).expect("checked in `new`")
    }
}

/// Something that can be asked of a point.
trait Quantity {
    fn inputs(&self) -> &'static [&'static str];
    fn output_stems(&self) -> &'static [&'static str];
    fn values(&self, fields: &[&str], set: &Tables, method: Method) -> Result<Vec<String>, String>;

    fn outputs(&self, method: Method) -> Vec<String> {
        let suffix = match method {
            Method::Table => "table",
            Method::Exact => "exact",
        };
        self.output_stems().iter().map(|stem| format!("{stem}_{suffix}")).collect()
    }
}

struct G1;

impl Quantity for G1 {
    fn inputs(&self) -> &'static [&'static str] {
        &["sigma_x", "sigma_y", "gamma", "theta", "phi"]
    }

    fn output_stems(&self) -> &'static [&'static str] {
        &["lambda", "g1"]
    }

    fn values(&self, fields: &[&str], set: &Tables, method: Method) -> Result<Vec<String>, String> {
        let at = Point::new(fields, self.inputs(), set)?;
        let v = at.view();
        Ok(match method {
            Method::Table => {
                let bound = at.bound()?;
                vec![bound.lambda(v.as_vec3()).to_string(), bound.g1(v.as_vec3()).to_string()]
            }
            Method::Exact => vec![at.exact().lambda(v).to_string(), at.exact().g1(v).to_string()],
        })
    }
}

struct Normal;

impl Quantity for Normal {
    fn inputs(&self) -> &'static [&'static str] {
        &["sigma_x", "sigma_y", "gamma", "theta", "phi", "u1", "u2"]
    }

    fn output_stems(&self) -> &'static [&'static str] {
        &["m_x", "m_y", "m_z", "pdf"]
    }

    fn values(&self, fields: &[&str], set: &Tables, method: Method) -> Result<Vec<String>, String> {
        let at = Point::new(fields, self.inputs(), set)?;
        let v = at.view();
        Ok(match method {
            Method::Table => {
                let bound = at.bound()?;
                let m = bound.sample_visible_normal(v.as_vec3(), at.u.map(|u| u as f32));
                [m.x, m.y, m.z, bound.visible_normal_pdf(v.as_vec3(), m)].map(|x| x.to_string()).into()
            }
            Method::Exact => {
                let m = at.exact().visible_normal(v, at.u);
                [m.x, m.y, m.z, at.exact().visible_normal_pdf(v, m)].map(|x| x.to_string()).into()
            }
        })
    }
}

/// The form of masking that a field names.
fn masking(text: &str) -> Result<Masking, String> {
    text.parse().map_err(|why| format!("masking \"{text}\": {why}"))
}

/// Error aimed at by the exact values.
const EXACT: f64 = 1e-10;

fn integrator(gamma: f64) -> Result<model::AlbedoIntegrator, String> {
    let shape = model::Shape::new(gamma).map_err(|why| why.to_string())?;
    Ok(model::AlbedoIntegrator::new(shape, EXACT))
}

struct Albedo;

impl Quantity for Albedo {
    fn inputs(&self) -> &'static [&'static str] {
        &["sigma", "gamma", "cos_theta", "masking"]
    }

    fn output_stems(&self) -> &'static [&'static str] {
        &["E", "schlick_scale", "schlick_bias"]
    }

    fn values(&self, fields: &[&str], set: &Tables, method: Method) -> Result<Vec<String>, String> {
        let values = numbers(&fields[..3], self.inputs())?;
        let &[sigma, gamma, cos] = &values[..] else { unreachable!("three columns were found") };
        let masking = masking(fields[3])?;
        Ok(match method {
            Method::Table => {
                let albedo = set.albedo(sigma, gamma, masking).map_err(|why| why.to_string())?;
                let v = direction(cos as f32);
                let Moments { scale, bias, .. } = albedo.moments(v);
                [albedo.albedo(v), scale, bias].map(|x| x.to_string()).into()
            }
            Method::Exact => {
                let schlick = |cos| [1.0 - schlick_weight(cos), schlick_weight(cos)];
                let albedo =
                    integrator(gamma)?.reflection(sigma, cos, schlick).map_err(|why| why.to_string())?;
                let [scale, bias] = albedo.of(masking);
                [scale + bias, scale, bias].map(|x| x.to_string()).into()
            }
        })
    }
}

struct AlbedoAverage;

impl Quantity for AlbedoAverage {
    fn inputs(&self) -> &'static [&'static str] {
        &["sigma", "gamma", "masking"]
    }

    fn output_stems(&self) -> &'static [&'static str] {
        &["E_avg"]
    }

    fn values(&self, fields: &[&str], set: &Tables, method: Method) -> Result<Vec<String>, String> {
        let values = numbers(&fields[..2], self.inputs())?;
        let &[sigma, gamma] = &values[..] else { unreachable!("two columns were found") };
        let masking = masking(fields[2])?;
        Ok(match method {
            Method::Table => {
                let average = set.average_moments(sigma, gamma, masking).map_err(|why| why.to_string())?;
                vec![average.total().to_string()]
            }
            Method::Exact => {
                let albedo = integrator(gamma)?.average(sigma, |_| [1.0]).map_err(|why| why.to_string())?;
                vec![albedo.of(masking)[0].to_string()]
            }
        })
    }
}
