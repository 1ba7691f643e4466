#!/bin/sh
# The templates of docs/own-scheme on an exported problem: they give modal_two_point's motion,
# `jvari judge` says how wrong it is, and what is no trace of the scene is refused with a sentence.
# usage: own_scheme.sh JVARI
. "$(dirname "$0")/outside.sh"
templates=$tree/docs/own-scheme
python=
for candidate in python3 /usr/bin/python3; do
    "$candidate" -c "import numpy" 2>/dev/null && python=$candidate && break
done
"$jvari" export $scene --rate 88200 --out problem.json --quiet || fail "export fails"
if [ -n "$python" ]; then
    "$python" "$templates/two_point.py" problem.json python.csv &&
        agree "the Python template" python.csv || fail "the Python template fails"
fi

# Its balance and its convergence are asked, and a gain of 2 % that is planted in it is found.
if [ -n "$python" ]; then
    said=$("$jvari" check two_point --external "$python $templates/two_point.py" 2>&1) &&
        [ "$(echo "$said" |
            grep -cE 'kept +(KeepsItsEnergyLedgerIn|ConvergesToTheReference|StaysSound)')" = 4 ] ||
        fail "the Python template is not asked for its balance, or breaks a promise: $said"
    sed 's/"bridge_force": F_b/"bridge_force": 1.02 * F_b/' "$templates/two_point.py" > gains.py
    said=$("$jvari" check gains --external "$python gains.py" --only ConvergesToTheReference 2>&1)
    [ $? = 4 ] && echo "$said" | grep -q "tap bridge errs by 0.02 0.02 0.02 0.02" ||
        fail "a planted gain is not found: $said"
fi
if command -v octave-cli >/dev/null; then
    octave-cli "$templates/two_point.m" problem.json octave.csv 2>/dev/null &&
        agree "the Octave template" octave.csv || fail "the Octave template fails"
fi

# A trace of one's own beside the scheme that it repeats has the same error, and its cost as
# reported.
"$jvari" judge $scene --trace 88200=own.csv --name again --cost 0.25 --schemes modal_two_point \
    --out judged --quiet || fail "judge fails"
awk -F, 'NR == 1 { for (k = 1; k <= NF; ++k) at[$k] = k }
    NR > 1 { error[$at["scheme"]] = $at["error_l2_10ms"] }
    $at["scheme"] == "again" { cost = $at["cost_s_per_s"]; options = $at["options"] }
    END { exit !(error["again"] == error["modal_two_point"] && error["again"] > 0 &&
        cost + 0 == 0.25 && options == "cost=as_reported") }' \
    judged/cells.csv || fail "the line in the picture is not that of the trace"
grep -q again judged/work_precision.svg || fail "the picture lacks the trace"

said=$("$jvari" judge $scene --trace 88200=own.csv --schemes modal_two_point)
echo "$said" |
    grep -q "it differs from modal_two_point by 0 (nut), 0 (y03), 0 (bridge), 0 (thread)" ||
    fail "a trace differs from its own scheme: $said"

# A matched trace is nearer to the scene than to a string of as many modes with its own compliance:
# no error from such a string is told.
"$jvari" run $scene --scheme modal_two_point --rate 88200 --option compliance=matched \
    --out matched.csv --quiet || exit 2
of_it() {
    "$jvari" judge $scene --trace "88200=$1" | grep -c "against a string of as many modes"
}
[ "$(of_it own.csv) $(of_it matched.csv)" = "1 0" ] ||
    fail "an error is told from a string of another compliance, or from none"

# A fault that is planted in one line of the Octave template is told at its size, however wrong the
# scheme itself is.
if command -v octave-cli >/dev/null; then
    sed 's/F_c = v_c - beta_c\*F_b;/F_b = 1.001*F_b; &/' "$templates/two_point.m" > mine.m
    octave-cli mine.m problem.json mine.csv 2>/dev/null || fail "the changed Octave template fails"
    said=$("$jvari" judge $scene --trace 88200=mine.csv --schemes modal_two_point |
        sed -n 's/.*it differs from modal_two_point by \([0-9.e-]*\) (nut).*/\1/p')
    awk -v d="$said" 'BEGIN { exit !(d > 2e-4 && d < 5e-3) }' ||
        fail "a planted error of 1e-3 is told as \"$said\""
fi

# A planted error is told at its right size: 1e-3 of every value, where the reference is
# modal_two_point's own solution.
"$jvari" judge free_string --duration 0.01 --trace 44100=nothing.csv 2>/dev/null &&
    fail "a file that is not there is judged"
"$jvari" run free_string --duration 0.02 --scheme exact_linear --modes 2000 --out free.csv \
    --quiet || exit 2
awk -F, -v OFS=, 'NR > 1 { for (k = 2; k <= NF; ++k) $k = sprintf("%.17g", 1.001 * $k) } 1' \
    free.csv > loud.csv
