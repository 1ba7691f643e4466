#!/bin/sh
# Do the tests see a fault? Plants one at a time (faults.txt) in a copy of the sources, builds the one test that should see it, and prints
# a table. A fault that is caught where it stands has its test; one that survives asks for one.
#   tests/mutants/run.sh [FOLDER] [NAME ...]     FOLDER: where copy and build lie, kept for the next time (default: build/mutants)
# Half a minute a fault where others share the two cores, and a whole build before the first. Ends with 1 where more than two survive.
set -eu
source=$(cd "$(dirname "$0")/../.." && pwd)
folder=${1:-$source/build/mutants}
[ $# -gt 0 ] && shift
mkdir -p "$folder/source"
folder=$(cd "$folder" && pwd)  # tests are started in it
copy=$folder/source build=$folder/source/build/release
for file in $(cd "$source" && git ls-files --cached --others --exclude-standard); do  # what is the same keeps its date and its object
    cmp -s "$source/$file" "$copy/$file" && continue
    mkdir -p "$(dirname "$copy/$file")"
    cp "$source/$file" "$copy/$file"
done
[ -f "$build/build.ninja" ] || (cd "$copy" && cmake --preset release) >"$folder/configure.log"

faults() { grep -v '^#' "$source/tests/mutants/faults.txt" | grep '|'; }
wanted() {  # no names: all
    [ $# -eq 1 ] && return 0
    name=$1
    shift
    for one in "$@"; do [ "$one" = "$name" ] && return 0; done
    return 1
}
targets=$(faults | cut -d'|' -f3 | sort -u)
# shellcheck disable=SC2086
ninja -C "$build" $targets >"$folder/build.log" 2>&1 || { tail -20 "$folder/build.log"; exit 2; }

passes() {  # TEST FILTER LOG
    at=$(find "$build" -maxdepth 2 -type f -name "$1" | head -n 1)
    (cd "$folder" && timeout 300 "$at" --gtest_brief=1 --gtest_filter="$2") >"$3" 2>&1 </dev/null
}
faults >"$folder/faults.now"
cut -d'|' -f3,4 "$folder/faults.now" | sort -u | while IFS='|' read -r test filter; do
    passes "$test" "$filter" "$folder/$test.log" || { echo "$test fails without a fault: $folder/$test.log"; exit 2; }
done

caught=0 planted=0
: >"$folder/table.txt"
while IFS='|' read -r name file test filter script; do
    wanted "$name" "$@" || continue
    planted=$((planted + 1))
    sed -i -E -e "$script" "$copy/$file"
    if cmp -s "$source/$file" "$copy/$file"; then outcome='NOT PLANTED'
    elif ! ninja -C "$build" "$test" >"$folder/$name.log" 2>&1 </dev/null; then outcome='DOES NOT COMPILE'
    else
        if passes "$test" "$filter" "$folder/$name.log"; then outcome=SURVIVED
        else
            outcome=caught
            caught=$((caught + 1))
        fi
    fi
    by=$(sed -n 's/^\[  FAILED  \] \([^ ]*\).*/\1/p' "$folder/$name.log" | head -n 1)
    printf '%-44s %-36s %-16s %s\n' "$name" "$file" "$outcome" "$by" | tee -a "$folder/table.txt"
    cp "$source/$file" "$copy/$file"
done <"$folder/faults.now"
echo "$caught of $planted caught"
[ $# -gt 0 ] || [ "$caught" -ge $((planted - 2)) ]
