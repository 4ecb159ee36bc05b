"""Estimates cycles of a Cortex-M4 or M7 with llvm-mca, from the blocks that run most.

llvm-mca knows how a core issues instructions and when results are ready. It runs each block as if
it followed itself; it knows no wait states, no caches and not what a taken branch costs.
"""

import re
import subprocess
from collections import Counter

from .chips import CHIPS
from .failure import Failure
from .tools import need, output

CORES = {"m4": "cortex-m4", "m7": "cortex-m7"}
# Of the executed instructions, how many the chosen blocks must hold; the rest has their ratio.
SHARE = 0.95
CONDITIONS = "eq|ne|hs|cs|lo|cc|mi|pl|vs|vc|hi|ls|ge|lt|gt|le"
# Branches that name an address, and calls: llvm-mca would take a hundred cycles for each.
TO_ADDRESS = re.compile(rf"^(b(?:{CONDITIONS})?(?:\.[wn])?|cbn?z r\d+,)\s*0x[0-9a-f]+$")
CALL = re.compile(r"^blx?(?:\.w)? \S+$")
REGION = re.compile(r"Code Region - (\d+)\n.*?Iterations:\s+(\d+)\n.*?Total Cycles:\s+(\d+)", re.S)


def version():
    """llvm-mca's own words."""
    found = re.search(r"LLVM version \S+", output([need("llvm-mca"), "--version"]) or "")
    if not found:
        raise Failure("llvm-mca does not say its version")
    return found[0]


class Estimate:
    """Estimates for one image."""

    def __init__(self, chip, path):
        self.chip = chip
        self.text = disassembled(path)
        self.cycles = {}

    def cycles_of(self, edges):
        """Of what ran: a block (the addresses of its instructions), where it went on, how often."""
        weight = Counter()
        for (block, _), times in edges.items():
            weight[block] += times * len(block)
        chosen, held, total = [], 0, weight.total()
        for block, instructions in weight.most_common():
            chosen.append(block)
            held += instructions
            if held >= SHARE * total:
                break
        self.learn([block for block in chosen if block not in self.cycles])
        cycles = sum(weight[block] / len(block) * self.cycles[block] for block in chosen)
        return cycles * total / held

    def learn(self, blocks):
        """Cycles of one run of each block."""
        if not blocks:
            return
        source = []
        for number, block in enumerate(blocks):
            source += [f"# LLVM-MCA-BEGIN {number}", *map(self.line, block), "# LLVM-MCA-END"]
        command = [need("llvm-mca"), f"-mcpu={CORES[self.chip]}", f"-mtriple={CHIPS[self.chip].target}"]
        command += ["-iterations=100", "-instruction-info=false", "-resource-pressure=false"]
        done = subprocess.run(
            command, input="\n".join(source) + "\n", stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
        )
        if done.returncode != 0:
            raise Failure(f"llvm-mca refuses a block: {done.stderr.strip()[-300:]}")
        for number, times, cycles in REGION.findall(done.stdout):
            self.cycles[blocks[int(number)]] = int(cycles) / int(times)
        for block in blocks:
            if block not in self.cycles:
                raise Failure(f"llvm-mca says nothing of the block at {block[0]:#x}")

    def line(self, address):
        if address not in self.text:
            raise Failure(f"llvm-objdump shows no instruction at {address:#x}")
        return self.text[address]


def disassembled(path):
    """Instructions by address, as an assembler takes them."""
    listing = output([need("llvm-objdump"), "-d", "--no-show-raw-insn", str(path)])
    if not listing:
        raise Failure("llvm-objdump prints nothing")
    found = {}
    conditional = 0
    for line in listing.splitlines():
        place, colon, text = line.partition(":")
        if not colon or not re.fullmatch(r"\s*[0-9a-f]+", place):
            continue
        text = re.sub(r"\s*<[^@]*>", "", re.sub(r"\s*@.*", "", text)).strip().replace("\t", " ")
        if block := re.fullmatch(r"it([te]*) \w+", text):
            # llvm-mca's M7 does not know this one, which takes a place and does nothing; without it
            # an assembler takes what follows as if it had no condition.
            conditional, text = 1 + len(block[1]), "nop"
        elif conditional:
            conditional -= 1
            text = re.sub(rf"^(\w+?)(?:{CONDITIONS})((?:\.\w+)?)(?= )", r"\1\2", text)
        # Where a branch goes is the trace's business.
        found[int(place, 16)] = CALL.sub("b elsewhere", TO_ADDRESS.sub(r"\1 elsewhere", text))
    return found
