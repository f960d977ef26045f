#!/usr/bin/env bash
# Prints the ratios that Relief promises, each from one run on this machine: scripts/bench.sh [MESH]
# Nothing here is a test: machines are shared and noisy. Medians; run it twice before you believe a change.
set -euo pipefail
cd "$(dirname "$0")/.."

scripts/setup.sh
mesh=${1:-/usr/share/glmark2/models/bunny.obj}
bin=$(scripts/build.sh release relief relief-sim relief-bench-raycast)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

"$bin/relief-bench-raycast" "$mesh" >"$work/bench.json"
python3 - "$bin" "$mesh" "$work" <<'P'
import json, statistics, subprocess, sys, time
bin, mesh, work = sys.argv[1:]
bench = json.load(open(f'{work}/bench.json'))
ms = bench['median_ms']
print(f"mesh {bench['mesh']}, {bench['triangles']} triangles; medians of {bench['repeats']} runs, ms")
for name, value in ms.items():
    print(f'  {name:16s} {value:8.1f}')

# The whole process, for the six maps (three front-back) that the loop above traces.
specs = [a for d in ('-x', '-y', '-z') for a in ('--map', f'front-back:dir={d},decode=projected,depth=half')]
command = [f'{bin}/relief', 'bake', mesh, '-o', f'{work}/out.relief', '-q', *specs]
# Its floor is taken as cold as the process itself: a fresh process each time, in turns.
times, floors = [], []
for _ in range(15):
    floor = subprocess.run([f'{bin}/relief-bench-raycast', mesh, f'{work}/floor.relief'], check=True, capture_output=True)
    floors.append(json.loads(floor.stdout)['sum'])
    start = time.perf_counter()
    subprocess.run(command, check=True)
    times.append(1000 * (time.perf_counter() - start))
process, floor = statistics.median(times), statistics.median(floors)
print(f'  {"floor of bake":16s} {floor:8.1f}   (import + tree + bare loop + write in a fresh process)')
print(f'  {"relief bake":16s} {process:8.1f}   (whole process)')
print(f"trace / bare rtcIntersect16 loop                   {ms['trace'] / ms['bare_loop']:.2f}   (at most 1.5)")
print(f"relief bake / (import + build + bare loop + write) {process / floor:.2f}   (at most 1.3)")

# The particle step, with the paper's collider.
subprocess.run([f'{bin}/relief', 'bake', mesh, '-o', f'{work}/default.relief', '-q', '--paper'], check=True)
open(f'{work}/scene.toml', 'w').write('[collider]\nfile = "default.relief"\n[particles]\ncapacity = 262144\n'
                                      '[emitter]\nburst = 262144\nrate = 0.0\n')
report = json.loads(subprocess.run([f'{bin}/relief-sim', f'{work}/scene.toml', '--steps', '60', '--json', '-q'],
                                   check=True, capture_output=True).stdout)
print(f"step of {report['particles']['alive']} particles, paper's collider: {report['ms_per_step']:.2f} ms "
      f"on {report['device']}")
P
