#!/usr/bin/python3
"""The Python package in a notebook: arrays, dicts and frames in and out, residuals, tables, examples that run."""

import doctest
import importlib
import os
import shutil
import sys
import tempfile
import unittest
from pathlib import Path
from unittest import mock

try:
    import numpy as np
except ImportError:
    print("python3-numpy is missing", file=sys.stderr)
    sys.exit(77)

import axistool

DATA = Path(os.environ["AXIS_TEST_DATA"])
CASE = DATA / "drive-cases" / "none" / "case-00"
LOGS = DATA.parents[1] / "host" / "examples" / "log"


class Frame:
    """The used part of a pandas DataFrame, so that the tests do not need pandas."""

    class Index:
        name = "t_s"

    def __init__(self, columns: dict, index: object = None) -> None:
        self._columns = columns
        self.columns = list(columns)
        self.index = index or Frame.Index()
        self.attrs = {"drive": "x"}

    def reset_index(self) -> "Frame":
        plain = type("Index", (), {"name": None})()
        return Frame({"t_s": np.arange(3) * 0.001, **self._columns}, plain)

    def __getitem__(self, name: str) -> "Frame.Series":
        return Frame.Series(self._columns[name])

    def to_numpy(self) -> np.ndarray:
        return np.array(list(self._columns.values())).T

    class Series:
        def __init__(self, values: object) -> None:
            self.values = values

        def to_numpy(self) -> np.ndarray:
            return np.asarray(self.values)


class RecordsOfMemory(unittest.TestCase):
    def test_dicts_frames_and_named_arrays_are_records(self) -> None:
        columns = {"t_s": [0.0, 0.001, 0.002], "u_V": [1.0, 2.0, 3.0]}
        named = np.array([(0.0, 1.0), (0.001, 2.0)], dtype=[("t_s", "f8"), ("u_V", "f8")])
        self.assertEqual(axistool.Record.of(columns)["u_V"].tolist(), [1.0, 2.0, 3.0])
        self.assertEqual(axistool.Record.of(named)["t_s"].tolist(), [0.0, 0.001])
        frame = axistool.Record.of(Frame({"u_V": [1.0, 2.0, 3.0]}))
        self.assertEqual(sorted(frame.columns), ["t_s", "u_V"])
        self.assertEqual(frame.header["drive"], "x")
        self.assertEqual(axistool.Record.of(columns).to_dict()["u_V"].dtype, np.float64)

    def test_datasets_are_records_with_their_coordinates(self) -> None:
        class Dataset(dict):  # as of xarray's, iterating gives the variables only
            coords = {"t_s": [0.0, 0.001]}
            attrs = {"drive": "x"}

            def __getitem__(self, name: str) -> object:
                return self.coords[name] if name in self.coords else super().__getitem__(name)

        record = axistool.Record.of(Dataset(x_mm=[1.0, 2.0]))
        again = axistool.Record.of(record.to_xarray_dict())
        for one in (record, again):
            self.assertEqual({name: one[name].tolist() for name in one.columns}, {"t_s": [0.0, 0.001], "x_mm": [1.0, 2.0]})
            self.assertEqual(one.header["drive"], "x")

    def test_arrays_without_names_are_told_the_way(self) -> None:
        for given in (np.zeros((500, 3)), 3.0, np.zeros(500)):
            with self.assertRaisesRegex(TypeError, r"Record\.from_arrays"):
                axistool.identify(given)

    def test_a_dict_identifies_as_its_file_does(self) -> None:
        record = axistool.Record.read(CASE / "train-steps.csv")
        by_file = axistool.identify(CASE / "train-steps.csv", drive=CASE / "model.toml")
        by_dict = axistool.identify(record.to_dict(), drive=CASE / "model.toml")
        self.assertEqual(by_dict.parameters, by_file.parameters)


class Residuals(unittest.TestCase):
    def test_are_what_the_prediction_leaves(self) -> None:
        rows = axistool.predict(CASE / "model.toml", CASE / "validate.csv")
        for against in ("t_s", "x_mm", "speed"):
            left = axistool.residuals(CASE / "model.toml", CASE / "validate.csv", against=against, channel="w_rad_s")
            np.testing.assert_array_equal(left.values, rows["w_rad_s"] - rows["w_pred_rad_s"])
            self.assertEqual(left.coordinate.shape, left.values.shape)
        np.testing.assert_array_equal(left.forward, rows["w_rad_s"] > 0.0)
        with self.assertRaises(KeyError):
            axistool.residuals(CASE / "model.toml", CASE / "validate.csv", against="temp_C")
        own = np.arange(len(rows)) ** 2
        np.testing.assert_array_equal(
            axistool.residuals(CASE / "model.toml", CASE / "validate.csv", against=own).coordinate, own)
        with self.assertRaisesRegex(ValueError, "shape"):
            axistool.residuals(CASE / "model.toml", CASE / "validate.csv", against=own[1:])


