//! Prints through the debugger, or QEMU in its place (semihosting).
//!
//! Numbers are written by hand: `core::fmt` takes 10 KB of flash and brings panics with it.

pub use crate::machine::exit;

use crate::machine::Stream;

/// Standard output on the PC. Without a debugger nothing is printed.
#[derive(Clone, Copy)]
pub struct Output(Option<Stream>);

impl Output {
    /// Opens it.
    #[must_use]
    pub fn new() -> Self {
        Self(Stream::open())
    }

    /// Prints a text as it is.
    pub fn text(&mut self, text: &str) -> &mut Self {
        self.bytes(text.as_bytes())
    }

    /// Prints a number in decimal.
    pub fn decimal(&mut self, number: u32) -> &mut Self {
        let mut digits = [b'0'; 10];
        let mut rest = number;
        let mut first = digits.len();
        for (i, digit) in digits.iter_mut().enumerate().rev() {
            *digit = b'0' + (rest % 10) as u8;
            rest /= 10;
            first = i;
            if rest == 0 {
                break;
            }
        }
        self.bytes(digits.get(first..).unwrap_or_default())
    }

    /// Prints a number as 16 hexadecimal digits.
    pub fn hex(&mut self, number: u64) -> &mut Self {
        let mut digits = [0; 16];
        let mut rest = number;
        for digit in digits.iter_mut().rev() {
            let value = (rest & 15) as u8;
            *digit = value + if value < 10 { b'0' } else { b'a' - 10 };
            rest >>= 4;
        }
        self.bytes(&digits)
    }

    fn bytes(&mut self, bytes: &[u8]) -> &mut Self {
        if let Some(stream) = &mut self.0 {
            stream.write(bytes);
        }
        self
    }
}

impl Default for Output {
    fn default() -> Self {
        Self::new()
    }
}
