"""How much stack a call takes that draws a triangle: measured, and what its code can take at most."""

from . import qemu, record
from .build import build
from .failure import Failure, note
from .reserved import Code

IMAGE = "stack"
# Of which the budgets tell, and the record.
CHIPS = ["m0", "m4"]
# Whose code is not read.
OTHER = ["riscv"]
FIELDS = ["core", "strategy", "filter", "depth", "entry", "scene", "bytes", "code"]


def counted(chip):
    """A row for each configuration: the deepest of all triangles, and the first scene that has it."""
    path = build(chip, IMAGE)
    code = None if chip in OTHER else Code(path)
    rows = []
    for line in qemu.run(chip, path).splitlines():
        words = line.split()
        if len(words) != len(FIELDS) or words[0] != chip:
            raise Failure(f"{chip}: not a line of stacks: {line}")
        row = dict(zip(FIELDS, words))
        # Bit 0 of an address tells Thumb code.
        entry = int(row.pop("code"), 16) & ~1
        row |= {"bytes": int(row["bytes"]), "at_most": bound(code, entry, line)}
        if row["at_most"] is not None and row["bytes"] > row["at_most"]:
            raise Failure(f"{chip}: {line}: more than its code reserves, {row['at_most']}")
        rows.append(row)
    if not rows:
        raise Failure(f"{chip}: the image measured nothing")
    return rows


def bound(code, entry, line):
    """What the code can take; None where that cannot be told."""
    try:
        return code and code.at_most(entry)
    except Failure as failure:
        note(f"NO BOUND of {line}: {failure}")
        return None


def name(row):
    """What is drawn, on whichever core."""
    return " ".join(row[field] for field in FIELDS[1:5])


def stack(chips):
    """Prints a table, and gives its rows."""
    rows = [row for chip in chips for row in counted(chip)]
    line = "{:<5} {:<46} {:<9} {:>5} {:>7}"
    print(line.format("core", "configuration", "scene", "bytes", "at_most"))
    for row in rows:
        most = "-" if row["at_most"] is None else row["at_most"]
        print(line.format(row["core"], name(row), row["scene"], row["bytes"], most))
    return rows


def stack_all():
    """Prints those of two cores, and writes them down."""
    record.add(stack=stack(CHIPS))
