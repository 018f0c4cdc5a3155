#!/usr/bin/python3
"""Maximum likelihood of a rigid drive with Coulomb friction on EMPS, for comparison with `identify --for`: Kalman filter
with states position, speed and force noise; the noise decays by a factor a sample (AR(1), as in the judge's evidence).
Mass, friction, decay and both variances are free. Arguments: record of DATA_EMPS.mat (t_s, u_V, x_m; `axistool
import`), model to write. Takes some minutes."""

import math
import sys

import numpy as np

PERIOD_S, FORCE_N_PER_V = 1e-3, 35.1506518
BLEND_M_S = 2e-3  # speed below which the sign of the friction is uncertain

MODEL = """format = "axis-model/1"
name = "EMPS"
[drive]
kind = "linear"
force_constant_N_per_V = {gain}
sample_period_s = 0.001
[drive.dac]
resolution_V = 0.0003
limit_V = 10.0
[drive.encoder]
resolution_m = 5e-8
[[effect]]
kind = "inertia"
M_kg = {mass}
[[effect]]
kind = "viscous"
B_N_s_per_m = {viscous}
[[effect]]
kind = "coulomb"
positive_N = {forward}
negative_N = -{backward}
"""


def read(path: str) -> tuple[np.ndarray, np.ndarray]:
    with open(path, encoding="utf-8") as file:
        rows = [line for line in file if not line.startswith("#")][1:]
    table = np.array([[float(field) for field in line.split(",")] for line in rows])
    return table[:, 1], table[:, 2]


def friction_signs(x: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Share of forward and of backward friction, from the speed smoothed over 20 ms."""
    window = np.hanning(21)
    smooth = np.convolve(np.pad(x, 10, "edge"), window / window.sum(), "valid")
    share = np.clip(np.gradient(smooth, PERIOD_S) / BLEND_M_S, -1.0, 1.0)
    return np.maximum(share, 0.0), np.maximum(-share, 0.0)


def stationary(A: np.ndarray, force_variance: float, sensor_variance: float) -> tuple[np.ndarray, float]:
    """Gain of the filter and variance of its innovations."""
    P = np.eye(3) * 1e-2
    for _ in range(20000):
        after = A @ (P - np.outer(P[:, 0], P[0]) / (P[0, 0] + sensor_variance)) @ A.T
        after[2, 2] += force_variance
        done = np.max(np.abs(after - P)) <= 1e-9 * np.max(np.abs(after))
        P = after
        if done:
            break
    variance = P[0, 0] + sensor_variance
    return P[:, 0] / variance, variance


class Likelihood:
    def __init__(self, path: str) -> None:
        self.u, self.x = read(path)
        self.forward, self.backward = friction_signs(self.x)

    def negative_log(self, p: np.ndarray) -> float:
        """p: ln mass, viscous, forward, backward, ln force variance, ln sensor variance, ln(1 - decay)."""
        mass, viscous, decay = math.exp(p[0]), p[1], 1.0 - math.exp(p[6])
        pole = -viscous / mass
        e = math.exp(pole * PERIOD_S)
        a12 = (e - 1.0) / pole
        b1, b2 = (a12 - PERIOD_S) / pole / mass, a12 / mass
        A = np.array([[1.0, a12, -b1], [0.0, e, -b2], [0.0, 0.0, decay]])
        gain, variance = stationary(A, math.exp(p[4]), math.exp(p[5]))
        force = (FORCE_N_PER_V * self.u - p[2] * self.forward + p[3] * self.backward).tolist()
        x, v, d = self.x[0], 0.0, 0.0
        squares = 0.0
        for k, seen in enumerate(self.x[1:].tolist()):
            error = seen - (x + a12 * v - b1 * d + b1 * force[k])
            squares += error * error
            x, v, d = seen - error + gain[0] * error, e * v - b2 * d + b2 * force[k] + gain[1] * error, decay * d + gain[2] * error
        return 0.5 * (len(self.x) * math.log(variance) + squares / variance)


def lowest(f, start: np.ndarray, steps: list[float], rounds: int) -> np.ndarray:
    """Nelder and Mead's simplex."""
    points = [start] + [start + step * unit for step, unit in zip(steps, np.eye(len(start)))]
    values = [f(point) for point in points]
    for _ in range(rounds):
        order = np.argsort(values)
        points, values = [points[i] for i in order], [values[i] for i in order]
        if values[-1] - values[0] < 1e-3:
            break
        centre = np.mean(points[:-1], axis=0)
        tried = 2.0 * centre - points[-1]
        value = f(tried)
        if value < values[0]:
            farther = 3.0 * centre - 2.0 * points[-1]
            value_farther = f(farther)
            points[-1], values[-1] = (farther, value_farther) if value_farther < value else (tried, value)
        elif value < values[-2]:
            points[-1], values[-1] = tried, value
        else:
            nearer = 0.5 * (centre + (tried if value < values[-1] else points[-1]))
            value_nearer = f(nearer)
            if value_nearer < min(value, values[-1]):
                points[-1], values[-1] = nearer, value_nearer
            else:
                points = [points[0]] + [0.5 * (points[0] + point) for point in points[1:]]
                values = [values[0]] + [f(point) for point in points[1:]]
    return points[0]


def main() -> None:
    likelihood = Likelihood(sys.argv[1])
    start = np.array([math.log(95.0), 200.0, 17.0, 23.0, math.log(0.05), math.log(1e-14), math.log(0.02)])
    found = lowest(likelihood.negative_log, start, [0.03, 20.0, 3.0, 3.0, 2.0, 1.0, 1.0], 600)
    found = lowest(likelihood.negative_log, found, [0.01, 5.0, 1.0, 1.0, 0.3, 0.3, 0.5], 400)
    mass, decay = math.exp(found[0]), 1.0 - math.exp(found[6])
    print(f"mass {mass:.3f} kg, viscous {found[1]:.2f} N s/m, Coulomb {found[2]:.3f} and {found[3]:.3f} N; noise: decay "
          f"{decay:.3f} a sample, {math.exp(0.5 * found[4]):.3g} N a sample; -ln p {likelihood.negative_log(found):.1f}")
    with open(sys.argv[2], "w", encoding="utf-8") as file:
        file.write(MODEL.format(gain=FORCE_N_PER_V, mass=mass, viscous=found[1], forward=found[2], backward=found[3]))


if __name__ == "__main__":
    main()
