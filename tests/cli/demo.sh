# SPDX-License-Identifier: Apache-2.0
# scripts/demo.sh with built tools prints its duration first and at most 20 lines in all. It creates a picture, and
# the files used by the commands in README.md.
. "$(dirname "$0")/lib.sh"

mkdir demo
cp -r "$RELIEF_SOURCE/scripts" "$RELIEF_SOURCE/samples" demo/
printf '#!/bin/sh\n' >demo/scripts/setup.sh
printf '#!/bin/sh\necho "%s"\n' "$RELIEF_BIN" >demo/scripts/build.sh
demo/scripts/demo.sh >log 2>&1 || die "the demo fails: $(cat log)"
[ "$(wc -l <log)" -le 20 ] && head -2 log | grep -q 'minutes on two cores' || die "the demo prints: $(cat log)"
grep -q 'wrong near the surface: ' log || die "the demo prints no verdict: $(cat log)"
[ -s demo/out/samples/bunny_in_the_snow/contact_sheet.png ] || die "the demo creates no picture"
sed -n '/^After the demo/,/^With your own files/s/^    \(relief.*[^ ]\)  *#.*/\1/p' "$RELIEF_SOURCE/README.md" >commands
[ "$(wc -l <commands)" -ge 5 ] || die "README.md has $(wc -l <commands) commands for the demo's files"
while read -r line; do
    (cd demo/out/samples/bunny_in_the_snow && PATH=$RELIEF_BIN:$PATH bash -euc "$line") >said 2>&1 </dev/null || die "$line: $(tail -5 said)"
done <commands
