#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Bakes meshes in different environments and compares the bytes: tests/long/determinism.sh [--quick].
# Prints a table of SHA-256 hashes. Exit status: 0 if each mesh has one hash, otherwise 7.
#
#   (nothing)   204 bakes: ten meshes, the paper's maps and patches; threads, locale, time zone, folder, umask,
#               GCC -O2, GCC -O0 and Clang, glibc without FMA and AVX2, and two other processors by QEMU
#   --quick     12 bakes of two meshes, with only the executable in RELIEF_BIN
set -euo pipefail
cd "$(dirname "$0")/../.."

mode=${1:-full}
case $mode in
    full | --quick) ;;
    *)
        echo "determinism.sh: unknown option '$mode'; use --quick" >&2
        exit 1
        ;;
esac

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir "$work/elsewhere"
tar -xzf /usr/share/doc/libcgal-dev/data.tar.gz -C "$work" data/meshes
bunny=/usr/share/glmark2/models/bunny.obj
off() { echo "$work/data/meshes/$1.off"; }

# relief_of BUILD OPTION…: builds relief with these options in a separate folder; prints the path of the executable.
relief_of() {
    local folder=build/determinism-$1
    shift
    cmake -S . -B "$folder" -G Ninja -DRELIEF_BUILD_TESTS=OFF -DRELIEF_BUILD_BENCHMARKS=OFF "$@" >&2 &&
        cmake --build "$folder" --target relief >&2 || return 1
    echo "$PWD/$folder/bin/relief"
}

declare -A executable
if [ "$mode" = --quick ]; then
    executable[gcc]=${RELIEF_BIN:?the folder of relief}/relief
else
    scripts/setup.sh
    executable[gcc]=$(scripts/build.sh release relief)/relief
    executable[clang]=$(relief_of clang -DCMAKE_CXX_COMPILER=clang++ -DCMAKE_BUILD_TYPE=RelWithDebInfo)
    executable[debug]=$(relief_of debug -DCMAKE_BUILD_TYPE=Debug -DCMAKE_CXX_FLAGS_DEBUG=-O0)
fi
cpu() { # MODEL: QEMU prints warnings about missing features, so errors are detected by exit code.
    command -v qemu-x86_64-static >/dev/null || {
        echo "determinism.sh: qemu-x86_64-static is missing; run scripts/setup.sh" >&2
        exit 2
    }
    echo "qemu-x86_64-static -cpu $1"
}
no_fma=GLIBC_TUNABLES=glibc.cpu.hwcaps=-FMA,-FMA4,-AVX2,-AVX2_Usable,-FMA_Usable
# If the locale is not installed, setlocale() fails, which must not matter either.
turkish=LC_ALL=tr_TR.UTF-8

paper=(--paper --resolution 128)
patches=(--budget 100kB)
failed=0
count=0
declare -A first
: >"$work/rows"

# cell NAME EXECUTABLE MESH KIND [PREFIX…] -- [OPTION…]: one bake and its hash.
cell() {
    local name=$1 program=${executable[$2]} mesh=$3 kind=$4 hash key
    local -n maps=$kind
    shift 4
    local prefix=()
    while [ "$1" != -- ]; do
        prefix+=("$1")
        shift
    done
    shift
    rm -f "$work/out.relief"
    "${prefix[@]}" "$program" bake "$mesh" -o "$work/out.relief" "${maps[@]}" -q "$@" 2>"$work/err" || {
        cat "$work/err" >&2
        echo "determinism.sh: $name: $(basename "$mesh") did not bake" >&2
        exit 1
    }
    hash=$(sha256sum <"$work/out.relief" | cut -c1-16)
    key="$(basename "$mesh") $kind"
    count=$((count + 1))
    first[$key]=${first[$key]:-$hash}
    [ "${first[$key]}" = "$hash" ] || failed=1
    printf '%s|%s|%s|%s\n' "$(basename "$mesh")" "$kind" "$name" "$hash" >>"$work/rows"
}

