/* SPDX-License-Identifier: AGPL-3.0-or-later */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "core/vertices.h"
#include "random.h"

static void push(vertices *list, double z, double v) {
  assert_int_equal(vertices_push(list, z, rgb_grey(v)), DSM_OK);
}
static double at(const vertices *list, double z) { return vertices_at(list->data, list->count, z).c[1]; }

static void nothing_is_all_lit(void **state) {
  (void)state;
  vertices list = {0};
  assert_true(at(&list, -1) == 1);
  assert_true(at(&list, 1e7) == 1);
  vertices_free(&list);
}

static void step_has_its_front_value(void **state) {
  (void)state;
  vertices list = {0};
  push(&list, 2, 1);
  push(&list, 2, 0.25);
  push(&list, 4, 0.25);
  push(&list, 4, 0.125);
  push(&list, 4, 0);
  assert_true(at(&list, 1) == 1 && at(&list, 2) == 1);
  assert_true(at(&list, nextafter(2, 3)) == 0.25 && at(&list, 3) == 0.25 && at(&list, 4) == 0.25);
  assert_true(at(&list, nextafter(4, 5)) == 0 && at(&list, HUGE_VAL) == 0);
  vertices_free(&list);
}

static void first_vertex_below_one_is_a_step(void **state) {
  (void)state;
  vertices list = {0};
  push(&list, 2, 0.5);
  assert_true(at(&list, 1) == 1 && at(&list, 2) == 1 && at(&list, 2.5) == 0.5);
  vertices_free(&list);
}

static void linear_between_vertices(void **state) {
  (void)state;
  vertices list = {0};
  push(&list, 1, 1);
  assert_int_equal(vertices_push(&list, 3, (rgb){{0, 0.5, 1}}), DSM_OK);
  rgb v = vertices_at(list.data, list.count, 1.5);
  assert_true(v.c[0] == 0.75 && v.c[1] == 0.875 && v.c[2] == 1);
  vertices_free(&list);
}

/* Against a scan of the definition, on coarse depths so that many coincide. */
static void random_functions_match_a_scan(void **state) {
  (void)state;
  for (uint64_t seed = 0; seed < most_cases(2000); ++seed) {
    rng r = rng_seeded(seed);
    vertices list = {0};
    double z = 0;
    for (uint32_t n = rng_below(&r, 30); n-- > 0;) {
      z += rng_below(&r, 3);
      push(&list, z, list.count ? rng_unit(&r) : 1);
    }
    for (double x = -0.75; x < z + 2; x += 0.25) {
      double expected = list.count && list.data[list.count - 1].z < x ? list.data[list.count - 1].v.c[1] : 1;
      for (size_t i = 0; i < list.count; ++i) {
        const vertex *b = &list.data[i], *a = i ? b - 1 : b;
        if (b->z < x) continue;
        if (i && b->z == x) expected = b->v.c[1];
        else if (i) expected = a->v.c[1] + (b->v.c[1] - a->v.c[1]) * (x - a->z) / (b->z - a->z);
        break;
      }
      assert_seeded(&r, fabs(at(&list, x) - expected) < 1e-14);
    }
    vertices_free(&list);
  }
}

static void grows_and_is_used_again(void **state) {
  (void)state;
  vertices list = {0};
  for (int round = 0; round < 2; ++round) {
    for (int i = 0; i < 100000; ++i) push(&list, i, 1.0 / (1 + i));
    assert_int_equal(list.count, 100000);
    for (int i = 0; i < 100000; i += 7777)
      assert_true(list.data[i].z == i && list.data[i].v.c[2] == 1.0 / (1 + i));
    vertices_free(&list);
    assert_true(list.data == NULL && list.count == 0 && list.capacity == 0);
  }
}

static void refuses_what_memory_cannot_hold(void **state) {
  (void)state;
  size_t full = SIZE_MAX / sizeof(vertex);
  vertices list = {NULL, full, full};
  assert_int_equal(vertices_push(&list, 1, rgb_grey(1)), DSM_NO_MEMORY);
  assert_true(list.data == NULL && list.count == full && list.capacity == full);
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(nothing_is_all_lit),
    cmocka_unit_test(step_has_its_front_value),
    cmocka_unit_test(first_vertex_below_one_is_a_step),
    cmocka_unit_test(linear_between_vertices),
    cmocka_unit_test(random_functions_match_a_scan),
    cmocka_unit_test(grows_and_is_used_again),
    cmocka_unit_test(refuses_what_memory_cannot_hold),
  };
  return cmocka_run_group_tests_name("vertices", tests, NULL, NULL);
}
