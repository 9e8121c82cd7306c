//! Estimates the memory that a bake takes, before it begins.

use crate::bake::albedo::AlbedoSpec;

/// Bytes held per value while a set is made: the values as they are gathered, rounded and kept, and
/// the files they are written to. `docs/reliability.md` has the measurements.
const BYTES_PER_VALUE: u128 = 24;
/// Bytes of the program itself.
const BASE: u128 = 32 << 20;

/// The error for a set that would exceed the memory limit.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "baking {values} values would take about {} MiB of memory, more than the {} MiB allowed; ask \
     for fewer shapes (a range of gamma instead of many single ones), a lower quality, or allow \
     more",
    mib(*needed),
    mib((*limit).into())
)]
pub struct TooLarge {
    /// Number of values of all tables together.
    pub values: u128,
    /// Estimated bytes to bake them.
    pub needed: u128,
    /// Bytes allowed.
    pub limit: u64,
}

fn mib(bytes: u128) -> u128 {
    bytes.div_ceil(1 << 20)
}

/// Numbers of values of some tables.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Values {
    /// Kept until the set is written.
    pub kept: u128,
    /// Held in addition while these tables are baked.
    pub making: u128,
}

impl Values {
    /// Values of albedo tables: the channels of both forms of masking are held in double precision
    /// until all nodes are done, and refinement may double the nodes several times.
    pub fn of_albedo(spec: &AlbedoSpec) -> Self {
        let kept = (spec.bytes().div_ceil(spec.precision.bytes()) as u128) << spec.doublings();
        let all = (8 * spec.nodes() as u128) << spec.doublings();
        Self { kept, making: all.saturating_sub(kept) }
    }

    /// Values of tables whose bake holds nothing in addition.
    pub fn kept(kept: u128) -> Self {
        Self { kept, making: 0 }
    }

    /// The most values that are held at once if tables are made one group after the other.
    pub fn at_once(groups: impl IntoIterator<Item = Self>) -> u128 {
        let most = groups.into_iter().fold(Self::kept(0), |all, group| Self {
            kept: all.kept.saturating_add(group.kept),
            making: all.making.max(group.making),
        });
        most.kept.saturating_add(most.making)
    }
}

/// Checks that tables of so many values can be baked within `limit` bytes. The estimate is too
/// high, by half for large sets.
///
/// # Errors
/// [`TooLarge`] with the estimate.
pub fn check(values: u128, limit: u64) -> Result<(), TooLarge> {
    let needed = values.saturating_mul(BYTES_PER_VALUE).saturating_add(BASE);
    if needed <= limit.into() { Ok(()) } else { Err(TooLarge { values, needed, limit }) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bake::albedo::AlbedoLobe;
    use crate::bake::axes;
    use crate::table_spec::{Quality, TableSpec, general_set};
    use microfacet_sampler::Masking;
    use microfacet_tables::{Precision, Reflectance};

    #[test]
    fn values_are_counted_as_they_are_baked() {
        for spec in general_set(Quality::Default, Precision::F32) {
            let shape = axes(&spec).iter().map(|axis| axis.len() as u128).product::<u128>();
            assert_eq!(spec.values(), 2 * shape, "{}", spec.name);
        }
    }

    #[test]
    fn what_is_held_while_making_counts_for_the_largest_group_alone() {
        let small = Values { kept: 10, making: 80 };
        let large = Values { kept: 20, making: 160 };
        assert_eq!(Values::at_once([small, large, small, Values::kept(5)]), 45 + 160);
        assert_eq!(Values::at_once([]), 0);
    }

    #[test]
    fn ten_thousand_anisotropic_materials_fit_into_the_default_limit() {
        let lobe = AlbedoLobe::student_t([0.3, 0.1], 3.0);
        let (maskings, quality) = (vec![Masking::HeightCorrelated], Quality::Default);
        let spec = AlbedoSpec::new(lobe, Reflectance::Mirror, maskings, quality, Precision::F32);
        let one = Values::of_albedo(&spec.unwrap());
        assert_eq!(check(Values::at_once([one; 10_000]), 4 << 30), Ok(()));
        assert!(check(10_000 * Values::at_once([one]), 4 << 30).is_err());
        assert!(check(Values::at_once([one; 20_000]), 4 << 30).is_err());
    }

    #[test]
    fn a_million_million_nodes_are_refused_untouched() {
        let mut specs = general_set(Quality::High, Precision::F32);
        let all =
            |specs: &[TableSpec]| specs.iter().map(TableSpec::values).fold(0, u128::saturating_add);
        assert_eq!(check(all(&specs), 1 << 30), Ok(()));
        (specs[2].views, specs[2].numbers) = (1_000_000, 1_000_000);
        let refused = check(all(&specs), 1 << 30).unwrap_err();
        assert!(
            refused.values > 66_000_000_000_000 && refused.to_string().contains("1024 MiB"),
            "{refused}"
        );
        (specs[2].views, specs[2].numbers) = (usize::MAX, usize::MAX);
        assert!(check(all(&specs), u64::MAX).is_err());
    }
}
