#!/bin/sh
# The layers: scenes <- schemes <- reference; analysis sees schemes/trace.hpp, run.hpp and scenes;
# bench is a staircase of rooms above them; tests see all. No scheme includes another, and each
# library is seen where docs/dependencies.md says and nowhere else. usage: layering.sh [TREE]
cd "${1:-$(dirname "$0")/..}" || exit 2
status=0
forbid() {  # forbid REASON PATTERN PATHS...: no line of PATHS matches PATTERN
    reason=$1 pattern=$2
    shift 2
    if grep -nE "$pattern" "$@" /dev/null; then
        echo "^ $reason" >&2
        status=1
    fi
}
files() { find "$@" -name '*.hpp' -o -name '*.cpp' | sort; }

unseen() {  # unseen REASON ROOMS PATHS...: no file of PATHS includes a header of ROOMS
    reason=$1 rooms=$2
    shift 2
    forbid "$reason" "#include \"($rooms)" "$@"
}
schemes() { echo "schemes/($1)/"; }
engine="scenes schemes reference analysis"

unseen "scenes see nothing above them" '(schemes|reference|analysis|bench)/' $(files scenes)
unseen "schemes see scenes alone" '(reference|analysis|bench)/' $(files schemes)
unseen "references see schemes and scenes" '(analysis|bench)/' $(files reference)
unseen "the event-driven exact solution stands above the other references" 'reference/exact/' \
    reference/*.hpp reference/*.cpp
unseen "the seam sees no scheme" "$(schemes 'body|contact|modal|spatial|grid|sitar')" \
    schemes/*.hpp schemes/scheme.cpp schemes/several_strings.cpp schemes/trace.cpp schemes/run.cpp
unseen "contacts see the seam alone" "$(schemes 'body|modal|spatial|grid|sitar')" \
    $(files schemes/contact)
unseen "a moving body sees contacts and the seam" "$(schemes 'modal|spatial|grid|sitar')" \
    $(files schemes/body)
unseen "modal schemes see contacts and the seam" "$(schemes 'spatial|grid|sitar')" \
    $(files schemes/modal)
unseen "kernels of modes see no scheme" 'schemes/modal/(modal_[^s]|three)' \
    $(files schemes/modal/kernels)
unseen "spatial schemes see modes, contacts and the seam" "$(schemes 'grid|sitar')" \
    $(files schemes/spatial)
unseen "the problem of schemes from outside sees contacts and the seam" \
    "$(schemes 'body|modal|spatial|grid|sitar')" $(files schemes/open)
unseen "grids see contacts and the seam" "$(schemes 'modal|spatial|sitar')" $(files schemes/grid)
unseen "sitars see contacts and the seam" "$(schemes 'modal|spatial|grid')" $(files schemes/sitar)
above=
# each room of bench sees itself and those after it here
for room in command report trim check suite judge compare study store; do
    [ -z "$above" ] || unseen "bench/$room sees nothing of the rooms above it" "bench/($above)/" \
        $(files bench/$room)
    above=${above:+$above|}$room
    forbid "bench/$room opens the namespace of its room" "^namespace jvari(::bench::[a-z]+)? \\{$" \
        $(grep -LE "^namespace jvari::bench::$room \\{$" $(files bench/$room))
done
unseen "locks, signals and programs see nothing else of the store" 'bench/store/[a-z_0-9]+\.' \
    $(files bench/store/system)
unseen "a comparison does not see how it is written down" 'bench/compare/record/' \
    bench/compare/*.hpp bench/compare/*.cpp
forbid "only the command line talks to standard streams: others have a Listener" \
    'std::(cout|cerr)|\bstd(out|err)\b|isatty' \
    $(files $engine bench | grep -v '^bench/command/')
unseen "the page's module sees the core and no room of bench" 'bench/' $(files web)
unseen "nothing sees the page's module" 'web/' $(files $engine bench python)
unseen "the Python module sees the engine, not the command line" 'bench/command/' $(files python)
unseen "the engine sees no Python" 'python/' $(files $engine bench)
unseen "the store measures nothing" 'analysis/' $(files bench/store)
unseen "analysis never sees which scheme made a trace" \
    'schemes/[^tr]|schemes/t[^r]|schemes/r[^u]|reference/|bench/' $(files analysis)
# Libraries, as the table of docs/dependencies.md says. The benchmark and the tests
# compare with any of them.
product=$(files scenes schemes reference analysis bench python | grep -v '^bench/step_times')
# only LIBRARY PATTERN PLACES: of the product, files that begin with PLACES alone include it
only() {
    forbid "$1 belongs to $3" "#include <$2" $(echo "$product" | grep -vE "^($3)")
}
only "toml++" 'toml' 'scenes/document'
only GSL 'gsl/' 'analysis/'
only Eigen 'Eigen/' 'schemes/decompositions|reference/exact/touching_set_making'
only Highway 'hwy/' 'schemes/|reference/exact/modal_sweep'
only FFTW 'fftw' 'analysis/fftw'
only SUNDIALS '(cvode|arkode|sundials|nvector|sunlin|sunmat|sunnonlin)' 'reference/sundials'
only CLI11 'CLI/' 'bench/command/'
only JSON 'nlohmann/' 'bench/'
only fmt 'fmt/' 'bench/'
only xxHash 'xxhash' 'bench/store/encoding'
only libsndfile 'sndfile' 'bench/(store/|command/player)'
only libsamplerate 'samplerate' 'bench/command/player'
only pybind11 'pybind11/' 'python/'
# -inl: part of a file of its own folder, compiled once for each set of instructions
forbid "no header leaks a library" \
    '#include <(toml|fftw|Eigen|hwy|gsl|nlohmann|sndfile|CLI|fmt|cvode|sundials)' \
    $(find $engine -name '*.hpp' ! -name '*-inl.hpp')
forbid "records name no folder of the machine that made them" '[ "=]/(tmp|root|home)/' \
    $(find results -maxdepth 3 -path results/runs -prune -o \
        \( -name '*.json' -o -name '*.toml' \) -print)
forbid "records come from a commit that exists" '^  "commit": "[^"]*-dirty' \
    $(find results -maxdepth 3 -name manifest.json)
lines=$(cat $product | wc -l)
share() {  # share MOST ROOM FILES...: they have at most so many of the product's lines
    most=$1 room=$2
    shift 2
    if [ "$(($(cat "$@" | wc -l) * 100))" -gt "$((most * lines))" ]; then
        echo "$room: more than $most % of the product's lines" >&2
        status=1
    fi
}
for room in $(for file in $product; do dirname "$file"; done | sort -u); do
    if [ "$(ls "$room"/*.hpp "$room"/*.cpp 2>/dev/null | wc -l)" -gt 30 ]; then
        echo "$room: more than 30 source files" >&2
        status=1
    fi
    case $room in */*) share 20 "$room" $(echo "$product" | grep "^$room/") ;; esac
done
share 48 bench $(echo "$product" | grep '^bench/')
forbid "-ffast-math is forbidden" 'ffast-math' CMakeLists.txt tests/CMakeLists.txt CMakePresets.json
exit $status
