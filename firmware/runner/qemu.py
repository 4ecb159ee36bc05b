"""Runs an image in QEMU."""

import subprocess

from .chips import CHIPS
from .failure import Failure
from .tools import need, output

SECONDS = 300


def command(chip, path, counted):
    """What starts QEMU. If `counted`, an instruction takes one nanosecond of its time."""
    _, qemu, machine, options, *_ = CHIPS[chip]
    words = [need(qemu), "-M", machine, *options, "-nographic", "-monitor", "none", "-serial", "none"]
    words += ["-semihosting-config", "enable=on,target=native", "-kernel", str(path)]
    return [*words, "-icount", "shift=0"] if counted else words


def run(chip, path, counted=False):
    """What the image prints."""
    try:
        done = subprocess.run(
            command(chip, path, counted), stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
            timeout=SECONDS, text=True, errors="replace",
        )
    except subprocess.TimeoutExpired as expired:
        printed = (expired.stdout or b"").decode(errors="replace")
        raise Failure(f"{chip}: not finished after {SECONDS} s in QEMU{last_line(printed)}")
    check(chip, done.returncode, done.stdout)
    return done.stdout


def check(chip, code, printed):
    if code != 0:
        raise Failure(f"{chip}: QEMU ended with code {code}{last_line(printed)}")


def version(chip):
    """QEMU's own words."""
    said = output([need(CHIPS[chip].qemu), "--version"])
    if not said:
        raise Failure("QEMU does not say its version")
    return said.splitlines()[0]


def last_line(printed):
    lines = printed.strip().splitlines()
    return f"; the image's last line: {lines[-1]}" if lines else "; the image printed nothing"
