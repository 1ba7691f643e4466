#!/bin/sh
# check.sh JVARI HOST PREFIX: the host of main.cpp plays what the program plays, and links no
# library under the GPL, nor any other that the schemes do without. The libraries of scenes, schemes
# and reference in PREFIX name no function of GSL or FFTW.
set -eu
jvari=$1 host=$2 prefix=$3
fail() { echo "check.sh: $*" >&2; exit 1; }
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
"$jvari" run tanpura_c3_release --scheme modal_two_moment --rate 48000 --tap-rate 48000 \
    --modes 133 --option compliance=matched --duration 0.2 --out "$dir/trace.csv" --quiet
"$host" "$dir/string.wav"
od -A n -t d2 -v -w2 -j 44 "$dir/string.wav" > "$dir/samples"
[ "$(head -c 12 "$dir/string.wav" | tr -d '\000-\037\200-\377' | cut -c1-4)" = RIFF ] ||
    fail "the host writes no WAV file"
# 0.2 s are those of the run, by the factor that fits; then the string goes on without a jump, and
# louder than it was: it was plucked.
awk -F, 'NR == FNR { said[NR] = $1; next }
    FNR == 1 { for (i = 1; i <= NF; ++i) if ($i ~ /^nut/) nut = i; next }
    n < 9600 { want[++n] = $nut; both += $nut * said[n]; all += $nut ^ 2 }
    END {
        for (k = 1; k <= n; ++k)
            if ((said[k] - want[k] * both / all) ^ 2 > 0.6 ^ 2) {
                print "sample", k, said[k]
                exit 1
            }
        for (k = n - 4800; k < n; ++k) step = most(step, said[k + 1] - said[k])
        for (k = n - 4800; k <= n; ++k) before = most(before, said[k])
        for (k = n + 1; (k in said); ++k) after = most(after, said[k])
        jump = most(0, said[n + 1] - said[n])
        print k, "jumps", jump, "steps", step, "before", before, "after", after
        exit k != 19201 || jump > step || after < 1.2 * before
    }
    function most(a, b) { b = b < 0 ? -b : b; return a > b ? a : b }
    ' "$dir/samples" "$dir/trace.csv" ||
    fail "the host does not play what the program plays"
# docs/host.md shows these very lines.
here=$(dirname "$0")
sed -n '/^```cpp$/,/^```$/{/^```/d;p}' "$here/../../docs/host.md" | cmp -s - "$here/main.cpp" ||
    fail "docs/host.md does not show tests/host/main.cpp"

needs=$(ldd "$host")
for library in gsl fftw3 sundials sndfile samplerate fmt; do
    case $needs in *lib$library*) fail "the host needs $library: $needs" ;; esac
done
for folder in scenes schemes reference; do
    library=$(find "$prefix" -name "libjvari_$folder.a")
    nm "$library" > "$dir/names"
    grep -q jvari "$dir/names" || fail "$library: nm finds nothing of jvari in it"
    ! grep -E ' U (gsl|fftw)_' "$dir/names" || fail "$library calls GSL or FFTW"
done
