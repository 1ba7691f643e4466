#!/bin/sh
# hosted.sh SOURCES: hosted.mjs. Exit code 77, a skip to ctest, without node.
command -v node >/dev/null || { echo "skipped: node is missing"; exit 77; }
exec node "$(dirname "$0")/hosted.mjs" "$@"
