//! Prints through the debugger, or QEMU in its place (Arm semihosting).
//!
//! Numbers are written by hand: `core::fmt` takes 10 KB of flash and brings panics with it.

use cortex_m_semihosting::debug::{self, EXIT_FAILURE, EXIT_SUCCESS};
use cortex_m_semihosting::hio::{self, HostStream};

/// Standard output on the PC. Without a debugger nothing is printed.
#[derive(Clone, Copy)]
pub struct Output(Option<HostStream>);

impl Output {
    /// Opens it.
    #[must_use]
    pub fn new() -> Self {
        Self(hio::hstdout().ok())
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
            // There is nobody else to tell.
            _ = stream.write_all(bytes);
        }
        self
    }
}

impl Default for Output {
    fn default() -> Self {
        Self::new()
    }
}

/// Ends QEMU, with success or not. On a real chip it stops here.
pub fn exit(success: bool) -> ! {
    debug::exit(if success { EXIT_SUCCESS } else { EXIT_FAILURE });
    loop {
        cortex_m::asm::wfi();
    }
}