"$jvari" judge free_string --duration 0.02 --trace 44100=loud.csv | grep -q "errs by 0.1 %" ||
    fail "an error of 1e-3 is not told"

# refused WHAT SENTENCE FILE: exit code 2, the sentence, and nothing written
refused() {
    said=$("$jvari" judge $scene --trace "44100=$3" --out nowhere 2>&1)
    code=$?
    [ $code = 2 ] && echo "$said" | grep -q "$2" && [ ! -e nowhere ] && return
    echo "$said" >&2
    fail "$1: expected \"$2\" and exit code 2, found $code"
}
sed 's/^0.0001/0.0002/' own.csv > times.csv && refused "other row times" "expected 0.0001" times.csv
cut -d, -f1-3,5 own.csv > missing.csv && refused "a missing tap" "tap bridge is missing" missing.csv
{ cat own.csv; tail -1 own.csv | sed 's/^[^,]*/0.010022675736961451/'; } > long.csv &&
    refused "a row too many" "has 443 rows, the scene has 442" long.csv
head -c 20000 own.csv > half.csv && refused "half a file" "cut off" half.csv
sed '5s/,[^,]*$/,twelve/' own.csv > word.csv && refused "a word" "expected a number" word.csv
: > empty.csv && refused "an empty file" "cannot read" empty.csv
head -300 own.csv > early.csv && refused "an early end" "has 299 rows, the scene has 442" early.csv
sed '300s/,[^,]*$/,1e400/' own.csv > large.csv &&
    refused "a number beyond all" "1e400\", expected a number" large.csv
head -c -3 own.csv > last.csv && refused "a last number that is cut off" "cut off" last.csv
sed '1s/$/,nut/; 1!s/$/,0/' own.csv > twice.csv &&
    refused "a tap that has two columns" "two columns .nut" twice.csv
tr ',' ';' < own.csv > semicolons.csv && refused "semicolons" "Expected commas" semicolons.csv
sed '1s/$/,energy_stored_J,energy_supplied_J,energy_dissipated_J/; 1!s/$/,nan,0,0/' own.csv \
    > energy.csv && refused "NaN among energies" "energy_stored_J holds no number" energy.csv
{ printf '\357\273\277'; cat own.csv; } > marked.csv
"$jvari" judge $scene --trace 44100=marked.csv > /dev/null ||
    fail "a byte-order mark hides the first column"
for name in ../../x a/b "" reference "$(printf 'x%.0s' $(seq 300))"; do
    said=$("$jvari" judge $scene --trace 44100=own.csv --name "$name" --out unfit 2>&1)
    [ $? = 2 ] && echo "$said" | grep -q "the scheme's name" && [ ! -e unfit/cells.csv ] ||
        fail "a trace called \"$name\" is not refused before it is judged: $said"
done
mkfifo pipe.wav
said=$(timeout 20 "$jvari" judge $scene --tap nut --trace 44100=pipe.wav 2>&1)
[ $? = 2 ] && echo "$said" | grep -q "no file" || fail "a pipe is waited for as a sound: $said"
cp own.csv trace.txt && refused "another extension" "expected .csv or .wav" trace.txt

# What a plugin prints does not stand among the JSON, and one that ends the program is no success.
cat > talks.c <<'END'
#include <stdio.h>
#include <stdlib.h>
#include "jvari_scheme.h"
static const struct jvari_plugin nothing = {sizeof nothing, JVARI_SCHEME_VERSION};
const struct jvari_plugin* jvari_schemes(void) {
    puts("hello");
    if (getenv("LEAVES")) exit(0);
    return &nothing;
}
END
if command -v cc >/dev/null; then
    cc -shared -fPIC -I"$tree/schemes/open" talks.c -o talks.so ||
        fail "the plugin that prints does not compile"
    run="run $scene --scheme modal_two_point --plugin ./talks.so"
    "$jvari" $run --json > talks.json 2>/dev/null && [ "$(head -c 1 talks.json)" = "{" ] ||
        fail "a plugin prints into the JSON: $(head -1 talks.json)"
    LEAVES=1 "$jvari" $run >/dev/null 2>&1
    [ $? = 4 ] || fail "a plugin that calls exit(0) ends the program as if the work were done"
fi

# Any program as a scheme, by files: it has the same rows, and its cells are kept.
cat > copies.sh <<'END'
#!/bin/sh
grep -q '^"contact_weights": \[\[' "$1" && cp own.csv "$2"
END
for round in kept again; do
    "$jvari" compare $scene --external "sh copies.sh" --schemes copies,modal_two_point \
        --rates 88200 --modes 133 --repeats 1 --out external --resume 2> $round.txt >$round.out ||
        fail "--external fails: $(cat $round.txt)"
done
grep -q "errors of 3 of 3 cells were read back" again.txt ||
    fail "cells of a command are not kept: $(cat again.txt)"
grep -q "cost of copies.*external, not compared" kept.out ||
    fail "the cost of a command is not marked: $(cat kept.out)"
exit $status
