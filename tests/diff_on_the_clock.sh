#!/bin/sh
# Does `jvari diff` find a scheme that is a third slower, and nothing between two runs of one
# program? On the real clock, so it is for the machine at hand and no test: each repeat runs a small
# comparison with the honest plugin, with the slow one, and with the honest one again. usage:
# diff_on_the_clock.sh JVARI HONEST.so SLOW.so [REPEATS]
[ $# -ge 3 ] || { sed -n 2,4p "$0" >&2; exit 2; }
jvari=$1 honest=$2 slow=$3 repeats=${4:-10}
work=$(mktemp -d) && trap 'rm -rf "$work"' EXIT || exit 2
compare() {  # PLUGIN OUT
    schemes=honest,modal_two_point,modal_two_point_trapezoidal,modal_spatial_newton
    "$jvari" compare free_string --schemes $schemes,finite_difference_explicit \
        --rates 44100,88200,176400 --duration 0.1 --repeats 5 --quiet --plugin "$1" \
        --out "$work/$2" >"$work/log" 2>&1 ||
        { cat "$work/log" >&2; exit 2; }
}
k=0 found=0 silent=0
while [ $((k += 1)) -le "$repeats" ]; do
    rm -rf "$work"/?
    compare "$honest" a; compare "$slow" b; compare "$honest" c
    "$jvari" diff "$work/a" "$work/b" >"$work/slow"; [ $? = 4 ] &&
        grep -q '^  honest' "$work/slow" && : $((found += 1))
    "$jvari" diff "$work/a" "$work/c" >"$work/same"
    grep -q '0 worse, 0 better, 0 moved' "$work/same" && : $((silent += 1))
    echo "$k: found $found, silent $silent; load $(cut -d' ' -f1 /proc/loadavg)"
done
