#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""Compares our components with those of LinuxCNC: their exports and their behaviour.

Names: pins, parameters and functions with type, direction and start value, for every module that both have; our names by the
rules count as the legacy names that they replace. Behaviour: streamer -> component -> sampler, one row of inputs per period, so
that both get the same inputs in the same periods. LinuxCNC's halrun runs as an ordinary user in separate namespaces.
"""
import argparse
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

from component_scenarios import SCENARIOS

ROOT = pathlib.Path(__file__).resolve().parent.parent
TYPE_LETTERS = {"bit": "b", "float": "f", "s32": "s", "u32": "u"}
STATISTICS = (".time", ".tmax", ".tmax-increased")

# Modules that are loaded besides those of the scenarios, to compare their exports.
LOADS = """and2 or2 xor2 not flipflop select8 estop_latch charge_pump sum2 mult2 scale offset constant hypot ddt comp near
mux2 mux4 limit1 limit2 limit3 lowpass ilowpass edge oneshot timedelay encoder counter encoder_ratio pid siggen
sim_encoder sim_home_switch sim_spindle timedelta latencybins threadtest supply steptest millturn conv_bit_float
conv_bit_s32 conv_bit_u32 conv_float_s32 conv_float_u32 conv_s32_bit conv_s32_float conv_s32_u32 conv_u32_bit
conv_u32_float conv_u32_s32""".split() + [
    "logic personality=0x1f03", "mux_generic config=fs4,ub2", "stepgen step_type=0,2,5", "sampler cfg=bfsu depth=5",
    "streamer cfg=bfsu depth=5", "carousel pockets=10,10,8 encoding=gray,index,counts", "debounce cfg=2,1",
    "bldc cfg=n,h,a,q,qi,hqi,f,B", "bldc cfg=6,B6,H,F,hT,hB6HF,nB", "spindle numgears=2", "max31855 personality=2",
    "message messages=Stop", "moveoff personality=2", "moveoff", "multiswitch cfg=3,2", "watchdog num_inputs=2",
    "pwmgen output_type=0,1,2", "weighted_sum wsum_sizes=2,3", "gantry", "demux", "bitslice", "lincurve"]


class Side:
    """One of the two systems."""

    def __init__(self, halrun, folder, is_reference):
        self.halrun = halrun
        self.folder = folder
        self.is_reference = is_reference
        folder.mkdir()
        folder.chmod(0o777)

    def run(self, text, timeout_s=30.0):
        (self.folder / "run.hal").write_text(text)
        environment = {**os.environ, "HOME": str(self.folder)}
        command = ["timeout", str(timeout_s), self.halrun, "-s", "-f", "run.hal"]
        if self.is_reference and os.geteuid() == 0:
            isolated = ["unshare", "--ipc", "--pid", "--fork", "--mount-proc"]
            command = isolated + ["setpriv", "--reuid=65534", "--regid=65534", "--clear-groups"] + command
        done = subprocess.run(command, cwd=self.folder, env=environment, stdout=subprocess.PIPE,
                              stderr=subprocess.STDOUT, text=True, check=False)
        return done.stdout

    def exports(self, load):
        """{name: description}; names are LinuxCNC's if ours have them as second names."""
        out = self.run(f"loadrt {load}\nshow pin\nshow param\nshow funct\nshow alias\n")
        found, legacy = {}, {}
        for line in out.splitlines():
            words = line.split()
            if len(words) == 5 and words[2] in ("IN", "OUT", "I/O", "RO", "RW"):
                if not words[4].endswith(STATISTICS):
                    found[words[4]] = (words[1], words[2], words[3])
            elif len(words) == 6 and words[3] in ("YES", "NO"):
                found[words[5]] = ("function",)
            elif len(words) == 2 and "." in words[0] and "." in words[1]:
                legacy[words[0]] = words[1]
        return {legacy.get(name, name): what for name, what in found.items()}

    def table(self, scenario, types):
        """The rows of outputs, or an error text."""
        rows, inputs, outputs = scenario["rows"], scenario["ins"], scenario["outs"]
        in_types = "".join(TYPE_LETTERS[types[pin][0]] for pin in inputs) or "b"
        out_types = "".join(TYPE_LETTERS[types[pin][0]] for pin in outputs)
        depth = len(rows) + 16
        lines = [f"loadrt threads name1=t period1={scenario['period']}",
                 f"loadrt streamer depth={depth} cfg={in_types}", f"loadrt sampler depth={depth} cfg={out_types}",
                 f"loadrt {scenario['load']}"]
        lines += [f"net i{i} streamer.0.pin.{i} {pin}" for i, pin in enumerate(inputs)]
        lines += [f"net o{i} {pin} sampler.0.pin.{i}" for i, pin in enumerate(outputs)]
        lines += [f"setp {name} {value}" for name, value in scenario["setp"].items()]
        lines += [f"addf {name} t" for name in ["streamer.0", *scenario["add"], "sampler.0"]]
        lines += ["loadusr -w halstreamer in.txt", "start", f"loadusr -w halsampler -n {len(rows)} out.txt"]
        (self.folder / "in.txt").write_text(
            "".join((" ".join(str(value) for value in row) or "0") + "\n" for row in rows))
        out = self.folder / "out.txt"
        out.unlink(missing_ok=True)
        log = self.run("\n".join(lines) + "\n", 20 + len(rows) * scenario["period"] / 1e9)
        if not out.exists():
            return log
        return [tuple(map(float, line.split())) for line in out.read_text().splitlines() if line != "overrun"]


