//! Rough dielectrics of one index of refraction at any shape and roughness, for textures of σ and
//! γ: their albedos, and what compensations and coats need of them.

use alloc::vec::Vec;

use glam::Vec3;
use microfacet_core::Masking;
use wide::f32x4;

use super::broad::Broad;
use super::compensation::Compensation;
use super::energy::{Averages, Energy, InterfaceAlbedo, Shares, Totals, averages, smooth_shares};
use super::interface::checked;
use crate::albedo::{InterfaceAlbedos, InterfaceAt, InterfaceTables};
use crate::bind_error::BindError;
use crate::elementary::exp2;
use crate::tables::Tables;
use crate::vector::vec3;

/// Rough dielectrics of one index of refraction under one form of masking, to be read at any σ and
/// γ: for renderers that take them from textures.
///
/// Made by [`Tables::family_dielectric`], once for all materials of the index. A lookup is
/// [`at`](Self::at) a place on the surface. What that returns goes into
/// [`Dielectric::at_hit`](crate::Dielectric::at_hit) or
/// [`Plastic::at_hit`](crate::Plastic::at_hit).
///
/// Albedos are read from the nodes of the set's own tables, so that their errors are those of the
/// tables' certificates.
#[derive(Clone, Debug)]
pub struct FamilyDielectric {
    albedos: InterfaceAlbedos,
    /// As it was given, and in single precision.
    index: f64,
    eta: f32,
    /// At each node and for either side: averages of what is reflected, of what is transmitted, of
    /// the logarithm of what is lost, and of what is transmitted with Turquin's factor.
    averages: [Vec<f32x4>; 2],
    /// Densities of the lights of further bounces, at each node and for either side.
    broad: Vec<[Broad; 2]>,
    smooth: Totals,
}

/// The logarithm of an average loss that is rounding alone. Less counts as this, so that
/// polynomials do not overshoot between nodes with and without a loss.
const LEAST: f64 = -24.0;

impl Tables {
    /// Rough dielectrics of an index of refraction η, inside over outside, at every σ and γ that
    /// the set's tables hold, for one form of masking.
    ///
    /// They are baked for a recipe whose material is a dielectric with a range of σ, and of γ if
    /// that varies as well:
    ///
    /// ```toml
    /// [[material]]
    /// name = "glass"
    /// sigma = { min = 0.05, max = 0.8 }
    /// gamma = { min = 1.8, max = 6 }
    /// fresnel = { dielectric = 1.5 }
    /// masking = "height-correlated"
    /// ```
    ///
    /// The call reads every node of these tables; keep the result.
    ///
    /// # Errors
    /// [`BindError::Index`] unless η lies in [1e-3, 1e3];
    /// [`MaterialError::NoDielectricRange`](crate::MaterialError::NoDielectricRange) if the set has
    /// no such tables.
    pub fn family_dielectric(
        &self,
        eta: f64,
        masking: Masking,
    ) -> Result<FamilyDielectric, BindError> {
        let (index, eta) = (eta, checked(eta)?);
        let (mut nodes, mut broad) = ([const { Vec::new() }; 2], Vec::new());
        let albedos = self.interface_albedos(index, masking, |albedo| {
            let [outside, inside] =
                averages(albedo).map(|[reflected, transmitted, lost, whole]| {
                    let log = if lost > 0.0 { libm::log2(lost).max(LEAST) } else { LEAST };
                    f32x4::from([reflected, transmitted, log, whole].map(|x| x as f32))
                });
            nodes[0].push(outside);
            nodes[1].push(inside);
            let sides = [&albedo.outside, &albedo.inside];
            broad.push(sides.map(|curve| Broad::round(|v| Shares::of(curve.eval(v)).lost)));
        })?;
        Ok(FamilyDielectric {
            albedos,
            index,
            eta,
            averages: nodes,
            broad,
            smooth: Totals::smooth(eta),
        })
    }
}

