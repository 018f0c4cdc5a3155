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

try:
    import numpy as np
except ImportError:
    print("python3-numpy is missing", file=sys.stderr)
    sys.exit(77)

import axistool

CASE = Path(os.environ["AXIS_TEST_DATA"]) / "drive-cases" / "none" / "case-00"


class Frame:
    """What of a pandas DataFrame is used; pandas itself is no package that the tests need."""

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


class Notebook(unittest.TestCase):
    def test_results_are_tables(self) -> None:
        record = axistool.Record.read(CASE / "train-steps.csv")
        found = axistool.identify(record, drive=CASE / "model.toml")
        compared = axistool.compare(found.model, CASE / "validate.csv")
        for result, word in ((record, "u_V"), (found, "J_kg_m2"), (compared, "x_mm")):
            self.assertIn("<table>", result._repr_html_())
            self.assertIn(word, result._repr_html_())

    def test_examples_in_the_help_run(self) -> None:
        before = os.getcwd()
        with tempfile.TemporaryDirectory() as folder:
            for name, source in (("steps.csv", "train-steps.csv"), ("jog.csv", "train-jog.csv"),
                                 ("drive.toml", "model.toml"), ("x.toml", "model.toml")):
                shutil.copy(CASE / source, Path(folder) / name)
            os.chdir(folder)
            try:
                for part in ("record", "analysis", "residuals"):
                    module = importlib.import_module(f"axistool.{part}")
                    failed, tried = doctest.testmod(module)
                    self.assertEqual(failed, 0, part)
                    self.assertGreater(tried, 1, part)
            finally:
                os.chdir(before)


if __name__ == "__main__":
    unittest.main()
