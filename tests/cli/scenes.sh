# SPDX-License-Identifier: Apache-2.0
# Scenes at random within all ranges, forty by default: no particle's number is none, or a line says why.
. "$(dirname "$0")/lib.sh"

"$relief" bake "$bunny" -o bunny.relief --budget 100kB -q
python3 -B "$RELIEF_SOURCE/tests/cli/scenes.py" "$relief_sim" bunny.relief "${RELIEF_SCENES:-40}"
