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
INSTRUCTION = re.compile(r"^\s*([0-9a-f]+):\s(?:[0-9a-f]{2,8} )+\s*(\S.*)$")
TO_ADDRESS = re.compile(r"^(b\w*(?:\.[wn])?|cbn?z)\s+(.*?)(?:#|0x)[-0-9a-fx]+(?:\s+<.*>)?$")
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

    def ratio(self, edges):
        """Cycles by instructions of a frame, from (addresses, next address) and how often."""
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
        return sum(weight[block] / len(block) * self.cycles[block] for block in chosen) / held

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
            raise Failure(f"llvm-mca refuses a block: {done.stderr.strip()[:300]}")
        for number, times, cycles in REGION.findall(done.stdout):
            self.cycles[blocks[int(number)]] = int(cycles) / int(times)
        if missing := [block for block in blocks if block not in self.cycles]:
            raise Failure(f"llvm-mca says nothing of {len(missing)} blocks; the first is at {missing[0][0]:#x}")

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
    for line in listing.splitlines():
        place, colon, text = line.partition(":")
        text = re.sub(r"\s*[@;].*| *<.*>$", "", text).strip().replace("\t", " ")
        if colon and text and re.fullmatch(r"\s*[0-9a-f]+", place):
            # Where a branch goes is the trace's business.
            found[int(place, 16)] = TO_ADDRESS.sub(r"\1 \2elsewhere", text)
    return found
