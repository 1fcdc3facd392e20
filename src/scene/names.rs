//! Choices that are typed by name: one table gives the enum, its names, and the error for a name
//! that is none of them.

/// An enum whose every variant has a name, with `ALL`, `name`, `Display` and `FromStr`.
macro_rules! named {
    (
        $(#[$of_choice:meta])*
        pub enum $Choice:ident, $what:literal {
            $( $(#[$of_variant:meta])* $Variant:ident = $name:literal, )*
        }
        $(#[$of_error:meta])*
        pub struct $Error:ident;
    ) => {
        $(#[$of_choice])*
        #[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
        #[non_exhaustive]
        pub enum $Choice {
            $( $(#[$of_variant])* $Variant, )*
        }

        impl $Choice {
            /// All of them, in order.
            pub const ALL: [Self; [$($name),*].len()] = [$(Self::$Variant),*];

            /// Its name, as it is typed.
            #[must_use]
            pub const fn name(self) -> &'static str {
                match self { $( Self::$Variant => $name, )* }
            }
        }

        impl core::fmt::Display for $Choice {
            fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
                f.pad(self.name())
            }
        }

        $(#[$of_error])*
        #[derive(Clone, Copy, PartialEq, Eq, Debug)]
        pub struct $Error;

        impl core::fmt::Display for $Error {
            fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
                f.write_str(concat!("unknown ", $what, "; there are"))?;
                for (i, choice) in $Choice::ALL.iter().enumerate() {
                    write!(f, "{} {choice}", if i == 0 { "" } else { "," })?;
                }
                Ok(())
            }
        }

        impl core::error::Error for $Error {}

        impl core::str::FromStr for $Choice {
            type Err = $Error;

            fn from_str(name: &str) -> Result<Self, $Error> {
                Self::ALL.into_iter().find(|choice| choice.name() == name).ok_or($Error)
            }
        }
    };
}

pub(crate) use named;
