"""Cycles of frames: counted from a trace on the Cortex-M0+, estimated on the M4 and M7."""

import shutil

from . import elf, mca, record, thumb
from .build import build
from .chips import CHIPS, TRACED
from .counts import PIXELS, rows, same_frames
from .failure import Failure, note
from .qemu import run
from .trace import executed, trace

EXACT, ESTIMATED = ["m0"], ["m4", "m7"]
# A display of 16 bits a pixel on a serial line of 62.5 MHz, the RP2040's fastest.
DISPLAY = 62.5e6 / (PIXELS * 16)
# The image's counter ticks each 40 instructions and prints hundredths of a pixel's; what lies
# between counter and markers is a few dozen.
TOLERANCE = 500


def cycles(chip):
    """Prints a core's frames."""
    show(recorded(chip, *frame) for frame in frames(chip))


def cycles_all(required):
    """Prints those of all cores, and writes them down. `required`: without llvm-mca it fails."""
    if not record.current():
        raise Failure(f"{record.PATH.name} is of other sources or tools: do `firmware/run all bench` first")
    missing = [tool for tool in ("llvm-mca", "llvm-objdump") if not shutil.which(tool)]
    if missing:
        text = f"no {' and no '.join(missing)} on the path; do `apt-get install llvm`"
        if required:
            raise Failure(text)
        note(f"NO ESTIMATES for m4 and m7: {text}")
    found = {chip: frames(chip) for chip in EXACT}
    found |= {chip: drawn(chip) if missing else frames(chip) for chip in ESTIMATED}
    same_frames([row for lines in found.values() for row, _ in lines])
    rows = [recorded(chip, *frame) for chip, lines in found.items() for frame in lines]
    show(rows)
    record.add(llvm_mca=None if missing else mca.version(), cycles=rows)


def frames(chip):
    """What was counted of each frame, and its cycles."""
    path = build(chip, TRACED)
    if chip in EXACT:
        thumb.self_check()
        count = thumb.Costs(elf.Memory(path)).cycles
    else:
        count = mca.Estimate(chip, path).cycles_of
    note(f"{chip}: tracing, which takes minutes")
    printed, traced = trace(chip, path)
    drawn = rows(chip, printed)
    if len(drawn) != len(traced):
        raise Failure(f"{chip}: {len(drawn)} frames drawn and {len(traced)} traced")
    for row, edges in zip(drawn, traced):
        instructions = executed(edges)
        if abs(instructions - row.instructions_per_pixel * PIXELS) > TOLERANCE:
            raise Failure(f"{chip}: {instructions} instructions traced, but counted {row}")
    return [(row, count(edges)) for row, edges in zip(drawn, traced)]


def drawn(chip):
    """The same without cycles."""
    path = build(chip, TRACED)
    return [(row, None) for row in rows(chip, run(chip, path, counted=True))]


def recorded(chip, row, total):
    """What is written down of a frame."""
    clocks = CHIPS[chip].clocks.items()
    return dict(zip(row._fields[:7], row[:7])) | {
        "cycles_per_pixel": None if total is None else round(total / PIXELS, 2),
        "how": "exact" if chip in EXACT else "estimate",
        "frames_per_second": None if total is None else {at: round(mhz * 1e6 / total, 2) for at, mhz in clocks},
        "hash": row.hash,
    }


def show(found):
    print(f"frames per second of 320x240; a 62.5 MHz serial display takes {DISPLAY:.1f}")
    print(f"{'core':<5} {'frame':<48} {'instr/px':>9} {'cycles/px':>9} {'':<9} frames/s")
    for row in found:
        name = " ".join(row[key] for key in ("scene", "strategy", "filter", "depth", "format"))
        clocks = CHIPS[row["core"]].clocks
        rates = row["frames_per_second"] or dict.fromkeys(clocks, "-")
        rates = ", ".join(f"{rate} ({at}, {clocks[at]} MHz)" for at, rate in rates.items())
        count = "-" if row["cycles_per_pixel"] is None else row["cycles_per_pixel"]
        numbers = f"{row['instructions_per_pixel']:>9} {count:>9} {row['how']:<9} {rates}"
        print(f"{row['core']:<5} {name:<48} {numbers}")
