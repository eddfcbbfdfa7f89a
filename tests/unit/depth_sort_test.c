/* SPDX-License-Identifier: AGPL-3.0-or-later */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <cmocka.h>

#include "core/depth_sort.h"
#include "random.h"

/* In order, a permutation, and equal depths as they came; whatever is sorted already, reversed, or all alike. */
static void keys_come_out_in_order_and_stable(void **state) {
  (void)state;
  for (uint64_t seed = 0; seed < most_cases(3000); ++seed) {
    rng r = rng_seeded(seed);
    uint32_t count = rng_below(&r, seed % 100 ? 70 : 3000), kinds = 1 + rng_below(&r, 2 * count + 1), kind = rng_below(&r, 4);
    depth_key *keys = malloc((2 * count + 1) * sizeof *keys);
    unsigned char *seen = calloc(count + 1, 1);
    for (uint32_t i = 0; i < count; ++i)
      keys[i] = (depth_key){kind == 0 ? i : kind == 1 ? -(double)i : kind == 2 ? rng_unit(&r) : rng_below(&r, kinds), i};
    depth_sort(keys, count, keys + count);
    for (uint32_t i = 0; i < count; ++i) {
      assert_seeded(&r, keys[i].index < count && !seen[keys[i].index]);
      seen[keys[i].index] = 1;
      if (i == 0) continue;
      assert_seeded(&r, keys[i - 1].z <= keys[i].z);
      assert_seeded(&r, keys[i - 1].z < keys[i].z || keys[i - 1].index < keys[i].index);
    }
    free(keys);
    free(seen);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(keys_come_out_in_order_and_stable),
  };
  return cmocka_run_group_tests_name("depth_sort", tests, NULL, NULL);
}
