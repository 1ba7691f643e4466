#!/bin/sh
# The prose that a stranger reads: no sentence above 30 words, links that lead somewhere, and a
# glossary that has each term of the project's own that is used, once. A cell of a table counts by
# itself, a link as its text, a span of code as one word. usage: prose.sh [TREE]
here=$(cd "$(dirname "$0")" && pwd)
cd "${1:-$here/..}" || exit 2
texts=$(ls README.md CONTRIBUTING.md docs/*.md bench/README.md bench/suites/README.md \
    results/README.md results/*/README.md scenes/README.md tests/*/README.md)
terms='tap cell certificate noise_floor horizon control fact headline_error thread barrier nut
    reference ledger flag front map suite precursor footprint tap_rate stand-in'
status=0
complain() { echo "$@" >&2; status=1; }

long() {  # sentences of more than 30 words; a word has a letter or a digit in it
    awk -f "$here/sentences.awk" "$@" | awk -F '\t' '
        {
            words = 0; n = split($2, part, / +/)
            for (i = 1; i <= n; ++i) words += part[i] ~ /[A-Za-z0-9]/
        }
        words > 30 { print $1 ": " words " words: " $2 }'
}

# It finds what it is for: one sentence of 31 words among one of 30, a table of short cells, and
# code.
planted=$(mktemp) && trap 'rm -f "$planted"' EXIT
some="a b c d e f g h i j k l m n o p q r s t u v w x y z a b c"
set -- "$some" "$some"
{
    printf '%s i.\n\n%s i\n[two words](of/a/link). One `span of code`.\n' "$@"
    printf '\n| %s | %s |\n' "$@"
    printf '\n    %s %s\n' "$@"
} >"$planted"
[ "$(long "$planted" | wc -l)" = 1 ] ||
    complain "prose.sh: does not find the one long sentence that was planted"

found=$(long $texts)
[ -z "$found" ] || complain "$found
^ sentences above 30 words"

anchors() { sed -n 's/^##* //p' "$1" | tr 'A-Z ' 'a-z-' | sed 's/[^a-z0-9_-]//g'; }
for text in $texts; do
    for link in $(sed 's/`[^`]*`//g' "$text" | grep -oE '\]\([^): ]+\)' | tr -d '])('); do
        file=${link%%#*} to=$text
        [ -z "$file" ] || to=$(dirname "$text")/$file
        [ -e "$to" ] || complain "$text: links to $link, which is not there"
        [ "$file" = "$link" ] || anchors "$to" | grep -qxF -- "${link#*#}" ||
            complain "$text: links to $link, which is no heading there"
    done
done

entries=$(sed -n 's/^- \*\*\([^*]*\)\*\*.*/\1/p' docs/glossary.md)
twice=$(echo "$entries" | sort | uniq -d)
[ -z "$twice" ] || complain "docs/glossary.md: has more than one entry for: $twice"
for term in $terms; do
    term=$(echo "$term" | tr _ ' ')
    grep -qiwE "${term}s?" $texts || continue
    echo "$entries" | grep -qxF "$term" || complain "docs/glossary.md: has no entry for '$term'"
done
exit $status
