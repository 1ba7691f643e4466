#!/bin/sh
# docs/first_minutes.md works as it stands: its commands, five at most, run one after the other in
# an empty folder, and the last ends in the answer that the text states. usage: first_minutes.sh
# PROGRAM [TREE]
program=$(realpath "$1")
tree=$(cd "${2:-$(dirname "$0")/..}" && pwd)
scratch=$(mktemp -d) && trap 'rm -rf "$scratch"' EXIT
cd "$scratch" || exit 2
complain() { echo "docs/first_minutes.md: $*" >&2; exit 1; }
export JVARI_CACHE=

mkdir bin && ln -s "$program" bin/jvari && PATH=$scratch/bin:$PATH
sed -n 's/^    \(jvari .*\)/\1/p' "$tree/docs/first_minutes.md" >commands
[ "$(wc -l <commands)" -ge 1 ] && [ "$(wc -l <commands)" -le 5 ] ||
    complain "has $(wc -l <commands) commands, expected one to five"
node=$tree/node_modules/vega/build/vega.min.js
while read -r command; do
    case $command in *--plot*) [ -f "$node" ] && command -v node >/dev/null ||
        command=$(echo "$command" | sed 's/--plot [^ ]*//') ;; esac
    sh -c "$command" >said 2>errors </dev/null || { cat errors >&2; complain "fails: $command"; }
done <commands

cat said >&2
grep -qE 'within 1 % +(none|cannot)' said || complain "the answer to 1 % is not that there is none"
# a busy machine may prefer the second
grep -qE 'third_octave_db  within 3 dB.* at (44.1|88.2) kHz' said ||
    complain "the answer to 3 dB is at none of the lowest rates"
grep -q 'smoothing' "$tree/docs/first_minutes.md" && grep -q 'smoothing' my_guitar.toml ||
    complain "the scene does not speak of smoothing"
[ -f guitar/report.html ] || complain "there is no report"
