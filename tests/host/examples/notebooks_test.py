#!/usr/bin/python3
"""The example notebooks run from top to bottom: in a kernel if nbclient and ipykernel are installed, else cell by cell
in this process. They contain no stored output, and every result at the end of a cell is a table."""

import ast
import json
import math
import os
import sys
import unittest
from pathlib import Path

try:
    import numpy  # noqa: F401
except ImportError:
    print("python3-numpy is missing", file=sys.stderr)
    sys.exit(77)

EXAMPLES = Path(os.environ["AXIS_TEST_DATA"]).parents[1] / "host" / "examples"
NOTEBOOKS = sorted(EXAMPLES.glob("*.ipynb"))
MOST_BYTES = 20_000


def code_cells(notebook: dict) -> list[str]:
    return ["".join(cell["source"]) for cell in notebook["cells"] if cell["cell_type"] == "code"]


def run_here(cells: list[str]) -> dict:
    """Runs cells without magics as a kernel does, and checks the displayed value of the last expression of each."""
    names: dict = {}
    for number, cell in enumerate(cells):
        body = ast.parse(cell).body
        last = body.pop() if body and isinstance(body[-1], ast.Expr) else None
        exec(compile(ast.Module(body, []), f"cell {number}", "exec"), names)
        if last is None:
            continue
        shown = eval(compile(ast.Expression(last.value), f"cell {number}", "eval"), names)
        if shown is not None and "<table>" not in shown._repr_html_():
            raise AssertionError(f"cell {number} shows no table")
    return names


class Notebooks(unittest.TestCase):
    def test_are_small_and_without_output(self) -> None:
        self.assertTrue(NOTEBOOKS)
        for path in NOTEBOOKS:
            self.assertLess(path.stat().st_size, MOST_BYTES, path.name)
            for cell in json.loads(path.read_text())["cells"]:
                self.assertFalse(cell.get("outputs"), path.name)

    def test_reach_the_effects_that_the_logs_hide(self) -> None:
        """tests/data/README.md states the truth of these logs."""
        os.chdir(EXAMPLES)
        names = run_here(code_cells(json.loads((EXAMPLES / "from-my-csv-to-my-model.ipynb").read_text())))
        cogging = names["better"].model.effect("cogging")
        harmonic, = cogging["harmonics"]
        self.assertAlmostEqual(cogging["period_mm"] / harmonic["order"], 1.25, delta=0.002)
        self.assertAlmostEqual(math.hypot(harmonic["cosine_Nm"], harmonic["sine_Nm"]), 0.156, delta=0.01)
        self.assertLess(names["after"].combined, 0.3 * names["before"].combined)

    def test_run_in_a_kernel(self) -> None:
        try:
            import ipykernel  # noqa: F401
            import nbclient
            import nbformat
        except ImportError:
            self.skipTest("python3-nbclient or python3-ipykernel is missing: the cells ran without a kernel")
        for path in NOTEBOOKS:
            notebook = nbformat.read(path, as_version=4)
            nbformat.validate(notebook)
            nbclient.NotebookClient(notebook, timeout=300, resources={"metadata": {"path": str(EXAMPLES)}}).execute()


if __name__ == "__main__":
    unittest.main()
