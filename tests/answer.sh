#!/bin/sh
# The README's first table is what results/work-precision holds: each row's error and cost are those
# of its scheme at its rate, rounded, the error is within what is wanted, and no unflagged run
# within it is surely cheaper (upper quartile below the row's lower one). An error counts with what
# the reference is certain to, and says so by "≤", where that is more than a tenth of it. Schemes
# are as published (compliance=own) where their name says nothing else; one without a rate has its
# modes in its place. A control (schemes.def) is no row and no cheaper run. usage: answer.sh [TREE]
cd "${1:-$(dirname "$0")/..}" || exit 2
results=results/work-precision
awk -F '[|,]' '
function trim(text) { gsub(/^ +| +$/, "", text); return text }
function rounds(actual, printed, scale, digits) {  # is `printed` what `actual` rounds to?
    digits = index(printed, ".") ? length(printed) - index(printed, ".") : 0
    half = 0.5001 * 10^-digits
    return actual * scale - printed <= half && printed - actual * scale <= half
}
FNR == NR { if (sub(/^JVARI_CONTROL\(/, "")) { sub(/\).*/, ""); control[$0] = 1 } next }
FNR == 1 { ++file; if (file < 4) { delete at; for (i = 1; i <= NF; ++i) at[$i] = i } }
file == 1 && FNR > 1 {
    low[$1] = $at["cost_lower"]; high[$1] = $at["cost_upper"]; cost[$1] = $at["cost_s_per_s"]
}
file == 2 && FNR > 1 && $at["status"] == "ok" && $at["flags"] == "" && !($at["scheme"] in control) {
    options = $at["options"]; sub(/^compliance=own$/, "", options)
    place = $at["rate"] == "" ? $at["modes"] " modes" : $at["rate"] / 1000 " kHz"
    id[$at["scheme"] (options == "" ? "" : " " options), place] = $1
    id[$at["scheme"] (options == "" ? "" : " " options), $at["modes"] " modes, " place] = $1
    nut[$1] = $at["headline_nut"]; bridge[$1] = $at["headline_bridge"]
}
file == 3 && ($1 in nut) && $at["measure"] == "error_l2_50ms" && $at["tap"] == nut[$1] {
    sure = $at["certificate"] + 0
    error[$1, "%"] = 100 * ($at["value"] + sure)
    shown[$1, "%"] = sure > 0.1 * $at["value"] ? error[$1, "%"] : 100 * $at["value"]
}
file == 3 && ($1 in nut) && $at["measure"] == "third_octave_db" && $at["tap"] == bridge[$1] {
    error[$1, "dB"] = shown[$1, "dB"] = $at["value"]
}
file == 4 && /^\|.* ms \|$/ {
    wanted = trim($2)
    if (match(wanted, /within [0-9.]+ (%|dB)/)) split(substr(wanted, RSTART, RLENGTH), goal, " ")
    n = split($0, cell, "|")
    match(cell[3], /`[^`]*`/)
    split(trim(cell[5]), printed, " "); split(trim(cell[6]), ms, " ")
    run = id[substr(cell[3], RSTART + 1, RLENGTH - 2), trim(cell[4])]
    unit = printed[2]
    sub(/^≤/, "", printed[1])
    if (run == "" || unit != goal[3] || !rounds(shown[run, unit], printed[1], 1) ||
        !rounds(cost[run], ms[1], 1000) || error[run, unit] + 0 > goal[2] + 0) wrong = wrong "\n" $0
    for (other in cost)
        if ((other, unit) in error && error[other, unit] + 0 <= goal[2] + 0 &&
            high[other] < low[run]) { cheaper = cheaper "\n" $0; break }
    ++rows
}
END {
    if (wrong) print "rows of README.md that " results " does not hold:" wrong
    if (cheaper) print "rows of README.md beside which " results " has a cheaper run:" cheaper
    if (!rows) print "README.md has no first table"
    exit !rows || wrong != "" || cheaper != ""
}' results="$results" schemes/schemes.def "$results/cost.csv" "$results/facts.csv" \
    "$results/errors.csv" README.md >&2
