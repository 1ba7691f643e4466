#!/bin/sh
# The README's capability table is what the program says. usage: readme.sh PROGRAM
cd "$(dirname "$0")/.." || exit 2
table=$(mktemp) && trap 'rm -f "$table"' EXIT
sed -n '/^<!-- jvari list schemes --markdown -->$/,/^<!-- end -->$/p' README.md | sed '1d;$d' >"$table"
"$1" list schemes --markdown --quiet | diff - "$table" || { echo "the table in README.md is not what 'jvari list schemes --markdown' prints" >&2; exit 1; }
