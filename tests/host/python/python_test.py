#!/usr/bin/python3
"""The Python package gives the command line's results bit for bit and its messages; reads and writes its files."""

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
from unittest import mock

try:
    import numpy as np
except ImportError:
    print("python3-numpy is missing", file=sys.stderr)
    sys.exit(77)

import axistool

CASES = Path(os.environ["AXIS_TEST_DATA"]) / "drive-cases"
CASE = CASES / "none" / "case-00"
LOGS = Path(os.environ["AXIS_TEST_DATA"]).parents[1] / "host" / "examples" / "log"
PROGRAM = os.environ["AXISTOOL"]


def command_line(*arguments: object) -> dict:
    said = subprocess.run([PROGRAM, *map(str, arguments), "--json", "-"], capture_output=True, text=True, check=True)
    return json.loads(said.stdout)


class SameFigures(unittest.TestCase):
    """JSON numbers read back as the same doubles, so equality is bit for bit."""

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

            told = command_line("design", model, "--limits", "drive", "--reserve", 0.4, "--velocity", 300)
            self.assertEqual(axistool.design(found.model, limits="drive", reserve=0.4, velocity=300.0).json, told)
            self.assertLess(told["limits"]["written"]["velocity"], 300.1)
            with self.assertRaises(axistool.UsageError):
                axistool.design(found.model, limits="all")

    def test_records_are_cut_shifted_and_opened(self) -> None:
        jog = CASE / "train-jog.csv"
        with tempfile.TemporaryDirectory() as folder:
            out = Path(folder) / "out.csv"
            for command, record in [
                (["cut", jog, "--from", 1, "--to", 2], axistool.cut(axistool.Record.read(jog), 1.0, 2.0)),
                (["shift", jog, "--channel", "u_V", "--by", -0.0015], axistool.shift(jog, "u_V", -0.0015)),
            ]:
                command_line(*command, "-o", out)
                told = axistool.Record.read(out)
                self.assertEqual(list(record.columns), list(told.columns))
                for name in told.columns:
                    np.testing.assert_array_equal(record[name], told[name], name)
            log = LOGS / "sweep.csv"
            told = command_line("open", log, "--drive", "x", "-o", folder, "--yes")
            opened = axistool.open_logs(log, drive="x")
            self.assertEqual({**opened.json, "records": []}, {**told, "records": []})
            (name, record), = opened.records.items()
            np.testing.assert_array_equal(record["i_A"], axistool.Record.read(Path(folder) / name)["i_A"])
            self.assertEqual(opened.mapping, (Path(folder) / "mapping.toml").read_text())
            sheet = Path(folder) / "sheet.toml"
            subprocess.run([PROGRAM, "sheet", "x", "--kind", "linear", "--kt", "20", "-o", sheet], check=True,
                           stdout=subprocess.DEVNULL)
            self.assertEqual(axistool.sheet("x", "linear", kt=20.0), sheet.read_text())

    def test_friction_bode_export_effects_plan_and_scoreboard(self) -> None:
        model, jog, steps = CASE / "model.toml", CASE / "train-jog.csv", CASE / "train-steps.csv"
        self.assertEqual(axistool.friction(jog, model).json, command_line("friction", jog, "--model", model))
        told = command_line("bode", jog, "--model", model)
        found = axistool.bode(jog, model).json
        self.assertEqual({key: found[key] for key in told}, told)
        self.assertEqual(axistool.effects("cogging"), command_line("effects", "cogging")["effects"])
        with tempfile.TemporaryDirectory() as folder:
            path, run, beliefs = Path(folder) / "x.hal", Path(folder) / "run.toml", Path(folder) / "plan.json"
            told = command_line("export", model, "--to", "linuxcnc", "--record", jog, "-o", path)
            made = axistool.export(model, "linuxcnc", path, jog)
            self.assertEqual(made.json, told)
            self.assertEqual(made.files, {name: Path(name).read_text() for name in told["files"]})
            box = "travel=40,speed=150,volts=3,time=10"
            told = command_line("plan", model, "--train", steps, "--rivals", "backlash,compliance", "--box", box,
                                "--most-samples", "1e6", "-o", run)
            planned = axistool.plan(model, steps, rivals=["backlash", "compliance"], box=box, most_steps=1e6)
            self.assertEqual({**planned.json, "run": ""}, {**told, "run": ""})
            self.assertEqual(planned.run, run.read_text())
            beliefs.write_text(json.dumps(told))
            with self.assertRaisesRegex(axistool.UsageError, "planned run"):  # steps were planned by nobody
                axistool.diagnose(model, steps, believed=beliefs)
        told = command_line("scoreboard", CASES / "none" / "case-01")
        scored = axistool.scoreboard(CASES / "none" / "case-01")
        for one in (*told["cases"], *scored["cases"]):
            del one["seconds"]
        self.assertEqual(scored, told)

    def test_circle(self) -> None:
        t = np.arange(8000) * 1e-3
        x, y = 20.0 * np.cos(np.pi * t), 20.0 * np.sin(np.pi * t)
        record = axistool.Record.from_arrays(t_s=t, x_mm=x + 0.003 * np.sign(y), x_ref_mm=x, y_mm=y, y_ref_mm=y)
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "circle.csv"
            record.write(path)
            told = command_line("circle", path, "--model", CASE / "model.toml", "--report", Path(folder) / "told.html")
            found = axistool.circle(path, [CASE / "model.toml"], report=Path(folder) / "found.html")
            self.assertEqual(found.json, told)
            self.assertEqual((Path(folder) / "found.html").read_text(), (Path(folder) / "told.html").read_text())

    def test_reports_are_the_pages_of_the_commands(self) -> None:
        case = CASES / "none" / "case-01"
        model, train, judge = case / "model.toml", case / "train-jog.csv", case / "validate.csv"
        with tempfile.TemporaryDirectory() as folder:
            told, found, better = (Path(folder) / name for name in ("told.html", "found.html", "better.toml"))
            sets = ["--train", train, "--validate", judge]
            for command, call in [
                (["identify", CASE / "train-steps.csv", "--drive", CASE / "model.toml"],
                 lambda: axistool.identify(CASE / "train-steps.csv", CASE / "model.toml", report=found)),
                (["compare", model, judge], lambda: axistool.compare(model, judge, report=found)),
                (["diagnose", model, *sets], lambda: axistool.diagnose(model, train, judge, report=found)),
                (["improve", model, *sets, "-o", better],
                 lambda: axistool.improve(model, train, judge, output=better, report=found)),
            ]:
                command_line(*command, "--report", told)
                text = better.read_text() if better.exists() else ""
                call()
                self.assertEqual(found.read_text(), told.read_text(), command[0])
                self.assertEqual(better.read_text() if text else "", text)
                found.unlink()
        with self.assertRaisesRegex(axistool.UsageError, "output="):
            axistool.improve(model, train, judge, report="x.html")

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
    def test_arrays_come_back_from_the_library_bit_for_bit_without_a_file(self) -> None:
        read = axistool.Record.read(CASE / "train-jog.csv")
        # Thirds need all bits of a double, unlike decimals of a few digits. t_s stays, because its steps are checked.
        own = {name: values if name == "t_s" else values / 3 for name, values in read.columns.items()}
        record = axistool.Record.from_arrays(read.header, **own)
        with mock.patch("builtins.open", side_effect=AssertionError), mock.patch("os.open", side_effect=AssertionError):
            checked = record.checked()
        self.assertEqual(list(checked.columns), list(own))
        for name, values in own.items():
            np.testing.assert_array_equal(checked[name].view(np.int64), values.view(np.int64), name)
        self.assertEqual({**checked.header, **read.header}, dict(checked.header))

    def test_a_file_is_read_as_the_program_reads_it(self) -> None:
        with open(CASE / "train-jog.csv", encoding="utf-8") as file:
            text = np.loadtxt((line for line in file if not line.startswith(("#", "t_s"))), delimiter=",")
        record = axistool.Record.read(CASE / "train-jog.csv")
        np.testing.assert_array_equal(np.column_stack(list(record.columns.values())).view(np.int64), text.view(np.int64))

    def test_a_log_of_another_program_is_imported(self) -> None:
        t = np.arange(100)
        with tempfile.TemporaryDirectory() as folder:
            np.save(Path(folder) / "log.npy", np.column_stack([t, np.sin(t), np.cos(t)]))
            record = axistool.Record.from_log(Path(folder) / "log.npy", "t_s=#1*0.001,u_V=#2,x_mm=#3", drive="x")
            self.assertEqual(list(axistool.Record.read(Path(folder) / "log.npy").columns), ["#1", "#2", "#3"])
        np.testing.assert_array_equal(record["u_V"], np.sin(t))
        self.assertEqual(record.header["drive"], "x")

    def test_an_angle_within_its_turn_is_unwrapped(self) -> None:
        angle = np.linspace(0.0, 30.0, 200)
        with tempfile.TemporaryDirectory() as folder:
            np.save(Path(folder) / "log.npy", np.column_stack([0.01 * np.arange(200), angle, angle % 6.25]))
            record = axistool.Record.from_log(
                Path(folder) / "log.npy", "t_s=#1,u_V=#2,x_mm=#3", drive="x", unwrap={"x_mm": 6.25}
            )
        np.testing.assert_allclose(record["x_mm"], angle, atol=1e-9)

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
        model, jog = CASE / "model.toml", CASE / "train-jog.csv"
        with tempfile.TemporaryDirectory() as folder:
            still, turned, out = Path(folder) / "still.csv", Path(folder) / "turned.csv", Path(folder) / "out.toml"
            record = axistool.Record.read(jog)
            t = np.arange(3000) * 0.001
            axistool.Record.from_arrays(t_s=t, u_V=0.1 * np.sin(t), x_mm=0 * t, w_rad_s=0.01 * np.sin(900 * t)).write(still)
            axistool.Record({**record.columns, "w_rad_s": -record["w_rad_s"]}, record.header).write(turned)
            for kind, call, command in [
                (axistool.BadInput, lambda: axistool.compare(model, "no-such.csv"), ["compare", model, "no-such.csv"]),
                (axistool.BadInput, lambda: axistool.compare(model, turned), ["compare", model, turned]),
                (axistool.BadInput, lambda: axistool.compare("no.toml", jog), ["compare", "no.toml", jog]),
                (axistool.Refused, lambda: axistool.identify(still, model), ["identify", still, "--drive", model]),
                (axistool.UsageError, lambda: axistool.add(model, "coging", jog),
                 ["add", model, "coging", "--train", jog, "-o", out]),
                (axistool.UsageError, lambda: axistool.diagnose(model, jog, prior={"J": 1e-4}),
                 ["diagnose", model, "--train", jog, "--prior", "J=0.0001"]),
                (axistool.BadInput, lambda: axistool.design(model, fc=1e6), ["design", model, "--fc", "1e6"]),
                (axistool.NoSuchDevice, lambda: axistool.disable("socket:/no/such"),
                 ["disable", "--device", "socket:/no/such"]),
            ]:
                with self.assertRaises(kind, msg=str(command)) as caught:
                    call()
                said = subprocess.run([PROGRAM, *map(str, command)], capture_output=True, text=True)
                self.assertEqual("axistool: " + str(caught.exception), said.stderr.strip())
                self.assertEqual(caught.exception.code, said.returncode)

    def test_are_told_apart(self) -> None:
        with self.assertRaises(axistool.UsageError):
            axistool.identify(CASE / "train-steps.csv", drive=CASE / "model.toml", method="guess")
        with self.assertRaises(axistool.NoSuchDevice):
            axistool.capture(0.1, device="socket:/nowhere/at/all")

    def test_of_a_callback_end_the_work(self) -> None:
        def enough(share: float, what: str) -> None:
            raise ZeroDivisionError(what)

        case = CASES / "pairs" / "case-00"
        before = threads()
        with self.assertRaises(ZeroDivisionError):
            axistool.improve(case / "model.toml", case / "train-jog.csv", case / "validate.csv", progress=enough)
        self.assertEqual(threads(), before, "nothing goes on behind")

    def test_ctrl_c_ends_a_diagnosis(self) -> None:
        """From another thread of Python, which runs because the library does not keep the interpreter's lock. What ends
        where it is has computed a tenth of the whole; what only says so at its end, all."""
        case = CASES / "pairs" / "case-00"
        begun = threading.Event()

        def press() -> None:
            begun.wait()
            os.kill(os.getpid(), signal.SIGINT)

        def computed_s(progress: axistool.Progress | None) -> float:
            from_s = time.process_time()
            try:
                axistool.diagnose(case / "model.toml", case / "train-jog.csv", case / "validate.csv", progress=progress)
            except KeyboardInterrupt:
                self.assertIsNotNone(progress)
            return time.process_time() - from_s

        whole_s = computed_s(None)
        before = threads()
        hand = threading.Thread(target=press)
        hand.start()
        self.assertLess(computed_s(lambda share, what: begun.set()), 0.5 * whole_s)
        hand.join()
        self.assertEqual(threads(), before, "nothing goes on behind")


def threads() -> set[str]:
    return set(os.listdir("/proc/self/task"))


if __name__ == "__main__":
    unittest.main()
