#!/usr/bin/python3
"""Exported models in MuJoCo: its inverse dynamics replays the effort of records, and what it lacks is what the export says.

Machines have one effect each beside inertia, viscous and Coulomb friction; their effort is written out here, nothing of it
is the program's. MuJoCo (@mujoco/mujoco of the npm registry) reads the exported file. Prints for each effect the effort
of the record, MuJoCo's, and the share of the squared effort that lies between them beside the share that export stated.
"""

import json
import math
import os
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

AXISTOOL = os.environ["AXISTOOL"]
PACKAGES = Path(os.environ["MUJOCO_PACKAGES"])
VERSION = "3.14.0"
KT, KA, LIMIT_V, LEAD, TS = 0.6, 1.2, 9.0, 1.5915494309189535, 1e-3
J, B, LEVEL = 0.0033, 0.007, 0.45
SKIPPED = 77
AT_REST = 1.0  # rad/s, as export counts: dry friction is undetermined at rest; MuJoCo's turns about within 0.2 rad/s

SHEET = f"""format = "axis-model/1"
name = "x"
[drive]
kind = "rotary"
amplifier_gain_A_per_V = {KA}
torque_constant_Nm_per_A = {KT}
lead_mm_per_rad = {LEAD!r}
sample_period_s = {TS}
[drive.dac]
limit_V = {LIMIT_V}
[[effect]]
kind = "inertia"
J_kg_m2 = {J}
[[effect]]
kind = "viscous"
B_Nm_s_per_rad = {B}
[[effect]]
kind = "coulomb"
positive_Nm = FORWARD
negative_Nm = BACKWARD
"""


def sign(w: float) -> float:
    return math.copysign(1.0, w)


# Torque of each effect by speed (rad/s) and travel (mm); its entry in a model; the effects that MJCF cannot express.
EFFECTS = {
    "nothing": (lambda w, x: 0.0, "", ()),
    "spring_torque": (lambda w, x: 0.03 * (x - 4.0), "stiffness_Nm_per_mm = 0.03\ncentre_mm = 4.0\n", ()),
    "constant_torque": (lambda w, x: 0.2, "torque_Nm = -0.2\n", ("constant_torque",)),
    "coulomb_asymmetry": (lambda w, x: 0.1, "", ("coulomb_asymmetry",)),
    "cogging": (lambda w, x: -0.15 * math.cos(2.0 * math.pi * x / 5.0), "period_mm = 5.0\ncosine_Nm = 0.15\nsine_Nm = 0.0\n",
                ("cogging",)),
    "nonlinear_viscous": (lambda w, x: sign(w) * 0.05 * (abs(w) / 10.0) ** 1.5,
                          "coefficient_Nm = 0.05\nexponent = 1.5\n", ("nonlinear_viscous",)),
    "stribeck": (lambda w, x: sign(w) * 0.3 * math.exp(-abs(w) / 6.0),
                 f"static_positive_Nm = {LEVEL + 0.3}\nstatic_negative_Nm = {-LEVEL - 0.3}\nomega1_positive_rad_s = 6.0\n"
                 "omega1_negative_rad_s = -6.0\nomega2_positive_rad_s = 6.0\nomega2_negative_rad_s = -6.0\n",
                 ("stribeck",)),
}


def motion() -> "list[tuple[float, float, float]]":
    """Angle (rad), speed and acceleration of a sum of three sines."""
    rows = []
    for k in range(8000):
        t, q, w, a = TS * k, 0.0, 0.0, 0.0
        for size, hertz in ((9.0, 0.31), (3.0, 0.83), (0.8, 2.1)):
            turn = 2.0 * math.pi * hertz
            q += size * math.sin(turn * t)
            w += size * turn * math.cos(turn * t)
            a -= size * turn * turn * math.sin(turn * t)
        rows.append((q, w, a))
    return rows


def packages() -> None:
    """Downloads MuJoCo from the registry once; skips without node, npm or network."""
    if shutil.which("node") is None or shutil.which("npm") is None:
        print("skipped: neither node nor npm is installed (make test-mujoco installs them)")
        sys.exit(SKIPPED)
    if (PACKAGES / "node_modules/@mujoco/mujoco/package.json").exists():
        return
    PACKAGES.mkdir(parents=True, exist_ok=True)
    done = subprocess.run(["npm", "install", "--prefix", str(PACKAGES), "--no-audit", "--no-fund", "--ignore-scripts",
                           "--fetch-retries=1", "--fetch-timeout=30000", f"@mujoco/mujoco@{VERSION}"], capture_output=True, text=True, check=False)
    if done.returncode != 0:
        print(f"skipped: npm does not get @mujoco/mujoco\n{done.stderr[-500:]}")
        sys.exit(SKIPPED)


def rms(values: "list[float]") -> float:
    return math.sqrt(sum(v * v for v in values) / len(values))


def replayed(name: str, folder: Path) -> bool:
    effort_of, fields, lacks = EFFECTS[name]
    rows = motion()
    asymmetry = 0.1 if name == "coulomb_asymmetry" else 0.0
    sheet = SHEET.replace("FORWARD", repr(LEVEL + asymmetry)).replace("BACKWARD", repr(-LEVEL + asymmetry))
    (folder / "x.toml").write_text(sheet + (f'[[effect]]\nkind = "{name}"\n{fields}' if fields else ""))
    effort = [J * a + B * w + LEVEL * sign(w) + effort_of(w, LEAD * q) for q, w, a in rows]
    text = "# format: axis-record/1\n# drive: x\nt_s,i_A,x_mm,w_rad_s\n"
    text += "".join(f"{TS * k:.6g},{effort[k] / KT!r},{LEAD * q!r},{w!r}\n" for k, (q, w, _) in enumerate(rows))
    (folder / "x.csv").write_text(text)
    (folder / "motion").write_text("".join(f"{q!r} {w!r} {a!r}\n" for q, w, a in rows))
    told = json.loads(subprocess.run([AXISTOOL, "export", "x.toml", "--to", "mjcf", "-o", "x.xml", "--record", "x.csv",
                                      "--json", "-"], cwd=folder, capture_output=True, text=True, check=True).stdout)
    mujoco = json.loads(subprocess.run(["node", str(Path(__file__).with_name("replay.mjs")), "x.xml", "motion",
                                        str(PACKAGES)], cwd=folder, capture_output=True, text=True, check=True).stdout)
    moving = [k for k, (_, w, _) in enumerate(rows) if abs(w) > AT_REST]
    between = rms([effort[k] - mujoco["torques"][k] for k in moving]) ** 2 / rms([effort[k] for k in moving]) ** 2
    stated = sum(one["share"] for one in told["not_expressed"])
    print(f"{name:<20} {rms(effort):8.4f} {rms(mujoco['torques']):8.4f} {100 * between:9.4f} {100 * stated:9.4f}  "
          f"{', '.join(one['kind'] for one in told['not_expressed'])}")
    return (tuple(one["kind"] for one in told["not_expressed"]) == lacks
            and abs(between - stated) <= 0.1 * stated + 1e-4
            and math.isclose(mujoco["limit"], KA * LIMIT_V) and math.isclose(mujoco["gear"], KT))


def main() -> None:
    packages()
    print(f"{'effect':<20} {'Nm':>8} {'MuJoCo':>8} {'between %':>9} {'stated %':>9}  not expressed")
    with tempfile.TemporaryDirectory() as folder:
        wrong = [name for name in EFFECTS if not replayed(name, Path(folder))]
    if wrong:
        sys.exit(f"MuJoCo does not replay what export states: {', '.join(wrong)}")


if __name__ == "__main__":
    main()
