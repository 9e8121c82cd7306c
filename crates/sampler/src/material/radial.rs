//! Isotropic distributions outside the Student-t family, each from its own tables.

use alloc::format;
use alloc::string::String;
use alloc::vec::Vec;

use microfacet_core::math::sqrt;
use microfacet_tables::axis::half_tangent::Slope;
use microfacet_tables::axis::hermite::{Node, between_rows, hermite, locate, make_monotone};
use microfacet_tables::axis::{HalfTangent, MirroredRoot, Rational};
use microfacet_tables::{Kind, LobeSpec, Mapping, Table};

use super::batch::Batch;
use super::distribution::{MicrofacetDistribution, visible_density};
use super::key::LobeKey;
use super::reflecting::Reflecting;
use super::roughness::checked;
use super::slices::{Slice, Slices};
use super::student_t::StudentT;
use super::surface::Shape;
use super::tabulated::Tabulated;
use crate::error::MaterialError;
use crate::vector::vec3;

/// A lobe of any isotropic distribution: GTR, Gauss, Schlick or a measured one.
///
/// Directions are unit vectors in the tangent frame, n = +z. One lookup inverts the CDF of the
/// in-plane slope and one that of the slope across, which depends on the in-plane slope.
#[derive(Clone, Debug)]
pub struct Radial {
    /// σ, masking and the in-plane slope.
    plane: StudentT,
    /// Slopes across: rows by in-plane slope, the half for u > ½.
    across: Vec<Node>,
    /// Cells along a row, and between rows.
    cells: usize,
    rows: usize,
    /// The coordinate of the in-plane slope.
    slope: Given,
    /// D^(1/4) by the half tangent of the slope.
    density: Vec<Node>,
    tilt: HalfTangent,
    /// The label of the distribution.
    name: String,
}

/// Why tables make no lobe of a distribution.
pub(crate) enum RadialError {
    /// A roughness out of range.
    Sigma(MaterialError),
    /// The name of a table that is missing.
    NoTable(String),
}

/// s in the formulas of tables without a γ axis: slopes across are in units of √(1 + x²), and κ is
/// the scale of its axis.
const ROUND: f64 = 1.0;

/// The coordinate of the in-plane slope, on which the slope across depends.
#[derive(Clone, Copy, Debug)]
enum Given {
    /// Where normals reach the horizon.
    Unbounded(HalfTangent),
    /// Where unit slopes have a largest value R, which is κ.
    Bounded(Rational, f32),
}

impl Radial {
    pub(crate) fn from_tables(
        tables: &[Table],
        sigma: f32,
        label: &str,
    ) -> Result<Self, RadialError> {
        let [sigma, _] = checked(sigma.into()).map_err(RadialError::Sigma)?;
        let slice = |kind: Kind| {
            let found = tables.iter().find(|table| {
                table.kind == kind && table.subject.lobe.distribution.as_deref() == Some(label)
            });
            let missing = || RadialError::NoTable(format!("{} of {label}", kind.name()));
            found.map(Slice::whole).ok_or_else(missing)
        };
        let (shadowing, slope) = (slice(Kind::RadialShadowing)?, slice(Kind::RadialSlope)?);
        let (conditional, density) = (slice(Kind::RadialConditional)?, slice(Kind::RadialDensity)?);
        let Mapping::HalfTangent(tilt) = density.axes[0].mapping else {
            unreachable!("validated on load")
        };
        let given = match conditional.axes[0].mapping {
            Mapping::HalfTangent(axis) => Given::Unbounded(axis),
            Mapping::Rational(axis) => Given::Bounded(axis, axis.kappa(ROUND) as f32),
            _ => unreachable!("validated on load"),
        };
        let width = conditional.axes[1].nodes.len();
        let mut across = conditional.nodes;
        across.chunks_exact_mut(width).for_each(make_monotone);
        Ok(Self {
            plane: StudentT::new(
                [sigma; 2],
                Slices::new([shadowing, slope], 1.0 + 1.0 / ROUND, ROUND),
            ),
            across,
            cells: width - 1,
            rows: conditional.axes[0].nodes.len() - 1,
            slope: given,
            density: density.nodes,
            tilt,
            name: label.into(),
        })
    }

