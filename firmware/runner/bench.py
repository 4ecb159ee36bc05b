"""Counts everything, on one core or all."""

from . import record
from .build import need_tools
from .chips import BOARDS
from .counts import counted, same_frames
from .failure import note


def bench(chip):
    """Prints a core's rows."""
    for row in counted(chip):
        print(row)


def bench_all():
    """Prints a table of all cores, and writes it down."""
    # What one core lacks is told before the others are counted.
    for chip in BOARDS:
        need_tools(chip)
    rows = [row for chip in BOARDS for row in counted(chip)]
    same_frames(rows)
    by_name = {}
    for row in rows:
        by_name.setdefault(row.name, {})[row.core] = row
    print(f"{'instructions per pixel':<52}" + "".join(f"{chip:>9}" for chip in BOARDS))
    for name, on in by_name.items():
        print(f"{name:<52}" + "".join(f"{on[chip].instructions_per_pixel:>9.2f}" for chip in BOARDS))
    print(f"{len(by_name)} rows, each with the same frame on all cores")

    # The rest comes from other commands; that of other sources or tools is of no use here.
    old = record.read() if record.current() else {}
    record.write(old | record.tools() | {"rows": [merged(on) for on in by_name.values()]})
    for section in ("cycles", "flash", "stack", "profiles"):
        if not old.get(section):
            task = "sizes" if section == "flash" else section
            note(f"the record has no {section} of these sources: `firmware/run all {task}` adds it")


def merged(on):
    """The rows of one name, by core, as one: they have the same frame, and the file is a sixth."""
    row = next(iter(on.values()))
    shared = {field: getattr(row, field) for field in ("scene", "strategy", "filter", "depth", "format", "hash")}
    counts = ("instructions_per_pixel", "instructions_per_triangle")
    return shared | {count: {core: getattr(row, count) for core, row in on.items()} for count in counts}

