#!/usr/bin/python3
"""The Python package: the command line's figures bit for bit, its errors in its words, records and models both ways."""

import json
import os
import signal
import subprocess
import sys
import tempfile
import threading
import time
import unittest
from pathlib import Path

try:
    import numpy as np
except ImportError:
    print("python3-numpy is missing", file=sys.stderr)
    sys.exit(77)

import axistool

CASES = Path(os.environ["AXIS_TEST_DATA"]) / "drive-cases"
CASE = CASES / "none" / "case-00"
PROGRAM = os.environ["AXISTOOL"]


def command_line(*arguments: object) -> dict:
    said = subprocess.run([PROGRAM, *map(str, arguments), "--json", "-"], capture_output=True, text=True, check=True)
    return json.loads(said.stdout)


class SameFigures(unittest.TestCase):
    """JSON carries doubles that read back as the same bits, so equality here is of bits."""

    def test_identify_compare_predict_and_design(self) -> None:
        with tempfile.TemporaryDirectory() as folder:
            model = Path(folder) / "x.toml"
            steps, jog, drive = CASE / "train-steps.csv", CASE / "train-jog.csv", CASE / "model.toml"
            told = command_line("identify", steps, "--drive", drive, "-o", model)
            found = axistool.identify(steps, drive=drive)
            self.assertEqual(found.json, told)
            self.assertEqual(found.parameters["J_kg_m2"].value, told["parameters"]["J_kg_m2"]["value"])
            self.assertEqual(found.model.effect("inertia")["J_kg_m2"],
                             axistool.Model.read(model).effect("inertia")["J_kg_m2"])

            told = command_line("compare", model, jog)
            compared = axistool.compare(found.model, axistool.Record.read(jog))  # both through memory
            self.assertEqual(compared.combined, told["combined"])
            self.assertEqual(compared.channels["x_mm"].rms, told["channels"]["x_mm"]["rms"])

            predictions = Path(folder) / "p.csv"
            command_line("compare", model, jog, "--predictions", predictions)
            predicted = axistool.predict(found.model, jog)
            np.testing.assert_array_equal(predicted["x_pred_mm"], axistool.Record.read(predictions)["x_pred_mm"])

            told = command_line("design", model, "-o", Path(folder) / "p.toml", "--fc", 25)
            designed = axistool.design(found.model, fc=25)
            np.testing.assert_array_equal(designed.Kobs, np.array(told["Kobs"]))
            self.assertEqual(designed.Kobs.shape, (3, 2))
            self.assertIn("kalman", designed.parameters)

    def test_diagnose(self) -> None:
        case = CASES / "none" / "case-01"
        train, judge = case / "train-jog.csv", case / "validate.csv"
        told = command_line("diagnose", case / "model.toml", "--train", train, "--validate", judge)
        told_of: list[tuple[float, str]] = []
        found = axistool.diagnose(case / "model.toml", train, judge, progress=lambda *now: told_of.append(now))
        self.assertEqual(found.status, told["verdict"]["status"])
        shares = [share for share, _ in told_of]
        self.assertEqual(shares, sorted(shares))
        self.assertTrue(shares and 0.0 <= shares[0] and shares[-1] <= 1.0, shares)
        self.assertEqual({what for _, what in told_of}, {"diagnose"})
        self.assertEqual([one.after for one in found.candidates], [one["after"] for one in told["candidates"]])


    def test_add(self) -> None:
        case = CASES / "single" / "case-00"
        jog, drive = case / "train-jog.csv", case / "model.toml"
        with tempfile.TemporaryDirectory() as folder:
            told = command_line("add", drive, "cogging", "--train", jog, "-o", Path(folder) / "x.toml")
        found = axistool.add(drive, "cogging", axistool.Record.read(jog))
        self.assertEqual({**found.json, "model": ""}, {**told, "model": ""})
        self.assertIn("cogging", found.model.kinds)
        one = told["parameters"][0]
        self.assertEqual(found.parameters[one["name"]].value, one["value"])


