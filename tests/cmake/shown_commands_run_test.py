#!/usr/bin/python3
"""Every command shown in README, CONTRIBUTING, the examples and `axistool help` runs to its end: in a folder of shipped
records, with a simulated board. Commands that need more are listed with the reason; shown_commands_test.sh checks that
they exist with their options."""

import os
import re
import resource
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

PROJECT = Path(__file__).resolve().parents[2]
PROGRAM = Path(os.environ["AXIS_BUILD"]) / "bin" / "axistool"
CASE = PROJECT / "tests/data/drive-cases/none/case-00"
COGGING = PROJECT / "tests/data/drive-cases/single/case-00"
PAGES = ["README.md", ".github/CONTRIBUTING.md", "host/examples/README.md"]
WORKED_PAGE = PROJECT / "host/examples/from-log-to-model.md"  # its commands follow from each other

NOT_RUN = [
    (r"\bsudo\b|--usb\b", "as root"),
    (r"\b(flash|update)\b|usb:|IMAGE|FILE\.bin", "a board, and an image for it"),
    (r"\baxistool sim\b", "does not end by itself; the board of this test is one"),
    (r"\bserve\b", "does not end by itself; host/workbench's tests run it"),
    (r"…|\b(COMMAND|KIND|MODEL)\b", "has a gap to fill in"),
    (r"emps|EMPS|\.mat\b", "a data set that is not shipped"),
    (r"--trigger|--last", "waits for something to happen to the machine"),
    (r"--map x/mapping.toml|pid.txt", "a log of the reader's own"),
    (r"\.mcap\b", "a bag of the reader's own; host/opening's tests run it"),
    (r"\bbench\b", "ten minutes"),
    (r"\bscoreboard\b", "minutes; make scoreboard"),
    (r"\bpitch screw", "a measured screw and an axis that is disabled; host/device's tests run it"),
    (r"\bcommission\b", "a minute and more; host/commission's tests run it"),
    (r"\bbode\b", "two minutes of motion; host/response's tests run it"),
    (r"\bplan\b|run\.(toml|csv)", "a minute and more; host/plan's tests run it"),
    (r"probe\.ngc", "needs a touch probe; host/axistool's tests run it"),
    (r"axistool circle\b", "needs records of circles; host/axes's tests run it"),
    (r"--response", "needs what bode writes; host/response's tests run it"),
    (r"--gain (current|inertia)", "records with a current, or with an added mass; host/identify's tests run it"),
    (r"backlash\+cogging", "a machine with both effects; host/diagnose's tests run it"),
    (r"\bimprove\b", "a minute; host/python's and host/diagnose's tests run it"),
    (r"--method paper", "longer jogs than those that are shipped; host/identify's tests run it"),
    (r"jittered|scope|angle", "a log of another program; host/record's tests run it"),
    (r"--before-after", "needs what improve writes; host/hil's tests run it"),
    (r"^axistool demo$", "ten seconds; host/demo's tests run it"),
]
# Commands that end with another code than 0.
ENDS = [
    (r"--fail-above", {0, 1}),  # the answer, yes or no
]
# Commands that ask on a terminal get the answer yes. Preceding commands of the operator, such as `axistool enable`, are
# also listed.
ASKS = r"axistool (excite|enable|home|run part.ngc --(?:capture|feed))\b"
BEFORE = [
    (r"axistool (move|run) ", "axistool home x --here --yes && axistool home y --here --yes"),
    (r"axistool (jog|move|capture .*--jog|run|excite x (ladder|multisine))", "axistool enable --yes"),
    (r"^axistool home x$", "axistool set-params x.homing.mode=1 && axistool enable x --yes"),
]
BOARD = r"axistool (jog|move|home|capture|run|excite|set-params|reset-params|restore|save|backup|enable|disable|diff-params)"


def shown() -> list[tuple[str, str]]:
    """Pairs (where, command), without repetition."""
    found: dict[str, str] = {}
    for page in PAGES:
        text = (PROJECT / page).read_text(encoding="utf-8")
        for match in re.finditer(r"^ {4}((?:build/bin/|sudo )?axistool [a-z].*)$|`((?:build/bin/|sudo )?axistool [a-z][^`]*)`",
                                 text, re.M):
            found.setdefault(match.group(1) or match.group(2), page)
    listed = subprocess.run([PROGRAM, "--help"], capture_output=True, text=True, check=True).stdout
    for command in re.findall(r"^  ([a-z][a-z-]+) ", listed, re.M):
        said = subprocess.run([PROGRAM, "help", command], capture_output=True, text=True).stdout.replace("\\\n", "")
        for line in re.findall(r"^  ((?:sudo )?axistool [a-z].*)$", said, re.M):
            found.setdefault(line, f"axistool help {command}")
    return [(where, re.sub(r"^build/bin/|  +[#(].*$", "", line).strip()) for line, where in found.items()]


def is_complete(command: str) -> bool:
    """Whether this only names a command in running text, such as `axistool jog`."""
    words = command.split()
    return len(words) > 2 or words[1] in ("effects", "parameters", "list", "doctor", "faults", "disable", "save", "udev-rule")


