#!/bin/sh
# The tables of the texts between "<!-- jvari list ... -->" and "<!-- end -->" are what the program prints.
# usage: readme.sh PROGRAM [TREE]; with WRITE=1 in the environment they are made so.
tree=${2:-$(dirname "$0")/..}
cd "$tree" || exit 2
scratch=$(mktemp -d) && trap 'rm -rf "$scratch"' EXIT
status=0 tables=0
for text in docs/*.md; do
    for what in $(sed -n 's/^<!-- jvari list \([a-z]*\) --markdown -->$/\1/p' "$text"); do
        tables=$((tables + 1))
        "$1" list "$what" --markdown --quiet >"$scratch/table" || exit 2
        awk -v what="$what" -v table="$scratch/table" '
            /^<!-- end -->$/ { skip = 0 }
            !skip
            $0 == "<!-- jvari list " what " --markdown -->" { while ((getline line <table) > 0) print line; skip = 1 }' "$text" >"$scratch/text"
        if [ -n "$WRITE" ]; then cp "$scratch/text" "$text"
        else
            diff "$text" "$scratch/text" || { echo "the table of $what in $text is not what 'jvari list $what --markdown' prints" >&2; status=1; }
        fi
    done
done
[ $tables = 2 ] || { echo "readme.sh: found $tables tables in the texts, expected 2: schemes and options" >&2; status=1; }
exit $status
