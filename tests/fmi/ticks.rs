//! The controller's ticks are those of its own clock, however the importer cuts time into steps.

use super::harness::{BOTH, CONTROLLER, Component, OK, Standard};

/// End of the long runs \[s\].
const END: u64 = 100;

/// How an importer computes times.
#[derive(Clone, Copy, Debug)]
enum Arithmetic {
    /// t = k h.
    Multiplied,
    /// t += h.
    Accumulated,
    /// As `Multiplied`, h some units in the last place off, differently in each step.
    NoisyStep,
    /// h is the difference of two multiplied times, as 0.09999999999999964.
    Difference,
}

/// A step size of `numerator / denominator` seconds.
#[derive(Clone, Copy, Debug)]
struct StepSize {
    numerator: u64,
    denominator: u64,
}

const STEP_SIZES: [StepSize; 4] = [
    StepSize { numerator: 1, denominator: 1000 },
    StepSize { numerator: 1, denominator: 4000 },
    StepSize { numerator: 37, denominator: 10_000 },
    StepSize { numerator: 1, denominator: 60 },
];

impl StepSize {
    fn seconds(self) -> f64 {
        self.numerator as f64 / self.denominator as f64
    }

    /// Number of ticks, every 1 ms from 0 on, before the end of step `steps`; in integers.
    fn ticks_before(self, steps: u64) -> u64 {
        (1000 * self.numerator * steps).div_ceil(self.denominator)
    }
}

/// A controller whose outputs change with every tick although its inputs do not: an observer that hardly corrects
/// and a law with the wrong sign oscillate between the voltage limits without a period.
fn controller(standard: Standard) -> Component {
    let component = Component::with_logging(standard, CONTROLLER, false);
    for (name, value) in [
        ("position", 0.01),
        ("observer.max_iterations", 1.0),
        ("observer.step_size", 1e-3),
        ("controller.law", 2.0),
        ("controller.k2", -1000.0),
    ] {
        assert_eq!(component.set(name, value), OK, "{name}");
    }
    component.initialise(0.0);
    component
}

/// Outputs at the end, as bits.
fn outputs(component: &Component) -> Vec<u64> {
    ["voltage", "estimate.velocity", "estimate.flux", "observer.residual"]
        .map(|name| component.get(name).to_bits())
        .into()
}

/// Steps to [`END`] and checks the time of the last tick after every step.
fn run(standard: Standard, step_size: StepSize, arithmetic: Arithmetic) -> Vec<u64> {
    let component = controller(standard);
    let tick_time = [component.reference("tick_time")];
    let h = step_size.seconds();
    let whole_steps = END * step_size.denominator / step_size.numerator;
    let mut t = 0.0;
    let mut value = [0.0];
    for step in 1..=whole_steps {
        let next = step as f64 * h;
        let (time, size) = match arithmetic {
            Arithmetic::Multiplied => ((step - 1) as f64 * h, h),
            Arithmetic::Accumulated => (t, h),
            Arithmetic::NoisyStep => {
                // -3 to 3 units in the last place, in no order.
                let ulps = (step.wrapping_mul(0x9E37_79B9_7F4A_7C15) >> 32) as i64 % 7 - 3;
                ((step - 1) as f64 * h, f64::from_bits(h.to_bits().wrapping_add_signed(ulps)))
            }
            Arithmetic::Difference => ((step - 1) as f64 * h, next - (step - 1) as f64 * h),
        };
        assert_eq!(component.step(time, size), OK, "{step_size:?} {arithmetic:?} step {step}");
        t += h;
        assert_eq!(component.get_reals(&tick_time, &mut value), OK);
        let expected = (step_size.ticks_before(step) - 1) as f64 * 1e-3;
        assert!(value[0] == expected, "{step_size:?} {arithmetic:?} step {step}: {} {expected}", value[0]);
    }
    // 3.7 ms do not divide 100 s.
    let (end, now) = (END as f64, component.get("time"));
    if end - now > 1e-6 {
        assert_eq!(component.step(now, end - now), OK);
    }
    assert_eq!(component.get("tick_time"), (END * 1000 - 1) as f64 * 1e-3);
    outputs(&component)
}

/// All step sizes in one arithmetic, against one big step.
fn check(standard: Standard, arithmetic: Arithmetic) {
    let at_once = controller(standard);
    assert_eq!(at_once.step(0.0, END as f64), OK);
    let reference = outputs(&at_once);
    for step_size in STEP_SIZES {
        assert_eq!(run(standard, step_size, arithmetic), reference, "{step_size:?} {arithmetic:?}");
    }
}

#[test]
fn ticks_with_multiplied_times() {
    check(Standard::Fmi2, Arithmetic::Multiplied);
}

#[test]
fn ticks_with_accumulated_times() {
    check(Standard::Fmi3, Arithmetic::Accumulated);
}

#[test]
fn ticks_with_noise_in_the_step_size() {
    check(Standard::Fmi2, Arithmetic::NoisyStep);
}

#[test]
fn ticks_with_differences_of_times() {
    check(Standard::Fmi3, Arithmetic::Difference);
}

#[test]
fn the_outputs_compared_tell_ticks_apart() {
    let component = controller(Standard::Fmi2);
    assert_eq!(component.step(0.0, END as f64 - 5e-3), OK);
    let mut seen = vec![outputs(&component)];
    for k in 0..5 {
        assert_eq!(component.step(END as f64 - 5e-3 + f64::from(k) * 1e-3, 1e-3), OK);
        let now = outputs(&component);
        assert!(!seen.contains(&now), "tick {k}");
        seen.push(now);
    }
}

#[test]
fn a_million_accumulated_steps_lose_no_tick() {
    for (standard, steps) in BOTH.into_iter().zip([1_000_000, 50_000]) {
        let component = Component::with_logging(standard, CONTROLLER, false);
        assert_eq!(component.set("sample_time", 1e-4), OK);
        assert_eq!(component.set("observer.max_iterations", 1.0), OK);
        component.initialise(0.0);
        let tick_time = [component.reference("tick_time")];
        let (mut t, mut value) = (0.0, [0.0]);
        for k in 0..steps {
            assert_eq!(component.step(t, 1e-4), OK, "step {k}");
            assert_eq!(component.get_reals(&tick_time, &mut value), OK);
            assert!(value[0] == f64::from(k) * 1e-4, "step {k}: {} ", value[0]);
            t += 1e-4;
        }
    }
}
