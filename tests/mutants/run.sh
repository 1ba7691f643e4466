#!/bin/sh
# Do the tests see a fault? Plants one at a time (faults.txt) in a copy of the sources, builds the
# one test program that should see it, and prints a table. A fault that survives asks for a test.
#   tests/mutants/run.sh [FOLDER] [NAME ...]
# FOLDER: where copy and build lie, kept for the next time (default: build/mutants). Half a minute a
# fault, and a whole build before the first. Ends with 1 where more than two survive.
set -eu
source=$(cd "$(dirname "$0")/../.." && pwd)
folder=${1:-$source/build/mutants}
[ $# -gt 0 ] && shift
mkdir -p "$folder/source"
folder=$(cd "$folder" && pwd)  # tests are started in it
copy=$folder/source build=$folder/source/build/release
plant="python3 $source/tests/mutants/plant.py"
$plant
for file in $(cd "$source" && git ls-files --cached --others --exclude-standard); do
    cmp -s "$source/$file" "$copy/$file" && continue  # it keeps its date and its object
    mkdir -p "$(dirname "$copy/$file")"
    cp "$source/$file" "$copy/$file"
done
[ -f "$build/build.ninja" ] ||  # each file by itself: a fault is in one
    (cd "$copy" && cmake --preset release -DCMAKE_UNITY_BUILD=OFF) >"$folder/configure.log"

for name in "${@:-.*}"; do $plant list | grep "^$name "; done >"$folder/faults.now"
targets=$(cut -d' ' -f3 "$folder/faults.now" | sort -u)
# shellcheck disable=SC2086
ninja -C "$build" $targets >"$folder/build.log" 2>&1 || { tail -20 "$folder/build.log"; exit 2; }

passes() {  # TEST FILTER LOG
    at=$(find "$build" -maxdepth 2 -type f -name "$1" | head -n 1)
    (cd "$folder" && timeout 300 "$at" --gtest_brief=1 --gtest_filter="$2") >"$3" 2>&1 </dev/null
}
cut -d' ' -f3,4 "$folder/faults.now" | sort -u | while read -r test filter; do
    passes "$test" "$filter" "$folder/$test.log" ||
        { echo "$test fails without a fault: $folder/$test.log"; exit 2; }
done

while read -r name file test filter; do
    outcome=SURVIVED
    $plant "$name" "$copy"
    if ! ninja -C "$build" "$test" >"$folder/$name.log" 2>&1 </dev/null; then
        outcome='DOES NOT COMPILE'
    elif ! passes "$test" "$filter" "$folder/$name.log"; then
        outcome=caught
    fi
    by=$(sed -n 's/^\[  FAILED  \] \([^ ]*\).*/\1/p' "$folder/$name.log" | head -n 1)
    printf '%-44s %-36s %-16s %s\n' "$name" "$file" "$outcome" "$by"
    cp "$source/$file" "$copy/$file"
done <"$folder/faults.now" | tee "$folder/table.txt"
caught=$(grep -c ' caught ' "$folder/table.txt") planted=$(wc -l <"$folder/table.txt")
echo "$caught of $planted caught"
[ $# -gt 0 ] || [ "$caught" -ge $((planted - 2)) ]
