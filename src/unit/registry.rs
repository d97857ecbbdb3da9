//! Which units there are: the library's own, which [`super`] lists, and those that a program adds.

#[cfg(feature = "tools")]
use super::REGISTRATIONS;
use super::memory::{OutOfMemory, try_boxed};
#[cfg(feature = "tools")]
use super::structure::{Dependencies, Structured};
#[cfg(feature = "added-units")]
use super::system::System;
use super::{Description, Edition, UNITS, Unit};

/// A unit that can be made from nothing but its table.
#[derive(Debug)]
pub struct UnitType {
    pub description: &'static Description,
    pub create: fn() -> Box<dyn Unit>,
    /// As `create`, for a library whose host goes on when memory runs out.
    pub try_create: fn() -> Result<Box<dyn Unit>, OutOfMemory>,
}

impl UnitType {
    /// The unit `U` with this description.
    pub const fn of<U: Unit + Default + 'static>(description: &'static Description) -> Self {
        Self { description, create: create::<U>, try_create: try_create::<U> }
    }
}

fn create<U: Unit + Default + 'static>() -> Box<dyn Unit> {
    Box::new(U::default())
}

fn try_create<U: Unit + Default + 'static>() -> Result<Box<dyn Unit>, OutOfMemory> {
    Ok(try_boxed("a unit", U::default())?)
}

/// What only tools want to know of a unit: apart, so that the shared library can do without.
#[cfg(feature = "tools")]
#[derive(Debug)]
pub struct Registration {
    pub unit: &'static UnitType,
    /// What each row of the table follows from.
    pub dependencies: fn() -> Vec<Dependencies>,
    /// Drawing in SVG, without text, so that no font is needed.
    pub icon: &'static str,
}

#[cfg(feature = "tools")]
impl Registration {
    /// Of the unit type that makes `U`s.
    pub const fn of<U: Structured>(unit: &'static UnitType, icon: &'static str) -> Self {
        Self { unit, dependencies: U::dependencies, icon }
    }

    /// That of the unit described, if it is one.
    pub fn find(description: &Description) -> Option<&'static Self> {
        let mut all = REGISTRATIONS.iter();
        #[cfg(feature = "added-units")]
        let mut all = all.by_ref().chain(ADDED_UNITS);
        all.find(|registration| core::ptr::eq(registration.unit.description, description))
    }
}

/// The list of the library's units. The icon of each is the drawing in `assets` with the unit's name.
macro_rules! units {
    ($($unit:ident: $model:ident = $module:ident;)*) => {
        $(pub static $unit: UnitType = UnitType::of::<$model>(&$module::DESCRIPTION);)*

        /// All units the shared library offers.
        pub static UNITS: &[&UnitType] = &[$(&$unit),*];

        #[cfg(feature = "tools")]
        static REGISTRATIONS: &[Registration] = &[$(Registration::of::<$model>(
            &$unit,
            include_str!(concat!("../../assets/", stringify!($model), ".svg")),
        )),*];
    };
}

/// Units that the running program adds to those of the library, collected by the linker: the functions of both standards
/// make instances of them, too.
///
/// ```ignore
/// static CART: UnitType = UnitType::of::<Cart>(&DESCRIPTION);
/// #[distributed_slice(ADDED_UNITS)]
/// static CART_REGISTRATION: Registration = Registration::of::<Cart>(&CART, include_str!("cart.svg"));
/// ```
#[cfg(feature = "added-units")]
#[linkme::distributed_slice]
pub static ADDED_UNITS: [Registration];

/// Loops that the running program adds.
#[cfg(feature = "added-units")]
#[linkme::distributed_slice]
pub static ADDED_SYSTEMS: [System];

/// All units that instances can be made of.
pub fn units() -> impl Iterator<Item = &'static UnitType> + Clone {
    let own = UNITS.iter().copied();
    #[cfg(feature = "added-units")]
    let own = own.chain(ADDED_UNITS.iter().map(|added| added.unit));
    own
}

/// Every unit in every edition that suits it.
pub fn editions() -> impl Iterator<Item = (&'static UnitType, Edition)> {
    editions_of(units())
}

/// As [`editions`], of some units.
pub fn editions_of(
    units: impl Iterator<Item = &'static UnitType>,
) -> impl Iterator<Item = (&'static UnitType, Edition)> {
    let all = units.flat_map(|unit| Edition::ALL.map(|edition| (unit, edition)));
    all.filter(|(unit, edition)| edition.suits(unit.description))
}
