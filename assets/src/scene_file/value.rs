//! Numbers, vectors, colours and names, each with its range. Values out of range are rejected where they occur.

use core::fmt;
use core::marker::PhantomData;
use core::str::FromStr;

use mode13h::glam::Vec3;
use mode13h::palette::Rgb;
use serde::de::{Deserialize, Deserializer, Error, Expected, SeqAccess, Unexpected, Visitor};

use super::names::in_full;

/// Defines a visitor from what it expects and its methods, and lets serde read the type with it.
macro_rules! visitor {
    ($Visitor:ident of $Value:ident: $what:literal $($methods:tt)*) => {
        struct $Visitor;

        impl<'de> serde::de::Visitor<'de> for $Visitor {
            type Value = $Value;

            fn expecting(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
                f.write_str($what)
            }

            $($methods)*
        }

        impl<'de> serde::Deserialize<'de> for $Value {
            fn deserialize<D: serde::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
                deserializer.deserialize_any($Visitor)
            }
        }
    };
}

pub(super) use visitor;

/// A kind of number.
pub(super) trait Number: Sized {
    /// The expected values, as text to follow "expected".
    const WHAT: &'static str;

    /// Converts a number; `None` if it is out of range.
    fn of(number: f64) -> Option<Self>;
}

struct NumberVisitor<N>(PhantomData<N>);

impl<N: Number> Visitor<'_> for NumberVisitor<N> {
    type Value = N;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(N::WHAT)
    }

    fn visit_i64<E: Error>(self, number: i64) -> Result<N, E> {
        // Rounded to the nearest beyond 2⁵³.
        N::of(number as f64).ok_or_else(|| not_in_range(number, &self))
    }

    fn visit_f64<E: Error>(self, number: f64) -> Result<N, E> {
        N::of(number).ok_or_else(|| not_in_range(number, &self))
    }
}

/// Makes the error of a number out of range; large ones are written with an exponent.
pub(super) fn not_in_range<E: Error>(number: impl fmt::Debug, expected: &dyn Expected) -> E {
    E::invalid_value(Unexpected::Other(&format!("{number:?}")), expected)
}

