#!/usr/bin/python3
"""A program on the simulated board waits at its stops (M0, M1), and the workbench in a real browser shows where. It goes
on by the page's key and by its button; nothing else of the page, and no notice of a program that was killed, moves an
axis."""

import os
import pty
import signal
import time
import unittest
from pathlib import Path

from served_page import PROGRAM, ServedPage  # ends here without a browser
from selenium.webdriver.common.by import By
from selenium.webdriver.common.keys import Keys
from selenium.webdriver.support.ui import WebDriverWait
from simulated_board import SimulatedBoard

PART = "G21 G90\nG1 F1200 X5\nM0\nX10\nM1\nX15\nM2\n"


class Operator:
    """A program that runs on a terminal of its own."""

    def __init__(self, part: Path) -> None:
        self.child, self.terminal = pty.fork()
        if self.child == 0:
            os.execv(PROGRAM, [PROGRAM, "run", str(part), "--here", "--yes", "--device", "sim"])

    def status(self) -> int | None:
        """The exit status, once it has ended; reads its output meanwhile, so that it never waits for that."""
        ended, status = os.waitpid(self.child, os.WNOHANG)
        try:
            if not ended and os.get_blocking(self.terminal):
                os.set_blocking(self.terminal, False)
            os.read(self.terminal, 65536)
        except OSError:  # nothing to read, or the terminal is closed
            pass
        return os.waitstatus_to_exitcode(status) if ended else None


class WaitingProgram(ServedPage, SimulatedBoard):
    def setUp(self) -> None:
        self.start_board(1, 5)  # a long time-out, so that a loaded computer does not look like a lost host
        self.part = self.place / "part.ngc"
        self.part.write_text(PART)
        served = self.place / "served"
        served.mkdir()
        self.open(served)
        self.addCleanup(self.close)

    def waits_in(self, line: int) -> None:
        WebDriverWait(self.browser, 60, 0.1).until(lambda _: any(f"in line {line}." in text for text in self.texts("#stops h2")), f"line {line}")

    def ends(self, run: Operator) -> int:
        status: list[int | None] = []
        WebDriverWait(None, 60, 0.05).until(lambda _: status.append(run.status()) or status[-1] is not None)
        return status[-1]

    def nobody_waits(self) -> None:
        WebDriverWait(self.browser, 30, 0.1).until(lambda _: not self.browser.find_elements(By.CSS_SELECTOR, "#stops section"))

    def test_goes_on_by_key_and_by_button(self) -> None:
        body = self.browser.find_element(By.TAG_NAME, "body")
        body.send_keys(Keys.ENTER)  # before the stop: no effect
        run = Operator(self.part)
        self.waits_in(3)
        self.assertIn("part.ngc", self.texts("#stops h2")[0])
        body.send_keys("4")  # another key only changes the view
        self.until("#content h1")
        time.sleep(1)
        self.assertIsNone(run.status())
        self.assertAlmostEqual(self.at_mm(), 5.0, delta=0.05)
        body.send_keys(Keys.ENTER)
        self.waits_in(5)
        time.sleep(1)
        self.assertIsNone(run.status())
        self.assertAlmostEqual(self.at_mm(), 10.0, delta=0.05)
        self.click("#stops button")
        self.assertEqual(self.ends(run), 0)
        self.assertAlmostEqual(self.at_mm(), 15.0, delta=0.05)
        self.nobody_waits()
        self.assertEqual(list(self.own.glob("axistool-stop-*")), [])
        self.assertEqual(self.messages(), [])

    def test_a_stopped_and_a_killed_program_no_longer_wait(self) -> None:
        run = Operator(self.part)
        self.waits_in(3)
        self.tool("disable", "x", "--device", "sim")
        self.assertEqual(self.ends(run), 1)
        self.nobody_waits()

        self.part.write_text(PART.replace("X5", "X6"))
        run = Operator(self.part)
        self.waits_in(3)
        left = next(self.own.glob("axistool-stop-*"))
        os.kill(run.child, signal.SIGKILL)
        self.ends(run)
        self.nobody_waits()
        self.assertFalse(left.exists())
        said = self.browser.execute_async_script(
            "fetch('/api/stops/' + arguments[0] + '/continue', { method: 'POST', body: '{}' }).then((answer) => arguments[1](answer.status))", left.name)
        self.assertEqual(said, 422)
        self.assertAlmostEqual(self.at_mm(), 6.0, delta=0.05)


if __name__ == "__main__":
    unittest.main()