def is_same(a, b):
    return a == b or (a != a and b != b) or abs(a - b) <= 1e-5 * max(1.0, abs(a))


def compare_exports(reference, ours, load, quiet):
    theirs, mine = reference.exports(load), ours.exports(load)
    if not theirs:
        print(f"{load}: LinuxCNC exports nothing")
        return True
    wrong = [f"  missing {name} {' '.join(what)}" for name, what in theirs.items() if name not in mine]
    wrong += [f"  {name}: theirs {' '.join(theirs[name])}, ours {' '.join(what)}"
              for name, what in mine.items() if name in theirs and theirs[name] != what]
    more = [name for name in mine if name not in theirs]
    if more:
        print(f"{load}: ours has {', '.join(more)} too")
    if wrong or not quiet:
        print(f"{load}: exports " + ("differ" if wrong else f"same ({len(theirs)})"))
    print("\n".join(wrong[:20]), end="\n" if wrong else "")
    return not wrong


def compare_behaviour(reference, ours, scenario):
    types = reference.exports(scenario["load"])
    theirs, mine = reference.table(scenario, types), ours.table(scenario, types)
    if isinstance(theirs, str) or isinstance(mine, str):
        print(f"{scenario['load']}: did not run\n  theirs: {theirs if isinstance(theirs, str) else 'ran'}"
              f"\n  ours: {mine if isinstance(mine, str) else 'ran'}")
        return False
    different = [i for i, (a, b) in enumerate(zip(theirs, mine)) if not all(map(is_same, a, b))]
    is_size = len(theirs) == len(mine)
    if not different and is_size:
        print(f"{scenario['load']}: same in {len(mine)} periods")
        return True
    reason = f" (known: {scenario['known']})" if scenario["known"] else ""
    print(f"{scenario['load']}: {len(different)} of {len(theirs)} periods differ{reason}")
    for i in different[:0 if scenario["known"] else 5]:
        print(f"  period {i}, inputs {scenario['rows'][i]}: theirs {theirs[i]}, ours {mine[i]}")
    return bool(scenario["known"]) and is_size


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("component", nargs="*", help="only these")
    parser.add_argument("--build", default="build/dev", help="our build folder")
    parser.add_argument("--reference", default="/usr/bin/halrun", help="LinuxCNC's halrun")
    parser.add_argument("--quiet", action="store_true", help="do not list exports that are the same")
    options = parser.parse_args()
    if shutil.which(options.reference) is None:
        sys.exit(f"{options.reference} is missing: install linuxcnc-uspace to compare with it")
    folder = pathlib.Path(tempfile.mkdtemp(prefix="compare-components-"))
    folder.chmod(0o755)
    binaries = ROOT / options.build / "bin"
    reference = Side(options.reference, folder / "theirs", True)
    ours = Side(str(binaries / "halrun"), folder / "ours", False)

    def is_wanted(load):
        return not options.component or re.split(r"\s", load)[0] in options.component

    failures = 0
    loads = dict.fromkeys(LOADS + [scenario["load"] for scenario in SCENARIOS])
    for load in filter(is_wanted, loads):
        failures += not compare_exports(reference, ours, load, options.quiet)
    for scenario in SCENARIOS:
        if is_wanted(scenario["load"]):
            failures += not compare_behaviour(reference, ours, scenario)
    shutil.rmtree(folder)
    print(f"{failures} differences that are not known" if failures else "no differences but the known ones")
    sys.exit(1 if failures else 0)


if __name__ == "__main__":
    main()
