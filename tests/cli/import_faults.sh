# SPDX-License-Identifier: Apache-2.0
# Kills the import worker and injects errors at its system calls, and at those of its parent. Either the collider is the
# same, or one line gives the system's error and a fix, and the existing file is kept. No other file is left.
#   RELIEF_FAULTS_ALL=1  tests every call, not every ninth of the dynamic loader
. "$(dirname "$0")/lib.sh"

command -v strace >/dev/null || die "strace is missing; run scripts/setup.sh"
strace -o probe.trace true 2>probe.err ||
    die "strace cannot trace here (ptrace is not permitted), so nothing can be tested: $(head -1 probe.err)"
mkdir out bin
cat >mesh.obj <<'M'
mtllib mesh.mtl
v 0 0 0
v 1 0 0
v 0 1 0
v 0 0 1
f 1 3 2
f 1 2 4
f 1 4 3
f 2 3 4
M
echo 'newmtl m' >mesh.mtl

# relief runs the worker in its own folder: here a script that starts it under strace with $INJECT.
cp "$relief" bin/relief
cp "$RELIEF_BIN/relief-import" bin/traced
cat >bin/relief-import <<'W'
#!/usr/bin/env bash
# shellcheck disable=SC2086
exec strace -f -o "$TRACE" ${INJECT:+-e "inject=$INJECT"} "${BASH_SOURCE%/*}/traced" "$@"
W
chmod +x bin/relief-import
export TRACE="$work/trace" INJECT=
bake=(mesh.obj --map fixed8:size=4 -j 1 -q -o)
"$relief" bake "${bake[@]}" new.relief
"$relief" bake "${bake[@]}" old.relief --map fixed8:size=8
! cmp -s old.relief new.relief || die "the old and the new file are equal"
cp old.relief out/a.relief
bin/relief bake "${bake[@]}" out/a.relief
cmp out/a.relief new.relief || die "a traced worker gives a different file"

# The worker's calls as "SYSCALL N PART". N counts per thread, as strace's when= does. Calls that two threads make with
# equal N are listed once, as the first thread's. PART is `loader` for the dynamic loader or `own`.
python3 - "$([ -n "${RELIEF_FAULTS_ALL:-}" ] && echo 1 || echo 9)" >calls <<'P'
import re, sys
step = int(sys.argv[1])
seen, listed, own = {}, set(), False
for line in open('trace'):
    match = re.match(r'(\d+) +(\w+)\(', line)
    if not match:
        continue
    key = match[1], match[2]
    seen[key] = seen.get(key, 0) + 1
    # The worker's first own call accesses the mesh.
    own = own or (match[2] in ('fstat', 'newfstatat') and line.split('(')[1].startswith('3,') and 'memfd' not in line and
                  'st_size=%d,' % __import__('os').path.getsize('mesh.obj') in line)
    call = match[2], seen[key]
    if call in listed:
        continue
    listed.add(call)
    if own or call[1] % step == 0:
        print(*call, 'own' if own else 'loader')
P
for name in mmap prctl prlimit64 landlock_restrict_self seccomp openat2 fallocate ftruncate fcntl exit_group; do
    grep -q "^$name .* own$" calls || die "the trace of the worker shows no $name: $(cat calls)"
done
grep -q 'loader$' calls || die "the trace shows no call of the dynamic loader"

# expect_complete WHAT: the bake leaves exactly one complete file.
expect_complete() {
    [ "$(ls -A out)" = a.relief ] || die "$1 leaves $(ls -A out)"
    [ ! -e /proc/"$(head -1 trace | cut -d' ' -f1)" ] || die "$1 leaves a worker"
    if [ "$code" -eq 0 ]; then
        cmp -s out/a.relief new.relief || die "$1: success with a different collider"
    else
        cmp -s out/a.relief old.relief || die "$1: exit code $code, and the old file is gone"
        [ "$(wc -l <stderr)" -eq 1 ] && grep -q "^relief: error: .*'mesh\.obj'.*;" stderr || die "$1 is not named: $(cat stderr)"
    fi
}

