//! Points by options: every combination of the values given.

use clap::Args;
use csv::StringRecord;

use microfacet_sampler::Masking;

use super::output::Output;
use super::quantities::{Known, Quantity};
use super::{Io, Unit, appended};
use crate::cli::values::{finite, gamma, masking, sigma};
use crate::cli::words;
use crate::cli::{Result, bail, ensure, note, print, warn, write};

/// The options of a quantity.
pub(super) trait Points {
    fn io(&self) -> &Io;

    /// The unit of angles.
    fn unit(&self) -> Unit {
        Unit::default()
    }

    /// The fields of each point, in the order of the quantity's columns.
    fn rows(&self) -> Result<Vec<Vec<String>>>;
}

/// A shape, and how roughness is written.
#[derive(Args)]
struct Shape {
    /// Shapes, comma separated.
    #[arg(long, value_name = "G,...", value_delimiter = ',', value_parser = gamma,
          conflicts_with = "input", required_unless_present = "input")]
    gamma: Vec<f64>,
    /// Square --sigma, which is then a perceptual roughness in [0, 1], as in glTF.
    #[arg(long, conflicts_with = "input")]
    perceptual: bool,
}

impl Shape {
    fn sigma(&self, x: f64) -> Result<f64> {
        if !self.perceptual {
            return Ok(x);
        }
        ensure!(
            (0.0..=1.0).contains(&x),
            "sigma = {x} must lie in [0, 1] with --perceptual, where 1 is sigma = 1; without it \
             sigma may be larger"
        );
        Ok(x * x)
    }
}

/// A lobe and a direction.
#[derive(Args)]
pub(super) struct Directed {
    #[command(flatten)]
    io: Io,
    /// Roughness, `X` or `X,Y`; repeat it for more.
    #[arg(long, value_name = "X[,Y]", value_parser = sigma, conflicts_with = "input",
          required_unless_present = "input")]
    sigma: Vec<[f64; 2]>,
    #[command(flatten)]
    shape: Shape,
    /// Polar angle of the direction, from the macro normal: 0 to pi/2, or to 90 with --degrees;
    /// repeat it for more; some from the normal to near the horizon if absent.
    #[arg(long, value_name = "T", value_parser = finite, conflicts_with = "input")]
    theta: Vec<f64>,
    /// Azimuth of the direction, from the x axis.
    #[arg(long, value_name = "P", value_parser = finite, default_value_t = 0.0,
          conflicts_with = "input")]
    phi: f64,
    #[command(flatten)]
    unit: Unit,
}

/// Polar angles in radians and in degrees, where none is given.
const THETAS: [[f64; 6]; 2] = [[0.0, 0.3, 0.6, 0.9, 1.2, 1.5], [0.0, 15.0, 30.0, 45.0, 60.0, 85.0]];

impl Points for Directed {
    fn io(&self) -> &Io {
        &self.io
    }

    fn unit(&self) -> Unit {
        self.unit
    }

    fn rows(&self) -> Result<Vec<Vec<String>>> {
        let thetas = match &self.theta[..] {
            [] => &THETAS[usize::from(self.unit.degrees)][..],
            given => given,
        };
        let mut rows = Vec::new();
        for &[x, y] in &self.sigma {
            let [x, y] = [self.shape.sigma(x)?, self.shape.sigma(y)?];
            for &gamma in &self.shape.gamma {
                let of_view =
                    |&theta: &f64| [x, y, gamma, theta, self.phi].map(|x| x.to_string()).to_vec();
                rows.extend(thetas.iter().map(of_view));
            }
        }
        Ok(rows)
    }
}

/// A lobe, a view and random numbers.
#[derive(Args)]
pub(super) struct VisibleNormal {
    #[command(flatten)]
    directed: Directed,
    /// Random numbers in [0, 1].
    #[arg(long, value_name = "U1,U2", value_parser = pair, default_value = "0.5,0.5",
          conflicts_with = "input")]
    u: [f64; 2],
}

impl Points for VisibleNormal {
    fn io(&self) -> &Io {
        self.directed.io()
    }

    fn unit(&self) -> Unit {
        self.directed.unit()
    }

    fn rows(&self) -> Result<Vec<Vec<String>>> {
        let mut rows = self.directed.rows()?;
        rows.iter_mut().for_each(|row| row.extend(self.u.map(|u| u.to_string())));
        Ok(rows)
    }
}

/// Parses two random numbers; their range is checked with those of a file.
fn pair(text: &str) -> Result<[f64; 2]> {
    match text.split(',').map(finite).collect::<Vec<_>>()[..] {
        [Ok(u1), Ok(u2)] => Ok([u1, u2]),
        _ => bail!("\"{text}\" must be two numbers in [0, 1], as 0.2,0.7"),
    }
}

