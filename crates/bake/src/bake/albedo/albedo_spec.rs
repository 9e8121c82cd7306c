//! The specification of albedo tables: the lobe, the reflectance, and the nodes.

use std::f64::consts::SQRT_2;

use microfacet_sampler::Masking;
use microfacet_tables::axis::{
    CriticalBlend, CrossingRoot, LogRoughness, LogShape, ViewBlend, even_nodes,
};
use microfacet_tables::{
    Axis, Interpolation, Interval, Kind, LobeForm, LobeSpec, Mapping, Precision, Reflectance,
    Roughness, SIGMA_MAX, Side, Subject, Table,
};

use super::lobe::{azimuth, stated, tail};
use super::{AlbedoError, AlbedoLobe};
use crate::bake::names;
use crate::distribution::Distribution;
use crate::table_spec::{GAMMA_MIN, Level};

/// Smallest σ node; smoother surfaces count as mirrors.
const SIGMA_MIN: f64 = LogRoughness::BAKED.first;
const INTERPOLATION: Interpolation = Interpolation::Lagrange6;

/// Albedo tables to bake: one for each form of masking, and with the moments of the family also a
/// table of averages for each.
#[derive(Clone, Debug, PartialEq)]
pub struct AlbedoSpec {
    /// The lobes that the tables are baked for.
    pub lobe: AlbedoLobe,
    /// The reflectance of the microfacets.
    pub reflectance: Reflectance,
    /// The forms of masking; both together take hardly longer than one.
    pub maskings: Vec<Masking>,
    /// The axes, that of the view last.
    pub axes: Vec<Axis>,
    /// Error aimed at in every node.
    pub tolerance: f64,
    /// How values are stored.
    pub precision: Precision,
}

/// Level from which the view nodes are crowded towards the normal.
const CLOSE_FROM: Level = Level(24);

/// γ below which a dielectric has enough upright facets for a kink of its transmission: up to 1.9
/// an axis in three parts errs less than one in two, at 3 it errs more
/// (`cargo run --profile dist -p microfacet-study -- dielectric_views`).
const HEAVY: f64 = 2.0;

impl AlbedoSpec {
    /// The specification at a level.
    ///
    /// Tables of a range of the family are cut out of the general ones: one node for a single γ or
    /// σ, else the nodes that interpolation reads in the range, so that values in between equal
    /// those of the general tables. For other lobes it is the coarsest table of the
    /// [refinement](Self::refined).
    ///
    /// # Errors
    /// [`AlbedoError`] for parameters that describe no ellipsoid, or a reflectance that no table is
    /// of ([`Reflectance::tabulated`] gives those of tables).
    pub fn new(
        lobe: AlbedoLobe,
        reflectance: Reflectance,
        maskings: Vec<Masking>,
        level: impl Into<Level>,
        precision: Precision,
    ) -> Result<Self, AlbedoError> {
        reflectance.check_of_table().map_err(AlbedoError::Lobe)?;
        let level = level.into();
        // All numbers of nodes were found by measuring. The interpolating polynomial reads six.
        let nodes = |counts| level.nodes(counts, 6);
        let quality = level.quality() as usize;
        let is_heavy = lobe.gamma.min < HEAVY;
        let is_dense = reflectance.side() == Some(Side::Dense);
        let index = reflectance.indices().map(|index| {
            let count = nodes([20, 32, 48]);
            // From inside, where the kinks along the view cross, parts share a node.
            let is_crossed = is_dense && index.min < SQRT_2 && SQRT_2 < index.max;
            let (mapping, count) = match is_crossed {
                true => (Mapping::CrossingRoot(CrossingRoot { crowded: is_heavy }), count | 1),
                false => (Mapping::ReflectanceRoot, count),
            };
            cut("eta", mapping, &even_nodes(0.0, 1.0, count), index.into())
        });
        let mut axes = match azimuth(&lobe)? {
            None => {
                let all = materials(&lobe, nodes([16, 24, 44]), nodes([22, 38, 68]));
                all.into_iter().chain(index).collect()
            }
            Some(azimuth) => {
                // 2ᵏ + 1 nodes in a quarter of the azimuths, before refinement.
                let quarter = [5, 9, 17][quality];
                let count = match lobe.form() {
                    // Its albedo is the same at every azimuth.
                    LobeForm::Distribution => 1,
                    LobeForm::Ellipsoid => 4 * (quarter - 1),
                    LobeForm::Family | LobeForm::StudentT => quarter,
                };
                let around =
                    Axis::placed("azimuth", Mapping::Azimuth(azimuth), INTERPOLATION, count);
                index.into_iter().chain([around]).collect::<Vec<_>>()
            }
        };
        let (view, views) = match lobe.is_family() {
            true if level >= CLOSE_FROM => (ViewBlend::CLOSE, nodes([20, 33, 58])),
            true => (ViewBlend::BAKED, nodes([20, 33, 58])),
            // γ of a single lobe is a constant of the coordinate; the number of nodes is doubled
            // until the error is met.
            false => (ViewBlend::BAKED.of_shape(tail(&lobe)), [17, 33, 65][quality]),
        };
        axes.push(if is_dense {
            // E changes fast where total reflection begins, and transmission where upright facets
            // begin to transmit: parts share a node there.
            let is_range = reflectance.indices().is_some_and(|index| !index.is_point());
            let blend = match is_heavy {
                true => CriticalBlend::UPRIGHT,
                false => CriticalBlend::BAKED,
            };
            let soft = if is_range { CriticalBlend::SOFT } else { 0.0 };
            let blend = CriticalBlend { soft, ..blend };
            let blend = if lobe.is_family() { blend } else { blend.of_shape(tail(&lobe)) };
            let parts = blend.parts();
            let count = parts * (2 * (views - 1)).div_ceil(parts) + 1;
            Axis::placed("view", Mapping::CriticalBlend(blend), INTERPOLATION, count)
        } else {
            Axis::placed("view", Mapping::ViewBlend(view), INTERPOLATION, views)
        });
        let tolerance = level.between([1e-5, 1e-6, 1e-7]) * share(&lobe, reflectance);
        Ok(Self { lobe, reflectance, maskings, axes, tolerance, precision })
    }

