//! A set of tables, and the lobes made from it.

use alloc::collections::BTreeMap;
use alloc::format;
use alloc::string::{String, ToString};
use alloc::vec::Vec;

use microfacet_core::shape::s_of_gamma;
use microfacet_core::{Roughness, Skew};
use microfacet_tables::{
    Interval, Kind, LoadError, LobeSpec, MaterialEntry, Provenance, Table, decode,
};

use crate::bind_error::BindError;
use crate::error::MaterialError;
use crate::material::{Ellipsoid, Family, Ggx, Lobe, Radial, Smooth, StudentT, coverage};

/// The default set as the bytes of a safetensors file.
#[cfg(feature = "embedded")]
pub const DEFAULT_SET: &[u8] = include_bytes!("../data/default.safetensors");

/// A set of tables, loaded and checked.
///
/// ```
/// use microfacet_sampler::{MicrofacetDistribution, Tables};
/// # #[cfg(feature = "embedded")] {
/// let tables = Tables::embedded();
/// let glass = tables.student_t(0.454, 3.0)?;
/// let v = [0.6, 0.0, 0.8];
/// let (m, pdf) = glass.sample_with_pdf(v, [0.3, 0.7]);
/// assert!(m[2] > 0.0 && pdf > 0.0);
/// # }
/// # Ok::<(), microfacet_sampler::MaterialError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Tables {
    provenance: Provenance,
    /// The tables of the set, then those of its [fallback](Tables::with_fallback).
    tables: Vec<Table>,
    own: usize,
}

impl Tables {
    /// The default set, compiled in: all γ ∈ [1.501, ∞], and albedos of metals over all σ and of
    /// common dielectrics and plastics: of index 1.3 to 1.7 (or of its inverse), γ ≥ 2 and σ ≤ 1,
    /// with height-correlated masking.
    ///
    /// The call decodes 2 MB in about a millisecond; keep the result. The checksum is
    /// skipped, since the bytes are part of the program.
    #[cfg(feature = "embedded")]
    #[must_use]
    pub fn embedded() -> Self {
        let (provenance, tables) =
            decode(DEFAULT_SET, false).expect("the embedded tables are tested");
        Self::of(provenance, tables)
    }

    /// Reads a set from the bytes of a safetensors file written by `microfacet-bake`.
    ///
    /// # Errors
    /// [`LoadError::Invalid`] for bytes that are damaged, truncated or no table set,
    /// [`LoadError::Unsupported`] for another version of the format. Everything is checked, the
    /// checksum included; no input causes a panic, or an allocation of more than a few times its
    /// size.
    pub fn from_bytes(bytes: &[u8]) -> Result<Self, LoadError> {
        let (provenance, tables) = decode(bytes, true)?;
        Ok(Self::of(provenance, tables))
    }

    /// Makes a set from tables, such as those that a bake has just filled.
    ///
    /// # Errors
    /// [`LoadError::Invalid`] if one of them is not valid.
    pub fn from_tables(provenance: Provenance, tables: Vec<Table>) -> Result<Self, LoadError> {
        for table in &tables {
            table.validate()?;
        }
        Ok(Self::of(provenance, tables))
    }

    fn of(provenance: Provenance, tables: Vec<Table>) -> Self {
        Self { provenance, own: tables.len(), tables }
    }

    /// This set with another one behind it: lookups that its own tables do not cover are made in
    /// those of `fallback`, such as the [default set](Self::embedded).
    ///
    /// For lookups alone: [`tables`](Self::tables), names of materials and what is written to a
    /// file remain those of the set itself. A second fallback comes behind the first.
    #[must_use]
    pub fn with_fallback(mut self, fallback: &Self) -> Self {
        self.tables.extend_from_slice(&fallback.tables);
        self
    }

    /// The set of the named materials alone, without tables that none of them reads.
    ///
    /// # Errors
    /// [`BindError::NoSuchMaterial`] naming those that exist.
    pub fn only(mut self, names: &[&str]) -> Result<Self, BindError> {
        let mut kept: Vec<MaterialEntry> = Vec::new();
        for (i, name) in names.iter().enumerate() {
            if !names[..i].contains(name) {
                kept.push(self.entry(name)?.clone());
            }
        }
        let lobes = kept.iter().flat_map(MaterialEntry::lobes);
        let lobes: Vec<LobeSpec> = lobes.map(LobeSpec::tabulated).collect();
        let fallback = self.tables.split_off(self.own);
        self.tables.retain(|Table { subject, .. }| {
            subject.lobe.is_family() || lobes.iter().any(|lobe| subject.lobe.contains(lobe))
        });
        self.own = self.tables.len();
        self.tables.extend(fallback);
        self.provenance.materials = kept;
        Ok(self)
    }

