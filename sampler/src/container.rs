//! The safetensors container: one file, all tables of a set, described by one JSON document in its metadata.
//!
//! `docs/format.md` is the specification. Everything in the file is under one CRC-32, the header included: it is taken over
//! the whole file with its own eight digits replaced by `0`, so that a damaged shape or axis is found like a damaged value.

use alloc::borrow::ToOwned;
use alloc::collections::BTreeMap;
use alloc::format;
use alloc::string::{String, ToString};
use alloc::vec;
use alloc::vec::Vec;

use half::f16;
use safetensors::{Dtype, SafeTensors, tensor::TensorView};
use serde::{Deserialize, Serialize};

use crate::axis::Axis;
use crate::error::LoadError;
use crate::student_t::Masking;
use crate::table::{Kind, Table};

/// `format` of the document.
pub const FORMAT: &str = "microfacet-tables";
/// Version of the format that this crate writes, and the newest that it reads.
pub const VERSION: u32 = 1;
/// Key of the document in the safetensors metadata.
const KEY: &str = "microfacet";
/// What precedes the digits of the checksum in the raw header, where the document is a JSON string inside JSON.
const CHECKSUM_PREFIX: &[u8] = br#"\"checksum\":\""#;
const NO_CHECKSUM: &str = "00000000";

/// How values are stored.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Precision {
    /// IEEE single precision.
    #[default]
    F32,
    /// IEEE half precision.
    F16,
    /// Sixteen-bit fixed point, value = offset + scale·integer with one offset and scale a channel.
    U16,
}

/// Where a set comes from and how its numbers are to be read.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Provenance {
    /// Program and version that baked the set.
    pub generator: String,
    /// Number of the numeric method; it changes whenever the same recipe would give other bytes.
    pub numerics: u32,
    /// Licence of the data.
    pub license: String,
    /// The conventions a reader could get wrong, in words.
    pub conventions: BTreeMap<String, String>,
    /// The recipe the set was baked from, as TOML; empty for the general set.
    pub recipe: String,
    /// Named materials of the recipe.
    pub materials: Vec<MaterialEntry>,
}

/// A named material of a recipe.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct MaterialEntry {
    /// Its name.
    pub name: String,
    /// σx and σy, as ranges [min, max] where a texture drives them.
    pub sigma: [[f64; 2]; 2],
    /// 1/(γ−1), so that γ = ∞ is the number 0; a range [min, max] likewise.
    pub s: [f64; 2],
    /// The distribution, such as `gtr:0.2,1.5`, of a material that is no Student-t; `sigma` is then the scale of its tables, which carry
    /// the [`table_suffix`](Self::table_suffix), and `s` means nothing.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub distribution: String,
    /// The turn of an ellipsoid, θx, θy, θz in radians as of [`Skew::new`](crate::Skew::new); its σ and s are single numbers.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub theta: Option<[f64; 3]>,
    /// The form of masking and shadowing it states, if any.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub masking: Option<Masking>,
    /// The reflectance of its facets, if it states one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub fresnel: Option<FresnelEntry>,
}

/// The reflectance of a material's facets, as in its recipe.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum FresnelEntry {
    /// F = 1.
    Mirror,
    /// Schlick's approximation with this reflectance at normal incidence, in [0, 1]; the moments of `albedo` tables serve every value.
    Schlick(f64),
    /// A conductor of complex index of refraction η + ik relative to the outside, for red, green and blue.
    Conductor {
        /// η > 0.
        eta: [f64; 3],
        /// k ≥ 0.
        k: [f64; 3],
    },
    /// A dielectric with this index of refraction, > 0, relative to the outside.
    Dielectric(f64),
    /// Dielectrics of all indices of refraction from 1 ≤ `min` on, relative to the outside.
    Dielectrics {
        /// Smallest.
        min: f64,
        /// Largest; `None` is ∞.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        max: Option<f64>,
    },
}

impl FresnelEntry {
    /// What the names of its own albedo tables hold; empty where the moments of `albedo` tables are enough.
    pub fn label(&self) -> String {
        let list = |x: &[f64; 3]| format!("{}_{}_{}", x[0], x[1], x[2]);
        match self {
            Self::Mirror | Self::Schlick(_) => String::new(),
            Self::Conductor { eta, k } => format!("conductor_{}_k_{}", list(eta), list(k)),
            Self::Dielectric(eta) => format!("eta_{eta}"),
            Self::Dielectrics { min, max } => {
                format!("eta_{min}_to_{}", max.unwrap_or(f64::INFINITY))
            }
        }
    }

