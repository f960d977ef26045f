#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Installs the Debian 12 packages that Relief needs to build, test and run. Does nothing, and needs no network, if all are
# installed. The other scripts call it: scripts/setup.sh [PACKAGE]…, with the additional packages they need.
#
# scripts/setup.sh tools [PACKAGE]…: only for the preset tools: no tests, Python or OpenVDB.
# scripts/setup.sh test [PACKAGE]…: only for scripts/test.sh.
# scripts/setup.sh web: also for runtime/web and one browser. node and npm may be installed by other means.
set -euo pipefail

tools=(
    ca-certificates cmake g++ git mold ninja-build pkg-config
    # formats
    flatbuffers-compiler libexpected-dev libflatbuffers-dev libglm-dev libxxhash-dev libzstd-dev
    # bake
    libassimp-dev libcairo2-dev libcgal-dev libcli11-dev libeigen3-dev libembree-dev libmeshoptimizer-dev libopenexr-dev
    libpugixml-dev libseccomp-dev libspdlog-dev libtbb-dev nlohmann-json3-dev
    fonts-dejavu-core
    # runtime: libepoxy, and Mesa's llvmpipe for machines without a GPU
    libegl-dev libepoxy-dev libgl-dev libgles-dev libpng-dev libtomlplusplus-dev libegl1 libegl-mesa0 libgl1-mesa-dri
    # samples
    glmark2-data imagemagick python3 webp
)
test=(
    assimp-testmodels clang clang-format libcgal-demo libclang-rt-dev libgtest-dev libstb-dev make openexr
    pybind11-dev python3-dev python3-jsonschema python3-numpy python3-pytest
)
everything=(
    bsdextrautils doxygen gcc-mingw-w64-x86-64 glslang-tools groff-base libglew-dev libglfw3-dev libopenvdb-dev
    libopenvdb-tools libsdl2-dev libvulkan-dev man-db mandoc mesa-vulkan-drivers python3-matplotlib python3-pip
    python3-venv qemu-user-static strace vulkan-validationlayers wine64 xauth xvfb
)
case ${1-} in
    tools)
        shift
        test=()
        everything=()
        ;;
    test)
        shift
        everything=()
        ;;
    web)
        shift
        everything=()
        set -- emscripten esbuild chromium fonts-liberation "$@"
        command -v node >/dev/null || set -- nodejs "$@"
        command -v npm >/dev/null || set -- npm "$@"
        ;;
esac
packages=("${tools[@]}" "${test[@]}" "${everything[@]}" "$@")

missing=()
for package in "${packages[@]}"; do
    status=$(dpkg-query -W -f '${db:Status-Status}' "$package" 2>/dev/null || true)
    [ "$status" = installed ] || missing+=("$package")
done
[ ${#missing[@]} -gt 0 ] || exit 0

sudo=()
if [ "$(id -u)" -ne 0 ]; then
    command -v sudo >/dev/null || {
        echo "setup.sh: packages are missing, and only root can install them: ${missing[*]}" >&2
        exit 1
    }
    sudo=(sudo)
fi
echo "Installing ${#missing[@]} packages: ${missing[*]}" >&2
quietly=$(dirname "$0")/quietly.sh
"$quietly" "${sudo[@]}" apt-get update -qq
"$quietly" "${sudo[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends "${missing[@]}" >&2
