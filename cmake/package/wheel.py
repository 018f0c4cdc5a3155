#!/usr/bin/python3
"""wheel.py WHEEL FOLDER: a self-contained copy of a wheel in FOLDER, with the libraries that its modules load.

By the rules of PEP 600 (manylinux): what every Linux of that glibc has stays outside, all else is copied beside the
package under a name of its own, and the platform's tag is the glibc of the machine that builds. Needs patchelf."""

import hashlib
import os
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

# PEP 600 refers to these as present on every manylinux platform; the loader is named by its path.
PRESENT = {"libc.so.6", "libm.so.6", "libdl.so.2", "librt.so.1", "libpthread.so.0", "libgcc_s.so.1", "libstdc++.so.6"}


def run(*command: object) -> str:
    return subprocess.run([str(part) for part in command], check=True, capture_output=True, text=True).stdout


def loaded_by(module: Path) -> dict[str, Path]:
    """Names and files of all libraries that come with a module, those of its libraries too."""
    found = dict(re.findall(r"^\s*(\S+) => (/\S+)", run("ldd", module), re.MULTILINE))
    return {name: Path(path) for name, path in found.items() if name not in PRESENT}


def needed_by(module: Path) -> list[str]:
    return run("patchelf", "--print-needed", module).split()


def own_name(name: str, path: Path) -> str:
    """The name with a hash of the content: two packages in one process then share a library only if it is the same."""
    stem, _, rest = name.partition(".so")
    return f"{stem}-{hashlib.sha256(path.read_bytes()).hexdigest()[:8]}.so{rest}"


def copyright_of(path: Path) -> tuple[str, Path] | None:
    """Debian's package of a library, and its licence."""
    for name in (path, path.resolve()):
        for spelt in (str(name), "/usr" + str(name), str(name).removeprefix("/usr")):
            told = subprocess.run(["dpkg-query", "-S", spelt], capture_output=True, text=True).stdout
            if told:
                package = told.split(":")[0]
                licence = Path("/usr/share/doc") / package / "copyright"
                return (package, licence) if licence.exists() else None
    return None


def bundle(tree: Path) -> int:
    """Copies the libraries of all modules in an unpacked wheel. Returns how many."""
    libraries: dict[str, Path] = {}
    modules = sorted(tree.rglob("*.so"))
    for module in modules:
        libraries |= loaded_by(module)
    beside = tree / "axistool.libs"
    beside.mkdir()
    names = {name: own_name(name, path) for name, path in libraries.items()}
    licences = next(tree.glob("*.dist-info")) / "licenses"
    licences.mkdir(exist_ok=True)
    for name, path in libraries.items():
        copy = beside / names[name]
        shutil.copyfile(path, copy)
        copy.chmod(0o755)
        run("patchelf", "--set-soname", names[name], "--set-rpath", "$ORIGIN", copy)
        if (licence := copyright_of(path)) is not None:
            shutil.copyfile(licence[1], licences / f"{licence[0]}.txt")
    for file in (*modules, *beside.iterdir()):
        for name in needed_by(file):
            if name in names:
                run("patchelf", "--replace-needed", name, names[name], file)
    for module in modules:
        run("patchelf", "--set-rpath", f"$ORIGIN/{os.path.relpath(beside, module.parent)}", module)
    return len(names)


def main(wheel: Path, folder: Path) -> int:
    glibc = (os.confstr("CS_GNU_LIBC_VERSION") or "").removeprefix("glibc ")
    platform = f"manylinux_{glibc.replace('.', '_')}_{os.uname().machine}"
    folder.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory() as scratch:
        run(sys.executable, "-m", "wheel", "unpack", "--dest", scratch, wheel)
        tree = next(Path(scratch).iterdir())
        count = bundle(tree)
        about = next(tree.glob("*.dist-info")) / "WHEEL"
        about.write_text(re.sub(r"-linux_\w+$", f"-{platform}", about.read_text(), flags=re.MULTILINE))
        run(sys.executable, "-m", "wheel", "pack", "--dest-dir", folder, tree)
    made = next(folder.glob(f"*{platform}.whl"))
    print(f"{made}: {made.stat().st_size / 1e6:.1f} MB, {count} libraries within")
    return 0


if __name__ == "__main__":
    sys.exit(main(Path(sys.argv[1]), Path(sys.argv[2])))
