#!/bin/sh
# The contract over one plugin breaks just this promise. usage: check.sh CONTRACT_TEST PLUGIN [PROMISE], without PROMISE: breaks none
JVARI_CONTRACT_PLUGINS=$2
export JVARI_CONTRACT_PLUGINS
said=$("$1" --gtest_brief=1 2>&1)
code=$?
broken=$(echo "$said" | sed -n 's|^\[  FAILED  \] All/\([A-Za-z.]*\)/.*|\1|p' | sort -u | tr '\n' ' ')
asked=$(echo "$said" | grep -c '^\[=*\] [1-9][0-9]* tests')
[ "$asked" = 1 ] && [ "$broken" = "${3:+$3 }" ] && { [ -n "$3" ] || [ $code = 0 ]; } && exit 0
echo "$said"
echo "$2 breaks: ${broken:-nothing}; expected: ${3:-nothing}" >&2
exit 1
