#!/usr/bin/python3
"""Takes machines through the page of the workbench and through the command: page_cases_test.py [CASE...]; each CASE is a
folder with records and model.toml, or with logs and drive.toml: these are dropped on the page, which opens them and
identifies the model. The results must be the same to the last digit, without a console message. Without a CASE: a few
machines, or all if AXIS_ALL_MACHINES is set. AXIS_SCREENSHOTS names a folder for the winning panel of each machine and
one contact sheet of them, sheet.png. Exit code 1: a case failed; 77: a data set is missing."""

import html
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from served_page import PROGRAM, ServedPage  # ends here without a browser
from selenium.common.exceptions import WebDriverException

JUDGES = re.compile("valid|judge|held|test|check")
LONGEST_S = 900
SHARED = Path(os.environ.get("AXIS_SHARED_DIR", Path(__file__).resolve().parents[4] / "shared")) / "data"
FEW = [Path(__file__).resolve().parents[2] / "data/drive-cases/single/case-00", SHARED / "real/arm-axis2", SHARED / "real-2/leadscrew-1"]
ALL = ("drive-cases/single", "controller-logs", "real", "real-2")
# Measured machines whose names of records do not say which are for validation: training, validation.
SPLITS = {
    "feed-drive-flex": (["square-1.5V.csv", "square-2V.csv", "sine-1Hz.csv", "sine-3Hz.csv"], ["sine-2Hz.csv", "sine-2.5Hz.csv", "sine-4Hz.csv"]),
    "pendulum-ak80": (["ddp.csv"], ["direct-collocation.csv"]),
    "bldc-cogging-2": (["speed-6.3-run2-a.csv", "speed-6.3-run2-b.csv"], ["speed-6.3-old-a.csv", "speed-6.3-old-b.csv"]),
}
LONG_RUNS_BELOW = {"arm-axis1": 1.2}  # rad/s; the faster runs are too short


def files_of(case: Path) -> tuple[list[str], list[str], str]:
    """Training records, validation records, model. Of runs at constant speeds, every second one is for validation."""
    expected = case.parent / "expected.json"
    model = "model.toml" if (case / "model.toml").exists() else "drive.toml"
    if expected.exists() and case.name in (machines := json.loads(expected.read_text())["machines"]):
        return machines[case.name]["train"], machines[case.name].get("validate", []), model
    if case.name in SPLITS:
        return *SPLITS[case.name], model
    if runs := sorted(path.name for path in case.glob("const-*.csv")):
        below = LONG_RUNS_BELOW.get(case.name)
        runs = [name for name in runs if below is None or float(name[7:12]) < below]
        return runs[::2], runs[1::2], model
    records = sorted(path.name for path in case.glob("*.csv"))
    return [name for name in records if not JUDGES.search(name)], [name for name in records if JUDGES.search(name)], model


def label_of(case: Path) -> str:
    return case.parent.name + "-" + case.name


def chosen_cases() -> list[Path]:
    if sys.argv[1:]:
        return [Path(name) for name in sys.argv[1:]]
    if not os.environ.get("AXIS_ALL_MACHINES"):
        return FEW
    return [case for name in ALL for case in (sorted((SHARED / name).glob("*/")) if (SHARED / name).is_dir() else [SHARED / name])]


