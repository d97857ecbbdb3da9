//! A model behind the C boundary, stepped as an importer would.

use core::ffi::c_void;
use std::hint::black_box;

use maglev_fmu::fmi::fmi2::{
    fmi2DoStep, fmi2EnterInitializationMode, fmi2ExitInitializationMode, fmi2FreeInstance, fmi2GetReal,
    fmi2Reset, fmi2SetReal,
};
use maglev_fmu::fmi::{Callback, Instance, Interface, Logger};
use maglev_fmu::model::Model;

/// Value reference of a variable.
pub fn reference(model: &dyn Model, name: &str) -> u32 {
    model.description().find(name).expect("a variable of the table").0 as u32
}

/// An instance with `INPUTS` inputs that are set before every step and four outputs that are read after it.
pub struct Component<const INPUTS: usize> {
    handle: *mut c_void,
    inputs: [u32; INPUTS],
    outputs: [u32; 4],
}

impl<const INPUTS: usize> Component<INPUTS> {
    /// `model` with some values; reset goes back to it as given here.
    pub fn new(
        mut model: impl Model + 'static,
        inputs: [&str; INPUTS],
        outputs: [&str; 4],
        values: &[(&str, f64)],
    ) -> Self {
        for (name, value) in values {
            let reference = reference(&model, name) as usize;
            model.values_mut()[reference] = *value;
        }
        let inputs = inputs.map(|name| reference(&model, name));
        let outputs = outputs.map(|name| reference(&model, name));
        let logger = Logger::new(Callback::None, c"bench", false).unwrap();
        let instance = Instance::new(Box::new(model), Interface::CoSimulation, logger).unwrap();
        Self { handle: Box::into_raw(Box::new(instance)).cast(), inputs, outputs }
    }

    /// Plays recorded inputs from a fresh start, in steps of `step_size` \[s\].
    pub fn play(&mut self, inputs: &[[f64; INPUTS]], step_size: f64) {
        // SAFETY: a live handle, one thread.
        unsafe {
            fmi2Reset(self.handle);
            fmi2EnterInitializationMode(self.handle);
            fmi2ExitInitializationMode(self.handle);
        }
        // Through opaque pointers, as if loaded: nothing is inlined into the loop.
        let set: unsafe extern "C-unwind" fn(_, *const _, _, *const _) -> _ = black_box(fmi2SetReal);
        let step: unsafe extern "C-unwind" fn(_, _, _, _) -> _ = black_box(fmi2DoStep);
        let get: unsafe extern "C-unwind" fn(_, *const _, _, *mut _) -> _ = black_box(fmi2GetReal);
        let mut outputs = [0.0; 4];
        let mut failures = 0;
        let mut time = 0.0;
        for input in inputs {
            // SAFETY: a live handle, one thread, arrays of the given length.
            unsafe {
                failures += set(self.handle, self.inputs.as_ptr(), INPUTS, input.as_ptr());
                failures += step(self.handle, time, step_size, 1);
                failures += get(self.handle, self.outputs.as_ptr(), 4, outputs.as_mut_ptr());
            }
            time += step_size;
            black_box(&outputs);
        }
        assert_eq!(failures, 0);
    }
}

impl<const INPUTS: usize> Drop for Component<INPUTS> {
    fn drop(&mut self) {
        // SAFETY: made in `new`, freed once.
        unsafe { fmi2FreeInstance(self.handle) }
    }
}
