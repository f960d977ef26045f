# SPDX-License-Identifier: Apache-2.0
# Small containers use little memory, regardless of what they claim, and errors name the option that raises the limit.
# setrlimit limits the memory of the process. tests/cases/appetite_cases.py tests random meshes.
source "$RELIEF_SOURCE/tests/cli/lib.sh"
export PYTHONPATH=$PYTHONPATH:$RELIEF_SOURCE/tests/cases

# within MB COMMAND…: runs with this much address space and a minute of CPU time
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
P

# A file of 66 kB: every verb that reads it rejects it early.
refused='bomb.relief.*2146435072 bytes in memory.*--max-memory'
expect_error 6 "$refused" within 500 "$relief" info bomb.relief
expect_error 6 "$refused" within 500 "$relief" slice bomb.relief -o x.png
expect_error 6 "$refused" within 500 "$relief" query bomb.relief --points points.csv -o out.csv
expect_error 6 "$refused" within 500 "$relief" export bomb.relief -o maps
expect_error 6 "$refused" within 500 "$relief_sim" bomb.relief --check
expect 6 within 500 "$relief" check bomb.relief
matches -q 'RLF-1402' <stdout || die "check does not mention the limit: $(cat stdout)"
matches -q -- '--max-memory' <stderr || die "check does not name the option: $(cat stderr)"
[ ! -e maps ] || die "a failed export created a folder"

# With a higher limit, a valid file is read.
expect_error 6 '268435456 bytes.*--max-memory' within 500 "$relief" info large.relief
expect 0 within 800 "$relief" info large.relief --max-memory 300MB
expect 0 within 800 "$relief" check large.relief --max-memory 300MB
expect 0 within 500 "$relief_sim" small.relief --check --max-memory 10MB
expect_error 1 'max-memory' "$relief" info small.relief --max-memory much

# A thousand maps.
expect 0 within 500 "$relief" query tiny.relief --points points.csv -o out.csv
