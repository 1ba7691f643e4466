#!/bin/sh
# clang-tidy (14) with the checks of .clang-tidy; every finding is an error. Exit 77 where clang-tidy is missing.
# usage: tidy.sh headers (all in one, which needs no build) | BUILD all | BUILD BASE (sources changed since a commit) | BUILD FILES ...
cd "$(dirname "$0")/.." || exit 2
[ "$1" = headers ] || [ $# -ge 2 ] || { echo "usage: tidy.sh headers | BUILD all|BASE|FILES ..." >&2; exit 2; }
tidy=$(command -v clang-tidy-14 || command -v clang-tidy) || { echo "no clang-tidy here" >&2; exit 77; }
said=$(mktemp -d) && trap 'rm -rf "$said"' EXIT
judge() {
    findings=$(grep -E '^[^ ]*:[0-9]+:[0-9]+: (warning|error): ' "$said/text" | sort -u)
    [ -z "$findings" ] || { echo "$findings" | sed "s|$PWD/||"; echo "$(echo "$findings" | wc -l) findings" >&2; exit 1; }
    exit 0
}
if [ "$1" = headers ]; then
    find scenes schemes reference analysis bench -name '*.hpp' ! -name '*-inl.hpp' | sort | sed 's|.*|#include "&"|' >"$said/headers.cpp"
    "$tidy" --quiet --config-file=.clang-tidy "$said/headers.cpp" -- -std=c++20 -I. >"$said/text" 2>/dev/null
    judge
fi
build=$1
shift
[ -f "$build/compile_commands.json" ] || { echo "no compile_commands.json in $build" >&2; exit 2; }
if [ "$1" = all ]; then files=$(find scenes schemes reference analysis bench -name '*.cpp' | sort)
elif [ -e "$1" ]; then files=$*
else files=$(git diff --name-only --diff-filter=d "$1" -- '*.cpp' | grep -E '^(scenes|schemes|reference|analysis|bench|tests)/') || exit 0
fi
# Of those that the build compiles; the list is printed with what was found.
for file in $files; do grep -q "\"file\": \".*/$file\"" "$build/compile_commands.json" && echo "$file"; done |
    xargs -r -n 1 -P "${JOBS:-2}" "$tidy" --quiet -p "$build" >"$said/text" 2>/dev/null
judge
