"""Builds an image: with the target that rustup installs, or from Debian's library source."""

import os
import shutil
import subprocess
from pathlib import Path

from . import elf
from .chips import CHIPS
from .failure import Failure, note
from .tools import need, output

FIRMWARE = Path(__file__).resolve().parent.parent
WRAPPER = FIRMWARE / "runner/rustc_wrapper.py"


def build(chip, image):
    """The path of a fresh image."""
    return build_all(chip, [image])[image]


def build_all(chip, images, profile="release"):
    """The paths of fresh images, by name, built with a profile of Cargo.toml."""
    target, flags = CHIPS[chip].target, CHIPS[chip].compiler_flags
    # Found missing after a long build, it would be a nuisance.
    need_tools(chip)
    environment = dict(os.environ)
    environment.update(RUSTC_WRAPPER=str(WRAPPER), MULTUM_ROOT=str(FIRMWARE.parent))
    folder = target_folder()
    command = ["build", "--profile", profile, "--locked", "--package", "images"]
    command += [word for image in images for word in ("--bin", image)]
    command += ["--features", chip, "--target", target]
    if flags:
        # For the target's code only: with --target cargo leaves the host's alone.
        environment["RUSTFLAGS"] = f"{environment.get('RUSTFLAGS', '')} {flags}".strip()
    names = f"{chip} {' '.join(images)}" + ("" if profile == "release" else f", profile {profile}")
    if has_target(target):
        note(f"{names}: building for {target} with rustup's target")
        command = [need("cargo"), *command]
    else:
        note(f"{names}: building for {target} from library source (no rustup target)")
        cargo, rustc, linker = source_tools(target)
        linker_variable = f"CARGO_TARGET_{target.upper().replace('-', '_').replace('.', '_')}_LINKER"
        environment.update(RUSTC=rustc, RUSTC_BOOTSTRAP="1")
        environment[linker_variable] = linker
        command = [cargo, *command, "-Zbuild-std=core"]
        folder = folder / "from-source"
    command += ["--target-dir", str(folder)]
    if subprocess.run(command, cwd=FIRMWARE, env=environment).returncode != 0:
        raise Failure(f"{names}: the build failed; the compiler's message is above")
    kept = {}
    for image in images:
        # One target folder serves all chips of a target: keep this chip's image under its own name.
        kept[image] = folder / (f"{chip}-{image}" + ("" if profile == "release" else f"-{profile}") + ".elf")
        shutil.copyfile(folder / target / profile / image, kept[image])
        text, data, bss = elf.sizes(kept[image])
        note(f"{chip} {image}: text {text}, data {data}, bss {bss} bytes ({kept[image]})")
    return kept


def need_tools(chip):
    """Fails if what builds or runs the chip's images is missing."""
    need(CHIPS[chip].qemu)
    if not has_target(CHIPS[chip].target):
        source_tools(CHIPS[chip].target)


def toolchain(chip):
    """The compiler that the chip's images are built with, as it names itself."""
    rustup = has_target(CHIPS[chip].target)
    name = output(["rustc" if rustup else source_tools(CHIPS[chip].target)[1], "-V"])
    if not name:
        raise Failure("the compiler does not say its version")
    return name


def target_folder():
    return Path(os.environ.get("CARGO_TARGET_DIR", FIRMWARE / "target")).resolve()


def has_target(target):
    """Whether the compiler on the path has the target's core library."""
    if not shutil.which("cargo") or not shutil.which("rustc"):
        return False
    folder = output(["rustc", "--print", "target-libdir", "--target", target])
    return folder is not None and any(Path(folder).glob("libcore-*"))


def source_tools(target):
    """Debian's cargo and rustc with library source, and a linker."""
    packages = f"`apt-get install cargo-web rustc-web rust-web-src`, or `rustup target add {target}`"
    cargo, rustc = "/usr/bin/cargo", "/usr/bin/rustc"
    for tool in (cargo, rustc):
        if not os.access(tool, os.X_OK):
            raise Failure(f"nothing to build {target} with: no {tool}; do {packages}")
    root = output([rustc, "--print", "sysroot"])
    if root is None or not (Path(root) / "lib/rustlib/src/rust/library/core").is_dir():
        raise Failure(f"nothing to build {target} with: {rustc} has no library source; do {packages}")
    # The linker that rustup's toolchain ships, or LLVM's own.
    bundled = output(["rustc", "--print", "sysroot"]) if shutil.which("rustc") else None
    candidates = sorted(Path(bundled).glob("lib/rustlib/*/bin/rust-lld")) if bundled else []
    candidates += [path for path in map(shutil.which, ("rust-lld", "ld.lld")) if path]
    if not candidates:
        raise Failure(f"no linker for {target}: do `apt-get install lld`, or `rustup target add {target}`")
    return cargo, rustc, str(candidates[0])
