# SPDX-License-Identifier: Apache-2.0
# Threads, locale, time zone, folder, umask and processor do not change the bytes.
. "$(dirname "$0")/lib.sh"
"$RELIEF_SOURCE/tests/long/determinism.sh" --quick
