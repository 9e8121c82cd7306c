//! The command: its words, options, outputs, pages, and the docs that show it.

#[path = "../common/mod.rs"]
mod common;

mod cli;
mod docs;
mod options;
mod outputs;
mod recipe_page;
mod report_cli;
mod shell;
mod survey;