kills=0 errors=0 endured=0
while read -r name number _; do
    cp old.relief out/a.relief
    code=0
    { INJECT="$name:signal=KILL:when=$number" bin/relief bake "${bake[@]}" out/a.relief 2>stderr; } 2>/dev/null || code=$?
    expect_complete "SIGKILL of the worker at $name $number"
    [ "$code" -eq 4 ] && grep -q 'SIGKILL' stderr || die "SIGKILL of the worker at $name $number: $code, $(cat stderr)"
    kills=$((kills + 1))
done < <(grep -v '^execve' calls)

: >reported
while read -r name number part; do
    case $name in # brk fails by returning the old end, which strace cannot inject
        openat | openat2) list='EMFILE ENFILE EACCES' ;;
        mmap | mremap) list='ENOMEM EAGAIN' ;;
        mprotect) list='ENOMEM' ;;
        read | pread64) list='EIO' ;;
        fallocate) list='ENOSPC ENOMEM EINTR' ;;
        ftruncate) list='EIO ENOSPC' ;;
        fcntl) list='EBUSY EPERM' ;;
        clone | clone3) list='EAGAIN ENOMEM' ;;
        landlock_restrict_self | landlock_add_rule) list='E2BIG' ;;
        seccomp) list='ENOMEM' ;;
        prctl | prlimit64) list='EPERM' ;;
        *) list='' ;;
    esac
    for errno in $list; do
        cp old.relief out/a.relief
        code=0
        # Replaces the call with one that the sandbox allows.
        INJECT="$name:error=$errno:syscall=getpid:when=$number" bin/relief bake "${bake[@]}" out/a.relief 2>stderr || code=$?
        grep -q INJECTED trace || continue # the call was made fewer times in this run
        expect_complete "$errno at the worker's $name $number"
        errors=$((errors + 1))
        case $code in
            0) endured=$((endured + 1)) ;;
            2 | 4 | 6) echo "$name $errno $part $(cat stderr)" >>reported ;;
            *) die "$errno at the worker's $name $number: exit code $code: $(cat stderr)" ;;
        esac
    done
done <calls
# Interrupted calls are repeated. Errors are named, also those of the loader.
! grep -q '^fallocate EINTR own' reported || die "an interrupted call is an error: $(grep '^fallocate EINTR' reported)"
for what in 'mmap ENOMEM loader.*libraries cannot be loaded.*ulimit -n' 'fallocate ENOSPC own.*No space left' \
    'ftruncate EIO own.*could not continue .*Input/output error' 'prlimit64 EPERM own.*cannot (limit|lower).*Operation not permitted' \
    'seccomp ENOMEM own.*system calls.*Cannot allocate' 'landlock_restrict_self E2BIG own.*enter Landlock'; do
    grep -qE "^$what" reported || die "not reported: $what: $(cut -c1-200 reported)"
done

# --- the parent ---

# inject_parent WANTED PATTERN INJECTION…: injects into the parent's calls; the worker is not traced.
inject_parent() {
    local wanted=$1 pattern=$2 code=0 options=()
    shift 2
    for injection in "$@"; do options+=(-e "inject=$injection"); done
    cp old.relief out/a.relief
    strace -o trace "${options[@]}" "$relief" bake "${bake[@]}" out/a.relief 2>stderr || code=$?
    grep -q INJECTED trace || die "$* was not injected"
    errors=$((errors + 1))
    expect_complete "$*"
    [ "$code" -eq "$wanted" ] && { [ "$wanted" -eq 0 ] || grep -qE "$pattern" stderr; } || die "$*: exit code $code: $(cat stderr)"
    [ "$code" -ne 0 ] || endured=$((endured + 1))
}
# Interrupted calls are repeated.
for injection in fallocate:error=EINTR poll:error=ENOMEM poll:error=EINTR; do
    grep -q "^${injection%%:*}(" trace 2>/dev/null || strace -o trace "$relief" bake "${bake[@]}" out/a.relief
    grep -q "^${injection%%:*}(" trace || continue
    inject_parent 0 '' "$injection:when=1"
