#!/bin/sh
# The recipe of docs/ci.md on the template in C: the shell lines of its YAML run, but for those that
# install and build jvari. A fault in the motion fails `check`, one in the energies of a scheme that
# promises none fails `diff`. usage: ci.sh JVARI
program=$(realpath "$1")
tree=$(cd "$(dirname "$0")/.." && pwd) || exit 2
scratch=$(mktemp -d) || exit 2
trap 'rm -rf "$scratch"' EXIT
cd "$scratch" || exit 2
status=0
fail() { echo "docs/ci.md: $*" >&2; status=1; }
block() { sed -n "/^\`\`\`$1\$/,/^\`\`\`\$/{/^\`\`\`/!p}" "$tree/docs/ci.md"; }
mkdir -p jvari/build/release
ln -s "$tree/schemes" jvari/ && ln -s "$program" jvari/build/release/
block toml > regression.toml
block yaml | sed -n 's/^ *- run: //p' | grep -v 'apt-get\|\.ci/' > steps
[ "$(wc -l < steps)" = 4 ] || fail "expected four lines that build, check, run and compare"
# step NAME FILE: the line of that name ends as it should
step() { grep "$1" steps > line && sh -e line > said 2>&1; }
template=$tree/docs/own-scheme/two_point.c
cp "$template" . && step '^cc' && block sh > baseline.sh && sh -e baseline.sh > said 2>&1 ||
    fail "no baseline: $(cat said)"
for name in '^cc' ' check ' ' suite ' ' diff '; do
    step "$name" || fail "a step fails on the template: $(cat line said)"
done
grep -q '<testsuite name="two_point_in_c"' check.xml || fail "no check.xml"

# planted WHAT SED STEP SAYS: of the template so changed the step fails
planted() {
    sed "$2" "$template" > two_point.c
    cmp -s two_point.c "$template" && fail "$1: nothing was changed"
    step '^cc' && { [ "$3" = ' check ' ] || step ' suite '; } || fail "$1: $(cat said)"
    step "$3"
    [ $? = 4 ] && grep -q "$4" said || fail "$1 is not found by$3: $(cat said)"
}
planted "a force that is 2 % too large" \
    's/= contact(\(.*\));/= 1.02 * contact(\1);/' ' check ' BROKEN
planted "a loss that is not counted" \
    's/s->lost += p->thread_damping/& * 0.999/' ' diff ' 'flags .*energy'
exit $status
