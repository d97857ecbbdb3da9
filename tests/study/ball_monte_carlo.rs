//! The ball's Monte-Carlo in part: the full one takes minutes.

use maglev_fmu::study::ball_monte_carlo::{Extent, run_extent};
use maglev_fmu::study::claim::Verdict;
use maglev_fmu::study::output;
use maglev_fmu_test::packages;

const RUNS: u32 = 10;

#[test]
fn adaptive_newton_wins_where_the_others_drop_the_ball() {
    let extent = Extent { runs: RUNS, stride: 13 };
    let findings =
        run_extent(packages::directory(), extent, &|share, _| assert!((0.0..=1.0).contains(&share))).unwrap();

    let claim = |id: &str| findings.claims.iter().find(|claim| claim.id == id).unwrap();
    let survives = claim("adaptive_newton_survives_spread_a");
    assert_eq!(survives.verdict, Verdict::Reproduced);
    let survivors = |who: &str| -> f64 {
        let rows = survives.measured.iter().filter(|row| row.what.contains(who));
        rows.map(|row| row.value).sum()
    };
    assert_eq!(survivors("adaptive Newton, resistance"), f64::from(2 * RUNS));
    assert!(survivors("DREM") < survivors("adaptive Newton, resistance"), "{:?}", survives.measured);
    assert_eq!(claim("drem_stands_noise_of_1_ma").verdict, Verdict::NotReproduced);

    // Every estimator appears once per spread; all of them hold the ball where only the flux is unknown.
    for (table, name) in findings.summaries.iter().zip(["A", "B", "C", "D"]) {
        assert!(table.title.starts_with(&format!("Spread {name}")), "{}", table.title);
        assert_eq!(table.rows.len(), 5);
    }
    for row in &findings.summaries[3].rows[2..] {
        assert_eq!([&row[2], &row[5]], [&format!("{RUNS} of {RUNS}"); 2], "{row:?}");
    }
    assert!(
        findings.advice[0].contains("adaptive Newton, resistance, 0 of 20 lost"),
        "{}",
        findings.advice[0]
    );

    let directory = tempfile::tempdir().unwrap();
    let report = output::write(directory.path(), std::slice::from_ref(&findings)).unwrap();
    let report = std::fs::read_to_string(report).unwrap();
    assert!(report.contains("every numeric parameter is assumed or tuned"));
    for figure in &findings.figures {
        let png = std::fs::read(directory.path().join(&figure.name).with_extension("png")).unwrap();
        assert!(png.len() > 50_000, "{}: {} bytes", figure.name, png.len());
    }
}
