"""Builds the module axistool._host with the project's CMake, in AXIS_BUILD or in the build folder of `make`."""

import os
import shutil
import subprocess
import sys
import sysconfig
from pathlib import Path

from setuptools import Extension, setup
from setuptools.command.build_ext import build_ext

PROJECT = Path(__file__).resolve().parents[2]
LISTS = [PROJECT / "cmake" / "packages" / name for name in ("build.txt", "python.txt")]


def missing_packages() -> list[str]:
    """Missing Debian packages; on other systems CMake reports missing dependencies."""
    if shutil.which("dpkg-query") is None:
        return []
    wanted = [line.split("#")[0].strip() for one in LISTS for line in one.read_text().splitlines()]
    known = subprocess.run(["dpkg-query", "-W", "-f", "${db:Status-Status} ${Package}\n", *filter(None, wanted)],
                           capture_output=True, text=True).stdout
    return [name for name in wanted if name and f"installed {name}\n" not in known]


class BuildModule(build_ext):
    def build_extension(self, extension: Extension) -> None:
        tree = Path(os.environ.get("AXIS_BUILD") or PROJECT / "build")
        if not (tree / "CMakeCache.txt").exists():
            if not LISTS[0].exists():
                sys.exit(f"axistool: {PROJECT} does not contain the C++ library that this package needs: install from the "
                         "project's own folder host/python, or set AXIS_BUILD to a build tree")
            if missing := missing_packages():
                sys.exit("axistool: Debian packages are missing: sudo apt install " + " ".join(missing))
            subprocess.check_call(["cmake", "-S", PROJECT / "cmake", "-B", tree, "-G", "Ninja", "--log-level=WARNING",
                                   f"-DPython3_EXECUTABLE={sys.executable}"])
        subprocess.check_call(["cmake", "--build", tree, "--target", "axis_python"])
        module = tree / "python" / "axistool" / f"_host{sysconfig.get_config_var('EXT_SUFFIX')}"
        if not module.exists():
            sys.exit(f"axistool: {tree} builds for another Python than {sys.executable}: set AXIS_BUILD to another "
                     "build tree")
        target = Path(self.get_ext_fullpath(extension.name))
        target.parent.mkdir(parents=True, exist_ok=True)
        shutil.copy2(module, target)


setup(ext_modules=[Extension("axistool._host", [])], cmdclass={"build_ext": BuildModule})
