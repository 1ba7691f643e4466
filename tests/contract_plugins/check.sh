#!/bin/sh
# `jvari check` of one plugin breaks just this promise. usage: check.sh JVARI PLUGIN [PROMISE], without PROMISE: it breaks none
said=$("$1" check --plugin "$2" 2>&1)
code=$?
broken=$(echo "$said" | sed -n 's|^  BROKEN  *\([A-Za-z]*\).*|\1|p' | tr '\n' ' ')
asked=$(echo "$said" | grep -c '^  kept')
[ -n "$3" ] && expected=4 || expected=0
[ "$asked" -gt 0 ] && [ "$broken" = "${3:+$3 }" ] && [ $code = $expected ] && exit 0
echo "$said"
echo "$2 breaks: ${broken:-nothing}; expected: ${3:-nothing}; exit code $code" >&2
exit 1
