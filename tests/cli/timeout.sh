# SPDX-License-Identifier: Apache-2.0
# relief bake --timeout: stops in time with one line that names the current stage, and leaves the existing files, no
# incomplete file and no worker. Also the progress line, which shows the stage.
. "$(dirname "$0")/lib.sh"
mkdir out

# limited SECONDS ARGUMENT…: bakes into out/a.relief in a separate process group; sets $code
limited() {
    local seconds=$1
    shift
    code=0
    setsid --wait bash -c 'echo $$ >group; exec "$@"' - "$relief" bake "$@" -o out/a.relief --depfile out/a.d \
        --timeout "$seconds" >stdout 2>stderr </dev/null || code=$?
    gone "$(cat group)" || die "a process outlived the time limit"
}

"$relief" bake "$bunny" -o new.relief --budget 30kB -q
"$relief" bake "$bunny" -o old.relief --budget 20kB -q
restore_old() { cp old.relief out/a.relief && echo old >out/a.d; }
outputs_are() { # old or new: both files must be
    cmp -s out/a.relief "$1.relief" && [ "$1" = "$(grep -qx old out/a.d && echo old || echo new)" ] && [ "$(ls -A out)" = $'a.d\na.relief' ]
}

# A search that would take long.
restore_old
start=$(date +%s%N)
limited 1 "$bunny" --max-error 0.001% -q
took=$((($(date +%s%N) - start) / 1000000))
[ "$code" -eq 6 ] && [ "$(wc -l <stderr)" -eq 1 ] || die "exit code $code: $(cat stderr)"
grep -qE "^relief: error: '.*bunny\.obj': the bake did not finish within 1 s; it was [a-z ]+, for [0-9.]+ s; .*--timeout" stderr ||
    die "the error says: $(cat stderr)"
[ "$took" -lt 5000 ] || die "it took $took ms"
outputs_are old || die "a stopped bake leaves $(ls -lA out)"

# An import that would never end. The worker ends, too.
unfold unfold.dae
limited 0.5 unfold.dae --import-timeout 600 --max-import-memory 100GB
[ "$code" -eq 6 ] && grep -q "unfold\.dae.*within 0\.5 s; it was reading the mesh" stderr || die "exit code $code: $(cat stderr)"
outputs_are old || die "an import whose time is up leaves $(ls -lA out)"

# At any time: all files new or all old.
start=$(date +%s%N)
"$relief" bake "$bunny" -o timed.relief --budget 30kB -q
span=$((($(date +%s%N) - start) / 1000000))
ended=0
for i in $(seq 12); do
    restore_old
    ms=$((span * i / 11))
    limited "$((ms / 1000)).$(printf %03d $((ms % 1000 + 1)))" "$bunny" --budget 30kB -q
    case $code in
        0) outputs_are new || die "after $ms ms: success without the new files" ;;
        6) outputs_are old && ended=$((ended + 1)) || die "after $ms ms: exit code 6, and not the old files" ;;
        *) die "after $ms ms: exit code $code: $(cat stderr)" ;;
    esac
done
[ "$ended" -ge 3 ] || die "only $ended of 12 limits stopped the bake"

# A sufficient limit changes nothing.
restore_old
limited 600 "$bunny" --budget 30kB
[ "$code" -eq 0 ] && outputs_are new || die "with enough time: exit code $code: $(cat stderr)"

expect_error 1 'timeout' "$relief" bake "$bunny" -o x.relief --timeout=1s

# The progress line: only on a terminal, erased at the end, and not with -q.
cat >terminal.py <<'P'
import os, pty, re, sys
child, terminal = pty.fork()
if child == 0:
    os.execv(sys.argv[1], sys.argv[1:])
shown = b''
while True:
    try:
        data = os.read(terminal, 4096)
    except OSError:  # EIO: the other end is closed
        break
    if not data:
        break
    shown += data
_, status = os.waitpid(child, 0)
shown = shown.decode()
lines = [re.sub('\x1b\\[K', '', line) for line in shown.split('\r')]
print('\n'.join(line for line in lines if re.search(r'bunny\.obj\': .*, \d+ s$', line)))
assert shown.rfind(' s\x1b[K') <= shown.rfind('\r\x1b[K'), 'the line stays'
sys.exit(os.waitstatus_to_exitcode(status))
P
python3 terminal.py "$relief" bake "$bunny" -o x.relief --max-error 0.5% -j 1 --timeout 600 >lines || die "on a terminal: $(cat lines)"
grep -qE "bunny\.obj': searching for the smallest budget, [0-9]+ s" lines || die "the line is: $(head -3 lines)"
python3 terminal.py "$relief" bake "$bunny" -o x.relief --paper --resolution 1024 -j 1 --quality best >lines || die "on a terminal: $(cat lines)"
grep -qE "bunny\.obj': baking the maps \[#+\.*\] [0-9]+ %, [0-9]+ s" lines || die "the line is: $(head -3 lines)"
python3 terminal.py "$relief" bake "$bunny" -o x.relief --max-error 2% -q >lines || die "on a terminal: $(cat lines)"
[ ! -s lines ] || [ "$(tr -d '\n' <lines)" = '' ] || die "-q shows $(head -1 lines)"
