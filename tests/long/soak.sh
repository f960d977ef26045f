#!/usr/bin/env bash
# Long runs, for a night and not for CI: tests/long/soak.sh [RUN]…, all of these by default. Ends with 0 if all pass.
#
#   sweep   a million particles take a thousand swept steps in a closed hollow box, and none gets out; without the
#           sweep most do. In OpenGL 3.3 and in OpenGL ES 3.0. An hour or so on llvmpipe.
#   rest    snow falls on the bunny: after it has come to rest, no bit of a position changes from step 5,000 to step
#           100,000 (RELIEF_SOAK_SETTLED and RELIEF_SOAK_STEPS say others).
#   import  every file of assimp-testmodels is read or refused, and none crashes the worker.
#   mutants 2,000 broken mesh files and every file of assimp-testmodels are baked soundly or refused (tests/long/mutants.sh)
#   gles    the tests in OpenGL ES that repeat long ones in OpenGL, which CI leaves out
#   package a build without the baker, from nothing, installs a runtime that samples/glfw builds with.
#   headers a build of each file alone, without precompiled headers: every file includes what it uses, and no warning of
#           GCC is off.
#   bytes   204 bakes of ten meshes in surroundings that must not matter give one hash each (tests/long/determinism.sh)
#   corpus  536 meshes as artists make them are baked at 1 MB and measured, or refused in one line. An hour or so.
#   fuzz    libFuzzer looks at all that tests/fuzz has a target for, ten minutes each (tests/long/fuzz.sh)
#   seeds   the generated cases of the tests are others: of seed RELIEF_TEST_SEED, by default the day's date, and solids of
#           unit cubes of the nine seeds after it too
#   cases   more than 500 random inputs of the generators in tests/cases, by the same seed: none is silently wrong, hangs or
#           crashes
#   level   a terrain of a kilometre with 200 pieces of furniture (tests/long/level.py): its verdict names what is lost
#   characters  the mannequin of the npm package @pmndrs/viverse walks, runs, stands and jumps: at every frame the GPU's maps of it
#           have at most 2 % of the points near it on the wrong side. Needs the npm registry.
#   ground  hills of 4097 x 4097 samples in 64 tiles: points at seams are no worse than others, a million drops fall on the seams,
#           and none through or up; balls roll over seams as they do elsewhere; and with a tenth of it in memory none falls through.
#   clang   everything is built by clang too, without a warning, and passes its tests.
#   load    the release tests pass five times while stress-ng keeps processors, memory and disk busy.
#   bare    .ci/run, from nothing, in a minimal Debian 12 that mmdebstrap makes; scripts/test.sh there without root; and
#           what the tools do there without a GL. Needs root, and takes more than an hour.
#   blender the add-on of samples/blender bakes, shows errors and plays particles in Debian's Blender, without a window
#   packages  cpack's .deb files pass lintian, and their users' programs and commands work in a minimal Debian 12 that has
#           nothing else (tests/long/try_packages.sh). Needs root.
#   sanitize  every test passes under the address and undefined-behaviour sanitizers, those of numbers too
#   embree4 a build for Embree 4's functions, done by Embree 3 (tests/bake/mesh/embree4), bakes the same bytes.
#   slurm   samples/slurm bakes the models of sweethome3d-furniture and a level on a cluster of one node, with a task that is begun
#           again, one that is killed, and broken meshes; a second run bakes the rest, a third nothing, and a fourth the level,
#           of which a container is gone. Needs root.
#   outputs 20 rounds of kills, errors, signals and eight writers leave no torn file (tests/long/all_or_nothing.sh)
set -euo pipefail
cd "$(dirname "$0")/../.."

scripts/setup.sh
all_runs=(sweep rest import mutants gles package headers bytes seeds cases level characters ground clang sanitize load bare packages embree4 outputs blender slurm
    corpus fuzz)
