#!/usr/bin/python3
"""The workbench in a real browser: drop a record, compare, find the missing effect, click an effect, and the error
falls; reload during a job; dark, wide and narrow layout; no console message, no horizontal scrolling. AXIS_SCREENSHOTS
names a folder for screenshots."""

import json
import os
import shutil
import subprocess
import sys
import tempfile
import time
import unittest
from pathlib import Path
from xml.etree import ElementTree

from served_page import PATIENCE_S, PROGRAM, ServedPage  # ends here without a browser
from selenium.webdriver.common.action_chains import ActionChains
from selenium.webdriver.common.by import By
from selenium.webdriver.support.ui import WebDriverWait

CASE = Path(os.environ["AXIS_TEST_DATA"]) / "drive-cases/single/case-00"  # this machine cogs

DRAWN = """
return [...document.querySelectorAll("#content .canvas canvas")].filter((canvas) => canvas.width && [...canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height).data].some((value) => value)).length;
"""


class Workbench(ServedPage, unittest.TestCase):
    def setUp(self) -> None:
        self.folder = Path(tempfile.mkdtemp(prefix="axis-workbench-"))
        self.addCleanup(shutil.rmtree, self.folder)
        for name in ("model.toml", "train-jog.csv", "validate.csv"):
            shutil.copy(CASE / name, self.folder)
        self.open(self.folder)
        self.addCleanup(self.close)

    def keep(self, name: str) -> None:
        """Saves a screenshot of the whole page if AXIS_SCREENSHOTS is set; checks conditions of every view."""
        wide = self.browser.execute_script("return document.documentElement.scrollWidth - document.documentElement.clientWidth")
        self.assertLessEqual(wide, 0, f"{name}: nothing lies beside the page")
        if not (folder := os.environ.get("AXIS_SCREENSHOTS")):
            return
        size = self.browser.get_window_size()
        self.browser.execute_script("window.scrollTo(0, 0)")
        height = self.browser.execute_script("return document.documentElement.scrollHeight")
        self.browser.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", {"width": size["width"], "height": min(height, 6000), "deviceScaleFactor": 1, "mobile": False})
        time.sleep(0.5)
        self.browser.save_screenshot(f"{folder}/{name}.png")
        self.browser.execute_cdp_cmd("Emulation.clearDeviceMetricsOverride", {})

    def show_on(self, width: int, height: int) -> None:
        self.browser.set_window_size(width, height)
        self.browser.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", {"width": width, "height": height, "deviceScaleFactor": 1, "mobile": False})
        time.sleep(0.3)

    def keep_on_phone(self, name: str) -> None:
        self.show_on(400, 850)
        self.keep(name)
        self.show_on(1440, 1000)
        self.browser.execute_cdp_cmd("Emulation.clearDeviceMetricsOverride", {})

    def quiet(self) -> None:
        self.assertEqual(self.messages(), [],
                         f"no console message; the page says: {self.texts('[role=alert]')}, {self.texts('#notice')}")

    def test_from_a_dropped_record_to_an_effect_that_was_added(self) -> None:
        browser = self.browser
        self.until("#content .verdict")
        self.assertNotIn("token", browser.current_url, "the address no longer holds the key")
        began = time.monotonic()
        self.drop(CASE / "train-sweep.csv")
        self.until("[aria-label='Role of train-sweep.csv']")
        WebDriverWait(browser, PATIENCE_S).until(lambda _: "train-sweep.csv" in " ".join(self.texts(".command code")))
        print(f"dropped to compared: {time.monotonic() - began:.2f} s", file=sys.stderr)
        self.assertGreater(browser.execute_script(DRAWN), 10)
        titles = " ".join(self.texts("#content figcaption strong"))
        for title in ("Against speed", "Along the travel", "Against acceleration", "After a reversal", "Over time", "Position and speed"):
            self.assertIn(title, titles)
        legends = " ".join(self.texts("#content .legend"))
        self.assertTrue("forward" in legends and "backward" in legends and "noise floor" in legends, legends)
        self.keep("compare")
        self.quiet()

        # Two clicks: find, add.
        self.click("a[href='#effects/find']")
        self.until(".progress progress")
        browser.refresh()  # in the middle of the job
        self.until(".progress progress, #diagnosis:not(.first-look) .card", 20)  # on a busy computer it has ended
        first = self.until("#cards .card")
        self.assertIn("Cogging", first.text)
        self.keep("effects")
        self.keep_on_phone("phone-effects")
        self.click("#cards .card button")
        self.until("#undo")
        self.until("#overlay .blocks .canvas canvas")
        self.keep("added")
        self.keep_on_phone("phone-added")
        given, after = (json.loads((self.folder / "workbench/0002-add.json").read_text())["error"][which]["validate"]["combined"] for which in ("given", "after"))
        self.assertLess(after, 0.5 * given)
        bars = self.texts(".bars .value")
        self.assertIn(f"{after:.3g} ×", bars)
        self.assertIn(f"{given:.3g} ×", bars)
        self.assertTrue((self.folder / "model+cogging.toml").exists())
        self.assertEqual(browser.execute_script("return document.querySelector('input[name=model]:checked').parentElement.textContent"), "model+cogging.toml")
        self.quiet()

        browser.execute_cdp_cmd("Browser.setDownloadBehavior", {"behavior": "allow", "downloadPath": str(self.folder / "downloads")})
        self.click("#story")
        WebDriverWait(browser, PATIENCE_S).until(lambda _: (self.folder / "downloads/story.html").exists())
        browser.switch_to.new_window("tab")
        browser.get((self.folder / "downloads/story.html").as_uri())
        self.until(".dygraph-legend, .canvas canvas")
        self.assertIn("axistool add model.toml cogging", browser.find_element(By.TAG_NAME, "body").text)
        self.keep("story")
        self.quiet()
        browser.close()
        browser.switch_to.window(browser.window_handles[0])

        # The same figures as the command's, and what was done can be undone.
        command = next(text for text in self.texts(".command code") if text.startswith("axistool add"))
        told = json.loads((self.folder / "workbench/0002-add.json").read_text())
        subprocess.run(command.replace("axistool", PROGRAM, 1), shell=True, cwd=self.folder, check=True, stdout=subprocess.DEVNULL)
        self.assertEqual(json.loads((self.folder / "workbench/0002-add.json").read_text()), told)
        self.click("#undo")
        self.until("#cards .card.found")
        self.assertFalse(browser.find_elements(By.ID, "undo"))
        self.quiet()

    def test_a_stretch_is_lit_left_out_and_saved(self) -> None:
        browser = self.browser
        downloads = self.folder / "downloads"
        browser.execute_cdp_cmd("Browser.setDownloadBehavior", {"behavior": "allow", "downloadPath": str(downloads)})
        self.until("[aria-label='Role of train-jog.csv']")
        browser.find_element(By.CSS_SELECTOR, "[aria-label='Role of train-jog.csv'] option[value=off]").click()
        WebDriverWait(browser, PATIENCE_S).until(lambda _: "train-jog" not in " ".join(self.texts("#content > div > .command code")))
        canvas = self.until("#content .plot .canvas canvas:last-of-type")
        browser.execute_script("arguments[0].scrollIntoView({ block: 'center' })", canvas)
        ActionChains(browser).move_to_element_with_offset(canvas, -100, 0).click_and_hold().move_by_offset(60, 0).move_by_offset(60, 0).release().perform()
        self.click(".zoomed button")
        self.until("#unlight")
        WebDriverWait(browser, PATIENCE_S).until(lambda _: "s, forward" in " ".join(self.texts(".legend")) or "s, backward" in " ".join(self.texts(".legend")))
        self.assertIn("--stretch", " ".join(self.texts(".command code")))
        self.keep("lit")
        self.click(".tools button")
        self.click(".tools button + button")
        WebDriverWait(browser, 20).until(lambda _: len(list(downloads.glob("*.csv")) + list(downloads.glob("*.png"))) == 2)
        rows = next(downloads.glob("*.csv")).read_text().splitlines()
        self.assertEqual(rows[0], "panel,series,time [s],value")
        self.assertGreater(len(rows), 5000)
        if folder := os.environ.get("AXIS_SCREENSHOTS"):
            shutil.copy(next(downloads.glob("*.png")), f"{folder}/figure.png")

        canvas = self.until("#content .plot .canvas canvas:last-of-type")
        browser.execute_script("arguments[0].scrollIntoView({ block: 'center' })", canvas)
        ActionChains(browser).move_to_element_with_offset(canvas, -50, 0).click_and_hold().move_by_offset(60, 0).move_by_offset(60, 0).release().perform()
        self.click(".zoomed button + button")
        WebDriverWait(browser, PATIENCE_S).until(lambda _: len(list(self.folder.glob("validate-*.csv"))) == 2)
        WebDriverWait(browser, PATIENCE_S).until(lambda _: "validate-from" in " ".join(self.texts("#content > div > .command code")))
        self.assertNotIn(" validate.csv", " ".join(self.texts("#content > div > .command code")))
        self.click("#take-back")
        WebDriverWait(browser, PATIENCE_S).until(lambda _: " validate.csv" in " ".join(self.texts("#content > div > .command code")))
        self.quiet()

    def test_every_view_by_keys_on_every_screen(self) -> None:
        browser = self.browser
        self.until("#content .blocks")
        for width, height, scheme, name in ((1440, 1000, "dark", "dark"), (400, 850, "light", "phone"), (3840, 2160, "light", "4k")):
            self.show_on(width, height)
            browser.execute_cdp_cmd("Emulation.setEmulatedMedia", {"features": [{"name": "prefers-color-scheme", "value": scheme}]})
            for key, shown in (("1", "#content .focus ~ div .blocks canvas"), ("2", "#diagnose"), ("3", ".effect"), ("4", "#content h1"), ("5", "#content .command"), ("6", "#content .loop ~ div .blocks canvas")):
                browser.find_element(By.TAG_NAME, "body").send_keys(key)
                self.until(shown)
                time.sleep(0.3)
                self.keep(f"{name}-{key}")
        self.assertEqual(len(browser.find_elements(By.CSS_SELECTOR, ".effect")), 0)
        browser.get(self.url.split("?")[0] + "#gallery/backlash")
        self.until("#effect-backlash[open]")
        self.quiet()

    def test_odds_at_first_sight_then_a_value_is_dragged_kept_and_undone(self) -> None:
        browser = self.browser
        self.until("#content .verdict")  # the files are read
        (self.folder / "validate.csv").unlink()
        (self.folder / "train-jog.csv").unlink()
        browser.get(self.url.split("?")[0])
        self.until("#content .lead")
        began = time.monotonic()
        self.drop(CASE / "validate.csv")
        self.until("#content .blocks canvas")
        drawn = time.monotonic() - began
        self.until("#first-look")
        print(f"dropped 14 s at 1 kHz: first picture after {drawn:.2f} s, odds after {time.monotonic() - began:.2f} s", file=sys.stderr)
        self.assertIn("Cogging", self.until("#first-look").text)
        self.assertEqual(list(self.folder.glob("workbench/*diagnose*")), [], "before any search")
        self.click("#first-look")
        self.assertIn("Cogging", self.until(".first-look #cards .card").text)
        quick = next(text for text in self.texts(".first-look .command code") if "--quick" in text)
        said = subprocess.run(quick.replace("axistool", PROGRAM, 1) + " --json -", shell=True, cwd=self.folder, check=True, stdout=subprocess.PIPE).stdout
        odds = next(one["probability"] for one in json.loads(said)["candidates"] if one["kinds"] == ["cogging"])
        self.assertIn("> 99 %" if 0.99 < odds < 1.0 else f"{100 * odds:.0f} %", self.until("#cards .card .value").text)
        self.keep("first-look")

        self.click("#cards .card button")
        self.until("#overlay .blocks .canvas canvas")
        verdict = self.texts("#overlay .verdict")
        slider = self.until(".slider input[data-name='cogging.cosine']")
        fitted = slider.get_attribute("value")
        browser.execute_script("arguments[0].scrollIntoView({ block: 'center' })", slider)
        began = time.monotonic()
        browser.execute_script("arguments[0].value = 0; arguments[0].dispatchEvent(new Event('input')); arguments[0].dispatchEvent(new Event('change'));", slider)
        WebDriverWait(browser, PATIENCE_S, 0.02).until(lambda _: "trial.toml" in " ".join(self.texts("#overlay .command code")))
        print(f"a value dragged: the residual follows after {time.monotonic() - began:.2f} s", file=sys.stderr)
        self.assertGreater(browser.execute_script(DRAWN), 10)
        self.assertFalse((self.folder / "model+cogging-adjusted.toml").exists(), "a trial keeps nothing")
        self.keep("dragged")
        self.click("#undo-values")
        WebDriverWait(browser, PATIENCE_S, 0.05).until(lambda _: self.texts("#overlay .verdict") == verdict)
        self.assertEqual(slider.get_attribute("value"), fitted)
        browser.execute_script("arguments[0].value = 0; arguments[0].dispatchEvent(new Event('input')); arguments[0].dispatchEvent(new Event('change'));", slider)
        self.click("#keep-values:enabled")
        WebDriverWait(browser, PATIENCE_S).until(lambda _: "values set by hand" in " ".join(self.texts(".bars th")))
        self.assertTrue((self.folder / "model+cogging-adjusted.toml").exists())
        self.click("#undo")
        WebDriverWait(browser, PATIENCE_S).until(lambda _: "values set by hand" not in " ".join(self.texts(".bars th")))
        self.assertEqual(browser.execute_script("return document.querySelector('input[name=model]:checked').parentElement.textContent"), "model+cogging.toml")
        self.quiet()

    def test_axes_differences_roles_and_the_gallery(self) -> None:
        browser = self.browser
        self.until("#content .blocks canvas")
        figure = "return [...document.querySelectorAll('#content figure')].find((one) => one.querySelector('strong')?.textContent === arguments[0])"
        spectrum = WebDriverWait(browser, PATIENCE_S).until(lambda _: browser.execute_script(figure, "Spectrum"))
        WebDriverWait(browser, PATIENCE_S).until(lambda _: "Nm/√Hz" in spectrum.text)  # drawn after the first picture
        speed = browser.execute_script(figure, "Against speed")
        browser.execute_script("arguments[0].scrollIntoView({ block: 'center' })", speed)
        next(button for button in speed.find_elements(By.CSS_SELECTOR, ".tools button") if button.text == "log y").click()
        self.assertTrue(browser.execute_script("return window.axisCharts.some((chart) => arguments[0].contains(chart.graphDiv) && chart.getOption('logscale'))", speed))
        canvas = spectrum.find_element(By.CSS_SELECTOR, ".canvas canvas:last-of-type")
        browser.execute_script("arguments[0].scrollIntoView({ block: 'center' })", spectrum)
        ActionChains(browser).move_to_element_with_offset(canvas, -60, 0).click().move_by_offset(100, 0).perform()
        self.assertIn("Δ", spectrum.find_element(By.CSS_SELECTOR, ".legend .at").text)
        self.assertIn("Δ", spectrum.find_element(By.CSS_SELECTOR, ".legend .reading").text)
        browser.find_element(By.CSS_SELECTOR, "[aria-label='Map up'] option[value=acceleration]").click()
        WebDriverWait(browser, PATIENCE_S).until(lambda _: "Position and acceleration" in self.texts("#content figcaption strong"))
        self.keep("axes")
        browser.find_element(By.CSS_SELECTOR, "[aria-label='Plotted against'] option[value=acceleration]").click()
        WebDriverWait(browser, PATIENCE_S).until(lambda _: "Missing torque against acceleration" in self.texts("#content figcaption strong"))
        self.assertIn("--plot acceleration,error", " ".join(self.texts(".command code")))
        browser.find_element(By.CSS_SELECTOR, "[aria-label='Plotted'] option[value=speed]").click()
        WebDriverWait(browser, PATIENCE_S).until(lambda _: "Speed against acceleration" in self.texts("#content figcaption strong"))
        self.keep("chosen-plot")
        browser.find_element(By.CSS_SELECTOR, "[aria-label='Plotted against'] option[value=temperature]").click()
        WebDriverWait(browser, PATIENCE_S).until(lambda _: "not drawn" in " ".join(self.texts("#content .facts, #content dl, #content .blocks")))
        downloads = self.folder / "downloads"
        browser.execute_cdp_cmd("Browser.setDownloadBehavior", {"behavior": "allow", "downloadPath": str(downloads)})
        browser.execute_script("[...arguments[0].querySelectorAll('.tools button')].find((one) => one.textContent === 'SVG').click()", browser.execute_script(figure, "Against speed"))
        WebDriverWait(browser, 20).until(lambda _: list(downloads.glob("*.svg")))
        svg = ElementTree.parse(next(downloads.glob("*.svg"))).getroot()
        names = [element.tag.rpartition("}")[2] for element in svg.iter()]
        self.assertGreaterEqual(names.count("path"), 5, "curves of both directions, their bands, and the axes")
        self.assertGreater(names.count("text"), 10)
        if folder := os.environ.get("AXIS_SCREENSHOTS"):
            shutil.copy(next(downloads.glob("*.svg")), f"{folder}/figure.svg")
        period = browser.execute_script("return [...document.querySelectorAll('#content figure')].find((one) => one.querySelector('strong')?.textContent.startsWith('Within one period'))")
        next(button for button in period.find_elements(By.CSS_SELECTOR, ".tools button") if button.text == "looks like…").click()
        WebDriverWait(browser, PATIENCE_S).until(lambda _: self.texts(".alike li"))
        self.assertIn("Cogging", self.texts(".alike li")[0])
        self.assertIn("--like phase", " ".join(self.texts(".alike .command code")))
        self.keep("looks-like")
        self.click("#swap")
        self.until("[aria-label='Role of validate.csv'] option[value=train]:checked")
        self.until("[aria-label='Role of train-jog.csv'] option[value=judge]:checked")
        browser.get(self.url.split("?")[0] + "#gallery/backlash")
        self.until("#effect-backlash[open] .picture canvas")
        self.assertIn("times as large", self.until("#effect-backlash .picture figcaption").text)
        self.keep("gallery")
        self.quiet()

    def fill_with_logs(self, heading: str) -> None:
        """Replaces model and records by a data sheet and the logs of another controller."""
        self.until("#content .verdict")  # the files are read
        sheet = (CASE / "model.toml").read_text().split("[[effect]]")[0]
        (self.folder / "model.toml").unlink()
        for name in ("train-jog.csv", "validate.csv"):
            rows = (self.folder / name).read_text().splitlines()[4:]
            (self.folder / name).write_text(heading + "\n" + "\n".join(rows).replace(",", ";"))
        (self.folder / "sheet.toml").write_text(sheet)
        self.browser.get(self.url)

    def test_from_logs_to_an_added_effect_in_four_clicks(self) -> None:
        self.fill_with_logs("Time [s];Command Voltage [V];ActPos [mm];ActVel [rad/s]")
        self.click("#choice a[href='#open/train-jog.csv/validate.csv']")
        self.until("[aria-label='Role of records/validate.csv'] option[value=judge]:checked")
        self.click("#identify")
        self.until("#content .verdict")
        self.assertTrue((self.folder / "sheet-identified.toml").exists())
        self.keep("opened")
        self.click("a[href='#effects/find']")
        self.until("#diagnosis:not(.first-look) #cards .card")
        self.click("#cards .card button")
        self.until("#overlay .blocks .canvas canvas")
        self.assertEqual(self.clicks, 4)
        told = json.loads((self.folder / "workbench/0003-add.json").read_text())
        self.assertLess(told["error"]["after"]["validate"]["combined"], told["error"]["given"]["validate"]["combined"])
        self.keep("added-to-logs")
        self.quiet()

    def test_channels_that_are_not_recognised_are_chosen(self) -> None:
        browser = self.browser
        self.fill_with_logs("a;b;c;d")
        self.click("#choice a[href='#open/train-jog.csv/validate.csv']")
        self.until("#content table select")
        self.keep("not-recognised")
        for name, quantity in (("a", "time in s"), ("b", "command in V"), ("c", "position in mm"), ("d", "speed in rad/s")):
            select = self.until(f"[aria-label='Quantity of {name}']")
            next(option for option in select.find_elements(By.TAG_NAME, "option") if option.text == quantity).click()
        self.click("#choose-channels")
        self.until("[aria-label='Role of records/validate.csv'] option[value=judge]:checked")
        first = [line for line in (self.folder / "records/validate.csv").read_text().splitlines() if not line.startswith("#")][:2]
        self.assertEqual(first[0], "t_s,u_V,x_mm,w_rad_s")
        self.quiet()

    def test_a_loop_is_designed_by_hand(self) -> None:
        browser = self.browser
        self.until("#content .verdict")
        browser.find_element(By.TAG_NAME, "body").send_keys("6")
        self.until("#content .loop ~ div .blocks canvas")
        titles = " ".join(self.texts("#content figcaption strong"))
        for title in ("Margins", "Step of", "Move over"):
            self.assertIn(title, titles)

        def error_um() -> float:
            return float(next(text for text in self.texts("#content .facts dl > div") if "designed" in text).split("\n")[-1].split()[0])

        slow = error_um()
        began = time.monotonic()
        browser.execute_script("const s = document.querySelector('.loop [data-name=fc]'); s.value = 60; s.dispatchEvent(new Event('input'));")
        WebDriverWait(browser, PATIENCE_S, 0.02).until(lambda _: "--fc 60 " in " ".join(self.texts("#content .command code")))
        print(f"bandwidth moved: figures follow after {time.monotonic() - began:.2f} s", file=sys.stderr)
        self.assertLess(error_um(), slow, "the faster loop follows better")
        self.keep("loop")
        self.keep_on_phone("phone-loop")
        self.click("#fastest")
        WebDriverWait(browser, PATIENCE_S).until(lambda _: "--margin 0.5" in " ".join(self.texts("#content .command code")))
        self.assertNotEqual(browser.execute_script("return document.querySelector('.loop [data-name=fc]').value"), "60", "the slider shows what was found")
        self.assertFalse((self.folder / "model-params.toml").exists())
        self.click("#write-parameters")
        WebDriverWait(browser, PATIENCE_S).until(lambda _: (self.folder / "model-params.toml").exists())
        self.quiet()

    def test_a_long_record_is_zoomed_to_its_spike(self) -> None:
        browser, rows, spike = self.browser, 300_000, 187_654
        self.until("#content .verdict")
        with open(self.folder / "long.csv", "w") as file:
            file.write("# format: axis-record/1\nt_s,u_V,x_mm,w_rad_s\n")
            file.writelines(f"{k / 1000:.3f},{9.5 if k == spike else k % 100 / 100},{k % 5000 / 100},{k % 77 / 10}\n" for k in range(rows))
        (self.folder / "workbench").mkdir(exist_ok=True)
        (self.folder / "workbench/choice.json").write_text(json.dumps({"model": "model.toml", "beside": [], "roles": {"long.csv": "off"}}))
        browser.refresh()
        self.click("#choice a[href='#record/long.csv']")
        WebDriverWait(browser, PATIENCE_S).until(lambda _: f"{rows:,} rows" in " ".join(self.texts("#record-status")) and "read" not in " ".join(self.texts("#record-status")))
        canvas = self.until("canvas.scope")

        def shown() -> dict:
            return browser.execute_script("const z = arguments[0].zoom; return { from: z.from, to: z.to, rows: z.shown.rows, first: z.shown.first, low: z.shown.low[0], high: (z.shown.high || z.shown.low)[0], isFine: z.isFine() }", canvas)

        def highest(view: dict) -> int:
            return view["first"] + view["rows"] * max(range(len(view["high"])), key=lambda k: view["high"][k])

        whole = shown()
        self.assertGreater(whole["rows"], 64, "buckets, not rows")
        self.assertEqual(max(whole["high"]), 9.5, "one row of 300 000 is in the picture")
        self.assertLessEqual(highest(whole), spike)
        self.assertGreater(highest(whole) + whole["rows"], spike)
        self.keep("record")
        # Drag over the spike, where the picture has it; then closer by the wheel's way, until rows are shown.
        box = browser.execute_script("const b = arguments[0].getBoundingClientRect(); return [b.left, b.width]", canvas)
        left, width = 74, box[1]
        place = left + (width - left) * spike / rows - width / 2
        ActionChains(browser).move_to_element_with_offset(canvas, int(place) - 30, 0).click_and_hold().move_by_offset(30, 0).move_by_offset(30, 0).release().perform()
        WebDriverWait(browser, PATIENCE_S).until(lambda _: shown()["isFine"] and shown()["to"] - shown()["from"] < 0.1 * rows)
        self.assertTrue(shown()["from"] < spike < shown()["to"])
        browser.execute_script("arguments[0].zoom.look(arguments[1] - 100, arguments[1] + 100)", canvas, spike)
        WebDriverWait(browser, PATIENCE_S).until(lambda _: shown()["isFine"])
        self.assertEqual(shown()["rows"], 1)
        self.assertEqual(highest(shown()), spike)
        ActionChains(browser).move_to_element_with_offset(canvas, int(left + (width - left) / 2 - width / 2), 0).perform()
        self.assertRegex(" ".join(self.texts("#record-reading")), r"187\.6[45]\d s: u_V")
        self.keep("record-zoomed")

        browser.execute_script("arguments[0].zoom.look(100_000, 140_000)", canvas)
        self.click("#keep-shown")
        WebDriverWait(browser, PATIENCE_S).until(lambda _: (self.folder / "long-100-140s.csv").exists())
        self.assertIn("axistool cut long.csv --from 100 --to 140", " ".join(self.texts(".command code")))
        kept = (self.folder / "long-100-140s.csv").read_text().splitlines()
        self.assertTrue(kept[-1].startswith("140"), kept[-1])
        self.keep_on_phone("phone-record")
        self.quiet()

    def test_a_long_comparison_is_a_job_of_one_page(self) -> None:
        browser = self.browser
        self.until("#content .verdict")
        lines = (self.folder / "validate.csv").read_text().splitlines()
        head = next(k for k, line in enumerate(lines) if line.startswith("t_s")) + 1
        rows = [line.split(",") for line in lines[head:]]
        shift = float(rows[-1][2]) - float(rows[0][2])
        with open(self.folder / "long.csv", "w") as file:
            file.write("\n".join(lines[:head]) + "\n")
            for tile in range(700_000 // len(rows)):
                file.writelines(f"{(tile * len(rows) + k) / 1000:.3f},{row[1]},{float(row[2]) + tile * shift:.5f},{row[3]}\n" for k, row in enumerate(rows))
        (self.folder / "workbench").mkdir(exist_ok=True)
        (self.folder / "workbench/choice.json").write_text(json.dumps({"model": "model.toml", "beside": [], "roles": {"long.csv": "train", "train-jog.csv": "off", "validate.csv": "off"}}))

        def states() -> list[str]:
            return [json.loads(path.read_text())["state"] for path in sorted(self.folder.glob("workbench/*.job.json"))]

        def become(*wanted: str) -> None:
            WebDriverWait(browser, PATIENCE_S, 0.05).until(lambda _: states() == list(wanted), f"{wanted}, not {states()}")

        browser.refresh()
        self.until(".progress progress[value]")
        self.until("canvas.scope")
        browser.refresh()
        self.until(".progress progress")
        self.assertEqual(states(), ["running"], "a reload begins no other one")
        # Another page, which this one does not know, begins the same and cancels it.
        browser.execute_async_script("""
            const done = arguments[0], post = (path, text) => fetch(path, { method: "POST", body: text }).then((answer) => answer.json());
            post("/api/jobs", JSON.stringify({ do: "compare", models: ["model.toml"], records: ["long.csv"] })).then((told) => post("/api/jobs/" + told.id + "/cancel", "{}")).then(done);""")
        become("running", "cancelled")
        self.until("#content .blocks canvas")
        become("done", "cancelled")
        command = next(text for text in self.texts(".command code") if text.startswith("axistool compare")).split(" --report")[0]
        told = json.loads((self.folder / "workbench/0001-compare.json").read_text())
        error = f"{told['combined']:#.3g}".rstrip(".")
        self.assertIn(f"{error} times the noise floor", " ".join(self.texts("#content .verdict")))
        self.assertTrue(command.endswith("--json workbench/0001-compare.json"), command)
        browser.refresh()
        self.until("#content .blocks canvas")
        self.assertEqual(states(), ["done", "cancelled"], "a result is kept")
        self.keep("long-compared")
        self.quiet()

    def test_file_names_are_text(self) -> None:
        name = "<img src=x onerror=alert(1)>.csv"
        self.until("#content .verdict")  # the first page has no request in progress that would lack its cookie
        shutil.copy(CASE / "train-jog.csv", self.folder / name)
        self.browser.delete_all_cookies()
        opener = self.folder / "opener.html"  # as serve opens the page: the token is in no command line
        opener.write_text(f'<meta http-equiv="refresh" content="0;url={self.url}">')
        self.browser.get(opener.as_uri())
        self.messages()  # of the page without its cookie, which may have asked for something
        self.until("[aria-label='Role of " + name + "']")
        WebDriverWait(self.browser, PATIENCE_S).until(lambda _: "onerror" in " ".join(self.texts(".command code")))
        self.assertEqual(self.browser.find_elements(By.TAG_NAME, "img"), [])
        self.quiet()


if __name__ == "__main__":
    unittest.main()
