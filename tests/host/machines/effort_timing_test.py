#!/usr/bin/env python3
"""Time at which a logged current acts: loggers that average over a period beginning before or after the row.

The machine has no hidden effect; its logs differ only in this time and in the current's noise. Diagnose must find the
time, the same parameters and the same verdict, with intervals that cover the truth as often as they claim. SEEDS=200
tests the intervals with 200 draws of the noise.
"""

import json
import math
import os
import random
import subprocess
import unittest
from pathlib import Path

import logged_machines_test as logged

SEEDS = int(os.environ.get("SEEDS", "16"))
TRUTH = {"J_kg_m2": 0.004, "B_Nm_s_per_rad": 0.008, "positive_Nm": 0.3, "negative_Nm": -0.3}
NOISE_A = 0.02
# samples: half of one, minus half of an integration step of 1/40, which moves the machine at the step's final speed
HELD = 0.4875


def pushes(seed: int, rows: int):
    """Torques of ±0.5 to ±1.5 Nm, each for 50 to 250 ms, with a weak spring that keeps the axis in place."""
    draw = random.Random(seed)
    efforts: list[float] = []
    while len(efforts) < rows:
        efforts += [draw.choice([-1, 1]) * draw.uniform(0.5, 1.5)] * draw.randint(50, 250)
    return lambda row, position, speed: efforts[row] - 0.02 * position


def shifted(log, samples):
    """The log if each row holds the mean torque of the period that begins `samples` samples after the row."""
    whole, part = math.floor(samples), samples - math.floor(samples)
    
    def at(row: int) -> float:
        return log[max(0, min(len(log) - 1, row))][0]

    return [((1.0 - part) * at(k + whole) + part * at(k + whole + 1), log[k][1]) for k in range(len(log))]


class EffortTiming(logged.Log):
    @classmethod
    def setUpClass(cls) -> None:
        clean = logged.Machine(TRUTH["J_kg_m2"], lambda w, q: TRUTH["positive_Nm"] + TRUTH["B_Nm_s_per_rad"] * abs(w))
        cls.logs = {
            name: clean.run(pushes(seed, 6000), 0.001, 6000, 40)
            for name, seed in (("train", 31), ("judge", 32))
        }

    def setUp(self) -> None:
        super().setUp()
        self.sheet(0.4, 2.0 * math.pi / 20000, 0.001)

    def held(self, estimate: dict, truth: float) -> bool:
        return estimate["ci95"][0] <= truth <= estimate["ci95"][1]

    def test_any_instant_gives_the_same_parameters_and_verdict(self) -> None:
        quarters = range(-4, 9) if SEEDS >= 200 else (-4, -2, 0, 3, 8)
        for quarter in quarters:
            with self.subTest(samples=0.25 * quarter):
                for name, log in self.logs.items():
                    self.write(name, shifted(log, 0.25 * quarter), NOISE_A)
                found = self.identified()
                self.assertAlmostEqual(found["effort_timing"]["samples"], HELD + 0.25 * quarter, delta=0.1)
                for name, truth in TRUTH.items():
                    estimate = found["parameters"][name]
                    half = 0.5 * (estimate["ci95"][1] - estimate["ci95"][0])
                    self.assertAlmostEqual(estimate["value"], truth, delta=1.5 * half, msg=name)
                diagnosis = self.diagnosed()
                self.assertIn(diagnosis["verdict"]["status"], ("adequate", "parameters"))

    def test_an_error_of_the_encoder_does_not_move_the_instant(self) -> None:
        # In a fit of inertia and friction alone it would, and the residual at steps of the torque would look like a
        # spring. It would also bias the inertia, and with it the amplitude of the error.
        for name, log in self.logs.items():
            read = [(effort, x + 0.01 * math.sin(4.0 * x + 1.0)) for effort, x in log]
            self.write(name, shifted(read, -0.25), NOISE_A)
        self.identified()
        diagnosis = self.diagnosed()
        self.assertEqual(diagnosis["verdict"]["effects"], ["encoder_cyclic_error"])
        self.assertAlmostEqual(diagnosis["effort_timing"]["samples"], HELD - 0.25, delta=0.05)
        self.assertLess(diagnosis["error"]["combined"]["after"]["validate"], 3.0)

    def test_intervals_hold_the_truth(self) -> None:
        # Except the inertia, whose interval of 0.03 % is narrower than the bias by filters and differences.
        names = ["B_Nm_s_per_rad", "positive_Nm", "negative_Nm", "effort_timing"]
        hits = dict.fromkeys(names, 0)
        for seed in range(SEEDS):
            self.write(f"noise{seed}", self.logs["train"], NOISE_A)
            folder = Path(self.folder.name)
            os.replace(folder / f"noise{seed}.csv", folder / "train.csv")
            found = self.identified()
            for name in names[:-1]:
                hits[name] += self.held(found["parameters"][name], TRUTH[name])
            self.assertAlmostEqual(found["parameters"]["J_kg_m2"]["value"], TRUTH["J_kg_m2"], delta=1e-3 * 0.004)
            hits["effort_timing"] += self.held(found["effort_timing"], HELD)
        print(SEEDS, hits, flush=True)
        least = round(0.93 * SEEDS) if SEEDS >= 200 else SEEDS - 3  # of 16, at most 3 missed: 99 %
        for name in names:
            self.assertGreaterEqual(hits[name], least, name)


if __name__ == "__main__":
    unittest.main(verbosity=2)
