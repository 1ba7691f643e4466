#!/bin/sh
# Sources of product and tests: nothing is called made, told, said, held, asked or whoever, and files
# named in comments exist. usage: sources.sh [TREE]
python3 - "${1:-$(dirname "$0")/..}" <<'PYTHON'
import pathlib
import re
import sys

ROOMS = "scenes schemes reference analysis bench python web tests results docs".split()
FORBIDDEN = re.compile(r"(?<![\w$])(made|told|said|held|asked|whoever)(?![\w$])")
ELSEWHERE = {"allocator_interface.h", "highway.h", "NAME.cpp"}  # other libraries, a placeholder

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


CPP_SUFFIXES, SCRIPT_SUFFIXES = {".cpp", ".hpp", ".h", ".def"}, {".js", ".mjs", ".css"}
HASH_SUFFIXES = {".py", ".pyi", ".sh", ".cmake", ".txt"}
tree = pathlib.Path(sys.argv[1])
files = [f for room in ROOMS for f in sorted((tree / room).rglob("*")) if f.is_file()]
names = {file.name for file in [*files, *tree.glob("*"), *tree.glob("cmake/*")]}
complaints = []
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
print("\n".join(complaints), file=sys.stderr)
sys.exit(bool(complaints))
PYTHON
