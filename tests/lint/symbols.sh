#!/bin/bash
# SPDX-License-Identifier: AGPL-3.0-or-later
# Each library exports exactly one symbol.
set -euo pipefail
cd "$(dirname "$0")/../../build/lib/povray-3.7"
failed=0
only() {
  local exported
  exported=$(nm --dynamic --defined-only --format=posix "$1" | cut -d' ' -f1)
  [ "$exported" = "$2" ] || { echo "$1 exports: $exported"; failed=1; }
}
only deepshadow.so dsm_api
only deepshadow_files.so deep_exr_table
exit $failed
