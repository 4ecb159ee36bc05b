"""The README's table: what the record says of one scene, and of memory."""

from . import record
from .chips import BOARDS
from .failure import Failure

README = record.ROOT / "README.md"
SCENE = "oblique"
BEGIN = "<!-- table of `firmware/run all table` -->"
END = "<!-- end of the table -->"
# Rows: strategy, filter, depth test, format.
ROWS = [
    ("affine", "nearest", "none", "rgb565:sized"),
    ("every:16", "nearest", "none", "rgb565:sized"),
    ("every:16", "nearest", "z16", "rgb565:sized"),
    ("adaptive", "nearest", "none", "rgb565:sized"),
    ("exact", "nearest", "none", "rgb565:sized"),
    ("every:16", "bilinear", "none", "rgb565:sized"),
    ("affine", "nearest", "none", "rgb565"),
    ("every:16", "nearest", "none", "rgb565"),
    ("every:16", "nearest", "z16", "rgb565"),
    ("every:16", "bilinear", "none", "rgb565"),
    ("every:16", "trilinear:piece", "none", "rgb565"),
]
NAMES = ("strategy", "filter", "depth", "format")
# Of triangles so small that setting them up is nearly all.
MESH = [("affine", "nearest", "none", "rgb565:sized"), ("every:16", "nearest", "none", "rgb565:sized")]
FLASH = ["affine", "nearest", "depth", "whole"]


def markdown():
    """The table's lines."""
    found = record.read()
    if not found.get("rows"):
        raise Failure("nothing is recorded; do `firmware/run all bench` first")
    rows = {(row["scene"], *(row[name] for name in NAMES)): row for row in found["rows"]}
    yield f"| {SCENE}, instructions a pixel | " + " | ".join(BOARDS) + " |"
    yield "|---|" + "---|" * len(BOARDS)
    for names in ROWS:
        yield line(names, rows, SCENE, "instructions_per_pixel")
    yield ""
    yield "| mesh, instructions a triangle | " + " | ".join(BOARDS) + " |"
    yield "|---|" + "---|" * len(BOARDS)
    for names in MESH:
        yield line(names, rows, "mesh", "instructions_per_triangle")
    yield ""
    yield "| flash of the core, bytes | m0 | m4 |"
    yield "|---|---|---|"
    flash = {(row["core"], row["image"]): row for row in found.get("flash", [])}
    for image in FLASH:
        bytes_of = [str(flash[core, image]["flash_of_feature"]) for core in ("m0", "m4")]
        yield f"| image `size-{image}` | " + " | ".join(bytes_of) + " |"


def line(names, rows, scene, of):
    """One row of the table."""
    if (scene, *names) not in rows:
        raise Failure(f"the record has no row {scene} {' '.join(names)}")
    counts = rows[scene, *names][of]
    shown = [f"{counts[core]:.1f}" if of.endswith("pixel") else f"{counts[core]:.0f}" for core in BOARDS]
    strategy, filter, depth, texels = names
    what = f"{strategy} {filter}" + ("" if depth == "none" else f" {depth}") + f", `{texels}`"
    return f"| {what} | " + " | ".join(shown) + " |"


def table():
    """Prints it."""
    print("\n".join(markdown()))


def check():
    """Fails unless the README has it."""
    wanted = "\n".join([BEGIN, *markdown(), END])
    if wanted not in README.read_text():
        raise Failure("README.md: the table is not what `firmware/run all table` prints")


def write():
    """Puts it into the README, between its marks."""
    text = README.read_text()
    if BEGIN not in text or END not in text:
        raise Failure(f"README.md has no lines {BEGIN} and {END}")
    before, rest = text.split(BEGIN, 1)
    _, after = rest.split(END, 1)
    README.write_text(before + "\n".join([BEGIN, *markdown(), END]) + after)
