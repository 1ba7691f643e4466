#!/bin/sh
# Comments name things instead of pointing at them. In the C++, JavaScript and CSS of the product at
# most 70 words in 1 000 of all comments are pointer words, at most 2 are "what", and no file of 100
# words or more has more than 120. usage: pointer_words.sh [TREE]
python3 - "${1:-$(dirname "$0")/..}" <<'PYTHON'
import pathlib
import re
import sys

POINTER = set("of what that those it its one which where whose else as".split())
MOST, MOST_OF_A_FILE, MOST_WHAT = 70, 120, 2
ROOMS = ("scenes", "schemes", "reference", "analysis", "bench", "python", "web")
SUFFIXES = (".hpp", ".cpp", ".h", ".def", ".js", ".mjs", ".css")
KEPT = {"schemes/open/jvari_scheme.h"}  # an interface of C that plugins are compiled against

tree = pathlib.Path(sys.argv[1])
words = pointers = whats = 0
failed = False
for file in sorted(f for room in ROOMS for f in (tree / room).rglob("*") if f.suffix in SUFFIXES):
    text = file.read_text(encoding="utf-8")
    comments = " ".join(re.findall(r"(?<!:)//(.*)", text) + re.findall(r"/\*(.*?)\*/", text, re.S))
    own = [word.lower() for word in re.findall(r"[A-Za-z]+", comments)]
    pointing = sum(word in POINTER for word in own)
    words, pointers, whats = words + len(own), pointers + pointing, whats + own.count("what")
    name = str(file.relative_to(tree))
    if name not in KEPT and len(own) >= 100 and pointing > MOST_OF_A_FILE * len(own) / 1000:
        print(f"{name}: {1000 * pointing / len(own):.0f} pointer words in 1 000, expected {MOST_OF_A_FILE} at most")
        failed = True
for found, most, name in ((pointers, MOST, "pointer words"), (whats, MOST_WHAT, 'times "what"')):
    print(f"{1000 * found / words:.1f} {name} in 1 000 words of comment, expected {most} at most")
    failed = failed or found > most * words / 1000
sys.exit(failed)
PYTHON
