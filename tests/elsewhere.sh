#!/bin/sh
# elsewhere.sh SYSTEM PREFIX BUILD: jvari::scenes and jvari::schemes, built for another system by a
# compiler of Debian 12, play what those that are installed in PREFIX play. SYSTEM is arm64, run by
# qemu, windows, run by wine, or libcxx: clang with its own C++ library, as on macOS. Without wine
# the program for Windows is built and not run. In PREFIX/bin tests/elsewhere has been built. BUILD
# keeps what is built here.
set -eu
system=$1 native=$2 build=$3
tree=$(cd "$(dirname "$0")/.." && pwd)
skip() { echo "skipped: $*"; exit 77; }
fail() { echo "elsewhere.sh $system: $*" >&2; exit 1; }
needs() { command -v "$1" > /dev/null || skip "no $1: $2"; }
mkdir -p "$build"
headers_alone() {  # headers_alone PACKAGE FOLDER: a library as headers, out of sight of others
    mkdir -p "$build/include"
    [ -d "/usr/include/$2" ] || skip "no headers of $2"
    ln -sfn "/usr/include/$2" "$build/include/$2"
    printf '%s\n' "Name: $1" "Description: headers" "Version: $(pkg-config --modversion "$1")" \
        "Cflags: -I$build/include -DTOML_HEADER_ONLY=1" > "$build/$1.pc"
}
case $system in
    arm64)
        why="dpkg --add-architecture arm64 && apt-get update && apt-get install"
        why="$why g++-aarch64-linux-gnu qemu-user-static libhwy-dev:arm64 libtomlplusplus-dev:arm64"
        needs aarch64-linux-gnu-g++ "$why"
        [ -f /usr/lib/aarch64-linux-gnu/pkgconfig/libhwy.pc ] || skip "no libhwy-dev:arm64: $why"
        [ -f /usr/lib/aarch64-linux-gnu/pkgconfig/tomlplusplus.pc ] ||
            skip "no libtomlplusplus-dev:arm64: $why"
        needs qemu-aarch64-static "$why"
        tools=aarch64-linux-gnu exe=''
        emulator=qemu-aarch64-static
        ;;
    windows)
        needs x86_64-w64-mingw32-g++-posix "apt-get install g++-mingw-w64-x86-64-posix"
        tools=x86_64-w64-mingw32 exe=.exe
        headers_alone libhwy hwy
        headers_alone tomlplusplus toml++
        export PKG_CONFIG_LIBDIR="$build"
        emulator=$(command -v wine64 || command -v /usr/lib/wine/wine64 || true)
        export WINEPREFIX="$build/wine" WINEDEBUG=-all
        ;;
    libcxx)
        needs clang++ "apt-get install clang libc++-dev libc++abi-dev"
        echo '#include <version>' | clang++ -stdlib=libc++ -x c++ -fsyntax-only - 2> "$build/log" ||
            skip "no libc++: apt-get install libc++-dev libc++abi-dev"
        tools=clang-libcxx exe='' emulator=env
        headers_alone tomlplusplus toml++
        cp "$(pkg-config --variable=pcfiledir libhwy)/libhwy.pc" "$build"
        export PKG_CONFIG_LIBDIR="$build"
        ;;
    *) fail "expected arm64, windows or libcxx" ;;
esac
prefix=$build/prefix
rm -rf "$prefix"
configure() {  # configure FROM TO ...
    from=$1 to=$2
    shift 2
    cmake -G Ninja -S "$from" -B "$to" -DCMAKE_BUILD_TYPE=Release \
        -DCMAKE_TOOLCHAIN_FILE="$tree/cmake/$tools.cmake" "$@"
}
logged() { "$@" > "$build/log" 2>&1 || { tail -n 40 "$build/log" >&2; fail "fails: $*"; }; }
logged configure "$tree" "$build/libraries" -DCMAKE_INSTALL_PREFIX="$prefix" \
    -DCMAKE_UNITY_BUILD=ON -DJVARI_STRICT=ON -DJVARI_ONLY_SCHEMES=ON
logged cmake --build "$build/libraries" --parallel 1
logged cmake --install "$build/libraries"
logged configure "$tree/tests/elsewhere" "$build/programs" -DCMAKE_PREFIX_PATH="$prefix"
logged cmake --build "$build/programs" --parallel 1
[ -n "$emulator" ] || { echo "built, not run: apt-get install wine64"; exit; }

# play TO BIN SUFFIX [EMULATOR]: the string of the host, and the samples of every scheme, into folder TO
play() {
    to=$1 bin=$2 suffix=$3
    shift 3
    mkdir -p "$to"
    "$@" "$bin/host$suffix" "$to/string.wav" || fail "the host in $bin fails"
    "$@" "$bin/samples$suffix" tanpura_c3_release 0.02 "$bin/two_point.plugin" > "$to/samples" ||
        fail "the samples in $bin fail"
    tr -d '\r' < "$to/samples" > "$to/lines"
    od -A n -t d2 -v -w2 -j 44 "$to/string.wav" > "$to/sounds"
}
cd "$build"
play native "$native/bin" ''
play played prefix/bin "$exe" "$emulator"
# 16 bits round to the same number but for a tie
paste -d ' ' native/sounds played/sounds | awk '
    NF != 2 || ($1 - $2) ^ 2 > 1 { exit wrong = 1 }
    END { exit wrong || NR != 19200 }' || fail "the host plays another string"
paste -d ' ' native/lines played/lines | awk -v most=1e-9 '
    { taps = NF / 2 }
    $1 != $(taps + 1) { print $1, "stands beside", $(taps + 1); exit wrong = 1 }
    $2 == "refuses" || $4 == "refuses" {
        if ($2 != $4) { print $1, "refuses in one place"; wrong = 1 }
        next
    }
    {
        for (k = 2; k <= taps; ++k) {
            d[$1, k] += ($k - $(k + taps)) ^ 2
            of[$1, k] += $k ^ 2
        }
        ++rows[$1]
    }
    END {
        for (name in rows) {
            worst = 0
            for (k = 2; k <= taps; ++k) {
                e = d[name, k] ? sqrt(d[name, k] / of[name, k]) : 0
                if (!(e <= worst)) worst = e
            }
            ++schemes
            printf "%s %.1e%s\n", name, worst, worst <= most ? "" : " differs"
            if (!(worst <= most)) wrong = 1
        }
        if (schemes < 8) { print schemes, "schemes play"; wrong = 1 }
        exit wrong
    }' || fail "samples differ by more than 1e-9"
