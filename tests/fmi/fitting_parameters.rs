//! Parameters that do not fit together are refused when they are complete, at the end of initialisation or when a tunable
//! one is set afterwards, and not at the first step.

use super::harness::{BOTH, Component, OK, plants};

#[test]
fn equal_prefilters_end_no_initialisation() {
    let nearly = [100.0, 100f64.next_up(), 100.0 + 1e-10, 100.0 - 1e-5];
    for (standard, second) in BOTH.into_iter().flat_map(|standard| nearly.map(|second| (standard, second))) {
        let component = Component::new(standard, "LevitatedBallController");
        assert_eq!(component.set("observer.prefilter[2]", second), OK);
        assert_eq!(component.enter_initialization(0.0, None), OK);
        // An importer between setting the one and the other may read what it likes.
        assert_eq!(component.get("voltage"), 0.0);
        component.recorder.clear();
        let said = "observer.prefilter[1] and observer.prefilter[2] are both 100 1/s: expected numbers that differ by a millionth or more";
        for _ in 0..2 {
            component.assert_refused(component.exit_initialization(), &[said]);
        }
        // Still in initialisation, and nothing is lost.
        assert_eq!(component.set("observer.prefilter[1]", 300.0), OK);
        assert_eq!(component.exit_initialization(), OK);
        assert_eq!(component.step(0.0, 1e-3), OK);
    }
}

#[test]
fn a_sample_time_too_short_hides_nothing_until_it_is_refused() {
    for (standard, model) in plants() {
        let component = Component::new(standard, model);
        assert_eq!(component.set("sensor.sample_time", 1e-12), OK);
        assert_eq!(component.enter_initialization(1e5, None), OK);
        assert_eq!(component.get("sensor.sample_time"), 1e-12);
        assert!(component.get("initial.position").is_finite());
        component.recorder.clear();
        let said = "sensor.sample_time = 1e-12 s: expected 0 or at least 1e-6 s";
        component.assert_refused(component.exit_initialization(), &[said]);
        assert_eq!(component.set("sensor.sample_time", 0.0), OK);
        assert_eq!(component.exit_initialization(), OK);
    }
}

#[test]
fn a_law_that_divides_by_its_gain_gets_none_of_zero() {
    for standard in BOTH {
        let component = Component::new(standard, "MaglevRigController");
        let [kind, gain] = ["controller.kind", "controller.input_gain"];
        assert_eq!(component.set(kind, 2.0), OK);
        assert_eq!(component.set(gain, 0.0), OK);
        assert_eq!(component.enter_initialization(0.0, None), OK);
        component.recorder.clear();
        let said = [
            "controller.input_gain = 0 1/s2",
            "expected another number than 0 with controller.kind = disturbance_rejection",
        ];
        component.assert_refused(component.exit_initialization(), &said);
        assert_eq!(component.set(kind, 1.0), OK);
        assert_eq!(component.exit_initialization(), OK);
        component.recorder.clear();

        // Tunable: refused when set, all or nothing.
        component.assert_refused(component.set(kind, 2.0), &said);
        assert_eq!(component.get(kind), 1.0);
        assert_eq!(component.set(gain, -3705.0), OK);
        assert_eq!(component.set(kind, 2.0), OK);
        let [bandwidth, gain_row] = ["controller.bandwidth", gain].map(|name| component.reference(name));
        component.assert_refused(component.set_reals(&[bandwidth, gain_row], &[50.0, 0.0]), &said);
        assert_eq!((component.get("controller.bandwidth"), component.get(gain)), (60.0, -3705.0));
        assert_eq!(component.step(0.0, 1e-3), OK);
    }
}
