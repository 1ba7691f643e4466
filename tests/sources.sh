#!/bin/sh
# Sources of product and tests: nothing is called made, told, said, held, asked or whoever, and files
# named in comments exist. No C++ function of the product is longer than 60 lines, except at most 12
# functions listed here with their reasons. usage: sources.sh [TREE]
python3 - "${1:-$(dirname "$0")/..}" <<'PYTHON'
import pathlib
import re
import sys

ROOMS = "scenes schemes reference analysis bench python web tests results docs".split()
FORBIDDEN = re.compile(r"(?<![\w$])(made|told|said|held|asked|whoever)(?![\w$])")
ELSEWHERE = {"allocator_interface.h", "highway.h", "NAME.cpp"}  # other libraries, a placeholder
MOST_LINES, MOST_LONG = 60, 12
LONG = {
    "bench/check/numbers.cpp:make_scenes_of_numbers": "a list of scenes",
    "bench/check/scenes.cpp:otherwise": "a switch with a case for each feature",
    "bench/check/scenes.cpp:with": "a switch with a case for each feature",
    "bench/study/cell_tables.cpp:columns": "a table of columns",
    "bench/study/certificate_library.cpp:trust_of": "one pass over the pairs of a certificate",
    "reference/exact/collocated_contact.cpp:step": "one Newton solve, whose parts share arrays",
    "reference/exact/exact_contact.cpp:phase": "one phase in the order of its equations",
    "reference/exact/window_energies.cpp:pairs_of": "one table of moments, row after row",
    "reference/string_equations.cpp:solve": "one linear solve, whose parts share arrays",
    "reference/sundials.cpp:advance": "one loop over returns of the library",
    "schemes/contact/contact_gram.cpp:solve_group": "one Newton solve, whose parts share arrays",
}

FILE = re.compile(r"(?<![\w./$*{}-])[\w./-]*\w\.(?:[hc]pp|def|h|m?js|css|py|sh|cmake|md)\b")
STRING = r""""(?:\\.|[^"\\\n])*"|(?<![0-9A-Fa-f])'(?:\\.|[^'\\\n])+'"""
COMMENT = r"//[^\n]*|/\*.*?\*/"
CPP = re.compile(rf'(?P<comment>{COMMENT})|R"(?P<end>\w*)\(.*?\)(?P=end)"|{STRING}', re.S)
HASH = re.compile(rf"(?P<comment>(?<!\S)# [^\n]*)|(\"\"\"|''')[\s\S]*?\2|{STRING}")
SCRIPT = re.compile(
    rf"(?P<comment>{COMMENT})|{STRING}|(?P<template>`)|(?P<brace>[{{}}])"
    r"|(?:(?<=[(,=:\[!&|?{};>])|(?<=return))\s*/(?![/*])(?:\\.|\[(?:\\.|[^\]\\\n])*\]|[^/\\\n\[])+/",
    re.S,
)
TEMPLATE = re.compile(r"(?:\\.|[^`\\$]|\$(?!\{))*(\$\{|`)", re.S)


def blank(text):
    return re.sub(r"[^\n]", " ", text)


def split(text, suffix):
    """The code with blanks for comments and strings, and the comments with their places."""
    pattern = CPP if suffix in CPP_SUFFIXES else SCRIPT if suffix in SCRIPT_SUFFIXES else HASH
    code, comments, at, depths = [], [], 0, [0]
    while match := pattern.search(text, at):
        code.append(text[at : match.start()])
        at = match.end()
        found = match.groupdict()
        if found["comment"]:
            comments.append((match.start(), match[0]))
        brace = found.get("brace")
        resumes = brace == "}" and depths[-1] == 0 and len(depths) > 1
        if found.get("template") or resumes:  # text up to the next value, or to the end
            if resumes:
                depths.pop()
            rest = TEMPLATE.match(text, at)
            code.append(" " + blank(rest[0]))
            at = rest.end()
            if rest[1] == "${":
                depths.append(0)
        elif brace:
            depths[-1] += 1 if brace == "{" else -1
            code.append(brace)
        else:
            code.append(blank(match[0]))
    return "".join(code) + text[at:], comments


