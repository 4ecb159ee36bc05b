"""The README's tables: what the record says of one scene, and of memory."""

from . import record
from .chips import BOARDS
from .failure import Failure

README = record.ROOT / "README.md"
SCENE = "oblique"
# Rows: strategy, filter, depth test, format.
ROWS = [
    ("affine", "nearest", "none", "rgb565:sized"),
    ("every:16", "nearest", "none", "rgb565:sized"),
    ("affine", "nearest", "z16", "rgb565:sized"),
    ("every:16", "nearest", "z16", "rgb565:sized"),
    ("exact", "nearest", "z16", "rgb565:sized"),
    ("adaptive", "nearest", "none", "rgb565:sized"),
    ("quadratic:16", "nearest", "none", "rgb565:sized"),
    ("exact", "nearest", "none", "rgb565:sized"),
    ("every:16", "bilinear", "none", "rgb565:sized"),
    ("every:16", "bilinear:5", "none", "rgb565:sized"),
    ("affine", "nearest", "none", "rgb565"),
    ("every:16", "nearest", "none", "rgb565"),
    ("every:16", "nearest", "z16", "rgb565"),
    ("every:16", "nearest-mip-nearest:span", "none", "rgb565"),
    ("every:16", "nearest-mip-nearest:span", "z16", "rgb565"),
    ("every:16", "bilinear", "none", "rgb565"),
    ("every:16", "trilinear:piece", "none", "rgb565"),
    ("every:16", "trilinear:5:piece", "none", "rgb565"),
]
NAMES = ("strategy", "filter", "depth", "format")
# Of triangles so small that setting them up is nearly all.
STRATEGIES = ("affine", "affine-within", "every:16", "adaptive", "exact")
MESH = [(strategy, "nearest", "none", "rgb565:sized") for strategy in STRATEGIES]
MESH += [(strategy, "nearest", "z16", "rgb565:sized") for strategy in ("affine", "every:16", "exact")]
MESH += [("every:16", "nearest-mip-nearest:span", depth, "rgb565") for depth in ("none", "z16")]
# With two of Cargo's profiles.
PROFILED = [
    (strategy, "nearest", depth, "rgb565:sized") for strategy in ("affine", "every:16") for depth in ("none", "z16")
]
FLASH = ["affine", "nearest", "depth", "whole"]
# What filters cost, of a `Texture`, and formats, of the nearest texel: the row's name and its filter or
# format.
FILTERS = {
    "nearest": "nearest",
    "bilinear": "bilinear",
    "bilinear:5": "bilinear:5",
    "nearest-mip-nearest, a level each triangle": "nearest-mip-nearest:triangle",
    "nearest-mip-nearest, a level each span": "nearest-mip-nearest:span",
    "nearest-mip-nearest, each piece of 16 columns": "nearest-mip-nearest:piece",
    "nearest-mip-nearest, each pixel": "nearest-mip-nearest:pixel",
    "linear-mip-nearest, each piece": "linear-mip-nearest:piece",
    "trilinear, each piece": "trilinear:piece",
    "trilinear:5, each piece": "trilinear:5:piece",
    "trilinear, each pixel": "trilinear:pixel",
    "aniso:4, each piece": "anisotropic:4:piece",
}
FORMATS = {
    "`SizedTexture` of `Rgb565`": ("nearest", "rgb565:sized"),
    "`Texture` of `Rgb565`": ("nearest", "rgb565"),
    "`Indexed8`": ("nearest", "palette8"),
    "`Indexed4`": ("nearest", "palette4"),
    "`Gray8`": ("nearest", "gray8"),
    "`Rgba5551` with alpha test": ("alpha-test", "rgba5551"),
    "`Bc1`, each texel by itself (in use where a texel is less than two pixels)": ("nearest", "bc1"),
    "`Bc1`, four colours mixed for each block that a run enters": ("nearest", "bc1:block"),
    "`Morton`": ("nearest", "morton"),
    "`ImageTexels` of an `ImageRaw`": ("nearest", "image:rgb565"),
}
# Cores of these, with the names of their columns.
SHORT = {"m4": "Cortex-M4", "m0": "Cortex-M0 code"}


