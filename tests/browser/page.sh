#!/bin/sh
# page.sh PROGRAM RESULTS SOURCES NODE_MODULES: the JavaScript of the report under node. Exit code
# 77, a skip to ctest, where that is not installed.
command -v node >/dev/null ||
    { echo "skipped: node is missing (tests/apt-packages.txt; ./test all installs it)"; exit 77; }
exec node "$(dirname "$0")/page.mjs" "$@"
