"""What features take of the flash: images that do one thing, each differing from another in one
feature."""

from typing import NamedTuple

from . import elf, record
from .build import build_all
from .chips import CORES
from .failure import Failure, note

PREFIX = "size-"
ZERO = "nothing"
# The core's modules of which only images that use them may have code.
LINEAR, LEVELS = {"filter", "colour"}, {"filter", "lod", "mipmap"}
MESH = {"clip", "camera", "transform"}
MODULES = LINEAR | LEVELS | MESH
# What an image brings and is not the core's.
GIVEN = "SIZE_"
TRIANGLE = {"SIZE_CORNERS", "SIZE_LEVELS"}
CLIPPED = {"SIZE_CLIPPED", "SIZE_TRIANGLES", "SIZE_LEVELS"}
SEEN = {"SIZE_MESH", "SIZE_VERTICES", "SIZE_TRIANGLES", "SIZE_LEVELS"}
PYRAMID = {"SIZE_PYRAMID"}
# Bytes of an RGB565 picture of 64x64, and of its pyramid.
TEXELS = {"SIZE_PICTURE": 2 * 64 * 64, "SIZE_LEVELS": 2 * sum(4**level for level in range(7))}
# Where a constant begins may depend on another's size.
ALIGNMENT = 8


class Image(NamedTuple):
    """The image that it is compared with, what it does more or instead, those of `MODULES` of which
    it must have code, and the constants that it brings."""

    previous: str | None
    feature: str
    modules: set
    brings: set


IMAGES = {
    ZERO: Image(None, "starts and ends", set(), set()),
    "prepared": Image(ZERO, "a band, and vertices on the screen", set(), {"SIZE_CORNERS"}),
    "affine": Image("prepared", "draws: affine, nearest texel", set(), TRIANGLE),
    "nearest": Image("affine", "every:16 instead of affine", set(), TRIANGLE),
    "within": Image("nearest", "affine within a bound", set(), TRIANGLE),
    "exact": Image("affine", "exact instead of affine", set(), TRIANGLE),
    "adaptive": Image("affine", "adaptive instead of affine", set(), TRIANGLE),
    "constant-z": Image("affine", "constant-z instead of affine", set(), TRIANGLE),
    "quadratic": Image("affine", "quadratic:16 instead of affine", set(), TRIANGLE),
    "extrapolated": Image("affine", "extrapolated instead of affine", set(), TRIANGLE),
    "subdivided": Image("affine", "subdivided instead of affine", set(), TRIANGLE),
    "picture": Image("nearest", "no coarser levels", set(), {"SIZE_CORNERS", "SIZE_PICTURE"}),
    "bilinear": Image("nearest", "bilinear", LINEAR, TRIANGLE),
    "bilinear-5": Image("nearest", "bilinear, weights of 5 bits", LINEAR, TRIANGLE),
    "level-each-span": Image("nearest", "a level for each span", LEVELS, TRIANGLE | PYRAMID),
    "mipmapped": Image("level-each-span", "for each piece instead", LEVELS, TRIANGLE | PYRAMID),
    "trilinear": Image("mipmapped", "trilinear", LINEAR | LEVELS, TRIANGLE | PYRAMID),
    "trilinear-5": Image("mipmapped", "trilinear, of 5 bits", LINEAR | LEVELS, TRIANGLE | PYRAMID),
    "anisotropic": Image("trilinear", "anisotropic:4", LINEAR | LEVELS, TRIANGLE | PYRAMID),
    "depth": Image("nearest", "z16", set(), TRIANGLE),
    "clip": Image("nearest", "clips and projects", {"clip"}, CLIPPED),
    "transform": Image("clip", "a mesh and a camera", MESH, SEEN),
    "projected": Image("transform", "vertices projected once a frame", MESH, SEEN),
    "look-at": Image("transform", "the camera from angles", MESH, SEEN),
    "transform-levels": Image("transform", "a level for each span", MESH | LEVELS, SEEN | PYRAMID),
    "whole": Image("transform-levels", "z16", MESH | LEVELS, SEEN | PYRAMID),
}


class Built(NamedTuple):
    """What an image consists of. `modules`: of all of the core's, those that it has code of."""

    text: int
    data: int
    bss: int
    constants: dict
    modules: set

    @property
    def given(self):
        return {name: size for name, size in self.constants.items() if name.startswith(GIVEN)}

    @property
    def code(self):
        """Bytes of flash besides what the image brings."""
        return self.text - sum(self.given.values())


def counted(chip):
    """A row for each image. Fails where one is not what its line in `IMAGES` says."""
    paths = build_all(chip, [PREFIX + name for name in IMAGES])
    modules = record.core_modules()
    built = {
        name: Built(*elf.sizes(path), elf.constants(path), elf.with_code(path, modules))
        for name, path in zip(IMAGES, paths.values())
    }
    faults = [fault for name in IMAGES for fault in wrong(name, built)]
    for fault in faults:
        note(f"WRONG {chip} {fault}")
    if faults:
        raise Failure(f"{chip}: {len(faults)} of the images' properties do not hold")
    return [row(chip, name, built) for name in IMAGES]


def row(chip, name, built):
    """What is printed and written down of an image."""
    image, previous = built[name], IMAGES[name].previous
    return {
        "core": CORES[chip],
        "image": name,
        "text": image.text,
        "data": image.data,
        "bss": image.bss,
        "flash_of_feature": image.code - built[ZERO].code,
        "more_than_previous": image.code - built[previous].code if previous else 0,
        "previous": previous,
        "feature": IMAGES[name].feature,
    }


def sizes(chips):
    """Prints a table, and gives its rows."""
    found = [row for chip in chips for row in counted(chip)]
    columns = ["core", "image", "text", "data", "bss", "flash_of_feature", "more_than_previous"]
    line = "{:<4} {:<16} {:>6} {:>4} {:>5} {:>16} {:>18}  {}"
    print(line.format(*columns, "previous and feature"))
    for row in found:
        change = f"{row['previous']} + {row['feature']}" if row["previous"] else row["feature"]
        print(line.format(*(row[column] for column in columns), change))
    return found


def sizes_all():
    """Prints those of all chips, and writes them down."""
    record.add(flash=sizes(CORES))


def wrong(name, built):
    """What is not as the documentation says."""
    image, zero = built[name], built[ZERO]
    _, _, modules, brings = IMAGES[name]
    if name == ZERO and image.modules:
        yield f"{name} has code of {', '.join(sorted(image.modules))}"
    for module in sorted((image.modules & MODULES) ^ modules):
        yield f"{name} {'has' if module in image.modules else 'lacks'} code of {module}"
    if ("BULGE" in image.constants) != ("lod" in modules):
        yield f"{name}: the table of logarithms goes with the choice of levels"
    if "LIGHT" in image.constants:
        yield f"{name} has the table that only building pyramids needs"
    if (image.data, image.bss) != (0, zero.bss):
        yield f"{name}: data and bss are {image.data} and {image.bss} and not 0 and {zero.bss}"
    # What is not there cannot be subtracted. Texels are read-only and whole: the compiler computed
    # them.
    if image.given.keys() != brings:
        yield f"{name} brings {sorted(image.given)} and not {sorted(brings)}"
    for texels in TEXELS.keys() & image.given.keys():
        if image.given[texels] != TEXELS[texels]:
            yield f"{texels} takes {image.given[texels]} bytes of flash and not {TEXELS[texels]}"
    if name == "picture" and abs(image.code - built["nearest"].code) > ALIGNMENT:
        yield f"{name} has {image.code} bytes of code, and with coarser levels {built['nearest'].code}"
