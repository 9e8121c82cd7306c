//! Maps of a table's errors over two of its axes: the errors of its certificate, measured again.
//!
//! A map covers the range that the certificate promises errors for. Each pixel is the largest error
//! measured in it: along the axes that are shown, and along the axes of views and random numbers
//! that are not. An axis of the material that is not shown stays at the value of the certificate's
//! largest error, and views are spaced as the table spaces them for that material.

mod albedo;
mod layout;
mod normals;
mod radial;
mod span;

use microfacet_baker::bake::albedo::AlbedoError;
use microfacet_baker::distribution::DistributionError;
use microfacet_baker::progress::Stage;
use microfacet_sampler::{BindError, MaterialError, Tables};
use microfacet_tables::{LoadError, Table};

use layout::Layout;

pub use layout::{Sides, seconds, sides};
pub use span::{Quantity, Span};

/// A point of a table, as shares of its axes; the components beyond them are unused.
type Place = [f64; AXES];
const AXES: usize = 4;

/// Errors of a table over one or two of its axes.
pub struct ErrorMap {
    /// The axis along x.
    pub x: Span,
    /// The axis along y; `None` for a table with one axis, or one that is measured along one.
    pub y: Option<Span>,
    /// Pixels along x.
    pub columns: usize,
    /// The largest error in each pixel, row by row from the low end of y; NaN where one is NaN.
    pub errors: Vec<f64>,
    /// Number of points measured.
    pub points: usize,
    /// Axes that are not shown and stay at a value.
    pub fixed: Vec<(Quantity, f64)>,
    /// Axes that are not shown, over which each pixel is the largest error.
    pub over: Vec<Quantity>,
    /// The point of the certificate's largest error, as shares of x and y, if the map contains it.
    pub worst: Option<[f64; 2]>,
}

impl ErrorMap {
    /// The largest error; NaN if any is NaN.
    pub fn largest(&self) -> f64 {
        self.errors.iter().copied().fold(0.0, worse)
    }
}

/// Why the errors of a table were not measured.
#[derive(Debug, thiserror::Error)]
pub enum Unmeasured {
    /// The table has one value, or none of its axes is of a known quantity.
    #[error("it has no axis along which errors could change")]
    NoAxes,
    /// A table that is read together with it is missing.
    #[error("the set lacks {0}, which is read together with it")]
    NoTable(String),
    /// The distribution is not known by its name alone.
    #[error(transparent)]
    Distribution(#[from] DistributionError),
    /// The set cannot make the lobe.
    #[error(transparent)]
    Material(#[from] MaterialError),
    /// The set cannot make the lobe of a material.
    #[error(transparent)]
    Named(#[from] BindError),
    /// The tables do not make a set.
    #[error(transparent)]
    Load(#[from] LoadError),
    /// The model does not have the albedo.
    #[error(transparent)]
    Albedo(#[from] AlbedoError),
}

/// The errors of one kind of tables.
trait Ruler {
    /// The axes of the table, in its order.
    fn spans(&self) -> &[Span];

    /// The errors at points; each `run` successive points have one value of the first axis.
    fn errors(&self, places: &[Place], run: usize, stage: &Stage) -> Result<Vec<f64>, Unmeasured>;
}

/// Measures the errors of a table of this set over some of its axes, on all threads; each point is
/// a step of the stage.
///
/// # Errors
/// [`Unmeasured`] if the set lacks a table that is read together with this one, if no axis has
/// errors to show, or if the model lacks the distribution or the albedo.
pub fn measure(
    set: &Tables,
    table: &Table,
    sides: Sides,
    stage: &Stage,
) -> Result<ErrorMap, Unmeasured> {
    let ruler = ruler(set, table)?;
    let spans = ruler.spans();
    let layout = Layout::new(table, sides);
    let (places, pixels): (Vec<Place>, Vec<usize>) =
        layout.places(table, spans).into_iter().unzip();
    stage.split(places.len());
    let mut errors = vec![0.0; layout.pixels.iter().product()];
    for (pixel, error) in pixels.into_iter().zip(ruler.errors(&places, layout.run(), stage)?) {
        errors[pixel] = worse(errors[pixel], error);
    }
    let worst = |axis: usize| spans[axis].worst(table);
    let y = sides.y.map_or(Some(0.5), worst);
    // An axis of one node has no other value.
    let fixed = layout.fixed.iter().filter(|&&i| table.axes[i].nodes.len() > 1);
    Ok(ErrorMap {
        columns: layout.pixels[0],
        errors,
        points: places.len(),
        fixed: fixed.map(|&i| (spans[i].quantity, spans[i].value(places[0][i]))).collect(),
        over: layout.over.iter().map(|&i| spans[i].quantity).collect(),
        worst: worst(sides.x).zip(y).map(|(x, y)| [x, y]),
        x: spans[sides.x].clone(),
        y: sides.y.map(|y| spans[y].clone()),
    })
}

fn ruler<'a>(set: &'a Tables, table: &'a Table) -> Result<Box<dyn Ruler + 'a>, Unmeasured> {
    use microfacet_tables::Kind;
    Ok(match table.kind {
        Kind::Albedo | Kind::AlbedoAverage => Box::new(albedo::Albedos::new(set, table)?),
        Kind::Shadowing
        | Kind::VisibleSlope
        | Kind::VisibleSlopePeeled
        | Kind::VisibleSlopeConditional => Box::new(normals::Normals::new(set, table)?),
        _ => Box::new(radial::Radial::new(set, table)?),
    })
}

/// The larger error; NaN counts as larger than any number.
fn worse(a: f64, b: f64) -> f64 {
    if b > a || b.is_nan() { b } else { a }
}
