# SPDX-License-Identifier: Apache-2.0
# Output files are either the complete old or the complete new file: after SIGKILL or an error in any system call of the
# write, on a full disk, with concurrent writers, and after signals at any time.
#   RELIEF_ATOMIC_ROUNDS=N  rounds of writers and of signals (1)
. "$(dirname "$0")/lib.sh"
rounds=${RELIEF_ATOMIC_ROUNDS:-1}

command -v strace >/dev/null || die "strace is missing; run scripts/setup.sh"
strace -o probe.trace true 2>probe.err ||
    die "strace cannot trace here (ptrace is not permitted), so nothing can be tested: $(head -1 probe.err)"
mkdir out
box cube.obj 1 1 1
hash_of() { sha256sum <"$1" | cut -d' ' -f1; }
bake=("$relief" bake cube.obj --paper -j 1 -q -o)
"${bake[@]}" new.relief --resolution 8
"${bake[@]}" old.relief --resolution 4
new=$(hash_of new.relief) old=$(hash_of old.relief)
[ "$new" != "$old" ] || die "the old and the new file are equal"

# --- kills and errors in every system call of the write ---

# `calls`: the main thread's system calls from the temporary file to the end, as "SYSCALL N TARGET". N counts the calls
# of this name in the main thread, like strace's when=, which counts per thread.
cp old.relief out/a.relief
strace -o trace "${bake[@]}" out/a.relief --resolution 8
[ "$(hash_of out/a.relief)" = "$new" ] || die "a traced bake gives a different file"
python3 - >calls <<'P'
import re
seen, writing, calls = {}, False, []
for line in open('trace'):
    match = re.match(r'(\w+)\(', line)
    if not match:
        continue
    name = match[1]
    seen[name] = seen.get(name, 0) + 1
    calls.append((name, seen[name], line))
first = next(i for i, (name, _, line) in enumerate(calls) if 'O_CREAT' in line and '.relief-' in line)
last = max(i for i, (name, _, _) in enumerate(calls) if name in ('rename', 'renameat', 'fsync', 'close'))
# The write starts at the last access to the target before the temporary file is created.
while first > 0 and calls[first - 1][0] in ('rt_sigprocmask', 'getpid', 'getrandom', 'getdents64', 'fstat', 'newfstatat', 'close', 'openat', 'readlink', 'brk'):
    first -= 1
names = {'openat', 'open', 'write', 'pwrite64', 'fsync', 'fdatasync', 'close', 'rename', 'renameat', 'renameat2', 'fchmod',
         'newfstatat', 'fstat', 'readlink', 'getdents64', 'getrandom', 'linkat', 'unlink'}
for name, number, line in calls[first:last + 1]:
    if name in names:
        what = 'temporary' if '.relief-' in line else 'other'
        print(name, number, what)
P
[ "$(wc -l <calls)" -ge 10 ] || die "the trace shows too few calls of the write: $(cat calls)"
for name in openat write fsync close rename fchmod; do
    grep -q "^$name " calls || die "the trace shows no $name"
done

kills=0 errors=0 torn=0 left_by_kill=0
check_old_or_new() { # WHAT
    local got
    got=$(hash_of out/a.relief)
    case $got in
        "$new" | "$old") ;;
        *)
            torn=$((torn + 1))
            die "$1 left an incomplete file"
            ;;
    esac
}
temporary_files() { find out -name '.relief-*' | wc -l; }

while read -r name number _; do
    cp old.relief out/a.relief
    code=0
    # The braces capture messages of bash, such as "Killed".
    { strace -o /dev/null -e "inject=$name:signal=KILL:when=$number" "${bake[@]}" out/a.relief --resolution 8; } \
        >/dev/null 2>&1 || code=$?
    [ "$code" -eq 137 ] || die "SIGKILL at $name $number: exit code $code"
    kills=$((kills + 1))
    check_old_or_new "SIGKILL at $name $number"
    left_by_kill=$((left_by_kill + $(temporary_files)))
