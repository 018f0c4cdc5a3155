#!/usr/bin/env python3
"""Typical logs of machines, analysed with the commands identify and diagnose.

The physics is programmed here in Python, independent of the simulator: small explicit steps, friction that holds until
the other torques exceed it, a measured current with noise, positions in encoder counts.
"""

import json
import math
import os
import random
import subprocess
import tempfile
import unittest
from pathlib import Path
from typing import Callable, Optional

AXISTOOL = os.environ["AXISTOOL"]


class Machine:
    """A motor with friction, external forces and optionally a load on a spring; in Nm or N, rad or m."""

    def __init__(
        self,
        inertia: float,
        friction: Callable[[float, float], float],  # magnitude, by speed and position
        pull: Callable[[float], float] = lambda position: 0.0,
        motor: Callable[[float, float], float] = lambda effort, position: effort,
        load: Optional[tuple[float, float, float, Callable[[float], float]]] = None,  # inertia, Hz, damping, friction
        gap: float = 0.0,  # free travel of the load
    ):
        self.inertia, self.friction, self.pull, self.motor, self.load = inertia, friction, pull, motor, load
        self.gap = gap

    def run(self, control: Callable[[int, float, float], float], period_s: float, rows: int, parts: int = 10):
        """(commanded torque, position) of every row; the torque is held until the next row."""
        step = period_s / parts
        position = speed = load_position = load_speed = 0.0
        log = []
        for row in range(rows):
            effort = control(row, position, speed)
            log.append((effort, position))
            for _ in range(parts):
                push = self.motor(effort, position) + self.pull(position)
                if self.load:
                    inertia, hertz, damping, friction = self.load
                    own = 2.0 * math.pi * hertz
                    twist = position - load_position
                    twist -= max(-0.5 * self.gap, min(0.5 * self.gap, twist))
                    spring = inertia * own * (own * twist + 2.0 * damping * (speed - load_speed))
                    push -= spring
                    load_speed = held(load_speed + step * spring / inertia, step * friction(load_speed) / inertia)
                    load_position += step * load_speed
                speed = held(speed + step * push / self.inertia, step * self.friction(speed, position) / self.inertia)
                position += step * speed
        return log


class CableChain:
    """A force that reverses within some travel (Dahl's model); in N and m."""

    def __init__(self, most: float, travel: float):
        self.most, self.travel = most, travel
        self.bent = self.last = 0.0  # -1 to 1; position

    def pull(self, position: float) -> float:
        step, self.last = position - self.last, position
        self.bent += step / self.travel * (1.0 - math.copysign(self.bent, self.bent * step))
        return -self.most * self.bent


def held(speed: float, friction: float) -> float:
    """The speed after friction has reduced its magnitude by at most `friction`."""
    return 0.0 if abs(speed) <= friction else speed - math.copysign(friction, speed)


def moves(seed: int, rows: int, period_s: float, reach: float, top: float) -> list[float]:
    """Positions of smooth moves to random places with short rests."""
    draw = random.Random(seed)
    path, here = [0.0] * int(0.2 / period_s), 0.0
    while len(path) < rows:
        there = draw.uniform(-reach, reach)
        duration = max(0.15, 1.5 * abs(there - here) / (top * draw.uniform(0.3, 1.0)))
        count = int(duration / period_s)
        for k in range(count):
            part = k / count
            path.append(here + (there - here) * (part - math.sin(2.0 * math.pi * part) / (2.0 * math.pi)))
        path += [there] * int(draw.uniform(0.05, 0.3) / period_s)
        here = there
    return path[:rows]


def follow(path: list[float], stiffness: float, damping: float, most: float):
    return lambda row, position, speed: max(-most, min(most, stiffness * (path[row] - position) - damping * speed))


def steps(seed: int, rows: int, period_s: float, most: float):
    draw = random.Random(seed)
    efforts: list[float] = []
    while len(efforts) < rows:
        efforts += [draw.choice([-1, 1]) * draw.uniform(0.15, 1.0) * most] * int(draw.uniform(0.5, 3.0) / period_s)
    return lambda row, position, speed: efforts[row]


