#!/bin/sh
# Every word of the Markdown files is British English or one of the field's (words.txt, one a line).
# Spans and blocks of code, links and names with digits or underscores in them do not count. usage:
# spelling.sh [TREE]; 77 where aspell or its dictionary is missing.
here=$(cd "$(dirname "$0")" && pwd)
cd "${1:-$here/..}" || exit 2
check() { aspell list --lang=en_GB --encoding=utf-8; }
echo word | check >/dev/null 2>&1 ||
    { echo "aspell and its English dictionary are not here: nothing checked" >&2; exit 77; }
unknown() { check | sort -u | grep -vixF -f "$here/words.txt"; }
[ "$(echo 'a strng and a barrier' | unknown)" = strng ] ||
    { echo "spelling.sh: does not find the one mistake that was planted" >&2; exit 1; }

texts=$(ls *.md docs/*.md bench/README.md bench/suites/README.md \
    results/README.md results/*/README.md scenes/README.md tests/*/README.md)
found=$(awk -f "$here/sentences.awk" $texts |
    sed 's/^[^\t]*\t//; s/CODE//g; s|https\?://[^ ]*||g; s/[^ ]*[0-9_][^ ]*//g
        s/[^ ]*\.[a-z][^ ]*//g; s/[’'\'']s\>//g' | unknown)
[ -z "$found" ] && exit 0
printf '%s\n^ unknown words: mend them, or add those of the field to tests/words.txt\n' "$found" >&2
exit 1
