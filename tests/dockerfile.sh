#!/bin/sh
# dockerfile.sh PROGRAM: the Dockerfile's first stage runs what ./demo runs, and its second installs
# the package of every library that the program loads. 77: there is no dpkg here.
cd "$(dirname "$0")/.." || exit 2
status=0
fail() { echo "Dockerfile: $*" >&2; status=1; }
for command in $(sed -n '/AS build/,/^FROM debian:12-slim/s/^RUN \(\.ci\/.*\)/\1/p' Dockerfile |
    tr ' ' '~'); do
    grep -qx "$(echo "$command" | tr '~' ' ')" demo ||
        fail "'$(echo "$command" | tr '~' ' ')' is not a line of ./demo"
done
[ "$(sed -n '/AS build/,/^FROM debian:12-slim/s/^RUN \.ci\//&/p' Dockerfile | wc -l)" = 2 ] ||
    fail "expected two commands of .ci in the first stage"
grep -q '^cmake_minimum_required' CMakeLists.txt &&
    grep -q 'install(TARGETS jvari RUNTIME' CMakeLists.txt ||
    fail "there is no rule that installs the program"
command -v dpkg >/dev/null || { echo "skipped: there is no dpkg here"; exit 77; }
installed=$(sed -n '/^FROM debian:12-slim/,$p' Dockerfile | tr ' ' '\n')
for library in $(objdump -p "$1" | awk '$1 == "NEEDED" { print $2 }'); do
    file=$(readlink -f "$(ldd "$1" | awk -v name="$library" '$1 == name { print $3 }')")
    package=$(dpkg -S "$file" 2>/dev/null | cut -d: -f1)
    [ -n "$package" ] || package=$(dpkg -S "${file#/usr}" 2>/dev/null | cut -d: -f1)
    # of every Debian; nodejs brings libstdc++6
    case $package in '' | libc6 | libgcc-s1 | libstdc++6) continue ;; esac
    echo "$installed" | grep -qx "$package" ||
        fail "the second stage lacks $package, which has $library"
done
exit $status