    /// The scale σ of slopes in the tables: their median.
    #[must_use]
    pub fn sigma(&self) -> f32 {
        self.plane.sigma()[0]
    }

    /// The slope across in units of √(1 + x²), given the in-plane slope.
    ///
    /// It is tabulated by the half tangent of that slope; where slopes are bounded by R, in units
    /// of √(1 − x²/R²) by x/(x + R), which keeps the rows alike up to R.
    #[inline(always)]
    fn sample_across(&self, x: Slope, u: f32) -> Slope {
        let a = x.x.abs();
        let (coordinate, shrink) = match self.slope {
            Given::Unbounded(axis) => (axis.of_view(x.z, a), 1.0),
            Given::Bounded(axis, reach) => {
                let (z, length) = (reach * x.z, sqrt(a * a + x.z * x.z));
                (axis.of_slope(a, z), sqrt((z - a).max(0.0) * (z + a)) / (reach * length))
            }
        };
        let (row, between) = locate(coordinate * self.rows as f32, self.rows);
        let (cell, w) = locate(MirroredRoot::coordinate(u) * self.cells as f32, self.cells);
        let start = row * (self.cells + 1) + cell;
        let below = start + self.cells + 1;
        let (a, b) = between_rows(
            &self.across[start..start + 2],
            &self.across[below..below + 2],
            0,
            between,
        );
        let t = Slope::from_end(hermite(a, b, w), if u > 0.5 { 1.0 } else { -1.0 });
        Slope { x: t.x * shrink, z: t.z }
    }
}

impl MicrofacetDistribution for Radial {
    /// Interpolated.
    #[inline]
    fn d(&self, m: impl Into<[f32; 3]>) -> f32 {
        let m = vec3(m);
        if !(m.z > 0.0) {
            return 0.0;
        }
        let sigma = self.sigma();
        let r = sqrt(m.x * m.x + m.y * m.y);
        // The half tangent of the unit slope r/(σ z): as of a view, with the horizontal and
        // vertical components exchanged.
        let h = self.tilt.of_view(sigma * m.z, r);
        let cells = self.density.len() - 1;
        let (cell, w) = locate(h * cells as f32, cells);
        let root = hermite(self.density[cell], self.density[cell + 1], w).max(0.0);
        (root * root) * (root * root)
    }

    #[inline]
    fn g1(&self, v: impl Into<[f32; 3]>) -> f32 {
        let v = vec3(v);
        self.plane.g1(v)
    }

    #[inline]
    fn sample_visible_normal(&self, v: impl Into<[f32; 3]>, u: [f32; 2]) -> [f32; 3] {
        let v = vec3(v);
        let plane = self.plane.surface();
        let view = plane.stretch(v);
        let x = plane.sample_slope(&view, u[0]);
        plane.assemble(&view, x, self.sample_across(x, u[1])).to_array()
    }

    /// From the tables' D and G1.
    #[inline]
    fn visible_normal_pdf(&self, v: impl Into<[f32; 3]>, m: impl Into<[f32; 3]>) -> f32 {
        let (v, m) = (vec3(v), vec3(m));
        let plane = self.plane.surface();
        let inverse_area = plane.shape.inverse_area(&plane.stretch(v));
        visible_density(v.dot(m), self.d(m), inverse_area)
    }

    fn is_effectively_smooth(&self) -> bool {
        self.plane.is_effectively_smooth()
    }

    fn is_symmetric(&self) -> bool {
        true
    }
}

impl Reflecting for Radial {}

impl Tabulated for Radial {
    fn key(&self) -> LobeKey {
        LobeKey::Upright(LobeSpec::outside(self.name.clone()))
    }

    fn bytes(&self) -> usize {
        self.plane.bytes() + size_of_val(&self.across[..]) + size_of_val(&self.density[..])
    }
}

impl Batch for Radial {}
