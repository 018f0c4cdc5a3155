"""A drive with a table, with independent physics: motor and table connected by a spring, a gap or both, Coulomb
friction on both sides, a screw with pitch errors, a motor encoder and a scale with errors of their own, and thermal
growth. Integrated here, in N, kg, mm and s, without code of the program."""

import math
import random

PERIOD = 1e-3  # s, of control and log
TURN = 10.0  # mm per motor turn
LEAD = TURN / (2.0 * math.pi)  # mm/rad
KT = 0.48  # Nm/A
FORCE_PER_A = KT / (1e-3 * LEAD)  # N
KINDS = ("backlash", "compliance", "pitch_error", "encoder_cyclic_error scale", "encoder_cyclic_error motor",
         "thermal_growth")

SHEET = f"""format = "axis-model/1"
name = "x"

[drive]
kind = "rotary"
torque_constant_Nm_per_A = {KT}
lead_mm_per_rad = {LEAD!r}
sample_period_s = {PERIOD}

[drive.encoder]
resolution_mm = RESOLUTION
"""


class Machine:
    """One machine: the parameters of the connection between motor and table."""

    def __init__(self, seed: int, causes: "dict[str, bool] | None" = None) -> None:
        draw = random.Random(seed)
        self.draw = draw
        self.motor, self.table = draw.uniform(600.0, 1800.0), draw.uniform(250.0, 900.0)  # kg
        self.table_friction, self.motor_friction = draw.uniform(250.0, 900.0), draw.uniform(0.0, 60.0)  # N
        self.viscous = draw.uniform(500.0, 2500.0)  # N s/m, on the table
        self.resolution = draw.choice((1e-4, 2e-4, 5e-4))
        self.scale_resolution = draw.choice((1e-4, 5e-4, 1e-3))
        self.delay_s = draw.choice((0.0, 0.0, 2e-4))
        few = draw.choice((0, 1, 1, 2, 2, 3))
        self.causes = set(causes if causes is not None else draw.sample(KINDS, few))
        size = draw.uniform
        self.gap = math.exp(size(math.log(0.004), math.log(0.06)))  # mm
        self.stiffness = math.exp(size(math.log(4e4), math.log(2e5)))  # N/mm
        self.lead_error = draw.choice((-1.0, 1.0)) * size(15.0, 120.0)  # um/m
        self.bends = [(size(1.0, 5.0) * 1e-3, size(60.0, 300.0), size(0.0, 6.28)) for _ in range(3)]  # mm, mm, rad
        self.scale_error = (size(0.6, 3.0) * 1e-3, draw.choice((0.43, 0.77, 1.55, 2.3, 4.1)), size(0.0, 6.28))
        self.motor_error = (size(1.0, 6.0) * 1e-3, TURN / draw.choice((1, 1, 2, 4)), size(0.0, 6.28))
        self.growth = (draw.choice((-1.0, 1.0)) * size(6.0, 30.0) * 1e-3, size(5.0, 40.0))  # mm, s
        for name, neutral in (("backlash", "gap"),):
            if name not in self.causes:
                setattr(self, neutral, 0.0)

    def pitch(self, x: float) -> float:
        if "pitch_error" not in self.causes:
            return 0.0
        return 1e-6 * self.lead_error * x + sum(a * math.sin(2.0 * math.pi * x / l + p) for a, l, p in self.bends)

    def wave(self, which: str, x: float) -> float:
        if f"encoder_cyclic_error {which}" not in self.causes:
            return 0.0
        amplitude, period, phase = self.scale_error if which == "scale" else self.motor_error
        return amplitude * math.sin(2.0 * math.pi * x / period + phase)

    def grown(self, t: float) -> float:
        if "thermal_growth" not in self.causes:
            return 0.0
        return -self.growth[0] * math.expm1(-t / self.growth[1])

    def sheet(self) -> str:
        return SHEET.replace("RESOLUTION", repr(self.resolution))

    def record(self, seconds: float, run: int) -> str:
        """A record of moves over the travel; `run` selects the motion."""
        draw = random.Random(self.draw.random() + run)
        reference = moves(seconds, draw)
        rows = ["# format: axis-record/1", "# drive: x", f"# sample_period_s: {PERIOD}", "t_s,i_A,x_mm,x2_mm"]
        zero = draw.uniform(-5.0, 5.0)
        body = Body(self)
        integral, past = 0.0, []
        late = int(round(self.delay_s / (PERIOD / body.substeps)))
        for k in range(1, len(reference) - 1):
            x_seen = math.floor((body.x + self.wave("motor", body.x)) / self.resolution) * self.resolution
            wanted = (reference[k + 1] - reference[k - 1]) / (2.0 * PERIOD)
            push = (reference[k + 1] - 2.0 * reference[k] + reference[k - 1]) / PERIOD**2
            error = reference[k] - x_seen
            integral += error * PERIOD
            mass = 1e-3 * (self.motor + self.table)
            force = mass * (push + 2.0 * 0.8 * 120.0 * (wanted - body.v) + 120.0**2 * (error + 15.0 * integral))
            force = max(-8000.0, min(8000.0, force))
            table = body.trail[-1 - late] if late < len(body.trail) else body.y
            t = k * PERIOD
            x2 = table + self.pitch(table) + self.wave("scale", table) + self.grown(t) + draw.gauss(0.0, 5e-5)
            x2 = math.floor((x2 + zero) / self.scale_resolution) * self.scale_resolution
            rows.append(f"{t:.6g},{force / FORCE_PER_A + draw.gauss(0.0, 0.01):.5f},{x_seen:.7g},{x2:.7g}")
            for _ in range(body.substeps):
                body.step(force)
        return "\n".join(rows) + "\n"


