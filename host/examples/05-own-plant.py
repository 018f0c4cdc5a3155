#!/usr/bin/env python3
"""Your own machine for the simulated board (axis-plant/1): a screw with friction and cogging. README.md has a command
to try it."""
import math
import random
import sys

KA_KT, J, B, LEAD = 3.1, 0.0081, 0.031, 1.5915494309189535  # Nm/V, kg m^2, Nm s/rad, mm/rad
COULOMB, STATIC, FADE, COGGING, PITCH = 2.1, 2.6, 1.5, 0.6, 4.0  # Nm, Nm, rad/s, Nm, mm
STEPS = 20  # integration steps per period


def advance(x, w, volts, dt):
    drive = KA_KT * volts + COGGING * math.sin(2 * math.pi * x / PITCH)
    dry = COULOMB + (STATIC - COULOMB) * math.exp(-((w / FADE) ** 2))
    if w == 0 and abs(drive) <= STATIC:
        return x, 0.0
    way = math.copysign(1, w if w else drive)
    new = w + dt / J * (drive - B * w - dry * way)
    new = 0.0 if w * new < 0 else new  # it stops before it reverses
    return x + LEAD * dt * (w + new) / 2, new


_, axes, period = sys.stdin.readline().split()
print("ready", flush=True)
state = [(0.0, 0.0)] * int(axes)
for line in sys.stdin:
    k, *volts = line.split()
    for i, u in enumerate(volts):
        for _ in range(STEPS):
            state[i] = advance(*state[i], 0.0 if u == "off" else float(u), float(period) / STEPS)
    print(k, *(f"{x} {w + random.gauss(0, 0.2)}" for x, w in state), flush=True)
