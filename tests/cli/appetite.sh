# Small inputs take little time and memory, whatever they claim; what is refused names the option that allows it. The limit of
# memory is that of the process, by setrlimit; no case takes a minute.
source "$RELIEF_SOURCE/tests/cli/lib.sh"
export PYTHONPATH=$PYTHONPATH:$RELIEF_SOURCE/tests/cases

# within MB COMMAND…: in so much address space, and a minute of the processor.
within() {
    local megabytes=$1
    shift
    (
        ulimit -t 60 -v $((megabytes * 1000))
        exec "$@"
    )
}

python3 - <<'P'
import struct
from containers import container, empty_map, plain_map

open("bomb.relief", "wb").write(container([empty_map(16384, 16376)]))        # 2 GB of texels in 66 kB
open("large.relief", "wb").write(container([empty_map(4096, 8192, 1)] * 2))  # 268 MB
open("small.relief", "wb").write(container([empty_map(512, 512)]))
texel = struct.pack("<4H", 0x7f7f, 0x7f7f, 9000, 50000)
open("tiny.relief", "wb").write(container([plain_map(4, 4, texel * 16)] * 1024))
open("points.csv", "w").write("0,0,0\n")


def obj(name, boxes):
    with open(name, "w") as out:
        for at, half in boxes:
            for k in range(8):
                out.write("v %r %r %r\n" % tuple(c + (half if k >> i & 1 else -half) for i, c in enumerate(at)))
        for i in range(len(boxes)):
            for face in [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]:
                out.write("f " + " ".join(str(8 * i + c + 1) for c in face) + "\n")


obj("far.obj", [((0, 0, 0), 0.5), ((1e5, 0, 0), 0.5)])
obj("specks.obj", [((1e8 * ((i * 3) % 13 - 6) / 6, 1e8 * ((i * 5) % 13 - 6) / 6, 1e8 * ((i * 7) % 13 - 6) / 6), 40)
                   for i in range(12)])
obj("apart.obj", [((0, 0, 0), 100), ((7e4, 7e4, 7e4), 100)])
with open("scattered.obj", "w") as out:  # twelve triangles
    for i in range(12):
        x, y, z = (1e8 * ((i * k) % 13 - 6) / 6 for k in (3, 5, 7))
        for dx, dy in ((0, 0), (900, 10), (40, 800)):
            out.write(f"v {x + dx} {y + dy} {z + dx}\n")
        out.write(f"f {3 * i + 1} {3 * i + 2} {3 * i + 3}\n")
P

# A file of 66 kB: refused before the work, by every verb that reads it.
refused='bomb.relief.*2146435072 bytes in memory.*--max-memory'
expect_error 6 "$refused" within 500 "$relief" info bomb.relief
expect_error 6 "$refused" within 500 "$relief" slice bomb.relief -o x.png
expect_error 6 "$refused" within 500 "$relief" query bomb.relief --points points.csv -o out.csv
expect_error 6 "$refused" within 500 "$relief" export bomb.relief -o maps
expect_error 6 "$refused" within 500 "$relief_sim" bomb.relief --check
expect 6 within 500 "$relief" check bomb.relief
matches -q 'RLF-1402' <stdout || die "check says nothing of the limit: $(cat stdout)"
matches -q -- '--max-memory' <stderr || die "check names no option: $(cat stderr)"
[ ! -e maps ] || die "export made a folder for nothing"

# Beyond the limit, a sound file is read where it is asked for.
expect_error 6 '268435456 bytes.*--max-memory' within 500 "$relief" info large.relief
expect 0 within 800 "$relief" info large.relief --max-memory 300MB
expect 0 within 800 "$relief" check large.relief --max-memory 300MB
expect 0 within 500 "$relief_sim" small.relief --check --max-memory 10MB
expect_error 1 'max-memory' "$relief" info small.relief --max-memory much

# A thousand maps.
expect 0 within 500 "$relief" query tiny.relief --points points.csv -o out.csv

# Parts far apart: bounded maps, and an error that names what was given and what helps.
expect 0 within 2000 "$relief" bake apart.obj -o apart.relief --no-check
expect 0 within 2000 "$relief" bake far.obj -o far.relief --no-check
expect_error 4 'specks.obj: no map sees .* smaller than a texel of .* by themselves' \
    within 2000 "$relief" bake specks.obj -o specks.relief -q
expect_error 4 'scattered.obj: no map sees .* smaller than a texel of .* by themselves' \
    within 2000 "$relief" bake scattered.obj -o scattered.relief -q
