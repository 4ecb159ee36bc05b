"""Compares what is counted with what may be spent.

A budget is a goal or what was counted when it was written down, with the compiler that the record
names; a count above it by more than `SLACK` fails. Another compiler inlines other functions: with one,
`OTHER_SLACK` is allowed, and the difference is said.
"""

import re
import tomllib

from . import elf, profiles, record, sizes, stack
from .build import FIRMWARE, build, toolchain
from .chips import CORES
from .counts import counted, same_frames
from .failure import Failure, note

BUDGETS = FIRMWARE.parent / "benches/budgets.toml"
# The image whose bytes are counted.
SHIPPED = "frames"
SLACK = 1.01
OTHER_SLACK = 1.15


def budgets(accept=False):
    """Fails over budget. `accept`: writes what was counted instead."""
    allowed = tomllib.loads(BUDGETS.read_text())
    limits, found, rows = {}, {}, []
    for chip, limit in allowed["instructions_per_pixel"].items():
        print(f"{chip}: {toolchain(chip)}")
        counts = counted(chip)
        rows += counts
        limits["instructions_per_pixel", chip] = limit
        found["instructions_per_pixel", chip] = {row.name: row.instructions_per_pixel for row in counts}
    same_frames(rows)
    profiled = []
    for chip, limit in allowed["defaults"].items():
        counts = profiles.counted(chip)
        profiled += counts
        limits["defaults", chip] = limit
        found["defaults", chip] = {row.name: row.instructions_per_pixel for row in counts}
    names = {row.name for row in profiled}
    same_frames(profiled + [row for row in rows if row.name in names])
    for chip, limit in allowed["bytes"].items():
        limits["bytes", chip] = limit
        found["bytes", chip] = dict(zip(("text", "data", "bss"), elf.sizes(build(chip, SHIPPED))))
    for chip, core in CORES.items():
        limits["flash", core] = allowed["flash"][core]
        built = sizes.counted(chip)
        found["flash", core] = {
            row["image"]: row["flash_of_feature"] for row in built if row["previous"]
        }
    for chip, limit in allowed["stack"].items():
        limits["stack", chip] = limit
        found["stack", chip] = {
            stack.name(row): row["at_most"] or row["bytes"] for row in stack.counted(chip)
        }
    if record.read().get("core_sources_sha256") != record.digest():
        note(f"{record.PATH.name} is of other sources than these: `firmware/run all bench` renews it")
    if accept:
        BUDGETS.write_text(rewritten(BUDGETS.read_text(), found))
        return
    recorded = record.read().get("toolchain")
    others = sorted({toolchain(chip) for chip in allowed["instructions_per_pixel"]} - {recorded})
    slack = OTHER_SLACK if others else SLACK
    if others:
        note(f"BUDGETS ARE OF ANOTHER COMPILER: {recorded}, not {', '.join(others)}; {slack} of them is allowed")
    lines = []
    for table, limit in limits.items():
        lines += within(" ".join(table), found[table], limit, slack)
    print(f"{'what':<28} {'of':<56} {'counted':>10} {'budget':>10} result")
    for line in lines:
        print("{:<28} {:<56} {:>10} {:>10} {}".format(*line))
    over = sum(line[-1] != "within" for line in lines)
    if over:
        raise Failure(f"{over} of {len(lines)} counts are over their budget in {BUDGETS.name}")


def within(what, counted, limits, slack):
    """Table rows; a count without a budget, or a budget without a count, is over."""
    for name in {**limits, **counted}:
        count, limit = counted.get(name, "-"), limits.get(name, "-")
        known = name in counted and name in limits
        yield what, name, count, limit, "within" if known and count <= limit * slack else "OVER"


def rewritten(text, found):
    """The file with the numbers that were found; the lines between stay. What a table lacks is
    added at its end, and what is no longer counted goes."""
    result, left, foreign = [], {}, False

    def finish():
        # Before the blank lines and comments that lead to the next table.
        end = len(result)
        while end and (not result[end - 1] or result[end - 1].startswith("#")):
            end -= 1
        result[end:end] = [f"{name} = {number}" for name, number in left.items()]

    for line in text.splitlines():
        if header := re.fullmatch(r"\[(\w+)\.(\w+)\]", line):
            finish()
            counted = found.get((header[1], header[2]))
            # The PC's budgets are not counted here.
            foreign = counted is None
            left = {quoted(name): number for name, number in (counted or {}).items()}
            result.append(line)
        elif foreign:
            result.append(line)
        elif entry := re.fullmatch(r'("[^"]*"|\w+) = \S+(\s*#.*)?', line):
            if entry[1] in left:
                result.append(f"{entry[1]} = {left.pop(entry[1])}{entry[2] or ''}")
        else:
            result.append(line)
    finish()
    return "\n".join(result) + "\n"


def quoted(name):
    return name if re.fullmatch(r"\w+", name) else f'"{name}"'
