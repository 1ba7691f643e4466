#!/bin/sh
# The digits of a result do not depend on the size of the machine's cache: four strings of 150 modes
# fill 33.6 kB. usage: other_cache.sh JVARI LIBRARY
scratch=$(mktemp -d) || exit 2
trap 'rm -rf "$scratch"' EXIT
run() {
    "$1" run tanpura_drone --scheme modal_two_point --rate 88200 --modes 150 --duration 0.02 \
        --quiet --out "$scratch/$2.csv"
}
run "$1" own && LD_PRELOAD=$2 run "$1" other || exit 2
cmp "$scratch/own.csv" "$scratch/other.csv"