def recorded():
    """The record, and its rows by scene and names."""
    found = record.read()
    if not found.get("rows"):
        raise Failure("nothing is recorded; do `firmware/run all bench` first")
    return found, {(row["scene"], *(row[name] for name in NAMES)): row for row in found["rows"]}


def filters():
    """What filters cost."""
    _, rows = recorded()
    yield from heading("instructions a pixel, every:16")
    for name, filter in FILTERS.items():
        yield short(name, rows, filter, "rgb565")


def formats():
    """What texel formats cost."""
    _, rows = recorded()
    yield from heading("nearest, instructions a pixel, every:16")
    for name, (filter, format) in FORMATS.items():
        yield short(name, rows, filter, format)


def heading(title):
    yield f"| {title} | " + " | ".join(SHORT.values()) + " |"
    yield "|---|" + "---|" * len(SHORT)


def short(name, rows, filter, format):
    """A row with the short list of cores."""
    counts = counted(rows, SCENE, ("every:16", filter, "none", format))["instructions_per_pixel"]
    return f"| {name} | " + " | ".join(f"{counts[core]:.1f}" for core in SHORT) + " |"


def costs():
    """What strategies cost on all cores, and flash."""
    found, rows = recorded()
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
    counts = counted(rows, scene, names)[of]
    shown = [f"{counts[core]:.1f}" if of.endswith("pixel") else f"{counts[core]:.0f}" for core in BOARDS]
    strategy, filter, depth, texels = names
    what = f"{strategy} {filter}" + ("" if depth == "none" else f" {depth}") + f", `{texels}`"
    return f"| {what} | " + " | ".join(shown) + " |"


def counted(rows, scene, names):
    """The record's row."""
    if (scene, *names) not in rows:
        raise Failure(f"the record has no row {scene} {' '.join(names)}")
    return rows[scene, *names]


def defaults():
    """What Cargo's own profile makes of the same work."""
    found, rows = recorded()
    by_names = {(row["scene"], *(row[name] for name in NAMES)): row for row in found.get("profiles", [])}
    yield "| instructions | " + " | ".join(f"{core}, this | {core}, Cargo's own" for core in SHORT) + " |"
    yield "|---|" + "---|---|" * len(SHORT)
    for scene, of, what in (("oblique", "instructions_per_pixel", "a pixel"), ("mesh", "instructions_per_triangle", "a triangle")):
        for names in PROFILED:
            pair = [counted(known, scene, names)[of] for known in (rows, by_names)]
            digits = 1 if scene == "oblique" else 0
            shown = [f"{counts[core]:.{digits}f}" for core in SHORT for counts in pair]
            strategy, filter, depth, _ = names
            yield f"| {scene} {strategy} {filter}" + ("" if depth == "none" else f" {depth}") + f", {what} | " + " | ".join(shown) + " |"


# By the mark that each has in the README.
TABLES = {"costs": costs, "filters": filters, "formats": formats, "defaults": defaults}


def marks(name):
    return f"<!-- {name} of `firmware/run all table` -->", f"<!-- end of {name} -->"


def table():
    """Prints them."""
    for name, lines in TABLES.items():
        print("\n".join([f"{name}:", *lines(), ""]))


def written(text):
    """The README's text with the tables between their marks."""
    for name, lines in TABLES.items():
        begin, end = marks(name)
        if text.count(begin) != 1 or text.count(end) != 1:
            raise Failure(f"README.md has no lines {begin} and {end}, or more than one of them")
        before, rest = text.split(begin)
        _, after = rest.split(end)
        text = before + "\n".join([begin, *lines(), end]) + after
    return text


def check():
    """Fails unless the README has them."""
    text = README.read_text()
    if written(text) != text:
        raise Failure("README.md: a table is not what `firmware/run all table` prints; do `firmware/run all table --write`")


def write():
    """Puts them into the README."""
    README.write_text(written(README.read_text()))
