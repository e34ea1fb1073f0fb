#!/usr/bin/python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""Compares tools/trajcheck.py with the checkers of the tests on the same traces: the planner's, and modified traces with faults.

usage: trajcheck_test.py FOLDER_OF_PROGRAMS
"""
import pathlib
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "tools"))
try:
    import numpy as np
except ImportError:
    sys.exit("trajcheck_test: python3-numpy is missing; script/bootstrap installs it")
import trajcheck

RUNS = [("XYZAB", ["--jerk"]), ("G61", [])]


def spoil(rows, how):
    out = rows.copy()
    middle = len(out) // 2
    if how == "a sample aside":
        out[middle, 0] += 2e-3
    elif how == "off the path":
        bump = np.sin(np.linspace(0, np.pi, len(out))) ** 4
        out[:, 1] += 0.06 * bump
    elif how == "short of the end":
        out = out[:-3]
    elif how == "a part left out":
        # A slow straight line replaces the path to the end: the limits are kept, but the path is not.
        out = np.concatenate([out[:1], out[0] + (out[-1] - out[0]) * np.linspace(0, 1, len(out))[:, None] ** 2])
        out[-1] = rows[-1]
    return out


def write(path, period, rows):
    with open(path, "w", encoding="ascii") as file:
        file.write(f"# period_s={period} tolerance=0\n")
        for row in rows:
            file.write(",".join(f"{value:.17g}" for value in row) + "\n")


def differences(kind, how, verdict, words):
    """Differences between the two judges."""
    theirs = dict(zip(("velocity", "acceleration", "jerk"), map(float, words[:3])))
    for name, (ratio, _, _) in verdict["worst"].items():
        if abs(ratio - theirs[name]) > 1e-3 * max(1.0, ratio):
            yield f"{kind}, {how}: {name} {ratio} here, {theirs[name]} there"
    if (words[4] == "ok") != verdict["ok"]:
        yield f"{kind}, {how}: {verdict} here, {' '.join(words)} there"
    deviation, reach = verdict["deviation"], 0.15 * verdict["tolerance"] + 4e-3
    if deviation is not None and deviation < 9 * verdict["tolerance"] and abs(deviation - float(words[3])) > reach:
        yield f"{kind}, {how}: deviation {deviation} here, {words[3]} there"


def main():
    programs = pathlib.Path(sys.argv[1])
    wrong, count, over_limit = [], 0, 0
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        subprocess.run([programs / "traj_programs", folder], check=True)
        for kind, mode in RUNS:
            stem = kind.replace(" ", "_")
            subprocess.run([programs / "traj_bench", "--fast", *mode, "--only", kind, "--trace", folder],
                           check=True, stdout=subprocess.DEVNULL)
            period, rows = trajcheck.read_trace(folder / f"{stem}.csv")
            geometry = trajcheck.read_geometry(folder / f"{stem}.json")
            for how in ("as driven", "a sample aside", "off the path", "short of the end", "a part left out"):
                spoiled = folder / "spoiled.csv"
                made = spoil(rows, how)
                write(spoiled, period, made)
                verdict = trajcheck.judge(geometry, period, made, with_jerk=bool(mode))
                done = subprocess.run([programs / "traj_verdict", kind, spoiled, *mode], check=False,
                                      stdout=subprocess.PIPE, text=True)
                wrong += differences(kind, how, verdict, done.stdout.split())
                if verdict["ok"] != (how == "as driven"):
                    wrong.append(f"{kind}, {how}: judged {verdict}")
                count += 1
                over_limit += not verdict["ok"]
    print(f"{count} traces, {over_limit} over a limit, {len(wrong)} differences")
    print("\n".join(wrong))
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