runs=("$@")
[ ${#runs[@]} -gt 0 ] || runs=("${all_runs[@]}")
work=$(mktemp -d)
stress=
trap '[ -z "$stress" ] || kill "$stress"; rm -rf "$work"' EXIT

# logged NAME COMMAND…: its output shows only where it fails.
logged() {
    local log=$work/$1.log
    "${@:2}" >"$log" 2>&1 || {
        tail -60 "$log" >&2
        return 1
    }
}

# built NAME OPTION…: a build of another configuration, in $work/NAME.
built() {
    logged "$1" cmake -G Ninja -S . -B "$work/$1" -DCMAKE_BUILD_TYPE=RelWithDebInfo "${@:2}" &&
        logged "$1" cmake --build "$work/$1"
}

sweep() {
    local bin status=0
    bin=$(scripts/build.sh release relief_runtime_particles_test) || return 1
    RELIEF_SOAK=1 logged sweep "$bin/relief_runtime_particles_test" --gtest_filter='*ASweptStepNeverTunnels*' \
        --gtest_output="json:$work/sweep.json" || status=$?
    python3 - "$work/sweep.json" <<'P'
import json, sys
tests = [test for suite in json.load(open(sys.argv[1]))['testsuites'] for test in suite['testsuite']]
for test in tests:
    print(f"sweep: {test['name']}: {'FAILED' if 'failures' in test else 'none lost'}; 1000000 particles, 1000 steps, "
          f"{test.get('collisions', '?')} contacts; {test['time']}; {test.get('context', '')}")
sys.exit(0 if tests else 'sweep: no such test')
P
    return "$status"
}

sanitize() {
    built sanitize --preset sanitize -DRELIEF_BUILD_NUMBER_TESTS=ON &&
        logged sanitize env LSAN_OPTIONS="suppressions=$PWD/tests/lsan.supp" ctest --test-dir "$work/sanitize" -LE night -j "$(nproc)"
}

gles() {
    scripts/build.sh release >/dev/null && logged gles ctest --test-dir build/release -R '/Gles30$' -j "$(nproc)"
}

package() {
    built runtime -DRELIEF_BUILD_BAKE=OFF -DRELIEF_BUILD_TESTS=OFF -DRELIEF_BUILD_BENCHMARKS=OFF &&
        logged package cmake --install "$work/runtime" --prefix "$work/prefix" || return 1
    local modules
    modules=$(find "$work/prefix" -name pkgconfig)
    # shellcheck disable=SC2046
    g++ -std=c++20 samples/glfw/glfw.cpp -o "$work/glfw" \
        $(PKG_CONFIG_PATH=$modules pkg-config --cflags --libs relief-runtime glfw3) &&
        "$work/prefix/bin/relief-sim" --version >/dev/null && echo "package: a build without the baker installs"
}

headers() {
    built headers -DRELIEF_PRECOMPILE=OFF -DRELIEF_UNITY=OFF || return 1
    echo "headers: builds without precompiled headers"
}

rest() {
    local bin
    bin=$(scripts/build.sh release relief relief-sim) || return 1
    "$bin/relief" bake /usr/share/glmark2/models/bunny.obj -o "$work/bunny.relief" -q || return 1
    cat >"$work/rest.toml" <<'T'
[collider]
file = "bunny.relief"
[particles]
capacity = 10000
[emitter]
burst = 10000
rate = 0.0
lifetime = 10000.0
T
    # The same scene gives the same particles, so two runs are the same run, looked at twice.
    local steps
    for steps in "${RELIEF_SOAK_SETTLED:-5000}" "${RELIEF_SOAK_STEPS:-100000}"; do
        "$bin/relief-sim" "$work/rest.toml" --steps "$steps" --dump "$work/$steps.ply" -q || return 1
    done
    python3 - "$work" "${RELIEF_SOAK_SETTLED:-5000}" "${RELIEF_SOAK_STEPS:-100000}" <<'P'
import struct, sys
work, settled, steps = sys.argv[1:]

def positions(name):
    data = open(f'{work}/{name}.ply', 'rb').read()
    body = data[data.index(b'end_header\n') + 11:]
    # x y z vx vy vz age lifetime id type; compares the bits of x y z, because -0 is not 0.
    return {row[8]: row[:3] for row in struct.iter_unpack('<10I', body)}

before, after = positions(settled), positions(steps)
moved = sum(after.get(id) != at for id, at in before.items())
print(f'rest: {len(before)} particles at step {settled}, {len(after)} at step {steps}; {moved} of them moved')
sys.exit(0 if before and len(before) == len(after) and moved == 0 else 1)
P
}

import() {
    local bin
    bin=$(scripts/build.sh release relief_bake_import_test) || return 1
    RELIEF_SOAK=1 logged import "$bin/relief_bake_import_test" --gtest_filter='*EveryModelOfThePackage*' \
        --gtest_output="json:$work/import.json" || return 1
    python3 - "$work/import.json" <<'P'
import json, sys
test = json.load(open(sys.argv[1]))['testsuites'][0]['testsuite'][0]
print(f"import: {test['tried']} files, {test['read']} of them read, the others refused")
P
}

bytes() { tests/long/determinism.sh; }

mutants() { tests/long/mutants.sh 2000; }

outputs() { tests/long/all_or_nothing.sh; }

# A cluster of this machine alone, until its function ends.
slurm_cluster() { # FOLDER
    mkdir -p "$1"/{state,spool} /run/munge
    cat >"$1/slurm.conf" <<C
ClusterName=soak
SlurmctldHost=$(hostname)
AuthType=auth/munge
SlurmUser=root
StateSaveLocation=$1/state
SlurmdSpoolDir=$1/spool
SlurmctldPidFile=$1/slurmctld.pid
SlurmdPidFile=$1/slurmd.pid
SlurmctldLogFile=$1/slurmctld.log
SlurmdLogFile=$1/slurmd.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
MpiDefault=none
ReturnToService=2
KillWait=2
JobAcctGatherType=jobacct_gather/none
NodeName=$(hostname) CPUs=$(nproc) State=UNKNOWN
PartitionName=farm Nodes=ALL Default=YES MaxTime=INFINITE State=UP
C
    export SLURM_CONF=$1/slurm.conf
    [ -s /etc/munge/munge.key ] || mungekey || return 1
    chown munge: /run/munge /etc/munge/munge.key
    munge -n >/dev/null 2>&1 || runuser -u munge -- munged || return 1
    local _
    slurmctld
    slurmd
    for _ in $(seq 60); do
        sinfo -h -o %T 2>/dev/null | grep -q idle && return
        sleep 1
    done
    tail -n 5 "$1/slurmctld.log" >&2
    tail -n 5 "$1/slurmd.log" >&2
    scontrol shutdown
    return 1
}

# waits until a job of submit.sh ends.
slurm_wait() {
    while squeue -h -j "$1" 2>/dev/null | grep -q .; do sleep 2; done
}

slurm() {
    local bin models=/usr/share/sweethome3d/furniture archive job tasks=8 status=0
    scripts/setup.sh slurm-wlm munge sweethome3d-furniture unzip || return 1
    bin=$(scripts/build.sh release relief) || return 1
    for archive in Scopia KatorLegaz; do
        mkdir -p "$work/farm/$archive"
        unzip -q -o "$models/$archive.sh3f" -d "$work/farm/$archive"
    done
    find "$work/farm" -name '*.obj' | sort | tail -n +486 | xargs -r rm
    printf 'v 0 0 0\nf 1 2 9\n' >"$work/farm/broken_index.obj"
    printf 'no mesh\n' >"$work/farm/broken_text.obj"
    python3 tests/cli/level.py "$work/farm/yard.gltf"
    printf 'version = 1\n[defaults]\nbudget = "60kB"\nquality = "fast"\n[[asset]]\nmesh = "**/*.obj"\noutput = "{dir}/{stem}.relief"\n' \
        >"$work/farm/r.toml"
    printf '[[asset]]\nmesh = "*.gltf"\noutput = "worlds/{stem}/world.json"\nbudget = "200kB"\n' >>"$work/farm/r.toml"
    slurm_cluster "$work/slurm" || return 1
    export RELIEF=$bin/relief
    local out=$work/farm_out begun=$SECONDS
    report() { python3 -c "import json; d = json.load(open('$out/reports/report.json')); print($1)"; }
    {
        job=$(samples/slurm/submit.sh "$work/farm/r.toml" "$out" $tasks -- --cpus-per-task=1)
        sleep 20
        # A node that dies: Slurm begins its task again. And one that is killed for good.
        scontrol requeue "$((job - 1))_1" || true
        sleep 2
        pkill -KILL -f "shard 2/$tasks" || true
        slurm_wait "$job"
        echo "slurm: first run: $(tail -1 "$out/reports/report.log" | head -c 200)"
        [ "$(report "d['failed'] >= 2 and d['unfinished_tasks'] == [2]")" = True ] &&
            job=$(samples/slurm/submit.sh "$work/farm/r.toml" "$out" $tasks -- --cpus-per-task=1) &&
            slurm_wait "$job" &&
            [ "$(report "d['unfinished_tasks'] == [] and d['failed']")" = 2 ] &&
            grep -q broken_index "$out/reports/failures.txt" &&
            [ "$(find "$out" ! -path '*/worlds/*/*.relief' \( -name '*.relief' -o -name world.json \) | wc -l)" = \
                "$(report "d['baked'] + d['up_to_date']")" ] &&
            "$RELIEF" check "$out/worlds/yard/world.json" --mesh "$work/farm/yard.gltf" --max-error 1 >/dev/null &&
            echo "slurm: $(report "d['baked'] + d['up_to_date']") of $(find "$work/farm" -name '*.obj' | wc -l) models and a level, $((SECONDS - begun)) s" &&
            rm "$work"/farm/broken_*.obj &&
            job=$(samples/slurm/submit.sh "$work/farm/r.toml" "$out" $tasks -- --cpus-per-task=1) &&
            slurm_wait "$job" &&
            [ "$(report "[d['baked'], d['failed'], d['unfinished_tasks']]")" = '[0, 0, []]' ] &&
            echo "slurm: another run bakes nothing" &&
            rm "$out"/worlds/yard/floor-*.relief &&
            job=$(samples/slurm/submit.sh "$work/farm/r.toml" "$out" $tasks -- --cpus-per-task=1) &&
            slurm_wait "$job" &&
            [ "$(report "[d['baked'], d['failed'], d['unfinished_tasks']]")" = '[1, 0, []]' ] &&
            "$RELIEF" check "$out/worlds/yard/world.json" >/dev/null &&
            echo "slurm: and then the level alone"
    } || {
        status=1
        cat "$out"/reports/report.json "$out"/reports/report.log >&2
    }
    scontrol shutdown || true
    return $status
}

blender() {
    local bin
    scripts/setup.sh blender || return 1
    bin=$(scripts/build.sh release relief relief-sim relief_python) || return 1
    mkdir -p "$work/blender"
    PYTHONPATH=$PWD/build/release/python logged blender env blender -b --factory-startup --python-exit-code 1 \
        -P tests/samples/blender_addon.py -- "$PWD/samples/blender/relief_collider.py" "$bin/relief" "$bin/relief-sim" \
        "$work/blender" "$work/blender/errors.png" || return 1
    [ -s "$work/blender/errors.png" ] && grep '^blender: ' "$work/blender.log"
}

corpus() { scripts/accuracy.sh --corpus | sed 's/^/corpus: /'; }

fuzz() { tests/long/fuzz.sh 600; }

seeds() {
    local seed=${RELIEF_TEST_SEED:-$(date +%Y%m%d)}
    scripts/build.sh release >/dev/null || return 1
    # Whatever draws its cases by seedFrom() (tests/seeds.h), and the command lines that do.
    RELIEF_TEST_SEED=$seed RELIEF_MUTANTS=500 RELIEF_SCENES=200 logged seeds ctest --preset release -j "$(nproc)" \
        -R '^(Voxels|ImportGltf|ImportFormat|ImportParts|ImportMessage|Shape|Winding|Mutated)[.]|^cli[.](mutants|scenes)$' ||
        return 1
    # The solids of unit cubes, which take seconds, by more of them.
    local next
    for next in 1 2 3 4 5 6 7 8 9; do
        RELIEF_TEST_SEED=$((seed + next)) logged seeds ctest --preset release -j "$(nproc)" -R '^Voxels[.]' || return 1
    done
    echo "seeds: seed $seed, and of Voxels the nine after it: none is wrong"
}

cases() {
    local bin generator status=0
    bin=$(scripts/build.sh release) || return 1
    for generator in tests/cases/*_cases.py; do
        PYTHONDONTWRITEBYTECODE=1 python3 "$generator" "$bin" ${RELIEF_TEST_SEED:+--seed "$RELIEF_TEST_SEED"} || status=1
    done
    return "$status"
}

characters() {
    local bin clip clips=()
    scripts/setup.sh npm || return 1
    bin=$(scripts/build.sh release relief relief_runtime_bench_test) || return 1
    (cd "$work" && logged npm npm pack @pmndrs/viverse@0.2.20 && tar xzf pmndrs-viverse-*.tgz) || return 1
    for clip in mannequin walk run idle jump-up; do
        sed -n 's/.*base64,\([A-Za-z0-9+\/=]*\).*/\1/p' "$work/package/dist/assets/$clip.js" | base64 -d >"$work/$clip.glb" || return 1
        [ "$clip" = mannequin ] || clips+=(--clips "$work/$clip.glb")
    done
    "$bin/relief" bake "$work/mannequin.glb" --animated "${clips[@]}" -o "$work/mannequin.relief" -q &&
        RELIEF_ANIMATED=$work/mannequin.relief logged characters "$bin/relief_runtime_bench_test" --gtest_filter='*AnimatedAccuracy*' &&
        grep '% wrong' "$work/characters.log"
}

level() {
    local bin
    scripts/setup.sh sweethome3d-furniture || return 1
    bin=$(scripts/build.sh release relief) || return 1
    python3 tests/long/level.py "$work/level.glb" &&
        "$bin/relief" bake "$work/level.glb" -o "$work/level.relief" --budget 16MB -q &&
        "$bin/relief" check "$work/level.relief" --mesh "$work/level.glb" --json >"$work/level.json" || return 1
    python3 - "$work/level.json" <<'P' || return 1
import json, sys
d = json.load(open(sys.argv[1]))
verdict, nodes = d['verdict'], [group for group in d['parts']['groups'] if group['of'] == 'node']
print(f"level: {verdict['wrong_percent']:.2g} % wrong near the surface, {verdict['lost_parts']} parts lost: {verdict['grade']}; "
      f"worst nodes: {', '.join('%s %.0f %%' % (node['name'], node['wrong_percent']) for node in nodes[:3])}")
sys.exit(0 if verdict['grade'] != 'good' and verdict['lost_parts'] > 0 and nodes[0]['name'] != 'terrain' else 1)
P
    # As a world of the same bytes it is right.
    "$bin/relief" bake "$work/level.glb" --world "$work/world" --budget 16MB -q &&
        "$bin/relief" check "$work/world/world.json" --mesh "$work/level.glb" --within 0.5 --max-error 2
}

ground() {
    local bin side=4097 drops=1048576 balls=16384 dir=$work/ground name
    bin=$(scripts/build.sh release relief relief-sim) || return 1
    hills() { python3 tests/long/ground.py "$@"; }
    mkdir -p "$dir" && hills write "$dir/hills.r16" $side &&
        "$bin/relief" bake "$dir/hills.r16" --heights low=0,high=300,tile=512 --world "$dir/w" &&
        "$bin/relief" check "$dir/w/world.json" --mesh "$dir/hills.r16" | head -7 || return 1
    hills points "$dir/drops.csv" $side $drops && hills points "$dir/balls.csv" $side $balls &&
        hills points "$dir/aside.csv" $side $balls --aside 256 &&
        hills scene w/world.json $side drops drops.csv $drops >"$dir/drops.toml" &&
        hills scene w/world.json $side drops drops.csv $drops --stream 6 >"$dir/stream.toml" || return 1
    for name in drops stream; do
        "$bin/relief-sim" "$dir/$name.toml" --dump "$dir/$name.ply" && hills below "$dir/$name.ply" $side >"$dir/$name" ||
            return 1
    done
    for name in balls aside; do
        hills scene w/world.json $side balls $name.csv $balls >"$dir/$name.toml" || return 1
        for steps in 100 300; do
            "$bin/relief-sim" "$dir/$name.toml" --steps $steps --dump "$dir/$name$steps.ply" -q || return 1
        done
        hills kicks "$dir/$name"100.ply "$dir/$name"300.ply >"$dir/$name" || return 1
    done
    python3 - "$dir" <<'P'
import sys
drops, stream, balls, aside = ([float(word) for word in open(f'{sys.argv[1]}/{name}').read().split()]
                               for name in ('drops', 'stream', 'balls', 'aside'))
print(f'ground: {drops[0]:.0f} drops on seams, {drops[1]:.0f} deeper than 5 cm, the deepest {1000 * drops[2]:.0f} mm, the highest '
      f'{1000 * drops[3]:.0f} mm; with 6 MB the deepest {stream[2]:.2f} m; of balls 999 of 1000 gain at most {balls[1]:.3f} J/kg, beside '
      f'seams {aside[1]:.3f}, and any at most {balls[2]:.2f} and {aside[2]:.2f}')
# Coarse tiles, of every fourth sample, are up to 1.5 m off.
sys.exit(0 if drops[1] == 0 and drops[3] < 0.05 and stream[2] < 1.5 and stream[0] == drops[0] and balls[1] < 0.05 and
         balls[2] < 1.1 * aside[2] + 0.05 else 1)
P
}

clang() {
    built clang -DCMAKE_CXX_COMPILER=clang++ -DCMAKE_CXX_FLAGS_RELWITHDEBINFO='-O2 -g1 -DNDEBUG' &&
        logged clang ctest --test-dir "$work/clang" -j "$(nproc)" --output-on-failure || return 1
    echo "clang: $(clang++ -dumpversion) builds everything, and it passes its tests"
}

load() {
    local round status=0
    scripts/setup.sh stress-ng || return 1
    scripts/build.sh release >/dev/null || return 1
    stress-ng --quiet --cpu 2 --vm 1 --vm-bytes 512M --io 1 --temp-path "$work" &
    stress=$!
    for round in 1 2 3 4 5; do
        if ctest --preset release -j "$(nproc)" >"$work/load.log" 2>&1; then
            echo "load: round $round: all pass"
        else
            status=1
            echo "load: round $round: $(grep -cE '\((Failed|Timeout|SEGFAULT|Subprocess[^)]*)\)$' "$work/load.log") fail" >&2
            cat "$work/load.log" >&2
        fi
    done
    kill "$stress"
    stress=
    return "$status"
}

# in_bare COMMAND: runs it there as root. Its mounts and processes end with it.
in_bare() {
    # shellcheck disable=SC2016
    unshare --mount --pid --fork bash -c '
        mount --rbind /dev "$0/dev" && mount -t proc proc "$0/proc" && mount -t sysfs sysfs "$0/sys" &&
            exec env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root LANG=C.UTF-8 chroot "$0" bash -euc "$1"' \
        "$work/bare" "$1"
}

# make_bare PART PACKAGES: a minimal Debian 12 with PACKAGES in $work/bare.
make_bare() {
    [ "$(id -u)" = 0 ] || {
        echo "soak.sh: $1 needs root, for it makes a system; use sudo" >&2
        return 1
    }
    scripts/setup.sh mmdebstrap || return 1
    # From where this system has its packages.
    # shellcheck disable=SC2016
    apt-get indextargets --format 'deb $(REPO_URI) $(RELEASE) $(COMPONENT)' 'Created-By: Packages' 'Origin: Debian' |
        grep -E ' bookworm(-updates|-security)? ' >"$work/sources.list"
    rm -rf "$work/bare"
    mmdebstrap --quiet --variant=minbase --include="$2" bookworm "$work/bare" - <"$work/sources.list" || return 1
    cp /etc/resolv.conf "$work/bare/etc/"
    # And it trusts whom this system trusts: a mirror may have a certificate of its own.
    mkdir -p "$work/bare/etc/ssl/certs"
    cp /etc/ssl/certs/ca-certificates.crt "$work/bare/etc/ssl/certs/"
    echo 'cafile=/etc/ssl/certs/ca-certificates.crt' >"$work/bare/etc/npmrc"
}

bare() {
    make_bare bare ca-certificates,git || return 1
    git clone -q --no-hardlinks . "$work/bare/srv/relief" || return 1
    logged bare in_bare '/srv/relief/.ci/run' || return 1
    echo "bare: .ci/run passes: $(sed -n 's/^test.sh: //p' "$work/bare.log" | paste -sd, | sed 's/,/, /g')"
    # The same tree, so that its builds are there already: whose they are matters to tests, not to compilers.
    logged bare in_bare 'useradd -m user && chown -R user: /srv/relief &&
        su user -s /bin/bash -c "/srv/relief/scripts/test.sh"' || return 1
    echo "bare: scripts/test.sh passes without root"
    # No driver, and no library of EGL: what needs a GPU says so in a line, and what needs none works.
    logged bare in_bare 'apt-get remove -y -qq libegl-mesa0 libegl1 libgl1-mesa-dri
        cd /root
        bin=/srv/relief/build/release/bin
        refused() { # COMMAND…: exit code 5 and one line that names what to install
            local code=0
            "$@" >out 2>err || code=$?
            [ $code = 5 ] && [ ! -s out ] && [ "$(wc -l <err)" = 1 ] && grep -q "error: .*libegl1" err && return
            echo "exit code $code: $*" && cat out err
            return 1
        }
        bunny=/usr/share/glmark2/models/bunny.obj
        $bin/relief bake $bunny -o bunny.relief -q --budget 200kB
        $bin/relief check bunny.relief --mesh $bunny >/dev/null
        echo 0,0,0 >points.csv
        $bin/relief query bunny.relief --points points.csv -o answers.csv
        refused $bin/relief-sim bunny.relief --steps 3' || return 1
    echo "bare: without a GL the CPU bakes, and what needs a GPU says what to install"
}

packages() {
    make_bare packages ca-certificates || return 1
    scripts/setup.sh dpkg-dev lintian || return 1
    local room=$work/bare/srv/relief names
    mkdir -p "$room/doc"
    # With the page of relief view.
    logged packages scripts/build.sh web && logged packages scripts/build.sh packages || return 1
    # Twice: the same sources give the same packages.
    local round
    for round in 1 2; do
        rm -rf build/packages/deb
        SOURCE_DATE_EPOCH=$(git log -1 --format=%ct) logged packages cpack --preset packages || return 1
        (cd build/packages/deb && sha256sum ./*.deb) >"$work/sums.$round"
    done
    cmp "$work/sums.1" "$work/sums.2" || {
        echo "packages: the same sources give other packages" >&2
        return 1
    }
    lintian --no-cfg --allow-root --fail-on error build/packages/deb/*.deb || return 1
    names=$(cd build/packages/deb && echo *.deb)
    echo "packages: $names: lintian has no errors"
    cp build/packages/deb/*.deb "$room/"
    cp tests/long/try_packages.sh /usr/share/glmark2/models/bunny.obj "$room/"
    cp --parents README.md bake/python/README.md "$room/doc/"
    # First what users of the tools have, without a compiler or documentation; then what programmers have; then nothing.
    logged packages in_bare 'cd /srv/relief
        export DEBIAN_FRONTEND=noninteractive
        apt-get update -qq
        user() { su nobody -s /bin/bash -c "$*"; }
        apt-get install -y -qq --install-recommends ./relief_*.deb ./python3-relief_*.deb
        user RELIEF_DOC=/srv/relief/doc ./try_packages.sh /srv/relief/bunny.obj tools python >&3
        apt-get install -y -qq --no-install-recommends ./librelief1_*.deb ./librelief-dev_*.deb cmake g++ ninja-build
        user ./try_packages.sh /srv/relief/bunny.obj development >&3
        apt-get remove -y -qq relief librelief1 librelief-dev python3-relief
        left=$(find /usr -ipath "*relief*" ! -path "/usr/share/doc/*")
        [ -z "$left" ] || { echo "left behind: $left"; exit 1; }' 3>&1 || return 1
    echo "packages: removed, they leave nothing behind"
}

embree4() {
    local bin mesh options
    bin=$(scripts/build.sh release relief) || return 1
    logged embree4 ctest --test-dir build/release --output-on-failure -R '^cli[.]embree4$' || return 1
    built embree4 -DRELIEF_EMBREE=4 -Dembree_DIR="$PWD/tests/bake/mesh/embree4" -DRELIEF_BUILD_PYTHON=OFF \
        -DRELIEF_BUILD_TESTS=OFF -DRELIEF_BUILD_BENCHMARKS=OFF || return 1
    # Solids, shells and cavities; scan conversion and rays.
    for mesh in /usr/share/glmark2/models/bunny.obj /usr/share/glmark2/models/horse.3ds \
        /usr/share/assimp/models/OBJ/spider.obj; do
        for options in '--budget 200kB' '--paper --resolution 64' '--max-error 3%'; do
            # shellcheck disable=SC2086
            "$bin/relief" bake "$mesh" -o "$work/3.relief" -q $options &&
                "$work/embree4/bin/relief" bake "$mesh" -o "$work/4.relief" -q $options || return 1
            cmp "$work/3.relief" "$work/4.relief" || return 1
        done
    done
    # All but how long it took.
    checked() { # EXECUTABLE COLLIDER
        "$1" check "$work/$2" --mesh "$mesh" --json | sed "s/$2/the.relief/" |
            python3 -c 'import json, sys; d = json.load(sys.stdin); del d["times_ms"]; print(json.dumps(d, indent=1))'
    }
    checked "$bin/relief" 3.relief >"$work/3.json" && checked "$work/embree4/bin/relief" 4.relief >"$work/4.json" &&
        diff "$work/3.json" "$work/4.json" >&2 || {
        echo "embree4: relief check says something else" >&2
        return 1
    }
    echo "embree4: nine bakes of three meshes are the same bytes"
}

failed=0
for run in "${runs[@]}"; do
    [[ " ${all_runs[*]} " == *" $run "* ]] || {
        echo "soak.sh: unknown run '$run'; choose of: ${all_runs[*]}" >&2
        exit 1
    }
    "$run" || failed=1
done
exit $failed
