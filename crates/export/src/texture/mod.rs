//! Directional albedos as textures that a shader reads with the filter of its hardware, in one
//! line: one shape γ, or a range of them as a volume, and the averages over all views; and the
//! shares of light that interfaces reflect and transmit, over indices of refraction.
//!
//! The coordinate of the view follows the roughness, so that E is smooth where it changes within
//! the roughness of the horizon. Up to [`MOST_FITTED`] texels the values are not the model's: they
//! are fitted so that what the filter reads between texels is closest to the model. [`engine`]
//! writes the textures that engines read today.

mod axis;
mod certificate;
mod check;
mod edge;
pub mod engine;
mod file;
mod fit;
mod interface;
mod shader;
mod truth;

use std::slice::from_ref;

use half::f16;
use microfacet_baker::progress::Stage;
use microfacet_core::Masking;
use microfacet_model::ParameterError;
use rayon::prelude::*;

pub use axis::{Along, Place, TexelAxis};
pub use certificate::{Checks, Deviation, Known, known};
pub use check::{MOST_TEXELS, SIZES, check};
use check::{check_size, check_surface};
pub use edge::Edge;
pub(crate) use file::ktx2::encode_texels;
pub use file::{BeforeRounding, Format, Made, files};
pub use interface::{ETA, Indices, check_interface};
pub use shader::coordinates as shader_coordinates;
pub use shader::{Lines, shader_lines};
pub use truth::{Channel, Truth};

pub use axis::place;
use axis::{AXES, array, coordinates};
use fit::{Filter, Tap, Target, fit};
use truth::{COARSEST, COARSEST_OF_INTERFACES, FINEST, FINEST_OF_INTERFACES, truths};

/// Textures of more texels than this hold the values at the texels. Errors fall with the square of
/// their number along an axis, from 5.2e-3 for γ = ∞ in 32 × 32 texels, and a fit, whose memory
/// grows with its points, gains no more than half.
pub const MOST_FITTED: usize = 1 << 18;
/// The smallest cosine for which a certificate holds.
pub const LEAST_COS: f64 = 1e-4;
/// Points of a fit within each cell along each axis: the texel and the middle, between which linear
/// interpolation of a smooth function errs less. With 3, the error of E for γ = ∞ in 32 × 32 texels
/// is 2.9e-3 instead of 2.6e-3.
const PER_CELL: usize = 2;
/// The same along the smallest cosine that counts, of interfaces, whose coordinate has few cells
/// there. With 2, what texels hold beyond that cosine is poorly determined: the largest error from
/// inside glass in 32 × 32 texels, in a coordinate with x^⅓, was 5.1e-3 instead of 3.2e-3.
const PER_HORIZON: usize = 6;
/// The same along coordinates of engines, in which E of smooth surfaces changes within a cell, and
/// of views from inside, which turn at the critical angle. With 2, the table of Cycles errs by
/// 9.1e-2 instead of 4.9e-2.
const PER_CELL_OF_ENGINES: usize = 3;
/// Seconds that one albedo of a mirror and of an interface take on one processor, and one average,
/// in 32 texels along each axis; only their ratio matters, for the progress that is shown.
const SECONDS: [[f64; 2]; 2] = [[7e-5, 1e-3], [1.2e-3, 2e-2]];

/// The shapes of a texture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Shapes {
    /// One γ; the texture has the axes s and t.
    One(f64),
    /// From ∞ down to this γ; the texture has the axes γ, s and t.
    DownTo(f64),
}

/// What the channels of a texture are.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Channels {
    /// E.
    #[default]
    E,
    /// 1 − E.
    OneMinusE,
    /// E, and bias − E (1−μ)⁵, from which scale and bias follow.
    ScaleBias,
}

impl Channels {
    fn all(self) -> Vec<Channel> {
        match self {
            Self::E => vec![Channel::E],
            Self::OneMinusE => vec![Channel::Lost],
            Self::ScaleBias => vec![Channel::E, Channel::Excess],
        }
    }
}

/// A texture to be made.
#[derive(Clone, Debug, PartialEq)]
pub struct TextureSpec {
    /// The name of its file, without an extension.
    pub name: String,
    /// γ, where no axis is of shapes.
    pub gamma: f64,
    /// The index of a dielectric, where no axis is of indices, as [`Place::eta`].
    pub eta: Option<f64>,
    /// The axes, slowest first. Without an axis of views the texture is of averages.
    pub axes: Vec<TexelAxis>,
    /// The form of masking.
    pub masking: Masking,
    /// The channels.
    pub channels: Vec<Channel>,
    /// The smallest cosine that counts.
    pub least_cos: f64,
    /// Whether values are fitted to the filter, or those at the texels.
    pub fitted: bool,
}

