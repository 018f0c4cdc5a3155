#!/usr/bin/python3
"""Two pages in two browsers on one simulated board: one commands, the other looks and can stop; after STOP the other one
may command. A program that waits at M0 shows in both, also in the Live view, and goes on by either."""

import time
import unittest

from live_test import PRESS, on_a_free_computer, ProcessorTime
from served_page import ServedPage  # ends here without a browser
from selenium.webdriver.common.action_chains import ActionChains
from selenium.webdriver.common.by import By
from selenium.webdriver.support.ui import WebDriverWait
from simulated_board import SimulatedBoard
from waiting_program_test import Operator, PART


class Page(ServedPage):
    """A further page of a program that another one has started."""

    def __init__(self, other: ServedPage) -> None:
        self.folder, self.url = other.folder, other.url
        self.browse()


class TwoPages(ServedPage, SimulatedBoard):
    waited = ProcessorTime()

    def setUp(self) -> None:
        self.start_board(1, 5)  # a long time-out, so that a loaded computer does not look like a lost host
        served = self.place / "served"
        served.mkdir()
        self.open(served, "--sim")
        self.addCleanup(self.close)
        self.other = Page(self)
        self.addCleanup(self.other.leave)
        for page in (self, self.other):
            page.browser.get(self.url.split("?")[0] + "#live")
            page.until("canvas.scope")

    def soon(self, holds, what: str) -> None:
        WebDriverWait(None, 30, 0.05).until(lambda _: holds(), what)

    def is_shown(self, page: ServedPage, state: str) -> bool:
        return page.texts(".motion .badge") == [state]

    def takes(self, page: ServedPage) -> None:
        def is_enabled() -> bool:
            page.browser.execute_script(PRESS, ["claim", "clear-faults", "enable-x"])
            time.sleep(0.3)
            return bool(page.browser.find_elements(By.CSS_SELECTOR, "#jog-x-plus:enabled"))

        self.soon(is_enabled, "the page commands, and the axis is enabled")

    def looks(self, page: ServedPage) -> None:
        self.soon(lambda: "Another page commands; this one looks." in page.texts("#who"), "the page says that it looks")
        for name in ("claim", "enable-x", "disable-x", "jog-x-plus", "jog-x-minus", "commission-start"):
            self.assertFalse(page.browser.find_element(By.ID, name).is_enabled(), name)

    @on_a_free_computer
    def test_one_commands_and_the_other_looks_and_stops(self) -> None:
        self.takes(self)
        self.looks(self.other)
        self.soon(lambda: self.is_shown(self.other, "enabled"), "both show the state")
        before = self.other.texts(".motion .where")
        ActionChains(self.browser).click_and_hold(self.until("#jog-x-plus:enabled")).perform()
        self.soon(lambda: self.other.texts(".motion .where") != before, "the other page shows that the axis moves")
        self.other.click("#stop")
        self.soon(lambda: self.axis()["state"] == "ready", "the page that looks has stopped the axis")
        self.assertEqual(self.axis()["fault"], "none")
        ActionChains(self.browser).release().perform()
        self.soon(lambda: self.is_shown(self, "ready") and self.until("#claim").is_displayed(), "the first page has lost the command")
        self.takes(self.other)
        self.looks(self)
        self.other.browser.get("about:blank")
        self.soon(lambda: self.axis()["state"] == "ready", "the axis stops with the page that commands")
        self.soon(lambda: self.until("#claim").is_enabled(), "the page that is left may command")

    def test_a_waiting_program_shows_on_both_pages(self) -> None:
        part = self.place / "part.ngc"
        part.write_text(PART)
        run = Operator(part)
        for line, page in ((3, self), (5, self.other)):
            for each in (self, self.other):
                self.soon(lambda: any(f"in line {line}." in text for text in each.texts("#stops h2")), f"line {line}")
                self.soon(lambda: self.is_shown(each, "enabled"), "the board's state is shown")
            page.click("#stops button")
        self.soon(lambda: run.status() is not None, "the program ends")
        self.assertAlmostEqual(self.at_mm(), 15.0, delta=0.05)
        for each in (self, self.other):
            self.soon(lambda: not each.texts("#stops section"), "nobody waits")
            self.assertEqual(each.messages(), [])


if __name__ == "__main__":
    unittest.main()