done <calls
[ "$left_by_kill" -gt 0 ] || die "no kill happened while a temporary file existed, so nothing was tested"
rm -f out/.relief-*.tmp

# fails NAME NUMBER ERRNO: the bake succeeds, or the error is named, the old file is kept and no other file is left.
fails() {
    local name=$1 number=$2 errno=$3 code=0 words
    cp old.relief out/a.relief
    strace -o injected -e "inject=$name:error=$errno:when=$number" "${bake[@]}" out/a.relief --resolution 8 2>stderr || code=$?
    grep -q INJECTED injected || die "$errno was not injected at $name $number"
    errors=$((errors + 1))
    check_old_or_new "$errno at $name $number"
    [ "$(temporary_files)" -eq 0 ] || die "$errno at $name $number leaves a temporary file"
    if [ "$code" -eq 0 ]; then
        [ "$(hash_of out/a.relief)" = "$new" ] || die "$errno at $name $number: success without the new file"
        return
    fi
    [ "$code" -eq 2 ] || die "$errno at $name $number: exit code $code: $(cat stderr)"
    words=$(python3 -c "import errno, os; print(os.strerror(errno.$errno))")
    [ "$(wc -l <stderr)" -eq 1 ] && grep -qF "$words" stderr && grep -qF "out/a.relief'" stderr ||
        die "$errno at $name $number is not named: $(cat stderr)"
    echo "$name $errno" >>reported
}
: >reported
while read -r name number _; do
    case $name in
        openat) list='ENOSPC EACCES EMFILE EINTR' ;;
        write) list='ENOSPC EIO EDQUOT EINTR' ;;
        fsync) list='ENOSPC EIO EDQUOT EINTR' ;;
        close) list='EIO ENOSPC EDQUOT EINTR' ;;
        rename) list='EACCES EIO EDQUOT' ;;
        fchmod) list='EIO EACCES' ;;
        *) list='' ;;
    esac
    for errno in $list; do
        fails "$name" "$number" "$errno"
    done
done <calls
# Each error must be reported at least once, and interrupted calls must be repeated.
for pair in 'openat ENOSPC' 'openat EACCES' 'write ENOSPC' 'write EIO' 'write EDQUOT' 'fsync ENOSPC' 'fsync EIO' 'fsync EDQUOT' \
    'close EIO' 'close ENOSPC' 'close EDQUOT' 'rename EACCES' 'rename EIO' 'fchmod EIO'; do
    grep -qx "$pair" reported || die "no call reported: $pair"
done
! grep -q EINTR reported || die "an interrupted call was an error: $(grep EINTR reported)"

# --- a full disk ---

cat >full.sh <<'F'
set -e
mount -t tmpfs -o size=64k tmpfs out
cp old.relief out/a.relief
code=0
"$@" out/a.relief --resolution 64 2>stderr || code=$?
[ "$code" -eq 2 ] && grep -q 'No space left on device' stderr && cmp old.relief out/a.relief &&
    [ "$(ls -A out)" = a.relief ] || { echo "exit code $code: $(cat stderr); $(ls -A out)"; exit 1; }
F
if unshare -Urm true 2>/dev/null; then
    full='a tmpfs of 64 KiB'
    unshare -Urm bash full.sh "${bake[@]}" >full.log 2>&1 || die "a full tmpfs: $(cat full.log)"
else
    full='a file size limit and /dev/full, for no tmpfs may be mounted here'
fi
cp old.relief out/a.relief
code=0
(ulimit -f 64 && exec "${bake[@]}" out/a.relief --resolution 64) 2>stderr || code=$?
[ "$code" -eq 2 ] && grep -q 'File too large' stderr || die "above the file size limit: exit code $code, $(cat stderr)"
cmp -s old.relief out/a.relief && [ "$(temporary_files)" -eq 0 ] || die "the file size limit changes files"
expect_error 2 '/dev/full.*No space left' "${bake[@]}" /dev/full
echo "full disk: $full"

