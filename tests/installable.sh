#!/bin/sh
# installable.sh BUILD: `cmake --install BUILD` works right after `cmake --build BUILD --target
# jvari`. What makes each file that it installs is among the commands of that target. 77: the build
# is not by ninja, which says what makes a file.
set -eu
build=$(cd "$1" && pwd)
[ -f "$build/build.ninja" ] || exit 77
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
ninja -C "$build" -t commands jvari > "$dir/commands"
grep -o ' FILES "[^"]*"' "$build/cmake_install.cmake" | sed 's/.*"\(.*\)"/\1/' |
    grep -F "$build/" > "$dir/files"
count=0
while read -r file; do
    # written when CMake configures
    case $file in */CMakeFiles/Export/* | */jvariConfig*.cmake | */copyright) continue ;; esac
    made=$(ninja -C "$build" -t commands "${file#"$build"/}" | tail -1)
    grep -qxF -- "$made" "$dir/commands" ||
        { echo "target jvari does not make $file, which is installed" >&2; exit 1; }
    count=$((count + 1))
done < "$dir/files"
[ "$count" -ge 7 ] ||
    { echo "$count files of the build are installed: this is not read right" >&2; exit 1; }
