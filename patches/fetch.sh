#!/bin/bash
# SPDX-License-Identifier: AGPL-3.0-or-later
# patches/fetch.sh DIR: fetches POV-Ray's pinned Debian source package into DIR with apt, through an apt
# configuration of its own. The machine's lists and settings stay as they are; root is not needed.
set -euo pipefail
version=1:3.7.0.10-2
suite=bookworm
dir=$(cd "$1" && pwd)

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir -p "$work"/{parts,candidates,lists/partial,cache/archives/partial}

# Each of the machine's own package sources that serves Debian 12's main becomes a candidate, with its mirror, its
# keys and its options; only the type changes. They are tried one by one, as not every mirror has sources.
candidate() { echo "$work/candidates/$(printf %03d "$(find "$work/candidates" -type f | wc -l)")$1"; }

# deb [ option=value ... ] URI SUITE COMPONENT...
from_list() {
  local entry='^[[:space:]]*deb(-src)?[[:space:]]+(\[[^]]*\][[:space:]]+)?([^[:space:]]+)[[:space:]]+([^[:space:]]+)[[:space:]]+(.*)$'
  local line options
  while read -r line || [ -n "$line" ]; do
    line=${line%%#*}
    [[ $line =~ $entry ]] || continue
    [ "${BASH_REMATCH[4]}" = $suite ] || continue
    [[ " ${BASH_REMATCH[5]} " == *' main '* ]] || continue
    options=$(sed -E 's/\barch[+-]?=[^] ]*//' <<<"${BASH_REMATCH[2]}")
    echo "deb-src $options ${BASH_REMATCH[3]} $suite main" >"$(candidate .list)"
  done <"$1"
}

# Stanzas of `Field: value`, where lines that begin with a space continue a field (a key block, for example).
from_sources() {
  local stanza fields
  while IFS= read -r -d '' stanza; do
    fields=$(sed -e ':more' -e 'N' -e '$!b more' -e 's/\n[[:space:]]/ /g' <<<"$stanza")
    grep -qiE '^Enabled:[[:space:]]*(no|false|0)' <<<"$fields" && continue
    grep -qiE "^Suites:(.*[[:space:]])?$suite([[:space:]]|\$)" <<<"$fields" || continue
    grep -qiE '^Components:(.*[[:space:]])?main([[:space:]]|$)' <<<"$fields" || continue
    {
      echo "Types: deb-src"
      echo "Suites: $suite"
      echo "Components: main"
      awk 'tolower($0) ~ /^(types|suites|components|architectures|enabled):/ { skip = 1; next }
           /^[^[:space:]]/ { skip = 0 }
           !skip' <<<"$stanza"
    } >"$(candidate .sources)"
  done < <(sed -e '/^#/d' "$1" | awk -v RS= -v ORS='\0' 1)
}

for file in /etc/apt/sources.list /etc/apt/sources.list.d/*.list; do
  if [ -f "$file" ]; then from_list "$file"; fi
done
for file in /etc/apt/sources.list.d/*.sources; do
  if [ -f "$file" ]; then from_sources "$file"; fi
done

# The sandbox user could not write into a private folder; the checksum is what we trust.
settings=(
  -o Dir::Etc::sourcelist=/dev/null -o Dir::Etc::sourceparts="$work/parts"
  -o Dir::State::lists="$work/lists" -o Dir::Cache="$work/cache"
  -o APT::Sandbox::User="$(id -un)" -o Acquire::Retries=3 -o Acquire::Languages=none
)
for file in "$work"/candidates/*; do
  [ -f "$file" ] || break
  rm -f "$work"/parts/*
  cp "$file" "$work/parts/povray.${file##*.}"
  if apt-get --quiet --quiet "${settings[@]}" update &&
    (cd "$dir" && apt-get --quiet --quiet "${settings[@]}" source --download-only "povray=$version"); then
    exit 0
  fi
done
exit 1