# --- eight concurrent writers and readers of one path ---

writes=0 reads=0
cp old.relief out/a.relief
for ((round = 0; round < rounds; ++round)); do
    pids=()
    for writer in 1 2 3 4 5 6 7 8; do
        for resolution in 4 8 4; do
            "${bake[@]}" out/a.relief --resolution "$resolution" || exit 1
        done &
        pids+=($!)
    done
    writes=$((writes + 24))
    for ((i = 0; i < 20; ++i)); do
        "$relief" info out/a.relief -q >/dev/null || die "a reader found an invalid file"
        check_old_or_new "a writer among eight"
        reads=$((reads + 1))
    done
    for pid in "${pids[@]}"; do
        wait "$pid" || die "one of eight writers failed"
    done
    check_old_or_new "eight writers"
    [ "$(temporary_files)" -eq 0 ] || die "eight writers leave a temporary file"
done

# --- signals ---

signals=0
cat >interrupt.py <<'P'
import os, random, signal, subprocess, sys, time
import processes
relief, rounds, mesh = sys.argv[1], int(sys.argv[2]), sys.argv[3]
old, new = open('old.relief', 'rb').read(), None
command = [relief, 'bake', mesh, '-o', 'out/a.relief', '--budget', '50kB', '-q']
start = time.monotonic()
subprocess.run(command, check=True)
span = time.monotonic() - start
new = open('out/a.relief', 'rb').read()
rng = random.Random(1)
ended = 0
for i in range(16 * rounds):
    number = [signal.SIGINT, signal.SIGTERM, signal.SIGHUP, signal.SIGQUIT][i % 4]
    open('out/a.relief', 'wb').write(old)
    child = subprocess.Popen(command, start_new_session=True, preexec_fn=lambda: __import__('resource').setrlimit(4, (0, 0)))
    time.sleep(span * rng.random())
    child.send_signal(number)
    sent = time.monotonic()
    code = child.wait()
    took = time.monotonic() - sent
    assert code in (0, -number), (number, code)
    ended += code == -number
    assert code == 0 or took < 2.0, f'{took:.1f} s after signal {number}'
    left = [name for name in os.listdir('out') if name.startswith('.relief-')]
    assert not left, left
    assert processes.gone(child.pid, 5.0), 'a child lives on'
    assert open('out/a.relief', 'rb').read() in (old, new), 'torn'
assert ended >= 4 * rounds, f'only {ended} signals came in time'
print(16 * rounds)
P
signals=$(python3 interrupt.py "$relief" "$rounds" "$bunny") || die "signals: see above"
# Signals during the write: strace delivers them at its system calls.
while read -r name number _; do
    for word in INT TERM HUP QUIT; do
        cp old.relief out/a.relief
        code=0
        { (ulimit -c 0 && exec strace -o /dev/null -e "inject=$name:signal=$word:when=$number" "${bake[@]}" out/a.relief --resolution 8); } \
            >/dev/null 2>&1 || code=$?
        [ "$code" -eq $((128 + $(kill -l "$word"))) ] || die "SIG$word at $name $number: exit code $code"
        check_old_or_new "SIG$word at $name $number"
        [ "$(temporary_files)" -eq 0 ] || die "SIG$word at $name $number leaves a temporary file"
        signals=$((signals + 1))
    done
done < <(awk '$3 == "temporary" || $1 == "write" || $1 == "fsync"' calls)

cat <<C
| what | times | torn files | temporary files left |
| --- | ---: | ---: | ---: |
| SIGKILL at each system call of the writing | $kills | $torn | $left_by_kill |
| an error injected there (ENOSPC, EIO, EDQUOT, EACCES, EMFILE, EINTR) | $errors | 0 | 0 |
| SIGINT, SIGTERM, SIGHUP, SIGQUIT: at its calls, and at random times of a bake | $signals | 0 | 0 |
| bakes by eight writers to one path, read $reads times meanwhile | $writes | 0 | 0 |

A full disk was $full.
C
