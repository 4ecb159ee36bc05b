"""Cycles of Armv6-M instructions on a Cortex-M0+ (Technical Reference Manual r0p1, table 3-1).

Memory answers without wait states: code and data in RAM, or flash whose accelerator always hits.
The multiplier is the one of a single cycle, which an implementation may choose (the RP2040 did).
"""

import struct

from .failure import Failure


def registers(word):
    """How many an LDM, STM, PUSH or POP moves; the ninth bit of the latter is LR or PC."""
    return (word & 0x1FF if word & 0xF000 == 0xB000 else word & 0xFF).bit_count()


def one(_word, _taken):
    return 1


def two(_word, _taken):
    return 2


def branch(_word, taken):
    return 2 if taken else 1


def high(word, _taken):
    """ADD, CMP and MOV of all registers: two where the result is the program counter."""
    to_pc = word & 0x87 == 0x87 and word & 0x0300 != 0x0100
    return 2 if to_pc else 1


def several(word, _taken):
    return 1 + registers(word)


def pop(word, _taken):
    return (3 if word & 0x100 else 1) + registers(word)


# First halfwords from one to the next, and what they cost; None is no instruction of a program
# that draws, or none at all.
CLASSES = [
    (0x0000, one),  # shifts, additions, immediates
    (0x4000, one),  # data processing, MULS too
    (0x4400, high),
    (0x4700, two),  # BX, BLX
    (0x4800, two),  # loads and stores
    (0xA000, one),  # ADR, ADD to SP
    (0xB000, one),  # ADD to SP, SUB from SP
    (0xB100, None),  # CBZ is Armv7-M
    (0xB200, one),  # extensions
    (0xB300, None),
    (0xB400, several),  # PUSH
    (0xB600, None),
    (0xB660, one),  # CPS
    (0xB680, None),
    (0xBA00, one),  # byte orders
    (0xBB00, None),
    (0xBC00, pop),
    (0xBE00, None),  # BKPT
    (0xBF00, one),  # NOP
    (0xBF01, None),  # IT is Armv7-M
    (0xC000, several),  # STM, LDM
    (0xD000, branch),
    (0xDE00, None),  # UDF, SVC
    (0xE000, two),
    (0xE800, None),
    (0xF000, None),  # of two halfwords: see below
]


def cost(first, second, taken):
    """Cycles of the instruction; `taken` tells of a conditional branch. None if unknown."""
    if first & 0xF800 == 0xF000:
        barrier_or_status = first & 0xFFE0 in (0xF380, 0xF3E0, 0xF3A0) and second & 0xD000 == 0x8000
        return 3 if second & 0xD000 == 0xD000 or barrier_or_status else None
    _, cycles = max((entry for entry in CLASSES if entry[0] <= first), key=lambda entry: entry[0])
    return cycles(first, taken) if cycles else None


def size(first):
    """Bytes, from the first halfword."""
    return 4 if first >= 0xE800 else 2


class Costs:
    """Cycles of an image's instructions, by address."""

    def __init__(self, memory):
        self.memory = memory
        self.known = {}

    def at(self, address, taken=False):
        """Cycles and bytes of the instruction there."""
        if (address, taken) not in self.known:
            self.known[address, taken] = self.decoded(address, taken)
        return self.known[address, taken]

    def cycles(self, edges):
        """Of what ran: a block (the addresses of its instructions), where it went on, how often."""
        total = 0
        for (block, following), times in edges.items():
            _, length = self.at(block[-1])
            # Only the last one may branch.
            last, _ = self.at(block[-1], taken=following != block[-1] + length)
            total += times * (sum(self.at(address)[0] for address in block[:-1]) + last)
        return total

    def decoded(self, address, taken):
        code = self.memory.read(address, 4)
        if code is None:
            raise Failure(f"executed outside of the image: {address:#x}")
        first, second = struct.unpack("<2H", code)
        cycles = cost(first, second, taken)
        if cycles is None:
            raise Failure(f"unknown cycles: {first:04x} {second:04x} at {address:#x}")
        return cycles, size(first)


# Encodings as the assembler gives them, and their cycles by the manual.
CHECKS = [
    ("movs r0, #1", 0x2001, 0, False, 1),
    ("adds r0, r1, r2", 0x1888, 0, False, 1),
    ("muls r1, r0", 0x4341, 0, False, 1),
    ("mov r8, r0", 0x4680, 0, False, 1),
    ("mov pc, r0", 0x4687, 0, False, 2),
    ("add pc, r0", 0x4487, 0, False, 2),
    ("cmp pc, r0", 0x4587, 0, False, 1),
    ("bx lr", 0x4770, 0, False, 2),
    ("blx r3", 0x4798, 0, False, 2),
    ("ldr r0, [pc, #32]", 0x4808, 0, False, 2),
    ("strh r0, [r1, r2]", 0x5288, 0, False, 2),
    ("ldrb r0, [r1, #1]", 0x7848, 0, False, 2),
    ("str r0, [sp, #4]", 0x9001, 0, False, 2),
    ("sub sp, #16", 0xB084, 0, False, 1),
    ("uxth r0, r0", 0xB280, 0, False, 1),
    ("push {r4, r5, r6, r7, lr}", 0xB5F0, 0, False, 6),
    ("pop {r4, r5, r6, r7}", 0xBCF0, 0, False, 5),
    ("pop {r4, r5, r6, r7, pc}", 0xBDF0, 0, False, 8),
    ("stm r0!, {r2}", 0xC004, 0, False, 2),
    ("ldm r0!, {r1, r2, r3}", 0xC80E, 0, False, 4),
    ("bne", 0xD1FB, 0, True, 2),
    ("bne, not taken", 0xD1FB, 0, False, 1),
    ("b", 0xE7FB, 0, True, 2),
    ("bl", 0xF00A, 0xF9C1, True, 3),
    ("dmb sy", 0xF3BF, 0x8F5F, False, 3),
    ("mrs r0, primask", 0xF3EF, 0x8010, False, 3),
    ("cbz r0 (Armv7-M)", 0xB100, 0, False, None),
    ("it eq (Armv7-M)", 0xBF08, 0, False, None),
]


def self_check():
    """Refuses to count by a table that is wrong."""
    for text, first, second, taken, cycles in CHECKS:
        found = cost(first, second, taken)
        if found != cycles:
            raise Failure(f"the table of cycles gives {found} and not {cycles} for {text}")