    /// The indices [min, max] ⊂ [1, ∞] of the dense side over the thin one; `None` of what is no dielectric.
    pub fn indices(&self) -> Option<[f64; 2]> {
        match *self {
            Self::Dielectric(eta) => Some([eta.max(1.0 / eta); 2]),
            Self::Dielectrics { min, max } => Some([min, max.unwrap_or(f64::INFINITY)]),
            _ => None,
        }
    }
}

impl MaterialEntry {
    /// What follows the kind in the names of this material's own tables; empty for a Student-t.
    pub fn table_suffix(&self) -> String {
        self.distribution.replace([':', ',', '/', '\\', ' '], "_")
    }

    /// What the name of this material's own albedo table ends in, after `view_albedo_`, the form of masking and `_`: of another
    /// distribution its [`table_suffix`](Self::table_suffix), of an anisotropic material of single numbers `gamma_γ_sigma_σx_σy` with γ to nine
    /// decimals, of an ellipsoid followed by `_theta_θx_θy_θz`. `None` if its albedo is that of the family's tables.
    pub fn view_label(&self) -> Option<String> {
        if !self.distribution.is_empty() {
            return Some(self.table_suffix());
        }
        let [x, y] = self.sigma;
        let single = |[min, max]: [f64; 2]| min == max;
        let round = x == y && self.theta.is_none();
        if round || ![x, y, self.s].into_iter().all(single) {
            return None;
        }
        // γ = 1 + 1/s of a γ with few digits has many: rounded, they are the same again.
        let gamma = libm::round((1.0 + 1.0 / self.s[0]) * 1e9) / 1e9;
        let turn = self.theta.map_or_else(String::new, |[x, y, z]| format!("_theta_{x}_{y}_{z}"));
        Some(format!("gamma_{gamma}_sigma_{}_{}{turn}", x[0], y[0]))
    }
}

#[derive(Serialize, Deserialize)]
struct Document {
    format: String,
    version: u32,
    checksum: String,
    #[serde(flatten)]
    provenance: Provenance,
    tables: Vec<Descriptor>,
}

#[derive(Serialize, Deserialize)]
struct Descriptor {
    name: String,
    kind: Kind,
    axes: Vec<Axis>,
    channels: Vec<String>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    masking: Option<Masking>,
    precision: Precision,
    /// For `u16`: value = offset + scale·integer, by channel.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    scale: Vec<f32>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    offset: Vec<f32>,
    certificate: BTreeMap<String, f64>,
}

fn invalid(why: impl ToString) -> LoadError {
    LoadError::Invalid(why.to_string())
}

/// The JSON document that describes a set, with zeros for its checksum: what [`encode`] embeds, and what other containers may carry.
///
/// # Errors
/// [`LoadError::Invalid`] if a table would not load again.
pub fn describe(provenance: &Provenance, tables: &[Table]) -> Result<String, LoadError> {
    let mut descriptors = Vec::new();
    for table in tables {
        table.validate()?;
        let (scale, offset) = Codec::fit(table).scale_offset();
        descriptors.push(Descriptor {
            name: table.name.clone(),
            kind: table.kind,
            axes: table.axes.clone(),
            channels: table.channels.clone(),
            masking: table.masking,
            precision: table.precision,
            scale,
            offset,
            certificate: table.certificate.clone(),
        });
    }
    let document = Document {
        format: FORMAT.into(),
        version: VERSION,
        checksum: NO_CHECKSUM.into(),
        provenance: provenance.clone(),
        tables: descriptors,
    };
    serde_json::to_string(&document).map_err(invalid)
}

/// Writes a set as the bytes of a safetensors file; the same set always gives the same bytes.
///
/// # Errors
/// [`LoadError::Invalid`] if a table would not load again.
pub fn encode(provenance: &Provenance, tables: &[Table]) -> Result<Vec<u8>, LoadError> {
    let json = describe(provenance, tables)?;
    let data: Vec<Vec<u8>> = tables.iter().map(|table| Codec::fit(table).encode(&table.values)).collect();
    let views = data
        .iter()
        .zip(tables)
        .map(|(bytes, table)| {
            TensorView::new(dtype(table.precision), table.shape(), bytes)
                .map(|view| (table.name.as_str(), view))
        })
        .collect::<Result<Vec<_>, _>>()
        .map_err(invalid)?;
    // One key only: the library writes the metadata in the order of a hash map.
    let metadata = [(KEY.to_owned(), json)].into_iter().collect();
    let mut bytes = safetensors::serialize(views, Some(metadata)).map_err(invalid)?;
    let at = checksum_position(&bytes).ok_or_else(|| invalid("no place for the checksum"))?;
    let digits = format!("{:08x}", crc32fast::hash(&bytes));
    bytes[at..at + 8].copy_from_slice(digits.as_bytes());
    Ok(bytes)
}

