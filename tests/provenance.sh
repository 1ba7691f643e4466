#!/bin/sh
# The key of a kept number covers every source that it depends on: a changed line in a room of
# bench, in the analysis or in a scheme changes the hash, a new room counts from its first file, and
# text changes nothing. usage: provenance.sh CMAKE [TREE]
cmake=$1
tree=$(cd "${2:-$(dirname "$0")/..}" && pwd) || exit 2
scratch=$(mktemp -d) || exit 2
trap 'rm -rf "$scratch"' EXIT
mkdir "$scratch/tree"
for room in scenes schemes reference analysis bench; do
    cp -r "$tree/$room" "$scratch/tree/" || exit 2
done
status=0
hash_of() {  # hash_of NAME: of the scratch tree now
    "$cmake" -DSOURCE="$scratch/tree" -DOUT="$scratch/provenance.hpp" \
        -P "$scratch/tree/bench/provenance.cmake" || exit 2
    sed -n "s/^#define $1 //p" "$scratch/provenance.hpp"
}
plant() {  # plant FILE NAME other|same: a line more in FILE makes hash NAME another, or leaves it
    before=$(hash_of "$2")
    mkdir -p "$(dirname "$scratch/tree/$1")"
    [ -f "$scratch/tree/$1" ] && cp "$scratch/tree/$1" "$scratch/kept" || rm -f "$scratch/kept"
    echo "// planted" >>"$scratch/tree/$1"
    after=$(hash_of "$2")
    [ -f "$scratch/kept" ] && cp "$scratch/kept" "$scratch/tree/$1" || rm "$scratch/tree/$1"
    case $3 in
        other) [ -n "$after" ] && [ "$before" != "$after" ] ;;
        same) [ -n "$after" ] && [ "$before" = "$after" ] ;;
    esac && return
    echo "a line in $1 does not leave $2 as expected: $3" >&2
    status=1
}
for file in bench/trim/target.cpp bench/suite/difference_rules.cpp \
    bench/check/claims.cpp bench/store/keys.hpp bench/study/errors.cpp bench/suite/map_points.cpp \
    bench/suite/facets.cpp bench/study/reference.cpp bench/new_room/new.cpp analysis/error.cpp \
    reference/sundials.cpp schemes/modal/modal_two_point.cpp schemes/schemes.def \
    schemes/modal/kernels/modal_two_point_pass-inl.hpp scenes/damping.cpp; do
    plant $file JVARI_CELL_SOURCES other
done
for file in schemes/modal/modal_two_point.cpp reference/exact/exact_contact.cpp \
    scenes/damping.cpp; do
    plant $file JVARI_RUN_SOURCES other
done
for file in bench/report/page.cpp bench/command/console.cpp bench/step_times.cpp \
    bench/README.md; do
    plant $file JVARI_CELL_SOURCES same
done
exit $status
