//! The errors of what a filter reads against the model: at the points of the fit, where linear
//! interpolation errs most, at others that are even over the texture, and along its edges.

use microfacet_baker::progress::Stage;
use microfacet_core::Masking;
use microfacet_model::ParameterError;

use super::axis::{AXES, Along, Place, TexelAxis, array, coordinates};
use super::edge::Edge;
use super::fit::{Filter, Tap};
use super::truth::{Channel, FINEST, FINEST_OF_INTERFACES, Truth, truths};
use super::{Texture, TextureSpec};

/// Even points of a certificate for each texel, and the fewest and the most of them, of albedos and
/// of averages.
const PER_TEXEL: usize = 2;
const EVENLY: [[usize; 2]; 2] = [[2_000, 200_000], [50, 6_000]];
/// Points in each cell along edges, where only half as many texels are near.
const PER_EDGE: usize = 6;
/// The same along lines within the domain.
const PER_LINE: usize = 3;
/// Points within each cell along γ: the texel and the middle, where linear interpolation errs most
/// in either direction, and in turn one of `BETWEEN`.
const WITHIN: [f64; 2] = [0.0, 0.5];
const BETWEEN: [f64; 3] = [0.29, 0.76, 0.15];
/// Steps of an additive recurrence that fills two dimensions evenly, and one with the first alone:
/// 1/ρ and 1/ρ² of the plastic number, ρ³ = ρ + 1.
const EVEN: [f64; 2] = [0.754_877_666_246_692_8, 0.569_840_290_998_053_3];

/// The error of a quantity over the points that count.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Deviation {
    /// `e`, `scale`, `bias`, `reflected` or `transmitted`.
    pub quantity: &'static str,
    /// The largest error.
    pub largest: f64,
    /// Where the largest error is.
    pub at: Place,
    /// Its root mean square, over the texture's coordinates.
    pub rms: f64,
    /// The largest error, if the filter's shares are multiples of 1/256, as those of much hardware.
    pub coarse: f64,
    /// The largest and the root mean square of the error relative to the true value, by which
    /// shaders may divide; meaningless where that value may be 0, as for the bias.
    pub relative: [f64; 2],
}

/// A place with the model's albedo.
#[derive(Clone, Copy, Debug)]
pub struct Known {
    /// The material and the view.
    pub place: Place,
    /// The model's albedo.
    pub truth: Truth,
}

/// The model's albedos at places of any shapes, under one form of masking; all of them or none have
/// a view, and so it is with an index.
///
/// # Errors
/// [`ParameterError`] for a place outside the domain of the model.
pub fn known(
    places: &[Place],
    masking: Masking,
    stage: &Stage,
) -> Result<Vec<Known>, ParameterError> {
    let gammas = places.iter().map(|place| place.gamma);
    let average = places.first().is_some_and(|place| place.cos.is_none());
    let interface = places.first().is_some_and(|place| place.eta.is_some());
    let finest = if interface { FINEST_OF_INTERFACES } else { FINEST }[usize::from(average)];
    let truths = truths(gammas, places.len(), |i| places[i], masking, finest, stage)?;
    Ok(places.iter().zip(truths).map(|(&place, truth)| Known { place, truth }).collect())
}

/// The points at which a texture is checked, for any values of its texels.
#[derive(Clone, Debug)]
pub struct Checks {
    filter: Filter,
    points: Vec<(Known, Tap)>,
    /// How many of them, the first ones, are even over the texture's coordinates.
    even: usize,
}

impl Deviation {
    /// The largest error rounded up to two digits, since a larger one may lie between the points.
    pub fn stated(&self) -> f64 {
        rounded_up(self.largest)
    }

    /// As [`Self::stated`], for a filter in steps of 1/256.
    pub fn stated_coarse(&self) -> f64 {
        rounded_up(self.coarse)
    }
}

fn rounded_up(x: f64) -> f64 {
    if !(x > 0.0 && x.is_finite()) {
        return x;
    }
    let tens = x.log10().floor() - 1.0;
    let digits = (x / 10_f64.powf(tens)).ceil();
    // By its text: a product with a power of ten is not the nearest number to the two digits.
    format!("{digits}e{tens}").parse().unwrap_or(x)
}

