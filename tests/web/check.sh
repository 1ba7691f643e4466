#!/bin/sh
# check.sh SCRIPT PROGRAM BUILD SOURCES ...: a script of this folder in node. Exit code 77, a skip
# to ctest, where the preset web has not been built.
command -v node >/dev/null || { echo "skipped: node is missing"; exit 77; }
[ -f "$3/jvari.wasm" ] || { echo "skipped: $3 holds no jvari.wasm (./play builds it)"; exit 77; }
if [ "$1" = page.mjs ]; then
    command -v chromium >/dev/null || { echo "skipped: chromium is missing"; exit 77; }
    [ -f "$5/axe-core/axe.min.js" ] || { echo "skipped: $5 holds no axe-core"; exit 77; }
fi
script=$1
shift
exec node "$(dirname "$0")/$script" "$@"
