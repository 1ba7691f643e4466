#!/bin/sh
# Each of the 33 schemes of deaf.cpp breaks one promise: FeelsEveryNumber, a wrong nut force
# ConvergesToTheReference. usage: deaf.sh JVARI PLUGIN
said=$("$1" check --plugin "$2" 2>&1)
one=$(echo "$said" | grep -c '^  breaks 1 of')
number=$(echo "$said" | grep -c '^  BROKEN  *FeelsEveryNumber ')
force=$(echo "$said" |
    grep -c '^  BROKEN  *ConvergesToTheReference  *wide_bridge_and_thread: tap nut')
[ "$one $number $force" = "33 32 1" ] && exit 0
echo "$said"
echo "$one schemes break one promise, $number FeelsEveryNumber, $force ConvergesToTheReference;" \
    "expected 33, 32, 1" >&2
exit 1
