//! Tables that come in grades, three qualities in two precisions: those of albedos, and of distributions outside the family.
//!
//! 16-bit fixed point is the only small precision to choose: half precision takes the same bytes, and its error, 3e-4 to 1e-3 of a value,
//! is above that of fixed point in every such table that was measured.

use microfacet_sampler::{MaterialEntry, Precision, Provenance, Table};

use crate::bake::{joined_name, radial_bytes};
use crate::family::Distribution;
use crate::generate::{BakeError, Job, albedo_tables, radial_tables, worst_error};
use crate::plan::AlbedoNeed;
use crate::spec::Quality;

const QUALITIES: [Quality; 3] = [Quality::Draft, Quality::Default, Quality::High];
const PRECISIONS: [Precision; 2] = [Precision::U16, Precision::F32];

/// What such tables are of.
pub(crate) enum Graded<'a> {
    /// Albedos.
    Albedo(&'a AlbedoNeed),
    /// A distribution outside the family, and a material that has it.
    Distribution(&'a Distribution, &'a MaterialEntry),
}

impl<'a> Graded<'a> {
    /// The four tables of a distribution that a material of the set has.
    pub(crate) fn distribution(
        distribution: &'a Distribution,
        provenance: &'a Provenance,
    ) -> Result<Self, BakeError> {
        let label = distribution.label();
        let entry = provenance.materials.iter().find(|entry| entry.distribution == label);
        match entry {
            Some(entry) => Ok(Self::Distribution(distribution, entry)),
            None => Err(BakeError::invalid(format!("no material has the distribution {label}"))),
        }
    }

    /// What messages call it.
    pub(crate) fn name(&self) -> String {
        match self {
            Self::Albedo(need) => joined_name(&["albedo", &need.lobe.label()]),
            Self::Distribution(distribution, _) => distribution.label(),
        }
    }

    /// What the tables are kept under; all that decides over their values.
    pub(crate) fn key(&self, quality: Quality, precision: Precision) -> String {
        match self {
            Self::Albedo(need) => format!("{:?}", need.spec(quality, precision)),
            // Its values, too: two measured files may have the same name.
            Self::Distribution(distribution, _) => {
                format!("{distribution:?}, {}, {quality:?}, {precision:?}", distribution.label())
            }
        }
    }

    /// Bytes of the values, known before they are baked; a dielectric's, or those of a lobe that is not round, may become more.
    fn bytes(&self, quality: Quality, precision: Precision) -> usize {
        match self {
            // What is no specification is no table either; baking says why.
            Self::Albedo(need) => need.spec(quality, precision).map_or(0, |spec| spec.bytes()),
            Self::Distribution(..) => radial_bytes(quality, precision),
        }
    }

    /// The certified tables of a quality, kept or new, in each of some precisions.
    pub(crate) fn bake(
        &self,
        quality: Quality,
        precisions: &[Precision],
        job: &mut Job,
    ) -> Result<Vec<Vec<Table>>, BakeError> {
        let keys: Vec<String> = precisions.iter().map(|&precision| self.key(quality, precision)).collect();
        job.kept_each(&keys, || match self {
            Self::Albedo(need) => {
                let spec = need.spec(quality, Precision::F32).map_err(BakeError::Albedo)?;
                albedo_tables(&spec, precisions)
            }
            Self::Distribution(distribution, entry) => {
                radial_tables(distribution, entry, quality, precisions)
            }
        })
    }
}

/// One quality in one precision.
struct Grade {
    quality: Quality,
    precision: Precision,
    /// Of the values alone.
    bytes: usize,
    /// The tables, once they were needed.
    tables: Option<Vec<Table>>,
}

/// The grades, the smallest first, each measured when it is asked for.
pub(crate) struct Choice<'a> {
    of: &'a Graded<'a>,
    grades: Vec<Grade>,
}

impl<'a> Choice<'a> {
    pub(crate) fn new(of: &'a Graded<'a>) -> Self {
        let grade = |quality, precision| Grade {
            quality,
            precision,
            bytes: of.bytes(quality, precision),
            tables: None,
        };
        let all = QUALITIES.iter().flat_map(|&quality| PRECISIONS.map(|precision| grade(quality, precision)));
        let mut grades: Vec<Grade> = all.collect();
        grades.sort_by_key(|grade| grade.bytes);
        Self { of, grades }
    }

    /// The tables of the smallest grade that errs by no more than `max_error`; nothing if none does, or if its values have more than
    /// `max_bytes`: such a grade is not baked to find that out.
    pub(crate) fn smallest(
        &mut self,
        max_error: f64,
        max_bytes: usize,
        job: &mut Job,
    ) -> Result<Option<Vec<Table>>, BakeError> {
        for i in 0..self.grades.len() {
            if self.grades[i].bytes > max_bytes {
                return Ok(None);
            }
            let tables = self.tables(i, job)?;
            if largest(tables) <= max_error {
                return Ok(Some(tables.to_vec()));
            }
        }
        Ok(None)
    }

    /// Bytes of the values of the smallest grade.
    pub(crate) fn least_bytes(&self) -> usize {
        self.grades[0].bytes
    }

    /// The least error of all grades that were measured.
    pub(crate) fn least_error(&self) -> f64 {
        let measured = self.grades.iter().filter_map(|grade| grade.tables.as_deref());
        measured.map(largest).fold(f64::INFINITY, f64::min)
    }

    fn tables(&mut self, i: usize, job: &mut Job) -> Result<&[Table], BakeError> {
        if self.grades[i].tables.is_none() {
            // All precisions of a quality at once, which cost hardly more than one.
            let quality = self.grades[i].quality;
            let baked = self.of.bake(quality, &PRECISIONS, job)?;
            for (precision, tables) in PRECISIONS.into_iter().zip(baked) {
                let same = |grade: &&mut Grade| grade.quality == quality && grade.precision == precision;
                let grade = self.grades.iter_mut().find(same).expect("all grades are listed");
                grade.tables = Some(tables);
            }
        }
        Ok(self.grades[i].tables.as_deref().expect("baked just now"))
    }
}

fn largest(tables: &[Table]) -> f64 {
    tables.iter().map(worst_error).fold(0.0, f64::max)
}
