//! Seeded random numbers: the same on every machine and in every release of the generator's
//! crate, so that a failure can be repeated.

use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;

/// The generator that all tests use.
pub type Rng = ChaCha8Rng;

/// A generator for one test.
#[must_use]
pub fn seeded(seed: u64) -> Rng {
    Rng::seed_from_u64(seed)
}
