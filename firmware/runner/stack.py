"""How much stack a call takes that draws a triangle."""

from . import qemu, record
from .build import build
from .failure import Failure

IMAGE = "stack"
# Of which the budgets tell, and the record.
CHIPS = ["m0", "m4"]
FIELDS = ["core", "strategy", "filter", "depth", "entry", "scene", "bytes", "code"]


def counted(chip):
    """A row for each configuration: the deepest of all triangles, and the first scene that has it."""
    path = build(chip, IMAGE)
    rows = []
    for line in qemu.run(chip, path).splitlines():
        words = line.split()
        if len(words) != len(FIELDS) or words[0] != chip:
            raise Failure(f"{chip}: not a line of stacks: {line}")
        row = dict(zip(FIELDS, words))
        row["bytes"] = int(row["bytes"])
        del row["code"]
        rows.append(row)
    if not rows:
        raise Failure(f"{chip}: the image measured nothing")
    return rows


def name(row):
    """What is drawn, on whichever core."""
    return " ".join(row[field] for field in FIELDS[1:5])


def stack(chips):
    """Prints a table, and gives its rows."""
    rows = [row for chip in chips for row in counted(chip)]
    print(f"{'core':<6}{'configuration':<50}{'scene':<10}{'bytes':>6}")
    for row in rows:
        print(f"{row['core']:<6}{name(row):<50}{row['scene']:<10}{row['bytes']:>6}")
    return rows


def stack_all():
    """Prints those of two cores, and writes them down."""
    record.add(stack=stack(CHIPS))
