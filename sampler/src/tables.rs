//! A set of tables, and what can be asked of it.

use alloc::string::{String, ToString};
use alloc::vec::Vec;

use microfacet_common::shape::s_of_gamma;

use crate::error::{BindError, LoadError};
use crate::format::{Kind, LobeEntry, MaterialEntry, Provenance, Table, decode};
use crate::material::{Ellipsoid, Radial, Roughness, Skew, StudentT, covers};

/// A set of tables, loaded and checked.
///
/// ```
/// use glam::Vec3;
/// use microfacet_sampler::Tables;
/// # #[cfg(feature = "embedded")] {
/// let tables = Tables::embedded();
/// let glass = tables.student_t(0.454, 3.0)?;
/// let v = Vec3::new(0.6, 0.0, 0.8);
/// let m = glass.sample_visible_normal(v, [0.3, 0.7]);
/// assert!(v.dot(m) > 0.0 && glass.visible_normal_pdf(v, m) > 0.0);
/// # }
/// # Ok::<(), microfacet_sampler::BindError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Tables {
    provenance: Provenance,
    tables: Vec<Table>,
}

impl Tables {
    /// The default set, compiled in: all γ ∈ [1.501, ∞].
    ///
    /// Decodes about 1 MB in well under a millisecond; keep the result. The checksum is skipped, since the bytes are part of
    /// the program.
    #[cfg(feature = "embedded")]
    pub fn embedded() -> Self {
        let bytes = include_bytes!("../../tables/default.safetensors");
        let (provenance, tables) = decode(bytes, false).expect("the embedded tables are tested");
        Self { provenance, tables }
    }

    /// Reads a set from the bytes of a safetensors file written by `microfacet-bake`.
    ///
    /// # Errors
    /// [`LoadError::Invalid`] for bytes that are damaged, truncated or something else, [`LoadError::Unsupported`] for another version of the
    /// format. Every part is checked, the checksum included; no input makes it panic or allocate more than a few times its size.
    pub fn from_bytes(bytes: &[u8]) -> Result<Self, LoadError> {
        let (provenance, tables) = decode(bytes, true)?;
        Ok(Self { provenance, tables })
    }

    /// A set made of tables at hand, such as those a bake has just filled.
    ///
    /// # Errors
    /// [`LoadError::Invalid`] if one of them is not sound.
    pub fn from_tables(provenance: Provenance, tables: Vec<Table>) -> Result<Self, LoadError> {
        for table in &tables {
            table.validate()?;
        }
        Ok(Self { provenance, tables })
    }

    /// The tables of the set.
    pub fn tables(&self) -> &[Table] {
        &self.tables
    }

    /// The first table of a kind.
    pub fn table(&self, kind: Kind) -> Option<&Table> {
        self.tables.iter().find(|table| table.kind == kind)
    }

    /// Where the set comes from.
    pub fn provenance(&self) -> &Provenance {
        &self.provenance
    }

    /// Whether γ can be bound; γ = 2 always can.
    pub fn covers(&self, gamma: f64) -> bool {
        let s = s_of_gamma(gamma);
        let has = |kind| self.tables.iter().any(|table| table.kind == kind && covers(table, s));
        let tabulated = has(Kind::Shadowing)
            && has(Kind::VisibleSlopeConditional)
            && (has(Kind::VisibleSlope) || has(Kind::VisibleSlopePeeled));
        gamma == 2.0 || gamma > 1.5 && tabulated
    }

    /// Binds a material: σ ∈ [1e-8, 1e6] (one number, or a pair for x and y) and γ ∈ (3/2, ∞] are fixed, and the γ axis is collapsed there.
    ///
    /// γ = 2 is GGX with α = σ, γ = `f64::INFINITY` is Beckmann. Where no table covers γ = 2 the material is [`StudentT::ggx`]. γ is
    /// taken in double precision, since near 3/2 single precision is too coarse for it. Takes some microseconds and holds about
    /// 20 KiB; [`StudentT::with_roughness`] is cheaper for a material that differs in σ only.
    ///
    /// # Errors
    /// [`BindError`] for a σ or γ outside the family, or a γ that this set does not cover.
    pub fn student_t(
        &self,
        sigma: impl Into<Roughness>,
        gamma: f64,
    ) -> Result<StudentT, BindError> {
        let sigma = sigma.into();
        match StudentT::bind(&self.tables, sigma, gamma) {
            Err(BindError::NotCovered { .. }) if gamma == 2.0 => StudentT::ggx(sigma),
            bound => bound,
        }
    }

