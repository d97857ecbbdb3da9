//! The reproduction of the bearing paper, from packages to files.

use std::sync::LazyLock;

use maglev_fmu::study::claim::Verdict;
use maglev_fmu::study::{EXPERIMENTS, Findings, output};
use maglev_fmu_test::packages;

/// One run serves all tests.
static FINDINGS: LazyLock<Findings> = LazyLock::new(|| {
    let experiment = EXPERIMENTS.iter().find(|experiment| experiment.name == "bearing").unwrap();
    (experiment.run)(packages::directory(), &|share, _| assert!((0.0..=1.0).contains(&share))).unwrap()
});

#[test]
fn figures_claims_and_report_are_written() {
    let directory = tempfile::tempdir().unwrap();
    let out = directory.path();
    let report = output::write(out, std::slice::from_ref(&*FINDINGS)).unwrap();

    let names: Vec<&str> = FINDINGS.figures.iter().map(|figure| figure.name.as_str()).collect();
    assert_eq!(names, [2, 3, 4, 5, 6].map(|number| format!("bearing_figure_{number}")));
    for name in names {
        let svg = std::fs::read_to_string(out.join(format!("{name}.svg"))).unwrap();
        assert!(svg.starts_with("<svg") && svg.contains("time [s]"), "{name}");
        let png = std::fs::read(out.join(format!("{name}.png"))).unwrap();
        let mut csv = csv::Reader::from_path(out.join(format!("{name}.csv"))).unwrap();
        let columns = csv.headers().unwrap().len();
        assert!(columns > 7, "{name}");
        // Fails on a row of another length.
        assert_eq!(csv.records().map(Result::unwrap).filter(|row| row.len() == columns).count(), 10_001);
        assert!(png.starts_with(b"\x89PNG") && png.len() > 50_000, "{name}: {} bytes", png.len());
    }

    let report = std::fs::read_to_string(report).unwrap();
    let json: serde_json::Value =
        serde_json::from_slice(&std::fs::read(out.join("claims.json")).unwrap()).unwrap();
    let claims = json[0]["claims"].as_array().unwrap();
    assert_eq!(claims.len(), FINDINGS.claims.len());
    for claim in claims {
        assert!(report.contains(&format!("id=\"{}\"", claim["id"].as_str().unwrap())));
        assert!(!claim["measured"].as_array().unwrap().is_empty() && claim["criterion"].is_string());
    }
}

#[test]
fn data_are_those_of_the_run() {
    let table = &FINDINGS.figures[1].table;
    assert_eq!(table.headers[0], "time [s]");
    assert_eq!(table.columns[0].len(), 10_001);
    assert_eq!(*table.columns[0].last().unwrap(), 10.0);
    // x1(10 s) of the observer loop, from the independent prototype's trajectory.
    let row = include_str!("../reference/bearing_law_a.csv").lines().last().unwrap();
    let reference: f64 = row.split(',').nth(5).unwrap().parse().unwrap();
    let position = table.headers.iter().position(|header| header.ends_with(": position [m]")).unwrap();
    assert!((table.columns[position].last().unwrap() / reference - 1.0).abs() < 1e-6);
}

#[test]
fn verdicts_are_those_that_were_measured_independently() {
    let verdict = |id: &str| FINDINGS.claims.iter().find(|claim| claim.id == id).unwrap().verdict;
    for id in [
        "observer_converges_within_50_ms",
        "observer_converges_for_every_initial_voltage",
        "observer_converges_for_every_law",
        "voltage_within_150_V",
        "observer_loop_agrees_with_state_feedback",
        "flux_estimates_alike_for_every_bias",
    ] {
        assert_eq!(verdict(id), Verdict::Reproduced, "{id}");
    }
    for id in ["settling_below_10_s", "discrete_model_is_exact", "table_1_is_consistent"] {
        assert_eq!(verdict(id), Verdict::NotReproduced, "{id}");
    }
    assert_eq!(verdict("globally_asymptotically_stable"), Verdict::CannotBeJudged);
}
