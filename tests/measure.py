"""How large the project is, and who asked for what it holds.

measure.py PROGRAM: prints the code lines of each folder, as if no line were longer than 100
columns, and the number of concepts that a reader has to know. Fails where docs/concepts.md does not
have exactly one line for each verb, flag, scheme, option, facet and suite of PROGRAM.
"""

import collections
import json
import math
import os
import re
import subprocess
import sys

program = os.path.abspath(sys.argv[1])
os.chdir(os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))

PRODUCT = ["scenes", "schemes", "reference", "analysis", "bench", "python", "web"]
CODE = (".cpp", ".hpp", ".h", ".js", ".mjs", ".py", ".pyi", ".css", ".html", ".sh", ".def",
        ".cmake", ".m", ".jl")
SLASHES = (".cpp", ".hpp", ".h", ".js", ".mjs", ".css", ".def")


def code_lines(path):
    """A longer line counts once for each 100 columns begun. Blank lines, comments, includes,
    namespaces and lone braces do not count."""
    with open(path, encoding="utf-8", errors="replace") as file:
        text = file.read()
    if path.endswith(SLASHES):
        text = re.sub(r"/\*.*?\*/", lambda m: "\n" * m.group().count("\n"), text, flags=re.S)
    comment = r"//" if path.endswith(SLASHES) else r"#(?!!)|<!--"
    uncounted = re.compile(rf"\s*({comment}|#\s*(include|pragma once)|(inline )?namespace\b|"
                           r"using namespace\b|[{}()\[\];,]*(\s*//.*)?$)")
    counted = [line.rstrip() for line in text.splitlines() if not uncounted.match(line)]
    return sum(max(1, math.ceil(len(line) / 100)) for line in counted)


def output_of(*command):
    return subprocess.run(command, capture_output=True, text=True, check=True).stdout


def listed(what):
    return json.loads(output_of(program, "list", what, "--json"))[what]


def help_of(*verb):
    return output_of(program, *verb, "--help").split("\nExample")[0]


def concepts():
    verbs = re.findall(r"^  ([a-z]+) {5,}", help_of().split("Subcommands:")[1], re.M)
    one = r"^ +(?:-\w,)?(--[a-z][a-z-]*)"
    flags = {flag for verb in verbs for flag in re.findall(one, help_of(verb), re.M)}
    measure = next(key for key in listed("keys")["cells"] if key["key"] == "measure")
    return {
        "Verbs": verbs,
        "Flags": flags - {"--help"},
        "Schemes": [scheme["name"] for scheme in listed("schemes")],
        "Options": {option["name"] for option in listed("options")},
        "Facets": measure["value"].replace(" or several", "").split(", "),
        "Suites": [suite["name"] for suite in listed("suites")],
    }


def complaints(has):
    with open("docs/concepts.md", encoding="utf-8") as file:
        sections = dict(re.findall(r"^## (\w+)\n(.*?)(?=^## |\Z)", file.read(), re.M | re.S))
    for kind, names in has.items():
        lines = re.findall(r"^- `([^`]+)`: \S", sections.get(kind, ""), re.M)
        for name in sorted(set(names) - set(lines)):
            yield (f"{kind}: `{name}` has no line. A concept needs somebody who asked for it, and "
                   "one that leaves for it")
        for name in sorted(set(lines) - set(names)):
            yield f"{kind}: the program has no `{name}`"
        for name, number in collections.Counter(lines).items():
            if number > 1:
                yield f"{kind}: `{name}` has {number} lines"


tracked = output_of("git", "ls-files").splitlines()
sizes, files = collections.Counter(), collections.Counter()
for path in tracked:
    folder = path.split("/")[0]
    if folder in [*PRODUCT, "tests"] and path.endswith(CODE) and os.path.exists(path):
        sizes[folder] += code_lines(path)
        files[folder] += 1
for folder, size in sizes.most_common():
    print(f"{folder:10} {size:6} code lines at 100 columns, {files[folder]:4} files")
print(f"product    {sum(sizes[folder] for folder in PRODUCT):6}")
has = concepts()
print(", ".join(f"{len(set(names))} {kind.lower()}" for kind, names in has.items()))
records = {path.split("/")[1] for path in tracked if re.match("results/.*/", path)}
print(f"{len(records)} folders of results")
faults = list(complaints(has))
for fault in faults:
    print(f"docs/concepts.md: {fault}", file=sys.stderr)
sys.exit(1 if faults else 0)
