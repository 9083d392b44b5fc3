//! `open_enum!`: codes that the other side may extend.

/// A newtype around an integer with named constants. Unknown values are kept and print as hexadecimal.
macro_rules! open_enum {
    (
        $(#[$meta:meta])*
        pub struct $name:ident($int:ty, width $width:literal) {
            $( $(#[$code_meta:meta])* $code:ident = $value:literal, )*
        }
    ) => {
        $(#[$meta])*
        #[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
        pub struct $name(pub $int);

        #[expect(non_upper_case_globals, reason = "the names are the specification's, used like variants")]
        impl $name {
            $( $(#[$code_meta])* pub const $code: Self = Self($value); )*

            /// The name of a known code.
            pub const fn name(self) -> Option<&'static str> {
                match self.0 {
                    $( $value => Some(stringify!($code)), )*
                    _ => None,
                }
            }
        }

        impl core::fmt::Debug for $name {
            fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
                match self.name() {
                    Some(name) => f.write_str(name),
                    None => write!(f, concat!(stringify!($name), "({:#0", $width, "x})"), self.0),
                }
            }
        }

        impl core::fmt::Display for $name {
            fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
                write!(f, concat!("{:#0", $width, "x}"), self.0)
            }
        }

        impl From<$int> for $name {
            fn from(code: $int) -> Self {
                Self(code)
            }
        }
    };
}