    /// One set of the materials and tables of several sets, without their fallbacks; a table that
    /// several of them have is kept once.
    ///
    /// # Errors
    /// [`LoadError::Invalid`] if two sets have different tables, or different materials, of the
    /// same name, or were baked by different numeric methods.
    pub fn joined(sets: impl IntoIterator<Item = Self>) -> Result<Self, LoadError> {
        let mut sets = sets.into_iter().map(|mut set| {
            set.tables.truncate(set.own);
            set
        });
        let Some(mut all) = sets.next() else {
            return Self::from_tables(Provenance::default(), Vec::new());
        };
        let different = |what: &str, name: &str| {
            LoadError::Invalid(format!(
                "two sets have different {what} `{name}`: join those of one bake"
            ))
        };
        let named = |tables: &[Table]| -> BTreeMap<String, usize> {
            tables.iter().enumerate().map(|(i, table)| (table.name.clone(), i)).collect()
        };
        let mut known = named(&all.tables);
        for Self { provenance, tables, .. } in sets {
            if provenance.numerics != all.provenance.numerics {
                return Err(different("numeric methods", &provenance.generator));
            }
            for table in tables {
                match known.get(&table.name) {
                    Some(&i) if all.tables[i] == table => {}
                    Some(_) => return Err(different("tables", &table.name)),
                    None => {
                        known.insert(table.name.clone(), all.tables.len());
                        all.tables.push(table);
                    }
                }
            }
            all.provenance.materials.extend(provenance.materials);
            all.provenance.conventions.extend(provenance.conventions);
        }
        all.provenance.check()?;
        all.own = all.tables.len();
        Ok(all)
    }

    /// The tables of the set.
    #[must_use]
    pub fn tables(&self) -> &[Table] {
        &self.tables[..self.own]
    }

    /// The tables in which lookups search: those of the set, then those of its fallback.
    pub(crate) fn searched(&self) -> &[Table] {
        &self.tables
    }

    /// The first table of a kind in the set itself, not in its fallback.
    #[must_use]
    pub fn table(&self, kind: Kind) -> Option<&Table> {
        self.tables().iter().find(|table| table.kind == kind)
    }

    /// Where the set comes from.
    #[must_use]
    pub fn provenance(&self) -> &Provenance {
        &self.provenance
    }

    /// Whether [`lobe`](Self::lobe) serves the shape γ; it always serves γ = 2.
    #[must_use]
    pub fn covers(&self, gamma: f64) -> bool {
        gamma == 2.0 || self.tabulates(gamma)
    }

    /// Whether [`student_t`](Self::student_t) and [`ellipsoid`](Self::ellipsoid) serve the shape γ.
    #[must_use]
    pub fn tabulates(&self, gamma: f64) -> bool {
        gamma > 1.5 && coverage::contains(&self.tables, s_of_gamma(gamma))
    }

    /// The shapes that [`student_t`](Self::student_t) serves, as ascending, disjoint ranges [min,
    /// max] of s = 1/(γ−1); a single shape is a range of no width.
    ///
    /// A lobe needs tables of several kinds; these are the shapes that all of them cover.
    #[must_use]
    pub fn shapes(&self) -> Vec<[f64; 2]> {
        coverage::shapes(&self.tables)
    }

    /// The Student-t lobe of roughness σ ∈ [1e-8, 1e6] (one number, or a pair for x and y) and
    /// shape γ ∈ (3/2, ∞], read from the tables.
    ///
    /// γ = 2 is GGX with α = σ, γ = `f64::INFINITY` is Beckmann. γ is taken in double precision
    /// because single precision is too coarse near 3/2. The γ axis is collapsed here, which takes
    /// some microseconds and about 20 KiB; [`StudentT::with_roughness`] is cheaper for a lobe that
    /// differs in σ only.
    ///
    /// # Errors
    /// [`MaterialError`] for a σ or γ outside the family, or a γ that this set does not cover; the
    /// set of a scene of GGX alone has no tables, see [`lobe`](Self::lobe).
    pub fn student_t(
        &self,
        sigma: impl Into<Roughness>,
        gamma: f64,
    ) -> Result<StudentT, MaterialError> {
        StudentT::from_tables(&self.tables, sigma.into(), gamma)
    }

