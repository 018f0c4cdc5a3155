#!/usr/bin/env python3
"""commission-bench: `axistool commission` on simulated machines with unknown hidden effects.

bench.py AXISTOOL MACHINES.json [--only NAME …] [--jobs N] [--keep FOLDER] [--check]

Prints one line for each machine: the result; the following error before, after, and with a controller designed from the
true parameters, for the same motion on the same machine; minutes of motion and seconds of computing.
"""
import argparse
import concurrent.futures
import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

MOST_OVER_TRUTH, MOST_MOTION_S, MOST_COMPUTING_S = 1.5, 360.0, 180.0
SURE = 0.95


def toml(value):
    return f'"{value}"' if isinstance(value, str) else repr(value)


def effect(entry):
    return "[[effect]]\n" + "".join(f"{key} = {toml(value)}\n" for key, value in entry.items())


def data_sheet(base, torque):
    drive = dict(base["drive"])
    metres = drive["kind"] == "linear"
    drive["force_constant_N_per_V" if metres else "torque_constant_Nm_per_A"] *= torque
    text = 'format = "axis-model/1"\nname = "x"\n[drive]\n' + "".join(f"{k} = {toml(v)}\n" for k, v in drive.items())
    text += "sample_period_s = 0.001\n[drive.dac]\nresolution_V = 0.00030517578125\nlimit_V = 10.0\n[drive.encoder]\n"
    text += f"resolution_{'m' if metres else 'mm'} = {base['encoder']}\n"
    return text + (f"[drive.tach]\nnoise_variance_rad2_s2 = {base['tach']}\n" if "tach" in base else "")


def one_level(base):
    """The data sheet states that friction is equal in both directions; otherwise a weight would count as Coulomb
    friction."""
    return effect({"kind": "coulomb", "level_N" if base["drive"]["kind"] == "linear" else "level_Nm": base["coulomb"][0]})


def machine(base, hidden):
    metres = base["drive"]["kind"] == "linear"
    force, speed = ("N", "m_s") if metres else ("Nm", "rad_s")
    inertia, viscous = ("M_kg", "B_N_s_per_m") if metres else ("J_kg_m2", "B_Nm_s_per_rad")
    dry, static, omega = base["coulomb"], base["static"], base["omega"]
    effects = [
        {"kind": "inertia", inertia: base[inertia]},
        {"kind": "viscous", viscous: base[viscous]},
        {"kind": "coulomb", f"positive_{force}": dry[0], f"negative_{force}": -dry[1]},
        {"kind": "stribeck", f"static_positive_{force}": static[0], f"static_negative_{force}": -static[1],
         f"omega1_positive_{speed}": omega[0], f"omega1_negative_{speed}": -omega[0],
         f"omega2_positive_{speed}": omega[1], f"omega2_negative_{speed}": -omega[1]},
    ]
    return data_sheet(base, 1.0) + "".join(effect(entry) for entry in effects + hidden)


def run(axistool, folder, arguments):
    """The completed run and its processor time in seconds, independent of other load on the computer."""
    with tempfile.TemporaryFile("w+") as told:
        process = subprocess.Popen([axistool, "commission", "x", "-o", folder, "--yes", *arguments], stdout=subprocess.DEVNULL,
                                   stderr=told)
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
        told.seek(0)
        return subprocess.CompletedProcess(process.args, process.returncode, "", told.read()), usage.ru_utime + usage.ru_stime


def commission_plant(axistool, base, entry, folder):
    """A machine simulated by another program; its true parameters are unknown here."""
    sheet, out = folder / "sheet.toml", folder / "found"
    alike = entry["sheet"].get("one_level")
    sheet.write_text(data_sheet(base, entry["sheet"]["torque"]) + (one_level(base) if alike else ""))
    plant = f"python3 {pathlib.Path(__file__).with_name('own_plant.py')} {entry['plant']} {entry['seed']}"
    done, took = run(axistool, str(out), ["--plant", plant, "--drive", str(sheet), "--box", base["box"]])
    result = {"name": entry["name"], "hides": entry["hides"], "computing_s": took}
    if done.returncode != 0:
        return {**result, "failed": (done.stderr or done.stdout).strip().splitlines()[-1]}
    state = json.loads((out / "commission.json").read_text())
    ladder = json.loads((out / "improvement.json").read_text())["ladder"]
    return {**result, "verdict": state["verdict"], "added": (state.get("decided") or []) + [k for rung in ladder for k in rung["added"]],
            "error": state["following_error_um"], "truth_um": None, "kept": state["kept"], "motion_s": state["motion_s"]}


