//! Which models there are: the library's own and those that a program adds.

use super::memory::{OutOfMemory, try_boxed};
#[cfg(feature = "tools")]
use super::structure::{Dependencies, Structured};
#[cfg(feature = "added-models")]
use super::system::System;
use super::{Description, Edition, Model};

/// A model that can be made from nothing but its table.
#[derive(Debug)]
pub struct ModelType {
    pub description: &'static Description,
    pub create: fn() -> Box<dyn Model>,
    /// As `create`, for a library whose host goes on when memory runs out.
    pub try_create: fn() -> Result<Box<dyn Model>, OutOfMemory>,
}

impl ModelType {
    /// The model `M` with this description.
    pub const fn of<M: Model + Default + 'static>(description: &'static Description) -> Self {
        Self { description, create: create::<M>, try_create: try_create::<M> }
    }
}

fn create<M: Model + Default + 'static>() -> Box<dyn Model> {
    Box::new(M::default())
}

fn try_create<M: Model + Default + 'static>() -> Result<Box<dyn Model>, OutOfMemory> {
    Ok(try_boxed("a model", M::default())?)
}

/// What only tools want to know of a model: apart, so that the shared library can do without.
#[cfg(feature = "tools")]
#[derive(Debug)]
pub struct Registration {
    pub model: &'static ModelType,
    /// What each row of the table follows from.
    pub dependencies: fn() -> Vec<Dependencies>,
    /// Drawing in SVG, without text, so that no font is needed.
    pub icon: &'static str,
}

#[cfg(feature = "tools")]
impl Registration {
    /// Of the type that makes `M`s.
    pub const fn of<M: Structured>(model: &'static ModelType, icon: &'static str) -> Self {
        Self { model, dependencies: M::dependencies, icon }
    }

    /// That of the model described, if it is one.
    pub fn find(description: &Description) -> Option<&'static Self> {
        let mut all = REGISTRATIONS.iter();
        #[cfg(feature = "added-models")]
        let mut all = all.by_ref().chain(ADDED_MODELS);
        all.find(|registration| core::ptr::eq(registration.model.description, description))
    }
}

/// The list of the library's models. The icon of each is the drawing in `assets` with the model's name.
macro_rules! models {
    ($($name:ident: $model:ident = $module:ident;)*) => {
        $(pub static $name: ModelType = ModelType::of::<super::$module::$model>(&super::$module::DESCRIPTION);)*

        /// All models the shared library offers.
        pub static MODELS: &[&ModelType] = &[$(&$name),*];

        #[cfg(feature = "tools")]
        static REGISTRATIONS: &[Registration] = &[$(Registration::of::<super::$module::$model>(
            &$name,
            include_str!(concat!("../../assets/", stringify!($model), ".svg")),
        )),*];
    };
}

models! {
    MAGNETIC_BEARING_PLANT: MagneticBearingPlant = magnetic_bearing_plant;
    MAGNETIC_BEARING_CONTROLLER: MagneticBearingController = magnetic_bearing_controller;
    LEVITATED_BALL_PLANT: LevitatedBallPlant = levitated_ball_plant;
    LEVITATED_BALL_CONTROLLER: LevitatedBallController = levitated_ball_controller;
    MAGLEV_RIG_PLANT: MaglevRigPlant = maglev_rig_plant;
    MAGLEV_RIG_CONTROLLER: MaglevRigController = maglev_rig_controller;
}

/// Models that the running program adds to those of the library, collected by the linker: the functions of both standards
/// make instances of them, too.
///
/// ```ignore
/// static CART: ModelType = ModelType::of::<Cart>(&DESCRIPTION);
/// #[distributed_slice(ADDED_MODELS)]
/// static CART_REGISTRATION: Registration = Registration::of::<Cart>(&CART, include_str!("cart.svg"));
/// ```
#[cfg(feature = "added-models")]
#[linkme::distributed_slice]
pub static ADDED_MODELS: [Registration];

/// Loops that the running program adds.
#[cfg(feature = "added-models")]
#[linkme::distributed_slice]
pub static ADDED_SYSTEMS: [System];

/// All models that instances can be made of.
pub fn models() -> impl Iterator<Item = &'static ModelType> + Clone {
    let own = MODELS.iter().copied();
    #[cfg(feature = "added-models")]
    let own = own.chain(ADDED_MODELS.iter().map(|added| added.model));
    own
}

/// Every model in every edition that suits it.
pub fn editions() -> impl Iterator<Item = (&'static ModelType, Edition)> {
    editions_of(models())
}

/// As [`editions`], of some models.
pub fn editions_of(
    models: impl Iterator<Item = &'static ModelType>,
) -> impl Iterator<Item = (&'static ModelType, Edition)> {
    let all = models.flat_map(|model| Edition::ALL.map(|edition| (model, edition)));
    all.filter(|(model, edition)| edition.suits(model.description))
}
