//! Elementary data types: their codes, names and sizes. Sources: data/data_types.tsv (OpENer ciptypes.h, libplctag
//! defs.h, Omron W506 8-7-1).

use super::dialect::Dialect;

/// How the bytes of an elementary type are read. All are little endian.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Form {
    /// Zero or not.
    Bool,
    /// Two's complement.
    Signed,
    /// A whole number.
    Unsigned,
    /// A whole number that is shown as bits.
    Bits,
    /// IEEE 754, single or double by its size.
    Float,
    /// Decimal digits of four bits each.
    Bcd,
}

macro_rules! elementary {
    ($( $(#[$meta:meta])* $variant:ident = $code:literal, $name:literal, $size:literal, $form:ident; )*) => {
        /// An elementary data type.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
        pub enum Elementary {
            $( $(#[$meta])* $variant, )*
        }

        impl Elementary {
            /// All of them.
            pub const ALL: &[Self] = &[$( Self::$variant, )*];

            /// The code on the wire.
            pub const fn code(self) -> u8 {
                match self { $( Self::$variant => $code, )* }
            }

            /// The name as the specification spells it.
            pub const fn name(self) -> &'static str {
                match self { $( Self::$variant => $name, )* }
            }

            /// Bytes, where the family makes no difference.
            const fn usual_size(self) -> usize {
                match self { $( Self::$variant => $size, )* }
            }

            /// How its bytes are read.
            pub const fn form(self) -> Form {
                match self { $( Self::$variant => Form::$form, )* }
            }
        }
    };
}

elementary! {
    /// 0xC1
    Bool = 0xC1, "BOOL", 1, Bool;
    /// 0xC2
    Sint = 0xC2, "SINT", 1, Signed;
    /// 0xC3
    Int = 0xC3, "INT", 2, Signed;
    /// 0xC4
    Dint = 0xC4, "DINT", 4, Signed;
    /// 0xC5
    Lint = 0xC5, "LINT", 8, Signed;
    /// 0xC6
    Usint = 0xC6, "USINT", 1, Unsigned;
    /// 0xC7
    Uint = 0xC7, "UINT", 2, Unsigned;
    /// 0xC8
    Udint = 0xC8, "UDINT", 4, Unsigned;
    /// 0xC9
    Ulint = 0xC9, "ULINT", 8, Unsigned;
    /// 0xCA
    Real = 0xCA, "REAL", 4, Float;
    /// 0xCB
    Lreal = 0xCB, "LREAL", 8, Float;
    /// 0xCC: synchronous time
    Stime = 0xCC, "STIME", 4, Signed;
    /// 0xCD: days since 1972-01-01
    Date = 0xCD, "DATE", 2, Unsigned;
    /// 0xCE: ms since midnight
    TimeOfDay = 0xCE, "TIME_OF_DAY", 4, Unsigned;
    /// 0xD1
    Byte = 0xD1, "BYTE", 1, Bits;
    /// 0xD2
    Word = 0xD2, "WORD", 2, Bits;
    /// 0xD3
    Dword = 0xD3, "DWORD", 4, Bits;
    /// 0xD4
    Lword = 0xD4, "LWORD", 8, Bits;
    /// 0xD6: µs
    Ftime = 0xD6, "FTIME", 4, Signed;
    /// 0xD7: µs
    Ltime = 0xD7, "LTIME", 8, Signed;
    /// 0xD8: ms
    Itime = 0xD8, "ITIME", 2, Signed;
    /// 0xDB: ms; 8 bytes on an Omron
    Time = 0xDB, "TIME", 4, Signed;
    /// 0x04: Omron
    UintBcd = 0x04, "UINT_BCD", 2, Bcd;
    /// 0x05: Omron
    UdintBcd = 0x05, "UDINT_BCD", 4, Bcd;
    /// 0x06: Omron
    UlintBcd = 0x06, "ULINT_BCD", 8, Bcd;
    /// 0x07: Omron
    Enum = 0x07, "ENUM", 4, Unsigned;
    /// 0x08: Omron, ns since 1970-01-01
    DateNsec = 0x08, "DATE_NSEC", 8, Unsigned;
    /// 0x09: Omron, ns
    TimeNsec = 0x09, "TIME_NSEC", 8, Signed;
    /// 0x0A: Omron, ns since 1970-01-01
    DateAndTimeNsec = 0x0A, "DATE_AND_TIME_NSEC", 8, Unsigned;
    /// 0x0B: Omron, ns since midnight
    TimeOfDayNsec = 0x0B, "TIME_OF_DAY_NSEC", 8, Unsigned;
}

/// First code of the specification; below are the vendor's own.
const FIRST_COMMON: u8 = 0xC1;

impl Elementary {
    /// From the code on the wire. Those below 0xC1 mean something on an Omron only.
    pub fn of_code(dialect: Dialect, code: u8) -> Option<Self> {
        let known = code >= FIRST_COMMON || dialect == Dialect::Omron;
        Self::ALL.iter().copied().find(|kind| known && kind.code() == code)
    }

    /// From its name, in capitals or not.
    pub fn of_name(name: &str) -> Option<Self> {
        Self::ALL.iter().copied().find(|kind| kind.name().eq_ignore_ascii_case(name))
    }

    /// Bytes of one value. A BOOL of an Omron has a second byte: whether it is forced.
    pub const fn size(self, dialect: Dialect) -> usize {
        match (self, dialect) {
            (Self::Bool, Dialect::Omron) => 2,
            (Self::Time, Dialect::Omron) => 8,
            _ => self.usual_size(),
        }
    }

    /// Bits of the number, for what can be written by bits.
    pub const fn bits(self) -> Option<u8> {
        match (self.form(), self.usual_size()) {
            (Form::Signed | Form::Unsigned | Form::Bits, 1) => Some(8),
            (Form::Signed | Form::Unsigned | Form::Bits, 2) => Some(16),
            (Form::Signed | Form::Unsigned | Form::Bits, 4) => Some(32),
            (Form::Signed | Form::Unsigned | Form::Bits, 8) => Some(64),
            _ => None,
        }
    }
}
