//! The tables that are refined together: the group in which they are chosen, baked, measured and
//! kept.

mod bake;

use microfacet_sampler::{MaterialEntry, Precision};

use super::BakeError;
use crate::bake::{joined_name, radial_bytes};
use crate::distribution::Distribution;
use crate::memory;
use crate::plan::{
    Cost, Plan, RequiredAlbedo, RequiredShapes, albedo_cost, cost, distribution_cost, seconds,
};
use crate::table_spec::{Level, Quality, TableSpec, general_set};

/// What the tables are of.
pub(super) enum TableGroup<'a> {
    /// Visible normals and masking of a need.
    Normals(&'a RequiredShapes, Parts),
    /// A distribution outside the family, and a material that has it.
    Distribution(&'a Distribution, MaterialEntry),
    /// Albedos.
    Albedo(&'a RequiredAlbedo),
}

/// Some of the tables of the general set.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Parts {
    All,
    Shadowing,
    Slope,
    /// The shares of light that slopes are peeled by come from the masking: both together.
    Peeled,
    Across,
}

impl Parts {
    /// Those that can be refined apart from each other: what each is measured by does not depend on
    /// the others.
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

    /// Those that a material needs beside them to be bound; no others, or the seam between two
    /// tables would be measured on the other one.
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

impl<'a> TableGroup<'a> {
    /// The groups of a plan at one quality.
    pub(super) fn whole(plan: &'a Plan) -> Result<Vec<Self>, BakeError> {
        let normals = plan.shapes.iter().map(|need| Self::Normals(need, Parts::All));
        Ok(normals.chain(Self::others(plan)?).collect())
    }

    /// As many groups of a plan as there can be.
    pub(super) fn apart(plan: &'a Plan) -> Result<Vec<Self>, BakeError> {
        let parts = |need| Parts::APART.map(|parts| Self::Normals(need, parts));
        let normals = plan.shapes.iter().flat_map(parts);
        let some = |group: &Self| group.values(Level::DEFAULT) > 0;
        Ok(normals.filter(some).chain(Self::others(plan)?).collect())
    }

    fn others(plan: &'a Plan) -> Result<Vec<Self>, BakeError> {
        let of = |distribution: &'a Distribution| {
            let label = distribution.label();
            let entry = plan.materials.iter().find(|entry| entry.distribution == label);
            let entry =
                entry.ok_or_else(|| BakeError::invalid(format!("no material has {label}")))?;
            Ok(Self::Distribution(distribution, entry.clone()))
        };
        let albedos = plan.albedos.iter().map(|need| Ok(Self::Albedo(need)));
        plan.distributions.iter().map(of).chain(albedos).collect()
    }

    /// What messages call it.
    pub(super) fn name(&self) -> String {
        match self {
            Self::Normals(..) => {
                let names: Vec<String> =
                    self.specs(Level::DEFAULT).into_iter().map(|spec| spec.name).collect();
                names.join(" with ")
            }
            Self::Distribution(distribution, _) => distribution.label(),
            Self::Albedo(need) => joined_name(&["albedo", &need.lobe.label()]),
        }
    }

    /// Levels that there are to choose from: as coarse as is worth storing at all, and as fine as
    /// single precision resolves, or as time allows.
    pub(super) fn levels(&self) -> std::ops::RangeInclusive<i32> {
        match self {
            Self::Normals(..) => -5 * Level::STEP..=3 * Level::STEP,
            _ => Level::from(Quality::Draft).0..=Level::from(Quality::High).0,
        }
    }

    /// The error to expect, before anything is measured: of the general set in the three qualities,
    /// as `microfacet-bake bake --out out --quality Q --precision P` prints it, and what fixed
    /// point adds.
    pub(super) fn expected(&self, level: Level, precision: Precision) -> f64 {
        let [single, fixed] = match self {
            Self::Normals(_, Parts::Shadowing) => [[7.5e-6, 4.0e-6, 1.4e-6], [2.5e-6; 3]],
            Self::Normals(_, Parts::Peeled) => [[5.8e-4, 2.1e-4, 3.2e-5], [5e-6; 3]],
            Self::Normals(_, Parts::Across) => [[2.9e-5, 2.6e-6, 4.0e-7], [1e-5; 3]],
            Self::Albedo(_) => [[2.3e-3, 1.8e-4, 2.6e-5], [1e-5; 3]],
            _ => [[2.4e-3, 8.5e-5, 1.1e-5], [5e-5, 5.5e-4, 1e-3]],
        };
        level.between(single) + if precision == Precision::F32 { 0.0 } else { level.between(fixed) }
    }

    /// Whether all precisions are measured at once: where the exact values that they are compared
    /// with are dear, and of single shapes, whose rounding differs much from that of the general
    /// set.
    pub(super) fn shares_measuring(&self) -> bool {
        !matches!(self, Self::Normals(need, _) if !need.gamma().is_point())
    }

    /// Specifications of the tables of visible normals; none of other groups.
    fn specs(&self, level: Level) -> Vec<TableSpec> {
        let Self::Normals(need, parts) = self else { return Vec::new() };
        let general = general_set(level, Precision::F32);
        parts.indices().iter().filter_map(|&i| need.cut(&general[i])).collect()
    }

    /// What a level is estimated to cost.
    pub(super) fn cost(&self, level: Level, precision: Precision) -> Cost {
        match self {
            Self::Normals(..) => {
                let at = |spec: TableSpec| TableSpec { precision, ..spec };
                cost(&self.specs(level).into_iter().map(at).collect::<Vec<_>>())
            }
            Self::Distribution(distribution, _) => {
                distribution_cost(distribution, level, precision)
            }
            // What is no specification is no table either; baking says why.
            Self::Albedo(need) => need
                .spec(level, precision)
                .map_or(Cost { bytes: 0, seconds: 0.0 }, |spec| albedo_cost(&spec)),
        }
    }

    /// Seconds that a level is estimated to take.
    pub(super) fn seconds(&self, level: Level) -> f64 {
        match self {
            Self::Normals(..) => seconds(&self.specs(level)),
            _ => self.cost(level, Precision::F32).seconds,
        }
    }

    /// Bytes of the values alone; those of an albedo that is refined become more.
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

    /// Values that are held in memory while it is baked.
    pub(super) fn values(&self, level: Level) -> u128 {
        match self {
            Self::Normals(..) => self.specs(level).iter().map(TableSpec::values).sum(),
            Self::Distribution(..) => (radial_bytes(level, Precision::F32) / 4) as u128,
            Self::Albedo(need) => {
                need.spec(level, Precision::F32).map_or(0, |spec| memory::of_albedo(&spec))
            }
        }
    }

    /// Steps of its progress.
    pub(super) fn steps(&self) -> usize {
        match self {
            // Each table, and the certificate.
            Self::Normals(need, parts) => {
                let general = general_set(Quality::Draft, Precision::F32);
                parts.indices().iter().filter(|&&i| need.cut(&general[i]).is_some()).count() + 1
            }
            _ => 1,
        }
    }
}
