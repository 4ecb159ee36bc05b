"""`benches/on-target.json`: what was counted, of which sources, and with which tools."""

import hashlib
import json

from .build import FIRMWARE
from .failure import Failure

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


def read():
    """What is recorded, or nothing."""
    return json.loads(PATH.read_text()) if PATH.exists() else {}


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
