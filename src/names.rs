//! Options selected by name: one table defines the enum, its names, and the error for an unknown
//! name.

use core::fmt;

/// The number of kernels across all machines.
pub(crate) const KERNELS: usize = 10;

/// The error for an unknown name, or for a kernel that this machine or build lacks. Its text lists
/// the available names.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
pub struct UnknownName(Unknown);

#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
enum Unknown {
    /// The kind of thing that is selected, and its names.
    Of(&'static str, &'static [&'static str]),
    /// A kernel: its name if other machines or builds have it, and the names of those available here.
    Kernel(Option<&'static str>, [Option<&'static str>; KERNELS]),
}

impl UnknownName {
    /// Makes the error for a name that no `what` has.
    pub const fn of(what: &'static str, names: &'static [&'static str]) -> Self {
        Self(Unknown::Of(what, names))
    }

    /// Makes the error for a kernel that is not available here; `lacking` is its name if it exists
    /// elsewhere.
    pub(crate) const fn kernel(lacking: Option<&'static str>, here: [Option<&'static str>; KERNELS]) -> Self {
        Self(Unknown::Kernel(lacking, here))
    }
}

impl fmt::Display for UnknownName {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fn list(f: &mut fmt::Formatter<'_>, names: impl Iterator<Item = &'static str>) -> fmt::Result {
            names.enumerate().try_for_each(|(i, name)| write!(f, "{} {name}", if i == 0 { "" } else { "," }))
        }
        match self.0 {
            Unknown::Of(what, names) => {
                write!(f, "unknown {what}; there are")?;
                list(f, names.iter().copied())
            }
            Unknown::Kernel(lacking, here) => {
                match lacking {
                    Some(name) => write!(f, "this machine or build lacks the kernel {name}; it has")?,
                    None => f.write_str("no such kernel; this machine has")?,
                }
                list(f, here.into_iter().flatten())
            }
        }
    }
}

crate::errors::error_type!(UnknownName);

/// Defines an enum with a name for each variant, and `ALL`, `name`, `Display` and `FromStr`.
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
                let unknown = $crate::UnknownName::of($what, &[$($name),*]);
                Self::ALL.into_iter().find(|choice| choice.name() == name).ok_or(unknown)
            }
        }
    };
}

pub(crate) use named;
