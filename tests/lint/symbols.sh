#!/bin/bash
# SPDX-License-Identifier: AGPL-3.0-or-later
# The plugin exports exactly one symbol.
set -euo pipefail
cd "$(dirname "$0")/../.."
exported=$(nm --dynamic --defined-only --format=posix build/lib/povray-3.7/deepshadow.so | cut -d' ' -f1)
[ "$exported" = dsm_api ] || { echo "deepshadow.so exports: $exported"; exit 1; }
