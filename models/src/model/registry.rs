//! Which models there are: the library's own and those that a program adds.

use super::memory::{OutOfMemory, try_boxed};
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

/// What only tools want to know of a model: made by them, so that the shared library does without.
#[derive(Debug)]
pub struct Registration {
    pub model: &'static ModelType,
    /// What each row of the table follows from.
    pub dependencies: fn() -> Vec<Dependencies>,
    /// Drawing in SVG, without text, so that no font is needed.
    pub icon: &'static str,
    /// What the model is, its source, and what is printed, derived or assumed: paragraphs with an empty line between them.
    pub documentation: &'static str,
}

impl Registration {
    /// Of the type that makes `M`s.
    pub const fn of<M: Structured>(
        model: &'static ModelType,
        icon: &'static str,
        documentation: &'static str,
    ) -> Self {
        Self { model, dependencies: M::dependencies, icon, documentation }
    }
}

/// Hands the list of the library's models to a macro: the name of the static that describes it, its type, its module.
#[macro_export]
macro_rules! for_all_models {
    ($macro:ident) => {
        $macro! {
            MAGNETIC_BEARING_PLANT: MagneticBearingPlant = magnetic_bearing_plant;
            MAGNETIC_BEARING_CONTROLLER: MagneticBearingController = magnetic_bearing_controller;
            LEVITATED_BALL_PLANT: LevitatedBallPlant = levitated_ball_plant;
            LEVITATED_BALL_CONTROLLER: LevitatedBallController = levitated_ball_controller;
            MAGLEV_RIG_PLANT: MaglevRigPlant = maglev_rig_plant;
            MAGLEV_RIG_CONTROLLER: MaglevRigController = maglev_rig_controller;
        }
    };
}

macro_rules! model_types {
    ($($name:ident: $model:ident = $module:ident;)*) => {
        $(pub static $name: ModelType = ModelType::of::<super::$module::$model>(&super::$module::DESCRIPTION);)*

        /// All models the shared library offers.
        pub static MODELS: &[&ModelType] = &[$(&$name),*];
    };
}

for_all_models!(model_types);

/// Models that the running program adds to those of the library, collected by the linker: the functions of both standards
/// make instances of them, too.
///
/// ```ignore
/// static CART: ModelType = ModelType::of::<Cart>(&DESCRIPTION);
/// #[distributed_slice(ADDED_MODELS)]
/// static CART_REGISTRATION: Registration = Registration::of::<Cart>(&CART, include_str!("cart.svg"), "A cart.");
/// ```
#[cfg(feature = "added-models")]
#[linkme::distributed_slice]
pub static ADDED_MODELS: [Registration];

/// Loops that the running program adds.
#[cfg(feature = "added-models")]
#[linkme::distributed_slice]
pub static ADDED_SYSTEMS: [System];

/// What the running program adds.
pub fn added_models() -> &'static [Registration] {
    #[cfg(feature = "added-models")]
    return &ADDED_MODELS;
    #[cfg(not(feature = "added-models"))]
    &[]
}

/// All models that instances can be made of.
pub fn models() -> impl Iterator<Item = &'static ModelType> + Clone {
    MODELS.iter().copied().chain(added_models().iter().map(|added| added.model))
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
