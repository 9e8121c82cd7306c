//! The record of a validation, as JSON: what `validate --json` prints and a page shows.

use microfacet_sampler::Tables;
use microfacet_tables::{describe, seal_document};
use serde::{Deserialize, Serialize};

use super::configuration::Configuration;
use super::furnace::{Survey, TOLERANCE};
use super::{LEVEL, Options, Outcome, PDF_TOLERANCE, Report};

/// What was tested of a set, and the result.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Record {
    /// The [`identity`] of the set.
    pub set: String,
    /// Whether all tests passed.
    pub passed: bool,
    /// Normals drawn for each configuration.
    pub samples: usize,
    /// Factor on γ of the model; other than 1, the tests are expected to reject.
    pub gamma_factor: f64,
    /// Probability with which a run rejects a correct set.
    pub level: f64,
    /// The p-value below which a single test rejects.
    pub level_of_one_test: f64,
    /// Configurations of which a test rejects.
    pub rejected: usize,
    /// Allowed deviation of an integral of the density from 1.
    pub pdf_tolerance: f64,
    /// The integral of the density furthest from 1; `None` without configurations or if not finite.
    pub worst_pdf_integral: Option<f64>,
    /// The configurations, the smallest p-value first.
    pub configurations: Vec<Tested>,
    /// Allowed deviation of a white furnace from 1.
    pub furnace_tolerance: f64,
    /// White furnaces, one for each table of albedos.
    pub furnaces: Vec<Returned>,
    /// What the set holds and no test judges.
    pub not_tested: Vec<String>,
}

/// A configuration and its tests.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Tested {
    /// Material and view.
    #[serde(flatten)]
    pub configuration: Configuration,
    /// p-value of the χ² of slopes in the plane of incidence and across it.
    #[serde(deserialize_with = "or_nan")]
    pub p_lobe: f64,
    /// p-value of the χ² of normals on the hemisphere.
    #[serde(deserialize_with = "or_nan")]
    pub p_world: f64,
    /// Kolmogorov–Smirnov distance of the in-plane slope.
    #[serde(deserialize_with = "or_nan")]
    pub ks: f64,
    /// Error of G1 for the view.
    #[serde(deserialize_with = "or_nan")]
    pub g1_error: f64,
}

/// The light that the white furnaces of a table return with the Kulla–Conty lobe.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Returned {
    /// The form of masking, by its name.
    pub masking: String,
    /// Materials and views.
    pub points: usize,
    /// The smallest share.
    #[serde(deserialize_with = "or_nan")]
    pub lowest: f64,
    /// The largest share.
    #[serde(deserialize_with = "or_nan")]
    pub highest: f64,
}

impl Record {
    /// Of a run on `set`, its furnaces, and what they leave out.
    ///
    /// # Errors
    /// As [`identity`].
    pub fn new(
        set: &Tables,
        options: Options,
        outcome: &Outcome,
        furnaces: &[Survey],
        not_tested: Vec<String>,
    ) -> Result<Self, microfacet_tables::LoadError> {
        Ok(Self {
            set: identity(set)?,
            passed: outcome.passed() && furnaces.iter().all(Survey::passed),
            samples: options.samples,
            gamma_factor: options.gamma_factor,
            level: LEVEL,
            level_of_one_test: outcome.level,
            rejected: outcome.rejected(),
            pdf_tolerance: PDF_TOLERANCE,
            worst_pdf_integral: outcome.worst_integral().map(|report| report.pdf_integral),
            configurations: outcome.reports.iter().map(Tested::from).collect(),
            furnace_tolerance: furnaces.iter().map(|of| of.allowed).fold(TOLERANCE, f64::max),
            furnaces: furnaces.iter().map(Returned::from).collect(),
            not_tested,
        })
    }
}

impl From<&Report> for Tested {
    fn from(report: &Report) -> Self {
        Self {
            configuration: report.configuration,
            p_lobe: report.normals.lobe.p,
            p_world: report.normals.world.p,
            ks: report.normals.ks,
            g1_error: report.g1_error,
        }
    }
}

