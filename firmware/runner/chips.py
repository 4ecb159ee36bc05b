"""Which chips there are, and which images each has room for."""

from typing import NamedTuple


class Chip(NamedTuple):
    """The compiler's target and flags, and QEMU's program and machine."""

    target: str
    qemu: str
    machine: str
    qemu_options: list = []
    compiler_flags: str = ""
    # Clocks, in MHz, of chips that are sold with such a core.
    clocks: dict = {}


ARM, RISCV = "qemu-system-arm", "qemu-system-riscv32"
# Another chip also needs a feature in images/Cargo.toml, a memory map in images/build.rs, and a
# plan in scenes/src/plan.rs that images/src/lib.rs names.
CHIPS = {
    "stm32f405": Chip("thumbv7em-none-eabihf", ARM, "netduinoplus2"),
    "nrf51": Chip("thumbv6m-none-eabi", ARM, "microbit"),
    # Boards with room for whole frames. QEMU has none with a Cortex-M0+; its code runs on an M3.
    "m0": Chip("thumbv6m-none-eabi", ARM, "mps2-an385", clocks={"RP2040": 125}),
    "m3": Chip("thumbv7m-none-eabi", ARM, "mps2-an385"),
    "m4": Chip("thumbv7em-none-eabihf", ARM, "mps2-an386", clocks={"STM32F405": 168}),
    "m7": Chip(
        "thumbv7em-none-eabihf", ARM, "mps2-an500",
        compiler_flags="-Ctarget-cpu=cortex-m7", clocks={"STM32H743": 480},
    ),
    "m33": Chip("thumbv8m.main-none-eabi", ARM, "mps2-an505"),
    "riscv": Chip("riscv32imac-unknown-none-elf", RISCV, "virt", qemu_options=["-bios", "none"]),
}
# Chips whose flash and RAM a product could have; the others are there to measure.
PRODUCTS = ["stm32f405", "nrf51"]
# The cores whose code these run.
CORES = {"nrf51": "m0", "stm32f405": "m4"}
BOARDS = [chip for chip in CHIPS if chip not in PRODUCTS]
# The images that count instructions, each of a topic.
COUNTED = ["strategies", "sized", "within", "lengths", "filters", "formats", "geometry"]
# The image whose executed addresses are traced.
TRACED = "cycles"
