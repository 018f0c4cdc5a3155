"""A simulated board of its own for a test, with parameters of a shipped drive on its axes."""

import json
import os
import shutil
import subprocess
import tempfile
import unittest
from pathlib import Path

from served_page import PROGRAM  # ends here without a browser
from selenium.webdriver.support.ui import WebDriverWait

MODEL = Path(os.environ["AXIS_TEST_DATA"]) / "drive-cases/none/case-00/model.toml"


class SimulatedBoard(unittest.TestCase):
    def start_board(self, axes: int, host_timeout_s: float, is_fitted: bool = True) -> None:
        self.place = Path(tempfile.mkdtemp(prefix="axis-board-"))
        self.addCleanup(shutil.rmtree, self.place, True)
        self.own = self.place / "own"
        self.own.mkdir(0o700)
        os.environ["XDG_RUNTIME_DIR"] = str(self.own)
        self.board = subprocess.Popen([PROGRAM, "sim", "--axes", str(axes), "--forget"], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        self.addCleanup(self.board.wait, 30)
        self.addCleanup(self.board.terminate)
        WebDriverWait(None, 30).until(lambda _: (self.own / "axis-sim.socket").exists())
        if not is_fitted:
            return
        self.parameters = self.place / "x.toml"
        self.tool("design", str(MODEL), "-o", str(self.parameters))
        for axis in "xyza"[:axes]:
            self.tool("set-params", str(self.parameters), "--axis", axis, f"host.timeout={host_timeout_s}", "--device", "sim")

    def tool(self, *words: str) -> str:
        return subprocess.run([PROGRAM, *words], check=True, stdout=subprocess.PIPE, text=True).stdout

    def axis(self, number: int = 0) -> dict:
        return json.loads(self.tool("status", "--device", "sim", "--json", "-"))["axes"][number]

    def at_mm(self) -> float:
        return self.axis()["position"]
