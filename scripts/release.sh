#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Makes a release: scripts/release.sh VERSION
#
# Sets the version in CMakeLists.txt and in the files that quote it, commits and tags v<VERSION>, builds the artefacts, and
# writes them with SHA256SUMS to out/release/<VERSION>: source archive, Debian packages, Python wheel, npm package, and the
# page that plays scenes. VERSION is the topmost heading of CHANGELOG.md. Run scripts/test.sh and scripts/nightly.sh on the
# commit before; this script runs no tests. Pushes nothing.
#
# If the tag exists on HEAD, only builds the artefacts: a build that failed can be repeated.
set -euo pipefail
cd "$(dirname "$0")/.."

die() {
    echo "release.sh: $*" >&2
    exit 1
}

version=${1:-}
[[ $version =~ ^[0-9]+\.[0-9]+\.[0-9]+$ ]] || die "usage: scripts/release.sh VERSION, such as 0.2.0"
[ -z "$(git status --porcelain)" ] || die "the working tree has changes; commit them first"
[ "$(grep -m1 '^## ' CHANGELOG.md)" = "## $version" ] || die "the topmost heading of CHANGELOG.md is not '## $version'; write it first"
old=$(sed -n 's/^project(Relief VERSION \([0-9.]*\).*/\1/p' CMakeLists.txt)
[ -n "$old" ] || die "CMakeLists.txt has no line 'project(Relief VERSION …'"
[ "$(printf '%s\n' "$old" "$version" | sort -V | tail -n 1)" = "$version" ] || die "$version is lower than $old; choose a higher version"

tag=v$version
if tagged=$(git rev-parse -q --verify "refs/tags/$tag^{commit}"); then
    [ "$tagged" = "$(git rev-parse HEAD)" ] || die "$tag is another commit; check it out, or choose another version"
else
    # replace OLD NEW FILE…: every FILE must contain OLD.
    replace() {
        local file text
        for file in "${@:3}"; do
            text=$(<"$file")
            [[ $text == *"$1"* ]] || die "$file does not contain '$1'; name the version there, or leave it out of release.sh"
            printf '%s\n' "${text//"$1"/"$2"}" >"$file"
        done
    }
    replace "project(Relief VERSION $old " "project(Relief VERSION $version " CMakeLists.txt
    replace "find_package(Relief ${old%.*} " "find_package(Relief ${version%.*} " README.md scripts/install/README.md \
        samples/in_your_build.md
    replace "\"$old\"" "\"$version\"" runtime/c_api/relief_runtime.h samples/godot/addons/relief/plugin.cfg
    replace "(${old//./, })" "(${version//./, })" samples/blender/relief_collider.py
    ! git grep -n "find_package(Relief [0-9]" -- '*.md' | grep -v "Relief ${version%.*} " || die "these lines name another version"
    [ "$old" = "$version" ] || git commit -qam "release: set the version to $version"
    git tag -a "$tag" -m "Relief $version"
fi

out=out/release/$version
rm -rf "$out"
mkdir -p "$out"
SOURCE_DATE_EPOCH=$(git log -1 --format=%ct)
export SOURCE_DATE_EPOCH

git archive --prefix="relief-$version/" -o "$out/relief-$version.tar.gz" HEAD

scripts/build.sh web >/dev/null
cp build/web/bin/view.html "$out/relief-player-$version.html"
npm pack --silent --pack-destination "$out" ./out/npm >/dev/null

scripts/setup.sh dpkg-dev
scripts/build.sh packages >/dev/null
rm -rf build/packages/deb
cpack --preset packages >/dev/null
cp build/packages/deb/*.deb "$out/"

# Debian's Python, which the module is built for.
/usr/bin/python3 -B - "$out" >/dev/null <<'P'
import sys
sys.path.insert(0, "bake/python")
import build_wheel
build_wheel.build_wheel(sys.argv[1], {"build-dir": "build/packages"})
P

(cd "$out" && sha256sum -- * >SHA256SUMS)
echo "$PWD/$out"
ls -l "$out"
