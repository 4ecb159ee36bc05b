"""What an image executes between two markers: its blocks of instructions and how often each ran.

QEMU writes a line for each block that it enters, and each block's instructions once, when it
translates it. A block has no branch but at its end, so that its lines tell every instruction and
where each branch went. The lines (tens of millions) go through a pipe and are counted as they
come; two adjacent ones are the unit, for where a block ends is where the next begins.
"""

import fcntl
import os
import subprocess
import threading
import time
from collections import Counter

from . import elf, qemu
from .failure import Failure

BEGIN, END = "frame_begins", "frame_ends"
CHUNK = 1 << 20
SECONDS = 3600


def trace(chip, path, most=None):
    """What the image printed, and for each frame how often a block (the addresses of its
    instructions) went on to an address: a Counter of (addresses, next address). With `most`, of so
    many frames at most: the image is then stopped, and what it printed not complete."""
    markers = [elf.address(path, name) for name in (BEGIN, END)]
    if None in markers:
        raise Failure(f"{chip}: the image has no markers to trace between")
    reader = Reader(*markers, most)
    source, sink = os.pipe()
    fcntl.fcntl(source, fcntl.F_SETPIPE_SZ, CHUNK)
    command = [*qemu.command(chip, path, counted=True), "-d", "in_asm,exec,nochain"]
    command += ["-D", f"/dev/fd/{sink}"]
    child = subprocess.Popen(
        command, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, pass_fds=[sink], text=True
    )
    os.close(sink)
    # Ends the pipe, and so the reading of it.
    watch = threading.Timer(SECONDS, child.kill)
    watch.start()
    try:
        reader.read(source)
        if reader.is_done():
            child.kill()
        printed, _ = child.communicate()
    finally:
        watch.cancel()
        child.kill()
        os.close(source)
    if not reader.is_done():
        qemu.check(chip, child.returncode, printed)
    return printed, reader.frames


class Reader:
    """Counts the lines of a trace."""

    def __init__(self, begin, end, most):
        self.begin, self.end, self.most = begin, end, most
        self.marks = [b"/%08x/" % address for address in (begin, end)]
        # The instructions of a block by its line, and those of the one that is being listed.
        self.blocks = {}
        self.listed = []
        self.last = None
        self.pairs = Counter()
        self.frames = []

    def read(self, source):
        rest = b""
        while not self.is_done() and (chunk := os.read(source, CHUNK)):
            # QEMU writes line by line: to be woken by each would take longer than to count it.
            time.sleep(0.005)
            whole, newline, rest = (rest + chunk).rpartition(b"\n")
            if newline:
                self.lines(whole)
        if not self.is_done() and (rest or self.last is not None):
            raise Failure("the trace ends in the middle of a frame")

    def is_done(self):
        """Whether there are as many frames as were asked for."""
        return self.most is not None and len(self.frames) >= self.most

    def lines(self, text):
        lines = text.split(b"\n")
        special = self.listed or text.startswith(b"0x") or b"\n0x" in text or b"IN:" in text
        if special or any(mark in text for mark in self.marks):
            for line in lines:
                self.line(line)
        elif self.last is not None:
            self.pairs.update(zip([self.last, *lines], lines))
            self.last = lines[-1]

    def line(self, line):
        if line.startswith(b"0x"):
            self.listed.append(int(line[:10], 16))
            return
        if not line.startswith((b"Trace", b"Stopped")):
            return
        address = None
        if line.startswith(b"Trace"):
            if self.listed:
                block, self.listed = tuple(self.listed), []
                if self.blocks.setdefault(line, block) != block:
                    raise Failure("two blocks of a trace have the same name")
            address = block_address(line)
        if self.last is not None:
            self.pairs[self.last, line] += 1
            self.last = line
        if address == self.begin:
            self.last, self.pairs = line, Counter()
        elif address == self.end and self.last is not None:
            self.frames.append(self.edges())
            self.last = None

    def edges(self):
        found = Counter()
        for (block, following), times in self.pairs.items():
            # "Stopped execution before" a block: its time slice was used up. The block's line
            # before it says nothing, the same block's line after it does.
            if block.startswith(b"Trace") and following.startswith(b"Trace"):
                found[self.blocks[block], block_address(following)] += times
        return found


def block_address(line):
    """`Trace 0: host [base/address/flags/flags] symbol`."""
    return int(line.split(b"/", 2)[1], 16)


def executed(edges):
    """The instructions of a frame."""
    return sum(times * len(block) for (block, _), times in edges.items())
