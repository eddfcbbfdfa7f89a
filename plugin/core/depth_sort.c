/* SPDX-License-Identifier: AGPL-3.0-or-later */
#include "core/depth_sort.h"

#include <string.h>

enum { SHORT = 8 };   /* faster by insertion */

static void insert(depth_key *keys, size_t count)
{
  for (size_t i = 1; i < count; i++) {
    depth_key key = keys[i];
    size_t to = i;
    for (; to > 0 && keys[to - 1].z > key.z; to--)
      keys[to] = keys[to - 1];
    keys[to] = key;
  }
}

void depth_sort(depth_key *keys, size_t count, depth_key *scratch)
{
  if (count <= SHORT) {
    insert(keys, count);
    return;
  }
  size_t half = count / 2;
  depth_sort(keys, half, scratch);
  depth_sort(keys + half, count - half, scratch);
  if (keys[half - 1].z <= keys[half].z)
    return;

  memcpy(scratch, keys, half * sizeof *keys);
  const depth_key *left = scratch, *left_end = scratch + half, *right = keys + half, *right_end = keys + count;
  while (left < left_end && right < right_end) {
    int later = right->z < left->z;   /* no branch: which of two depths is less is anybody's guess */
    *keys++ = *(later ? right : left);
    right += later;
    left += !later;
  }
  memcpy(keys, left, (size_t)(left_end - left) * sizeof *keys);   /* the right rest is in place */
}
