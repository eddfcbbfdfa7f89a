/* SPDX-License-Identifier: AGPL-3.0-or-later */
/* Numbers that look random and are not: a hash of what they are for. */
#ifndef DSM_CORE_HASH_H
#define DSM_CORE_HASH_H

#include <stdint.h>

/* The finaliser of splitmix64: every bit of the result depends on every bit of x. 0 gives 0. */
static inline uint64_t hash_mix(uint64_t x)
{
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
  return x ^ (x >> 31);
}

#endif
