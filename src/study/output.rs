//! Files of a reproduction: per figure CSV, SVG and PNG; all claims; the report.

use std::fs;
use std::path::{Path, PathBuf};

use serde::Serialize;

use super::claim::Claim;
use super::{FigureWithData, Findings, StudyError, Table, report};
use crate::{chart, file};

/// The claims of one experiment in `claims.json`.
#[derive(Serialize)]
struct ExperimentClaims<'a> {
    experiment: &'a str,
    claims: &'a [Claim],
}

/// Writes everything below `directory` and returns the report's path.
pub fn write(directory: &Path, findings: &[Findings]) -> Result<PathBuf, StudyError> {
    make_directory(directory)?;
    let mut pictures = Vec::new();
    for experiment in findings {
        for figure in &experiment.figures {
            pictures.push(write_figure(directory, figure)?);
        }
    }
    let claims: Vec<ExperimentClaims> = findings
        .iter()
        .map(|experiment| ExperimentClaims { experiment: experiment.name, claims: &experiment.claims })
        .collect();
    write_file(&directory.join("claims.json"), serde_json::to_string_pretty(&claims)?.as_bytes())?;
    let path = directory.join("report.html");
    write_file(&path, report::html(findings, &pictures).as_bytes())?;
    Ok(path)
}

/// Endings of the files of a figure.
pub const FIGURE_ENDINGS: [&str; 3] = ["svg", "png", "csv"];

/// Writes a figure as SVG and PNG and its data as CSV and returns the SVG.
pub fn write_figure(directory: &Path, figure: &FigureWithData) -> Result<String, StudyError> {
    make_directory(directory)?;
    let svg = chart::svg(&figure.figure)?;
    let [as_svg, as_png, as_csv] =
        FIGURE_ENDINGS.map(|ending| directory.join(format!("{}.{ending}", figure.name)));
    write_file(&as_svg, svg.as_bytes())?;
    write_file(&as_png, &chart::png(&figure.figure, &svg)?)?;
    write_file(&as_csv, &csv(&figure.table)?)?;
    Ok(svg)
}

/// Makes a directory, and those that it lies in.
pub fn make_directory(path: &Path) -> Result<(), StudyError> {
    fs::create_dir_all(path).map_err(|source| StudyError::Write { path: path.to_owned(), source })
}

/// Shortest decimal numbers that read back to the same bits; headers with commas are quoted.
fn csv(table: &Table) -> Result<Vec<u8>, csv::Error> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    writer.write_record(&table.headers)?;
    let rows = table.columns.first().map_or(0, Vec::len);
    for row in 0..rows {
        writer.write_record(table.columns.iter().map(|column| format!("{:e}", column[row])))?;
    }
    writer.into_inner().map_err(|error| error.into_error().into())
}

fn write_file(path: &Path, bytes: &[u8]) -> Result<(), StudyError> {
    file::replace(path, bytes).map_err(|source| StudyError::Write { path: path.to_owned(), source })
}
