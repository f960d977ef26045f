#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Bunny in the snow: bakes the Stanford bunny, simulates snow on it, and writes a contact sheet of frames and slices to
# out/samples/bunny_in_the_snow/contact_sheet.png. Needs no GPU and no window.
cat <<'T'
Installs missing packages, compiles relief and relief-sim, bakes the Stanford bunny, and simulates snow. This takes about
4 minutes on two cores, plus the download of packages; a second run takes half a minute.
T
RELIEF_QUIET=1 exec "$(dirname "$0")/samples.sh" bunny_in_the_snow
