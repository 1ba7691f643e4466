#!/bin/sh
# A new scheme is one file and one line in schemes/schemes.def: a copy of
# tests/contract_plugins/honest.hpp is added to a copy of the tree, and the tests that look at every
# scheme are green there. A new obstacle rule is one file and one row of schemes/contact/rules.hpp:
# tests/regularised_rule.hpp is added likewise, and its schemes on all strings keep the contract.
# usage: new_scheme.sh BUILD: quick, with the objects of this build (contract_test, schemes_test and
# jvari) and the files that differ
#        new_scheme.sh full:  everything that these tests need is built anew, by CMake; the smoke
#                             record is compared as well
here=$(cd "$(dirname "$0")/.." && pwd) || exit 2
[ -n "$1" ] || { echo "usage: new_scheme.sh BUILD | full" >&2; exit 2; }
scratch=$(mktemp -d) && trap 'rm -rf "$scratch"' EXIT
tree=$scratch/tree name=added_by_a_test
say() { echo "new_scheme.sh: $*"; }
must() { say "$1"; shift; "$@" >"$scratch/said" 2>&1 ||
    { cat "$scratch/said"; say "FAILED: $*"; exit 1; }; }

mkdir "$tree" &&
    tar -C "$here" --exclude=./build --exclude=./node_modules --exclude=./.git --exclude=./report \
        --exclude=./results/runs -cf - . |
    tar -C "$tree" -xf - || exit 2
{  # the file
    sed -e '/^#pragma once/d' -e 's|"schemes/plugin.hpp"|"schemes/scheme.hpp"|' \
        -e '/^}  \/\/ namespace jvari/,$d' "$here/tests/contract_plugins/honest.hpp"
    echo "extern const Descriptor $name;"
    echo "const Descriptor $name{\"$name\", \"a test\", honest_features, Balance::exact,"
    echo "                       Clock::stepped, planted<Honest>};"
    echo '}  // namespace jvari'
} >"$tree/schemes/modal/$name.cpp"
echo "JVARI_BUILTIN($name)" >>"$tree/schemes/schemes.def"  # the line
cp "$here/tests/regularised_rule.hpp" "$tree/schemes/contact/"  # a rule, and its row
include='#include "schemes/contact/'
sed -i -e "s|^${include}quadratised_rule.hpp\"|&\n${include}regularised_rule.hpp\"|" \
    -e 's|^    ROW(penalty,|    ROW(regularised, RegularisedRule, "a test") \\\n&|' \
    "$tree/schemes/contact/rules.hpp"
table="modal/modal_two_point modal/modal_three_point spatial/modal_spatial_newton
    grid/finite_difference_explicit grid/finite_difference_theta grid/finite_difference_hamiltonian"

if [ "$1" = full ]; then
    build=$scratch/build
    export CCACHE_BASEDIR="$scratch"
    must "configures" cmake -S "$tree" -B "$build" -G Ninja -DCMAKE_BUILD_TYPE=Release
    must "builds" cmake --build "$build" --parallel 2 \
        --target jvari contract_test schemes_test bench_test
    jvari=$build/jvari contract=$build/tests/contract_test seam=$build/tests/schemes_test
    must "smoke record unchanged" "$build/tests/bench_test" "--gtest_filter=Regression.*"
else
    build=$(cd "$1" && pwd) || exit 2
    commands() { ninja -C "$build" -t commands "$1"; }
    compile=$(commands jvari | grep -- '-c .*/schemes/modal/modal_two_point.cpp$' |
        sed 's| -o .*||; s|-MD .*-MF [^ ]*||')
    cd "$build" || exit 2
    # The registry and the pairings are compiled with the rest of their room, or by themselves.
    room=CMakeFiles/jvari_schemes.dir/Unity/unity_0_cxx.cxx
    if [ -f $room ]; then
        sed "s|\"$here/|\"$tree/|" $room >"$scratch/room.cpp"
        must "compiles the room" \
            sh -c "$compile -iquote $tree -o $scratch/room.o -c $scratch/room.cpp"
    else
        table="registry driver/pairings $table"
    fi
    for source in modal/$name $table; do
        object=$scratch/$(basename $source).o
        must "compiles schemes/$source.cpp" \
            sh -c "$compile -iquote $tree -o $object -c $tree/schemes/$source.cpp"
    done
    for target in jvari tests/contract_test tests/schemes_test; do
        link=$(commands $target | tail -1 |
            sed "s| -o $target | $(ls $scratch/*.o | tr '\n' ' ')-o $scratch/$(basename $target) |")
        must "links $target" sh -c "$link"
    done
    jvari=$scratch/jvari contract=$scratch/contract_test seam=$scratch/schemes_test
fi
export JVARI_SCENES="$tree/scenes"
must "layers" sh "$tree/tests/layering.sh" "$tree"
must "is listed" sh -c "$jvari list schemes --quiet | grep -q '^  $name '"
must "keeps the contract" "$contract" --gtest_brief=1 "--gtest_filter=*.${name}*"
must "lists the rule with every string" \
    sh -c "[ \$($jvari list schemes --quiet | grep -c '_regularised$') = 6 ]"
must "keeps the contract by the new rule" \
    "$contract" --gtest_brief=1 "--gtest_filter=*_regularised*"
must "was asked for it" \
    sh -c "'$contract' --gtest_list_tests '--gtest_filter=*.${name}*' | grep -q lossless_free"
must "seam" "$seam" --gtest_brief=1 "--gtest_filter=Facts.*:Limits.*:Options.*:PluginInterface.*"
must "lacks its row in docs/schemes.md" sh -c "! sh '$tree/tests/readme.sh' $jvari"
must "writes its row" env WRITE=1 sh "$tree/tests/readme.sh" "$jvari"
must "has its row in docs/schemes.md" grep -q "^| \`$name\` |" "$tree/docs/schemes.md"
smoke=$tree/bench/suites/smoke.toml
must "smoke names its schemes" \
    sh -c "[ \$(grep -c '^\[\[cells\]\]' $smoke) = \$(grep -c '^schemes = ' $smoke) ]"
say "green"
