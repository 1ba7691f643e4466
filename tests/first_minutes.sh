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

figure() { # CELLS COLUMN COMPLIANCE MODES RATE: of modal_two_point
    sed 's/"[^"]*"/x/g' "$1" | awk -F, -v column="$2" -v compliance="compliance=$3" -v modes="$4" -v rate="$5" '
        NR == 1 { for (i = 1; i <= NF; ++i) at[$i] = i }
        $at["scheme"] == "modal_two_point" && $at["options"] == compliance && $at["modes"] == modes &&
            $at["rate"] == rate { print $at[column] }'
}
# What the page says, with figures that the run has: whatever is the cheapest on a busy machine. A
# run may have been ended there because a cheaper one is as accurate.
stated() { # FORMAT FACTOR CELLS COLUMN COMPLIANCE MODES RATE
    found=$(figure "$3" "$4" "$5" "$6" "$7")
    [ -n "$found" ] || ! grep -q 'were ended after' said || return 0
    [ -n "$found" ] || complain "there is no run with $6 modes at $7 Hz"
    text=$(awk -v format="$1" -v x="$found" -v factor="$2" 'BEGIN { printf format, x * factor }')
    tr '\n' ' ' <"$tree/docs/$page" | grep -qF "$text" || complain "does not say: $text"
}

follow at_rest.md
contacts=$(($(wc -l <impacts.csv) - 1))
grep -qF "has $contacts contacts in 0.1 s" "$tree/docs/$page" || complain "there are $contacts contacts"
awk -F, 'NR > 2 && $4 == 0 {free = 1} END {exit !free}' rest.csv || complain "the string stays on the bridge"
stated "with 133 modes and an error of %.3f %%" 100 rest/cells.csv error_l2_50ms matched 133 44100
stated "180 modes at 176.4 kHz, for %.2f %%" 100 rest/cells.csv error_l2_50ms own 180 176400
# time, nut, y03, bridge, thread: the bridge holds its string for the first millisecond
awk -F, 'NR > 2 && $1 < 1e-3 && ($4 < 1.98 || $4 > 1.99) {exit 1}' rest.csv ||
    complain "the bridge does not push with 1.98 N"
# which of those that do is the cheapest is a matter of the clock
grep -qE 'error_l2_50ms +within 1 % +modal_' said || complain "no scheme is within 1 %"
[ -s next.csv ] || complain "the run does not go on"

follow first_minutes.md
cat said >&2
grep -qE 'within 1 % +(none|cannot)' said || complain "the answer to 1 % is not that there is none"
stated "178 modes at 176.4 kHz errs by %.1f %%" 100 guitar/cells.csv error_l2_50ms matched 178 176400
stated "132 modes at 44.1 kHz errs by %.1f dB" 1 guitar/cells.csv third_octave_db matched 132 44100
# a busy machine may prefer the second
grep -qE 'third_octave_db  within 3 dB.* at (44.1|88.2) kHz' said ||
    complain "the answer to 3 dB is at none of the lowest rates"
grep -q 'smoothing' "$tree/docs/first_minutes.md" && grep -q 'smoothing' my_guitar.toml ||
    complain "the scene does not speak of smoothing"
[ -f guitar/report.html ] || complain "there is no report"
