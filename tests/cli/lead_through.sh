# SPDX-License-Identifier: Apache-2.0
# Follows samples/in_….md with the installed files: files are written as shown, and commands run in order. No page is
# longer than a screen.
. "$(dirname "$0")/lib.sh"

cmake --install "$RELIEF_BIN/.." --prefix "$work/prefix" >log || die "cannot install: $(tail log)"
export PATH=$work/prefix/bin:$PATH CMAKE_PREFIX_PATH=$work/prefix
PKG_CONFIG_PATH=$(find "$work/prefix" -name pkgconfig)
PYTHONPATH=$(find "$work/prefix" -type d -name dist-packages)
LD_LIBRARY_PATH=$(dirname "$(find "$work/prefix" -name 'librelief.so')")
export PKG_CONFIG_PATH PYTHONPATH LD_LIBRARY_PATH

# follow PAGE: writes its files and runs its commands in a separate folder
follow() {
    local page=$RELIEF_SOURCE/samples/$1
    [ "$(wc -l <"$page")" -le 60 ] || die "$1 is longer than a screen"
    mkdir -p "$1.d/meshes"
    cp "$bunny" "$1.d/"
    cp "$bunny" "$1.d/meshes/"
    python3 - "$page" "$1.d" <<'P' || die "$1 contains no commands"
import pathlib, re, sys
text, folder = pathlib.Path(sys.argv[1]).read_text(), pathlib.Path(sys.argv[2])
commands = ''
for name, language, block in re.findall(r'(?:<!-- file: (\S+) -->\n)?```(\w*)\n(.*?)```', text, re.S):
    if name:
        (folder / name).write_text(block)
    else:
        assert language == 'sh', f'a block of {language or "nothing"} without a file'
        commands += block
assert commands
(folder / 'commands.sh').write_text('set -e\n' + commands)
P
    # Debian's Python, for which the package is built.
    (cd "$1.d" && PATH=$(dirname /usr/bin/python3):$PATH bash commands.sh >../log 2>&1) || die "$1: $(tail -20 log)"
}

follow in_your_engine.md
cat >engine.c <<'C'
#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <relief_runtime.h>
#include <stdio.h>
int snow_begin(const char* file);
void snow_frame(const relief_birth* births, size_t count, float seconds, const relief_view* view);
void snow_end(void);
int main(void) {
    EGLDisplay display = eglGetPlatformDisplay(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, NULL);
    const EGLint version[] = {EGL_CONTEXT_MAJOR_VERSION, 3, EGL_NONE};
    eglInitialize(display, NULL, NULL);
    eglBindAPI(EGL_OPENGL_ES_API);
    eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, eglCreateContext(display, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, version));
    if (snow_begin("no such file.relief") || !snow_begin("in_your_engine.md.d/bunny.relief")) return 1;
    relief_birth birth = {.position = {0, 2, 0}, .lifetime = 5};
    for (int i = 0; i < 10; ++i) snow_frame(&birth, 1, 1 / 60.0f, NULL);
    snow_end();
    return relief_api_version() < RELIEF_API_VERSION;
}
C
# shellcheck disable=SC2046
cc -std=c99 engine.c in_your_engine.md.d/snow.o -o engine $(pkg-config --cflags --libs relief egl)
./engine 2>said || die "the engine's page fails: $(cat said)"
grep -q 'no such file' said || die "an error is not printed: $(cat said)"

follow in_your_build.md
[ "$(find in_your_build.md.d/baked -name '*.relief')" = in_your_build.md.d/baked/meshes/bunny.relief ] || die "the recipe baked $(find in_your_build.md.d)"
cmp in_your_build.md.d/baked/meshes/bunny.relief in_your_build.md.d/out/baked/meshes/bunny.relief || die "CMake gives different bytes"

if [ "$RELIEF_PYTHON$RELIEF_OPENVDB" = ONON ]; then
    follow in_python_and_blender.md
    grep -qE '^[0-9.]+ % wrong, worst at' log && grep -qE '^[0-9.]+% of the box is inside$' log || die "bunny.py prints: $(cat log)"
    [ "$(find in_python_and_blender.md.d/frames -name '*.ply' | wc -l)" = 3 ] && [ -s in_python_and_blender.md.d/bunny.vdb ] ||
        die "no frames: $(find in_python_and_blender.md.d)"
fi
