//! Choices that are typed by name: one table gives the enum, its names, and the error for an unknown name.

use core::fmt;

/// An unknown name. Its text lists the known ones.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub struct UnknownName {
    /// The thing to be chosen.
    pub(crate) what: &'static str,
    pub(crate) names: &'static [&'static str],
}

impl fmt::Display for UnknownName {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "unknown {}; there are", self.what)?;
        for (i, name) in self.names.iter().enumerate() {
            write!(f, "{} {name}", if i == 0 { "" } else { "," })?;
        }
        Ok(())
    }
}

impl core::error::Error for UnknownName {}

/// An enum whose every variant has a name, with `ALL`, `name`, `Display` and `FromStr`.
macro_rules! named {
    (
        $(#[$of_choice:meta])*
        pub enum $Choice:ident, $what:literal {
            $( $(#[$of_variant:meta])* $Variant:ident = $name:literal, )*
        }
    ) => {
        $(#[$of_choice])*
        #[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
        #[non_exhaustive]
        pub enum $Choice {
            $( $(#[$of_variant])* $Variant, )*
        }

        impl $Choice {
            /// All variants, in order.
            pub const ALL: [Self; [$($name),*].len()] = [$(Self::$Variant),*];

            /// The variant's name, as it is typed.
            #[must_use]
            #[doc(hidden)]
            pub const fn name(self) -> &'static str {
                match self { $( Self::$Variant => $name, )* }
            }
        }

        impl core::fmt::Display for $Choice {
            fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
                f.pad(self.name())
            }
        }

        impl core::str::FromStr for $Choice {
            type Err = $crate::UnknownName;

            fn from_str(name: &str) -> Result<Self, Self::Err> {
                let unknown = $crate::UnknownName { what: $what, names: &[$($name),*] };
                Self::ALL.into_iter().find(|choice| choice.name() == name).ok_or(unknown)
            }
        }
    };
}

pub(crate) use named;
