//! The master of two models, with a small model of each version.

use maglev_fmu::host::{ControlLoop, ExchangeOrder, Fmu, HostError, Instance, Logging};

use super::small_model::*;

/// Controller `y = -u / 2`, plant `y <- y + u` from `y = 1`: the models of a loop, one of each version.
fn control_loop(order: ExchangeOrder) -> ControlLoop {
    let [two, three] = both();
    let with_parameters = |fmu: &Fmu, name: &str, parameters: [f64; 3]| -> Instance {
        let mut model = fmu.instantiate(name, Logging::Off).unwrap();
        for (variable, value) in ["y", "a", "b"].into_iter().zip(parameters) {
            model.set_by_name(variable, value).unwrap();
        }
        model
    };
    let controller = with_parameters(&two, "controller", [0.0, 0.0, -0.5]);
    let plant = with_parameters(&three, "plant", [1.0, 1.0, 1.0]);
    let mut control_loop =
        ControlLoop::connect(controller, plant, order, &[("y", "u"), ("flag", "flag")], &[("y", "u")])
            .unwrap();
    control_loop.record(&[("plant", "y"), ("controller", "y"), ("plant", "steps")]).unwrap();
    control_loop
}

#[test]
fn the_controller_acts_at_once_or_one_step_late() {
    let mut at_once = control_loop(ExchangeOrder::ControllerFirst);
    at_once.initialise(10.0, None, 0.1).unwrap();
    let trace = at_once.run(3).unwrap();
    assert_eq!(trace.names, ["plant.y", "controller.y", "plant.steps"]);
    assert_eq!(trace.units, [Some("m".to_owned()), Some("m".to_owned()), None]);
    assert_eq!(trace.time, [10.0, 10.0 + 0.1, 10.0 + 2.0 * 0.1]);
    assert_eq!(trace.column("plant.y").unwrap(), [1.0, 0.5, 0.25]);
    assert_eq!(trace.column("controller.y").unwrap(), [-0.5, -0.25, -0.125]);
    assert_eq!(trace.column("plant.steps").unwrap(), [0.0, 1.0, 2.0]);
    assert_eq!(at_once.plant().get_by_name("y").unwrap(), 0.125, "the plant after the last step");

    let mut late = control_loop(ExchangeOrder::Parallel);
    late.initialise(10.0, None, 0.1).unwrap();
    let trace = late.run(4).unwrap();
    assert_eq!(trace.column("plant.y").unwrap(), [1.0, 1.0, 0.5, 0.0]);
    assert_eq!(trace.column("controller.y").unwrap(), [0.0, -0.5, -0.5, -0.25]);
}

#[test]
fn a_wire_may_add_an_offset() {
    let mut biased = control_loop(ExchangeOrder::ControllerFirst);
    biased.add_offset("u", 0.25).unwrap();
    biased.initialise(0.0, None, 0.1).unwrap();
    assert_eq!(biased.run(3).unwrap().column("plant.y").unwrap(), [1.0, 0.75, 0.625]);
    let unwired = biased.add_offset("y", 1.0).unwrap_err();
    assert_eq!(unwired.to_string(), "no wire leads to `y` of `plant`");
}

#[test]
fn a_run_goes_on_where_the_last_one_ended() {
    for order in [ExchangeOrder::ControllerFirst, ExchangeOrder::Parallel] {
        let mut whole = control_loop(order);
        whole.initialise(0.0, Some(1.0), 0.01).unwrap();
        let expected = whole.run(20).unwrap();

        let mut split = control_loop(order);
        split.initialise(0.0, Some(1.0), 0.01).unwrap();
        let mut trace = split.run(7).unwrap();
        assert_eq!(split.time(), Some(7.0 * 0.01));
        split.run_into(&mut trace, 13, |_, _, _| Ok(())).unwrap();
        assert_eq!(trace, expected);
    }
}

#[test]
fn an_intervention_sees_every_communication_point() {
    let mut control_loop = control_loop(ExchangeOrder::ControllerFirst);
    control_loop.initialise(0.0, None, 0.5).unwrap();
    let mut times = Vec::new();
    let trace = control_loop
        .run_with(3, |time, controller, plant| {
            times.push(time);
            controller.set_by_name("b", 0.0)?;
            plant.set_by_name("y", time)
        })
        .unwrap();
    assert_eq!(times, [0.0, 0.5, 1.0]);
    assert_eq!(trace.column("plant.y").unwrap(), times);
}

#[test]
fn a_misused_loop_says_so() {
    let mut control_loop = control_loop(ExchangeOrder::Parallel);
    assert!(matches!(control_loop.run(1), Err(HostError::LoopNotInitialised { .. })));
    for step_size in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(matches!(control_loop.initialise(0.0, None, step_size), Err(HostError::StepSize { .. })));
    }
    assert!(matches!(
        control_loop.record(&[("observer", "y")]),
        Err(HostError::UnknownModel { model, .. }) if model == "observer"
    ));
    assert!(matches!(control_loop.record(&[("plant", "z")]), Err(HostError::UnknownVariable { .. })));
    control_loop.initialise(0.0, None, 0.1).unwrap();
    let mut foreign = maglev_fmu::host::Trace::default();
    assert!(matches!(
        control_loop.run_into(&mut foreign, 1, |_, _, _| Ok(())),
        Err(HostError::ForeignTrace { .. })
    ));
    let (controller, plant) = control_loop.into_instances();
    let unknown = ControlLoop::connect(controller, plant, ExchangeOrder::Parallel, &[("y", "w")], &[]);
    assert!(matches!(unknown, Err(HostError::UnknownVariable { variable, .. }) if variable == "w"));
}
