"""Programs on the path."""

import shutil
import subprocess

from .failure import Failure

# Debian's package of each.
PACKAGES = {
    "cargo": "cargo-web",
    "qemu-system-arm": "qemu-system-arm",
    "qemu-system-riscv32": "qemu-system-misc",
    "llvm-mca": "llvm",
    "llvm-objdump": "llvm",
}


def need(tool):
    """The program's path."""
    path = shutil.which(tool)
    if not path:
        raise Failure(f"no {tool} on the path; do `apt-get install {PACKAGES[tool]}`")
    return path


def output(command):
    """What a command prints; None if it fails."""
    done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
    return done.stdout.strip() if done.returncode == 0 else None
