//! The reproduction of the rig's paper and what goes beyond it, from packages to files.

use std::path::Path;
use std::sync::LazyLock;

use maglev_fmu::study::claim::{Claim, Verdict};
use maglev_fmu::study::{EXPERIMENTS, Findings, Summary, output};
use maglev_fmu_test::packages;

fn findings(name: &str) -> Findings {
    let experiment = EXPERIMENTS.iter().find(|experiment| experiment.name == name).unwrap();
    (experiment.run)(packages::directory(), &|share, _| assert!((0.0..=1.0).contains(&share))).unwrap()
}

static PAPER: LazyLock<Findings> = LazyLock::new(|| findings("rig"));
static BEYOND: LazyLock<Findings> = LazyLock::new(|| findings("rig-observers"));

fn claim<'a>(findings: &'a Findings, id: &str) -> &'a Claim {
    findings.claims.iter().find(|claim| claim.id == id).unwrap()
}

/// Number of a claim that is called `what`, or else whose name starts so.
fn measured(claim: &Claim, what: &str) -> f64 {
    let exactly = claim.measured.iter().find(|number| number.what == what);
    exactly.or(claim.measured.iter().find(|number| number.what.starts_with(what))).unwrap().value
}

fn assert_close(value: f64, expected: f64, relative: f64) {
    assert!((value / expected - 1.0).abs() < relative, "{value}, expected {expected}");
}

#[test]
fn table_5_comes_out_of_the_packages() {
    let row = claim(&PAPER, "table_5_simulation");
    assert_close(measured(row, "LESO"), 2.9797e-4, 0.01);
    assert_close(measured(row, "NESO"), 3.363_61e-4, 0.01);
    assert!((measured(row, "NESO over LESO") - 1.1330).abs() < 0.002);
    // One configuration of many, from the independent prototype.
    let row = claim(&PAPER, "table_5_experiment");
    assert_close(measured(row, "LESO"), 9.48e-4, 2e-3);
    assert_close(measured(row, "NESO"), 9.71e-4, 2e-3);
}

#[test]
fn ranking_flips() {
    let general = claim(&PAPER, "leso_better_than_neso");
    assert_close(measured(general, "NESO over LESO of z1: sine and step"), 0.218, 0.02);
    assert_close(measured(general, "the same of z2"), 0.172, 0.02);
    assert!((0.2..0.8).contains(&measured(general, "share of")));
    let noisy = claim(&PAPER, "leso_better_under_noise");
    assert_close(measured(noisy, "NESO over LESO of z1: ball at rest"), 1.77, 0.05);
    assert_close(measured(noisy, "the same of z2"), 4.17, 0.07);
}

#[test]
fn verdicts_are_those_that_were_measured_independently() {
    for (findings, id, verdict) in [
        (&PAPER, "table_5_simulation", Verdict::Reproduced),
        (&PAPER, "table_5_experiment", Verdict::CannotBeJudged),
        (&PAPER, "leso_better_in_table_5", Verdict::Reproduced),
        (&PAPER, "leso_better_than_neso", Verdict::NotReproduced),
        (&PAPER, "leso_better_under_noise", Verdict::CannotBeJudged),
        (&PAPER, "printed_swarm_settles", Verdict::NotReproduced),
        (&PAPER, "printed_parameters_are_optimal", Verdict::NotReproduced),
        (&PAPER, "pid_holds_the_ball", Verdict::Reproduced),
        (&PAPER, "bandwidth_trades_accuracy_for_noise", Verdict::Reproduced),
        (&BEYOND, "extended_state_compensates_disturbances", Verdict::Reproduced),
        (&BEYOND, "printed_observer_serves_control", Verdict::NotReproduced),
    ] {
        assert_eq!(claim(findings, id).verdict, verdict, "{id}");
    }
    assert!(measured(claim(&PAPER, "printed_swarm_settles"), "rms velocity over range") > 10.0);
    assert_close(measured(claim(&PAPER, "printed_parameters_are_optimal"), "J of Table 3 over"), 15.06, 5e-3);
    assert_eq!(measured(claim(&PAPER, "pid_holds_the_ball"), "with the error r - y"), 1.0);
}

