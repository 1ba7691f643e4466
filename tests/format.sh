#!/bin/sh
# Every C++ file is as clang-format 14 (Debian 12) leaves it with .clang-format. usage: format.sh [TREE]; 77 without that version.
cd "${1:-$(dirname "$0")/..}" || exit 2
for program in clang-format-14 clang-format; do
    if "$program" --version 2>/dev/null | grep -q 'version 14\.'; then
        find scenes schemes reference analysis bench tests -name '*.cpp' -o -name '*.hpp' | sort | xargs "$program" --dry-run --Werror && exit 0
        echo "mend by: $program -i FILE" >&2
        exit 1
    fi
done
echo "clang-format 14 is not here: nothing checked" >&2
exit 77
