"""plant.py: exits with 1 where a fault of faults.txt does not stand exactly once in its source.
plant.py list: a line for each fault: name, file, test program, filter of its tests.
plant.py NAME TREE: plants the fault in a copy of the sources."""

import pathlib
import re
import sys

here = pathlib.Path(__file__).resolve().parent
faults = {}
for line in (here / "faults.txt").read_text().splitlines():
    if section := re.fullmatch(r"\[(\w+) (\S+)\]", line):
        program, tests = section.groups()
    elif head := re.fullmatch(r"(\w+): (\S+)", line):
        changes = []
        faults[head[1]] = (head[2], program, tests, changes)
    elif line.startswith("- "):  # white space is as clang-format has it today
        tokens = re.findall(r"\w+|\S", line[2:])
        changes.append([re.compile(r"\s*".join(re.escape(token) for token in tokens)), ""])
    elif line.startswith("+ "):
        changes[-1][1] = line[2:]

if len(sys.argv) == 3:
    file, _, _, changes = faults[sys.argv[1]]
    path = pathlib.Path(sys.argv[2], file)
    text = path.read_text()
    for pattern, planted in changes:
        text = pattern.sub(lambda _: planted, text)
    path.write_text(text)
elif len(sys.argv) == 2:
    print(*(" ".join([name, *fault[:3]]) for name, fault in faults.items()), sep="\n")
else:
    lost = False
    for name, (file, _, _, changes) in faults.items():
        path = here.parent.parent / file
        text = path.read_text() if path.exists() else ""
        for pattern, _ in changes:
            if (count := len(pattern.findall(text))) != 1:
                print(f"{name}: stands {count} times in {file}, expected once", file=sys.stderr)
                lost = True
    sys.exit(lost or not faults)
