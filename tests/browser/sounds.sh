#!/bin/sh
# sounds.sh PROGRAM: the .wav of every scene of the library in headless Chromium. Exit code 77, a
# skip to ctest, where that is not installed.
for program in node chromium; do
    command -v $program >/dev/null ||
        { echo "skipped: $program is missing (tests/apt-packages.txt; ./test all installs it)"; \
        exit 77; }
done
exec node "$(dirname "$0")/sounds.mjs" "$1"
