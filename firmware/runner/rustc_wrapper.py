#!/usr/bin/env python3
"""Stands between cargo and rustc, so that an image is the same wherever the clone lies.

Cargo hashes the path of a package outside of its workspace, as the core is to the images, into
`-C metadata`. That orders the functions of the linked program, their order decides what is inlined,
and one clone's counts of instructions were up to 3 % above another's. The names of package and
crate tell crates apart as well.
"""

import hashlib
import os
import sys


def same_everywhere(arguments, package):
    """rustc's arguments with metadata that no path is part of."""
    crate = arguments[arguments.index("--crate-name") + 1] if "--crate-name" in arguments else ""
    stamp = hashlib.sha256(f"{package} {crate}".encode()).hexdigest()[:16]
    return [f"metadata={stamp}" if word.startswith("metadata=") else word for word in arguments]


def main():
    rustc, *arguments = sys.argv[1:]
    folder, root = os.environ.get("CARGO_MANIFEST_DIR", ""), os.environ.get("MULTUM_ROOT", "")
    if root and (folder + os.sep).startswith(root + os.sep):
        package = f"{os.environ['CARGO_PKG_NAME']} {os.environ['CARGO_PKG_VERSION']}"
        arguments = same_everywhere(arguments, package)
    os.execvp(rustc, [rustc, *arguments])


if __name__ == "__main__":
    main()
