//! Tables of one layout, as a document describes them: what all have in common once, and the rest
//! in columns with one entry for each table. Their values are one tensor.

use alloc::borrow::ToOwned;
use alloc::collections::{BTreeMap, BTreeSet};
use alloc::format;
use alloc::string::String;
use alloc::vec;
use alloc::vec::Vec;

use microfacet_core::Masking;
use serde::{Deserialize, Serialize};

use super::certificate::{Certificate, Figures};
use super::ensure;
use super::kind::Kind;
use super::lobe::{LobeForm, LobeSpec, Roughness};
use super::precision::{Codec, Precision};
use super::reflectance::Reflectance;
use super::stored::{Range, Sigma, StoredAxis};
use super::subject::{Side, Subject, joined_name};
use super::table::Table;

/// Tables of one layout. Empty columns are left out of the file.
#[derive(Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Stack {
    /// The name of the tensor, and of a table that is alone in it.
    pub(super) name: String,
    /// The number of tables, the first dimension of the tensor; missing for a single table, whose
    /// tensor does not have that dimension.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    count: Option<usize>,
    kind: Kind,
    lobe: LobeForm,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    masking: Option<Masking>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    reflectance: Option<Optics>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    side: Option<Side>,
    /// By index among the axes of the document.
    axes: Vec<usize>,
    pub(super) channels: Vec<String>,
    pub(super) precision: Precision,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    gamma: Vec<Range>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    sigma: Vec<Sigma>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    theta: Vec<[f64; 3]>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    distribution: Vec<String>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    eta: Vec<Eta>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    k: Vec<[f64; 3]>,
    /// For `u16`: value = offset + scale·integer, per channel.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    scale: Vec<Vec<f32>>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    offset: Vec<Vec<f32>>,
    certificate: BTreeMap<String, Vec<Option<Figure>>>,
}

/// A figure of a certificate; whole numbers are written without a decimal point.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
#[serde(untagged)]
enum Figure {
    Whole(u32),
    Real(f64),
}

impl From<f64> for Figure {
    fn from(x: f64) -> Self {
        if f64::from(x as u32) == x { Self::Whole(x as u32) } else { Self::Real(x) }
    }
}

