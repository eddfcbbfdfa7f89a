#!/bin/bash
# SPDX-License-Identifier: AGPL-3.0-or-later
# tests/coverage.sh: how many branches of plugin/core and plugin/map the unit and oracle tests reach, a line a file (Debian package gcovr).
# What is left out and why: tests/coverage.md.
#
# Without optimisation, and without asserts (NDEBUG): an assert's other branch ends the program. The image tests run an optimised program
# and add nothing here.
set -euo pipefail
top=$(cd "$(dirname "$0")/.." && pwd)
command -v gcovr >/dev/null || { echo "coverage.sh needs gcovr (Debian: gcovr)" >&2; exit 1; }

"$top/tests/sanitize/build.sh" coverage '-O0 -g --coverage -DNDEBUG'
cd "$top/build/coverage"
find . -name '*.gcda' -delete
tests=$(find tests/unit tests/oracle -name '*_test.c' | sed 's/\.c$//' | tr '\n' ' ')
DSM_CASES=${DSM_CASES-500} make -s "-j$(nproc)" check-TESTS TESTS="$tests" >check.log 2>&1 ||
  { grep '^FAIL' check.log; echo "coverage.sh: these tests have failed" >&2; }

gcovr --root . --filter 'plugin/(core|map)/' --branches plugin
