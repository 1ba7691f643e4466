#!/bin/sh
# manual.sh JVARI DIR: writes into DIR what --help says as a manual page (jvari.1), and what it lists as completion for bash (jvari.bash),
# zsh (_jvari) and fish (jvari.fish). Names of schemes, scenes and suites are asked of the program when they are completed.
set -eu
jvari=$1 out=$2
mkdir -p "$out"
help=$(mktemp -d)
trap 'rm -rf "$help"' EXIT
"$jvari" --help > "$help/jvari"
version=$("$jvari" --version | cut -d' ' -f2)
verbs=$(awk '/^Subcommands:/ { on = 1; next } on && NF == 0 { exit } on { print $1 }' "$help/jvari")
for verb in $verbs; do "$jvari" "$verb" --help > "$help/$verb"; done
options() { awk '$1 ~ /^(-[a-z],)?--[a-z]/ { sub(/^-[a-z],/, "", $1); print $1 }' "$help/$1"; }
about() { head -1 "$help/$1"; }
instruments=$(sed -n 's/^  instrument INSTRUMENT REQUIRED *//p' "$help/new" | sed 's/,//g; s/ or / /')
lists=$(sed -n 's/^  what WHAT:{\(.*\)}.*/\1/p' "$help/list" | tr ',' ' ')
known() { sed "s/INSTRUMENTS/$instruments/; s/LISTS/$lists/; s/VERBS/$(echo $verbs)/"; }
verbatim() { sed -e 's/\\/\\e/g' -e "s/^\([.']\)/\\\\\&\1/" -e 's/-/\\-/g'; }

{
    echo ".\\\" Written by cmake/manual.sh from what --help says."
    echo ".TH JVARI 1 \"\" \"jvari $version\" \"User Commands\""
    echo ".SH NAME"
    echo "jvari \\- compares numerical schemes for strings against obstacles by speed and accuracy"
    echo ".SH SYNOPSIS"
    for verb in $verbs; do printf '.B jvari %s\n%s\n.br\n' "$verb" "$(sed -n "s/^Usage: jvari $verb //p" "$help/$verb" | verbatim)"; done
    echo ".SH DESCRIPTION"
    echo ".nf"
    verbatim < "$help/jvari"
    echo ".fi"
    for verb in $verbs; do
        echo ".SH $(echo "$verb" | tr a-z A-Z)"
        echo ".nf"
        verbatim < "$help/$verb"
        echo ".fi"
    done
} > "$out/jvari.1"

names='jvari list $1 2>/dev/null | awk "/^  [^ ]/ { print \$1 }"'
{
    echo "# bash completion for jvari"
    echo "_jvari_names() { $names; }"
    cat <<'END'
_jvari() {
    local current=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD - 1]} words=
    case $before in
        --scheme | --schemes | --reference) words="$(_jvari_names schemes) $(_jvari_names references)" ;;
        --out | --plugin | --plot | --junit) compopt -o default; return ;;
        --history) compopt -o dirnames; return ;;
        --wav-format) words="pcm24 pcm16" ;;
        --print) words=slurm ;;
        new) words="INSTRUMENTS" ;;
        run | compare | certify | trim) [ "$COMP_CWORD" = 2 ] && compopt -o default && words=$(_jvari_names scenes) ;;
        suite) [ "$COMP_CWORD" = 2 ] && compopt -o default && words=$(_jvari_names suites) ;;
        check) words=$(_jvari_names schemes) ;;
        list) words="LISTS" ;;
        report | diff) compopt -o dirnames; return ;;
    esac
    [ "$COMP_CWORD" != 1 ] || words='VERBS'
    case $current in
        -*) case ${COMP_WORDS[1]} in
END
    for verb in $verbs; do echo "            $verb) words='$(echo $(options "$verb"))' ;;"; done
    cat <<'END'
            *) words='--help --version' ;;
        esac ;;
    esac
    COMPREPLY=($(compgen -W "$words" -- "$current"))
}
complete -F _jvari jvari
END
} | known > "$out/jvari.bash"

{
    echo "#compdef jvari"
    echo "# zsh completion for jvari"
    echo "_jvari_names() { local -a found; found=(\$($names)); compadd -a found; }"
    echo "local -a verbs"
    echo "verbs=("
    for verb in $verbs; do printf "    '%s:%s'\n" "$verb" "$(about "$verb" | sed "s/[':]//g")"; done
    cat <<'END'
)
if ((CURRENT == 2)); then
    _describe verb verbs
    return
fi
case ${words[CURRENT - 1]} in
    --scheme | --schemes | --reference) _jvari_names schemes; _jvari_names references; return ;;
    --out | --plugin | --plot | --junit) _files; return ;;
    --history) _files -/; return ;;
    new) compadd INSTRUMENTS; return ;;
    run | compare | certify | trim) ((CURRENT == 3)) && { _jvari_names scenes; _files -g '*.toml'; return; } ;;
    suite) ((CURRENT == 3)) && { _jvari_names suites; _files -g '*.toml'; return; } ;;
    check) _jvari_names schemes; return ;;
    list) compadd LISTS; return ;;
    report | diff) _files -/; return ;;
esac
case ${words[2]} in
END
    for verb in $verbs; do echo "    $verb) compadd -- $(echo $(options "$verb")) ;;"; done
    echo "esac"
} | known > "$out/_jvari"

{
    echo "# fish completion for jvari"
    echo "function __jvari_names; jvari list \$argv[1] 2>/dev/null | string match -r '^  [^ ]\\S*' | string trim; end"
    echo "complete -c jvari -n __fish_use_subcommand -f"
    for verb in $verbs; do
        printf "complete -c jvari -n __fish_use_subcommand -f -a %s -d '%s'\n" "$verb" "$(about "$verb" | sed "s/'//g")"
        for option in $(options "$verb"); do
            case $option in
                --scheme | --schemes | --reference) what=" -x -a '(__jvari_names schemes; __jvari_names references)'" ;;
                --out | --plugin | --plot | --junit | --history) what=" -r" ;;
                *) what= ;;
            esac
            echo "complete -c jvari -n '__fish_seen_subcommand_from $verb' -l ${option#--}$what"
        done
    done
    echo "complete -c jvari -n '__fish_seen_subcommand_from new' -f -a 'INSTRUMENTS'"
    echo "complete -c jvari -n '__fish_seen_subcommand_from run compare certify trim' -a '(__jvari_names scenes)'"
    echo "complete -c jvari -n '__fish_seen_subcommand_from suite' -a '(__jvari_names suites)'"
    echo "complete -c jvari -n '__fish_seen_subcommand_from check' -f -a '(__jvari_names schemes)'"
    echo "complete -c jvari -n '__fish_seen_subcommand_from list' -f -a 'LISTS'"
} | known > "$out/jvari.fish"