/// κ = scale + heavy/(2γ−3), as [scale, heavy], of the coordinate x^¼ of views.
const KAPPA: [f64; 2] = [3.0, 0.5];

/// [`KAPPA`] of a texture of E. For GGX up to σ = 1 a constant errs less.
fn kappa(shapes: Shapes, sigma_max: f64) -> [f64; 2] {
    match shapes {
        Shapes::One(2.0) if sigma_max <= 1.0 => [4.0, 0.0],
        _ => KAPPA,
    }
}

impl TextureSpec {
    /// The texture of E, named `name`, and that of its averages, with `_average` after the name;
    /// `size` texels along γ (if there is a range), s and t.
    ///
    /// # Panics
    /// Unless `size` has one number for each axis, of at least two.
    pub fn of_shapes(
        name: &str,
        shapes: Shapes,
        sigma_max: f64,
        size: &[usize],
        masking: Masking,
        channels: Channels,
    ) -> [Self; 2] {
        let [scale, heavy] = kappa(shapes, sigma_max);
        let mut along = vec![Along::Roughness { largest: sigma_max }, Along::view(scale, heavy)];
        let gamma = match shapes {
            Shapes::One(gamma) => gamma,
            Shapes::DownTo(smallest) => {
                along.insert(0, Along::Shape { smallest });
                f64::NAN
            }
        };
        assert_eq!(size.len(), along.len(), "a size for each axis");
        let axes: Vec<TexelAxis> =
            along.into_iter().zip(size).map(|(along, &n)| TexelAxis::to_ends(along, n)).collect();
        let directional = Self {
            name: name.into(),
            gamma,
            eta: None,
            masking,
            channels: channels.all(),
            least_cos: LEAST_COS,
            fitted: size.iter().product::<usize>() <= MOST_FITTED,
            axes,
        };
        let average = directional.average(&format!("{name}_average"));
        [directional, average]
    }

    /// The texture of its averages, by another name.
    pub fn average(&self, name: &str) -> Self {
        let axes = self.axes.iter().filter(|axis| !axis.along.is_view()).cloned().collect();
        let channels = self.channels.iter().map(|channel| channel.of_averages()).collect();
        Self { name: name.into(), axes, channels, ..self.clone() }
    }

    /// The place at one coordinate along each axis.
    pub fn place(&self, at: &[f64]) -> Place {
        place(&self.axes, self.fixed(), at)
    }

    /// What no axis may set, as it is given.
    fn fixed(&self) -> Place {
        Place { eta: self.eta, ..Place::of_shape(self.gamma) }
    }

    /// Whether it has an axis of views; else it is of averages.
    pub fn is_directional(&self) -> bool {
        self.axes.iter().any(|axis| axis.along.is_view())
    }

    /// Whether it is of the shares of an interface.
    pub fn is_of_interfaces(&self) -> bool {
        self.eta.is_some() || self.axes.iter().any(|axis| axis.along.inside().is_some())
    }

    /// An estimate of the seconds that it takes on one processor; only ratios are meaningful.
    pub fn seconds(&self) -> f64 {
        let texels: f64 = self.axes.iter().map(|axis| axis.len() as f64).product();
        let per_cell = self.per_cell() as f64;
        let points = if self.fitted { per_cell.powi(self.axes.len() as i32) } else { 1.0 };
        let [mirror, interface] = SECONDS[usize::from(!self.is_directional())];
        let one = if self.is_of_interfaces() { interface } else { mirror };
        one * texels * (points + 1.0)
    }

    /// The error that the model's values aim at: the finest where they are the texels. Where texels
    /// are fitted to them, or judged by them, 3e-2/n² and of averages 1e-1/n², with n texels along
    /// the longest axis: even those of GGX up to σ = 1 err by 0.6/n², and by 0.16/n². Textures of
    /// interfaces err by more than 1/n², and need a tenth of that.
    fn tolerance(&self) -> f64 {
        let average = usize::from(!self.is_directional());
        let longest = self.axes.iter().map(TexelAxis::len).max().unwrap_or(1);
        let of_interfaces = self.is_of_interfaces();
        let share = if of_interfaces { [3e-1, 1.0] } else { [3e-2, 1e-1] };
        let loose = share[average] / (longest * longest) as f64;
        let [finest, coarsest] = match of_interfaces {
            true => [FINEST_OF_INTERFACES, COARSEST_OF_INTERFACES],
            false => [FINEST, COARSEST],
        };
        let [finest, coarsest] = [finest[average], coarsest[average]];
        if self.fitted { loose.clamp(finest, coarsest) } else { finest }
    }

