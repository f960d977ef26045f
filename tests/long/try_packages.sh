#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Tests installed packages as their users would: try_packages.sh MESH PART…, on a system without other parts of Relief.
# Part `tools` also reads level.glb from the folder of MESH. `scripts/nightly.sh packages` runs it in a minimal Debian. Parts:
#
#   tools        the commands of README.md, "Use"; the manual
#   python       the program of samples/in_python_and_blender.md
#   development  the projects of scripts/install/README.md, programs in C with librelief and with relief.h
#
# Pages are read from the folder of librelief-dev, or from RELIEF_DOC.
set -euo pipefail

doc=${RELIEF_DOC:-/usr/share/doc/relief}
mesh=$1
shift

die() {
    echo "FAILED: $*" >&2
    exit 1
}

tools() {
    cp "$mesh" bunny.obj
    cp "$(dirname "$mesh")/level.glb" .
    printf '[collider]\nfile = "bunny.relief"\n[time]\nsteps = 20\n[render]\nsize = [160, 120]\n' >bunny_in_the_snow.toml
    mkdir -p meshes/rocks && cp "$mesh" meshes/rocks/a.obj
    printf 'version = 1\n[[asset]]\nmesh = "meshes/**/*.obj"\noutput = "baked/{stem}.relief"\nbudget = "64kB"\n' >colliders.toml
    sed -n '/^## Use$/,/ --world level /s/^    \(relief.*[^ ]\)  *#.*/\1/p' "$doc/README.md" >commands
    [ "$(wc -l <commands)" -ge 5 ] || die "README.md contains $(wc -l <commands) commands"
    while read -r line; do
        bash -euc "$line" >said 2>&1 </dev/null || die "$line: $(tail -5 said)"
        echo "  $line"
    done <commands
    for file in bunny.relief bunny.html end.ply slice.png frames/frame_0000.png baked/a.relief level/world.json; do
        [ -s $file ] || die "$file was not written"
    done
    relief bake --recipe colliders.toml -j 2 >said 2>&1 || die "the second run of the recipe fails: $(tail -5 said)"
    [ -s /usr/share/man/man1/relief-bake.1.gz ] || die "the manual page of relief bake is missing"
}

python() {
    cp "$mesh" bunny.obj
    sed -n '/^```python$/,/^```$/{//!p}' "$doc/samples/in_python_and_blender.md" >program.py
    [ "$(wc -l <program.py)" -ge 5 ] || die "samples/in_python_and_blender.md contains no program"
    python3 program.py >said 2>&1 || die "Python: $(tail -5 said)"
    python3 - said bunny.relief <<'P'
import pathlib, sys
import relief
wrong = float(open(sys.argv[1]).read().split()[0])
assert 0 < wrong < 3, wrong
assert relief.load(sys.argv[2]).maps
home = pathlib.Path(relief.__file__).parent
assert str(home) == "/usr/lib/python3/dist-packages/relief", home
assert (home / "py.typed").is_file() and (home / "_relief.pyi").is_file()
P
}

development() {
    mkdir consumer
    between() { sed -n "/<!-- $1 -->/,/^\`\`\`\$/p" "$doc/scripts/install/README.md" | sed '1,2d;$d'; }
    between install:cmake >consumer/CMakeLists.txt
    between install:cpp >consumer/main.cpp
    between install:recipe >consumer/colliders.toml
    cp "$mesh" consumer/bunny.obj
    cp "$mesh" consumer/box.obj
    { cmake -G Ninja -S consumer -B out && cmake --build out; } >said 2>&1 || die "the project of the page does not build: $(tail -20 said)"
    out/snowfall out/bunny.relief | grep -qE '^[0-9]+ maps, ' || die "the project's program prints something else"
    read -ra flags < <(pkg-config --cflags --libs relief-runtime)
    g++ -std=c++20 consumer/main.cpp -o by_pkg_config "${flags[@]}" || die "does not build by pkg-config"
    cat >load.c <<'C'
#include <relief_runtime.h>
#include <stdio.h>
int main(int count, char** arguments) {
    relief_collider* collider = relief_collider_load(count > 1 ? arguments[1] : "");
    puts(collider != NULL ? relief_version() : relief_error());
    relief_collider_free(collider);
    return collider == NULL;
}
C
    read -ra flags < <(pkg-config --cflags --libs relief)
    cc -std=c99 -Wall -Werror load.c -o load "${flags[@]}" || die "a program in C does not build"
    [ "$(./load out/bunny.relief)" = "$(relief --version | sed 's/.* //')" ] || die "a program in C does not load a collider"
    relief export out/bunny.relief --engine c engine -q
    (cd engine && sh -euc "$(grep -E '^ {4}(cc|\./)' RELIEF.md)") >said 2>&1 || die "the engine's page: $(tail -5 said)"
    grep -q ' of 400 balls rest on it' said || die "the engine's program prints: $(tail -5 said)"
}

for part in "$@"; do
    work=$(mktemp -d)
    (cd "$work" && "$part") || exit 1
    rm -rf "$work"
    echo "packages: $part works"
done
