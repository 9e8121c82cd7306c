//! How values are stored: number formats, and conversion to and from bytes.

use alloc::vec;
use alloc::vec::Vec;

use half::f16;
use safetensors::Dtype;
use serde::{Deserialize, Serialize};

/// How values are stored.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Precision {
    /// IEEE single precision.
    #[default]
    F32,
    /// IEEE half precision.
    F16,
    /// Sixteen-bit fixed point, value = offset + scale·integer, with one offset and scale per
    /// channel.
    U16,
}

impl Precision {
    /// Bytes of a stored value.
    pub const fn bytes(self) -> usize {
        match self {
            Self::F32 => 4,
            Self::F16 | Self::U16 => 2,
        }
    }

    pub(super) const fn dtype(self) -> Dtype {
        match self {
            Self::F32 => Dtype::F32,
            Self::F16 => Dtype::F16,
            Self::U16 => Dtype::U16,
        }
    }
}

/// Converts between f32 values and stored bytes, little-endian.
pub(super) enum Codec {
    F32,
    F16,
    /// One scale and offset per channel.
    U16 {
        scale: Vec<f32>,
        offset: Vec<f32>,
    },
}

impl Codec {
    /// The codec that stores these values, channels fastest, with the least error.
    pub(super) fn fit(precision: Precision, values: &[f32], channels: usize) -> Self {
        match precision {
            Precision::F32 => Self::F32,
            Precision::F16 => Self::F16,
            Precision::U16 => {
                let (mut low, mut high) =
                    (vec![f32::INFINITY; channels], vec![f32::NEG_INFINITY; channels]);
                for (i, &x) in values.iter().enumerate() {
                    low[i % channels] = low[i % channels].min(x);
                    high[i % channels] = high[i % channels].max(x);
                }
                let scale = low.iter().zip(&high).map(|(lo, hi)| (hi - lo) / 65535.0).collect();
                Self::U16 { scale, offset: low }
            }
        }
    }

    pub(super) fn described(
        precision: Precision,
        scale: &[f32],
        offset: &[f32],
        channels: usize,
    ) -> Result<Self, &'static str> {
        let finite = |xs: &[f32]| xs.len() == channels && xs.iter().all(|x| x.is_finite());
        match precision {
            Precision::F32 => Ok(Self::F32),
            Precision::F16 => Ok(Self::F16),
            Precision::U16 if finite(scale) && finite(offset) => {
                Ok(Self::U16 { scale: scale.into(), offset: offset.into() })
            }
            Precision::U16 => Err("`scale` and `offset` need one finite number a channel"),
        }
    }

    pub(super) fn scale_offset(&self) -> Option<(Vec<f32>, Vec<f32>)> {
        match self {
            Self::U16 { scale, offset } => Some((scale.clone(), offset.clone())),
            _ => None,
        }
    }

    pub(super) fn encode(&self, values: &[f32]) -> Vec<u8> {
        match self {
            Self::F32 => values.iter().flat_map(|x| x.to_le_bytes()).collect(),
            Self::F16 => values.iter().flat_map(|&x| f16::from_f32(x).to_le_bytes()).collect(),
            Self::U16 { scale, offset } => {
                let n = scale.len();
                let quantise = |(i, &x): (usize, &f32)| {
                    let step = scale[i % n];
                    // A constant channel has no step; half a step is added because the cast
                    // truncates.
                    let q = if step > 0.0 { ((x - offset[i % n]) / step + 0.5) as u16 } else { 0 };
                    q.to_le_bytes()
                };
                values.iter().enumerate().flat_map(quantise).collect()
            }
        }
    }

    pub(super) fn decode(&self, bytes: &[u8]) -> Vec<f32> {
        match self {
            Self::F32 => bytes
                .chunks_exact(4)
                .map(|b| f32::from_le_bytes([b[0], b[1], b[2], b[3]]))
                .collect(),
            Self::F16 => {
                bytes.chunks_exact(2).map(|b| f16::from_le_bytes([b[0], b[1]]).to_f32()).collect()
            }
            Self::U16 { scale, offset } => {
                let n = scale.len();
                let value = |(i, b): (usize, &[u8])| {
                    offset[i % n] + scale[i % n] * f32::from(u16::from_le_bytes([b[0], b[1]]))
                };
                bytes.chunks_exact(2).enumerate().map(value).collect()
            }
        }
    }

    /// The values as they are read back after being stored at `precision`.
    pub(super) fn round(precision: Precision, mut values: Vec<f32>, channels: usize) -> Vec<f32> {
        // Storing fits scale and offset to the values again, which may differ by an ulp after
        // rounding: repeat until they do not. Two rounds have always been enough; the limit
        // prevents a cycle.
        for _ in 0..16 {
            let codec = Self::fit(precision, &values, channels);
            let stored = codec.decode(&codec.encode(&values));
            if stored == values {
                break;
            }
            values = stored;
        }
        values
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stored_values_stay_what_they_are() {
        let values: Vec<f32> =
            (0..60).map(|i| libm::sinf(i as f32) * if i % 2 == 0 { 3.0 } else { 1e-3 }).collect();
        for (precision, error) in
            [(Precision::F32, 0.0), (Precision::F16, 1.5e-3), (Precision::U16, 5e-5)]
        {
            let once = Codec::round(precision, values.clone(), 2);
            assert!(once.iter().zip(&values).all(|(a, b)| (a - b).abs() <= error));
            assert_eq!(Codec::round(precision, once.clone(), 2), once);
            let codec = Codec::fit(precision, &once, 2);
            assert_eq!(codec.encode(&once).len(), precision.bytes() * once.len());
        }
        // A constant channel has no step.
        assert_eq!(Codec::round(Precision::U16, vec![0.7; 8], 2), [0.7; 8]);
    }
}
