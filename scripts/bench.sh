#!/usr/bin/env bash
# Prints the ratios that Relief promises, each from one run on this machine. Nothing here is a test, because machines are
# shared and noisy.
#
#   scripts/bench.sh [MESH]                      all of them, as medians; run it twice before you believe a change
#   scripts/bench.sh --save OLD.json             nine rounds of the ratios of bakes and steps (--rounds N: other than 9)
#   scripts/bench.sh --against OLD.json          the same of this build, and whether it is slower: exit code 1, else 0
#                                                (bench_compare.py says how noise is told; with --save also kept)
#   scripts/bench.sh --growth DIR [OPTION]…      time against triangles, bytes and particles, as DIR/growth.png and .csv;
#                                                bench_growth.py --help has the options
#
# RELIEF_BENCH_LARGE=1 takes the sizes for a GPU (a million particles and more) even where there is none.
set -euo pipefail

if [ "${1:-}" = --growth ]; then
    [ $# -ge 2 ] || {
        echo "bench.sh: --growth needs a folder for growth.png and growth.csv" >&2
        exit 2
    }
    folder=$(realpath -m "$2")
    shift 2
    root=$(realpath "$(dirname "$0")/..")
    "$root/scripts/setup.sh" libopenvdb-tools python3-matplotlib
    bin=$("$root/scripts/build.sh" release relief relief-bench-step)
    exec /usr/bin/python3 "$root/scripts/bench_growth.py" --bin "$bin" --out "$folder" "$@"
fi

save='' against='' rounds=9 mesh=/usr/share/glmark2/models/bunny.obj
while [ $# -gt 0 ]; do
    case $1 in
    --save | --against | --rounds)
        [ $# -ge 2 ] || {
            echo "bench.sh: $1 needs a value" >&2
            exit 2
        }
        case $1 in
        --save) save=$(realpath -m "$2") ;;
        --against) against=$(realpath -m "$2") ;;
        --rounds) rounds=$2 ;;
        esac
        shift 2
        ;;
    -*)
        echo "bench.sh: unknown option $1; scripts/bench.sh [MESH] [--save FILE] [--against FILE] [--rounds N]," \
            "or --growth DIR" >&2
        exit 2
        ;;
    *)
        mesh=$(realpath "$1")
        shift
        ;;
    esac
done
[[ $rounds =~ ^[1-9][0-9]{0,3}$ ]] || {
    echo "bench.sh: --rounds $rounds is no number from 1 to 9999" >&2
    exit 2
}
[ -z "$against" ] || [ -r "$against" ] || {
    echo "bench.sh: $against cannot be read; write it with scripts/bench.sh --save" >&2
    exit 2
}
cd "$(dirname "$0")/.."

scripts/setup.sh
if [ -n "$save$against" ]; then
    bin=$(scripts/build.sh release relief relief-bench-raycast relief-bench-step)
    work=$(mktemp -d)
    trap 'rm -rf "$work"' EXIT
    python3 scripts/bench_save.py "$bin" "$mesh" "$rounds" "${save:-$work/new.json}"
    [ -z "$against" ] || python3 scripts/bench_compare.py "$against" "${save:-$work/new.json}"
    exit
fi
bin=$(scripts/build.sh release relief relief-sim relief-bench-raycast relief-bench-step relief-bench-sort \
    relief-bench-picture relief-bench-births relief-bench-depth-maps)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

"$bin/relief-bench-raycast" "$mesh" >"$work/bench.json"
python3 - "$bin" "$mesh" "$work" <<'P'
import csv, json, statistics, struct, subprocess, sys, time
bin, mesh, work = sys.argv[1:]
bench = json.load(open(f'{work}/bench.json'))
ms = bench['median_ms']
print(f"mesh {bench['mesh']}, {bench['triangles']} triangles; medians of {bench['repeats']} runs, ms")
for name, value in ms.items():
    print(f'  {name:16s} {value:8.1f}')

# The whole process, for the six maps (three front-back) that the loop above traces.
specs = [a for d in ('-x', '-y', '-z') for a in ('--map', f'front-back:dir={d},depth=half,decode=projected')]
command = [f'{bin}/relief', 'bake', mesh, '-o', f'{work}/out.relief', '-q', *specs]
# Its floor is measured as cold as the process itself: a fresh process each time, in turns.
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

