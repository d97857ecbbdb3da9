//! Cost of saving and restoring the state of an instance through the C ABI, of its bytes, and how many there are; for
//! every model, and for the observers of the magnetic bearing that keep many samples.

mod measure;

use core::ffi::c_void;
use core::ptr::null_mut;

use maglev_fmu::fmi::fmi3::{
    fmi3DeserializeFMUState, fmi3DoStep, fmi3EnterInitializationMode, fmi3ExitInitializationMode,
    fmi3FreeFMUState, fmi3FreeInstance, fmi3GetFMUState, fmi3SerializeFMUState, fmi3SerializedFMUStateSize,
    fmi3SetFMUState,
};
use maglev_fmu::fmi::{Callback, Instance, Interface, LONGEST_SAVED_STATE, Logger};
use maglev_fmu::model::{MAGNETIC_BEARING_CONTROLLER, MODELS, ModelType};
use measure::{Candidate, medians, verdict};

/// What one call does.
type Work = Box<dyn FnMut()>;

const CALLS: usize = 2000;
const ROUNDS: usize = 51;

/// An instance after more steps than any observer keeps samples.
struct Subject {
    handle: *mut c_void,
    state: *mut c_void,
    bytes: Vec<u8>,
}

impl Subject {
    fn new(model: &ModelType, parameters: &[(&str, f64)]) -> Self {
        let mut model = (model.create)();
        for (name, value) in parameters {
            let (reference, _) = model.description().find(name).expect("a variable of the table");
            model.values_mut()[reference] = *value;
        }
        let logger = Logger::new(Callback::None, c"subject", false).unwrap();
        let instance = Instance::new(model, Interface::CoSimulation, logger).unwrap();
        let handle: *mut c_void = Box::into_raw(Box::new(instance)).cast();
        let (mut state, mut size) = (null_mut(), 0);
        // SAFETY: a live handle, room for the results.
        unsafe {
            assert_eq!(fmi3EnterInitializationMode(handle, 0, 0.0, 0.0, 0, 0.0), 0);
            assert_eq!(fmi3ExitInitializationMode(handle), 0);
            for k in 0..100 {
                let (a, b, c, d) = (&mut 0, &mut 0, &mut 0, &mut 0.0);
                assert_eq!(fmi3DoStep(handle, f64::from(k) * 1e-3, 1e-3, 1, a, b, c, d), 0);
            }
            assert_eq!(fmi3GetFMUState(handle, &mut state), 0);
            assert_eq!(fmi3SerializedFMUStateSize(handle, state, &mut size), 0);
        }
        let mut subject = Self { handle, state, bytes: vec![0; size] };
        subject.serialise();
        subject
    }

    fn save(&mut self) {
        // SAFETY: a live handle, a living state.
        assert_eq!(unsafe { fmi3GetFMUState(self.handle, &mut self.state) }, 0);
    }

    fn save_and_free(&self) {
        let mut state = null_mut();
        // SAFETY: a live handle.
        unsafe {
            assert_eq!(fmi3GetFMUState(self.handle, &mut state), 0);
            assert_eq!(fmi3FreeFMUState(self.handle, &mut state), 0);
        }
    }

    fn restore(&self) {
        // SAFETY: a live handle, a living state.
        assert_eq!(unsafe { fmi3SetFMUState(self.handle, self.state) }, 0);
    }

    fn serialise(&mut self) {
        let (bytes, size) = (self.bytes.as_mut_ptr(), self.bytes.len());
        // SAFETY: a live handle, a living state, room for its bytes.
        assert_eq!(unsafe { fmi3SerializeFMUState(self.handle, self.state, bytes, size) }, 0);
    }

    fn deserialise(&mut self) {
        let (bytes, size) = (self.bytes.as_ptr(), self.bytes.len());
        // SAFETY: a live handle, a living state.
        assert_eq!(unsafe { fmi3DeserializeFMUState(self.handle, bytes, size, &mut self.state) }, 0);
    }
}

impl Drop for Subject {
    fn drop(&mut self) {
        // SAFETY: a live handle, a living state, freed once.
        unsafe {
            fmi3FreeFMUState(self.handle, &mut self.state);
            fmi3FreeInstance(self.handle);
        }
    }
}

fn repeated(mut call: impl FnMut()) -> impl FnMut() {
    move || (0..CALLS).for_each(|_| call())
}

fn main() {
    let controller: &ModelType = &MAGNETIC_BEARING_CONTROLLER;
    let plain = MODELS.iter().map(|model| (model.description.name, *model, &[][..]));
    let kalman: &[(&str, f64)] = &[("observer.kind", 4.0)];
    let window: &[(&str, f64)] = &[("observer.window", 64.0)];
    let long = [("bearing, kalman", controller, kalman), ("bearing, window of 64", controller, window)];
    for (name, model, parameters) in plain.chain(long) {
        let subject = || Subject::new(model, parameters);
        let (mut saved, saved_anew, restored) = (subject(), subject(), subject());
        let (mut serialised, mut deserialised) = (subject(), subject());
        let size = saved.bytes.len() as f64;
        let works: [(&str, Work); 5] = [
            ("save", Box::new(repeated(move || saved.save()))),
            ("save to new memory and free", Box::new(repeated(move || saved_anew.save_and_free()))),
            ("restore", Box::new(repeated(move || restored.restore()))),
            ("serialise", Box::new(repeated(move || serialised.serialise()))),
            ("deserialise", Box::new(repeated(move || deserialised.deserialise()))),
        ];
        let mut candidates = works.map(|(name, run)| Candidate { name, operations: CALLS, run });
        let nanoseconds = medians(&mut candidates, ROUNDS);
        for (candidate, nanoseconds) in candidates.iter().zip(nanoseconds) {
            let limit = (!candidate.name.contains("serialise")).then_some(1000.0);
            verdict(&format!("{name}: {}", candidate.name), nanoseconds, "ns", limit, None);
        }
        verdict(&format!("{name}: serialised state"), size, "B", Some(LONGEST_SAVED_STATE as f64), None);
    }
}
