//! The reproduction of the levitated ball paper, from packages to files.

use std::sync::LazyLock;

use maglev_fmu::study::claim::{Claim, Verdict};
use maglev_fmu::study::{EXPERIMENTS, Findings, output};
use maglev_fmu_test::packages;

/// One run serves all tests.
static FINDINGS: LazyLock<Findings> = LazyLock::new(|| {
    let experiment = EXPERIMENTS.iter().find(|experiment| experiment.name == "ball").unwrap();
    (experiment.run)(packages::directory(), &|share, _| assert!((0.0..=1.0).contains(&share))).unwrap()
});

fn claim(id: &str) -> &'static Claim {
    FINDINGS.claims.iter().find(|claim| claim.id == id).unwrap()
}

/// Measured value whose name starts with `what`.
fn measured(id: &str, what: &str) -> f64 {
    let found = claim(id).measured.iter().find(|measurement| measurement.what.starts_with(what));
    found.unwrap_or_else(|| panic!("{id}: no {what}")).value
}

#[test]
fn figures_claims_and_report_are_written() {
    let directory = tempfile::tempdir().unwrap();
    let out = directory.path();
    let report = output::write(out, std::slice::from_ref(&*FINDINGS)).unwrap();
    let names: Vec<&str> = FINDINGS.figures.iter().map(|figure| figure.name.as_str()).collect();
    assert_eq!(names, [2, 3, 4, 5, 6, 7].map(|number| format!("ball_figure_{number}")));
    for name in names {
        let svg = std::fs::read_to_string(out.join(format!("{name}.svg"))).unwrap();
        assert!(svg.starts_with("<svg") && svg.contains("time [s]"), "{name}");
        let png = std::fs::read(out.join(format!("{name}.png"))).unwrap();
        assert!(png.starts_with(b"\x89PNG") && png.len() > 50_000, "{name}: {} bytes", png.len());
        let mut csv = csv::Reader::from_path(out.join(format!("{name}.csv"))).unwrap();
        let columns = csv.headers().unwrap().len();
        // Fails on a row of another length.
        assert!(
            csv.records().map(Result::unwrap).filter(|row| row.len() == columns).count() > 2000,
            "{name}"
        );
    }
    let report = std::fs::read_to_string(report).unwrap();
    assert!(report.contains("lost every equation") && report.contains("assumed or tuned"));
    let json: serde_json::Value =
        serde_json::from_slice(&std::fs::read(out.join("claims.json")).unwrap()).unwrap();
    for claim in json[0]["claims"].as_array().unwrap() {
        assert!(report.contains(&format!("id=\"{}\"", claim["id"].as_str().unwrap())));
        for measurement in claim["measured"].as_array().unwrap() {
            assert!(measurement["value"].is_number(), "{claim}");
        }
    }
}

#[test]
fn verdicts_are_those_that_were_measured_independently() {
    for id in [
        "ball_follows_without_position_sensor",
        "flux_estimate_converges",
        "speed_and_position_follow_from_the_flux",
        "as_good_as_full_information",
        "gain_speeds_up_convergence",
        "steady_state_error_grows_with_gain",
        "excitation_depends_on_the_filters",
        "excitation_is_needed",
        "open_loop_integration_is_problematic",
        "drem_works_sampled",
        "newton_needs_no_excitation_and_no_fast_sampling",
    ] {
        assert_eq!(claim(id).verdict, Verdict::Reproduced, "{id}");
    }
    assert_eq!(claim("performance_still_satisfactory").verdict, Verdict::CannotBeJudged);
    assert_eq!(claim("computational_complexity_is_high").verdict, Verdict::NotReproduced);
}

/// Figures of the independent continuous prototype; the sampled loop may differ by what 0.1 ms does.
#[test]
fn numbers_are_those_of_the_continuous_loop() {
    let near = |value: f64, expected: f64, share: f64| {
        assert!((value / expected - 1.0).abs() <= share, "{value} {expected}");
    };
    near(measured("flux_estimate_converges", "slowest of the sinusoids"), 0.354, 0.02);
    near(measured("flux_estimate_converges", "slowest of the steps"), 3.05, 0.01);
    near(measured("ball_follows_without_position_sensor", "largest |y - y*|"), 3.02, 0.01);
    // Figure 7, by gain.
    for (gain, share) in
        [("0.0001", 0.1001), ("0.001", 0.1006), ("0.01", 0.1058), ("0.1", 0.1287), ("1", 0.1310)]
    {
        let name = format!("|flux error| / lam0 after 10 s, gamma = {gain} 1/s");
        near(measured("steady_state_error_grows_with_gain", &name), share, 2e-3);
    }
    // The bias of a frozen flux error of 2 %, by mechanical rate.
    let table =
        FINDINGS.summaries.iter().find(|table| table.title.starts_with("A frozen flux error")).unwrap();
    for (row, millimetres) in table.rows.iter().zip([0.6367, 0.5067, 0.4494]) {
        let value: f64 = row[1].strip_suffix(" mm").unwrap().parse().unwrap();
        near(value, millimetres, 2e-3);
    }
}