    /// Binds an ellipsoid: a lobe of shape γ ∈ (3/2, ∞] seen through a matrix, tilted and turned; see [`Ellipsoid`].
    ///
    /// It reads the same tables as [`student_t`](Self::student_t), at γ = 2 too.
    ///
    /// # Errors
    /// [`BindError`] for a matrix that is not finite or (almost) singular, a γ outside the family, or one that this set does not cover.
    pub fn ellipsoid(&self, skew: Skew, gamma: f64) -> Result<Ellipsoid, BindError> {
        Ellipsoid::bind(StudentT::bind(&self.tables, 1.0.into(), gamma)?, skew)
    }

    /// This set with the default set behind it: shapes that its own tables do not cover are read from those compiled in.
    ///
    /// For lookups; names of tables may then repeat, which a file does not allow.
    #[cfg(feature = "embedded")]
    pub fn or_embedded(mut self) -> Self {
        self.tables.extend(Self::embedded().tables);
        self
    }

    /// Binds a material of the set's recipe by its name.
    ///
    /// Where the recipe gives ranges, the middle of σ and of s = 1/(γ−1) is bound; use [`student_t`](Self::student_t) for others.
    ///
    /// # Errors
    /// [`BindError::NoSuchMaterial`] naming those that exist, or what [`student_t`](Self::student_t) reports.
    pub fn material(&self, name: &str) -> Result<StudentT, BindError> {
        let entry = self.student_t_entry(name)?;
        self.student_t(entry.sigma(), entry.gamma())
    }

    /// Binds a material of the set's recipe that is an ellipsoid: one that states `theta`.
    ///
    /// # Errors
    /// [`BindError::NoSuchMaterial`], [`BindError::OtherDistribution`] for another material, or what [`ellipsoid`](Self::ellipsoid) reports.
    pub fn material_ellipsoid(&self, name: &str) -> Result<Ellipsoid, BindError> {
        let entry = self.entry(name)?;
        let Some(theta) = entry.theta else { return Err(other_lobe(entry)) };
        self.ellipsoid(Skew::new(entry.sigma(), theta)?, entry.gamma())
    }

    /// Binds a material of the set's recipe that is no Student-t, such as a GTR or a measured one.
    ///
    /// # Errors
    /// [`BindError::NoSuchMaterial`], or [`BindError::OtherDistribution`] for a Student-t.
    pub fn radial(&self, name: &str) -> Result<Radial, BindError> {
        let entry = self.entry(name)?;
        if entry.distribution.is_empty() {
            return Err(other_lobe(entry));
        }
        Radial::bind(&self.tables, entry.sigma[0][0] as f32, &entry.lobe())
    }

    /// The entry of a material that is a Student-t.
    pub(crate) fn student_t_entry(&self, name: &str) -> Result<&MaterialEntry, BindError> {
        let entry = self.entry(name)?;
        let plain = matches!(entry.lobe(), LobeEntry::Family | LobeEntry::StudentT { .. });
        if plain { Ok(entry) } else { Err(other_lobe(entry)) }
    }

    pub(crate) fn entry(&self, name: &str) -> Result<&MaterialEntry, BindError> {
        let materials = &self.provenance.materials;
        materials.iter().find(|entry| entry.name == name).ok_or_else(|| {
            // A scene may have thousands.
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

/// The material exists, but is of another kind than was asked for.
fn other_lobe(entry: &MaterialEntry) -> BindError {
    BindError::OtherDistribution {
        name: entry.name.clone(),
        distribution: entry.lobe().name().into(),
    }
}
