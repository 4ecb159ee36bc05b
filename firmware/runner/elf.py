"""What is in an image: a 32-bit little-endian ELF file."""

import re
import struct

WRITE, ALLOCATED = 1, 2
SYMBOLS, NO_BITS = 2, 8
# Of a symbol.
FUNCTION = 2
# The last name of a constant, in either of the compiler's ways to write names.
CONSTANT = re.compile(r"\d([A-Z][A-Z_]+)(17h[0-9a-f]{16}E)?$")


def sections(image):
    """Kind, flags, address, contents, size and the number of the section that it refers to, of each."""
    table, = struct.unpack_from("<I", image, 32)
    entry, count = struct.unpack_from("<HH", image, 46)
    for number in range(count):
        kind, flags, address, offset, size, link = struct.unpack_from("<6I", image, table + number * entry + 4)
        yield kind, flags, address, image[offset : offset + size if kind != NO_BITS else offset], size, link


def sizes(path):
    """Text, data and bss in bytes."""
    text = data = bss = 0
    for kind, flags, _, _, size, _ in sections(path.read_bytes()):
        if flags & ALLOCATED and kind == NO_BITS:
            bss += size
        elif flags & ALLOCATED and flags & WRITE:
            data += size
        elif flags & ALLOCATED:
            text += size
    return text, data, bss


def functions(path):
    """Of Arm code: sizes of the functions by address, and where data between instructions begins
    and ends (by the mapping symbols `$t` and `$d` of the Arm ELF specification)."""
    found, marks = {}, {}
    parts = list(sections(path.read_bytes()))
    for kind, _, _, symbols, _, link in parts:
        if kind != SYMBOLS:
            continue
        names = parts[link][3]
        for name, value, size, info, _, _ in struct.iter_unpack("<3I2BH", symbols):
            name = names[name : names.index(b"\0", name)]
            if info & 15 == FUNCTION:
                found[value & ~1] = max(size, found.get(value & ~1, 0))
            elif name[:2] in (b"$t", b"$d"):
                marks[value] = name[:2]
    order = [*sorted(marks), None]
    data = {at: end for at, end in zip(order, order[1:]) if marks[at] == b"$d" and end}
    return found, data


def constants(path):
    """Sizes of the symbols in sections that are loaded and not written to, by their last name."""
    found = {}
    parts = list(sections(path.read_bytes()))
    for kind, _, _, symbols, _, link in parts:
        if kind != SYMBOLS:
            continue
        for name, _, size, _, _, home in struct.iter_unpack("<3I2BH", symbols):
            flags = parts[home][1] if home < len(parts) else 0
            names = parts[link][3]
            name = names[name : names.index(b"\0", name)].decode(errors="replace")
            last = CONSTANT.search(name)
            if last and flags & ALLOCATED and not flags & WRITE:
                found[last[1]] = size
    return found


def address(path, wanted):
    """Where the symbol of this name is; bit 0 tells Thumb code and is cleared."""
    parts = list(sections(path.read_bytes()))
    for kind, _, _, symbols, _, link in parts:
        if kind != SYMBOLS:
            continue
        for name, value, *_ in struct.iter_unpack("<3I2BH", symbols):
            names = parts[link][3]
            if names[name : names.index(b"\0", name)].decode(errors="replace") == wanted:
                return value & ~1
    return None


class Memory:
    """What an image holds before it runs, by address."""

    def __init__(self, path):
        self.parts = []
        for kind, flags, address, contents, _, _ in sections(path.read_bytes()):
            if flags & ALLOCATED and kind != NO_BITS:
                self.parts.append((address, contents))

    def read(self, address, size):
        """Bytes; None outside of the image."""
        for start, contents in self.parts:
            if start <= address and address + size <= start + len(contents):
                return contents[address - start : address - start + size]
        return None


def with_code(path, modules):
    """Those of the core's modules of which code is in the image, inlined or not: debug information
    names every function that left an instruction. (It also names constants, used or not.)"""
    names = re.findall(rb"_[RZ][\w.$]+", path.read_bytes())
    code = b"\n".join(name for name in set(names) if not CONSTANT.search(name.decode()))
    return {module for module in modules if of_core(module).search(code)}


def of_core(module):
    """How a name in the module is written, in either of the compiler's ways."""
    return re.compile(f"6multum{len(module)}{module}|multum\\.\\.{module}\\.\\.".encode())
