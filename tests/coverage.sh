#!/bin/bash
# SPDX-License-Identifier: AGPL-3.0-or-later
# tests/coverage.sh: how many branches of plugin/core and plugin/map the unit and oracle tests reach, a line a file (Debian package gcovr).
# What is left out and why: tests/coverage.md. Fails if a test does, or if less than 95 % is reached.
#
# Without asserts (NDEBUG): an assert's other branch ends the program. Hardly optimised, so that branches are those of the source. The image
# tests run an optimised program and add nothing here. Counters are plain, as atomic ones take three times as long; threads lose counts to each
# other, and where gcov makes a negative number of that, gcovr leaves out the branch (some three).
set -euo pipefail
top=$(cd "$(dirname "$0")/.." && pwd)
command -v gcovr >/dev/null || { echo "coverage.sh needs gcovr (Debian: gcovr)" >&2; exit 1; }
least=95

# What the tree no longer has is not to be counted.
cd "$top"
mkdir -p build/coverage/plugin/core build/coverage/plugin/map
find build/coverage/plugin/core build/coverage/plugin/map -name '*.[ch]' -o -name '*.gcno' | while read -r file; do
  source=${file#build/coverage/}
  source=${source/\/.libs\//\/}
  [ -e "${source%.gcno}" ] || [ -e "${source%.gcno}.c" ] || rm "$file"
done

"$top/tests/sanitize/build.sh" coverage '-O1 -g --coverage -fprofile-update=single -DNDEBUG'
cd "$top/build/coverage"
find . -name '*.gcda' -delete
tests=$(find tests/unit tests/oracle -name '*_test.c' | sed 's/\.c$//' | tr '\n' ' ')
failed=0
DSM_CASES=${DSM_CASES-500} make -s "-j$(nproc)" check-TESTS TESTS="$tests" >check.log 2>&1 || failed=1

gcovr --root . --filter 'plugin/(core|map)/' --branches --gcov-ignore-parse-errors --fail-under-branch "$least" plugin 2>gcovr.log || {
  [ $? -eq 4 ] || { tail gcovr.log >&2; exit 1; }
  echo "coverage.sh: less than $least % of the branches are reached" >&2
  failed=1
}
if grep '^FAIL' check.log; then echo "coverage.sh: these tests have failed" >&2; fi
exit $failed
