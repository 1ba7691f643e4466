#!/bin/sh
# Each of the 38 schemes of deaf.cpp breaks one promise: 35 FeelsEveryNumber, a wrong nut force
# ConvergesToTheReference, another exponent with the same stiffness IsOneMotionInAllUnits, a pluck
# whose start is ignored PlaysLaterAsAtOnce. usage: deaf.sh JVARI PLUGIN
said=$("$1" check --plugin "$2" 2>&1)
count() { echo "$said" | grep -c "^  $1"; }
found="$(count 'breaks 1 of') $(count 'BROKEN  *FeelsEveryNumber ')"
found="$found $(count 'BROKEN  *ConvergesToTheReference  *wide_bridge_and_thread: tap nut')"
found="$found $(count 'BROKEN  *IsOneMotionInAllUnits ') $(count 'BROKEN  *PlaysLaterAsAtOnce ')"
[ "$found" = "38 35 1 1 1" ] && exit 0
echo "$said"
echo "schemes that break one promise, and of each promise: $found; expected 38 35 1 1 1" >&2
exit 1
