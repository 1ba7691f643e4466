#!/bin/sh
# docs/first_minutes.md and docs/at_rest.md work as they stand: their commands, five at most, run
# one after the other in an empty folder, and end in the answers that the text states. usage:
# first_minutes.sh PROGRAM [TREE]
program=$(realpath "$1")
tree=$(cd "${2:-$(dirname "$0")/..}" && pwd)
scratch=$(mktemp -d) && trap 'rm -rf "$scratch"' EXIT
cd "$scratch" || exit 2
complain() { echo "docs/$page: $*" >&2; exit 1; }
export JVARI_CACHE=

mkdir bin && ln -s "$program" bin/jvari && PATH=$scratch/bin:$PATH
node=$tree/node_modules/vega/build/vega.min.js
follow() { # PAGE: its commands; what they say
    page=$1
    sed -n 's/^    \(jvari .*\)/\1/p' "$tree/docs/$page" >commands
    [ "$(wc -l <commands)" -ge 1 ] && [ "$(wc -l <commands)" -le 5 ] ||
        complain "has $(wc -l <commands) commands, expected one to five"
    : >said
    while read -r command; do
        case $command in *--plot*) [ -f "$node" ] && command -v node >/dev/null ||
            command=$(echo "$command" | sed 's/--plot [^ ]*//') ;; esac
        sh -c "$command" >>said 2>errors </dev/null ||
            { cat errors >&2; complain "fails: $command"; }
    done <commands
}

follow at_rest.md
# time, nut, y03, bridge, thread: the bridge holds its string for the first millisecond
awk -F, 'NR > 2 && $1 < 1e-3 && ($4 < 1.98 || $4 > 1.99) {exit 1}' rest.csv ||
    complain "the bridge does not push with 1.98 N"
grep -qE 'error_l2_50ms +within 1 % .*matched, .* at 44.1 kHz, 0.0[12]' said ||
    complain "the answer to 1 % is another"
[ -s next.csv ] || complain "the run does not go on"

follow first_minutes.md
cat said >&2
grep -qE 'within 1 % +(none|cannot)' said || complain "the answer to 1 % is not that there is none"
# a busy machine may prefer the second
grep -qE 'third_octave_db  within 3 dB.* at (44.1|88.2) kHz' said ||
    complain "the answer to 3 dB is at none of the lowest rates"
grep -q 'smoothing' "$tree/docs/first_minutes.md" && grep -q 'smoothing' my_guitar.toml ||
    complain "the scene does not speak of smoothing"
[ -f guitar/report.html ] || complain "there is no report"