/// Reads a set from the bytes of a safetensors file, checking everything; `verify` may skip the checksum where the bytes are known good.
///
/// # Errors
/// [`LoadError`] saying what is wrong; never a panic, and never an allocation larger than a few times the input.
pub(crate) fn decode(bytes: &[u8], verify: bool) -> Result<(Provenance, Vec<Table>), LoadError> {
    let (_, metadata) = SafeTensors::read_metadata(bytes).map_err(|why| {
        invalid(format!("{why}; a table set is a safetensors file written by `microfacet-bake`"))
    })?;
    let json = metadata.metadata().as_ref().and_then(|map| map.get(KEY)).ok_or_else(|| {
        invalid(format!("a safetensors file, but without the `{KEY}` document of a table set"))
    })?;
    check_version(json)?;
    if verify {
        verify_checksum(bytes)?;
    }
    let tensors = SafeTensors::deserialize(bytes).map_err(invalid)?;
    let (provenance, tables) = assemble(json, |descriptor, codec| {
        let tensor = tensors.tensor(&descriptor.name).map_err(|_| "no tensor of that name".to_string())?;
        if tensor.dtype() != dtype(descriptor.precision) {
            return Err(format!("stored as {:?}, described as {:?}", tensor.dtype(), descriptor.precision));
        }
        let shape: Vec<usize> =
            descriptor.axes.iter().map(Axis::len).chain([descriptor.channels.len()]).collect();
        if shape != tensor.shape() {
            return Err(format!("tensor of shape {:?}, axes and channels of {shape:?}", tensor.shape()));
        }
        Ok(codec.decode(tensor.data()))
    })?;
    if tensors.len() != tables.len() {
        return Err(invalid(format!("{} tensors for {} tables", tensors.len(), tables.len())));
    }
    Ok((provenance, tables))
}

/// Puts a set together again from the document of [`describe`] and the values of each table, decoded already.
///
/// # Errors
/// [`LoadError`] if the document is not one, or a table is not sound.
pub fn reassemble(
    json: &str,
    mut values: impl FnMut(&str) -> Result<Vec<f32>, String>,
) -> Result<(Provenance, Vec<Table>), LoadError> {
    check_version(json)?;
    assemble(json, |descriptor, _| values(&descriptor.name))
}

/// The format and version of a document, before anything else of it: a newer one may not parse as this one.
fn check_version(json: &str) -> Result<(), LoadError> {
    #[derive(Deserialize)]
    struct Head {
        format: String,
        version: u32,
    }
    let head: Head = serde_json::from_str(json).map_err(invalid)?;
    if head.format != FORMAT {
        return Err(invalid(format!("format \"{}\" where \"{FORMAT}\" is expected", head.format)));
    }
    if head.version != VERSION {
        return Err(LoadError::Unsupported(format!(
            "format version {} (this reader knows {VERSION}): update the reader or bake again",
            head.version
        )));
    }
    Ok(())
}

fn assemble(
    json: &str,
    mut values: impl FnMut(&Descriptor, &Codec) -> Result<Vec<f32>, String>,
) -> Result<(Provenance, Vec<Table>), LoadError> {
    let document: Document = serde_json::from_str(json).map_err(invalid)?;
    let mut tables: Vec<Table> = Vec::with_capacity(document.tables.len());
    for descriptor in document.tables {
        let fail = |why: String| invalid(format!("table `{}`: {why}", descriptor.name));
        if descriptor.channels.is_empty() {
            return Err(fail("no channels".into()));
        }
        if tables.iter().any(|other| other.name == descriptor.name) {
            return Err(fail("named twice".into()));
        }
        let codec = Codec::from_descriptor(&descriptor).map_err(|why| fail(why.into()))?;
        let values = values(&descriptor, &codec).map_err(fail)?;
        let table = Table {
            values,
            name: descriptor.name,
            kind: descriptor.kind,
            axes: descriptor.axes,
            channels: descriptor.channels,
            masking: descriptor.masking,
            precision: descriptor.precision,
            certificate: descriptor.certificate,
        };
        table.validate()?;
        tables.push(table);
    }
    Ok((document.provenance, tables))
}

fn dtype(precision: Precision) -> Dtype {
    match precision {
        Precision::F32 => Dtype::F32,
        Precision::F16 => Dtype::F16,
        Precision::U16 => Dtype::U16,
    }
}

fn checksum_position(bytes: &[u8]) -> Option<usize> {
    let header = usize::try_from(u64::from_le_bytes(bytes.get(..8)?.try_into().ok()?)).ok()?;
    let head = bytes.get(..header.checked_add(8)?)?;
    let at = head.windows(CHECKSUM_PREFIX.len()).position(|window| window == CHECKSUM_PREFIX)?;
    let at = at + CHECKSUM_PREFIX.len();
    (at + 8 <= head.len()).then_some(at)
}

