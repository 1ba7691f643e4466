#!/bin/sh
# package.sh BUILD: the Debian package of a built tree holds what it should, and its program runs on
# what lies in the package alone. 77: no dpkg here.
set -eu
build=$1
command -v dpkg-deb >/dev/null || { echo "skipped: there is no dpkg-deb here"; exit 77; }
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
fail() { echo "$*"; exit 1; }
cpack -G DEB --config "$build/CPackConfig.cmake" -B "$dir" > "$dir/log" 2>&1 ||
    { cat "$dir/log"; exit 1; }
deb=$(ls "$dir"/*.deb)
dpkg-deb -x "$deb" "$dir/root"
for file in bin/jvari share/jvari/scenes/tanpura_c3.toml share/jvari/suites/smoke.toml \
    share/jvari/certificates/tanpura_c3_release.json share/doc/jvari/copyright \
    include/jvari/schemes/scheme.hpp; do
    [ -s "$dir/root/usr/$file" ] || fail "the package lacks usr/$file"
done
find "$dir/root/usr/lib" -name jvariConfig.cmake | grep -q . ||
    fail "the package lacks what find_package(jvari) reads"
depends=$(dpkg-deb -f "$deb" Depends)
for library in libc6 libgsl libsundials; do
    echo "$depends" | grep -q $library || fail "the package does not name $library: $depends"
done
grep -q 'GNU General Public License' "$dir/root/usr/share/doc/jvari/copyright" ||
    fail "the copyright does not say that the program is under the GPL"
case $depends in *python*) fail "the package needs Python: $depends" ;; esac

# Its scenes and certificates are its own: a scene and a suite that it alone has are found, a
# certificate that it lacks is missed.
share=$dir/root/usr/share/jvari
sed '0,/^name = .*/s//name = "packed"/' "$share/scenes/tanpura_c3_release.toml" \
    > "$share/scenes/packed.toml"
cp "$share/suites/smoke.toml" "$share/suites/packed.toml"
cd "$dir"
run() {
    env -u JVARI_SCENES -u JVARI_SUITES -u JVARI_CERTIFICATES JVARI_CACHE= \
        "$dir/root/usr/bin/jvari" "$@"
}
for what in scenes suites; do
    run list $what | grep -q '^  packed ' || fail "its $what are not those of the package"
done
compare() {
    run compare tanpura_c3_release --schemes modal_two_point --rates 44100 --duration 0.05 \
        --repeats 1
}
compare > said || { cat said; exit 1; }
grep -q 'uncertainty is .*tanpura_c3_release.json' said ||
    { cat said; fail "the certificate of the package is not found"; }
rm "$share/certificates/tanpura_c3_release.json"
compare >said 2>&1
grep -q 'uncertainty is .*by doubling its modes' said && ! grep -q 'tanpura_c3_release.json' said ||
    fail "the certificate is not that of the package"
echo "$(basename "$deb"), $(stat -c %s "$deb") bytes; needs $depends"
