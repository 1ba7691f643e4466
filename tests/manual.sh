#!/bin/bash
# manual.sh JVARI DIR: the manual page has a section for each verb, and the completions of DIR offer what the program knows.
set -eu
program=$1 dir=$2
jvari() { "$program" "$@"; }  # as a completion calls it
fail() { echo "$*"; exit 1; }
verbs=$("$program" --help | awk '/^Subcommands:/ { on = 1; next } on && NF == 0 { exit } on { print $1 }')
[ "$(echo "$verbs" | wc -l)" -ge 10 ] || fail "the program has few verbs: $verbs"
for verb in $verbs; do grep -qix "\.SH $verb" "$dir/jvari.1" || fail "the manual page has no section $verb"; done

source "$dir/jvari.bash"
compopt() { :; }  # it works within a completion alone
offers() {        # offers EXPECTED WORDS...: after the words it offers, among others, the first
    local expected=$1 COMP_WORDS COMP_CWORD COMPREPLY=()
    shift
    COMP_WORDS=("$@") COMP_CWORD=$(($# - 1))
    _jvari
    printf '%s\n' "${COMPREPLY[@]}" | grep -qx -- "$expected" || fail "bash: '$*' is not completed to $expected: ${COMPREPLY[*]}"
}
offers compare jvari com
offers tanpura_c3_release jvari compare tanp
offers modal_two_point jvari run x --scheme modal_t
offers exact_contact jvari compare x --reference ex
offers work-precision jvari suite wo
offers --within jvari trim x --w
offers guitar jvari new gu
offers facts jvari list fa
offers pcm16 jvari run x --wav-format pcm
if command -v zsh > /dev/null; then zsh -n "$dir/_jvari"; fi
if command -v fish > /dev/null; then fish -n "$dir/jvari.fish"; fi
for verb in $verbs; do
    grep -q "'$verb:" "$dir/_jvari" || fail "zsh: no $verb"
    grep -q -- "-a $verb " "$dir/jvari.fish" || fail "fish: no $verb"
done
