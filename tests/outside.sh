# Sourced by the tests of schemes from outside, with the program as $1: a scratch folder to work in,
# modal_two_point's trace own.csv, and what fails.
jvari=$1
tree=$(cd "$(dirname "$0")/.." && pwd) || exit 2
scratch=$(mktemp -d) || exit 2
trap 'rm -rf "$scratch"' EXIT
cd "$scratch" || exit 2
status=0
fail() {
    echo "$1" >&2
    status=1
}
scene="tanpura_c3_release --duration 0.01"
"$jvari" run $scene --rate 88200 --scheme modal_two_point --out own.csv --quiet || exit 2

# agree NAME FILE: a trace differs from own.csv by no more than rounding, in every tap
agree() {
    paste -d, own.csv "$2" | awk -F, -v name="$1" '
        NR > 1 { for (k = 2; k <= 5; ++k) { d = $k - $(k + 5); sum[k] += d * d; of[k] += $k * $k } }
        END {
            for (k = 2; k <= 5; ++k) if (NR != 443 || !(sum[k] <= 1e-20 * of[k])) {
                print name, "differs in column", k
                exit 1
            }
        }' >&2 || status=1
}