impl FamilyDielectric {
    /// The dielectric at a roughness σ and a shape γ.
    ///
    /// Both are clamped to the ranges that the set's tables cover; NaN counts as the smallest.
    #[must_use]
    pub fn at(&self, sigma: f32, gamma: f32) -> DielectricAt<'_> {
        DielectricAt { family: self, at: self.albedos.at(sigma, gamma), smooth: false }
    }

    /// The index of refraction, inside over outside.
    #[must_use]
    pub fn eta(&self) -> f64 {
        self.index
    }

    /// The form of masking.
    #[must_use]
    pub fn masking(&self) -> Masking {
        self.albedos.masking
    }

    /// All that lookups read.
    pub(crate) fn tables(&self) -> InterfaceTables {
        let Self { albedos, eta, averages, broad, smooth, .. } = self;
        let mut tables = albedos.tables(*eta, smooth.transmitted());
        for (side, (of, nodes)) in tables.sides.iter_mut().zip(averages).enumerate() {
            of.averages = nodes.iter().map(|node| node.to_array()).collect();
            of.bands = broad.iter().map(|sides| sides[side].bands()).collect();
        }
        tables
    }

    /// The memory that it takes, in bytes.
    #[must_use]
    pub fn bytes(&self) -> usize {
        let averages = self.averages.iter().map(|all| size_of_val(&all[..])).sum::<usize>();
        let broad = self.broad.len() * size_of::<[Broad; 2]>();
        size_of::<Self>() + self.albedos.bytes() + averages + broad
    }
}

/// A rough dielectric at one σ and γ, read from a [`FamilyDielectric`].
#[derive(Clone, Copy, Debug)]
pub struct DielectricAt<'a> {
    family: &'a FamilyDielectric,
    at: InterfaceAt<'a>,
    /// Whether the lobe is a mirror, whatever the tables hold.
    smooth: bool,
}

impl<'a> DielectricAt<'a> {
    /// The index of refraction, inside over outside.
    #[must_use]
    pub fn eta(&self) -> f64 {
        self.family.index
    }

    /// The form of masking.
    #[must_use]
    pub fn masking(&self) -> Masking {
        self.family.masking()
    }

    /// The shares of light that one bounce reflects and transmits, seen from outside.
    ///
    /// `v` is a unit vector in the tangent frame, n = +z. A view at or below the horizon, or NaN,
    /// is the grazing view.
    #[must_use]
    pub fn outside(&self, v: impl Into<[f32; 3]>) -> [f32; 2] {
        self.at.shares(0, vec3(v).z)
    }

    /// The shares of light that one bounce reflects and transmits, seen from inside; z points to
    /// the side of the view.
    #[must_use]
    pub fn inside(&self, v: impl Into<[f32; 3]>) -> [f32; 2] {
        self.at.shares(1, vec3(v).z)
    }

    /// In single precision, 1 if next to 1.
    pub(super) fn index(&self) -> f32 {
        self.family.eta
    }

    /// The energy of the lobe, which may be smooth.
    pub(super) fn energy(self, compensation: Compensation, smooth: bool) -> Energy<Self> {
        let FamilyDielectric { averages, eta, .. } = self.family;
        let (totals, compensation) = if smooth {
            (self.family.smooth, Compensation::None)
        } else {
            let place = &self.at.place;
            let averages = averages.each_ref().map(|nodes| -> Averages {
                let all = place.interpolate(nodes);
                let lost = exp2(f32x4::splat(all.to_array()[2])).to_array()[0];
                let [reflected, transmitted, log, whole] = all.to_array().map(f64::from);
                let lost = if log > LEAST + 1.0 { f64::from(lost).min(1.0) } else { 0.0 };
                [reflected, transmitted, lost, whole]
            });
            (Totals::rough(averages, compensation, *eta), compensation)
        };
        Energy::new(Self { smooth, ..self }, totals, compensation, *eta)
    }
}

impl InterfaceAlbedo for DielectricAt<'_> {
    #[inline]
    fn shares(&self, side: usize, v: Vec3) -> [f32; 2] {
        if self.smooth {
            return smooth_shares(self.family.eta, side, v);
        }
        self.at.shares(side, v.z.abs())
    }

    #[inline]
    fn broad(&self, side: usize) -> &Broad {
        &self.family.broad[self.at.place.nearest()][side]
    }
}
