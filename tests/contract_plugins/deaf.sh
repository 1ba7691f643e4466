#!/bin/sh
# Each of the 43 schemes of deaf.cpp breaks one promise: 38 FeelsEveryNumber, a wrong nut force
# ConvergesToTheReference, a pluck whose start is ignored PlaysLaterAsAtOnce. Three break
# IsOneMotionInAllUnits: another exponent with the same stiffness, a bridge that is soft above 2e5
# N/m, a profile 1 mm aside. usage: deaf.sh JVARI PLUGIN
said=$("$1" check --plugin "$2" 2>&1)
count() { echo "$said" | grep -c "^  $1"; }
found="$(count 'breaks 1 of') $(count 'BROKEN  *FeelsEveryNumber ')"
found="$found $(count 'BROKEN  *ConvergesToTheReference  *wide_bridge_and_thread: tap nut')"
found="$found $(count 'BROKEN  *IsOneMotionInAllUnits ') $(count 'BROKEN  *PlaysLaterAsAtOnce ')"
[ "$found" = "43 38 1 3 1" ] && exit 0
echo "$said"
echo "schemes that break one promise, and of each promise: $found; expected 43 38 1 3 1" >&2
exit 1
