//! Table groups: tables that are chosen, baked, certified and cached together.

mod bake;
mod kept;

use serde::{Deserialize, Serialize};

use microfacet_tables::{Kind, MaterialEntry, Precision, Subject};

use super::BakeError;
use crate::bake::albedo::stated;
use crate::bake::radial_bytes;
use crate::distribution::Distribution;
use crate::memory::Values;
use crate::plan::{
    AlbedoWork, Cost, Known, Plan, RequiredAlbedo, RequiredShapes, growth, normals_work,
    on_threads, radial_work,
};
use crate::table_spec::{Level, Quality, TableSpec, general_set};

/// A table group, by what its tables hold.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(super) enum TableGroup {
    /// Visible normals and masking of some required shapes.
    Normals(RequiredShapes, Parts),
    /// A distribution outside the family, and a material that has it.
    Distribution(Distribution, MaterialEntry),
    Albedo(RequiredAlbedo),
}

/// The tables of a group, by those of the general set.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(super) enum Parts {
    All,
    Shadowing,
    Slope,
    /// Masking and peeled slopes for γ < 1.8: both together, since the shares of light that the
    /// peeled slopes use come from the masking.
    Peeled,
    Across,
}

impl Parts {
    /// Parts that can be refined independently, since the error of each does not depend on the
    /// others.
    const APART: [Self; 4] = [Self::Shadowing, Self::Peeled, Self::Slope, Self::Across];

    /// Indices into the general set.
    fn indices(self) -> &'static [usize] {
        match self {
            Self::All => &[0, 1, 2, 3, 4],
            Self::Shadowing => &[0],
            Self::Peeled => &[1, 3],
            Self::Slope => &[2],
            Self::Across => &[4],
        }
    }

    /// The other tables without which these make no lobe. The error of slopes is measured only up
    /// to the seam, so tables beyond it are left out.
    fn others(self) -> &'static [usize] {
        match self {
            Self::All => &[],
            Self::Shadowing => &[2, 4],
            Self::Peeled => &[4],
            Self::Slope => &[0, 4],
            Self::Across => &[0, 1, 2, 3],
        }
    }
}

impl TableGroup {
    /// The groups of a plan whose tables all have one quality.
    pub(super) fn whole(plan: &Plan) -> Result<Vec<Self>, BakeError> {
        let normals = plan.shapes.iter().map(|&need| Self::Normals(need, Parts::All));
        Ok(normals.chain(Self::others(plan)?).collect())
    }

    /// The largest number of groups that a plan can be split into.
    pub(super) fn apart(plan: &Plan) -> Result<Vec<Self>, BakeError> {
        let parts = |&need| Parts::APART.map(|parts| Self::Normals(need, parts));
        let normals = plan.shapes.iter().flat_map(parts);
        let some = |group: &Self| group.values(Level::DEFAULT) != Values::kept(0);
        Ok(normals.filter(some).chain(Self::others(plan)?).collect())
    }

    fn others(plan: &Plan) -> Result<Vec<Self>, BakeError> {
        let of = |distribution: &Distribution| {
            let label = distribution.label();
            let has = |entry: &MaterialEntry| entry.lobe.distribution.as_ref() == Some(&label);
            let entry = plan.materials.iter().flat_map(MaterialEntry::parts).find(has);
            let entry =
                entry.ok_or_else(|| BakeError::invalid(format!("no material has {label}")))?;
            Ok(Self::Distribution(distribution.clone(), entry))
        };
        let albedos = plan.albedos.iter().map(|need| Ok(Self::Albedo(need.clone())));
        plan.distributions.iter().map(of).chain(albedos).collect()
    }

    /// The name in messages.
    pub(super) fn name(&self) -> String {
        match self {
            Self::Normals(..) => {
                let specs = self.specs(Level::DEFAULT, Precision::F32);
                specs.into_iter().map(|spec| spec.name).collect::<Vec<_>>().join(" with ")
            }
            Self::Distribution(distribution, _) => distribution.label(),
            Self::Albedo(need) => Subject::of(stated(&need.lobe)).name(Kind::Albedo),
        }
    }

    /// The levels of a search: from the coarsest that is worth storing to the finest that single
    /// precision resolves, or that bakes in reasonable time.
    pub(super) fn levels(&self) -> std::ops::RangeInclusive<i32> {
        match self {
            Self::Normals(..) => -5 * Level::STEP..=3 * Level::STEP,
            _ => Level::from(Quality::Draft).0..=Level::from(Quality::High).0,
        }
    }

