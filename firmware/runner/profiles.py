"""What the same work takes in a program with Cargo's own release profile: sixteen units, and no optimisation
across crates when they are linked. All else is counted in images of one unit that are optimised as a whole."""

from . import record
from .bench import merged
from .build import build_all
from .counts import rows
from .failure import Failure
from .qemu import run

PROFILE = "defaults"
# Of which the budgets tell, and the record.
CHIPS = ["m0", "m4", "riscv"]
IMAGE = "sized"
SCENES = ("oblique", "mesh")


def counted(chip):
    """A core's rows."""
    path = build_all(chip, [IMAGE], PROFILE)[IMAGE]
    found = [row for row in rows(chip, run(chip, path, counted=True)) if row.scene in SCENES]
    if not found:
        raise Failure(f"{chip}: {IMAGE} draws none of {', '.join(SCENES)}")
    return found


def profiles(chips):
    """Prints the rows, and gives what the record keeps of them."""
    counts = {}
    for chip in chips:
        for row in counted(chip):
            print(row, flush=True)
            counts.setdefault(row.name, {})[chip] = row
    return [merged(on) for on in counts.values()]


def profiles_all():
    """Prints those of three cores, and writes them down."""
    record.add(profiles=profiles(CHIPS))
