"""The files of results/problems are what the program exports. The table of its README names each
file and its scene.

problems.py JVARI FILE ...: exports these and compares.
problems.py JVARI --write: makes all of them again, and their uncertainties in the table.
"""

import json
import math
import os
import re
import subprocess
import sys
import tempfile

program, names = os.path.abspath(sys.argv[1]), sys.argv[2:]
folder = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "results", "problems")
with open(os.path.join(folder, "README.md")) as file:
    text = file.read()
row = re.compile(r"^\| \[(\w+)\]\((\w+\.json)\) \|(.*)\| ([^|]*) \| `([^`]+)` \|$", re.M)
scenes = {match[1]: match[5] for match in row.finditer(text)}
assert len(scenes) == 12, f"{len(scenes)} problems in the table"


def exported(name, path):
    words = scenes[name].split()
    # a plucked string is judged from where its pluck ends
    duration = [] if "--duration" in words else ["--duration", "0.05"]
    command = [program, "export", *words, *duration, "--rate", "44100", "--out", path, "--quiet"]
    subprocess.run(command, check=True)
    with open(path) as file:
        return json.load(file)


def same(was, now, where):  # numbers to 1e-9, all else to the letter
    if isinstance(was, list) and isinstance(now, list):
        assert len(was) == len(now), f"{where}: {len(now)} values, not {len(was)}"
        scale = max((abs(x) for x in was if isinstance(x, (int, float))), default=0)
        for k, (a, b) in enumerate(zip(was, now)):
            if isinstance(a, (int, float)) and isinstance(b, (int, float)):
                assert abs(a - b) <= 1e-9 * abs(a) + 1e-13 * scale, f"{where}[{k}] is {b}, not {a}"
            else:
                same(a, b, f"{where}[{k}]")
    elif isinstance(was, float) and isinstance(now, (int, float)):
        assert abs(was - now) <= 1e-9 * abs(was), f"{where} is {now}, not {was}"
    else:
        assert was == now, f"{where} is {now}, not {was}"


def compare(name):
    with open(os.path.join(folder, name + ".json")) as file:
        was = json.load(file)
    with tempfile.TemporaryDirectory() as scratch:
        now = exported(name, scratch + "/problem.json")
    assert list(was) == list(now), f"{name}: the members are {list(now)}"
    for member in was.keys() - {"program", "reference"}:
        same(was[member], now[member], f"{name}: {member}")
    old, new = was["reference"], now["reference"]
    assert list(old) == list(new), f"{name}: the members of the reference are {list(new)}"
    known_to = [r["uncertainty_l2_50ms"] for r in (old, new)]
    for tap, a, b, known, anew in zip(was["tap_names"], old["trace"], new["trace"], *known_to):
        apart = math.dist(a, b) / math.hypot(*a)
        assert apart <= known + anew, (f"{name}: the reference of {tap} moved by {apart:.2g}, and "
                                       f"is known to {known:.2g} and {anew:.2g}")


if names == ["--write"]:
    for name in scenes:
        problem = exported(name, os.path.join(folder, name + ".json"))
        known = problem["reference"]["uncertainty_l2_50ms"][0]
        print(f"{name}: {known:.1e}")
        text = row.sub(lambda m: m[0] if m[1] != name else
                       m[0].replace(f"| {m[4]} |", f"| {known:.1e} |"), text)
    with open(os.path.join(folder, "README.md"), "w") as file:
        file.write(text)
for name in names if names != ["--write"] else []:
    compare(name)
