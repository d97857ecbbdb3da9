//! The comparison of the bearing's observers, through the packaged models.

use maglev_fmu::study::claim::Verdict;
use maglev_fmu::study::{EXPERIMENTS, Findings, Table};
use maglev_fmu_test::packages;

fn findings() -> Findings {
    let experiment = EXPERIMENTS.iter().find(|experiment| experiment.name == "bearing-observers").unwrap();
    (experiment.run)(packages::directory(), &|_, _| ()).unwrap()
}

/// Value of the column whose header starts with `header`, at a sample time \[s\] and a noise \[m\].
fn value(table: &Table, header: &str, sample_time: f64, noise: f64) -> f64 {
    let column = table.headers.iter().position(|candidate| candidate.starts_with(header)).unwrap();
    let row = (0..table.columns[0].len())
        .find(|row| table.columns[0][*row] == sample_time && table.columns[1][*row] == noise)
        .unwrap();
    table.columns[column][row]
}

#[test]
fn observers_rank_as_they_should() {
    let findings = findings();
    let table = &findings.figures[0].table;
    for noise in [1e-9, 1e-8, 1e-7, 1e-6] {
        let flux = |observer: &str| value(table, &format!("{observer}: rms flux"), 1e-3, noise);
        let bound = value(table, "Cramer-Rao bound of flux", 1e-3, noise);
        let kalman = flux("Kalman no process noise");
        println!("noise {noise:e} m: Kalman {kalman:e} Wb, bound {bound:e} Wb");
        assert!(kalman < 1.1 * bound, "{kalman} {bound}");
        assert!(kalman < flux("Kalman default noise"));
        // Least squares over longer windows, and nothing of it near the filter.
        let windows = ["Newton exact model", "Newton 10 samples", "Newton 30 samples"].map(flux);
        assert!(windows[0] > 2.0 * windows[1] && windows[1] > 2.0 * windows[2], "{windows:?}");
        assert!(windows[2] > 1e3 * kalman);
        let up = |observer: &str| value(table, &format!("{observer}: share"), 1e-3, noise);
        assert_eq!(up("Kalman no process noise"), 1.0);
        assert_eq!(up("Kalman default noise"), 1.0);
    }
    // Without noise: the printed reduced observer is biased, the compensated one and exact Newton are not.
    let clean = |observer: &str| value(table, &format!("{observer}: rms flux"), 1e-3, 0.0);
    assert!(clean("reduced Newton printed") > 1e-2);
    assert!(clean("reduced Newton compensated") < 1e-4);
    assert!(clean("Newton exact model") < 1e-7);

    assert_eq!(findings.figures.len(), 2);
    assert!(findings.advice[0].contains("at 1e-6 m Kalman"), "{}", findings.advice[0]);
    let verdict = |id: &str| findings.claims.iter().find(|claim| claim.id == id).unwrap().verdict;
    assert_eq!(verdict("reduced_observer_estimates_the_flux"), Verdict::NotReproduced);
    assert_eq!(verdict("fast_sampling_is_ill_conditioned"), Verdict::Reproduced);

    // The cascade settles from every start, the printed law does not.
    let settling = findings.summaries.last().unwrap();
    let settled: Vec<bool> =
        settling.rows.iter().map(|row| row[1].ends_with(" s") && !row[1].starts_with("not")).collect();
    assert_eq!(settled, [false, true, true, true]);
}