impl From<&Survey> for Returned {
    fn from(survey: &Survey) -> Self {
        Self {
            masking: survey.masking.name().into(),
            points: survey.points,
            lowest: survey.lowest.kulla_conty,
            highest: survey.highest.kulla_conty,
        }
    }
}

/// Eight hexadecimal digits that two sets share if they hold the same description and values,
/// whether as safetensors or as images: a CRC-32.
///
/// # Errors
/// [`LoadError::Invalid`](microfacet_tables::LoadError) for a set that could not be written.
pub fn identity(set: &Tables) -> Result<String, microfacet_tables::LoadError> {
    /// The member of a description that has the digits.
    #[derive(Deserialize)]
    struct Sealed {
        checksum: String,
    }
    let mut tables = set.tables().to_vec();
    // Images of a folder come in the order of their names.
    tables.sort_by(|a, b| a.name.cmp(&b.name));
    let document = describe(set.provenance(), &tables)?;
    let values: Vec<f32> = tables.into_iter().flat_map(|table| table.values).collect();
    let sealed = seal_document(&document, &values).expect("a description has a checksum");
    let Sealed { checksum } = serde_json::from_str(&sealed).expect("a description is JSON");
    Ok(checksum)
}

/// A number; JSON has `null` for one that is not finite.
fn or_nan<'de, D: serde::Deserializer<'de>>(from: D) -> Result<f64, D::Error> {
    Ok(Option::deserialize(from)?.unwrap_or(f64::NAN))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn record() -> Record {
        let configuration = Configuration {
            sigma_x: 0.1,
            sigma_y: 10.0,
            gamma: f64::INFINITY,
            theta: 0.5,
            phi: -3.0,
            seed: u64::MAX,
        };
        let tested =
            Tested { configuration, p_lobe: 0.25, p_world: 1e-300, ks: 1e-3, g1_error: 0.0 };
        Record {
            set: "0123abcd".into(),
            passed: false,
            samples: 1000,
            gamma_factor: 1.0,
            level: LEVEL,
            level_of_one_test: 5e-5,
            rejected: 1,
            pdf_tolerance: PDF_TOLERANCE,
            worst_pdf_integral: Some(1.0),
            configurations: vec![tested],
            furnace_tolerance: TOLERANCE,
            furnaces: Vec::new(),
            not_tested: vec!["a table".into()],
        }
    }

    #[test]
    fn what_is_written_is_read() {
        let record = record();
        let text = serde_json::to_string(&record).unwrap();
        assert!(text.contains(r#""gamma":"inf""#), "{text}");
        assert_eq!(serde_json::from_str::<Record>(&text).unwrap(), record);
    }

    /// JSON has no NaN, and the record of a failed test must be readable.
    #[test]
    fn what_is_not_finite_is_read_as_nan() {
        let mut record = record();
        record.configurations[0].p_lobe = f64::NAN;
        record.worst_pdf_integral = Some(f64::INFINITY);
        let read: Record = serde_json::from_str(&serde_json::to_string(&record).unwrap()).unwrap();
        assert!(read.configurations[0].p_lobe.is_nan());
        assert_eq!(read.worst_pdf_integral, None);
    }

    #[test]
    fn sets_of_other_values_or_words_have_another_identity() {
        let set = Tables::embedded();
        let known = identity(&set).unwrap();
        let (mut provenance, mut tables) = (set.provenance().clone(), set.tables().to_vec());
        tables.reverse();
        let of = |provenance: &_, tables: &[_]| {
            identity(&Tables::from_tables(Clone::clone(provenance), tables.to_vec()).unwrap())
                .unwrap()
        };
        assert_eq!(of(&provenance, &tables), known);
        let before = tables[0].values[0];
        tables[0].values[0] = f32::from_bits(before.to_bits() ^ 1);
        assert_ne!(of(&provenance, &tables), known);
        tables[0].values[0] = before;
        provenance.license += " ";
        assert_ne!(of(&provenance, &tables), known);
    }
}
