"""Cycles of frames: counted from a trace on the Cortex-M0+, estimated on the M4 and M7."""

import shutil

from . import elf, mca, record, thumb
from .bench import tools
from .build import build
from .chips import CHIPS, TRACED
from .counts import PIXELS, rows
from .failure import Failure, note
from .trace import trace

EXACT, ESTIMATED = ["m0"], ["m4", "m7"]
# A display of 16 bits a pixel on a serial line of 62.5 MHz, the RP2040's fastest.
DISPLAY = 62.5e6 / (PIXELS * 16)
# The image's counter ticks each 40 instructions and prints hundredths of a pixel's; what lies
# between counter and markers is a few dozen.
TOLERANCE = 500


def cycles(chip):
    """Prints a core's frames."""
    show(of_core(chip))


def cycles_all(required):
    """Prints those of all cores, and writes them down. `required`: without llvm-mca it fails."""
    available = all(shutil.which(tool) for tool in ("llvm-mca", "llvm-objdump"))
    if not available:
        if required:
            raise Failure("no llvm-mca and llvm-objdump on the path; do `apt-get install llvm`")
        note("NO ESTIMATES for m4 and m7: no llvm-mca and llvm-objdump on the path; do `apt-get install llvm`")
    found = [row for chip in EXACT + ESTIMATED for row in of_core(chip, available)]
    show(found)
    old, current = record.read(), tools()
    if any(old.get(key) != value for key, value in current.items()):
        raise Failure(f"{record.PATH.name} is of other sources or tools: do `firmware/run all bench` first")
    old |= {"llvm_mca": mca.version() if available else None, "cycles": found}
    record.write(old)


def of_core(chip, available=True):
    """What is written down of each frame."""
    path = build(chip, TRACED)
    note(f"{chip}: tracing")
    printed, traced = trace(chip, path)
    lines = rows(chip, printed)
    if len(lines) != len(traced):
        raise Failure(f"{chip}: {len(lines)} frames drawn and {len(traced)} traced")
    if chip in EXACT:
        thumb.self_check()
        count = thumb.Costs(elf.Memory(path)).cycles
    elif available:
        estimate = mca.Estimate(chip, path)

        def count(edges):
            return estimate.ratio(edges) * executed(edges)
    else:
        count = None
    found = []
    for line, edges in zip(lines, traced):
        instructions = executed(edges)
        if abs(instructions - line.instructions_per_pixel * PIXELS) > TOLERANCE:
            raise Failure(f"{chip} {line.name}: {instructions} instructions traced, and counted {line}")
        row = dict(zip(line._fields[:6], line[:6]))
        row["instructions_per_pixel"] = round(instructions / PIXELS, 2)
        total = count(edges) if count else None
        row["cycles_per_pixel"] = round(total / PIXELS, 2) if count else None
        row["how"] = "exact" if chip in EXACT else "estimate"
        clocks = CHIPS[chip].clocks.items()
        row["frames_per_second"] = {at: round(mhz * 1e6 / total, 2) for at, mhz in clocks} if count else None
        row["hash"] = line.hash
        found.append(row)
    return found


def executed(edges):
    return sum(times * len(block) for (block, _), times in edges.items())


def show(found):
    print(f"frames per second of 320x240; a 62.5 MHz serial display takes {DISPLAY:.1f}")
    print(f"{'core':<5} {'frame':<48} {'instr/px':>9} {'cycles/px':>9} {'':<9} frames/s")
    for row in found:
        name = " ".join(row[key] for key in ("scene", "strategy", "filter", "depth", "format"))
        clocks = CHIPS[row["core"]].clocks
        rates = row["frames_per_second"] or dict.fromkeys(clocks, "-")
        rates = ", ".join(f"{rate} ({at}, {clocks[at]} MHz)" for at, rate in rates.items())
        count = "-" if row["cycles_per_pixel"] is None else row["cycles_per_pixel"]
        print(f"{row['core']:<5} {name:<48} {row['instructions_per_pixel']:>9} {count:>9} {row['how']:<9} {rates}")
