"""Compares what is counted with what may be spent."""

import tomllib

from . import elf
from .build import FIRMWARE, build
from .chips import COUNTED
from .failure import Failure
from .qemu import run

BUDGETS = FIRMWARE.parent / "benches/budgets.toml"
# The image whose bytes are counted.
SHIPPED = "frames"


def budgets():
    allowed = tomllib.loads(BUDGETS.read_text())
    rows = []
    drawn = {}
    for chip, limits in allowed["instructions_per_pixel"].items():
        printed = [run(chip, build(chip, image), counted=True) for image in COUNTED]
        lines = [line.split() for line in "".join(printed).splitlines()]
        for line in lines:
            drawn.setdefault(" ".join(line[1:-3]), set()).add(line[-1])
        counted = {" ".join(line[1:-3]): float(line[-3]) for line in lines if line[:1] == [chip]}
        rows += within(f"{chip} instructions/pixel", counted, limits)
    for chip, limits in allowed["bytes"].items():
        counted = dict(zip(("text", "data", "bss"), elf.sizes(build(chip, SHIPPED))))
        rows += within(f"{chip} bytes", counted, limits)
    print(f"{'what':<24} {'of':<52} {'counted':>10} {'budget':>10} result")
    for row in rows:
        print("{:<24} {:<52} {:>10} {:>10} {}".format(*row))
    over = sum(row[-1] != "within" for row in rows)
    if over:
        raise Failure(f"{over} of {len(rows)} counts are over their budget in {BUDGETS}")
    # What was counted is worth nothing if the frames are not the same.
    different = [name for name, hashes in drawn.items() if len(hashes) != 1]
    if different:
        raise Failure(f"the cores draw different pixels: {', '.join(different)}")


def within(what, counted, limits):
    """Table rows; a count without a budget, or a budget without a count, is over."""
    for name in {**limits, **counted}:
        count, limit = counted.get(name, "-"), limits.get(name, "-")
        known = name in counted and name in limits
        yield what, name, count, limit, "within" if known and count <= limit else "OVER"
