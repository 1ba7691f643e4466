#!/bin/sh
# check.sh PROGRAM RESULTS NODE_MODULES DEMO: the report, the demo's among them, in headless
# Chromium. Exit code 77, a skip to ctest, where what draws it is not installed.
for program in node chromium; do
    command -v $program >/dev/null ||
        { echo "skipped: $program is missing (tests/apt-packages.txt; ./test all installs it)"; \
        exit 77; }
done
[ -f "$3/vega/build/vega.min.js" ] ||
    { echo "skipped: $3 holds no vega (npm ci at the root of the sources)"; exit 77; }
[ -f "$3/axe-core/axe.min.js" ] ||
    { echo "skipped: $3 holds no axe-core (npm ci at the root of the sources)"; exit 77; }
exec node "$(dirname "$0")/check.mjs" "$1" "$2" "$3" "$4"