done
# Shortages are named.
strace -o trace "$relief" bake "${bake[@]}" out/a.relief
clone=$(grep -oE '^(clone3|clone|vfork)' trace | head -1)
inject_parent 4 'importer could not be started \(Resource temporarily unavailable\); .*end processes.*ulimit.*-u' \
    "$clone:error=EAGAIN"
inject_parent 4 'importer could not be started \(Cannot allocate memory\); .*free memory' "$clone:error=ENOMEM"
inject_parent 4 'importer could not be started \(Too many open files\); close files.*ulimit -n' memfd_create:error=EMFILE
inject_parent 4 'importer could not be started \(Too many open files in system\); close files' memfd_create:error=ENFILE
inject_parent 4 'importer could not be started \(No space left on device\); .*free memory' fallocate:error=ENOSPC

# Few descriptors, without a tracer, which needs some itself.
few=0
for ((limit = 4; limit < 200; ++limit)); do
    cp old.relief out/a.relief
    code=0
    (ulimit -n "$limit" && exec "$relief" bake "${bake[@]}" out/a.relief) 2>stderr || code=$?
    [ "$code" -ne 0 ] || break
    # The parent's own loader prints its own messages.
    ! grep -q 'error while loading shared libraries' stderr || continue
    expect_complete "$limit descriptors"
    grep -q 'ulimit -n' stderr || die "$limit descriptors: $(cat stderr)"
    few=$((few + 1))
done
[ "$code" -eq 0 ] && [ "$few" -ge 3 ] || die "with $limit descriptors: $code, $few rejected: $(cat stderr)"
cmp out/a.relief new.relief || die "few descriptors give a different file"
# Few processes, as an unprivileged user: root has no limit.
if setpriv --reuid=65534 --regid=65534 --clear-groups true 2>/dev/null; then
    chmod -R a+rwX .
    chmod a+x "$work"
    cp old.relief out/a.relief
    code=0
    setpriv --reuid=65534 --regid=65534 --clear-groups bash -c 'ulimit -u 0 && exec "$@"' - \
        "$relief" bake "${bake[@]}" out/a.relief 2>stderr || code=$?
    [ "$code" -eq 4 ] && grep -q 'ulimit.*-u' stderr || die "no processes: exit code $code: $(cat stderr)"
fi

# A worker that returns a false image: one line.
python3 "$RELIEF_SOURCE/tests/cli/heights.py" hills.png 33
cat >bin/relief-import <<'W'
#!/usr/bin/env bash
printf '\1' >&6
cat "$ANSWER" >&5
W
image_size() { # COLUMNS ROWS MOST
    python3 -c 'import struct, sys; sys.stdout.buffer.write(struct.pack("<IQQQ", 0, *map(int, sys.argv[1:])))' "$@"
}
rejects_answer() { # CODE PATTERN
    ANSWER=answer expect_error "$1" "'hills\.png': $2" bin/relief bake hills.png --heights low=0,high=9 -o x.relief
}
: >answer
rejects_answer 4 'the importer returned no result'
image_size 33 33 65535 | head -c 20 >answer
rejects_answer 4 'the importer returned no result'
image_size 33 33 7 >answer
rejects_answer 3 'the importer returned an invalid image size'
image_size 1099511627776 33 65535 >answer
rejects_answer 6 'it has 1099511627776x33 samples'
{ image_size 33 33 255 && head -c 1000 /dev/zero; } >answer
rejects_answer 4 'the importer returned no result'
printf '\x63\0\0\0\0\0\0\0' >answer
rejects_answer 3 'the importer returned an unknown error'
printf '\x03\0\0\0\xff\xff\xff\xff boom' >answer
rejects_answer 4 'the importer returned no result'
printf '\x03\0\0\0\x06\0\0\0a\nb\x1bcd' >answer
rejects_answer 3 'a.b.*cd$'

cat <<C
| what | times | another collider, a torn file or a process left |
| --- | ---: | ---: |
| SIGKILL of the import worker at its system calls | $kills | 0 |
| an error injected there, and where its parent starts it (EMFILE, ENFILE, ENOMEM, EAGAIN, EIO, ENOSPC, EBUSY, EINTR, …) | $errors, of which $endured did not matter | 0 |
| too few descriptors | $few | 0 |
C