# The particle step: planned maps of 1 MB against the paper's collider, one front-back map and one cube of 512
# texels a side. Snow as in samples/, but born at once all through the box of the bunny: so it has
# something to collide with from the first step on.
COUNT, STEPS, REPEATS = 262144, 64, 5
paper_maps = ['--map', 'front-back:dir=-z,size=512,depth=half,decode=projected',
              '--map', 'cube:size=512,decode=projected']
for name, maps in ('planned', ['--budget', '1MB']), ('paper', paper_maps):
    subprocess.run([f'{bin}/relief', 'bake', mesh, '-o', f'{work}/{name}.relief', '-q', *maps], check=True)
info = json.loads(subprocess.run([f'{bin}/relief', 'info', f'{work}/planned.relief', '--json'],
                                 check=True, capture_output=True).stdout)
low, high = info['bounds']['min'], info['bounds']['max']
side = max(h - l for l, h in zip(low, high))
for name in 'planned', 'paper':
    open(f'{work}/{name}.toml', 'w').write(
        f'[collider]\nfile = "{name}.relief"\n[particles]\ncapacity = {COUNT}\n[emitter]\nburst = {COUNT}\n'
        f'rate = 0.0\nbox_min = {low}\nbox_max = {high}\n[forces]\ndrag = 2.5\n'
        f'wind = [{0.125 * side}, 0.0, {0.05 * side}]\n')

def play(name, steps, *options):
    return json.loads(subprocess.run([f'{bin}/relief-sim', f'{work}/{name}.toml', '--steps', str(steps), '--json',
                                      '-q', *options], check=True, capture_output=True).stdout)

def near(name, steps):
    """Share of the particles inside or within 5 % of the longest side, as the planned maps see it."""
    play(name, steps, '--dump', f'{work}/end.ply')
    data = open(f'{work}/end.ply', 'rb').read()
    data = data[data.index(b'end_header\n') + 11:]
    with open(f'{work}/points.csv', 'w') as out:
        out.writelines('%.9g,%.9g,%.9g\n' % p[:3] for p in struct.iter_unpack('<8f2I', data))
    subprocess.run([f'{bin}/relief', 'query', f'{work}/planned.relief', '--points', f'{work}/points.csv',
                    '-o', f'{work}/field.csv'], check=True)
    with open(f'{work}/field.csv') as file:
        fields = [row['f'] for row in csv.DictReader(file)]
    return sum(f != '' and float(f) < 0.05 * side for f in fields) / len(fields)

runs = {'planned': [], 'paper': []}
for _ in range(REPEATS):  # in turns, so that both meet the same other work on the machine
    for name in runs:
        runs[name].append(play(name, STEPS))
step = {name: statistics.median(r['ms_per_step_median'] for r in reports) for name, reports in runs.items()}
print(f"step of {COUNT} particles, median of {REPEATS} runs of {STEPS} steps in turns, on {runs['paper'][0]['device']}")
for name, reports in runs.items():
    collider, particles = reports[0]['collider'], reports[0]['particles']
    print(f"  {name:8s} {step[name]:8.2f} ms, {1e6 * step[name] / COUNT:6.1f} ns a particle; {collider['maps']} maps, "
          f"{collider['gpu_bytes'] / 1e6:.2f} MB; near the mesh: {100 * near(name, 1):.0f} % at first, "
          f"{100 * near(name, STEPS):.0f} % at last; {particles['collisions'] / COUNT / STEPS:.2f} contacts a step")
print(f"planned / paper                                    {step['planned'] / step['paper']:.2f}   "
      f"(at most 2 on llvmpipe, 1 on a GPU)")
P