class ABoard(unittest.TestCase):
    def test_simulated_around_a_model_is_captured_as_it_jogs(self) -> None:
        with axistool.simulated_board(CASE / "model.toml") as device:
            axistool.set_parameters(axistool.design(CASE / "model.toml").parameters, "x", device)
            axistool.enable("x", device)
            record = axistool.capture(0.0, device, jog="20:0.3,-20:0.3")
            axistool.disable(device)
        self.assertGreater(len(record), 500)
        self.assertGreater(np.ptp(record["x_mm"]), 2.0)

    def test_that_does_not_come_up_says_why(self) -> None:
        with self.assertRaisesRegex(axistool.BadInput, "no-such.toml"), axistool.simulated_board("no-such.toml"):
            pass


class BothWays(unittest.TestCase):
    def test_a_record_keeps_every_bit(self) -> None:
        t = np.arange(50) * 0.001
        values = np.random.default_rng(1).standard_normal(50) / 3
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "r.csv"
            axistool.Record.from_arrays({"drive": "x"}, t_s=t, u_V=values, x_mm=values * 1e-9).write(path)
            again = axistool.Record.read(path)
        np.testing.assert_array_equal(again["x_mm"], values * 1e-9)
        self.assertEqual(again.header["drive"], "x")
        self.assertEqual(len(again), 50)

    def test_a_model_keeps_every_bit_and_all_it_holds(self) -> None:
        for case in (CASE, CASES / "single" / "case-00"):
            model = axistool.Model.read(case / "model.toml")
            with tempfile.TemporaryDirectory() as folder:
                model.write(Path(folder) / "m.toml")
                self.assertEqual(axistool.Model.read(Path(folder) / "m.toml").document, model.document)

    def test_columns_of_two_lengths_are_no_record(self) -> None:
        with self.assertRaisesRegex(axistool.BadInput, "one length"):
            axistool.Record.from_arrays(t_s=[0.0, 1.0], u_V=[0.0]).write("/dev/null")


class Errors(unittest.TestCase):
    def test_say_what_the_program_says(self) -> None:
        with self.assertRaises(axistool.BadInput) as caught:
            axistool.compare(CASE / "model.toml", "no-such.csv")
        said = subprocess.run([PROGRAM, "compare", str(CASE / "model.toml"), "no-such.csv"], capture_output=True, text=True)
        self.assertEqual("axistool: " + str(caught.exception), said.stderr.strip())

    def test_are_told_apart(self) -> None:
        with self.assertRaises(axistool.UsageError):
            axistool.identify(CASE / "train-steps.csv", drive=CASE / "model.toml", method="guess")
        with self.assertRaises(axistool.NoSuchDevice):
            axistool.capture(0.1, device="socket:/nowhere/at/all")

    def test_of_a_callback_end_the_program(self) -> None:
        def enough(share: float, what: str) -> None:
            raise ZeroDivisionError(what)

        case = CASES / "pairs" / "case-00"
        with self.assertRaises(ZeroDivisionError):
            axistool.improve(case / "model.toml", case / "train-jog.csv", case / "validate.csv", progress=enough)
        self.assert_nothing_runs()

    def test_interrupted_the_program_ends_too(self) -> None:
        case = CASES / "pairs" / "case-00"
        threading.Thread(target=interrupt_once_it_runs, daemon=True).start()
        with self.assertRaises(KeyboardInterrupt):
            axistool.improve(case / "model.toml", case / "train-jog.csv", case / "validate.csv")
        self.assert_nothing_runs()

    def assert_nothing_runs(self) -> None:
        children = Path(f"/proc/self/task/{os.getpid()}/children")
        if children.exists():  # not on every kernel
            self.assertEqual(children.read_text().split(), [], "nothing goes on behind")


def interrupt_once_it_runs() -> None:
    """Ctrl-C some time after the program has started, however long that takes on a busy machine."""
    children = Path(f"/proc/self/task/{os.getpid()}/children")
    for _ in range(600):
        if not children.exists() or children.read_text().split():
            break
        time.sleep(0.05)
    time.sleep(0.3)
    os.kill(os.getpid(), signal.SIGINT)


if __name__ == "__main__":
    unittest.main()
