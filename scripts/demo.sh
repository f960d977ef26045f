#!/usr/bin/env bash
# "Bunny in the snow": bakes the Stanford bunny, lets snow fall on it without a window, and leaves a contact sheet of frames
# and slices, out/samples/bunny_in_the_snow/contact_sheet.png. Needs no GPU.
exec "$(dirname "$0")/samples.sh" bunny_in_the_snow
