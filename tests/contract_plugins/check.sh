#!/bin/sh
# `jvari check` of a scheme breaks just this promise. usage: check.sh JVARI PLUGIN SCHEME [PROMISE],
# without PROMISE: it breaks none
said=$("$1" check "$3" --plugin "$2" 2>&1)
code=$?
broken=$(echo "$said" | sed -n 's|^  BROKEN  *\([A-Za-z]*\).*|\1|p' | tr '\n' ' ')
asked=$(echo "$said" | grep -c '^  kept')
[ -n "$4" ] && expected=4 || expected=0
[ "$asked" -gt 0 ] && [ "$broken" = "${4:+$4 }" ] && [ $code = $expected ] && exit 0
echo "$said"
echo "$3 breaks: ${broken:-nothing}; expected: ${4:-nothing}; exit code $code" >&2
exit 1