class Bench:
    """A folder with what the examples name, and a simulated board for all of them."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.environment = {**os.environ, "PATH": f"{PROGRAM.parent}:{os.environ['PATH']}", "HOME": str(folder),
                            "XDG_RUNTIME_DIR": str(folder), "AXIS_DEVICE": "sim", "AXIS_PATIENCE": "30", "C": str(CASE),
                            "L": "host/examples/log"}
        for needed in ("firmware/core/supervision", "firmware/app/parameters", ".zfunc", ".config/fish/completions",
                       ".local/share/bash-completion/completions"):
            (folder / needed).mkdir(parents=True)
        shutil.copytree(PROJECT / "host/examples/log", folder / "host/examples/log")
        for plant in ("05-own-plant.py", "05-own-plant.toml"):
            shutil.copy(PROJECT / "host/examples" / plant, folder)
        shutil.copy(PROJECT / "host/hil/scenarios/square.toml", folder / "mine.toml")
        (folder / "readings.csv").write_text("x_mm,dial_mm\n0,0\n0.1,0.1\n0.2,0.2\n0.1,0.112\n0,0.012\n", "utf-8")
        (folder / "part.ngc").write_text("G21 G90 G1 F600 X1\nG1 X0\nM2\n", encoding="utf-8")
        self.lay_out("")
        self.must("axistool design x.toml -o stage-params.toml")
        self.board = subprocess.Popen([PROGRAM, "sim", "--forget", "--x", "x.toml", "--y", "x.toml"], cwd=folder,
                                      env=self.environment, stdout=subprocess.PIPE, text=True)
        assert self.board.stdout is not None and self.board.stdout.readline()

    def prepare(self) -> None:
        for axis in "xy":
            self.must(f"axistool set-params stage-params.toml --axis {axis}")
            self.must(f"axistool home {axis} --here --yes")
        self.must("axistool set-params host.timeout=10")  # for a busy computer
        self.must("axistool backup machine.toml")

    def lay_out(self, page: str) -> None:
        """Restores the files that examples name, of a cogging machine, because examples overwrite them."""
        for name in ("x.toml", "x2.toml", "better.toml", "x-drive.toml", "data-sheet.toml"):
            shutil.copy(COGGING / "model.toml", self.folder / name)
        y = re.sub(r'^name = .*', 'name = "y"', (COGGING / "model.toml").read_text(encoding="utf-8"), flags=re.M)
        (self.folder / "y.toml").write_text(y, encoding="utf-8")
        for name in ("steps", "jog", "a", "log", "record", "slow", "fast"):
            shutil.copy(COGGING / "train-jog.csv", self.folder / f"{name}.csv")
        for name in ("validate", "b", "other"):
            shutil.copy(COGGING / "validate.csv", self.folder / f"{name}.csv")
        steps = CASE / "train-steps.csv" if page == "axistool help identify" else COGGING / "train-sweep.csv"
        shutil.copy(steps, self.folder / "steps.csv")
        if page == "axistool help open":  # a motor constant requires a log with current
            for log, name in (("sweep", "steps"), ("jog", "jog")):
                shutil.copy(PROJECT / f"host/examples/log/{log}.csv", self.folder / f"{name}.csv")
        for name in ("x-params.toml", "machine-7.toml"):
            if (self.folder / "machine.toml").exists():
                shutil.copy(self.folder / "machine.toml", self.folder / name)

    def run(self, command: str) -> subprocess.CompletedProcess[str]:
        return subprocess.run(["bash", "-c", command], cwd=self.folder, env=self.environment, timeout=300,
                              stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)

    def must(self, command: str) -> None:
        for _ in range(60):  # an axis that was disabled in motion must first coast to rest
            done = self.run(command)
            if done.returncode == 0 or "it moves" not in done.stdout:
                break
            time.sleep(0.25)
        assert done.returncode == 0, f"{command}: {done.stdout}"

    def end(self) -> None:
        self.board.send_signal(signal.SIGINT)
        self.board.wait()


def try_worked_page(bench: Bench) -> int:
    """Each line of the page's blocks is a command, or a line of the output of the command above it."""
    bad = ran = 0
    said = ""
    for line in re.findall(r"^ {4}(.*)$", WORKED_PAGE.read_text(encoding="utf-8"), re.M):
        if line.startswith("axistool "):
            done = bench.run(line)
            said = " ".join(done.stdout.split())
            ran += 1
            if done.returncode != 0:
                bad += 1
                print(f"{WORKED_PAGE.name}: {line}\nends with {done.returncode}:\n{done.stdout}", flush=True)
        elif not line.startswith("L=") and " ".join(line.split()) not in said:
            bad += 1
            print(f"{WORKED_PAGE.name}: {line}\nis not in what the command says:\n{said}", flush=True)
    return bad if ran > 8 else 1


def try_all(bench: Bench) -> int:
    bad = try_worked_page(bench)
    ran = 0
    page = ""
    for where, command in shown():
        reason = next((why for pattern, why in NOT_RUN if re.search(pattern, command)), None)
        if reason:
            print(f"not run: {command}: {reason}")
        if reason or not is_complete(command):
            continue
        if where != page:
            bench.lay_out(where)
            page = where
        if re.search(BOARD, command):
            bench.run("axistool clear-faults; axistool disable; axistool restore machine.toml --yes")
        for pattern, first in BEFORE:
            if re.search(pattern, command):
                bench.must(first)
        wanted = next((codes for pattern, codes in ENDS if re.search(pattern, command)), {0})
        command = re.sub(rf"({ASKS}[^&]*?)(?: --yes)?( &&|$)", r"\1 --yes\3", command)
        before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
        done = bench.run(command)
        cost_s = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before
        ran += 1
        print(f"{cost_s:6.1f} s  {command}", flush=True)
        if done.returncode not in wanted:
            bad += 1
            print(f"{where}: {command}\nends with {done.returncode}:\n{done.stdout}", flush=True)
    print(f"{ran} commands ran")
    return 1 if bad or ran < 40 else 0


def main() -> int:
    with tempfile.TemporaryDirectory() as folder:
        bench = Bench(Path(folder))
        try:
            bench.prepare()
            return try_all(bench)
        finally:
            bench.end()


if __name__ == "__main__":
    sys.exit(main())
