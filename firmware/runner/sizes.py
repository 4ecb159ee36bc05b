"""What filters take of the flash: the images that draw one triangle to show it."""

from . import elf
from .build import build
from .failure import Failure, note

# The core's modules of which each image may have code, and must. The first holds a pyramid of which
# it reads the finest level, the second only that level; the others differ from the first in their
# filter.
FILTERS = {
    "size-nearest": set(),
    "size-picture": set(),
    "size-bilinear": {"filter", "colour"},
    "size-mipmapped": {"filter", "lod", "mipmap"},
    "size-trilinear": {"filter", "colour", "lod", "mipmap"},
}
MODULES = set().union(*FILTERS.values())
# Bytes of an RGB565 picture of 64x64, and of its pyramid.
PICTURE, LEVELS = 2 * 64 * 64, 2 * sum(4**level for level in range(7))


def filter_sizes(chips):
    print(f"{'chip':<10} {'image':<15} {'text':>7} {'data':>5} {'bss':>6} {'more':>6}  code of")
    faults = []
    for chip in chips:
        first, *_ = images = {image: build(chip, image) for image in FILTERS}
        base = elf.sizes(images[first])
        for image, path in images.items():
            counted, found = elf.sizes(path), elf.with_code(path, MODULES)
            text, data, bss = counted
            print(f"{chip:<10} {image:<15} {text:>7} {data:>5} {bss:>6} {text - base[0]:>+6}  ", end="")
            print(", ".join(sorted(found)) or "no filter")
            constants = elf.constants(path)
            faults += [f"{chip} {image}: {fault}" for fault in wrong(image, counted, base, found, constants)]
    for fault in faults:
        note(f"WRONG {fault}")
    if faults:
        raise Failure(f"{len(faults)} of the images' properties do not hold")


def wrong(image, counted, base, found, constants):
    """What is not as the documentation says."""
    expected = FILTERS[image]
    for module in sorted(found ^ expected):
        yield f"{'has' if module in found else 'lacks'} code of {module}"
    if ("BULGE" in constants) != ("lod" in expected):
        yield "the table of logarithms goes with the choice of levels"
    if "LIGHT" in constants:
        yield "has the table that only building pyramids needs"
    if counted[1:] != (0, base[2]):
        yield f"data and bss are {counted[1:]} and not (0, {base[2]})"
    # Read-only and whole: the compiler computed it.
    name, size = ("SIZE_PICTURE", PICTURE) if image == "size-picture" else ("SIZE_LEVELS", LEVELS)
    if constants.get(name) != size:
        yield f"{name} takes {constants.get(name)} bytes of flash and not {size}"
    # The rest is the same code, but for the texels' alignment.
    if image == "size-picture" and abs(base[0] - counted[0] - (LEVELS - PICTURE)) > 8:
        yield f"levels from 1 on take {base[0] - counted[0]} bytes of flash and not {LEVELS - PICTURE}"