class Log(unittest.TestCase):
    """A folder with a data sheet, records and models, and the commands on them."""

    def setUp(self) -> None:
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)

    def call(self, *arguments: str, code: int = 0) -> str:
        done = subprocess.run([AXISTOOL, *arguments], cwd=self.folder.name, capture_output=True, text=True)
        self.assertEqual(done.returncode, code, done.stderr)
        return done.stderr

    def sheet(self, per_ampere: float, encoder: float, period_s: float, linear: bool = False) -> None:
        unit = "m" if linear else "mm"
        constants = (
            f'kind = "linear"\nforce_constant_N_per_V = {per_ampere}\nforce_constant_N_per_A = {per_ampere}\n'
            if linear
            else f'kind = "rotary"\namplifier_gain_A_per_V = 1.0\ntorque_constant_Nm_per_A = {per_ampere}\nlead_mm_per_rad = 1.0\n'
        )
        text = (
            f'format = "axis-model/1"\nname = "logged"\n[drive]\n{constants}sample_period_s = {period_s}\n'
            f"[drive.dac]\nlimit_V = 100.0\n[drive.encoder]\nresolution_{unit} = {encoder}\n"
        )
        (Path(self.folder.name) / "sheet.toml").write_text(text)
        self.per_ampere, self.encoder, self.period_s, self.linear = per_ampere, encoder, period_s, linear

    def write(self, name: str, log: list[tuple[float, float]], noise_A: float, column: str = "i_A") -> None:
        draw = random.Random(name)
        rows = [f"t_s,{column},{'x_m' if self.linear else 'x_mm'}"]
        for row, (effort, position) in enumerate(log):
            current = effort / self.per_ampere + draw.gauss(0.0, noise_A)
            counted = self.encoder * round(position / self.encoder)
            rows.append(f"{row * self.period_s:.4f},{current:.6g},{counted:.9g}")
        header = f"# format: axis-record/1\n# sample_period_s: {self.period_s:g}\n"
        (Path(self.folder.name) / f"{name}.csv").write_text(header + "\n".join(rows) + "\n")

    def identified(self) -> dict:
        self.call("identify", "train.csv", "--drive", "sheet.toml", "-o", "model.toml", "--json", "identified.json")
        return json.loads((Path(self.folder.name) / "identified.json").read_text())

    def diagnosed(self) -> dict:
        self.call(
            "diagnose", "model.toml", "--train", "train.csv", "--validate", "judge.csv", "--json", "diagnosis.json"
        )
        return json.loads((Path(self.folder.name) / "diagnosis.json").read_text())

    def improved(self) -> str:
        self.call("improve", "model.toml", "--train", "train.csv", "--validate", "judge.csv", "-o", "improved.toml")
        return (Path(self.folder.name) / "improved.toml").read_text()

    def value(self, model: str, key: str) -> float:
        return float(next(line for line in model.splitlines() if line.startswith(f"{key} = ")).split("=")[1])


