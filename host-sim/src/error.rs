//! What can be wrong with the files and arguments that a user gives.

/// Why something was refused. Displays as one line: where, what is wrong, what to do.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// A file cannot be read.
    #[error("{file}: cannot be read ({reason}); check the name and the permissions")]
    Read {
        /// The file.
        file: String,
        /// What the operating system says.
        reason: String,
    },
    /// The contents of a picture or mesh file cannot be used.
    #[error("{file}: {problem}; {remedy}")]
    Content {
        /// The file, or the place in a file.
        file: String,
        /// What is wrong.
        problem: String,
        /// What the user can do.
        remedy: String,
    },
    /// A file cannot be written.
    #[error("{file}: cannot be written ({reason}); give another name with -o")]
    Write {
        /// The file.
        file: String,
        /// What went wrong.
        reason: String,
    },
    /// No scene has this name.
    #[error("scene '{name}' is unknown; choose {known}, or give an .obj, .gltf or .glb file")]
    UnknownScene {
        /// The name.
        name: String,
        /// The names there are.
        known: String,
    },
    /// The core refused data or parameters.
    #[error("{context}: {source}")]
    Core {
        /// What was given to the core.
        context: String,
        /// Its answer.
        source: multum::error::Error,
    },
}

impl Error {
    /// An [`Error::Content`] whose parts, which may quote a file, are brought to one line.
    #[must_use]
    pub fn content(file: &str, problem: &str, remedy: &str) -> Self {
        Self::Content {
            file: one_line(file),
            problem: one_line(problem),
            remedy: one_line(remedy),
        }
    }

    /// An [`Error::Read`].
    #[must_use]
    pub fn read(file: &std::path::Path, reason: &std::io::Error) -> Self {
        Self::Read {
            file: one_line(&file.display().to_string()),
            reason: one_line(&reason.to_string()),
        }
    }

    /// An [`Error::Write`].
    #[must_use]
    pub fn write(file: &std::path::Path, reason: &dyn std::fmt::Display) -> Self {
        Self::Write {
            file: one_line(&file.display().to_string()),
            reason: one_line(&reason.to_string()),
        }
    }

    /// An [`Error::Core`].
    #[must_use]
    pub fn core(context: &str, source: multum::error::Error) -> Self {
        Self::Core {
            context: one_line(context),
            source,
        }
    }
}

/// Text with line breaks and other control characters replaced: names in files may hold them.
pub(crate) fn one_line(text: &str) -> String {
    text.chars()
        .map(|c| if c.is_control() { ' ' } else { c })
        .collect()
}