    /// The error expected before anything is measured: that of the default set in the three
    /// qualities, as `microfacet-bake bake --glass --out out --quality Q --precision P` prints it,
    /// and the error that fixed point adds.
    pub(super) fn expected(&self, level: Level, precision: Precision) -> f64 {
        let [single, fixed] = match self {
            Self::Normals(_, Parts::Shadowing) => [[7.5e-6, 4.0e-6, 1.4e-6], [2.5e-6; 3]],
            Self::Normals(_, Parts::Peeled) => [[4.3e-4, 7.0e-5, 2.6e-5], [5e-6; 3]],
            Self::Normals(_, Parts::Across) => [[2.9e-5, 2.6e-6, 4.0e-7], [1e-5; 3]],
            Self::Normals(..) => [[6.0e-4, 2.5e-5, 3.0e-6], [1.3e-3, 1.0e-3, 8.2e-4]],
            Self::Albedo(need) if need.coarse => [[7.9e-3, 1.8e-3, 9e-4], [1e-5; 3]],
            Self::Albedo(_) => [[2.3e-3, 1.8e-4, 2.6e-5], [1e-5; 3]],
            _ => [[2.4e-3, 8.5e-5, 1.1e-5], [5e-5, 5.5e-4, 1e-3]],
        };
        level.between(single) + if precision == Precision::F32 { 0.0 } else { level.between(fixed) }
    }

    /// Whether all precisions are measured at once: where the exact values to compare with are
    /// expensive, and for single shapes, whose rounding error differs much from that of the general
    /// set.
    pub(super) fn shares_measuring(&self) -> bool {
        !matches!(self, Self::Normals(need, _) if !need.gamma().is_point())
    }

    /// The specifications of the tables of visible normals; empty for other groups.
    fn specs(&self, level: Level, precision: Precision) -> Vec<TableSpec> {
        let Self::Normals(need, parts) = self else { return Vec::new() };
        let general = general_set(level, precision);
        parts.indices().iter().filter_map(|&i| need.cut(&general[i])).collect()
    }

    /// Draft tables without which those of the group make no lobe.
    fn other_specs(&self) -> Vec<TableSpec> {
        let Self::Normals(need, parts) = self else { return Vec::new() };
        let draft = general_set(Level::DRAFT, Precision::F32);
        parts.others().iter().filter_map(|&i| need.cut(&draft[i])).collect()
    }

    /// The bytes of a level in a file beyond those of the values, for names, axes and certificates.
    pub(super) fn header(&self, level: Level, precision: Precision, known: &mut Known) -> usize {
        match self {
            Self::Normals(..) => {
                self.specs(level, precision).iter().map(|spec| known.normals(spec)).sum()
            }
            Self::Distribution(distribution, _) => {
                known.radial(&distribution.label(), level, precision)
            }
            // An invalid specification counts 0 bytes; `cost` and the bake return its error.
            Self::Albedo(need) => need.spec(level, precision).map_or(0, |spec| known.albedo(&spec)),
        }
    }

    /// Bytes of the values alone; refinement of an albedo adds to them.
    pub(super) fn bytes(&self, level: Level, precision: Precision) -> usize {
        match self {
            Self::Normals(..) => self.specs(level, precision).iter().map(TableSpec::bytes).sum(),
            Self::Distribution(..) => radial_bytes(level, precision),
            Self::Albedo(need) => need.spec(level, precision).map_or(0, |spec| spec.bytes()),
        }
    }

    /// What the group is expected to add to a set in which `known` is described already.
    ///
    /// # Errors
    /// [`BakeError::Albedo`] for an albedo that no table can hold.
    pub(super) fn cost(
        &self,
        level: Level,
        precision: Precision,
        known: &mut Known,
    ) -> Result<Cost, BakeError> {
        let growth = match self {
            Self::Albedo(need) => growth(&need.spec(level, precision)?),
            _ => 1.0,
        };
        let values = (growth * self.bytes(level, precision) as f64) as usize;
        let seconds = on_threads(self.work(level, 1));
        Ok(Cost { bytes: values + self.header(level, precision, known), seconds })
    }

    /// Numbers of values held in memory during the bake.
    pub(super) fn values(&self, level: Level) -> Values {
        match self {
            Self::Albedo(need) => match need.spec(level, Precision::F32) {
                Ok(spec) => Values::of_albedo(&spec),
                Err(_) => Values::kept(0),
            },
            _ => Values::kept((self.bytes(level, Precision::F32) / Precision::F32.bytes()) as u128),
        }
    }

    /// The work of [`bake`](Self::bake) in a number of precisions, in estimated seconds of one
    /// thread.
    pub(super) fn work(&self, level: Level, precisions: usize) -> f64 {
        let sum = |[bake, certify]: [f64; 2]| bake + precisions as f64 * certify;
        match self {
            Self::Normals(..) => {
                let specs = self.specs(level, Precision::F32);
                let others = self.other_specs();
                specs.iter().map(|spec| sum(normals_work(spec))).sum::<f64>()
                    + others.iter().map(|spec| normals_work(spec)[0]).sum::<f64>()
            }
            Self::Distribution(distribution, _) => sum(radial_work(distribution, level)),
            Self::Albedo(need) => need
                .spec(level, Precision::F32)
                .map_or(0.0, |spec| AlbedoWork::new(&spec).expected(&spec)),
        }
    }
}