fn verify_checksum(bytes: &[u8]) -> Result<(), LoadError> {
    let at = checksum_position(bytes).ok_or_else(|| invalid("no checksum"))?;
    let mut hasher = crc32fast::Hasher::new();
    hasher.update(&bytes[..at]);
    hasher.update(NO_CHECKSUM.as_bytes());
    hasher.update(&bytes[at + 8..]);
    let digits = format!("{:08x}", hasher.finalize());
    if digits.as_bytes() == &bytes[at..at + 8] {
        Ok(())
    } else {
        Err(invalid("checksum does not match: the file is damaged; copy it again or bake again"))
    }
}

/// Between f32 values and stored bytes, little-endian.
enum Codec {
    F32,
    F16,
    U16 { scale: Vec<f32>, offset: Vec<f32> },
}

impl Codec {
    fn fit(table: &Table) -> Self {
        match table.precision {
            Precision::F32 => Self::F32,
            Precision::F16 => Self::F16,
            Precision::U16 => {
                let n = table.channels.len();
                let (mut low, mut high) = (vec![f32::INFINITY; n], vec![f32::NEG_INFINITY; n]);
                for (i, &x) in table.values.iter().enumerate() {
                    low[i % n] = low[i % n].min(x);
                    high[i % n] = high[i % n].max(x);
                }
                let scale = low.iter().zip(&high).map(|(lo, hi)| (hi - lo) / 65535.0).collect();
                Self::U16 { scale, offset: low }
            }
        }
    }

    fn from_descriptor(descriptor: &Descriptor) -> Result<Self, &'static str> {
        let n = descriptor.channels.len();
        Ok(match descriptor.precision {
            Precision::F32 => Self::F32,
            Precision::F16 => Self::F16,
            Precision::U16 => {
                let finite = |xs: &[f32]| xs.len() == n && xs.iter().all(|x| x.is_finite());
                if !finite(&descriptor.scale) || !finite(&descriptor.offset) {
                    return Err("`scale` and `offset` need one finite number a channel");
                }
                Self::U16 { scale: descriptor.scale.clone(), offset: descriptor.offset.clone() }
            }
        })
    }

    fn scale_offset(&self) -> (Vec<f32>, Vec<f32>) {
        match self {
            Self::U16 { scale, offset } => (scale.clone(), offset.clone()),
            _ => (Vec::new(), Vec::new()),
        }
    }

    fn encode(&self, values: &[f32]) -> Vec<u8> {
        match self {
            Self::F32 => values.iter().flat_map(|x| x.to_le_bytes()).collect(),
            Self::F16 => values.iter().flat_map(|&x| f16::from_f32(x).to_le_bytes()).collect(),
            Self::U16 { scale, offset } => {
                let n = scale.len();
                let quantise = |(i, &x): (usize, &f32)| {
                    let step = scale[i % n];
                    // A constant channel has no step; half a step is added since the cast truncates.
                    let q = if step > 0.0 { ((x - offset[i % n]) / step + 0.5) as u16 } else { 0 };
                    q.to_le_bytes()
                };
                values.iter().enumerate().flat_map(quantise).collect()
            }
        }
    }

    fn decode(&self, bytes: &[u8]) -> Vec<f32> {
        match self {
            Self::F32 => {
                bytes.chunks_exact(4).map(|b| f32::from_le_bytes([b[0], b[1], b[2], b[3]])).collect()
            }
            Self::F16 => bytes.chunks_exact(2).map(|b| f16::from_le_bytes([b[0], b[1]]).to_f32()).collect(),
            Self::U16 { scale, offset } => {
                let n = scale.len();
                let value = |(i, b): (usize, &[u8])| {
                    offset[i % n] + scale[i % n] * f32::from(u16::from_le_bytes([b[0], b[1]]))
                };
                bytes.chunks_exact(2).enumerate().map(value).collect()
            }
        }
    }
}

impl Table {
    /// The table as it will be read back when stored at `precision`: rounding happens here and nowhere else, so that a
    /// certificate can be measured on what a reader gets.
    pub fn rounded(mut self, precision: Precision) -> Self {
        self.precision = precision;
        // Storing fits scale and offset to the values once more, which after rounding may differ by an ulp: until they do not. Two
        // rounds have always been enough; the limit is against a cycle.
        for _ in 0..16 {
            let codec = Codec::fit(&self);
            let values = codec.decode(&codec.encode(&self.values));
            if values == self.values {
                break;
            }
            self.values = values;
        }
        self
    }
}