    /// The moments of the whole family, for both forms of masking.
    pub fn general(level: impl Into<Level>, precision: Precision) -> Self {
        let maskings = Masking::ALL.into();
        Self::new(LobeSpec::GENERAL, Reflectance::Mirror, maskings, level, precision)
            .expect("the family is no ellipsoid")
    }

    /// The specification of a directional table, for its form of masking alone; `None` for a table
    /// of other values, and for one of a distribution that its label does not describe. `tolerance`
    /// is the error aimed at in every node, which a table does not state.
    pub fn of_table(table: &Table, tolerance: f64) -> Option<Self> {
        let Subject { lobe, masking, reflectance } = &table.subject;
        let lobe = match (&lobe.distribution, table.axes.first()?.mapping) {
            (Some(label), Mapping::Azimuth(azimuth)) => AlbedoLobe {
                roughness: Roughness::isotropic(Interval::point(azimuth.sigma[0])),
                ..AlbedoLobe::outside(Distribution::Named(label.parse().ok()?))
            },
            (Some(_), _) => return None,
            (None, _) => lobe.map(|_| unreachable!("it has none")),
        };
        let (maskings, reflectance) = (vec![(*masking)?], (*reflectance)?);
        let (axes, precision) = (table.axes.clone(), table.precision);
        Some(Self { lobe, reflectance, maskings, axes, tolerance, precision })
    }

    /// The same specification with one axis twice as dense.
    #[must_use]
    pub fn refined(&self, axis: usize) -> Self {
        let mut finer = self.clone();
        let Axis { name, mapping, interpolation, nodes } = &self.axes[axis];
        let closed = matches!(mapping, Mapping::Azimuth(azimuth) if !azimuth.fold);
        let count = if closed { 2 * nodes.len() } else { 2 * nodes.len() - 1 };
        finer.axes[axis] = Axis::placed(name, *mapping, *interpolation, count);
        finer
    }

    /// How many times an axis may be [`refined`](Self::refined): 0 for the moments of the family,
    /// whose nodes were found by measuring. For others the number of nodes that is needed depends
    /// on the material.
    pub fn doublings(&self) -> u32 {
        match (self.lobe.form(), self.reflectance) {
            (LobeForm::Family, Reflectance::Mirror) => 0,
            // No number of nodes resolves well the kink that the clamp of G1(l) leaves, nor the
            // onset of total reflection on smooth surfaces.
            (LobeForm::Family | LobeForm::Ellipsoid, _) => 2,
            _ => 4,
        }
    }

    /// The error aimed at for the whole table, given that of a node.
    pub fn target(&self) -> f64 {
        300.0 * self.tolerance / share(&self.lobe, self.reflectance)
    }

    /// Axes that can be [`refined`](Self::refined): those of the view with more than one node.
    pub fn refinable(&self) -> Vec<usize> {
        let refines = |axis: &Axis| axis.len() > 1 && is_of_view(axis);
        (0..self.axes.len()).filter(|&i| refines(&self.axes[i])).collect()
    }

    /// Number of nodes at which the albedo is integrated.
    pub fn nodes(&self) -> usize {
        self.axes.iter().map(Axis::len).product()
    }

