#!/bin/sh
# ./demo from a finished build: the line of it that runs the suite, with PROGRAM and FOLDER in place
# of its own. Its answer is 33 lines at most, with a verdict on each of the four strings, and takes
# less than 30 s of one processor. usage: demo.sh PROGRAM FOLDER [TREE]
program=$(realpath "$1") folder=$2
cd "${3:-$(dirname "$0")/..}" || exit 2
complain() { echo "./demo: $*" >&2; cat "$folder.said" >&2; exit 1; }
rm -rf "$folder"
is='build/release/jvari suite demo --out report/demo'
line=$(sed -n "s#^$is \"\\\$@\"#\"\$program\" suite demo --out \"\$folder\"#p" demo)
[ -n "$line" ] ||
    { echo "./demo: no line of it begins with $is" >&2; exit 1; }
export JVARI_CACHE=  # none: references are computed
eval "$line" >"$folder.said" || complain "ended with $?"
times >"$folder.times"  # not behind a pipe: the times are of this shell's children
spent=$(awk 'NR == 2 { gsub(/[ms]/, " "); print $1 * 60 + $2 + $3 * 60 + $4 }' "$folder.times")
[ "$(wc -l <"$folder.said")" -le 33 ] ||
    complain "says $(wc -l <"$folder.said") lines, expected 33 at most"
[ "$(grep -c '^the cheapest scheme on' "$folder.said")" = 4 ] ||
    complain "says no verdict on four strings"
[ "$(grep -c '^advice on .*; .*the advice h' "$folder.said")" = 4 ] ||
    complain "does not say of four strings whether the advice holds"
[ "$(grep -c ' within ' "$folder.said")" -ge 16 ] || complain "says too few accuracies"
[ -f "$folder/report.html" ] || complain "there is no report"
echo "processor time of the demo: $spent s"
awk -v spent="$spent" 'BEGIN { exit spent >= 30 }' ||
    complain "takes $spent s of a processor"
