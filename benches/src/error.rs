//! What can go wrong when benches are run and read.

use std::path::Path;

/// Why there is no result. Displays as one line.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// A program cannot be started.
    #[error("{program} cannot be started ({reason}); {remedy}")]
    Start {
        /// The program.
        program: String,
        /// What the operating system says.
        reason: String,
        /// What the user can do.
        remedy: String,
    },
    /// A program has failed; it said why itself.
    #[error("`{command}` failed ({status}); its message is above")]
    Failed {
        /// The command line.
        command: String,
        /// How it ended.
        status: String,
    },
    /// A file cannot be read.
    #[error("{file}: cannot be read ({reason})")]
    Read {
        /// The file.
        file: String,
        /// What the operating system says.
        reason: String,
    },
    /// A file, or what a program printed, is not as expected.
    #[error("{place}: {problem}")]
    Content {
        /// The file or program.
        place: String,
        /// What is wrong.
        problem: String,
    },
    /// A file cannot be written.
    #[error("{file}: cannot be written ({reason})")]
    Write {
        /// The file.
        file: String,
        /// What the operating system says.
        reason: String,
    },
    /// A scene cannot be prepared.
    #[error(transparent)]
    Scene(host_sim::error::Error),
    /// The core refused a buffer.
    #[error("the core refuses a buffer: {0}")]
    Core(#[from] multum::error::Error),
}

impl From<host_sim::error::Error> for Error {
    fn from(error: host_sim::error::Error) -> Self {
        match error {
            // Its text is about arguments of host-sim.
            host_sim::error::Error::Write { file, reason } => Self::Write { file, reason },
            error => Self::Scene(error),
        }
    }
}

impl Error {
    /// An [`Error::Read`].
    #[must_use]
    pub fn read(file: &Path, reason: &std::io::Error) -> Self {
        Self::Read {
            file: file.display().to_string(),
            reason: reason.kind().to_string(),
        }
    }

    /// An [`Error::Content`].
    #[must_use]
    pub fn content(place: &(impl ToString + ?Sized), problem: &(impl ToString + ?Sized)) -> Self {
        Self::Content {
            place: place.to_string(),
            problem: problem.to_string(),
        }
    }
}
