"""Compares the frames that chips draw with the PC's."""

import re
import subprocess

from .build import FIRMWARE, build
from .failure import Failure
from .qemu import run
from .tools import need

# What is run, and the line that is compared.
IMAGE = "frames"
FRAME = re.compile(r"^frame (\S+) (\d+x\d+) ([0-9a-f]{16})$")
# The frames that each chip must draw: scene, size, and what host-sim is told besides.
TRILINEAR = ["--filter", "trilinear", "--lod-per", "piece"]
FRAMES = {
    "stm32f405": [
        ("crate", "320x240", []),
        ("spot", "320x240", []),
        ("room", "320x240", []),
        ("corridor", "320x240", TRILINEAR),
    ],
    "nrf51": [("crate", "160x120", []), ("checkers", "160x120", TRILINEAR)],
}
# The other architecture, with the same plan: see images/src/lib.rs.
FRAMES["riscv"] = FRAMES["stm32f405"]


def verify(chips):
    rows = []
    for chip in chips:
        rows += compare(chip, frames(run(chip, build(chip, IMAGE))), expected(chip))
    print(f"{'chip':<10} {'image':<7} {'scene':<9} {'size':<8} {'chip hash':<17} {'host hash':<17} result")
    for row in rows:
        print("{:<10} {:<7} {:<9} {:<8} {:<17} {:<17} {}".format(*row))
    different = sum(row[-1] != "same" for row in rows)
    if different:
        raise Failure(f"{different} of {len(rows)} frames differ from the PC's")


def compare(chip, seen, wanted):
    """Table rows; a frame that one side lacks is a difference."""
    for frame in sorted({**wanted, **seen}, key=[*wanted, *seen].index):
        ours, theirs = seen.get(frame, "-"), wanted.get(frame, "-")
        yield chip, IMAGE, *frame, ours, theirs, "same" if ours == theirs else "DIFFERENT"


def expected(chip):
    """The frames as the PC draws them: whole, and by host-sim's own way through the stages."""
    wanted = {}
    for scene, size, options in FRAMES[chip]:
        command = [need("cargo"), "run", "--quiet", "--release", "--locked", "--package", "host-sim"]
        command += ["--", "hash", scene, "--device", "--size", size, *options]
        done = subprocess.run(command, cwd=FIRMWARE.parent, stdout=subprocess.PIPE, text=True)
        if done.returncode != 0 or not frames(done.stdout):
            raise Failure(f"{chip} {scene}: host-sim gave no hash; its message is above")
        wanted.update(frames(done.stdout))
    return wanted


def frames(printed):
    """Hashes by scene and size."""
    found = filter(None, map(FRAME.match, printed.splitlines()))
    return {(match[1], match[2]): match[3] for match in found}
