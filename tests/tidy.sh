#!/bin/sh
# clang-tidy (14) with the checks of .clang-tidy; every finding is an error. Exit 77 where
# clang-tidy is missing. usage: tidy.sh BUILD rooms (headers, and sources room by room) | BUILD all
# | BUILD BASE (sources changed since a commit) | BUILD FILES ...
cd "$(dirname "$0")/.." || exit 2
[ $# -ge 2 ] || { echo "usage: tidy.sh BUILD rooms|all|BASE|FILES ..." >&2; exit 2; }
tidy=$(command -v clang-tidy-14 || command -v clang-tidy) ||
    { echo "no clang-tidy here" >&2; exit 77; }
said=$(mktemp -d) && trap 'rm -rf "$said"' EXIT
judge() {
    findings=$(grep -E '^[^ ]*:[0-9]+:[0-9]+: (warning|error): ' "$said/text" |
        sed "s|$PWD/||; s|^\./||" | sort -u)
    [ -z "$findings" ] ||
        { echo "$findings"; echo "$(echo "$findings" | wc -l) findings" >&2; exit 1; }
    exit 0
}
build=$1
shift
if [ "$1" = rooms ]; then
    # A room is read as one file, so that what its sources include is read once. Not here: the
    # folders whose sources name things alike (analysis, reference/exact, schemes but body),
    # Highway's, and the checks that take long (clang-analyzer) or only hint at speed.
    for room in scenes bench/*/ schemes/body reference; do
        find "$room" -name '*.cpp' ! -path 'reference/exact/*' | sort |
            sed 's|.*|#include "&"|' >"$said/$(echo "$room" | tr -d /).cpp"
    done
    find scenes schemes reference analysis bench -name '*.hpp' ! -name '*-inl.hpp' | sort |
        sed 's|.*|#include "&"|' >"$said/headers.cpp"
    find "$said" -name '*.cpp' -empty -delete
    # each its own text
    grep -oE 'JVARI_[A-Z_]+=' CMakeLists.txt | sort -u |
        sed 's/\(.*\)=/#define \1 "\1"/' >"$said/defined.hpp"
    slow=-clang-analyzer-*,-performance-inefficient-*,-performance-no-automatic-move
    export slow
    find "$said" -name '*.cpp' | xargs -n 1 -P "${JOBS:-2}" sh -c '"$0" --quiet \
        --config-file=.clang-tidy --checks="$slow",-bugprone-suspicious-include \
        --header-filter="(scenes|schemes|reference|analysis|bench)/.*\.[ch]pp" "$3" -- \
        -std=c++20 -include "$1/defined.hpp" -I. -I"$2/generated" \
        -isystem /usr/include/eigen3' "$tidy" "$said" "$build" >"$said/text" 2>/dev/null
    judge
fi
[ -f "$build/compile_commands.json" ] || { echo "no compile_commands.json in $build" >&2; exit 2; }
if [ "$1" = all ]; then files=$(find scenes schemes reference analysis bench -name '*.cpp' | sort)
elif [ -e "$1" ]; then files=$*
else
    files=$(git diff --name-only --diff-filter=d "$1" -- '*.cpp' |
        grep -E '^(scenes|schemes|reference|analysis|bench|tests)/') || exit 0
fi
# Of those that the build compiles; the list is printed with what was found.
for file in $files; do grep -q "\"file\": \".*/$file\"" "$build/compile_commands.json" &&
    echo "$file"; done |
    xargs -r -n 1 -P "${JOBS:-2}" "$tidy" --quiet -p "$build" >"$said/text" 2>/dev/null
judge