class LoggedMachines(Log):
    def test_an_arm_under_gravity(self) -> None:
        self.sheet(1.2, 2.0 * math.pi / 65536, 0.004)
        arm = Machine(0.25, lambda w, q: 1.1 + 0.5 * abs(w), lambda q: -4.0 * math.cos(q))
        for name, seed in (("train", 1), ("judge", 2)):
            path = moves(seed, 4000, 0.004, 1.2, 2.0)
            self.write(name, arm.run(follow(path, 80.0, 6.0, 15.0), 0.004, 4000, 20), 0.05)
        found = self.identified()
        self.assertAlmostEqual(found["parameters"]["J_kg_m2"]["value"], 0.25, delta=0.02)
        self.assertTrue(found["beside_travel"])
        diagnosis = self.diagnosed()
        self.assertEqual(diagnosis["verdict"]["effects"], ["cogging"])
        self.assertLess(diagnosis["error"]["combined"]["after"]["validate"], 2.0)

    def test_an_arm_whose_friction_falls_with_speed(self) -> None:
        self.sheet(1.0, 2.0 * math.pi / 40000, 0.002)
        arm = Machine(0.1, lambda w, q: 0.6 + 0.5 * math.exp(-abs(w) / 0.15) + 0.2 * abs(w), lambda q: -2.0 * math.sin(q))
        for name, seed in (("train", 21), ("judge", 22)):
            path = moves(seed, 7500, 0.002, 2.0, 2.0)
            self.write(name, arm.run(follow(path, 80.0, 6.0, 15.0), 0.002, 7500), 0.02)
        self.identified()
        # A flattening curve fits equally well if it may rise towards rest, which is Stribeck friction.
        diagnosis = self.diagnosed()
        self.assertEqual(sorted(diagnosis["verdict"]["effects"]), ["cogging", "stribeck"])
        self.assertLess(diagnosis["error"]["combined"]["after"]["validate"], 1.2)

    def test_a_vertical_axis_heavier_than_its_friction(self) -> None:
        self.sheet(0.8, 0.001, 0.004)
        axis = Machine(0.003, lambda w, q: 0.5 + 0.006 * abs(w), lambda q: -0.8)
        for name, seed in (("train", 3), ("judge", 4)):
            path = moves(seed, 4000, 0.004, 100.0, 40.0)
            self.write(name, axis.run(follow(path, 5.0, 0.3, 10.0), 0.004, 4000, 20), 0.04)
        found = self.identified()
        self.assertTrue(any("friction cannot drive the axis" in warning for warning in found["warnings"]))
        verdict = self.diagnosed()["verdict"]
        self.assertIn("constant_torque", verdict["effects"])
        self.assertNotIn("spring_torque", verdict["effects"])

    def test_a_screw_whose_preload_varies(self) -> None:
        self.sheet(35.0, 1e-6, 0.002, linear=True)
        screw = Machine(60.0, lambda v, x: 30.0 * (1.0 + 0.4 * math.sin(2.0 * math.pi * x / 0.35 + 1.0)) + 150.0 * abs(v))
        for name, seed in (("train", 5), ("judge", 6)):
            path = moves(seed, 7500, 0.002, 0.25, 0.4)
            self.write(name, screw.run(follow(path, 3e4, 1500.0, 400.0), 0.002, 7500), 0.05)
        self.identified()
        self.assertEqual(self.diagnosed()["verdict"]["effects"], ["position_dependent_friction"])
        self.assertAlmostEqual(self.value(self.improved(), "period_m"), 0.35, delta=0.01)

    def test_drag_with_the_square_of_the_speed(self) -> None:
        self.sheet(0.2, 2.0 * math.pi / 8000, 0.005)
        fan = Machine(0.003, lambda w, q: 0.05 + 2e-3 * abs(w) + 3e-5 * w * w)
        for name, seed in (("train", 7), ("judge", 8)):
            self.write(name, fan.run(steps(seed, 6000, 0.005, 1.2), 0.005, 6000, 20), 0.02)
        self.identified()
        # The current is logged half a row late, which is no dead time of the drive.
        self.assertEqual(self.diagnosed()["verdict"]["effects"], ["nonlinear_viscous"])

    def test_a_load_on_a_spring_with_friction_on_both_sides(self) -> None:
        self.sheet(1.0, 4.66e-6, 0.001, linear=True)
        drive = Machine(
            0.5, lambda v, x: 0.25 + 5.0 * abs(v), load=(0.25, 18.0, 0.03, lambda v: 0.15 + 3.0 * abs(v))
        )
        for name, lowest, step in (("train", 0.5, 1.1), ("judge", 0.7, 1.3)):
            draw = random.Random(name)
            waves = [(lowest + step * k, draw.uniform(0.0, 2.0 * math.pi)) for k in range(int((40.0 - lowest) / step))]

            def control(row: int, position: float, speed: float) -> float:
                angle = 2.0 * math.pi * 0.001 * row
                return 0.35 * sum(math.sin(angle * hertz + phase) for hertz, phase in waves) - 4.0 * position

            self.write(name, drive.run(control, 0.001, 10000), 0.0, "u_V")
        self.identified()
        diagnosis = self.diagnosed()
        self.assertEqual(diagnosis["verdict"]["effects"], ["compliance"])
        model = self.improved()
        share = self.value(model, "load_fraction")
        self.assertAlmostEqual(share, 1.0 / 3.0, delta=0.05)
        self.assertAlmostEqual(self.value(model, "resonance_Hz") * math.sqrt(1.0 - share), 18.0, delta=0.6)

    def test_a_belt_with_play_is_not_taken_for_a_spring_alone(self) -> None:
        self.sheet(0.1, 2.0 * math.pi / 20000, 0.001)
        pulley = (2e-4, 87.0, 0.045, lambda w: 0.01 + 1e-4 * abs(w))
        belt = Machine(2e-4, lambda w, q: 0.03 + 2e-4 * abs(w), load=pulley, gap=0.03)
        for name in ("train", "judge"):
            draw = random.Random(name)
            efforts: list[float] = []
            while len(efforts) < 12000:
                efforts += [draw.choice([-1, 1]) * draw.uniform(0.06, 0.2)] * int(draw.uniform(20, 150))
            log = belt.run(lambda row, position, speed: efforts[row] - 0.002 * position, 0.001, 12000)
            self.write(name, log, 0.0, "u_V")
        self.identified()
        verdict = self.diagnosed()["verdict"]
        self.assertTrue("backlash" in verdict["effects"] or verdict["status"] == "unexplained", verdict)

    def test_a_cable_chain_shows_over_the_travel_since_a_reversal(self) -> None:
        self.sheet(50.0, 1e-6, 0.002, linear=True)
        chain = CableChain(40.0, 0.02)
        axis = Machine(30.0, lambda v, x: 30.0 + 60.0 * abs(v), chain.pull)
        for name, seed in (("train", 23), ("judge", 24)):
            chain.bent = chain.last = 0.0
            path = moves(seed, 10000, 0.002, 0.5, 0.5)
            self.write(name, axis.run(follow(path, 4e4, 3000.0, 800.0), 0.002, 10000), 0.02)
        self.identified()
        verdict = self.diagnosed()["verdict"]
        self.assertEqual((verdict["status"], verdict.get("coordinate")), ("unexplained", "travel_since_reversal"))

    def test_a_measured_current_makes_no_effect(self) -> None:
        self.sheet(0.06, 2.0 * math.pi / 10000, 0.001)
        clean = Machine(1.5e-4, lambda w, q: 0.03 + 3e-4 * abs(w))
        for name, seed in (("train", 11), ("judge", 12)):
            path = moves(seed, 10000, 0.001, 50.0, 80.0)
            self.write(name, clean.run(follow(path, 0.8, 0.03, 4.0), 0.001, 10000), 0.03)
        self.identified()
        diagnosis = self.diagnosed()
        self.assertEqual(diagnosis["verdict"]["effects"], [])
        self.assertNotEqual(diagnosis["verdict"]["status"], "unexplained")
        self.assertLess(diagnosis["error"]["combined"]["after"]["validate"], 1.4)

    def test_an_angle_that_begins_again_each_turn(self) -> None:
        self.sheet(0.4, 2.0 * math.pi / 20000, 0.001)
        motor = Machine(0.004, lambda w, q: 0.3 + 0.008 * abs(w))
        path = moves(13, 6000, 0.001, 20.0, 25.0)
        log = motor.run(follow(path, 3.0, 0.15, 4.0), 0.001, 6000)
        self.write("train", [(effort, math.remainder(position, 2.0 * math.pi)) for effort, position in log], 0.01)
        said = self.call("identify", "train.csv", "--drive", "sheet.toml", "-o", "model.toml", code=9)
        self.assertIn("axistool import train.csv --unwrap x_mm=6.283185307 -o", said)
        self.call("import", "train.csv", "--unwrap", "x_mm=6.283185307", "-o", "whole.csv")
        os.replace(Path(self.folder.name) / "whole.csv", Path(self.folder.name) / "train.csv")
        self.assertAlmostEqual(self.identified()["parameters"]["J_kg_m2"]["value"], 0.004, delta=1e-4)


if __name__ == "__main__":
    unittest.main(verbosity=2)
