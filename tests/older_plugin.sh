#!/bin/sh
# A plugin that was compiled against other headers is refused with a sentence: the headers are copied, changed by one line, and a plugin is
# compiled against the copy. usage: older_plugin.sh JVARI COMPILER
jvari=$1 compiler=$2
tree=$(cd "$(dirname "$0")/.." && pwd) || exit 2
scratch=$(mktemp -d) || exit 2
trap 'rm -rf "$scratch"' EXIT
status=0
expect() {  # expect refused|loaded NAME SED: of a plugin whose headers of scenes and schemes differ by that
    rm -rf "$scratch/tree"
    mkdir "$scratch/tree"
    (cd "$tree" && cp --parents scenes/*.hpp schemes/*.hpp "$scratch/tree/") || exit 2
    sed -i "$3" "$scratch"/tree/*/*.hpp
    [ -z "$3" ] || ! (cd "$scratch/tree" && for file in */*.hpp; do cmp -s "$file" "$tree/$file" || exit 1; done) || { echo "$2: nothing was changed" >&2; exit 2; }
    "$compiler" -std=c++20 -shared -fPIC -fvisibility=hidden -DJVARI_BAD_TABLE=0 -I"$scratch/tree" "$tree/tests/bad_plugin.cpp" -o "$scratch/plugin.so" || exit 2
    said=$("$jvari" run free_string --duration 0.001 --scheme bad_facts --plugin "$scratch/plugin.so" 2>&1)
    code=$?
    case $1 in
        refused) [ $code = 2 ] && echo "$said" | grep -q "compile it with the headers and the compiler of this program" ;;
        loaded) echo "$said" | grep -q "no facts today" ;;
    esac && return
    echo "$said" >&2
    echo "$2: expected the plugin to be $1, exit code $code" >&2
    status=1
}
expect loaded "the same headers" ''
expect refused "a virtual function less" '/virtual std::vector<FreeMode> free_modes/d;s/place_of(&Scheme::free_modes), //'
expect refused "two virtual functions exchanged" '/virtual int dofs/{h;d};/virtual std::vector<Fact> facts/{G}'
expect refused "a virtual function more, at the end" 's|// New virtual functions come here.*|virtual void more() {}|'
expect refused "another type of a virtual function" 's/virtual std::vector<FreeMode> free_modes() const/virtual std::vector<FreeMode> free_modes(int = 0) const/'
expect refused "a field less" '/double skew = 0;/d;s/JVARI_AT(skew), //'
exit $status
