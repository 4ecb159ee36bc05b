"""The lines of the images that count instructions, and what must hold between cores."""

from typing import NamedTuple

from .build import build_all
from .chips import COUNTED
from .failure import Failure
from .qemu import run

# Of a frame.
PIXELS = 320 * 240


class Row(NamedTuple):
    """A line. Where there is nothing to count by, a count is None."""

    core: str
    scene: str
    strategy: str
    filter: str
    depth: str
    format: str
    instructions_per_pixel: float
    instructions_per_triangle: float | None
    hash: str

    @property
    def name(self):
        """What was done, on whichever core."""
        return " ".join(self[1:6])

    def __str__(self):
        counts = ["-" if count is None else f"{count:.2f}" for count in self[6:8]]
        return " ".join([*self[:6], *counts, self.hash])


def rows(chip, printed):
    """What an image printed."""
    found = []
    for line in printed.splitlines():
        words = line.split()
        if words[:1] == ["#"]:
            continue
        if len(words) != len(Row._fields) or words[0] != chip:
            raise Failure(f"{chip}: not a line of counts: {line}")
        counts = [None if word == "-" else float(word) for word in words[6:8]]
        found.append(Row(*words[:6], *counts, words[8]))
    if not found:
        raise Failure(f"{chip}: the image counted nothing")
    return found


def counted(chip):
    """All rows of a core."""
    images = build_all(chip, COUNTED)
    return [row for image, path in images.items() for row in rows(chip, run(chip, path, counted=True))]


def same_frames(rows):
    """What was counted is worth nothing if the cores do not draw the same."""
    drawn = {}
    for row in rows:
        drawn.setdefault(row.name, {}).setdefault(row.core, set()).add(row.hash)
    cores = {row.core for row in rows}
    different = [name for name, on in drawn.items() if len(set(map(frozenset, on.values()))) != 1]
    if different:
        raise Failure(f"the cores draw different pixels: {', '.join(different)}")
    missing = [name for name, on in drawn.items() if on.keys() != cores]
    if missing:
        raise Failure(f"not counted on all cores: {', '.join(missing)}")
