//! The output files: tables as CSV, everything as JSON, and plots.

use std::path::Path;

use serde_json::{Value, json};

use microfacet_baker::store::replace;

use crate::csv::{csv, number};
use crate::figures::Figure;
use crate::paper::Paper;
use crate::rows::Row;
use crate::settings::{GAMMA, SIGMA, Settings};
use crate::sweep::{Cell, Summary};
use crate::{Failure, plot};

/// Every file of the benchmark by its name.
pub(crate) fn files(
    document: &Value,
    rows: &[Row],
    cells: &[Cell],
) -> Result<Vec<(&'static str, Vec<u8>)>, Failure> {
    Ok(vec![
        ("bench.csv", csv(&ROW, rows.iter().map(row_fields))?),
        ("bench.json", format!("{document:#}\n").into_bytes()),
        ("bench.svg", plot::svg(rows).into_bytes()),
        ("sweep.csv", csv(&CELL, cells.iter().map(cell_fields))?),
    ])
}

/// Writes files into an existing folder.
pub(crate) fn write(folder: &Path, files: &[(&str, Vec<u8>)]) -> Result<(), Failure> {
    for (name, bytes) in files {
        let path = folder.join(name);
        replace(&path, bytes)
            .map_err(|why| Failure(format!("writing {}: {why}", path.display())))?;
    }
    Ok(())
}

const ROW: [&str; 10] = [
    "quantity",
    "name",
    "gamma",
    "ns",
    "bytes",
    "stored_bytes",
    "error_max",
    "error_rms",
    "furnace_variance",
    "variance_ns",
];
const CELL: [&str; 10] = [
    "function", "gamma", "sigma_x", "sigma_y", "turn_x", "turn_y", "turn_z", "views", "numbers",
    "ns",
];

fn optional(x: Option<f64>) -> String {
    x.map_or(String::new(), number)
}

fn row_fields(row: &Row) -> [String; 10] {
    [
        row.quantity.name().into(),
        row.name.clone(),
        row.gamma.to_string(),
        format!("{:.3}", row.ns),
        row.bytes.to_string(),
        row.stored.to_string(),
        optional(row.error.map(|error| error.max)),
        optional(row.error.map(|error| error.rms)),
        optional(row.variance),
        optional(row.cost()),
    ]
}

fn cell_fields(cell: &Cell) -> [String; 10] {
    let ([sigma_x, sigma_y], [x, y, z]) = (cell.sigma, cell.turns);
    [
        cell.function.clone(),
        cell.gamma.to_string(),
        sigma_x.to_string(),
        sigma_y.to_string(),
        x.to_string(),
        y.to_string(),
        z.to_string(),
        cell.views.into(),
        cell.numbers.into(),
        format!("{:.3}", cell.ns),
    ]
}

/// Everything as one JSON document.
pub(crate) fn document(
    settings: &Settings,
    rows: &[Row],
    sweep: &[Summary],
    figures: &[Figure],
    paper: &Paper,
) -> Value {
    // JSON has no infinity.
    let shape = |gamma: f64| if gamma.is_finite() { json!(gamma) } else { json!("inf") };
    let row = |row: &Row| {
        json!({
            "quantity": row.quantity.name(), "name": row.name,
            "gamma": shape(row.gamma), "ns": row.ns, "bytes": row.bytes, "stored_bytes": row.stored,
            "error_max": row.error.map(|error| error.max), "error_rms": row.error.map(|error| error.rms),
            "furnace_variance": row.variance, "variance_ns": row.cost(),
        })
    };
    let summary = |summary: &Summary| {
        let Summary { cells, common, median, most, worst } = summary;
        json!({
            "function": worst.function, "cells": cells,
            "common_ns": common, "median_ns": median, "percentile_99_ns": most, "worst_ns": worst.ns,
            "worst": {
                "gamma": shape(worst.gamma), "sigma": worst.sigma, "turns": worst.turns,
                "views": worst.views, "numbers": worst.numbers,
            },
        })
    };
    let figure = |figure: &Figure| {
        json!({
            "name": figure.name, "unit": figure.unit,
            "must": figure.must, "aim": figure.aim, "reached": figure.reached,
        })
    };
    json!({
        "sigma": SIGMA, "gamma": GAMMA,
        "inputs": "views evenly over the hemisphere, random numbers uniform in [0, 1)",
        "calls": settings.calls, "rounds": settings.rounds, "seed": settings.seed,
        "rows": rows.iter().map(row).collect::<Vec<_>>(),
        "sweep": sweep.iter().map(summary).collect::<Vec<_>>(),
        "figures": figures.iter().map(figure).collect::<Vec<_>>(),
        "paper": paper.json(),
    })
}