def moves(seconds: float, draw: random.Random) -> "list[float]":
    """Moves from target to target with speed ramps, at several speeds; the first is over the whole travel and back."""
    path, x = [0.0] * 100, 0.0
    targets = [(-100.0, 150.0), (100.0, 60.0), (-100.0, 60.0)]
    while len(path) < seconds / PERIOD:
        target, top = targets.pop(0) if targets else (draw.uniform(-100.0, 100.0), draw.choice((8.0, 25.0, 80.0, 180.0)))
        if abs(target - x) > 4.0 * top:
            target = x + math.copysign(4.0 * top, target - x)
        ramp, start, way, length = draw.choice((400.0, 1000.0, 2500.0)), x, math.copysign(1.0, target - x), abs(target - x)
        gone, speed = 0.0, 0.0
        while gone < length - 1e-4:
            speed = max(min(speed + ramp * PERIOD, top, math.sqrt(2.0 * ramp * (length - gone))), 0.05)
            gone = min(gone + speed * PERIOD, length)
            path.append(start + way * gone)
        x = path[-1]
        path += [x] * draw.choice((10, 60, 150))
    return path


def slowed(speed: float, by: float) -> float:
    return math.copysign(max(abs(speed) - by, 0.0), speed)


class Body:
    """Motor (x, v) and table (y, w), mm and mm/s."""

    def __init__(self, machine: Machine) -> None:
        self.m = machine
        self.springy = "compliance" in machine.causes
        self.substeps = 10 if self.springy else 5
        self.dt = PERIOD / self.substeps
        self.x = self.v = self.y = self.w = 0.0
        self.side = 0 if machine.gap > 0.0 else 1
        self.trail = [0.0]

    def step(self, force: float) -> None:
        m, dt = self.m, self.dt
        motor, table = 1e-3 * m.motor, 1e-3 * m.table  # N per mm/s^2
        drag = m.table_friction + 1e-3 * m.viscous * abs(self.w)
        half = 0.5 * m.gap
        if self.springy:
            twist = self.x - self.y
            bent = twist - half if twist > half else twist + half if twist < -half else 0.0
            pull = m.stiffness * bent
            if bent != 0.0:
                damped = pull + 0.12 * math.sqrt(m.stiffness * table) * (self.v - self.w)
                pull = damped if m.gap == 0.0 or damped * bent > 0.0 else 0.0
            self.v = slowed(self.v + dt * (force - pull) / motor, dt * m.motor_friction / motor)
            self.w = slowed(self.w + dt * pull / table, dt * drag / table)
            self.x += dt * self.v
            self.y += dt * self.w
        elif self.side != 0:
            both = motor + table
            before = self.v
            self.v = slowed(self.v + dt * force / both, dt * (drag + m.motor_friction) / both)
            self.w = self.v
            self.x += dt * self.v
            self.y += dt * self.v
            if m.gap > 0.0:
                if self.v != 0.0:
                    contact = table * (self.v - before) / dt + math.copysign(drag, self.v)
                else:
                    contact = force + self.side * m.motor_friction
                if contact * self.side < 0.0:
                    self.side = 0
        else:
            self.v = slowed(self.v + dt * force / motor, dt * m.motor_friction / motor)
            self.w = slowed(self.w, dt * drag / table)
            self.x += dt * self.v
            self.y += dt * self.w
            if abs(self.x - self.y) >= half:
                self.side = 1 if self.x > self.y else -1
                self.x = self.y + self.side * half
                self.v = self.w = (motor * self.v + table * self.w) / (motor + table)
        self.trail.append(self.y)
        if len(self.trail) > 50:
            del self.trail[:-20]
