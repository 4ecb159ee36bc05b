"""What a function and those that it calls reserve of the stack at most, from an image's Thumb code.

A function's own is the sum of all that its instructions reserve, whichever way is taken; a call
that replaces the function (a tail call) counts as if it did not. So this is a bound, and close.
"""

from . import elf
from .failure import Failure

LR = 14


class Code:
    """The functions of an image."""

    def __init__(self, path):
        self.memory = elf.Memory(path)
        self.sizes, self.data = elf.functions(path)
        self.known = {}

    def at_most(self, address, callers=()):
        """Bytes that a call of the function at an address uses."""
        if address in callers:
            raise Failure(f"the function at {address:#x} calls itself: its stack has no bound")
        if address not in self.known:
            own, called = self.own(address)
            deeper = [self.at_most(to, (*callers, address)) for to in called]
            self.known[address] = own + max(deeper, default=0)
        return self.known[address]

    def own(self, address):
        """What a function reserves itself, and which others it goes to."""
        if not self.sizes.get(address):
            raise Failure(f"no function of known size begins at {address:#x}")
        end = address + self.sizes[address]
        own, called, at = 0, set(), address
        while at < end:
            if at in self.data:
                at = self.data[at]
                continue
            first, second = self.word(at), 0
            if first >> 11 in (0b11101, 0b11110, 0b11111):
                second = self.word(at + 2)
                own += reserves_long(first, second)
                to, calls = goes_long(first, second, at)
                at += 4
            else:
                if unknown(first):
                    raise Failure(f"what the instruction at {at:#x} calls or reserves is not known")
                own += reserves(first)
                to, calls = goes(first, at), False
                at += 2
            # Within the function even BL is but a jump: Armv6-M has none else that reaches far.
            if to is not None and (calls and to == address or not address <= to < end):
                called.add(to)
        return own, called

    def word(self, address):
        return int.from_bytes(self.memory.read(address, 2), "little")


def reserves(word):
    if word & 0xFE00 == 0xB400:  # PUSH
        return 4 * (word & 0x1FF).bit_count()
    if word & 0xFF80 == 0xB080:  # SUB SP
        return 4 * (word & 0x7F)
    return 0


def reserves_long(first, second):
    if first == 0xE92D:  # PUSH
        return 4 * second.bit_count()
    if first == 0xF84D and second & 0x0F00 == 0x0D00:  # STR [SP, -n]!
        return second & 0xFF
    if first in (0xE96D, 0xED2D, 0xED6D):  # STRD [SP, -n]!, VPUSH
        return 4 * (second & 0xFF)
    immediate = (first & 0x400) << 1 | (second & 0x7000) >> 4 | second & 0xFF
    if second & 0x8F00 == 0x0D00 and first & 0xFBFF == 0xF2AD:  # SUBW
        return immediate
    if second & 0x8F00 == 0x0D00 and first & 0xFBFF == 0xF1AD:  # SUB
        return expanded(immediate)
    return 0


def expanded(immediate):
    """Thumb's modified immediate (Armv7-M Architecture Reference Manual, A5.3.2)."""
    low = immediate & 0xFF
    if immediate >> 10 == 0:
        return [low, low << 16 | low, low << 24 | low << 8, low * 0x01010101][immediate >> 8 & 3]
    value, turn = 0x80 | immediate & 0x7F, immediate >> 7
    return (value >> turn | value << (32 - turn)) & 0xFFFF_FFFF


def unknown(word):
    """BLX, BX to another register than LR, and ADD of a register to SP."""
    jumps = word & 0xFF00 == 0x4700 and word != 0x4700 | LR << 3
    return jumps or word & 0xFF87 == 0x4485


def goes(word, at):
    """Where a branch leads to."""
    if word & 0xF800 == 0xE000:
        return at + 4 + signed(word & 0x7FF, 11) * 2
    if word & 0xF000 == 0xD000 and word & 0x0E00 != 0x0E00:
        return at + 4 + signed(word & 0xFF, 8) * 2
    return None


def goes_long(first, second, at):
    """The same, and whether it comes back."""
    if first & 0xF800 != 0xF000 or second & 0x8000 == 0:
        return None, False
    sign, j1, j2 = first >> 10 & 1, second >> 13 & 1, second >> 11 & 1
    if second & 0x1000:  # BL, B
        high = sign << 2 | (1 ^ j1 ^ sign) << 1 | 1 ^ j2 ^ sign
        return at + 4 + signed(high << 21 | (first & 0x3FF) << 11 | second & 0x7FF, 24) * 2, second & 0x4000 != 0
    if first >> 6 & 0xE != 0xE and second & 0x4000 == 0:  # B with a condition
        high = sign << 2 | j2 << 1 | j1
        return at + 4 + signed(high << 17 | (first & 0x3F) << 11 | second & 0x7FF, 20) * 2, False
    return None, False


def signed(value, bits):
    return value - (1 << bits) if value >> (bits - 1) else value