# The runtime: what a step costs, feature by feature; pictures; the depth sort; births.
large=${RELIEF_BENCH_LARGE:-0}
[ "$large" = 1 ] && large_option=--large || large_option=
"$bin/relief-bench-step" "$work/planned.relief" $large_option >"$work/step.json"
"$bin/relief-bench-sort" >"$work/sort.json"
[ "$large" = 1 ] || ! grep -q '"software": true' "$work/step.json" && count=1048576 || count=65536
"$bin/relief-bench-picture" "$work/planned.relief" --particles $count >"$work/picture.json"
capacities=(16667)
if [ "$large" != 1 ] && grep -q '"software": true' "$work/step.json"; then
    capacities+=(65536 262144)
fi
"$bin/relief-bench-births" "${capacities[@]}" >"$work/births.json"
python3 - "$work" <<'P'
import json, sys
work = sys.argv[1]
step, sort, births, picture = (json.load(open(f'{work}/{name}.json')) for name in ('step', 'sort', 'births', 'picture'))

steps, copy = step['steps'], step['copy']
print(f"\nstep of {steps['particles']} particles, medians of {steps['blocks']} blocks of {steps['block']} in turns, "
      f"on {step['renderer']}; ratios of {step['ratios_of']}")
ratio = copy['step_over_copy']
print(f"  {'bare copy':20s} {copy['ms']:8.3f} ms")
for v in step['variants']:
    r, t = v['over_collider'], v['touching']
    print(f"  {v['name']:20s} {v['ms']:8.3f} ms, {r['median']:5.2f} of collider ({r['least']:.2f} to {r['most']:.2f}); "
          f"{100 * t['in_contact'] / t['alive']:3.0f} % touch, {t['contacts_a_step']:.2f} contacts a step: {v['what']}")
print(f"step without collider / bare copy                  {ratio['median']:.2f}   "
      f"({ratio['least']:.2f} to {ratio['most']:.2f})")
for f in step['frames']:
    size = 'x'.join(map(str, f['picture']))
    print(f"frame of {f['particles']:7d} particles, {size}: step {f['step_ms']:.2f} ms, "
          f"with points {f['points_ms']:.2f} ms, with quads {f['quads_ms']:.2f} ms")
for p in picture['pictures']:
    size, parts = 'x'.join(map(str, p['picture'])), p['parts']
    print(f"picture of {picture['particles']} points of {p['pixels_of_a_point']:.1f} pixels, {size}: "
          + ', '.join(f"{name} {part['ms']:.2f}" for name, part in parts.items()) + ' ms')
    print(f"picture with light, soft edges, order / bare draw  {parts['all']['over_bare']:.2f}   (at most 1.2 on a GPU)")
for s in sort['sorts']:
    print(f"sort of {s['particles']:8d} particles: {s['passes_per_ms']:.3f} passes/ms, "
          f"{s['frame_ms_over_30']:.2f} ms a frame over 30 frames, whole {s['sequence_ms']:.2f} ms"
          + (f", as compute {s['compute_ms']:.3f} ms" if 'compute_ms' in s else ''))
for c in births['capacities']:
    b = c['births_per_ms']
    print(f"births, capacity {c['capacity']:8d}, {c['path']}: {b['emit']:.0f} sampled, {b['spawn']:.0f} placed, "
          f"{b['draw']:.0f} drawn per ms; {c['bookkeeping']['ns_per_death']:.0f} ns a death")
P

# Depth maps from a mesh on the GPU, over a bare draw of the same triangles. OBJ and PLY alone.
case $mesh in
*.obj | *.ply)
    "$bin/relief-bench-depth-maps" "$mesh" >"$work/depth_maps.json"
    python3 - "$work" <<'P'
import json, sys
bench = json.load(open(f'{sys.argv[1]}/depth_maps.json'))
print(f"\nmaps of {bench['size']}² from {bench['triangles']} triangles, on {bench['device']}; milliseconds of the GPU (wall)")
for s in bench['sets']:
    print(f"  {s['maps']:24s} {s['decode']:9s} {s['gpu_ms']:8.3f} ({s['wall_ms']:.3f}), bare draw {s['bare_gpu_ms']:.3f} "
          f"({s['bare_wall_ms']:.3f}): {s['gpu_ratio']:.2f} ({s['wall_ratio']:.2f}; at most 1.3 on a GPU); "
          f"with planes {s['with_planes_gpu_ms']:.3f}, exact {s['exact_gpu_ms']:.3f}")
P
    ;;
esac
