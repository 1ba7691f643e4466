#!/bin/sh
# check.sh JVARI HOST PREFIX: the host of main.cpp plays what the program plays, and links no library under the GPL, nor any other that the
# schemes do without. The libraries of scenes, schemes and reference in PREFIX name no function of GSL or FFTW.
set -eu
jvari=$1 host=$2 prefix=$3
fail() { echo "check.sh: $*" >&2; exit 1; }
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
"$jvari" run tanpura_c3_release --scheme modal_two_point --rate 48000 --tap-rate 48000 --duration 0.2 --out "$dir/trace.csv" --quiet
"$host" > "$dir/said"
awk -F, 'NR == FNR { said = $1; next }
    FNR == 1 { for (i = 1; i <= NF; ++i) if ($i ~ /^nut/) nut = i; next }
    n < 9600 { sum += $nut ^ 2; ++n }
    END { want = sqrt(sum / n); print said, want; exit !(n == 9600 && (said / want - 1) ^ 2 < 1e-20) }' "$dir/said" "$dir/trace.csv" ||
    fail "the host does not play what the program plays"

needs=$(ldd "$host")
for library in gsl fftw3 sundials hdf5 sndfile samplerate fmt; do
    case $needs in *lib$library*) fail "the host needs $library: $needs" ;; esac
done
for folder in scenes schemes reference; do
    library=$(find "$prefix" -name "libjvari_$folder.a")
    nm "$library" > "$dir/names"
    grep -q jvari "$dir/names" || fail "$library: nm finds nothing of jvari in it"
    ! grep -E ' U (gsl|fftw)_' "$dir/names" || fail "$library calls GSL or FFTW"
done
