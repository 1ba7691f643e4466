#!/bin/sh
# What README.md and results/README.md say of trimmed models is what results/trim holds: modes,
# rates, errors and how much cheaper they are. usage: trimmed.sh [TREE]
cd "${1:-$(dirname "$0")/..}" || exit 2
# figures RECORD: scheme and rate of the whole model; modes, rate, error of the trimmed one; ratio
# of costs; is it within
figures() {
    sed 's/"[^"]*"/x/g' "results/trim/$1/path.csv" | awk -F, '
        NR == 1 { for (i = 1; i <= NF; ++i) at[$i] = i }
        NR == 2 { scheme = $at["scheme"]; rate = $at["rate"]; cost = $at["cost_s_per_s"] }
        END {
            ratio = sprintf("%.3g", cost / $at["cost_s_per_s"]) + 0
            print scheme, rate, $at["modes"], $at["rate"], $at["error"], ratio, $at["within"]
        }'
}
wrong=0
say() { echo "$1" >&2; wrong=1; }

set -- $(figures tanpura_c3_release-1)
text=$(tr '\n' ' ' <README.md | grep -o 'By `jvari trim`.*\[trim\](results')
khz() { awk -v hz="$1" 'BEGIN { print hz / 1000 }'; }
wanted="$3 matched modes at $(khz "$4") kHz keep the nut force within 1 %"
case $text in
    *"$wanted"*) ;;
    *) say "README.md: results/trim/tanpura_c3_release-1 has: $wanted" ;;
esac

for folder in results/trim/*/; do
    name=$(basename "$folder")
    set -- $(figures "$name")
    row=$(grep "^| \`$name\` |" results/README.md) ||
        { say "results/README.md has no row of $name"; continue; }
    [ "$7" = yes ] || say "$folder: its last model is not within the tolerance"
    echo "$row" | awk -F'|' -v whole="\`$1\` ×$(($2 / 44100))" \
        -v modes="$3 modes, ×$(($4 / 44100))" -v error="$5" -v ratio="$6" '{
        scale = $6 ~ /%/ ? 100 : 1; split($6, printed, " ")
        off = printed[1] - scale * error
        exit !(index($4, whole) && index($5, modes) && off ^ 2 < 1e-18 && $7 + 0 == ratio)
    }' || say "results/README.md: $folder has $*
$row"
done
exit $wrong
