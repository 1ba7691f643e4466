#!/bin/sh
# The table of docs/schemes.md between "<!-- jvari list schemes --markdown -->" and "<!-- end -->" is what the program prints.
# usage: readme.sh PROGRAM [TREE]; with WRITE=1 in the environment it is made so.
tree=${2:-$(dirname "$0")/..}
cd "$tree" || exit 2
scratch=$(mktemp -d) && trap 'rm -rf "$scratch"' EXIT
text=docs/schemes.md begin='<!-- jvari list schemes --markdown -->'
grep -qxF -- "$begin" "$text" || { echo "$text has no line '$begin'" >&2; exit 1; }
"$1" list schemes --markdown --quiet >"$scratch/table" || exit 2
awk -v begin="$begin" -v table="$scratch/table" '
    /^<!-- end -->$/ { skip = 0 }
    !skip
    $0 == begin { while ((getline line <table) > 0) print line; skip = 1 }' "$text" >"$scratch/text"
if [ -n "$WRITE" ]; then cp "$scratch/text" "$text"
else diff "$text" "$scratch/text" || { echo "the table in $text is not what 'jvari list schemes --markdown' prints" >&2; exit 1; }
fi
