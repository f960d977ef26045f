# SPDX-License-Identifier: Apache-2.0
# The installed tree as users see it: links of pages work, and Python imports the package. The CMake project of
# scripts/install/README.md builds, runs, and rebakes exactly what changed. The sample with a window builds with only
# pkg-config.
. "$(dirname "$0")/lib.sh"
build="$RELIEF_BIN/.."
prefix="$work/a prefix"
cmake --install "$build" --prefix "$prefix" >log || die "cannot install: $(tail log)"
export CMAKE_PREFIX_PATH=$prefix

for file in bin/relief bin/relief-sim share/man/man1/relief.1 share/man/man1/relief-bake.1 share/man/man1/relief-sim.1 \
    share/bash-completion/completions/relief share/bash-completion/completions/relief-sim share/doc/relief/README.md share/doc/relief/formats/README.md \
    share/doc/relief/samples/rain.toml share/relief/schemas/bake.schema.json \
    share/relief/shaders/collider/collider.glsl share/relief/collider.fbs share/doc/relief/samples/own_engine/bounce.c include/relief.h include/relief_runtime.h include/relief/runtime/particles/particle_system.h; do
    [ -s "$prefix/$file" ] || die "$file is not installed"
done
! grep -rIlF "$RELIEF_SOURCE" "$prefix" --include='*.cmake' --include='*.pc' --include='*.h' --include='*.1' ||
    die "the installed tree contains the build path"

# All links work, of files and of pages, and the pages that users need exist.
[ -z "$(find "$prefix" -xtype l)" ] || die "broken links: $(find "$prefix" -xtype l)"
python3 "$RELIEF_SOURCE/tests/cli/links.py" "$prefix" >links || die "dead links: $(cat links)"
for page in bake/recipe/README.md bake/measure/trust.md runtime/bench/measurements.md \
    samples/README.md samples/python/plots.py; do
    [ -s "$prefix/share/doc/relief/$page" ] || die "$page is not installed"
done
echo '[dead](nowhere.md)' >"$prefix/share/doc/relief/dead.md"
! python3 "$RELIEF_SOURCE/tests/cli/links.py" "$prefix" >links || die "a dead link is not detected"
grep -q 'dead.md: nowhere.md does not exist' links || die "the dead link is not named: $(cat links)"

# The separately installed Python package finds its importer and provides types.
if [ -d "$build/python" ]; then
    cmake --install "$build" --prefix "$work/python" --component python >log || die "cannot install the Python package"
    module=$work/python/lib/python3/dist-packages
    [ -f "$module/relief/py.typed" ] && [ -s "$module/relief/_relief.pyi" ] || die "type stubs are missing: $(ls "$module/relief")"
    [ ! -e python/bin ] || die "the Python package also installs: $(ls python/bin)"
    PYTHONPATH=$module /usr/bin/python3 -c 'import relief, sys; print(relief.__file__); relief.bake(sys.argv[1], budget=20000)' \
        "$bunny" >module || die "import relief"
    [ "$(cat module)" = "$module/relief/__init__.py" ] || die "import relief imports $(cat module)"
fi

# Installed headers include only installed headers, and none of the player.
(cd "$prefix/include/relief" && grep -rhoE '#include "[^"]+"' . | sort -u | sed 's/.*"\(.*\)"/\1/') >includes
while read -r header; do
    [ -f "$prefix/include/relief/$header" ] || die "a header includes $header, which is not installed"
done <includes
! grep -rlE '#include <(nlohmann|toml|CLI|png|Imf|flatbuffers|zstd)' "$prefix/include/relief" || die "third-party headers are included"

