//! Reading a model description takes memory in proportion to its length, whatever it says.

use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;

use maglev_fmu::host::ModelDescription;

thread_local! {
    /// Bytes that this thread has allocated and not released; less than none if it releases what others allocated.
    static NOW: Cell<isize> = const { Cell::new(0) };
    /// The most of it since it was set last.
    static MOST: Cell<isize> = const { Cell::new(0) };
}

/// The system's allocator, counting for each thread, since other tests run beside this one.
struct Counting;

// SAFETY: everything is passed on to the system's allocator.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        let now = NOW.get() + layout.size().cast_signed();
        NOW.set(now);
        MOST.set(MOST.get().max(now));
        // SAFETY: the caller's promise about the layout.
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        NOW.set(NOW.get() - layout.size().cast_signed());
        // SAFETY: the pointer came from `alloc`, hence from the system's allocator.
        unsafe { System.dealloc(pointer, layout) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

/// Length of the hostile part \[byte\].
const LENGTH: usize = 500_000;

/// Most memory per byte of the document: a variable of some 35 bytes of text takes that and its place in two lists.
const FACTOR: usize = 20;

/// As many copies of a pattern with their numbers in place of `#` as fill half of the length.
fn many(pattern: &str) -> String {
    (0..LENGTH / 2 / pattern.len()).map(|number| pattern.replace('#', &number.to_string())).collect()
}

fn fmi2(types: &str, variables: &str) -> String {
    format!(
        "<fmiModelDescription fmiVersion=\"2.0\" modelName=\"m\" guid=\"g\"><TypeDefinitions>{types}</TypeDefinitions>\
         <ModelVariables>{variables}</ModelVariables></fmiModelDescription>"
    )
}

fn fmi3(types: &str, variables: &str) -> String {
    format!(
        "<fmiModelDescription fmiVersion=\"3.0\" modelName=\"m\" instantiationToken=\"t\">\
         <TypeDefinitions>{types}</TypeDefinitions><ModelVariables>{variables}</ModelVariables></fmiModelDescription>"
    )
}

/// Guards: 0.5 MB that took 527 MB, because each alias had its own copy of a long start value.
#[test]
fn a_small_description_takes_little_memory() {
    let long = "1".repeat(LENGTH / 2);
    let head = "<Float64 name=\"x\" valueReference=\"0\"";
    let of_type2 =
        many("<ScalarVariable name=\"#\" valueReference=\"#\"><Real declaredType=\"T\"/></ScalarVariable>");
    let of_type3 = many("<Float64 name=\"#\" valueReference=\"#\" declaredType=\"T\"/>");
    let documents = [
        (
            "aliases of a long start",
            fmi3("", &format!("{head} start=\"{long}\">{}</Float64>", many("<Alias name=\"#\"/>"))),
        ),
        (
            "aliases of a long description",
            fmi3("", &format!("{head} description=\"{long}\">{}</Float64>", many("<Alias name=\"#\"/>"))),
        ),
        ("a long unit, FMI 3.0", fmi3(&format!("<Float64Type name=\"T\" unit=\"{long}\"/>"), &of_type3)),
        (
            "a long unit, FMI 2.0",
            fmi2(&format!("<SimpleType name=\"T\"><Real unit=\"{long}\"/></SimpleType>"), &of_type2),
        ),
        ("unknown variables", fmi3("", &many("<x/>"))),
        ("unknown types", fmi3(&many("<x/>"), "")),
        ("unknown elements of FMI 2.0", fmi2("", &many("<x/>"))),
        ("small variables", fmi3("", &many("<Int8 name=\"#\" valueReference=\"#\"/>"))),
        (
            "start elements",
            fmi3(
                "",
                &format!("<String name=\"s\" valueReference=\"0\">{}</String>", many("<Start value=\"\"/>")),
            ),
        ),
        ("dimensions", fmi3("", &format!("{head}>{}</Float64>", many("<Dimension/>")))),
        ("depth", fmi3("", &format!("{}{}", many("<x>"), many("</x>")))),
        (
            "items",
            fmi3(
                &format!(
                    "<EnumerationType name=\"T\">{}</EnumerationType>",
                    many("<Item name=\"\" value=\"1\"/>")
                ),
                "",
            ),
        ),
        ("attributes", fmi3("", &format!("<x {}/>", many("a#=\"\" ")))),
    ];
    for (what, document) in documents {
        let before = NOW.get();
        MOST.set(before);
        let result = ModelDescription::parse(&document);
        let taken = (MOST.get() - before).unsigned_abs();
        let per_byte = taken as f64 / document.len() as f64;
        println!("{what}: {per_byte:.1} bytes per byte of {}, {}", document.len(), result.is_ok());
        assert!(taken < FACTOR * document.len(), "{what}: {taken} bytes for {}", document.len());
    }
}
