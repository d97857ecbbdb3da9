//! Choices between named items, declared once: an enumeration of Rust, the items that importers see, and what converts the
//! numbers in a model's values to the one and back.

/// Declares an enumeration with the name of its type, a description, and per item its name and what it means.
///
/// ```ignore
/// choice! {
///     /// What the law is fed with.
///     pub enum Feedback = "Feedback", "What the law is fed with" {
///         Estimate = "estimate", "The observer's estimate";
///         State = "state", "The inputs state.*, for comparison";
///     }
/// }
/// ```
#[macro_export]
macro_rules! choice {
    (
        $(#[$attribute:meta])*
        $visibility:vis enum $name:ident = $type_name:literal, $description:literal {
            $($item:ident = $item_name:literal, $meaning:literal;)+
        }
    ) => {
        $(#[$attribute])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        $visibility enum $name {
            $(#[doc = $meaning] $item,)+
        }

        #[allow(dead_code, reason = "not every choice is asked for in every way")]
        impl $name {
            const ALL: &'static [Self] = &[$(Self::$item),+];

            /// What importers see of it.
            $visibility const ENUMERATION: $crate::model::quantity::Enumeration =
                $crate::model::quantity::Enumeration {
                    name: $type_name,
                    description: $description,
                    items: &[$(($item_name, $meaning)),+],
                };

            /// The number of the item, from 1 on.
            $visibility const fn number(self) -> f64 {
                self as u8 as f64 + 1.0
            }

            /// Whether `number` stands for this item.
            #[inline(always)]
            $visibility fn is(self, number: f64) -> bool {
                number == self.number()
            }

            /// The item that `number` stands for. A number in a model's values is that of an item, since it was checked.
            $visibility fn from_number(number: f64) -> Self {
                Self::ALL.iter().copied().find(|item| item.is(number)).unwrap_or(Self::ALL[0])
            }
        }
    };
}
pub use choice;

#[cfg(test)]
mod tests {
    choice! {
        /// Of three.
        enum Fruit = "Fruit", "What grows" {
            Apple = "apple", "On trees";
            Berry = "berry", "On bushes";
            Melon = "melon", "On the ground";
        }
    }

    #[test]
    fn numbers_and_items_belong_together() {
        let names: Vec<&str> = Fruit::ENUMERATION.items.iter().map(|(name, _)| *name).collect();
        assert_eq!(names, ["apple", "berry", "melon"]);
        for (place, item) in [Fruit::Apple, Fruit::Berry, Fruit::Melon].into_iter().enumerate() {
            assert_eq!(item.number(), (place + 1) as f64);
            assert_eq!(Fruit::from_number(item.number()), item);
        }
        assert!(Fruit::Melon.is(3.0) && !Fruit::Melon.is(1.0));
    }
}
