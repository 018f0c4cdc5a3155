#!/usr/bin/python3
"""Commissions an axis of a simulated board by the workbench in a real browser: the run is a job with progress; the space
bar, a page that is left and Cancel stop the axis; the run continues at the step that it had reached. AXIS_COMMISSION=1
lets it run to its end, some minutes, and checks the result; AXIS_SCREENSHOTS names a folder for screenshots."""

import json
import os
import time
import unittest

from served_page import ServedPage  # ends here without a browser
from selenium.webdriver.common.by import By
from selenium.webdriver.support.ui import WebDriverWait
from simulated_board import SimulatedBoard

BOX = {"Travel": "100", "Speed": "200", "Command": "4", "Motion": "360"}


class Commission(ServedPage, SimulatedBoard):
    def setUp(self) -> None:
        self.start_board(1, 1, is_fitted=False)
        served = self.place / "served"
        served.mkdir()
        (served / "x-drive.toml").write_text(self.tool("sim", "--print-drive", "x"))
        self.open(served, "--sim")
        self.addCleanup(self.close)
        self.show()

    def show(self) -> None:
        self.browser.get(self.url.split("?")[0] + "#live")
        self.until("canvas.scope")

    def keep(self, name: str) -> None:
        if folder := os.environ.get("AXIS_SCREENSHOTS"):
            self.browser.execute_script("document.getElementById('commission').scrollIntoView()")
            time.sleep(0.3)
            self.browser.save_screenshot(f"{folder}/{name}.png")

    def soon(self, holds, what: str, patience_s: float = 60) -> None:
        WebDriverWait(None, patience_s, 0.05).until(lambda _: holds(), what)

    def press(self, button: str) -> None:
        """Takes the command if this page does not have it: one without processor time for half a second has lost it."""
        def pressed() -> bool:
            for name in ("claim", button):
                self.browser.execute_script("const button = document.getElementById(arguments[0]); if (button?.offsetParent && !button.disabled) button.click();", name)
                time.sleep(0.2)
            return self.job()["state"] in ("queued", "running")

        self.soon(pressed, f"{button} starts a job")

    def job(self) -> dict:
        jobs = sorted((self.folder / "workbench").glob("*.job.json"))
        return json.loads(jobs[-1].read_text()) if jobs else {"state": "none"}

    def ended(self, patience_s: float = 60) -> dict:
        self.soon(lambda: self.job()["state"] not in ("queued", "running"), "the job has ended", patience_s)
        return self.job()

    def moves(self) -> None:
        start = self.axis()["counts"]  # an axis has no position in mm before it is fitted

        def is_moving() -> bool:
            self.assertIn(self.job()["state"], ("queued", "running"), self.job())
            return abs(self.axis()["counts"] - start) > 200

        self.soon(is_moving, "the axis moves")

    def stands(self) -> None:
        def rests() -> bool:
            before = self.axis()["counts"]
            time.sleep(0.5)
            return abs(self.axis()["counts"] - before) < 50 and self.axis()["state"] not in ("enabled", "starting", "stopping")

        self.soon(rests, "the axis stands, and its loop is open", 5)

    def start(self) -> None:
        self.click("#commission summary")
        self.assertFalse(self.browser.find_element(By.ID, "commission-start").is_enabled(), "not without a box and the command")
        for name, value in BOX.items():
            place = self.until(f"#commission input[aria-label='{name}']")
            place.clear()
            place.send_keys(value)
        self.press("commission-start")

    def test_stops_and_continues(self) -> None:
        self.start()
        self.moves()
        self.assertIn("axistool commission x --drive x-drive.toml --box travel=100mm,speed=200mm/s,volts=4V,time=360s -o x", self.job()["command"])
        self.assertNotIn("owner", json.dumps(self.job()), "the key of the page is not stored")
        self.assertEqual(self.browser.execute_async_script(
            "fetch('/api/jobs', { method: 'POST', body: JSON.stringify({ do: 'commission', model: 'x-drive.toml', axis: 'x', box: 'travel=1,speed=1,volts=1,time=1' }) }).then((answer) => arguments[0](answer.status))"),
            422, "only with the command")
        self.messages()  # the browser reports that refusal
        self.keep("commission-runs")
        self.browser.find_element(By.TAG_NAME, "body").send_keys(" ")
        self.stands()
        stopped = self.ended()
        self.assertEqual(stopped["state"], "failed", stopped)
        self.assertIn(stopped["next"], ("look", "identify"))

        self.press("commission-continue")
        self.moves()
        self.browser.get("about:blank")
        self.stands()
        left = self.ended()
        self.assertEqual((left["state"], left["request"]["from"], left["request"]["folder"]), ("failed", stopped["next"], "x"))

        self.show()
        self.press("commission-continue")
        self.moves()
        self.click(".progress button")
        self.assertEqual(self.ended()["state"], "cancelled")
        self.stands()
        if os.environ.get("AXIS_COMMISSION"):
            began = time.monotonic()
            while self.job().get("next") != "" or self.job()["state"] != "done":
                self.press("commission-continue")
                state = self.ended(900)
                print(f"commission: {state['state']} after {time.monotonic() - began:.0f} s {state['message']}", flush=True)
                self.assertLess(time.monotonic() - began, 1200)
            done = self.job()
            self.assertEqual(done["report"], "x/page.html")
            self.assertEqual(json.loads((self.folder / "x/commission.json").read_text()), json.loads((self.folder / f"workbench/{done['id']:04}-commission.json").read_text()))
            self.until("#commission-page")
            self.keep("commission-done")
        self.assertEqual(self.messages(), [])


if __name__ == "__main__":
    unittest.main()