class Notebook(unittest.TestCase):
    def test_results_are_tables(self) -> None:
        record = axistool.Record.read(CASE / "train-steps.csv")
        found = axistool.identify(record, drive=CASE / "model.toml")
        compared = axistool.compare(found.model, CASE / "validate.csv")
        for result, word in ((record, "u_V"), (found, "J_kg_m2"), (compared, "x_mm")):
            self.assertIn("<table>", result._repr_html_())
            self.assertIn(word, result._repr_html_())
            self.assertIn(word, repr(result))
            self.assertLess(len(repr(result)), 4000, "a table, not all of the data")

    def test_plots_are_given_the_figures(self) -> None:
        """Fake axes record the plots instead of matplotlib; without matplotlib plot() says how to install it."""
        found = axistool.identify(CASE / "train-steps.csv", drive=CASE / "model.toml")
        compared = axistool.compare(found.model, CASE / "validate.csv")
        steps = [axistool.ImprovementStep([], 9.0, 8.0), axistool.ImprovementStep(["cogging"], 1.1, 1.2)]
        improved = axistool.Improvement(found.model, steps, "", {})
        curve = axistool.friction(CASE / "train-jog.csv", found.model)
        for result, name, value in (
            (compared, "barh", compared.channels["x_mm"].rms / compared.channels["x_mm"].floor),
            (improved, "barh", 1.2), (curve, "errorbar", curve.effort[0]), (found, "errorbar", 0),
            (axistool.design(found.model), "plot", 1.0),
            (axistool.residuals(found.model, CASE / "validate.csv", channel="w_rad_s"), "plot", None),
        ):
            axes = mock.MagicMock()
            self.assertIs(result.plot(axes), axes)
            drawn = [np.asarray(one, dtype=float) for call in getattr(axes, name).call_args_list for one in call.args
                     if not isinstance(one, str)]
            self.assertTrue(drawn)
            if value is not None:
                self.assertTrue(any(np.any(one == value) for one in drawn), (type(result), value, drawn))
        with mock.patch.dict(sys.modules, {"matplotlib.pyplot": None}):
            for result in (found, compared, improved, curve, axistool.Record.read(CASE / "train-jog.csv")):
                with self.assertRaisesRegex(axistool.UsageError, "python3-matplotlib"):
                    result.plot()


class Help(unittest.TestCase):
    def test_every_public_name_has_a_text_with_an_example(self) -> None:
        for name in axistool.__all__:
            one = getattr(axistool, name)
            if name == "Progress":  # a type alias
                continue
            self.assertIn(">>> ", one.__doc__ or "", name)
            for method, held in vars(one).items() if isinstance(one, type) else ():
                if not method.startswith("_") and (callable(held) or isinstance(held, (classmethod, property))):
                    self.assertTrue(getattr(one, method).__doc__, f"{name}.{method}")

    def test_its_examples_run(self) -> None:
        before, other, cogged = os.getcwd(), CASE.parent / "case-01", DATA / "drive-cases" / "single" / "case-00"
        with tempfile.TemporaryDirectory() as folder:
            for name, source in (("steps.csv", CASE / "train-steps.csv"), ("jog.csv", CASE / "train-jog.csv"),
                                 ("drive.toml", CASE / "model.toml"), ("x.toml", CASE / "model.toml"),
                                 ("y.toml", other / "model.toml"), ("y-jog.csv", other / "train-jog.csv"),
                                 ("y-valid.csv", other / "validate.csv"), ("z.toml", cogged / "model.toml"), ("z-jog.csv", cogged / "train-jog.csv"),
                                 ("scope.csv", LOGS / "sweep.csv")):
                shutil.copy(source, Path(folder) / name)
            shutil.copytree(other, Path(folder) / "cases" / "case-01")
            os.chdir(folder)
            try:
                for part in ("analysis", "board", "errors", "logs", "model", "record", "residuals", "results", "studies"):
                    module = importlib.import_module(f"axistool.{part}")
                    failed, tried = doctest.testmod(module, optionflags=doctest.ELLIPSIS)
                    self.assertEqual(failed, 0, part)
                    self.assertGreater(tried, 1, part)
            finally:
                os.chdir(before)


if __name__ == "__main__":
    unittest.main()
