#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""Compares our kinematics modules with those of LinuxCNC: their pins, and their forward and inverse kinematics.

Each module is loaded unmodified in a separate process by an ordinary user, with a HAL that only stores pins (kinematics_stub.c).
Then its pins are set and its functions called as declared in kinematics.h. Random joints are converted forward and back (for
closed loops: random poses inverse and back). Ours starts at LinuxCNC's joints, because the current joints select the
configuration of elbows and knees. A result of LinuxCNC that its own forward kinematics does not convert back to the pose is not a
solution: it is counted but not compared.
"""
import argparse
import ctypes
import json
import math
import os
import pathlib
import random
import shutil
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
TOOLS = pathlib.Path(__file__).resolve().parent
TYPES = {1: "bit", 2: "float", 3: "s32", 4: "u32"}
DIRECTIONS = {16: "in", 32: "out", 48: "in/out", 64: "parameter, read only", 192: "parameter"}
# Pins of LinuxCNC that ours lack, with the reason.
KNOWN_PINS = {"userk.": "counters of the example of a user's type",
              "userkins.in": "of a template", "userkins.out": "of a template", "userkins.param": "of a template",
              "pentakins.base.5.": "there are five struts", "pentakins.effector.5.": "there are five struts",
              "xyzab-tdr-kins.": "a placeholder of halcompile"}

MM, TURN, TILT = (-300, 300), (-170, 170), (-80, 80)
HAND = [TURN] * 6
# name: number of joints, range of random joints (or with `poses` poses), size of the machine; pins that are
# set.
MODELS = {
    "rotatekins": {"joints": [MM, MM, MM, TURN, TILT, TURN, MM, MM, MM], "size": 300},
    "tripodkins": {"poses": [MM, MM, (5, 600)], "size": 400,
                   "pins": {"tripodkins.Bx": 400, "tripodkins.Cx": 150, "tripodkins.Cy": 350}},
    "lineardeltakins": {"poses": [(-200, 200), (-200, 200), MM, TURN, TURN, TURN, MM, MM, MM], "size": 269},
    "rotarydeltakins": {"poses": [(-14, 14), (-14, 14), (-23, -1), TURN, TURN, TURN, MM, MM, MM], "size": 14},
    "5axiskins": {"joints": [MM, MM, MM, TILT, TURN, MM], "size": 300, "pins": {"5axiskins.pivot-length": 180.5}},
    # Its forward kinematics does not return to the pose of its inverse, so the inverse is compared.
    "maxkins": {"poses": [MM, MM, MM, TURN, TILT, TURN, MM, MM, MM], "size": 300, "is_inverse_only": True,
                "pins": {"maxkins.pivot-length": 120}},
    "xyzac-trt-kins": {"joints": [MM, MM, MM, TILT, TURN], "size": 300, "offsets": True},
    "xyzbc-trt-kins": {"joints": [MM, MM, MM, TILT, TURN], "size": 300, "offsets": True},
    "xyzac-trt-kins type 1": {"joints": [MM, MM, MM, TILT, TURN], "size": 300, "switch": 1},
    "xyzac-trt-kins type 2": {"joints": [MM, MM, MM, TILT, TURN], "size": 300, "switch": 2},
    "5axiskins type 2": {"joints": [MM, MM, MM, TILT, TURN, MM], "size": 300, "switch": 2},
    "scarakins type 1": {"joints": [MM] * 6, "size": 640, "switch": 1},
    "pumakins type 2": {"joints": HAND, "size": 820, "switch": 2},
    "genserkins type 2": {"joints": [MM] * 9, "size": 820, "switch": 2},
    "userkins": {"joints": [MM, MM, MM], "size": 300},
    "xyzab_tdr_kins": {"joints": [MM, MM, MM, TURN, TURN], "size": 300, "offsets": True, "switch": 1},
    "scarakins": {"joints": [TURN, (-170, -1), MM, TURN, TURN, TURN], "size": 640},
    "pumakins": {"joints": HAND, "size": 820, "rpy": True},
    "genserkins": {"joints": HAND, "size": 820, "rpy": True, "tolerance": 1e-4},
    "genhexkins": {"poses": [(-6, 6), (-6, 6), (15, 30), (-15, 15), (-15, 15), (-15, 15)], "size": 25, "rpy": True,
                   "pins": {"genhexkins.tool-offset": 3, "genhexkins.spindle-offset": 2, "genhexkins.screw-lead": 0.5}},
    "pentakins": {"poses": [(-150, 150), (-150, 150), (-150, 150), (-25, 25), (-25, 25)], "size": 1000,
                  "pins": {"pentakins.tool-offset": 30}},
    "rosekins": {"joints": [(1, 300), MM, (-170, 170)], "size": 300},
    "scorbot-kins": {"joints": [TURN, (0, 60), (-60, -1), TURN, TURN], "size": 458},
}


# ---- the process that loads one module
class Module:
    def __init__(self, stub, path):
        self.hal = ctypes.CDLL(stub, ctypes.RTLD_GLOBAL)
        self.hal.stub_name.restype = ctypes.c_char_p
        self.hal.stub_get.restype = ctypes.c_double
        self.hal.stub_set.argtypes = [ctypes.c_int, ctypes.c_double]
        self.module = ctypes.CDLL(path, os.RTLD_LAZY)
        self.flags = ctypes.c_ulong(0), ctypes.c_ulong(0)
        if self.module.rtapi_app_main() < 0:
            sys.exit("the module did not load")
        self.module.kinematicsType()
        self.pins = {self.hal.stub_name(i).decode(): i for i in range(self.hal.stub_count())}

    def exports(self):
        return {name: [TYPES[self.hal.stub_type(i)], DIRECTIONS[self.hal.stub_dir(i)], self.hal.stub_get(i)]
                for name, i in self.pins.items()}

    def inverse(self, pose, joints):
        world, found = (ctypes.c_double * 9)(*pose), (ctypes.c_double * 16)(*joints)
        flags = ctypes.byref(self.flags[1]), ctypes.byref(self.flags[0])
        status = self.module.kinematicsInverse(world, found, *flags)
        return [status == 0, list(found)]

    def forward(self, joints, pose):
        world, given = (ctypes.c_double * 9)(*pose), (ctypes.c_double * 16)(*joints)
        flags = ctypes.byref(self.flags[0]), ctypes.byref(self.flags[1])
        status = self.module.kinematicsForward(given, world, *flags)
        return [status == 0, list(world)]


def work():
    """Answers the requests on the standard input as one JSON text."""
    task = json.load(sys.stdin)
    out = os.dup(1)
    os.dup2(2, 1)
    module = Module(task["stub"], task["path"])
    answer = {"exports": module.exports(), "calls": []}
    for name, value in task["pins"].items():
        module.hal.stub_set(module.pins[name], value)
    if task["switch"]:
        module.module.kinematicsSwitch(task["switch"])
    for call in task["calls"]:
        if call[0] == "joints":  # forward, and inverse from the result
            is_found, pose = module.forward(call[1], call[2])
            back = module.inverse(pose, call[3]) if is_found else [False, call[1]]
        else:  # inverse, and forward from the result
            pose = call[1]
            back = module.inverse(pose, call[3])
            is_found = True
        again = module.forward(back[1], call[2] if call[0] == "joints" else pose) if back[0] else [False, pose]
        answer["calls"].append({"isFound": is_found, "pose": pose, "back": back, "again": again})
    os.write(out, json.dumps(answer).encode())


# ---- the process that compares
def ask(command_prefix, task):
    done = subprocess.run([*command_prefix, "/usr/bin/python3", str(pathlib.Path(task["script"])), "--work"],
                          input=json.dumps(task), stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, check=False)
    if done.returncode != 0:
        return done.stderr.strip().splitlines()[-1] if done.stderr else f"ended with status {done.returncode}"
    return json.loads(done.stdout)


def columns(pose):
    """The orientation of a pose as its columns X and Z."""
    a, b, c = (math.radians(x) for x in pose[3:6])
    ca, sa, cb, sb, cc, sc = math.cos(a), math.sin(a), math.cos(b), math.sin(b), math.cos(c), math.sin(c)
    return [cc * cb, sc * cb, -sb, cc * sb * ca + sc * sa, sc * sb * ca - cc * sa, cb * ca]


def distance(p, q, model):
    lengths = [0, 1, 2, 6, 7, 8] if model.get("rpy") else range(9)
    most = max(abs(p[i] - q[i]) for i in lengths)
    if model.get("rpy"):
        most = max(most, *(model["size"] * abs(x - y) for x, y in zip(columns(p), columns(q))))
    return most if most == most else math.inf


def drawn_calls(model, count):
    calls = []
    for _ in range(count):
        drawn = [random.uniform(*span) for span in model.get("joints") or model["poses"]]
        if "joints" in model:
            joints = drawn + [0.0] * (16 - len(drawn))
            calls.append(["joints", joints, [0.0] * 9, joints])
        else:
            pose = drawn + [0.0] * (9 - len(drawn))
            calls.append(["pose", pose, pose, [0.0] * 16])
    return calls


def compare_exports(theirs, ours):
    wrong = []
    for name, what in theirs.items():
        if any(name.startswith(known) for known in KNOWN_PINS):
            continue
        if name not in ours:
            wrong.append(f"missing {name}")
        elif ours[name][:2] != what[:2] or abs(ours[name][2] - what[2]) > 1e-9 * max(1.0, abs(what[2])):
            wrong.append(f"{name}: theirs {what}, ours {ours[name]}")
    return wrong


def compare_calls(model, theirs, ours, calls):
    """The differences, and the counts of the requests."""
    tolerance = model.get("tolerance", 1e-6) * model["size"]
    count = {"same": 0, "rejected by both": 0, "no solution of theirs": 0, "rejected by ours": 0}
    wrong = []
    for call, their, our in zip(calls, theirs, ours):
        if call[0] == "joints" and distance(their["pose"], our["pose"], model) > tolerance:
            wrong.append(f"forward {call[1]}: theirs {their['pose']}, ours {our['pose']}")
            continue
        is_solved = their["back"][0] and (model.get("is_inverse_only") or their["again"][0] and
                                          distance(their["again"][1], their["pose"], model) < tolerance)
        if not is_solved:
            count["no solution of theirs" if their["back"][0] else "rejected by both"] += 1
            if our["back"][0] and distance(our["again"][1], our["pose"], model) > tolerance:
                wrong.append(f"inverse {our['pose']}: ours is no solution, {our['back'][1]}")
            continue
        if not our["back"][0]:
            count["rejected by ours"] += 1
            continue
        size = max(abs(x - y) for x, y in zip(their["back"][1], our["back"][1]))
        if size > tolerance:
            wrong.append(f"inverse {their['pose']}: theirs {their['back'][1]}, ours {our['back'][1]}")
        else:
            count["same"] += 1
    return wrong, count


def compare(name, model, options, task):
    random.seed(name + str(options.seed))
    calls = drawn_calls(model, options.poses)
    theirs = ask(options.as_user, {**task, "path": f"{options.reference}/{name.split()[0]}.so", "calls": calls})
    if isinstance(theirs, str):
        print(f"{name}: LinuxCNC's did not run: {theirs}")
        return 1
    # Starts at LinuxCNC's joints; if it has none, at the random ones.
    asked = [[call[0], call[1], call[2], their["back"][1] if their["back"][0] else call[3]]
             for call, their in zip(calls, theirs["calls"])]
    asked = [[*call[:3], [x if x == x else 0.0 for x in call[3]]] for call in asked]
    ours = ask(options.as_user, {**task, "path": str(ROOT / options.build / "lib" / f"{name.split()[0]}.so"), "calls": asked})
    if isinstance(ours, str):
        print(f"{name}: ours did not run: {ours}")
        return 1
    wrong = compare_exports(theirs["exports"], ours["exports"])
    differences, count = compare_calls(model, theirs["calls"], ours["calls"], calls)
    told = ", ".join(f"{number} {what}" for what, number in count.items() if number)
    print(f"{name}: {len(wrong)} of {len(theirs['exports'])} pins differ; {len(calls)} asked: {told}, "
          f"{len(differences)} differ")
    for line in wrong[:10] + differences[:options.show]:
        print("  " + line)
    return len(wrong) + len(differences)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("module", nargs="*", help="only these")
    parser.add_argument("--build", default="build/release", help="our build folder")
    parser.add_argument("--reference", default="/usr/lib/linuxcnc/modules", help="folder of LinuxCNC's modules")
    parser.add_argument("--poses", type=int, default=2000, help="drawn for each module")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--show", type=int, default=5, help="differences that are shown of each module")
    options = parser.parse_args()
    if not pathlib.Path(options.reference, "trivkins.so").exists():
        print(f"skipped: no modules of LinuxCNC in {options.reference}; install linuxcnc-uspace to compare with it")
        return 0
    options.as_user = ["setpriv", "--reuid=65534", "--regid=65534", "--clear-groups"] if os.geteuid() == 0 else []
    folder = pathlib.Path(tempfile.mkdtemp(prefix="compare-kinematics-"))
    folder.chmod(0o755)
    stub = folder / "stub.so"
    subprocess.run(["cc", "-shared", "-fPIC", "-O1", "-o", str(stub), str(TOOLS / "kinematics_stub.c")], check=True)
    script = shutil.copy(__file__, folder)
    failures = 0
    for name in options.module or MODELS:
        model = MODELS[name]
        pins = dict(model.get("pins", {}))
        task = {"stub": str(stub), "script": script, "pins": pins, "switch": model.get("switch", 0)}
        if model.get("offsets"):
            prefix = name
            pins.update({f"{prefix}.{axis}-rot-point": value for axis, value in zip("xyz", (10, -20, 30))})
            pins.update({f"{prefix}.x-offset": 4, f"{prefix}.z-offset": -6})
            pins[f"{prefix}.tool-offset" + ("-z" if name == "xyzab_tdr_kins" else "")] = 70
        failures += compare(name, model, options, task)
    shutil.rmtree(folder)
    print(f"{failures} differences" if failures else "no differences")
    return 1 if failures else 0


if __name__ == "__main__":
    if "--work" in sys.argv:
        work()
    else:
        sys.exit(main())