class Case(ServedPage):
    def ended(self, name: str) -> dict:
        """The state of a job, once it has ended."""
        until, path = time.monotonic() + LONGEST_S, self.folder / f"workbench/{name}.job.json"
        while time.monotonic() < until:
            state = json.loads(path.read_text()) if path.exists() else {"state": "queued"}
            if state["state"] not in ("queued", "running"):
                return state
            time.sleep(0.2)
        raise TimeoutError(f"{name} takes longer than {LONGEST_S} s")

    def records_chosen(self, case: Path, folder: Path) -> None:
        """Records and a model that are in the folder already, with the roles that they have elsewhere."""
        train, validate, model = files_of(case)
        for name in [*train, *validate, model]:
            shutil.copy(case / name, folder)
        roles = {**{name: "train" for name in train}, **{name: "judge" for name in validate}}
        (folder / "workbench").mkdir()
        (folder / "workbench/choice.json").write_text(json.dumps({"model": model, "beside": [], "roles": roles}))
        self.open(folder)
        self.until("#choice .role-train")

    def logs_dropped(self, case: Path, folder: Path) -> None:
        """Drops logs and data sheet on the page of an empty folder and clicks on to a model."""
        train, validate, sheet = files_of(case)
        self.open(folder)
        self.until("#content .lead")
        self.drop(*(case / name for name in [sheet, *train, *validate]))
        self.until("#accept-opening, #choice .role-train", 60)
        for button in self.browser.find_elements("id", "accept-opening"):
            button.click()
        self.until("#choice .role-train", 60)
        self.click("#identify")
        if (state := self.ended("0001"))["state"] != "done":
            raise AssertionError(state["message"])
        self.until("#choice input[name=model]:checked", 60)

    def go(self, case: Path, panel: Path) -> dict:
        """The result of the page, and differences from the command."""
        folder = Path(tempfile.mkdtemp(prefix="axis-case-"))
        has_logs, began = not (case / "model.toml").exists(), time.monotonic()
        job = "0002" if has_logs else "0001"
        try:
            (self.logs_dropped if has_logs else self.records_chosen)(case, folder)
            self.browser.get(self.url.split("?")[0] + "#effects/find")
            if (state := self.ended(job))["state"] != "done":
                raise AssertionError(state["message"])
            self.until("#diagnosis:not(.first-look) .verdict", 60)
            self.browser.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", {"width": 1280, "height": 2000, "deviceScaleFactor": 1, "mobile": False})
            time.sleep(1.5)
            first = self.browser.find_elements("css selector", "#diagnosis .blocks figure") or self.browser.find_elements("css selector", "#diagnosis .verdict")
            first[0].screenshot(str(panel))
            found = json.loads((folder / f"workbench/{job}-diagnose.json").read_text())
            shown = self.texts("#cards .card .bar .value")
            seconds = time.monotonic() - began
            command = state["command"].split(" --json ")[0].replace("axistool", PROGRAM, 1) + " --json -"
            said = json.loads(subprocess.run(command, shell=True, cwd=folder, check=True, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL).stdout)
            problems = [*self.messages(), *(["the command says something else"] if said != found else [])]
            return {"case": label_of(case), "page": found["verdict"]["effects"], "status": found["verdict"]["status"], "odds": shown[:3], "seconds": round(seconds, 1), "problem": "; ".join(problems)}
        finally:
            self.close()
            shutil.rmtree(folder)


def sheet(output: Path, results: list[dict]) -> None:
    """One picture of all panels."""
    cells = [f'<figure><figcaption>{html.escape(one["case"])}: {html.escape(", ".join(one["page"]) or one.get("status", ""))} {html.escape(one["problem"])}</figcaption>'
             + (f'<img src="{one["case"]}.png">' if (output / (one["case"] + ".png")).exists() else "") + "</figure>" for one in results]
    page = output / "sheet.html"
    page.write_text("<style>body{display:grid;grid-template-columns:repeat(3,1fr);gap:8px;margin:8px;font:14px sans-serif}figure{margin:0}img{width:100%}</style>" + "".join(cells))
    height = 8 + 430 * -(-len(results) // 3)
    subprocess.run(["chromium", "--headless=new", "--no-sandbox", "--disable-gpu", f"--window-size=1700,{height}", f"--screenshot={output / 'sheet.png'}", page.as_uri()],
                   check=True, stderr=subprocess.DEVNULL)


def main() -> int:
    cases = chosen_cases()
    missing = [case for case in cases if not case.is_dir()]
    output = Path(os.environ.get("AXIS_SCREENSHOTS") or tempfile.mkdtemp(prefix="axis-panels-"))
    output.mkdir(parents=True, exist_ok=True)
    results = []
    for case in (case for case in cases if case not in missing):
        try:
            results.append(Case().go(case, output / (label_of(case) + ".png")))
        except (WebDriverException, TimeoutError, AssertionError) as failure:
            results.append({"case": label_of(case), "page": [], "problem": f"{type(failure).__name__}: {failure}"[:200]})
        print(results[-1], flush=True)
    if os.environ.get("AXIS_SCREENSHOTS"):
        (output / "results.json").write_text(json.dumps(results, indent=1) + "\n")
        sheet(output, results)
    else:
        shutil.rmtree(output)
    for case in missing:
        print(f"{case}: not there, so it was not taken through the page", file=sys.stderr)
    return 1 if any(one["problem"] for one in results) else 77 if missing else 0


if __name__ == "__main__":
    sys.exit(main())
