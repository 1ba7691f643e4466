#!/bin/sh
# Every C++ file is as clang-format 14 (Debian 12) leaves it with .clang-format, every script and
# style sheet as prettier does. usage: format.sh [TREE]; 77 without either program.
cd "${1:-$(dirname "$0")/..}" || exit 2
for program in clang-format-14 clang-format; do
    if "$program" --version 2>/dev/null | grep -q 'version 14\.'; then
        [ -x node_modules/.bin/prettier ] ||
            { echo "prettier is not here: nothing checked" >&2; exit 77; }
        list=$(mktemp)
        trap 'rm "$list"' EXIT
        find scenes schemes reference analysis bench tests python web \
            -name '*.cpp' -o -name '*.hpp' | sort >"$list"
        xargs "$program" --dry-run --Werror <"$list" ||
            { echo "mend by: $program -i FILE" >&2; exit 1; }
        ! LC_ALL=C.UTF-8 xargs grep -nE '^.{101}' <"$list" ||
            { echo "wider than 100 columns: break the line, or shorten its comment" >&2; exit 1; }
        find bench tests web results -name '*.js' -o -name '*.mjs' -o -name '*.css' | sort |
            xargs node_modules/.bin/prettier --check ||
                { echo "mend by: npx prettier --write FILE" >&2; exit 1; }
        exit 0
    fi
done
echo "clang-format 14 is not here: nothing checked" >&2
exit 77