# Shaders for programs that compile them: pkg-config and CMake give their folder.
ln -s "$prefix" plain # pkg-config escapes spaces with backslashes
PKG_CONFIG_PATH=$(find "$work/plain/" -name pkgconfig)
export PKG_CONFIG_PATH
shaders=$(pkg-config --variable=shaderdir relief-runtime)
[ -s "$shaders/collider/collider.glsl" ] || die "pkg-config gives the shader folder '$shaders'"
mkdir shaders
cat >shaders/CMakeLists.txt <<'C'
cmake_minimum_required(VERSION 3.25)
project(shaders LANGUAGES CXX)
find_package(Relief REQUIRED)
file(SIZE ${Relief_SHADER_DIR}/collider/collider.glsl bytes)
C
cmake -G Ninja -S shaders -B shaders/out >log 2>&1 || die "CMake does not find the shaders: $(tail -20 log)"

# Any GL loader before or after Relief's headers, and every installed header on its own.
read -ra flags < <(pkg-config --cflags relief-runtime glfw3 sdl2)
compiles() { g++ -std=c++20 -Wall -Wextra -Werror -fsyntax-only "${flags[@]}" "$1" 2>log || die "$2: $(head -5 log)"; }
for loader in epoxy/gl.h GL/glew.h GLES3/gl32.h SDL_opengl.h GLFW/glfw3.h; do
    printf '#include <%s>\n#include <relief/relief.hpp>\nint main() {}\n' "$loader" >first.cpp
    compiles first.cpp "$loader first"
done
# GLEW must precede other GL headers.
printf '#include <relief/relief.hpp>\n#include <GL/glew.h>\nint main() {}\n' >last.cpp
compiles last.cpp "a loader last"
(cd "$prefix/include/relief" && find . -name '*.h' | sort | sed 's|^\./\(.*\)|#include "\1"|') >all.cpp
compiles all.cpp "installed headers"
! grep -rlE '#include <(epoxy|GL|GLES|EGL)' "$prefix/include/relief" || die "a public header includes GL headers"

# The sample with a window, built with the commands of its page, draws some frames.
grep '^ *g++' "$RELIEF_SOURCE/samples/glfw/README.md" >commands
[ "$(wc -l <commands)" -eq 1 ] || die "samples/glfw/README.md must have one command"
cp "$RELIEF_SOURCE"/samples/glfw/glfw.cpp .
[ "$(wc -l <glfw.cpp)" -lt 60 ] || die "glfw.cpp is not under 60 lines"
sh -e commands >log 2>&1 || die "samples/glfw does not build: $(head -5 log)"
"$relief" bake "$bunny" -q -o windows.relief --budget 100kB
said=$(xvfb-run -a -s '-screen 0 320x240x24' ./glfw windows.relief 3 2>&1) || die "glfw: $said"
[ "$said" = '5000 particles' ] || die "glfw prints: $said"
for library in assimp embree CGAL gmp mpfr tbb OpenEXR IlmImf png json; do
    ! ldd glfw | matches -i "$library" || die "the runtime needs $library"
done

# The project of scripts/install/README.md.
mkdir consumer
between() { sed -n "/<!-- $1 -->/,/^\`\`\`\$/p" "$RELIEF_SOURCE/scripts/install/README.md" | sed '1,2d;$d'; }
between install:cmake >consumer/CMakeLists.txt
between install:cpp >consumer/main.cpp
between install:recipe >consumer/colliders.toml
[ -s consumer/CMakeLists.txt ] && [ -s consumer/main.cpp ] && [ -s consumer/colliders.toml ] || die "scripts/install/README.md contains no project"
cp "$bunny" consumer/bunny.obj
cat >consumer/box.obj <<'O'
mtllib box.mtl
v 0 0 0
v 1 0 0
v 0 1 0
v 0 0 1
usemtl red
f 1 3 2
f 1 2 4
f 2 3 4
f 3 1 4
O
echo 'newmtl red' >consumer/box.mtl
cmake -G Ninja -S consumer -B out >log 2>&1 || die "does not configure: $(tail -20 log)"
cmake --build out >log 2>&1 || die "does not build: $(tail -20 log)"
expect 0 out/snowfall out/bunny.relief
grep -qE '^[0-9]+ maps, [0-9]+ bytes on the GPU$' stdout || die "the program prints: $(cat stdout)"
expect 0 "$relief" check out/box.relief

