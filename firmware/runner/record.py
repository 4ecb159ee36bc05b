"""`benches/on-target.json`: what was counted, of which sources, and with which tools."""

import hashlib
import json

from . import qemu
from .build import FIRMWARE, toolchain
from .chips import BOARDS
from .failure import Failure, note

ROOT = FIRMWARE.parent
PATH = ROOT / "benches/on-target.json"


def digest():
    """SHA-256 of the core's sources: of each, by path, its path, its length and itself."""
    folder = ROOT / "core/src"
    hash = hashlib.sha256()
    names = sorted(path.relative_to(folder).as_posix() for path in folder.rglob("*") if path.is_file())
    if not names:
        raise Failure("the core has no sources")
    for name in names:
        content = (folder / name).read_bytes()
        hash.update(f"{name}\0{len(content)}\0".encode() + content)
    return hash.hexdigest()


def core_modules():
    """The names of the core's modules."""
    names = {path.stem for path in (ROOT / "core/src").iterdir() if path.is_dir() or path.suffix == ".rs"}
    return names - {"lib"}


def tools():
    """What a count depends on."""
    compilers = sorted({toolchain(chip) for chip in BOARDS})
    emulators = sorted({qemu.version(chip) for chip in BOARDS})
    return {
        "toolchain": ", ".join(compilers),
        "qemu": ", ".join(emulators),
        "core_sources_sha256": digest(),
    }


def read():
    """What is recorded, or nothing."""
    return json.loads(PATH.read_text()) if PATH.exists() else {}


def current():
    """Whether what is recorded is of these sources and tools."""
    old = read()
    return all(old.get(key) == value for key, value in tools().items())


def add(**sections):
    """Writes sections down. Those of other sources or tools than the rest's are not."""
    if current():
        write(read() | sections)
    else:
        note(
            f"NOT RECORDED: {PATH.name} is of other sources or tools than these; "
            "do `firmware/run all bench` first"
        )


def write(record):
    """A line for each row, so that a change shows as what it is."""
    lines = []
    for key, value in record.items():
        if isinstance(value, list):
            rows = ",\n".join("    " + json.dumps(row) for row in value)
            lines.append(f"  {json.dumps(key)}: [\n{rows}\n  ]")
        else:
            lines.append(f"  {json.dumps(key)}: {json.dumps(value)}")
    PATH.write_text("{\n" + ",\n".join(lines) + "\n}\n")
