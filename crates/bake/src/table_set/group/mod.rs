//! Table groups: tables that are chosen, baked, measured and kept together.

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
    Plan, RequiredAlbedo, RequiredShapes, albedo_headers, albedo_seconds, cost, distribution_cost,
    distribution_seconds, specs_seconds,
};
use crate::table_spec::{Level, Quality, TableSpec, general_set};

/// A group of tables, by what they hold.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(super) enum TableGroup {
    /// Visible normals and masking of some required shapes.
    Normals(RequiredShapes, Parts),
    /// A distribution outside the family, and a material that has it.
    Distribution(Distribution, MaterialEntry),
    /// A required albedo.
    Albedo(RequiredAlbedo),
}

/// Some of the tables of the general set.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(super) enum Parts {
    All,
    Shadowing,
    Slope,
    /// The shares of light that the peeled slopes use come from the masking: both go together.
    Peeled,
    Across,
}

impl Parts {
    /// Parts that can be refined apart from each other: the error of each does not depend on the
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

    /// The other tables that are required to make a material from these; no more, or the error at
    /// the seam between two tables would be that of the other one.
    fn beside(self) -> &'static [usize] {
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
    /// The groups of a plan at one quality.
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
            let has = |entry: &&MaterialEntry| entry.lobe.distribution.as_ref() == Some(&label);
            let entry = plan.materials.iter().find(has);
            let entry =
                entry.ok_or_else(|| BakeError::invalid(format!("no material has {label}")))?;
            Ok(Self::Distribution(distribution.clone(), entry.clone()))
        };
        let albedos = plan.albedos.iter().map(|need| Ok(Self::Albedo(need.clone())));
        plan.distributions.iter().map(of).chain(albedos).collect()
    }

    /// The group's name in messages.
    pub(super) fn name(&self) -> String {
        match self {
            Self::Normals(..) => {
                let names: Vec<String> =
                    self.specs(Level::DEFAULT).into_iter().map(|spec| spec.name).collect();
                names.join(" with ")
            }
            Self::Distribution(distribution, _) => distribution.label(),
            Self::Albedo(need) => Subject::of(stated(&need.lobe)).name(Kind::Albedo),
        }
    }

    /// Levels to choose from: from the coarsest that is worth storing to the finest that single
    /// precision resolves, or that time allows.
    pub(super) fn levels(&self) -> std::ops::RangeInclusive<i32> {
        match self {
            Self::Normals(..) => -5 * Level::STEP..=3 * Level::STEP,
            _ => Level::from(Quality::Draft).0..=Level::from(Quality::High).0,
        }
    }

    /// The error expected before anything is measured: that of the general set in the three
    /// qualities, as `microfacet-bake bake --out out --quality Q --precision P` prints it, and what
    /// fixed point adds.
    pub(super) fn expected(&self, level: Level, precision: Precision) -> f64 {
        let [single, fixed] = match self {
            Self::Normals(_, Parts::Shadowing) => [[7.5e-6, 4.0e-6, 1.4e-6], [2.5e-6; 3]],
            Self::Normals(_, Parts::Peeled) => [[4.3e-4, 7.0e-5, 2.6e-5], [5e-6; 3]],
            Self::Normals(_, Parts::Across) => [[2.9e-5, 2.6e-6, 4.0e-7], [1e-5; 3]],
            Self::Normals(..) => [[6.0e-4, 2.5e-5, 3.0e-6], [1.3e-3, 1.0e-3, 8.2e-4]],
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

    /// Specifications of the tables of visible normals; empty for other groups.
    fn specs(&self, level: Level) -> Vec<TableSpec> {
        let Self::Normals(need, parts) = self else { return Vec::new() };
        let general = general_set(level, Precision::F32);
        parts.indices().iter().filter_map(|&i| need.cut(&general[i])).collect()
    }

    /// The estimated bytes of a level in a file, before refinement of an albedo.
    pub(super) fn file_bytes(&self, level: Level, precision: Precision) -> usize {
        match self {
            Self::Normals(..) => {
                let at = |spec: TableSpec| TableSpec { precision, ..spec };
                cost(&self.specs(level).into_iter().map(at).collect::<Vec<_>>()).bytes
            }
            Self::Distribution(distribution, _) => {
                distribution_cost(distribution, level, precision).bytes
            }
            // An invalid specification costs nothing here; the bake reports what is wrong with it.
            Self::Albedo(need) => {
                need.spec(level, precision).map_or(0, |spec| spec.bytes() + albedo_headers(&spec))
            }
        }
    }

    /// The estimated seconds of one thread to bake a level and to certify it once.
    pub(super) fn seconds(&self, level: Level) -> f64 {
        match self {
            Self::Normals(..) => specs_seconds(&self.specs(level)).iter().sum(),
            Self::Distribution(distribution, _) => {
                distribution_seconds(distribution, level).iter().sum()
            }
            Self::Albedo(need) => {
                need.spec(level, Precision::F32).map_or(0.0, |spec| albedo_seconds(&spec))
            }
        }
    }

    /// Bytes of the values alone; refinement of an albedo adds to them.
    pub(super) fn bytes(&self, level: Level, precision: Precision) -> usize {
        match self {
            Self::Normals(..) => {
                let at = |spec: TableSpec| TableSpec { precision, ..spec }.bytes();
                self.specs(level).into_iter().map(at).sum()
            }
            Self::Distribution(..) => radial_bytes(level, precision),
            Self::Albedo(need) => need.spec(level, precision).map_or(0, |spec| spec.bytes()),
        }
    }

    /// Numbers of values held in memory during the bake.
    pub(super) fn values(&self, level: Level) -> Values {
        let none = Values::kept(0);
        match self {
            Self::Normals(..) => {
                Values::kept(self.specs(level).iter().map(TableSpec::values).sum())
            }
            Self::Distribution(..) => {
                Values::kept((radial_bytes(level, Precision::F32) / 4) as u128)
            }
            Self::Albedo(need) => {
                let spec = need.spec(level, Precision::F32);
                spec.map_or(none, |spec| Values::of_albedo(&spec))
            }
        }
    }

    /// Draft tables that make a material together with those of a part of the set.
    fn beside(&self) -> Vec<TableSpec> {
        let Self::Normals(need, parts) = self else { return Vec::new() };
        let draft = general_set(Level::DRAFT, Precision::F32);
        parts.beside().iter().filter_map(|&i| need.cut(&draft[i])).collect()
    }

    /// The work of [`bake`](Self::bake) in so many precisions, in estimated seconds of one thread.
    pub(super) fn work(&self, level: Level, precisions: usize) -> f64 {
        let sum = |[bake, certify]: [f64; 2]| bake + precisions as f64 * certify;
        match self {
            Self::Normals(..) => {
                sum(specs_seconds(&self.specs(level))) + specs_seconds(&self.beside())[0]
            }
            Self::Distribution(distribution, _) => sum(distribution_seconds(distribution, level)),
            Self::Albedo(_) => self.seconds(level),
        }
    }
}