no_work() { cmake --build out | matches 'no work to do' || die "$1, but there is work to do"; }
# expect_bakes FILES CHANGED…: after CHANGED change, exactly FILES are baked again.
expect_bakes() {
    local wanted=$1 one
    shift
    sleep 0.01
    touch before
    for one; do echo '# changed' >>"$one"; done
    cmake --build out >log 2>&1 || die "does not build again: $(tail log)"
    local got
    got=$(find out -name '*.relief' -newer before -printf '%f ' | sort)
    [ "$got" = "$wanted" ] || die "a change of $* bakes '$got' instead of '$wanted': $(cat log)"
    no_work "$* was changed and baked"
}
no_work "all is built"
expect_bakes 'box.relief ' consumer/box.obj
expect_bakes 'bunny.relief ' consumer/bunny.obj
expect_bakes 'box.relief ' consumer/box.mtl

# Errors are reported at configure time.
rejects() { # PATTERN LINES
    mkdir -p wrong
    printf 'cmake_minimum_required(VERSION 3.25)\nproject(wrong LANGUAGES CXX)\n%s\n' "$2" >wrong/CMakeLists.txt
    ! cmake -G Ninja -S wrong -B wrong/out >log 2>&1 || die "is not rejected: $2"
    tr -s ' \n' ' ' <log | matches -E "$1" || die "'$(cat log)' does not match '$1'"
    rm -r wrong
}
rejects 'no component nonsense' 'find_package(Relief REQUIRED COMPONENTS nonsense)'
rejects 'expected RECIPE' $'find_package(Relief REQUIRED)\nrelief_add_colliders(c MESHES a.obj)'
rejects '0\.9' 'find_package(Relief 0.9 REQUIRED)'

# Recipes.
mkdir recipe
cp consumer/box.* recipe/
printf 'version = 1\n[[asset]]\nmesh = "*.obj"\noutput = "{stem}.relief"\nbudget = "20kB"\n' >recipe/recipe.toml
printf '%s\n' 'cmake_minimum_required(VERSION 3.25)' 'project(recipe LANGUAGES CXX)' \
    'find_package(Relief REQUIRED COMPONENTS bake)' \
    'relief_add_colliders(colliders RECIPE recipe.toml OUTPUT_DIR baked)' >recipe/CMakeLists.txt
cmake -G Ninja -S recipe -B recipe/out >log 2>&1 || die "does not configure: $(tail -20 log)"
cmake --build recipe/out >log 2>&1 || die "does not build: $(tail -20 log)"
expect 0 "$relief" check recipe/out/baked/box.relief
cmake --build recipe/out | matches 'no work to do' || die "the recipe is baked twice"
sleep 0.01
grep -qE '^ *pool = relief_bakes' recipe/out/build.ninja && grep -A1 '^pool relief_bakes' recipe/out/CMakeFiles/rules.ninja \
    recipe/out/build.ninja | grep -q 'depth = 2' || die "Ninja has no pool for bakes"
cp /usr/share/assimp/models/glTF2/simple_skin/simple_skin.gltf recipe/
sed -i 's/"\*.obj"/["*.obj", "*.gltf"]/' recipe/recipe.toml
cmake --build recipe/out >log 2>&1 || die "does not build: $(tail -20 log)"
[ "$(grep -c 'it is skinned' log)" = 1 ] || die "a build hides or repeats warnings: $(cat log)"
echo '# touched' >>recipe/box.mtl
cmake --build recipe/out >log 2>&1
grep -q 'Baking the colliders' log || die "a material of a recipe is not a dependency"
cmake --build recipe/out | matches 'no work to do' || die "the recipe is baked twice"