    /// Names of the channels.
    pub fn channels(&self) -> Vec<String> {
        let clamp = self.lobe.theta.map(|_| Kind::CLAMP.into());
        names(self.reflectance.channels()).into_iter().chain(clamp).collect()
    }

    /// Whether tables of averages are baked as well: for moments of more than one material, since
    /// the averages of one follow from its albedo.
    pub fn has_averages(&self) -> bool {
        self.lobe.is_family()
            && self.reflectance == Reflectance::Mirror
            && self.nodes_of_materials() > 1
    }

    /// Number of nodes that differ in more than the view.
    pub fn nodes_of_materials(&self) -> usize {
        self.axes.iter().filter(|axis| !is_of_view(axis)).map(Axis::len).product()
    }

    /// Number of tables.
    pub fn tables(&self) -> usize {
        (1 + usize::from(self.has_averages())) * self.maskings.len()
    }

    /// Bytes of the values as they are stored.
    pub fn bytes(&self) -> usize {
        let one = self.channels().len() * self.precision.bytes() * self.nodes();
        let averages = self.axes[..2].iter().map(Axis::len).product::<usize>()
            * Kind::MOMENTS.len()
            * Precision::F32.bytes();
        self.maskings.len() * (one + if self.has_averages() { averages } else { 0 })
    }

    /// The subject of a table.
    pub fn subject(&self, masking: Masking) -> Subject {
        let (masking, reflectance) = (Some(masking), Some(self.reflectance));
        Subject { masking, reflectance, ..Subject::of(stated(&self.lobe)) }
    }

    /// The whole extent of the family's axes, with the outer nodes that only interpolation reads.
    pub(super) fn everywhere(&self) -> LobeSpec {
        let ends = |i: usize| {
            let ends = self.axes[i].ends().map(|t| self.axes[i].quantity(t).unwrap_or(f64::NAN));
            Interval { min: ends[0].min(ends[1]), max: ends[0].max(ends[1]) }
        };
        LobeSpec::family(Roughness::Isotropic(ends(1)), ends(0))
    }

    /// The name of a table.
    pub fn name(&self, kind: Kind, masking: Masking) -> String {
        self.subject(masking).name(kind)
    }
}

/// Factor of the error that nodes of a lobe aim at, of a three-hundredth of the error of the table.
///
/// The kink that the clamp of G1(l) leaves in a tilted lobe takes quadrature to high orders. Nodes
/// of round lobes err by at most 2.3e-6 instead of 8.6e-8, of tables that err by 1.8e-4
/// (`docs/albedo.md`), and take fewer points.
fn share(lobe: &AlbedoLobe, reflectance: Reflectance) -> f64 {
    match (lobe.form(), reflectance.indices()) {
        (LobeForm::Ellipsoid, _) => 30.0,
        (LobeForm::Family, None) => 10.0,
        _ => 1.0,
    }
}

fn is_of_view(axis: &Axis) -> bool {
    let Axis { mapping, .. } = axis;
    matches!(mapping, Mapping::Azimuth(_) | Mapping::ViewBlend(_) | Mapping::CriticalBlend(_))
}

/// The axes of γ and σ for round lobes.
fn materials(lobe: &AlbedoLobe, shapes: usize, roughnesses: usize) -> Vec<Axis> {
    let (gamma, sigma) = (lobe.gamma, lobe.roughness.x());
    let (log_shape, log_rough) = (LogShape::BAKED, LogRoughness::BAKED);
    let ends = [f64::INFINITY, GAMMA_MIN].map(|gamma| log_shape.coordinate(gamma));
    let shapes = even_nodes(ends[0], ends[1], shapes);
    let ends = [SIGMA_MIN, SIGMA_MAX].map(|sigma| log_rough.coordinate(sigma));
    let roughnesses = even_nodes(ends[0], ends[1], roughnesses);
    // Surfaces smoother than the first node count as mirrors.
    let [from, to] = if sigma.min < SIGMA_MIN {
        [SIGMA_MIN, sigma.max.max(2.0 * SIGMA_MIN)]
    } else {
        [sigma.min, sigma.max]
    };
    vec![
        cut("gamma", Mapping::LogShape(log_shape), &shapes, [gamma.max, gamma.min]),
        cut("sigma", Mapping::LogRoughness(log_rough), &roughnesses, [from, to]),
    ]
}

/// The axis of the nodes that the polynomial reads anywhere between two quantities; a single value
/// is a node itself.
fn cut(name: &str, mapping: Mapping, nodes: &[f64], ends: [f64; 2]) -> Axis {
    let all = Axis::new(name, mapping, INTERPOLATION, nodes.to_vec());
    let [from, to] = ends.map(|x| all.coordinate(x).expect("an axis of a quantity"));
    if from == to { Axis { nodes: vec![from], ..all } } else { all.cut(from, to) }
}
