#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Runs the long tests: scripts/nightly.sh [OPTION]… [JOB|nightly|weekly]…, by default the group nightly. tests/README.md
# describes the jobs; tests/long/jobs.sh contains them. A job that fails does not stop the others. Prints one line per job:
# name, state, seconds and figures. Exits with 1 if a job failed.
#
#   --list        Prints the jobs: name, group and minutes on two cores
#   --shard I/N   Runs part I of N, one part per machine; the parts take about the same time
#   --resume      Skips jobs that already passed for this commit; local changes disable it
#   --out DIR     Folder of logs and results (default: out/nightly/COMMIT)
set -euo pipefail
cd "$(dirname "$0")/.."

fail() {
    echo "nightly.sh: $*" >&2
    exit 2
}

out= shard=1/1 resume=0 wanted=()
while [ $# -gt 0 ]; do
    case $1 in
        --list)
            tests/long/jobs.sh
            exit
            ;;
        --shard | --out)
            [ $# -ge 2 ] || fail "$1 needs a value"
            declare "${1#--}=$2"
            shift
            ;;
        --resume) resume=1 ;;
        -*) fail "unknown option '$1'; use --list, --shard I/N, --resume or --out DIR" ;;
        *) wanted+=("$1") ;;
    esac
    shift
done
[[ $shard =~ ^([1-9][0-9]?)/([1-9][0-9]?)$ ]] && [ "${BASH_REMATCH[1]}" -le "${BASH_REMATCH[2]}" ] ||
    fail "--shard is '$shard'; give I/N, such as 2/3"
[ ${#wanted[@]} -gt 0 ] || wanted=(nightly)

all=$(tests/long/jobs.sh)
chosen=()
for word in "${wanted[@]}"; do
    mapfile -t found < <(awk -v word="$word" '$1 == word || $2 == word { print $1 }' <<<"$all")
    [ ${#found[@]} -gt 0 ] || fail "unknown job '$word'; choose from: nightly weekly $(awk '{ print $1 }' <<<"$all" | paste -sd' ')"
    chosen+=("${found[@]}")
done
# Assigns the longest job first, each to the part with the fewest minutes. Each part runs its jobs in the order of the list.
mapfile -t mine < <(
    awk -v list="${chosen[*]}" 'BEGIN { split(list, names, " "); for (i in names) chosen[names[i]] }
        $1 in chosen { print $3, NR, $1 }' <<<"$all" | sort -k1,1nr -k2,2n |
        awk -v part="${shard%/*}" -v parts="${shard#*/}" '{
            least = 1
            for (i = 2; i <= parts; i++) if (sum[i] + 0 < sum[least] + 0) least = i
            sum[least] += $1
            if (least == part) print $2, $3
        }' | sort -n | cut -d' ' -f2
)

commit=$(git rev-parse --short=12 HEAD)
if ! git diff --quiet HEAD; then
    commit+=-changed
    [ $resume = 0 ] || echo "nightly.sh: --resume is ignored: the sources have local changes" >&2
    resume=0
fi
out=$(realpath -m "${out:-out/nightly/$commit}")
mkdir -p "$out"
scripts/setup.sh

failed=0
for name in "${mine[@]}"; do
    if [ $resume = 1 ] && grep -qsE "^$name +passed" "$out/$name.result"; then
        echo "$(cat "$out/$name.result") (before)"
        continue
    fi
    begun=$SECONDS state=passed
    tests/long/jobs.sh "$name" >"$out/$name.log" 2>&1 </dev/null || state=FAILED
    figures=$(sed -n "s/^$name: //p" "$out/$name.log" | paste -sd';' | sed 's/;/; /g')
    printf '%-12s %s %6d s  %s\n' "$name" "$state" $((SECONDS - begun)) "$figures" | tee "$out/$name.result"
    [ $state = passed ] || {
        failed=1
        tail -n 40 "$out/$name.log" >&2
        echo "nightly.sh: full log of $name: $out/$name.log" >&2
    }
done
exit $failed