impl Checks {
    /// Even points throughout the certified domain, points along its edges and in its corners, and
    /// those of a fit that are inside it.
    pub(super) fn new(
        spec: &TextureSpec,
        fitted: Vec<(Known, Tap)>,
        stage: &Stage,
    ) -> Result<Self, ParameterError> {
        let (axes, filter) = (&spec.axes, Filter::new(&spec.axes));
        let average = usize::from(!spec.is_directional());
        let [fewest, most] = EVENLY[average];
        let count = (PER_TEXEL * filter.texels).clamp(fewest, most);
        let shapes = axes.iter().find(|axis| axis.is_sliced());
        let slices = shapes.map_or(vec![f64::NAN], slices);
        let share = count / slices.len();
        let of = |at: [f64; AXES]| match spec.place(&at) {
            place if spec.promises(&place) => (place, filter.tap(axes, &at)),
            below => {
                let place = Place { cos: Some(spec.least_cos), ..below };
                (place, filter.tap(axes, &coordinates(axes, &place)))
            }
        };
        let evenly = slices
            .iter()
            .enumerate()
            .flat_map(|(i, &slice)| (0..share).map(move |j| even(axes, slice, i * share + j)));
        let mut points: Vec<(Place, Tap)> = evenly.map(of).collect();
        let even = points.len();
        if spec.is_directional() {
            for &slice in &slices {
                points.extend(edges(axes, slice, PER_EDGE).map(of));
                points.extend(spec.horizon(&filter, slice, PER_EDGE));
                points.extend(
                    lines(spec, slice)
                        .map(|place| (place, filter.tap(axes, &coordinates(axes, &place)))),
                );
            }
        }
        let (places, taps): (Vec<Place>, Vec<Tap>) = points.into_iter().unzip();
        let inside = fitted.into_iter().filter(|(known, _)| spec.promises(&known.place));
        let points = spec.known(places, stage)?.zip(taps).chain(inside).collect();
        Ok(Self { filter, points, even })
    }

    /// Checks at places whose albedos are known.
    pub fn at(spec: &TextureSpec, known: &[Known]) -> Self {
        let filter = Filter::new(&spec.axes);
        let tap = |known: &Known| filter.tap(&spec.axes, &coordinates(&spec.axes, &known.place));
        let points = known.iter().map(|known| (*known, tap(known))).collect();
        Self { filter, points, even: known.len() }
    }

    /// The errors of a texture along each named edge of its domain.
    pub fn along_edges(&self, texture: &Texture) -> Vec<(Edge, Vec<Deviation>)> {
        let spec = &texture.spec;
        let along = |edge: Edge| (edge, self.of(texture, |place| edge.holds(spec, place)));
        Edge::of(spec).into_iter().map(along).filter(|(_, errors)| !errors.is_empty()).collect()
    }

    /// The errors of a texture at the points that `counts` counts.
    pub fn of(&self, texture: &Texture, counts: impl Fn(&Place) -> bool) -> Vec<Deviation> {
        let planes: Vec<Vec<f64>> = (0..texture.spec.channels.len())
            .map(|channel| texture.plane(channel).map(f64::from).collect())
            .collect();
        let counted = |points: &[(Known, Tap)]| {
            points.iter().filter(|(known, _)| counts(&known.place)).copied().collect::<Vec<_>>()
        };
        let (even, others) = self.points.split_at(self.even);
        let (even, others) = (counted(even), counted(others));
        let deviation = |(quantity, of): (&'static str, Reading)| {
            let (mut largest, mut at, mut coarse, mut sum) = (-1.0, None, 0.0_f64, 0.0);
            let (mut share, mut shares) = (0.0_f64, 0.0);
            for (i, (known, tap)) in even.iter().chain(&others).enumerate() {
                let error = |read: fn(&Filter, &[f64], Tap) -> f64| {
                    let read = |channel: usize| read(&self.filter, &planes[channel], *tap);
                    let (got, want) = of(&read, known.truth);
                    ((got - want).abs(), want)
                };
                let (fine, want) = error(Filter::read);
                coarse = coarse.max(error(Filter::read_coarsely).0);
                share = share.max(fine / want);
                if i < even.len() {
                    sum += fine * fine;
                    shares += (fine / want).powi(2);
                }
                if fine > largest {
                    (largest, at) = (fine, Some(known.place));
                }
            }
            let [rms, mean] = [sum, shares].map(|sum| (sum / even.len() as f64).sqrt());
            let relative = [share, mean];
            Some(Deviation { quantity, largest, at: at?, rms, coarse, relative })
        };
        quantities(&texture.spec.channels).into_iter().filter_map(deviation).collect()
    }
}

/// Places on the lines within the domain of an interface, in the slice of an index.
fn lines(spec: &TextureSpec, slice: f64) -> impl Iterator<Item = Place> {
    let rough = spec.axes.iter().find(|axis| matches!(axis.along, Along::Roughness { .. }));
    let steps = rough.map_or(Vec::new(), |axis| axis.dense(PER_LINE));
    let at = move |rough: f64| {
        let of = |axis: &TexelAxis| match axis.along {
            Along::Roughness { .. } => rough,
            _ if axis.is_sliced() => slice,
            _ => 1.0,
        };
        let material = spec.place(&array(spec.axes.iter().map(of)));
        let on = move |edge: Edge| material.eta.and_then(|eta| edge.cos(eta));
        let views = Edge::WITHIN.into_iter().filter_map(on);
        views.map(move |cos| Place { cos: Some(cos.max(spec.least_cos)), ..material })
    };
    steps.into_iter().flat_map(at)
}

