"""A workbench that serves a folder, in a real headless browser. Exit code 77 without a browser."""

import os
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

try:
    from selenium import webdriver
    from selenium.common.exceptions import StaleElementReferenceException
    from selenium.webdriver.common.by import By
    from selenium.webdriver.chrome.service import Service
    from selenium.webdriver.support.ui import WebDriverWait
except ImportError:
    print("python3-selenium is not installed: the workbench was not opened in a browser", file=sys.stderr)
    sys.exit(77)
if not shutil.which("chromium") or not shutil.which("chromedriver"):
    print("chromium or chromium-driver is not installed: the workbench was not opened in a browser", file=sys.stderr)
    sys.exit(77)

PROGRAM = os.environ["AXISTOOL"]
PATIENCE_S = 240

# Drops files on the page; their content comes from a file input that exists only for this purpose.
DROP = """
const input = document.getElementById("test-input"), data = new DataTransfer();
for (const file of input.files) data.items.add(file);
for (const type of ["dragover", "drop"]) document.body.dispatchEvent(new DragEvent(type, { dataTransfer: data, bubbles: true, cancelable: true }));
input.remove();
"""


class ServedPage:
    """Starts both; end() checks that the program ends in order."""

    clicks = 0

    def open(self, folder: Path, *options: str) -> None:
        self.folder = folder
        self.program = subprocess.Popen([PROGRAM, "serve", str(self.folder), "--no-browser", *options], stdout=subprocess.PIPE, text=True)
        self.url = self.program.stdout.readline().strip()
        self.browse()

    def browse(self) -> None:
        """Opens a browser of its own on the program."""
        self.profile = tempfile.mkdtemp(dir=self.folder.parent, prefix="axis-profile-")
        options = webdriver.ChromeOptions()
        for word in ("--headless=new", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage", "--window-size=1440,1000", f"--user-data-dir={self.profile}"):
            options.add_argument(word)
        options.set_capability("goog:loggingPrefs", {"browser": "ALL"})
        self.browser = webdriver.Chrome(service=Service("/usr/bin/chromedriver"), options=options)
        self.browser.set_page_load_timeout(60)
        self.browser.get(self.url)

    def leave(self) -> None:
        self.browser.quit()
        shutil.rmtree(self.profile, True)

    def close(self) -> None:
        self.leave()
        self.program.send_signal(signal.SIGTERM)
        code, printed = self.program.wait(30), self.program.stdout.read()
        self.program.stdout.close()
        assert code == 0 and printed == "", f"ends in order, and one line is all that it prints: {code}, {printed}"

    def until(self, selector: str, patience_s: float = PATIENCE_S):
        return WebDriverWait(self.browser, patience_s, 0.1).until(
            lambda browser: next(iter(browser.find_elements(By.CSS_SELECTOR, selector)), None), selector)

    def texts(self, selector: str) -> list[str]:
        return self.browser.execute_script("return [...document.querySelectorAll(arguments[0])].map((one) => one.innerText.trim())", selector)

    def click(self, selector: str) -> None:
        """Clicks; repeats if the page has redrawn the element since it was found, because results arrive at any
        time."""
        def clicked(_) -> bool:
            element = self.until(selector)
            self.browser.execute_script("arguments[0].scrollIntoView({ block: 'center' })", element)
            element.click()
            self.clicks += 1
            return True

        WebDriverWait(self.browser, PATIENCE_S, 0.1, (StaleElementReferenceException,)).until(clicked, selector)

    def drop(self, *paths: Path) -> None:
        self.browser.execute_script("const i = document.createElement('input'); i.type = 'file'; i.multiple = true; i.id = 'test-input'; document.body.append(i);")
        self.browser.find_element(By.ID, "test-input").send_keys("\n".join(str(path) for path in paths))
        self.browser.execute_script(DROP)

    def messages(self) -> list[str]:
        """What the page wrote to the console since the last call."""
        return [entry["message"] for entry in self.browser.get_log("browser")]