/// A round lobe with its masking.
#[derive(Args)]
pub(super) struct Average {
    #[command(flatten)]
    io: Io,
    /// Roughnesses, comma separated.
    #[arg(long, value_name = "X,...", value_delimiter = ',', value_parser = finite,
          conflicts_with = "input", required_unless_present = "input")]
    sigma: Vec<f64>,
    #[command(flatten)]
    shape: Shape,
    /// Form of masking.
    #[arg(long, value_parser = masking(), default_value = "height-correlated",
          conflicts_with = "input")]
    masking: Masking,
}

impl Average {
    /// The fields of each lobe, with those of a view before the form of masking.
    fn with(&self, view: &[Option<f64>]) -> Result<Vec<Vec<String>>> {
        let mut rows = Vec::new();
        for &sigma in &self.sigma {
            let sigma = self.shape.sigma(sigma)?;
            for &gamma in &self.shape.gamma {
                let of_view = |view: &Option<f64>| {
                    let numbers = [Some(sigma), Some(gamma), *view].into_iter().flatten();
                    let masking = self.masking.name().to_owned();
                    numbers.map(|x| x.to_string()).chain([masking]).collect()
                };
                rows.extend(view.iter().map(of_view));
            }
        }
        Ok(rows)
    }
}

impl Points for Average {
    fn io(&self) -> &Io {
        &self.io
    }

    fn rows(&self) -> Result<Vec<Vec<String>>> {
        self.with(&[None])
    }
}

/// A round lobe, its masking and a view.
#[derive(Args)]
pub(super) struct Directional {
    #[command(flatten)]
    lobe: Average,
    /// Cosines of the view's polar angle, in [0, 1], comma separated.
    #[arg(long, value_name = "C,...", value_delimiter = ',', value_parser = finite,
          default_values_t = [1.0, 0.8, 0.6, 0.4, 0.2, 0.05], conflicts_with = "input")]
    cos_theta: Vec<f64>,
}

impl Points for Directional {
    fn io(&self) -> &Io {
        &self.lobe.io
    }

    fn rows(&self) -> Result<Vec<Vec<String>>> {
        let views: Vec<_> = self.cos_theta.iter().copied().map(Some).collect();
        self.lobe.with(&views)
    }
}

/// Prints the quantity at points, as columns for a reader or as JSON.
pub(super) fn answer(
    rows: &[Vec<String>],
    io: &Io,
    quantity: Quantity,
    known: &Known,
) -> Result<()> {
    let [inputs, outputs] = quantity.columns();
    let fields: Vec<Vec<&str>> =
        rows.iter().map(|row| row.iter().map(String::as_str).collect()).collect();
    // For each point, the values by each method.
    let answers = fields.iter().map(|row| {
        io.method.iter().map(|&method| known.values(row, method)).collect::<Result<Vec<_>>>()
    });
    let answers = answers.collect::<Result<Vec<_>>>()?;
    fields.iter().find_map(|row| known.doubt(row)).iter().for_each(warn);
    if io.method.len() > 1 {
        fields.iter().find_map(|row| known.note(row)).iter().for_each(note);
    }
    if io.json {
        let names = inputs.iter().map(ToString::to_string).chain(appended(quantity, &io.method));
        let mut output = Output::new(names.collect(), true);
        let records = rows.iter().zip(&answers).map(|(row, answers)| {
            let values = answers.iter().flatten();
            Ok(row.iter().chain(values).map(String::as_str).collect::<StringRecord>())
        });
        let (text, _) = output.rows(records)?;
        return write(&[&output.head()?, &text, output.tail()].concat());
    }
    let varies = |i: usize| fields.iter().any(|row| row[i] != fields[0][i]);
    let (across, fixed): (Vec<_>, Vec<_>) = (0..inputs.len()).partition(|&i| varies(i));
    let unit = |i: usize| ["theta", "phi"].contains(&inputs[i]).then(|| known.angles());
    let fixed = fixed.iter().map(|&i| {
        let unit = unit(i).map_or(String::new(), |unit| format!(" {unit}"));
        format!("{} = {}{unit}", inputs[i], fields[0][i])
    });
    let head = across.iter().map(|&i| match unit(i) {
        Some(unit) => format!("{} [{unit}]", inputs[i]),
        None => inputs[i].to_owned(),
    });
    let head = head.chain(["method"].iter().chain(outputs).map(ToString::to_string));
    let mut lines = vec![head.collect::<Vec<_>>()];
    for (row, answers) in fields.iter().zip(answers) {
        for (method, values) in io.method.iter().zip(answers) {
            let at = across.iter().map(|&i| row[i]).chain([method.name()]).map(String::from);
            lines.push(at.chain(values).collect());
        }
    }
    let fixed: Vec<_> = fixed.collect();
    print(&format!("{}\n\n{}\n", fixed.join(", "), words::columns(&lines).join("\n")))
}