/// From a function that reads a channel: the value of a quantity, and its true value.
type Reading = Box<dyn Fn(&dyn Fn(usize) -> f64, Truth) -> (f64, f64)>;

/// The quantities that channels hold, as a shader forms them.
fn quantities(channels: &[Channel]) -> Vec<(&'static str, Reading)> {
    let mut all: Vec<(&'static str, Reading)> = Vec::new();
    for (i, &channel) in channels.iter().enumerate() {
        match channel {
            Channel::Empty | Channel::Excess | Channel::TintExcess | Channel::RootLost => {}
            Channel::ReflectedExcess => {
                all.push(("reflected", Box::new(move |read, t| (read(i) + t.smooth, t.shares[0]))));
            }
            Channel::TransmittedExcess => {
                let of = move |read: &dyn Fn(usize) -> f64, t: Truth| read(i) + (1.0 - t.smooth);
                all.push(("transmitted", Box::new(move |read, t| (of(read, t), t.shares[1]))));
            }
            // The error of 1 − E is that of E.
            Channel::Lost => all.push(("e", Box::new(move |read, t| (1.0 - read(i), t.e)))),
            Channel::NotReflected => {
                all.push(("reflected", Box::new(move |read, t| (1.0 - read(i), t.shares[0]))));
            }
            _ => all.push((channel.name(), Box::new(move |read, t| (read(i), channel.of(t))))),
        }
    }
    let find = |channel| channels.iter().position(|&other| other == channel);
    let [e, excess, scale, bias] =
        [Channel::E, Channel::Excess, Channel::Scale, Channel::Bias].map(find);
    if let (Some(e), Some(excess)) = (e, excess) {
        let bias =
            move |read: &dyn Fn(usize) -> f64, t: Truth| read(excess) + read(e) * t.mirror[0];
        all.push(("bias", Box::new(move |read, t| (bias(read, t), t.bias))));
        all.push(("scale", Box::new(move |read, t| (read(e) - bias(read, t), t.e - t.bias))));
    }
    let shares = [
        ([Channel::Reflected, Channel::Transmitted], 0.0),
        ([Channel::ReflectedExcess, Channel::TransmittedExcess], 1.0),
    ];
    for (both, more) in shares {
        if let [Some(r), Some(t)] = both.map(find) {
            all.push(("e", Box::new(move |read, truth| (read(r) + read(t) + more, truth.e))));
        }
    }
    // Engines read E as the sum of both.
    if let (Some(scale), Some(bias), None) = (scale, bias, e) {
        all.push(("e", Box::new(move |read, t| (read(scale) + read(bias), t.e))));
    }
    all
}

/// Coordinates of the slices that are checked: three in each cell, and the end; of indices, along
/// which shares change least, the middle of each cell, and both ends.
fn slices(axis: &TexelAxis) -> Vec<f64> {
    let cells = axis.texels.windows(2).zip(BETWEEN.into_iter().cycle());
    if !axis.is_of_shapes() {
        let middle = |(pair, _): (&[f64], f64)| 0.5 * (pair[0] + pair[1]);
        return cells.map(middle).chain([0.0, 1.0]).collect();
    }
    let cell = |(pair, between): (&[f64], f64)| {
        let at = |within: f64| pair[0] + within * (pair[1] - pair[0]);
        [at(WITHIN[0]), at(WITHIN[1]), at(between)]
    };
    cells.flat_map(cell).chain([1.0]).collect()
}

/// A point of an even sequence, in the slice of a shape.
fn even(axes: &[TexelAxis], slice: f64, i: usize) -> [f64; AXES] {
    let mut steps = EVEN.iter();
    let mut along = |axis: &TexelAxis| match axis.is_sliced() {
        true => slice,
        false => (0.5 + i as f64 * steps.next().expect("two axes beside slices")).fract(),
    };
    array(axes.iter().map(&mut along))
}

/// Points along the roughest surfaces and along the normal view, in the slice of a shape. The other
/// two edges are the smallest cosine that counts: on a mirror all views are above it.
fn edges(axes: &[TexelAxis], slice: f64, per_cell: usize) -> impl Iterator<Item = [f64; AXES]> {
    let longest = axes.iter().map(TexelAxis::len).max().unwrap_or(1);
    let steps = per_cell * (longest - 1);
    let point = move |along: f64, first: bool| {
        let mut nth = 0;
        array(axes.iter().map(|axis| {
            if axis.is_sliced() {
                return slice;
            }
            nth += 1;
            if (nth == 1) == first { along } else { 1.0 }
        }))
    };
    (0..=steps)
        .map(move |i| i as f64 / steps as f64)
        .flat_map(move |along| [true, false].map(|first| point(along, first)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bounds_are_rounded_up() {
        for (x, up) in
            [(0.0163, 0.017), (0.002, 0.002), (5.98e-4, 6e-4), (9.91e-5, 1e-4), (0.0, 0.0)]
        {
            assert_eq!(rounded_up(x), up);
        }
    }
}
