#!/usr/bin/env python3
"""Machines independent of the simulator, for the simulated board (axis-plant/1): own_plant.py KIND [SEED]

A screw with friction, in Nm, kg m^2, rad/s and mm; KIND is what it hides: nothing, cogging, weight, delay.
"""
import collections
import math
import random
import sys

KA_KT, J, B, LEAD = 3.0, 0.008, 0.03, 1.6
COULOMB, STATIC, FADE = 2.0, 2.3, 1.5
STEPS = 10  # integration steps per period
kind = sys.argv[1]
noise = random.Random(int(sys.argv[2]) if len(sys.argv) > 2 else 1)
COGGING = 0.45 if kind == "cogging" else 0.0
WEIGHT = 0.8 if kind == "weight" else 0.0
LATE = 2 if kind == "delay" else 0  # periods


def advance(x, w, volts, dt):
    drive = KA_KT * volts - WEIGHT + (COGGING * math.sin(2 * math.pi * x / 4.0) if COGGING else 0.0)
    if w == 0 and abs(drive) <= STATIC:
        return x, 0.0
    dry = COULOMB + (STATIC - COULOMB) * math.exp(-((w / FADE) ** 2))
    way = math.copysign(1, w if w else drive)
    new = w + dt / J * (drive - B * w - dry * way)
    new = 0.0 if w * new < 0 else new
    return x + LEAD * dt * (w + new) / 2, new


_, axes, period = sys.stdin.readline().split()
print("ready", flush=True)
state = [(0.0, 0.0)] * int(axes)
late = [collections.deque([0.0] * LATE) for _ in state]
for line in sys.stdin:
    k, *volts = line.split()
    for i, u in enumerate(volts):
        late[i].append(0.0 if u == "off" else float(u))
        now = late[i].popleft()
        for _ in range(STEPS):
            state[i] = advance(*state[i], now, float(period) / STEPS)
    print(k, *(f"{x} {w + noise.gauss(0, 0.2)}" for x, w in state), flush=True)