def commission(axistool, base, entry, folder):
    if "plant" in entry:
        return commission_plant(axistool, base, entry, folder)
    truth, sheet, out = folder / "truth.toml", folder / "sheet.toml", folder / "found"
    base = {**base, **entry.get("base_changes", {})}
    truth.write_text(machine(base, entry["hides"]))
    alike = entry["sheet"].get("one_level")
    sheet.write_text(data_sheet(base, entry["sheet"]["torque"]) + (one_level(base) if alike else ""))
    common = ["--sim", str(truth), "--seed", str(entry["seed"])]
    done, took = run(axistool, str(out), [*common, "--box", base["box"], "--drive", str(sheet)])
    result = {"name": entry["name"], "hides": [e["kind"] for e in entry["hides"]], "computing_s": took}
    if done.returncode != 0:
        return {**result, "failed": (done.stderr or done.stdout).strip().splitlines()[-1]}
    state = json.loads((out / "commission.json").read_text())
    ladder = json.loads((out / "improvement.json").read_text())["ladder"]
    # The same step with the true model, whose data sheet is then also the true one.
    told = folder / "told"
    shutil.copytree(out, told)
    shutil.copy(truth, told / "improved.toml")
    roomy = base["box"].replace("time=", "time=1")  # the commissioning may have used the box's time
    other, _ = run(axistool, str(told), [*common, "--box", roomy, "--drive", str(truth), "--from", "compensate", "--to", "compensate"])
    best = json.loads((told / "commission.json").read_text())["following_error_um"] if other.returncode == 0 else {}
    return {**result, "verdict": state["verdict"], "added": (state.get("decided") or []) + [k for rung in ladder for k in rung["added"]],
            "error": state["following_error_um"], "truth_um": best.get("after"), "kept": state["kept"],
            "motion_s": state["motion_s"]}


def answer(result):
    """The tool's verdict, and whether it is right: the hidden effects, or an ambiguous group that contains them."""
    hidden, verdict = set(result["hides"]), result["verdict"]
    if result["added"]:
        found = set(result["added"])
        for group in map(set, verdict["alternatives"]):  # ambiguous, reported as such
            if found & group and hidden & group:
                found = (found - group) | (hidden & group)
        # Friction of every machine falls with speed, so naming Stribeck friction is also right.
        return " + ".join(sorted(found)), found - {"stribeck"} == hidden
    groups = [set(group) for group in verdict["alternatives"]]
    if verdict["status"] == "ambiguous":
        return " or ".join(sorted(verdict["effects"])), any(hidden & group for group in groups) or bool(
            hidden & set(verdict["effects"]))
    # "Nothing is missing" is also right if the tool lists the hidden effects as not visible in these motions.
    is_noise = verdict["probability_nothing"] > SURE and not verdict["effects"]
    return verdict["status"], not hidden and (verdict["status"] in ("adequate", "parameters") or is_noise)


def judge(result):
    if "failed" in result:
        return f"{result['name']:<26} FAILED: {result['failed']}", False
    said, right = answer(result)
    error = result["error"]
    reached = min(error["before"], error["after"] if error["after"] is not None else error["before"])
    share = reached / result["truth_um"] if result["truth_um"] else float("nan")
    good = right and not share > MOST_OVER_TRUTH and result["motion_s"] <= MOST_MOTION_S and result["computing_s"] <= MOST_COMPUTING_S
    after = "stopped" if error["after"] is None else f"{error['after']:.2f}"
    return (f"{result['name']:<26} {'right' if right else 'WRONG':<6} {said:<46} {error['before']:8.2f} {after:>8} "
            f"{result['truth_um'] or float('nan'):8.2f} {share:6.2f} {error['floor']:6.2f} {result['motion_s'] / 60:6.1f} {result['computing_s']:6.0f}"), good


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("axistool")
    parser.add_argument("machines")
    parser.add_argument("--only", nargs="*")
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument("--keep")
    parser.add_argument("--check", action="store_true", help="fail unless every machine is right")
    options = parser.parse_args()
    book = json.loads(pathlib.Path(options.machines).read_text())
    entries = [e for e in book["machines"] if not options.only or e["name"] in options.only]
    folder = pathlib.Path(options.keep or tempfile.mkdtemp(prefix="commission-bench-"))
    print(f"{'machine':<26} {'':<6} {'found':<46} {'before':>8} {'after':>8} {'truth':>8} {'ratio':>6} {'floor':>6} {'min':>6} {'s':>6}")

    def one(entry):
        place = folder / entry["name"]
        shutil.rmtree(place, ignore_errors=True)
        place.mkdir(parents=True)
        return commission(options.axistool, book["bases"][entry["base"]], entry, place)

    good = 0
    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        for result in pool.map(one, entries):
            line, is_good = judge(result)
            print(line, flush=True)
            good += is_good
    print(f"{good} of {len(entries)}: the right effect or an honest group, following error at most {MOST_OVER_TRUTH} times "
          f"that of the true parameters, at most {MOST_MOTION_S / 60:.0f} minutes of motion and {MOST_COMPUTING_S:.0f} s of computing")
    if not options.keep:
        shutil.rmtree(folder)
    return 0 if good == len(entries) or not options.check else 1


if __name__ == "__main__":
    sys.exit(main())
