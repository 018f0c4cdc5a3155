#!/usr/bin/python3
"""Takes cases through the page of the workbench and through the command: page_cases.py OUTPUT CASE...; each CASE is a
folder with records and model.toml, or drive.toml, which the page identifies first. The verdicts must be the same to the
last digit. Writes the winning panel of each case and one contact sheet of them, sheet.png, to OUTPUT. AXISTOOL names
the program. Exit code 1: a case failed."""

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


def files_of(case: Path) -> tuple[list[str], list[str], str]:
    """Training records, validation records, model; for measured machines from their expected.json."""
    expected = case.parent / "expected.json"
    model = "model.toml" if (case / "model.toml").exists() else "drive.toml"
    if expected.exists() and case.name in (machines := json.loads(expected.read_text())["machines"]):
        return machines[case.name]["train"], machines[case.name].get("validate", []), model
    records = sorted(path.name for path in case.glob("*.csv"))
    return [name for name in records if not JUDGES.search(name)], [name for name in records if JUDGES.search(name)], model


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

    def go(self, case: Path, panel: Path) -> dict:
        """The result of the page, and differences from the command."""
        train, validate, model = files_of(case)
        folder = Path(tempfile.mkdtemp(prefix="axis-case-"))
        for name in [*train, *validate, model]:
            shutil.copy(case / name, folder)
        roles = {**{name: "train" for name in train}, **{name: "judge" for name in validate}}
        (folder / "workbench").mkdir()
        (folder / "workbench/choice.json").write_text(json.dumps({"model": model, "beside": [], "roles": roles}))
        self.open(folder)
        try:
            jobs = 1
            if model == "drive.toml":
                self.until("#choice li")
                if any(kind == "log" for kind in (one["kind"] for one in self.browser.execute_async_script("fetch('/api/folder').then((a) => a.json()).then((a) => arguments[0](a.files))"))):
                    self.browser.get(self.url.split("?")[0] + "#open/" + "/".join([*train, *validate]))
                    self.until("#accept-opening, #choice .role-train", 60)
                    for button in self.browser.find_elements("id", "accept-opening"):
                        button.click()
                self.click("#choice button.small:not(:disabled):not(#swap)")
                state, jobs = self.ended("0001"), 2
                if state["state"] != "done":
                    return {"case": case.name, "problem": state["message"], "page": []}
            self.browser.get(self.url.split("?")[0] + "#effects/find")
            state = self.ended(f"{jobs:04}")
            if state["state"] != "done":
                return {"case": case.name, "problem": state["message"], "page": []}
            self.until("#diagnosis:not(.first-look) .verdict", 60)
            time.sleep(1)
            self.browser.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", {"width": 1280, "height": 2000, "deviceScaleFactor": 1, "mobile": False})
            time.sleep(0.5)
            first = self.browser.find_elements("css selector", "#diagnosis .blocks figure, #diagnosis .verdict")
            figures = [one for one in first if one.tag_name == "figure"]
            (figures or first)[0].screenshot(str(panel))
            found = json.loads((folder / f"workbench/{jobs:04}-diagnose.json").read_text())
            command = state["command"].split(" --json ")[0].replace("axistool", PROGRAM, 1) + " --json -"
            said = json.loads(subprocess.run(command, shell=True, cwd=folder, check=True, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL).stdout)
            problems = [*self.messages(), *(["the command says something else"] if said != found else [])]
            return {"case": case.name, "page": found["verdict"]["effects"], "status": found["verdict"]["status"], "problem": "; ".join(problems)}
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
    output, cases = Path(sys.argv[1]), [Path(name) for name in sys.argv[2:]]
    output.mkdir(parents=True, exist_ok=True)
    results = []
    for case in cases:
        try:
            results.append(Case().go(case, output / (case.name + ".png")))
        except (WebDriverException, TimeoutError, AssertionError) as failure:
            results.append({"case": case.name, "page": [], "problem": f"{type(failure).__name__}: {failure}"[:200]})
        print(results[-1], flush=True)
    (output / "results.json").write_text(json.dumps(results, indent=1) + "\n")
    sheet(output, results)
    return 1 if any(one["problem"] for one in results) else 0


if __name__ == "__main__":
    sys.exit(main())