    /// The model's values at places, as [`truths`].
    fn truths(
        &self,
        gammas: impl Iterator<Item = f64>,
        count: usize,
        place: impl Fn(usize) -> Place + Sync,
        stage: &Stage,
    ) -> Result<Vec<Truth>, ParameterError> {
        truths(gammas, count, place, self.masking, self.tolerance(), stage)
    }

    fn per_cell(&self) -> usize {
        let of_engine =
            |axis: &TexelAxis| axis.along.is_view() && !matches!(axis.along, Along::View(_));
        if self.axes.iter().any(of_engine) { PER_CELL_OF_ENGINES } else { PER_CELL }
    }

    /// Values at the texels, or fitted ones.
    ///
    /// # Errors
    /// [`ParameterError`] for a [`Place`] outside the domain of the model.
    pub fn make(&self, stage: &Stage) -> Result<Texture, ParameterError> {
        if self.fitted { Ok(self.fit(&self.samples(stage)?)) } else { self.at_texels(stage) }
    }

    /// As [`Self::make`], with the points at which it is checked.
    ///
    /// # Errors
    /// As [`Self::make`].
    pub fn make_checked(
        &self,
        [values, checks]: [&Stage; 2],
    ) -> Result<(Texture, Checks), ParameterError> {
        if !self.fitted {
            return Ok((self.at_texels(values)?, Checks::new(self, Vec::new(), checks)?));
        }
        let samples = self.samples(values)?;
        Ok((self.fit(&samples), Checks::new(self, samples, checks)?))
    }

    /// What the filter reads at each point of a fit, and what it should be there.
    fn samples(&self, stage: &Stage) -> Result<Vec<(Known, Tap)>, ParameterError> {
        let (places, taps): (Vec<Place>, Vec<Tap>) = self.points().into_iter().unzip();
        Ok(self.known(places, stage)?.zip(taps).collect())
    }

    /// Places with the model's albedos.
    fn known(
        &self,
        places: Vec<Place>,
        stage: &Stage,
    ) -> Result<impl Iterator<Item = Known>, ParameterError> {
        let gammas = places.iter().map(|place| place.gamma);
        let truths = self.truths(gammas, places.len(), |i| places[i], stage)?;
        Ok(places.into_iter().zip(truths).map(|(place, truth)| Known { place, truth }))
    }

    /// Whether the certificate holds at a place.
    fn promises(&self, place: &Place) -> bool {
        place.cos.is_none_or(|cos| cos >= self.least_cos)
    }

    fn fit(&self, samples: &[(Known, Tap)]) -> Texture {
        let filter = Filter::new(&self.axes);
        let target = |(known, tap): &(Known, Tap)| Target {
            tap: *tap,
            promised: self.promises(&known.place),
        };
        let targets: Vec<Target> = samples.iter().map(target).collect();
        let plane = |channel: &Channel| {
            let wanted: Vec<f64> =
                samples.iter().map(|(known, _)| channel.of(known.truth)).collect();
            let [least, most] = channel.range();
            let values = fit(&filter, &targets, &wanted, vec![0.0; filter.texels]);
            values.into_iter().map(|value| value.clamp(least, most) as f32).collect()
        };
        self.of_planes(&self.channels.iter().map(plane).collect::<Vec<_>>())
    }

    fn at_texels(&self, stage: &Stage) -> Result<Texture, ParameterError> {
        let texels = self.grid(|axis| axis.texels.clone());
        let at = |i| self.place(&texels.at(i));
        let shapes = self.axes.iter().zip(&texels.0).find(|(axis, _)| axis.is_of_shapes());
        let gammas: Vec<f64> = shapes.map_or(vec![self.gamma], |(axis, coordinates)| {
            let of = |&c: &f64| place(from_ref(axis), self.fixed(), &[c]).gamma;
            coordinates.iter().map(of).collect()
        });
        let truths = self.truths(gammas.into_iter(), texels.len(), at, stage)?;
        let plane = |channel: &Channel| truths.iter().map(|&t| channel.of(t) as f32).collect();
        Ok(self.of_planes(&self.channels.iter().map(plane).collect::<Vec<_>>()))
    }

    fn of_planes(&self, planes: &[Vec<f32>]) -> Texture {
        let texel = |i: usize| planes.iter().map(move |plane| plane[i]);
        let values = (0..planes[0].len()).flat_map(texel).collect();
        Texture { spec: self.clone(), values, half: false }
    }

    /// The values of the channels at each texel, from albedos that are at hand.
    pub(crate) fn exact(&self, truth: impl Fn(&Place) -> Truth + Sync) -> Vec<Vec<f32>> {
        let texels = self.grid(|axis| axis.texels.clone());
        let of = |i| {
            let truth = truth(&self.place(&texels.at(i)));
            self.channels.iter().map(|channel| channel.of(truth) as f32).collect()
        };
        (0..texels.len()).into_par_iter().map(of).collect()
    }