impl From<Figure> for f64 {
    fn from(figure: Figure) -> Self {
        match figure {
            Figure::Whole(n) => n.into(),
            Figure::Real(x) => x,
        }
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
enum Optics {
    Moments,
    Conductor,
    Dielectric,
}

/// An index of refraction: of a conductor for red, green and blue, of a dielectric a range.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(untagged, expecting = "three numbers, or a number or an object of `min` and `max`")]
enum Eta {
    Rgb([f64; 3]),
    Range(Range),
}

impl Stack {
    /// A stack of one table, whose axes have these indices in the document.
    fn one(table: &Table, axes: Vec<usize>) -> Self {
        let Subject { lobe, masking, reflectance } = &table.subject;
        let codec = Codec::fit(table.precision, &table.values, table.channels.len());
        let (scale, offset) = codec.scale_offset().unzip();
        let form = lobe.form();
        let gamma = (form != LobeForm::Distribution).then(|| lobe.gamma.into());
        let sigma = (lobe.roughness != Roughness::ALL).then(|| lobe.roughness.into());
        let (optics, eta, k) = match *reflectance {
            Some(Reflectance::Conductor { eta, k }) => {
                (Some(Optics::Conductor), Some(Eta::Rgb(eta)), Some(k))
            }
            Some(Reflectance::Interface { index, .. }) => {
                (Some(Optics::Dielectric), Some(Eta::Range(index.into())), None)
            }
            Some(_) => (Some(Optics::Moments), None, None),
            None => (None, None, None),
        };
        let figures = Figures::from(table.certificate.clone()).into_iter();
        Self {
            name: table.name.clone(),
            count: None,
            kind: table.kind,
            lobe: form,
            masking: *masking,
            reflectance: optics,
            side: reflectance.and_then(|of| of.side()),
            axes,
            channels: table.channels.clone(),
            precision: table.precision,
            gamma: Vec::from_iter(gamma),
            sigma: Vec::from_iter(sigma),
            theta: Vec::from_iter(lobe.theta),
            distribution: Vec::from_iter(lobe.distribution.clone()),
            eta: Vec::from_iter(eta),
            k: Vec::from_iter(k),
            scale: Vec::from_iter(scale),
            offset: Vec::from_iter(offset),
            certificate: figures.map(|(key, figure)| (key, vec![Some(figure.into())])).collect(),
        }
    }

    pub(super) fn len(&self) -> usize {
        self.count.unwrap_or(1)
    }

    /// Whether the tensor can take the only table of another stack as well.
    fn takes(&self, next: &Self) -> bool {
        let of = |stack: &Self| {
            let Self { kind, lobe, masking, reflectance, side, precision, .. } = *stack;
            (kind, lobe, masking, reflectance, side, precision)
        };
        of(self) == of(next)
            && (&self.axes, &self.channels) == (&next.axes, &next.channels)
            && [self.gamma.is_empty(), self.sigma.is_empty()]
                == [next.gamma.is_empty(), next.sigma.is_empty()]
    }

    /// Adds the only table of another stack.
    fn push(&mut self, next: Self) {
        let count = self.len();
        self.count = Some(count + 1);
        self.gamma.extend(next.gamma);
        self.sigma.extend(next.sigma);
        self.theta.extend(next.theta);
        self.distribution.extend(next.distribution);
        self.eta.extend(next.eta);
        self.k.extend(next.k);
        self.scale.extend(next.scale);
        self.offset.extend(next.offset);
        for (key, figure) in next.certificate {
            self.certificate.entry(key).or_insert_with(|| vec![None; count]).extend(figure);
        }
        self.certificate.values_mut().for_each(|column| column.resize(count + 1, None));
    }

    /// The dimensions of the tensor; `None` if an axis is longer than any file has values.
    pub(super) fn shape(&self, axes: &[StoredAxis]) -> Option<Vec<usize>> {
        let along = self.axes.iter().map(|&i| axes.get(i)?.len());
        let all = self.count.map(Some).into_iter().chain(along);
        all.chain([Some(self.channels.len())]).collect()
    }

    /// Checks that every axis is there, and every column as long as there are tables.
    pub(super) fn check(&self, axes: &[StoredAxis]) -> Result<(), String> {
        ensure(!self.channels.is_empty(), || "no channels".into())?;
        ensure(self.len() > 0, || "no tables".into())?;
        for i in &self.axes {
            ensure(*i < axes.len(), || format!("axis {i} of {}", axes.len()))?;
        }
        let Self { gamma, sigma, theta, distribution, eta, k, scale, offset, .. } = self;
        let columns = [
            ("gamma", gamma.len()),
            ("sigma", sigma.len()),
            ("theta", theta.len()),
            ("distribution", distribution.len()),
            ("eta", eta.len()),
            ("k", k.len()),
            ("scale", scale.len()),
            ("offset", offset.len()),
        ];
        let columns = columns.into_iter().filter(|(_, entries)| *entries > 0);
        let figures = self.certificate.iter().map(|(key, column)| (&key[..], column.len()));
        let tables = self.len();
        columns.chain(figures).try_for_each(|(key, entries)| {
            ensure(entries == tables, || {
                format!("`{key}` has {entries} entries for {tables} tables")
            })
        })
    }

    /// The subject of the i-th table; the error names the missing column.
    fn subject(&self, i: usize) -> Result<Subject, String> {
        let missing = |key: &str| format!("no `{key}`, which its lobe or reflectance needs");
        let sigma = self.sigma.get(i).map(|sigma| Roughness::from(*sigma));
        let lobe = match (self.lobe, self.gamma.get(i), self.distribution.get(i)) {
            (LobeForm::Distribution, _, None) => return Err(missing("distribution")),
            (LobeForm::Distribution, _, Some(label)) => LobeSpec::outside(label.clone()),
            (_, None, _) => return Err(missing("gamma")),
            (form, Some(&gamma), _) => {
                ensure(form == LobeForm::Family || sigma.is_some(), || missing("sigma"))?;
                let lobe = LobeSpec::family(sigma.unwrap_or(Roughness::ALL), gamma.into());
                LobeSpec { theta: self.theta.get(i).copied(), ..lobe }
            }
        };
        let (got, stated) = (lobe.form(), self.lobe);
        ensure(got == stated, || {
            format!("its columns are of the form {got:?}, not of {stated:?}")
        })?;
        let reflectance = match (self.reflectance, self.eta.get(i).copied()) {
            (None, _) => None,
            (Some(Optics::Moments), _) => Some(Reflectance::Mirror),
            (Some(Optics::Conductor), Some(Eta::Rgb(eta))) => {
                let k = self.k.get(i).copied().ok_or_else(|| missing("k"))?;
                Some(Reflectance::Conductor { eta, k })
            }
            (Some(Optics::Dielectric), Some(Eta::Range(index))) => {
                let side = self.side.ok_or_else(|| missing("side"))?;
                Some(Reflectance::Interface { side, index: index.into() })
            }
            (Some(_), _) => return Err(missing("eta")),
        };
        Ok(Subject { lobe, masking: self.masking, reflectance })
    }

    fn certificate(&self, i: usize) -> Result<Certificate, String> {
        let of =
            |(key, column): (&String, &Vec<Option<Figure>>)| Some((key.clone(), column[i]?.into()));
        self.certificate.iter().filter_map(of).collect::<Figures>().try_into()
    }

    pub(super) fn codec(&self, i: usize) -> Result<Codec, String> {
        let [scale, offset] =
            [&self.scale, &self.offset].map(|column| column.get(i).map_or(&[][..], |own| own));
        let codec = Codec::described(self.precision, scale, offset, self.channels.len());
        codec.map_err(ToOwned::to_owned)
    }

    pub(super) fn table_name(&self, i: usize) -> Result<String, String> {
        self.subject(i).map(|subject| self.name_of(&subject))
    }

    fn name_of(&self, subject: &Subject) -> String {
        if self.count.is_none() { self.name.clone() } else { subject.name(self.kind) }
    }

    pub(super) fn table(
        &self,
        i: usize,
        axes: &[StoredAxis],
        values: Vec<f32>,
    ) -> Result<Table, String> {
        // Checked before axes are made, which take memory for as many nodes as they state.
        let shape = self.shape(axes).unwrap_or_default();
        let shape = &shape[usize::from(self.count.is_some())..];
        let expected = shape.iter().try_fold(1, |product: usize, n| product.checked_mul(*n));
        ensure(!values.is_empty() && expected == Some(values.len()), || {
            format!("{} values for shape {shape:?}", values.len())
        })?;
        let subject = self.subject(i)?;
        let single = subject.single();
        let axes = self.axes.iter().map(|&axis| axes[axis].axis(single));
        Ok(Table {
            name: self.name_of(&subject),
            kind: self.kind,
            axes: axes.collect::<Result<_, _>>()?,
            channels: self.channels.clone(),
            values,
            precision: self.precision,
            certificate: self.certificate(i)?,
            subject,
        })
    }
}

/// The axes and the stacks of tables, in their order: each stack a run of tables of one layout.
pub(super) fn stacked(tables: &[Table]) -> (Vec<StoredAxis>, Vec<Stack>) {
    let (mut axes, mut stacks): (Vec<StoredAxis>, Vec<Stack>) = Default::default();
    let mut places = BTreeMap::new();
    let mut last_is_named = false;
    for table in tables {
        let single = table.subject.single();
        let place = |axis| {
            let stored = StoredAxis::of(axis, single);
            *places.entry(stored.key()).or_insert_with(|| {
                axes.push(stored);
                axes.len() - 1
            })
        };
        let stack = Stack::one(table, table.axes.iter().map(place).collect());
        // Names are not stored for tables that share a tensor, but made of their subjects.
        let is_named = table.name == table.subject.name(table.kind);
        match stacks.last_mut() {
            Some(last) if last_is_named && is_named && last.takes(&stack) => last.push(stack),
            _ => stacks.push(stack),
        }
        last_is_named = is_named;
    }
    name(&mut stacks);
    (axes, stacks)
}

/// Names each tensor of several tables after what its tables have in common.
fn name(stacks: &mut [Stack]) {
    let alone = stacks.iter().filter(|stack| stack.count.is_none());
    let taken: BTreeSet<String> = alone.map(|stack| stack.name.clone()).collect();
    let mut numbers: BTreeMap<String, usize> = BTreeMap::new();
    for stack in stacks.iter_mut().filter(|stack| stack.count.is_some()) {
        let masking = stack.masking.map_or("", Masking::name);
        let optics = match stack.reflectance {
            Some(Optics::Conductor) => "conductors",
            Some(Optics::Dielectric) => "dielectrics",
            _ => "",
        };
        let side = stack.side.map_or("", Side::name);
        let name = joined_name(&[stack.kind.name(), masking, optics, side]);
        let number = numbers.entry(name.clone()).or_default();
        stack.name = loop {
            *number += 1;
            let numbered = format!("{name}_{number}");
            if !taken.contains(&numbered) {
                break numbered;
            }
        };
    }
}

#[cfg(test)]
mod tests;