/// Defines a type for each kind of number, stored as `$Type`.
macro_rules! numbers {
    ($( $(#[$doc:meta])* $Name:ident($Type:ty): $what:literal, |$x:ident| $legal:expr; )*) => {$(
        $(#[$doc])*
        #[derive(Clone, Copy, Debug)]
        pub(super) struct $Name(pub(super) $Type);

        impl Number for $Name {
            const WHAT: &'static str = $what;

            fn of(number: f64) -> Option<Self> {
                // Rounded to the nearest; infinite beyond the range of f32, which is never valid.
                let $x = number as $Type;
                ($x.is_finite() && $legal).then_some(Self($x))
            }
        }

        impl<'de> Deserialize<'de> for $Name {
            fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
                deserializer.deserialize_any(NumberVisitor(PhantomData))
            }
        }
    )*};
}

numbers! {
    /// A coordinate or an intensity.
    Plain(f32): "a finite number", |_x| true;
    /// An angle in degrees, a number of turns, or a time in seconds.
    Finite(f64): "a finite number", |_x| true;
    /// A share.
    Share(f32): "a number from 0 to 1", |x| (0.0..=1.0).contains(&x);
    /// A length.
    Positive(f32): "a number above 0", |x| x > 0.0;
    /// A size.
    NotNegative(f32): "a number of at least 0", |x| x >= 0.0;
    /// An exponent.
    Shininess(f32): "a number from 0 to 1000", |x| (0.0..=1000.0).contains(&x);
    /// Rounds per scene duration.
    Rounds(f64): "a number other than 0, from -1000 to 1000", |x| x != 0.0 && x.abs() <= 1000.0;
    /// Rounds per scene duration, for a motion that cannot run backwards.
    Times(f64): "a number above 0, at most 1000", |x| x > 0.0 && x <= 1000.0;
    /// A time.
    Seconds(f64): "a number of seconds above 0, at most 3600", |x| x > 0.0 && x <= 3600.0;
    /// The vertical field of view, in degrees.
    FieldOfView(f32): "a number of degrees from 1 to 179", |x| (1.0..=179.0).contains(&x);
    /// The angle between the axis of a cone and its edge, in degrees.
    HalfAngle(f32): "a number of degrees from 0 to 90", |x| (0.0..=90.0).contains(&x);
    /// An angle between two faces, in degrees.
    Crease(f32): "a number of degrees from 0 to 180", |x| (0.0..=180.0).contains(&x);
    /// An entry of the palette.
    Entry(f32): "a palette entry, a whole number from 0 to 255", |x| (0.0..=255.0).contains(&x) && x == libm::truncf(x);
    /// Fractional bits of vertex coordinates.
    VertexBits(f32): "a number of bits, a whole number from 0 to 8", |x| (0.0..=8.0).contains(&x) && x == libm::truncf(x);
    /// A number of palette entries.
    Entries(f32): "a number of palette entries, from 1 to 256", |x| (1.0..=256.0).contains(&x) && x == libm::truncf(x);
}

impl Entry {
    pub(super) fn index(self) -> u8 {
        // An integer from 0 to 255.
        self.0 as u8
    }
}

impl VertexBits {
    pub(super) fn bits(self) -> u8 {
        // A whole number from 0 to 8.
        self.0 as u8
    }
}

impl Entries {
    pub(super) fn count(self) -> u16 {
        // An integer from 1 to 256.
        self.0 as u16
    }
}

/// A type that the items of a list can have.
pub(super) trait Item {
    /// Their name in the plural.
    const ITEMS: &'static str;
}

impl<N: Number> Item for N {
    const ITEMS: &'static str = "numbers";
}

impl Item for Vector {
    const ITEMS: &'static str = "points";
}

/// A list of exactly `N` items.
#[derive(Clone, Copy, Debug)]
pub(super) struct List<T, const N: usize>(pub(super) [T; N]);

/// The visitor of a list, which rejects anything else.
struct ListVisitor<T, const N: usize>(PhantomData<T>);

impl<'de, T: Item + Deserialize<'de>, const N: usize> Visitor<'de> for ListVisitor<T, N> {
    type Value = List<T, N>;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "a list of {N} {}", T::ITEMS)
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut list: A) -> Result<Self::Value, A::Error> {
        let mut found = std::vec::Vec::with_capacity(N);
        while let Some(entry) = list.next_element()? {
            found.push(entry);
        }
        let length = found.len();
        found.try_into().map(List).map_err(|_| A::Error::invalid_length(length, &self))
    }
}

impl<'de, T: Item + Deserialize<'de>, const N: usize> Deserialize<'de> for List<T, N> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(ListVisitor(PhantomData))
    }
}

/// Three coordinates.
pub(super) type Vector = List<Plain, 3>;

impl Vector {
    pub(super) fn vec3(&self) -> Vec3 {
        Vec3::from_array(self.0.map(|c| c.0))
    }
}

/// Either a number or three of them.
pub(super) enum OneOrThree<N> {
    One(N),
    Three([N; 3]),
}

impl<'de, N: Number + Deserialize<'de>> Deserialize<'de> for OneOrThree<N> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Both<N>(PhantomData<N>);

        impl<'de, N: Number + Deserialize<'de>> Visitor<'de> for Both<N> {
            type Value = OneOrThree<N>;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                write!(f, "{}, or three in a list", N::WHAT)
            }

            fn visit_i64<E: Error>(self, number: i64) -> Result<Self::Value, E> {
                NumberVisitor(PhantomData).visit_i64(number).map(OneOrThree::One)
            }

            fn visit_f64<E: Error>(self, number: f64) -> Result<Self::Value, E> {
                NumberVisitor(PhantomData).visit_f64(number).map(OneOrThree::One)
            }

            fn visit_seq<A: SeqAccess<'de>>(self, list: A) -> Result<Self::Value, A::Error> {
                ListVisitor(PhantomData).visit_seq(list).map(|List(three)| OneOrThree::Three(three))
            }
        }

        deserializer.deserialize_any(Both(PhantomData))
    }
}

/// Red, green and blue, 0 to 1 each: a list of them, or "#rrggbb" with 255 for 1.
#[derive(Clone, Copy, Debug)]
pub(super) struct Color(pub(super) [f32; 3]);

