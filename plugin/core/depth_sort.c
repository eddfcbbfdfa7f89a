/* SPDX-License-Identifier: AGPL-3.0-or-later */
#include "core/depth_sort.h"

#include <string.h>

enum { SHORT = 8 };

/* A short row: counts for each key those that belong in front of it. No branch asks which of two depths is less, as that is anybody's guess. */
static void sort_short(depth_key *keys, size_t count, depth_key *scratch)
{
  uint32_t place[SHORT] = {0};
  int in_order = 1;
  for (size_t i = 1; i < count; i++)
    in_order &= keys[i - 1].z <= keys[i].z;
  if (in_order)
    return;
  memcpy(scratch, keys, count * sizeof *keys);
  for (uint32_t i = 0; i < count; i++) {
    uint32_t behind = 0;
    for (uint32_t k = 0; k < i; k++) {
      uint32_t is_behind = scratch[i].z < scratch[k].z;
      place[k] += is_behind;
      behind += is_behind;
    }
    place[i] = i - behind;
  }
  for (size_t i = 0; i < count; i++)
    keys[place[i]] = scratch[i];
}

/* One or the other, with no branch whatever the compiler thinks of it. */
static size_t chosen(size_t one, size_t other, size_t is_other)
{
  return one ^ ((one ^ other) & -is_other);
}

/* Merges two rows, the second of which is as long as the first or by one longer, from both ends at once: a step waits for the one before it,
 * but not for those at the other end. None runs out of either row, as half of all keys are not more than one has. */
static void merge(depth_key *keys, size_t half, size_t count, depth_key *scratch)
{
  size_t a = 0, b = half, a_last = half - 1, b_last = count - 1;   /* what is left of each */
  memcpy(scratch, keys, count * sizeof *keys);
  for (size_t i = 0; i < half; i++) {
    size_t from_b = scratch[b].z < scratch[a].z, from_a = scratch[b_last].z < scratch[a_last].z;
    keys[i] = scratch[chosen(a, b, from_b)];
    b += from_b;
    a += !from_b;
    keys[count - 1 - i] = scratch[chosen(b_last, a_last, from_a)];
    a_last -= from_a;
    b_last -= !from_a;
  }
  if (count % 2)
    keys[half] = scratch[a == a_last + 1 ? b : a];
}

void depth_sort(depth_key *keys, size_t count, depth_key *scratch)
{
  if (count <= SHORT) {
    sort_short(keys, count, scratch);
    return;
  }
  size_t half = count / 2;
  depth_sort(keys, half, scratch);
  depth_sort(keys + half, count - half, scratch);
  if (keys[half - 1].z > keys[half].z)
    merge(keys, half, count, scratch);
}
