//! Errors of a material's albedo over all views, through the run-time lookup, against the model's quadrature.

use std::f64::consts::TAU;

use glam::Vec3;
use rayon::prelude::*;

use microfacet_sampler::{LoadError, Mapping, Moments, Table, ViewAlbedo};

use super::albedo::{outside, place};
use super::certificate::{low_discrepancy, round_up};
use crate::bake::albedo::BakeError;
use crate::bake::view_albedo::{LobeAlbedo, ViewSpec};
use crate::scene::Interval;

/// Views measured.
pub(crate) const POINTS: usize = 512;

/// What the model says of one view.
pub struct Reference {
    v: Vec3,
    /// Scale, bias and F82.
    exact: [f64; 3],
    /// |E − that of the round lobe that usually stands in|, if one does.
    shortcut: Option<f64>,
    /// Outside the domain that the figures are promised for.
    outside: bool,
}

/// The views to measure at: a half of them evenly in φ, a half as the table's azimuths stand; an eighth grazes below cos θ = 0.02.
///
/// # Errors
/// [`BakeError`] for a lobe out of the domain.
pub fn references(spec: &ViewSpec) -> Result<Vec<Reference>, BakeError> {
    // Nodes are to be judged by something better.
    LobeAlbedo::with(&spec.lobe, 0.1 * spec.tolerance, |model| references_of(spec, model))
}

fn references_of(spec: &ViewSpec, model: &LobeAlbedo<'_>) -> Result<Vec<Reference>, BakeError> {
    let azimuths = spec.azimuth()?;
    let one = |i: usize| {
        let [a, _] = low_discrepancy(i);
        let quadrant = f64::from(i as u32 / 2 % 4);
        let stretched = azimuths.quantity(a);
        // Either end of either axis, so that a table that folds has to.
        let phi = if i.is_multiple_of(2) { TAU * a } else { stretched + 0.25 * TAU * quadrant };
        let [c, s] = azimuths.direction(a);
        let (_, cos) = place(i, Interval::point(azimuths.sigma(c, s)));
        let sin = (1.0 - f64::from(cos).powi(2)).max(0.0).sqrt();
        let v = Vec3::new((sin * libm::cos(phi)) as f32, (sin * libm::sin(phi)) as f32, cos);
        let cos = f64::from(cos);
        let exact = model.at(cos, libm::atan2(f64::from(v.y), f64::from(v.x)))?.of(spec.masking);
        let stand_in = model.stand_in(cos)?.map(|albedo| albedo.of(spec.masking));
        let total = |moments: [f64; 3]| moments[0] + moments[1];
        Ok(Reference {
            v,
            exact,
            shortcut: stand_in.map(|stand_in| (total(stand_in) - total(exact)).abs()),
            outside: outside(f64::INFINITY, v.z, Interval::point(f64::INFINITY)),
        })
    };
    (0..POINTS).into_par_iter().map(one).collect()
}

/// The table with its certificate: errors of E and of the moments, and by how much the round stand-in would be off.
///
/// # Errors
/// [`LoadError`] if the table is not sound.
pub fn certified(table: Table, references: &[Reference]) -> Result<Table, LoadError> {
    let bound = ViewAlbedo::new(&table)?;
    let errors: Vec<([f64; 4], bool)> = references
        .iter()
        .map(|at| {
            let Moments { scale, bias, f82 } = bound.moments(at.v);
            let got = [scale, bias, f82].map(f64::from);
            let error = |i: usize| (got[i] - at.exact[i]).abs();
            let total = (got[0] + got[1] - at.exact[0] - at.exact[1]).abs();
            ([error(0), error(1), error(2), total], at.outside)
        })
        .collect();
    let mut certificate = table.certificate.clone();
    let inside = || errors.iter().filter(|point| !point.1);
    for (i, name) in ["scale", "bias", "f82", "e"].into_iter().enumerate() {
        let max = inside().map(|point| point.0[i]).fold(0.0, f64::max);
        let sum: f64 = inside().map(|point| point.0[i] * point.0[i]).sum();
        certificate.insert(format!("{name}_max_error"), round_up(max));
        certificate.insert(format!("{name}_rms_error"), round_up((sum / inside().count() as f64).sqrt()));
    }
    let grazing = errors.iter().filter(|point| point.1).map(|point| point.0[3]).fold(0.0, f64::max);
    certificate.insert("e_max_error_outside".into(), round_up(grazing));
    let shortcuts = references.iter().filter(|at| !at.outside).filter_map(|at| at.shortcut);
    if let Some(worst) = shortcuts.reduce(f64::max) {
        certificate.insert("shortcut_max_error".into(), round_up(worst));
    }
    certificate.insert("points".into(), errors.len() as f64);
    Ok(Table { certificate, ..table })
}

/// By how much the table's nodes are missed if every other azimuth, or every other view, is left out: which axis is the coarser one.
///
/// # Errors
/// [`LoadError`] if the table is not sound.
pub fn missed_by_half(table: &Table) -> Result<[f64; 2], LoadError> {
    let whole = ViewAlbedo::new(table)?;
    let missed = |axis: usize| -> Result<f64, LoadError> {
        let half = ViewAlbedo::new(&half(table, axis))?;
        let mut worst = 0.0_f32;
        let [azimuths, views] = &table.axes[..] else { unreachable!("validated by `new`") };
        let (Mapping::Azimuth(azimuth), Mapping::ViewBlend(blend)) = (azimuths.mapping, views.mapping) else {
            unreachable!("validated by `new`")
        };
        let azimuth = azimuth.bind(azimuths.len());
        for &t in &azimuths.nodes {
            let [c, s] = azimuth.direction(t);
            let view = blend.bind_shaped(azimuth.sigma(c, s));
            for cos in views.nodes.iter().map(|&t| view.quantity(t)) {
                let sin = ((1.0 - cos) * (1.0 + cos)).sqrt();
                let v = Vec3::new((sin * c) as f32, (sin * s) as f32, cos as f32);
                let (a, b) = (whole.moments(v), half.moments(v));
                worst = worst.max((a.scale - b.scale).abs()).max((a.bias - b.bias).abs());
                worst = worst.max((a.f82 - b.f82).abs());
            }
        }
        Ok(f64::from(worst))
    };
    Ok([missed(0)?, missed(1)?])
}

/// Every other node along an axis.
fn half(table: &Table, axis: usize) -> Table {
    let mut thin = table.clone();
    thin.axes[axis].nodes = table.axes[axis].nodes.iter().copied().step_by(2).collect();
    let views = table.axes[1].len();
    let kept = |i: &usize| [i / views, i % views][axis].is_multiple_of(2);
    let nodes = table.values.chunks_exact(table.channels.len()).enumerate().filter(|(i, _)| kept(i));
    thin.values = nodes.flat_map(|(_, node)| node.iter().copied()).collect();
    thin
}