/// Numbers of a table's row, by the row's first cell and the columns' places.
fn cell(summary: &Summary, row: &str, column: usize) -> f64 {
    let row = summary.rows.iter().find(|cells| cells[0] == row).unwrap();
    let number = row[column].split([' ', ',']).next().unwrap();
    number.parse().unwrap_or_else(|_| panic!("{} in {}", row[column], summary.title))
}

#[test]
fn disturbance_rejection_is_three_times_better_than_the_pid() {
    let table = &BEYOND.summaries[0];
    assert_close(cell(table, "PID, as printed", 1), 6.46, 2e-3);
    assert_close(cell(table, "LESO wo = 300, wc = 60", 1), 1.81, 5e-3);
    assert_close(cell(table, "LESO wo = 400, wc = 80", 1), 0.85, 1e-2);
    assert_close(cell(table, "LESO wo = 300, wc = 60", 2), 14.4, 5e-3);
    assert!(cell(table, "LESO wo = 300, wc = 60", 4) < cell(table, "PID, as printed", 4) / 3.0);
    for lost in ["LESO of Table 3, b0 = -3705, wc = 40", "LESO of Table 3, b0 = 1, wc = 60"] {
        assert_eq!(table.rows.iter().find(|cells| cells[0] == lost).unwrap()[1], "ball lost");
    }
}

#[test]
fn tuned_observers_beat_the_printed_ones() {
    let table = &BEYOND.summaries[1];
    // Columns from the third on: no noise, 0.1 mV, 1 mV, 3 mV, 1 mV with other masses.
    for column in 2..8 {
        let printed = cell(table, "LESO, Table 3", column).min(cell(table, "NESO, Table 4", column));
        for tuned in
            ["LESO", "LESO, current form", "NESO", "Kalman with disturbance", "Newton with disturbance"]
        {
            assert!(cell(table, tuned, column) < printed, "{tuned}, column {column}");
        }
        // A model without a disturbance bears neither the disturbance step nor a wrong mass.
        assert!(cell(table, "Newton with disturbance", column) < 0.5 * cell(table, "Newton", column));
    }
}

#[test]
fn steady_starts_have_no_peak() {
    let starts = &BEYOND.summaries[2];
    for row in &starts.rows {
        assert!(cell(starts, &row[0], 1) > 0.5, "from zero: {row:?}");
        assert!(cell(starts, &row[0], 3) < 1e-9, "steady: {row:?}");
    }
}

fn assert_files(findings: &Findings, out: &Path) {
    let report = output::write(out, std::slice::from_ref(findings)).unwrap();
    let report = std::fs::read_to_string(report).unwrap();
    for figure in &findings.figures {
        let name = &figure.name;
        let svg = std::fs::read_to_string(out.join(format!("{name}.svg"))).unwrap();
        assert!(svg.starts_with("<svg") && report.contains(&format!("id=\"{name}\"")), "{name}");
        let png = std::fs::read(out.join(format!("{name}.png"))).unwrap();
        assert!(png.starts_with(b"\x89PNG") && png.len() > 30_000, "{name}: {} bytes", png.len());
        let mut csv = csv::Reader::from_path(out.join(format!("{name}.csv"))).unwrap();
        let columns = csv.headers().unwrap().len();
        // Fails on a row of another length.
        let rows = csv.records().map(Result::unwrap).filter(|row| row.len() == columns).count();
        assert!(columns >= 3 && rows >= 7, "{name}: {columns} columns, {rows} rows");
        assert!(figure.table.columns.iter().all(|column| column.len() == rows), "{name}");
    }
    for claim in &findings.claims {
        assert!(report.contains(&format!("id=\"{}\"", claim.id)) && !claim.measured.is_empty());
    }
}

#[test]
fn figures_claims_and_report_are_written() {
    let directory = tempfile::tempdir().unwrap();
    assert_files(&PAPER, directory.path());
    assert_files(&BEYOND, directory.path());
    let names: Vec<&str> = PAPER.figures.iter().map(|figure| figure.name.as_str()).collect();
    assert_eq!(names, ["rig_figure_3", "rig_figure_5", "rig_ranking", "rig_discretisation", "rig_swarm"]);
}