impl Color {
    /// The colour, rounded to the nearest 1/255.
    pub(super) fn rgb(self) -> Rgb {
        Rgb::from_intensities(self.0)
    }
}

visitor! { ColorVisitor of Color: "a colour: \"#rrggbb\", or red, green and blue from 0 to 1 in a list"
    fn visit_str<E: Error>(self, text: &str) -> Result<Color, E> {
        let digits = text.strip_prefix('#').filter(|digits| digits.len() == 6);
        // `from_str_radix` would accept a sign.
        let digits = digits.filter(|digits| digits.bytes().all(|byte| byte.is_ascii_hexdigit()));
        match digits.map(|digits| u32::from_str_radix(digits, 16)) {
            Some(Ok(number)) => {
                let Rgb { r, g, b } = Rgb::from(number);
                Ok(Color([r, g, b].map(|byte| f32::from(byte) / 255.0)))
            }
            _ => Err(E::invalid_value(Unexpected::Str(text), &self)),
        }
    }

    fn visit_seq<A: SeqAccess<'de>>(self, list: A) -> Result<Color, A::Error> {
        let List(shares) = ListVisitor::<Share, 3>(PhantomData).visit_seq(list)?;
        Ok(Color(shares.map(|share| share.0)))
    }
}

/// The background that the frame is cleared to.
#[derive(Clone, Copy, Debug)]
pub(super) enum Background {
    Entry(u8),
    Color(Color),
}

visitor! { BackgroundVisitor of Background:
    "a palette entry from 0 to 255, or a colour: \"#rrggbb\", or red, green and blue from 0 to 1"
    fn visit_i64<E: Error>(self, number: i64) -> Result<Background, E> {
        NumberVisitor(PhantomData).visit_i64(number).map(|entry: Entry| Background::Entry(entry.index()))
    }

    fn visit_str<E: Error>(self, text: &str) -> Result<Background, E> {
        ColorVisitor.visit_str(text).map(Background::Color)
    }

    fn visit_seq<A: SeqAccess<'de>>(self, list: A) -> Result<Background, A::Error> {
        ColorVisitor.visit_seq(list).map(Background::Color)
    }
}

/// One of several names.
pub(super) struct Name<T>(pub(super) T);

struct NameVisitor<T>(PhantomData<T>);

impl<T: FromStr<Err: fmt::Display>> Visitor<'_> for NameVisitor<T> {
    type Value = Name<T>;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a name in quotes")
    }

    fn visit_str<E: Error>(self, name: &str) -> Result<Name<T>, E> {
        in_full(name).parse().map(Name).map_err(|error| E::custom(format_args!("\"{name}\": {error}")))
    }
}

impl<'de, T: FromStr<Err: fmt::Display>> Deserialize<'de> for Name<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(NameVisitor(PhantomData))
    }
}

/// `false`, `true` for the default, or one of several names.
pub(super) struct OffOr<T>(pub(super) Option<T>);

impl<'de, T: FromStr<Err: fmt::Display> + Default> Deserialize<'de> for OffOr<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Either<T>(PhantomData<T>);

        impl<T: FromStr<Err: fmt::Display> + Default> Visitor<'_> for Either<T> {
            type Value = OffOr<T>;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("true, false, or a name in quotes")
            }

            fn visit_bool<E: Error>(self, on: bool) -> Result<OffOr<T>, E> {
                Ok(OffOr(on.then(T::default)))
            }

            fn visit_str<E: Error>(self, name: &str) -> Result<OffOr<T>, E> {
                NameVisitor(PhantomData).visit_str(name).map(|Name(value)| OffOr(Some(value)))
            }
        }

        deserializer.deserialize_any(Either(PhantomData))
    }
}

/// The name of a file, or of something built in.
pub(super) struct FileName(pub(super) String);

visitor! { FileNameVisitor of FileName: "a name of 1 to 1000 characters"
    fn visit_str<E: Error>(self, name: &str) -> Result<FileName, E> {
        let legal = (1..=1000).contains(&name.chars().count()) && !name.contains(char::is_control);
        if legal { Ok(FileName(name.into())) } else { Err(E::invalid_value(Unexpected::Str(name), &self)) }
    }
}
