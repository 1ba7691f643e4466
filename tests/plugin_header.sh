#!/bin/sh
# jvari_scheme.h keeps the program and its plugins apart: a plugin in C runs whether gcc or clang
# compiled it, and one that was compiled against a header with fewer or more members runs; another
# version is refused with a sentence. usage: plugin_header.sh JVARI
. "$(dirname "$0")/outside.sh"
# compiled COMPILER SED SOURCE: the plugin in the scratch folder, against the header changed by that
compiled() {
    cp "$tree"/schemes/open/jvari_scheme.h* .
    sed -i "$2" jvari_scheme.h
    [ -z "$2" ] || ! cmp -s jvari_scheme.h "$tree/schemes/open/jvari_scheme.h" ||
        { echo "nothing was changed by $2" >&2; exit 2; }
    "$1" -O1 -shared -fPIC -I. "$3" -o plugin.so -lm || exit 2
}
runs() {  # runs WHAT SCHEME: modal_two_point's motion but for rounding
    "$jvari" run $scene --rate 88200 --scheme "$2" --plugin ./plugin.so --out other.csv --quiet ||
        fail "$1 does not run"
    agree "$1" other.csv
}
refused() {  # refused WHAT SENTENCE
    said=$("$jvari" check --plugin ./plugin.so 2>&1)
    code=$?
    [ $code = 2 ] && echo "$said" | grep -q "$2" && return
    fail "$1: expected \"$2\" and exit code 2, found $code: $said"
}
c=$tree/docs/own-scheme/two_point.c cpp=$tree/tests/plugin/plain_two_point.cpp
for compiler in gcc clang; do
    command -v $compiler >/dev/null || continue
    compiled $compiler '' "$c" && runs "a plugin in C by $compiler" two_point_in_c
done
promises() {  # promises WHAT: it keeps them, its balance among them
    said=$("$jvari" check --plugin ./plugin.so) &&
        [ "$(echo "$said" | grep -c 'kept .*KeepsItsEnergyLedgerIn')" = 2 ] ||
        fail "$1 breaks a promise, or is not asked for its balance: $said"
}
promises "the template in C"
for compiler in g++ clang++; do
    command -v $compiler >/dev/null || continue
    compiled $compiler '' "$cpp" && runs "a plugin in C++ by $compiler" plain_two_point
done
promises "the template in C++"
compiled gcc '/All below may be 0/,/const void\* own/d' "$c" &&
    runs "a plugin of a header without the optional members" two_point_in_c
compiled gcc '/const char \*compiler/s/$/ double more[64];/
    s/^    const void\* own;.*/& double more[64];/
    /option_names/s/$/ double more[64];/' "$c"
runs "a plugin of a header with more members" two_point_in_c
compiled gcc 's/JVARI_SCHEME_VERSION 1/JVARI_SCHEME_VERSION 2/' "$c" &&
    refused "another version" "has version 2 of jvari_scheme.h, this program has 1"
echo 'const struct { unsigned abi; void *table; int count; } jvari_plugin = {1, 0, 3};' > older.c
gcc -shared -fPIC older.c -o plugin.so && refused "the door of C++ objects" "of an older jvari"

# What was written against a header that has since grown runs, or is refused with a sentence; it
# never crashes.
old=$tree/tests/plugin/version_1
gcc -O1 -shared -fPIC -I"$old" "$old/decays.c" -o plugin.so -lm || exit 2
free="run free_string --duration 0.01 --modes 20"
said=$("$jvari" $free --scheme decays --plugin ./plugin.so --out decays.csv 2>&1)
code=$?
if [ $code = 0 ]; then
    "$jvari" $free --scheme exact_linear --out exact.csv --quiet || exit 2
    paste -d, exact.csv decays.csv |
        awk -F, 'NR > 1 { d = $2 - $5; sum += d * d; of += $2 * $2 }
            END { exit !(NR == 443 && of > 0 && sum <= 1e-20 * of) }' ||
        fail "a plugin of version 1 runs and is wrong"
else
    [ $code = 2 ] && echo "$said" | grep -q "has version 1 of jvari_scheme.h" ||
        fail "a plugin of version 1 ends with code $code: $said"
fi
exit $status