    /// Lobes of every σ and γ, read from the tables at each hit: for textures of roughness and of
    /// γ. It is prepared here, once for a set, in some milliseconds.
    ///
    /// It reads tables over ranges of γ, such as those of the default set or of a material whose γ
    /// is a range; of several tables of one kind, fallbacks included, that of the widest range.
    ///
    /// # Errors
    /// [`MaterialError::NoRange`] for a set of single shapes.
    pub fn family(&self) -> Result<Family, MaterialError> {
        Family::from_tables(&self.tables)
    }

    /// The lobe of [`student_t`](Self::student_t), or [`Ggx`] in closed form for γ = 2 where no
    /// table covers it; σ = 0 is [`Smooth`].
    ///
    /// # Errors
    /// As [`student_t`](Self::student_t).
    pub fn lobe(&self, sigma: impl Into<Roughness>, gamma: f64) -> Result<Lobe, MaterialError> {
        let sigma = sigma.into();
        if sigma.0 == [0.0; 2] {
            return if gamma > 1.5 { Ok(Smooth.into()) } else { Err(MaterialError::Gamma(gamma)) };
        }
        match self.student_t(sigma, gamma) {
            Err(MaterialError::NotCovered { .. }) if gamma == 2.0 => Ok(Ggx::new(sigma)?.into()),
            lobe => Ok(lobe?.into()),
        }
    }

    /// An ellipsoid: a Student-t lobe of shape γ ∈ (3/2, ∞], tilted and turned by a matrix.
    ///
    /// It reads the same tables as [`student_t`](Self::student_t), at γ = 2 too.
    ///
    /// # Errors
    /// [`MaterialError`] for a γ outside the family, or one that this set does not cover.
    pub fn ellipsoid(&self, skew: Skew, gamma: f64) -> Result<Ellipsoid, MaterialError> {
        Ellipsoid::new(self.student_t(1.0, gamma)?, skew)
    }

    /// The lobe of a named material of the set's recipe, whatever its distribution: the core of one
    /// with [haze](Self::material_haze).
    ///
    /// A range in the recipe is taken at its middle, of σ and of s = 1/(γ−1). At the hits of a
    /// texture use [`StudentT::with_roughness`] or [`family`](Self::family), for single values
    /// [`lobe`](Self::lobe).
    ///
    /// # Errors
    /// [`BindError::NoSuchMaterial`] naming those that exist, or what [`lobe`](Self::lobe) and
    /// [`ellipsoid`](Self::ellipsoid) report.
    pub fn material(&self, name: &str) -> Result<Lobe, BindError> {
        self.lobe_of(&self.entry(name)?.lobe)
    }

    /// The lobe of the haze around a named material, and its weight in [0, 1]; `None` for a
    /// material without haze. Ranges are taken at their middle, as by
    /// [`material`](Self::material), which has the core. [`bsdf`](Self::bsdf) makes a
    /// [`Haze`](crate::Haze) of both.
    ///
    /// # Errors
    /// What [`material`](Self::material) reports.
    pub fn material_haze(&self, name: &str) -> Result<Option<(Lobe, f32)>, BindError> {
        let Some(haze) = &self.entry(name)?.haze else { return Ok(None) };
        Ok(Some((self.lobe_of(&haze.lobe)?, middle(haze.weight))))
    }

    fn lobe_of(&self, lobe: &LobeSpec) -> Result<Lobe, BindError> {
        match (lobe.theta, &lobe.distribution) {
            (Some(theta), _) => {
                let skew = Skew::new(lobe.sigma(), theta)?;
                Ok(self.ellipsoid(skew, lobe.gamma())?.into())
            }
            (None, None) => Ok(self.lobe(lobe.sigma(), lobe.gamma())?),
            (None, Some(label)) => {
                let sigma = lobe.roughness.x().min as f32;
                Ok(Radial::from_tables(&self.tables, sigma, label)?.into())
            }
        }
    }

    pub(crate) fn entry(&self, name: &str) -> Result<&MaterialEntry, BindError> {
        let materials = &self.provenance.materials;
        materials.iter().find(|entry| entry.name == name).ok_or_else(|| {
            // A scene may have thousands of materials.
            const SHOWN: usize = 12;
            let mut known: Vec<String> = materials
                .iter()
                .take(SHOWN)
                .map(|entry| alloc::format!("\"{}\"", entry.name))
                .collect();
            if materials.len() > SHOWN {
                known.push(alloc::format!("{} more", materials.len() - SHOWN));
            }
            let known =
                if known.is_empty() { "no named materials".to_string() } else { known.join(", ") };
            BindError::NoSuchMaterial { name: name.into(), known }
        })
    }
}

/// The middle of a share of light.
pub(crate) fn middle(share: Interval) -> f32 {
    (0.5 * (share.min + share.max)) as f32
}