def functions(code):
    """Name, first line and number of lines of each function: clang-format puts a blank before the
    brace of a body, and none before the brace of an initialiser."""
    code = re.sub(r"(?m)^[ \t]*#(?:.*\\\n)*.*", lambda m: blank(m[0]), code)
    start, body, depth, initialisers = 0, None, 0, 0
    for match in re.finditer(r"[{};]", code):
        at, kind = match.start(), match[0]
        head = code[start:at]
        if body is None and kind == "{":
            opens = re.search(r"[\w)}>\]] $", head) and ")" in head and "concept" not in head
            if opens and not re.match(r"\s*(?:\w+:\s+)?(?:namespace|class|struct|enum)\b", head):
                body, depth = start + len(head) - len(head.lstrip()), 0
            elif head.endswith(" ") and not head.endswith("= "):
                start = at + 1  # a class or a namespace
            else:
                initialisers += 1
        elif body is None and kind == "}" and initialisers > 0:
            initialisers -= 1
        elif body is not None and kind == "}" and depth == 0:
            name = re.search(r"(\w+)\s*\(\s*(\w*),?\s*(\w*)", code[body:at])
            name = name and (".".join(name.groups()[1:]) if name[1] == "TEST" else name[1])
            yield name, code.count("\n", 0, body) + 1, code.count("\n", body, at) + 1
            body, start = None, at + 1
        elif body is not None:
            depth += {"{": 1, "}": -1, ";": 0}[kind]
        elif kind != "{":
            start = at + 1


CPP_SUFFIXES, SCRIPT_SUFFIXES = {".cpp", ".hpp", ".h", ".def"}, {".js", ".mjs", ".css"}
HASH_SUFFIXES = {".py", ".pyi", ".sh", ".cmake", ".txt"}
tree = pathlib.Path(sys.argv[1])
files = [f for room in ROOMS for f in sorted((tree / room).rglob("*")) if f.is_file()]
names = {file.name for file in [*files, *tree.glob("*"), *tree.glob("cmake/*")]}
complaints, long = [], set()
for file in files:
    name = str(file.relative_to(tree))
    if file.suffix not in CPP_SUFFIXES | SCRIPT_SUFFIXES | HASH_SUFFIXES:
        continue
    if file.suffix == ".txt" and file.name != "CMakeLists.txt":
        continue
    text = file.read_text(encoding="utf-8")
    code, comments = split(text, file.suffix)
    place = lambda at: f"{name}:{text.count(chr(10), 0, at) + 1}: "
    if file.suffix not in {".css", ".sh", ".cmake", ".txt"}:
        for match in FORBIDDEN.finditer(code):
            complaints.append(place(match.start()) + f"'{match[0]}' is no name, expected a noun")
    for at, comment in comments:
        for match in FILE.finditer(comment):
            if pathlib.Path(match[0]).name not in names | ELSEWHERE:
                complaints.append(place(at + match.start()) + f"{match[0]} is no file of the tree")
    measured = file.suffix in {".cpp", ".hpp"} and not name.startswith("tests/")
    for function, line, lines in functions(code) if measured else ():
        if lines <= MOST_LINES:
            continue
        long.add(f"{name}:{function}")
        if f"{name}:{function}" not in LONG:
            complaints.append(
                f"{name}:{line}: {function} has {lines} lines, expected {MOST_LINES} at most"
            )
complaints += [f"sources.sh: {name} is listed and not long" for name in LONG.keys() - long]
if len(LONG) > MOST_LONG:
    complaints.append(f"sources.sh: lists {len(LONG)} functions, expected {MOST_LONG} at most")
print("\n".join(complaints), file=sys.stderr)
sys.exit(bool(complaints))
PYTHON
