#!/bin/bash
# SPDX-License-Identifier: AGPL-3.0-or-later
# Lokovic & Veach's figures 6 to 9 alone, as the report measures them (tests/report/plan_papers.sh), as text with tabs.
#
#   tests/bench/figures.sh [6] [7] [8] [9]        all; "7" with its row of 64 x 64 rays a pixel takes a quarter of an hour
#
# FORM=short or smoke: smaller. RUNS=N: as in the report. What is measured counts for the report, too.
set -eu
export DEEP_SHADOW_CHOICE=map  # what is measured are maps, also where rays would cost less
top=$(cd "$(dirname "$0")/../.." && pwd)
: "${FORM:=full}" "${REPORT:=$top/build/report}"
export REPORT
figures=("${@:-6 7 8 9}")
read -ra figures <<<"${figures[*]}"
# lv/ is the picture without shadows, which all times refer to
"$top/tests/report/run.sh" "$FORM" lv/ "${figures[@]/#/lv}"
for figure in "${figures[@]}"; do
  printf '\nFigure %s\n' "$figure"
  awk -f "$top/tests/report/common.awk" -v table="lv$figure" -f "$top/tests/report/papers.awk" "$REPORT/report.csv" |
    sed -E 's:</t[dh]><t[dh]>:\t:g; s/<[^>]*>//g; s/&#178;/^2/g; s/&#215;/x/g; s/N1/N^1/'
done
