//! Reproductions of the papers, a small path tracer, and the measurements behind the choices that
//! the other crates make. This crate is not published.
//!
//! `cargo run --release -p microfacet-study` lists them; each module says what it prints, and which
//! page of `docs/` shows it. `docs/reproduced.md` has the claims of the papers, one a row.

pub mod albedo_convergence;
pub mod albedo_design;
pub mod closed_forms;
pub mod dielectric_design;
pub mod dielectric_views;
pub mod ellipsoid_cost;
pub mod ellipsoid_note;
pub mod engines;
pub mod fit_normals;
pub mod frame_time;
pub mod idea;
pub mod merl;
pub mod planned;
pub mod printed_formulas;
pub mod progress;
pub mod reference;
pub mod report_sphere;
pub mod reproduced;
pub mod sawicki;
pub mod spheres;
pub mod stand_in;
pub mod student_t_paper;
pub mod table_design;
pub mod tail;

use std::error::Error;

use microfacet_baker::bake::albedo::{AlbedoError, AlbedoSpec, bake};
use microfacet_baker::certify::albedo::{certified, edge_references, interior_references};
use microfacet_baker::progress::Stage;
use microfacet_tables::Table;

/// The result of a study.
pub type Outcome = Result<(), Box<dyn Error>>;

/// A study, as the command line names it.
#[derive(Clone, Copy, Debug)]
pub struct Study {
    /// Its name, which is that of its module.
    pub name: &'static str,
    /// What it shows.
    pub what: &'static str,
    /// Runs it, given the arguments after its name.
    pub run: fn(&[String]) -> Outcome,
}

const fn study(name: &'static str, what: &'static str, run: fn(&[String]) -> Outcome) -> Study {
    Study { name, what, run }
}

/// All studies, by name.
pub const STUDIES: [Study; 24] = [
    study(
        "albedo_convergence",
        "error against time of one directional albedo",
        albedo_convergence::run,
    ),
    study("albedo_design", "coordinates of the view for albedos", albedo_design::run),
    study(
        "closed_forms",
        "masking and albedos without tables: forms, their sizes and errors",
        closed_forms::run,
    ),
    study(
        "dielectric_design",
        "tables of albedos of dielectrics: errors and sizes [ROW]",
        dielectric_design::run,
    ),
    study("dielectric_views", "nodes of views from inside a dielectric", dielectric_views::run),
    study("ellipsoid_cost", "time of a normal of an ellipsoid", ellipsoid_cost::run),
    study("ellipsoid_note", "the claims of the Ellipsoid note", ellipsoid_note::run),
    study("engines", "errors of the albedos that engines ship [FOLDER]", engines::run),
    study("fit_normals", "fits of five distributions to synthetic normals", fit_normals::run),
    study("frame_time", "time to picture of textured gold beside GGX; --help", frame_time::run),
    study("idea", "the pictures of docs/idea.md FOLDER", idea::run),
    study("merl", "makes files in the format of the MERL database [--start] FOLDER", merl::run),
    study("planned", "what bakes take next to what is planned [RECIPE ...]", planned::run),
    study(
        "printed_formulas",
        "the printed formulas for masking beside ours",
        printed_formulas::run,
    ),
    study("progress", "how far the time left is off TARGET [RECIPE]", progress::run),
    study("reference", "writes the test vectors FILE", reference::run),
    study("report_sphere", "the sphere of a page by the crate's BSDFs; --help", report_sphere::run),
    study("reproduced", "numbers that papers print beside figures", reproduced::run),
    study("sawicki", "the equations of Sawicki 2021", sawicki::run),
    study("spheres", "figures 7 to 9 of Ribardiere et al. 2017; --help", spheres::run),
    study(
        "stand_in",
        "how far the albedo of a round lobe is off that of an anisotropic one",
        stand_in::run,
    ),
    study("student_t_paper", "the equations of Ribardiere et al. 2017", student_t_paper::run),
    study("table_design", "designs of the table of visible slopes", table_design::run),
    study("tail", "a second GGX and one gamma for each other [FOLDER]", tail::run),
];

/// Prints the head of a table in Markdown.
fn print_head(columns: &[&str]) {
    println!("| {} |\n|{}", columns.join(" | "), " --- |".repeat(columns.len()));
}

/// The albedo tables of a specification, with their certificates.
fn baked(spec: &AlbedoSpec) -> Result<Vec<Table>, AlbedoError> {
    let stage = Stage::unwatched();
    let tables = bake(spec)?;
    let edges = edge_references(spec, &tables, &stage)?;
    certified(spec, tables, &[interior_references(spec, &stage)?, edges].concat(), &stage)
}
