#!/bin/sh
# The table of docs/schemes.md between "<!-- jvari list -->" and "<!-- end -->", and the notes below
# it, are what the program says. The head of the table stays as it is and names every feature.
# usage: readme.sh PROGRAM [TREE]; with WRITE=1 in the environment the table is made so.
tree=${2:-$(dirname "$0")/..}
cd "$tree" || exit 2
scratch=$(mktemp -d) && trap 'rm -rf "$scratch"' EXIT
text=docs/schemes.md
"$1" list --json >"$scratch/list" || exit 2
python3 - "$text" "$scratch/list" >"$scratch/text" <<'PYTHON' || exit 1
import json, sys
begin, end = "<!-- jvari list -->\n", "<!-- end -->\n"
above, table = open(sys.argv[1]).read().split(begin)
table, below = table.split(end)
head = table.split("\n", 1)[0]
features = [name.strip() for name in head.split("|")[2:-2]]
said = json.load(open(sys.argv[2]))
rows, notes = [], {}
for d in said["schemes"] + said["references"]:
    if d["control"]:
        continue
    unnamed = set(d["represents"]) - set(features)
    assert not unnamed, f"the head of the table lacks {unnamed}"
    near = {a["feature"] for a in d["approximates"]}
    cells = ["◐" if f in near else "●" if f in d["represents"] else "" for f in features]
    rows.append(f"| `{d['name']}` |" + "".join(c + "|" for c in cells) + f" {d['balance']} |")
    facts = ", ".join(f"{a['feature']} (fact `{a['fact']}`)" for a in d["approximates"])
    note = " ".join(filter(None, [facts and f"◐ {facts}.", d["note"]]))
    if note:
        notes.setdefault(note, []).append(f"`{d['name']}`")
lines = [head, "|---|" + ":-:|" * len(features) + "---|", *rows, "",
         "● as in the scene; ◐ approximated, and a fact of the run says how. "
         "Every scheme takes several strings and a body.", "",
         *(f"- {', '.join(names)}: {note}" for note, names in notes.items()), "", ""]
print(above + begin + "\n".join(lines) + end + below, end="")
PYTHON
if [ -n "$WRITE" ]; then cp "$scratch/text" "$text"
else diff "$text" "$scratch/text" ||
    { echo "the table in $text is not what 'jvari list --json' says" >&2; exit 1; }
fi
