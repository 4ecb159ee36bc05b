"""Which instructions a frame executes, and how often each: where the counts of `bench` come from."""

import re
from collections import Counter

from .build import build
from .counts import PIXELS, rows
from .failure import Failure, note
from .qemu import run
from .tools import need, output
from .trace import executed, trace

# What a frame's counter and its markers may differ by, see `cycles`.
TOLERANCE = 500
# Instructions that run less often than this in a unit, a pixel or a triangle, are left out.
LEAST = 0.05
# What Rust's symbols have for signs.
SIGNS = {"_$LT$": "<", "$LT$": "<", "$GT$": ">", "$C$": ", ", "$u20$": " ", "$RF$": "&", "$u5b$": "[", "$u5d$": "]"}
SIGNS |= {"$u3b$": ";", "$u7b$": "{", "$u7d$": "}", "..": "::"}


def listing(chip, image, name):
    """Prints the instructions of the frame with this name (scene strategy filter depth format)."""
    path = build(chip, image)
    drawn = rows(chip, run(chip, path, counted=True))
    names = [row.name for row in drawn]
    if name not in names:
        raise Failure(f"{image} draws no `{name}`; it draws:\n  " + "\n  ".join(names))
    number = names.index(name)
    note(f"{chip}: tracing {number + 1} frames, which takes minutes")
    _, frames = trace(chip, path, number + 1)
    if len(frames) <= number:
        raise Failure(f"{chip} {image}: this line is not of a frame that is traced")
    edges, row = frames[number], drawn[number]
    total = executed(edges)
    if abs(total - row.instructions_per_pixel * PIXELS) > TOLERANCE:
        raise Failure(f"{chip}: {total} instructions traced, but counted {row}")
    units = PIXELS
    unit = "pixel"
    if row.scene == "mesh":
        units, unit = total / row.instructions_per_triangle, "triangle"
    show(row, unit, functions(path), times(edges), units)


def times(edges):
    """How often each address was executed."""
    found = Counter()
    for (block, _), count in edges.items():
        for address in block:
            found[address] += count
    return found


def functions(path):
    """The name and the instructions, by address, of each function of an image."""
    text = output([need("llvm-objdump"), "-d", "-C", "--no-show-raw-insn", str(path)])
    if not text:
        raise Failure("llvm-objdump prints nothing")
    found = []
    for line in text.splitlines():
        if head := re.fullmatch(r"[0-9a-f]+ <(.*)>:", line):
            found.append((readable(head[1]), {}))
        elif found and (instruction := re.fullmatch(r"\s*([0-9a-f]+):\s+(\S.*)", line)):
            # Where a branch goes is told by its address; the rest of the line names the function.
            text = re.sub(r"\s*<[^@]*>|\s*@.*", "", instruction[2])
            found[-1][1][int(instruction[1], 16)] = text.strip().replace("\t", " ")
    return found


def readable(symbol):
    """A function's name as the source has it, nearly."""
    symbol = re.sub(r"::h[0-9a-f]{16}$", "", symbol)
    for mark, sign in SIGNS.items():
        symbol = symbol.replace(mark, sign)
    return symbol


def show(row, unit, found, executions, units):
    """The functions, those that execute most first, with their instructions in order."""
    print(f"{row.core} {row.name}: {executions.total() / units:.2f} instructions a {unit}")
    print(f"(those of less than {LEAST} are not shown, but are in the sums)")
    shares = [(sum(executions[address] for address in lines), name, lines) for name, lines in found]
    known = sum(share for share, _, _ in shares)
    if known != executions.total():
        raise Failure(f"llvm-objdump does not show {executions.total() - known} executed instructions")
    for share, name, lines in sorted(shares, key=lambda each: -each[0]):
        if share < LEAST * units:
            break
        print(f"\n{share / units:9.2f}  {name}")
        left_out = False
        for address, text in lines.items():
            often = executions[address] / units
            if often < LEAST:
                left_out = True
                continue
            if left_out:
                print(f"{'...':>9}")
                left_out = False
            print(f"{often:9.3f}  {address:x}  {text}")
