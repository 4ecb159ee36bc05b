"""Runs an image in QEMU."""

import subprocess

from .chips import CHIPS
from .failure import Failure
from .tools import need

SECONDS = 120


def run(chip, path, counted=False):
    """What the image prints. If `counted`, an instruction takes one nanosecond of its time."""
    _, qemu, machine = CHIPS[chip]
    command = [need(qemu), "-M", machine, "-nographic", "-monitor", "none", "-serial", "none"]
    command += ["-semihosting-config", "enable=on,target=native", "-kernel", str(path)]
    if counted:
        command += ["-icount", "shift=0"]
    try:
        done = subprocess.run(
            command, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, timeout=SECONDS, text=True,
            errors="replace",
        )
    except subprocess.TimeoutExpired as expired:
        printed = (expired.stdout or b"").decode(errors="replace")
        raise Failure(f"{chip}: not finished after {SECONDS} s in QEMU{last_line(printed)}")
    if done.returncode != 0:
        raise Failure(f"{chip}: QEMU ended with code {done.returncode}{last_line(done.stdout)}")
    return done.stdout


def last_line(printed):
    lines = printed.strip().splitlines()
    return f"; the image's last line: {lines[-1]}" if lines else "; the image printed nothing"