    fn grid(&self, along: impl Fn(&TexelAxis) -> Vec<f64>) -> Grid {
        Grid(self.axes.iter().map(along).collect())
    }

    /// Points to fit to: a grid over the whole texture, and for views also the smallest cosine that
    /// counts, which is not on the grid.
    fn points(&self) -> Vec<(Place, Tap)> {
        let filter = Filter::new(&self.axes);
        let dense = |axis: &TexelAxis| {
            axis.dense(if axis.along.inside().is_some() { PER_CELL } else { self.per_cell() })
        };
        let grid = self.grid(dense);
        let of = |i| {
            let at = grid.at(i);
            (self.place(&at), filter.tap(&self.axes, &at))
        };
        let mut points: Vec<_> = (0..grid.len()).into_par_iter().map(of).collect();
        if self.is_directional() {
            let sliced = self.axes.iter().find(|axis| axis.is_sliced());
            let is_own =
                |axis: &TexelAxis| matches!(axis.along, Along::View(_) | Along::Critical { .. });
            let along_horizon = match self.is_of_interfaces() && self.axes.iter().any(is_own) {
                true => PER_HORIZON,
                false => self.per_cell(),
            };
            for slice in sliced.map_or(vec![f64::NAN], dense) {
                points.extend(self.horizon(&filter, slice, along_horizon));
            }
        }
        points
    }

    /// Points of the smallest cosine that counts, from the smoothest surface to the roughest of one
    /// slice: `per_cell` or more in each cell that they run through, along either axis. On smooth
    /// surfaces they run through all coordinates of the view.
    fn horizon(&self, filter: &Filter, slice: f64, per_cell: usize) -> Vec<(Place, Tap)> {
        let of = |rough: f64| {
            let at = array(self.axes.iter().map(|axis| match axis {
                sliced if sliced.is_sliced() => slice,
                view if view.along.is_view() => 0.0,
                _ => rough,
            }));
            let place = self.place(&at);
            let place = Place { cos: Some(self.least_cos), ..place };
            (rough, place, coordinates(&self.axes, &place))
        };
        let far = |a: &[f64; AXES], b: &[f64; AXES]| {
            let cells = |(i, axis): (usize, &TexelAxis)| (a[i] - b[i]).abs() * axis.len() as f64;
            self.axes.iter().enumerate().map(cells).any(|cells| cells * per_cell as f64 > 1.0)
        };
        let (mut found, mut ahead) = (vec![of(0.0)], vec![of(1.0)]);
        while let Some(next) = ahead.pop() {
            let last = &found[found.len() - 1];
            if far(&last.2, &next.2) && next.0 - last.0 > f64::EPSILON {
                let middle = of(0.5 * (last.0 + next.0));
                ahead.extend([next, middle]);
            } else {
                found.push(next);
            }
        }
        found.into_iter().map(|(_, place, at)| (place, filter.tap(&self.axes, &at))).collect()
    }
}

/// All combinations of coordinates along each axis, the last axis fastest.
struct Grid(Vec<Vec<f64>>);

impl Grid {
    fn len(&self) -> usize {
        self.0.iter().map(Vec::len).product()
    }

    fn at(&self, mut i: usize) -> [f64; AXES] {
        let mut at = [0.0; AXES];
        for (c, along) in at.iter_mut().zip(&self.0).rev() {
            *c = along[i % along.len()];
            i /= along.len();
        }
        at
    }
}

/// A texture.
#[derive(Clone, Debug, PartialEq)]
pub struct Texture {
    /// The specification that it was made from.
    pub spec: TextureSpec,
    /// Its values, the channels of a texel together, the last axis fastest.
    pub values: Vec<f32>,
    /// Whether the values are stored in 16 bits, to which they are rounded already.
    pub half: bool,
}

impl Texture {
    /// The values of a channel.
    pub fn plane(&self, channel: usize) -> impl Iterator<Item = f32> + '_ {
        self.values.iter().skip(channel).step_by(self.spec.channels.len()).copied()
    }

    /// Rounds it to 16 bits, and says by how much.
    #[must_use]
    pub fn rounded(&self) -> (Self, f64) {
        let values: Vec<f32> = self.values.iter().map(|&x| f16::from_f32(x).to_f32()).collect();
        let changes = values.iter().zip(&self.values).map(|(a, b)| f64::from((a - b).abs()));
        let largest = changes.fold(0.0, f64::max);
        (Self { values, half: true, spec: self.spec.clone() }, largest)
    }

    /// Texels along each axis, slowest first.
    pub fn size(&self) -> Vec<usize> {
        self.spec.axes.iter().map(TexelAxis::len).collect()
    }
}
