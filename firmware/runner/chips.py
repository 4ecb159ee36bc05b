"""Which chips there are, and which images each has room for."""

from typing import NamedTuple


class Chip(NamedTuple):
    """The compiler's target, and QEMU's program and machine."""

    target: str
    qemu: str
    machine: str


# Another chip also needs a feature in images/Cargo.toml, a memory map in images/build.rs, and a
# plan in scenes/src/plan.rs that images/src/lib.rs names.
CHIPS = {
    "stm32f405": Chip("thumbv7em-none-eabihf", "qemu-system-arm", "netduinoplus2"),
    "nrf51": Chip("thumbv6m-none-eabi", "qemu-system-arm", "microbit"),
    # Boards with room for whole frames. QEMU has none with a Cortex-M0+; its code runs on an M3.
    "m4": Chip("thumbv7em-none-eabihf", "qemu-system-arm", "mps2-an386"),
    "m0": Chip("thumbv6m-none-eabi", "qemu-system-arm", "mps2-an385"),
}
# Chips whose flash and RAM a product could have; the others are there to measure.
PRODUCTS = ["stm32f405", "nrf51"]
BOARDS = ["m4", "m0"]
# Images in which the timer counts instructions.
COUNTED = ["bench", "filters"]