# threads KIND MESH, elsewhere KIND MESH: cells that need only one executable.
threads() {
    local n
    for n in 1 2 3 8; do
        cell "threads $n" gcc "$2" "$1" -- -j "$n"
    done
}
elsewhere() {
    cell 'locale, time zone, folder, umask' gcc "$2" "$1" env "$turkish" TZ=Asia/Kathmandu \
        bash -c 'cd "$0" && umask 077 && exec "$@"' "$work/elsewhere" -- -j 3
}

if [ "$mode" = --quick ]; then
    for mesh in "$bunny" "$(off lion-head)"; do
        cell 'as it is' gcc "$mesh" paper --
        cell 'threads 1' gcc "$mesh" paper -- -j 1
        elsewhere paper "$mesh"
        cell 'glibc without FMA' gcc "$mesh" paper env "$no_fma" --
        # shellcheck disable=SC2046
        cell 'Nehalem (SSE4.2)' gcc "$mesh" paper $(cpu Nehalem) -- -j 1
    done
    cell 'as it is' gcc "$(off lion-head)" patches --
    elsewhere patches "$(off lion-head)"
else
    meshes=("$bunny")
    for name in fandisk cheese lion-head refined_elephant couplingdown anchor_dense camel man knot2; do
        meshes+=("$(off "$name")")
    done
    for mesh in "${meshes[@]}"; do
        cell 'as it is' gcc "$mesh" paper --
        threads paper "$mesh"
        elsewhere paper "$mesh"
        cell 'locale C.UTF-8' gcc "$mesh" paper env LC_ALL=C.UTF-8 --
        cell 'locale POSIX' gcc "$mesh" paper env LC_ALL=POSIX --
        cell 'time zone' gcc "$mesh" paper env TZ=Pacific/Chatham --
        cell 'glibc without FMA' gcc "$mesh" paper env "$no_fma" --
        cell 'Clang -O2' clang "$mesh" paper --
        cell 'GCC -O0' debug "$mesh" paper --
        # shellcheck disable=SC2046
        cell 'Nehalem (SSE4.2)' gcc "$mesh" paper $(cpu Nehalem) --
        # shellcheck disable=SC2046
        cell 'Haswell (AVX2, FMA)' gcc "$mesh" paper $(cpu Haswell) --

        cell 'as it is' gcc "$mesh" patches --
        cell 'threads 1' gcc "$mesh" patches -- -j 1
        cell 'threads 8' gcc "$mesh" patches -- -j 8
        elsewhere patches "$mesh"
        cell 'glibc without FMA' gcc "$mesh" patches env "$no_fma" --
        cell 'Clang -O2' clang "$mesh" patches --
    done
    for mesh in "${meshes[@]:1:2}"; do
        cell 'GCC -O0' debug "$mesh" patches --
        # shellcheck disable=SC2046
        cell 'Nehalem (SSE4.2)' gcc "$mesh" patches $(cpu Nehalem) --
    done
fi

python3 - "$work/rows" <<'P'
import collections, sys
rows = [line.rstrip('\n').split('|') for line in open(sys.argv[1])]
table = collections.OrderedDict()
for mesh, kind, cell, digest in rows:
    table.setdefault((mesh, kind), collections.OrderedDict()).setdefault(digest, []).append(cell)
cells = list(dict.fromkeys(cell for _, _, cell, _ in rows))
lines = ['| mesh | maps | bakes | SHA-256 begins with |', '| --- | --- | ---: | --- |']
for (mesh, kind), digests in table.items():
    text = '; '.join(digest if len(digests) == 1 else f"{digest} ({', '.join(names)})" for digest, names in digests.items())
    lines.append(f'| {mesh} | {kind} | {sum(map(len, digests.values()))} | {text} |')
two = sum(len(digests) > 1 for digests in table.values())
summary = f'{len(rows)} bakes of {len(table)} mesh and map choices in {len(cells)} environments: {two} with more than one hash.'
print('\n'.join(lines + ['', summary]))
P
[ "$failed" = 0 ] || exit 7
