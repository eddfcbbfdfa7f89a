/* SPDX-License-Identifier: AGPL-3.0-or-later */
/*
 * Transmittance, sweep, compressors and look-up on random cases against long doubles, and what must hold of every visibility
 * function: it starts at 1, stays in [0,1], never grows, and is within the tolerance at every depth.
 *
 *   DSM_CASES=1000000 DSM_SEED=1 tests/unit/random_cases_test     a million of each, two minutes on a quiet machine
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <cmocka.h>

#include "core/compress.h"
#include "core/transmittance.h"
#include "long_double.h"
#include "map/lookup.h"
#include "map/pack_tile.h"
#include "map/worker.h"
#include "random.h"

enum { MOST = 64 };

static uint64_t number_from(const char *name, uint64_t otherwise) {
  const char *text = getenv(name);
  return text ? strtoull(text, NULL, 10) : otherwise;
}

#define FOR_EACH_CASE(r, few) \
  for (uint64_t case_ = 0, first_ = number_from("DSM_SEED", 1), end_ = number_from("DSM_CASES", few); case_ < end_; ++case_) \
    for (rng r = rng_seeded(first_ + case_), *once_ = &r; once_; once_ = NULL)

/* The depths where a function is looked at: both sides of each that was added, and one between neighbours. */
typedef struct { double z[16 * MOST]; size_t count; } places;

static int by_size(const void *a, const void *b) {
  double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

static void add_place(places *p, double z) {
  if (p->count < sizeof p->z / sizeof *p->z) p->z[p->count++] = z;
}

static void add_vertices(places *p, const vertex *f, size_t count) {
  for (size_t i = 0; i < count; ++i) add_place(p, f[i].z);
}

static void finish_places(places *p, rng *r) {
  size_t n = p->count;
  qsort(p->z, n, sizeof *p->z, by_size);
  for (size_t i = 1; i < n; ++i) add_place(p, p->z[i - 1] + (p->z[i] - p->z[i - 1]) * rng_unit(r));
  if (n) add_place(p, p->z[n - 1] * 2 + 1);
}

/* What holds of every function that the library makes; `falls`: of no input that grows. A first vertex may be the far side of a
 * step from 1. */
static int is_sound(const vertices *f, int falls) {
  for (size_t i = 0; i < f->count; ++i) {
    const vertex *b = &f->data[i];
    if (!isfinite(b->z) || (i && b->z < b[-1].z) || (i > 1 && b->z == b[-2].z)) return 0;
    for (int c = 0; c < 3; ++c) {
      if (!(b->v.c[c] >= 0 && b->v.c[c] <= 1)) return 0;
      if (falls && i && b->v.c[c] > b[-1].v.c[c]) return 0;
    }
  }
  return 1;
}

/* Depth 0 has neighbours so close that no rate of change between them is a double: those count as one depth. */
static double next_depth(double z) { return z > 0 ? nextafter(z, HUGE_VAL) : 1e-12; }

/* ---- One ray ------------------------------------------------------------------------------------------------- */

static int by_front(const void *a, const void *b) {
  double x = ((const event *)a)->front, y = ((const event *)b)->front;
  return (x > y) - (x < y);
}

/* Surfaces and spans whose ends coincide, nearly coincide, chain, overlap; in one ray all orders of magnitude, or one. */
static size_t random_events(rng *r, event *e) {
  size_t n = rng_below(r, rng_below(r, 32) ? 12 : MOST);
  double scale = rng_scale(r, 1e-6, 1e7), every = rng_below(r, 8) == 0;
  uint32_t cells = 1 + rng_below(r, 20);
  int grey = rng_below(r, 2) == 0;
  for (size_t i = 0; i < n; ++i) {
    double z0 = every ? rng_scale(r, 1e-6, 1e7) / scale : rng_below(r, cells), z1 = z0;
    switch (rng_below(r, 7)) {
      case 0: break;
      case 1: z1 += rng_below(r, cells); break;
      case 2: z1 += rng_scale(r, 1e-12, 1); break;
      case 3: z0 += rng_unit(r), z1 = z0 + rng_unit(r); break;
      case 4: z1 = next_depth(z0); break;
      case 5: z0 = z1 = i ? next_depth(e[i - 1].back / scale) : z0; break;
      default: z1 = z0 + 1; break;
    }
    e[i] = (event){z0 * scale, z1 * scale, rgb_grey(1), 0};
    for (int c = 0; c < 3; ++c) {
      double depth = rng_scale(r, 1e-9, rng_below(r, 9) ? 1 : 1e4);
      e[i].transmittance.c[c] = c && grey ? e[i].transmittance.c[0] : rng_below(r, 60) ? exp(-depth) : 0;
    }
  }
  qsort(e, n, sizeof *e, by_front);
  return n;
}

static double random_tolerance(rng *r) {
  switch (rng_below(r, 12)) {
    case 0: return 0;
    case 1: return 0.499;
    default: return rng_scale(r, rng_below(r, 4) ? 1e-3 : 1e-9, 0.499);
  }
}

static void transmittance(void **state) {
  (void)state;
  vertices f = {0};
  double worst = 0;   /* error, as a share of what is allowed */
  FOR_EACH_CASE(r, 4000) {
    event e[MOST];
    size_t n = random_events(&r, e);
    double tolerance = random_tolerance(&r), allowed = fmax(tolerance / 4, 1e-6);
    long double depths[MOST][3];
    for (size_t i = 0; i < n; ++i)
      for (int c = 0; c < 3; ++c) depths[i][c] = true_depth(&e[i], c);
    f.count = 0;
    assert_int_equal(transmittance_build(e, n, tolerance, &f), DSM_OK);
    assert_seeded(&r, is_sound(&f, 1));
    assert_seeded(&r, f.count == 0 || (f.data[0].v.c[0] == 1 && f.data[0].v.c[1] == 1 && f.data[0].v.c[2] == 1));
    places p = {.count = 0};
    for (size_t i = 0; i < n; ++i) {
      add_place(&p, e[i].front);
      add_place(&p, e[i].back);
    }
    add_vertices(&p, f.data, f.count < 4 * MOST ? f.count : 4 * MOST);
    finish_places(&p, &r);
    for (size_t i = 0; i < p.count; ++i)
      for (int c = 0; c < 3; ++c)
        for (int side = FRONT; side <= BEHIND; ++side) {
          long double error = fabsl(true_value(f.data, f.count, p.z[i], side, c) - true_transmittance(e, depths, n, p.z[i], side, c));
          worst = fmax(worst, (double)error / allowed);
          assert_seeded(&r, error <= allowed * (1 + 1e-5L) + 1e-11L);
        }
    if (n) assert_seeded(&r, fabsl(true_value(f.data, f.count, 1e9, BEHIND, 0) - true_transmittance(e, depths, n, 1e9, BEHIND, 0)) < 2e-12L);
  }
  print_message("transmittance: at worst %.7f of the error allowed\n", worst);
  vertices_free(&f);
}

/* ---- A pixel --------------------------------------------------------------------------------------------------- */

/* Plateaus, steps, ramps and ramps as steep as doubles go, on depths that often coincide. */
static size_t random_function(rng *r, vertex *f, size_t most, double scale, int may_grow, int grey) {
  size_t n = rng_below(r, (uint32_t)most);
  double z = rng_below(r, 4), gentle = rng_between(r, 0, 1);
  rgb v = rgb_grey(1);
  for (size_t i = 0; i < n; ++i) {
    if ((i || rng_below(r, 4) == 0) && rng_below(r, 3))
      for (int c = 0; c < 3; ++c) {
        v.c[c] = may_grow ? fmin(1, v.c[c] * rng_between(r, 0.5, 1.6)) : v.c[c] * rng_between(r, gentle, 1);
        if (rng_below(r, 100) == 0) v.c[c] = 0;
        if (grey && c) v.c[c] = v.c[0];
      }
    f[i] = (vertex){z * scale, v};
    switch (rng_below(r, 6)) {
      case 0: break;
      case 1: z = next_depth(z); break;
      case 2: z += rng_scale(r, 1e-14, 1e-2); break;
      case 3: z = floor(z) + 1; break;
      default: z += rng_unit(r); break;
    }
  }
  return n;
}

static void sweep(void **state) {
  (void)state;
  average_scratch scratch = {0};
  vertices out = {0};
  long double worst = 0;
  FOR_EACH_CASE(r, 4000) {
    enum { RAYS = 8, EACH = 10 };
    vertex all[RAYS * EACH];
    size_t first[RAYS + 1] = {0};
    double weights[RAYS], sum = 0, scale = rng_scale(&r, 1e-6, 1e7);
    int may_grow = rng_below(&r, 4) == 0, grey = rng_below(&r, 2) == 0;
    uint32_t count = 1 + rng_below(&r, RAYS);
    for (uint32_t i = 0; i < count; ++i) {
      first[i + 1] = first[i] + random_function(&r, all + first[i], EACH, scale, may_grow, grey);
      sum += weights[i] = rng_below(&r, 5) ? rng_unit(&r) : 0;
    }
    for (uint32_t i = 0; i < count; ++i) weights[i] = sum > 0 ? weights[i] / sum : 1.0 / count;
    average_input in = {all, first, weights, count};
    out.count = 0;
    assert_int_equal(average_sweep(&in, &scratch, &out), DSM_OK);
    assert_seeded(&r, is_sound(&out, !may_grow));
    assert_seeded(&r, out.count == 0 || (out.data[0].v.c[0] == 1 && out.data[0].v.c[1] == 1 && out.data[0].v.c[2] == 1));
    places p = {.count = 0};
    add_vertices(&p, all, first[count]);
    finish_places(&p, &r);
    for (size_t i = 0; i < p.count; ++i)
      for (int c = 0; c < (grey ? 1 : 3); ++c)
        for (int side = FRONT; side <= BEHIND; ++side) {
          long double error = fabsl(true_value(out.data, out.count, p.z[i], side, c) - true_average(&in, p.z[i], side, c));
          if (error > worst) worst = error;
          assert_seeded(&r, error < 1e-13L);
        }
  }
  print_message("sweep: error %.3Lg at worst\n", worst);
  vertices_free(&out);
  average_free(&scratch);
}

static void check_compressed(rng *r, const vertex *in, size_t n, const vertices *out, int channels, double tolerance, int falls,
                             long double *worst) {
  assert_seeded(r, is_sound(out, falls));
  for (int c = 0; c < channels; ++c) {
    assert_seeded(r, n == 0 || in[n - 1].v.c[c] > 0 || true_value(out->data, out->count, 1e300, BEHIND, c) == 0);
    assert_seeded(r, true_value(out->data, out->count, 0, FRONT, c) == 1);
  }
  places p = {.count = 0};
  add_vertices(&p, in, n);
  add_vertices(&p, out->data, out->count);
  finish_places(&p, r);
  for (size_t i = 0; i < p.count; ++i)
    for (int c = 0; c < channels; ++c)
      for (int side = FRONT; side <= BEHIND; ++side) {
        long double error = fabsl(true_value(out->data, out->count, p.z[i], side, c) - true_value(in, n, p.z[i], side, c));
        if (error - tolerance > *worst) *worst = error - tolerance;
        assert_seeded(r, error <= tolerance + 2e-15L);
      }
}

static void compressors(void **state) {
  (void)state;
  vertices greedy = {0}, minimal = {0}, rest = {0};
  long double worst[3] = {-1, -1, -1};
  FOR_EACH_CASE(r, 4000) {
    vertex in[MOST];
    int may_grow = rng_below(&r, 4) == 0, channels = rng_below(&r, 2) ? 3 : 1;
    size_t n = random_function(&r, in, rng_below(&r, 16) ? 24 : MOST, rng_scale(&r, 1e-6, 1e7), may_grow, 0);
    double tolerance = random_tolerance(&r), spent = rng_below(&r, 2) ? tolerance * 0.5 * rng_unit(&r) : 0;
    greedy.count = minimal.count = rest.count = 0;
    assert_int_equal(compress_greedy(in, n, channels, tolerance, &greedy), DSM_OK);
    assert_int_equal(compress_minimal(in, n, channels, tolerance, &minimal), DSM_OK);
    assert_int_equal(compress_minimal_after(in, n, channels, tolerance, spent, &rest), DSM_OK);
    check_compressed(&r, in, n, &greedy, channels, tolerance, !may_grow, &worst[0]);
    check_compressed(&r, in, n, &minimal, channels, tolerance, !may_grow, &worst[1]);
    check_compressed(&r, in, n, &rest, channels, tolerance - spent, !may_grow, &worst[2]);
    assert_seeded(&r, minimal.count <= greedy.count);
  }
  print_message("compressors: beyond the tolerance by %.3Lg (greedy), %.3Lg (minimal), %.3Lg (rest) at worst\n", worst[0], worst[1],
                worst[2]);
  vertices_free(&greedy);
  vertices_free(&minimal);
  vertices_free(&rest);
}

/* ---- A look-up ------------------------------------------------------------------------------------------------- */

/* How a tile stores: rounded, or depths and values that it can hold as they are, in absolute records or, mostly, in deltas. */
typedef enum { ROUNDED, EXACT, IN_DELTAS, STORINGS } storing;
static const rounding rule_of_deltas = {8, 1, 0x1p-6, 0};

/* A tile of random pixels. */
typedef struct {
  tile_maker base;
  vertices all;
  baked_pixel pixels[TILE_PIXELS];
  size_t counts[TILE_PIXELS];
  storing as;
  int tiles_of_deltas;
} random_tile_maker;

static dsm_result make_random(tile_maker *base, const tile_key *key, const wanted_pixels *wanted, const tile **out, tile_tally *tally) {
  (void)wanted;
  random_tile_maker *m = (random_tile_maker *)(void *)base;
  if (key->level || key->x || key->y) abort();
  tally->pixels = TILE_PIXELS;
  const rounding rule = m->as == IN_DELTAS ? rule_of_deltas : rounding_least();
  dsm_result result = pack_tile(m->pixels, &m->all, &rule, out);
  m->tiles_of_deltas += result == DSM_OK && (*out)->kind == TILE_STORED && codes_are_deltas(&(*out)->codes);
  return result;
}

static void destroy_nothing(tile_maker *base) { (void)base; }

static double in_steps(double x, double steps) { return floor(x * steps + 0.5) / steps; }

static void fill(random_tile_maker *m, rng *r) {
  m->all.count = 0;
  m->as = (storing)rng_below(r, STORINGS);
  double depth_steps = m->as == IN_DELTAS ? 1 / rule_of_deltas.quantum : 0x1p18, value_steps = m->as == IN_DELTAS ? 255 : VALUE_STEPS;
  for (int i = 0; i < TILE_PIXELS; ++i) {
    vertex f[16];
    int grey = m->as == IN_DELTAS || rng_below(r, 4) != 0;
    size_t n = random_function(r, f, i ? 16 : 2, m->as != ROUNDED ? 1 : rng_scale(r, 1e-6, 1e7), 0, grey);
    m->pixels[i] = (baked_pixel){.first = m->all.count, .count = n, .coloured = !grey, .tolerance = 0.01};
    m->counts[i] = n;
    for (size_t k = 0; k < n; ++k) {
      double z = m->as != ROUNDED ? 8 + fmin(in_steps(f[k].z, depth_steps), 31) : f[k].z;
      rgb v = f[k].v;
      for (int c = 0; m->as != ROUNDED && c < 3; ++c) v.c[c] = in_steps(v.c[c], value_steps);
      assert_int_equal(vertices_push(&m->all, z, v), DSM_OK);
    }
  }
}

static dsm_result no_rays(void *data, const dsm_ray *rays, uint32_t count, double tolerance, dsm_sink *sink) {
  (void)data, (void)rays, (void)count, (void)tolerance, (void)sink;
  return DSM_INVALID;
}

static int32_t go_on(void *data) { return (void)data, 0; }
static void say_nothing(void *data, int32_t severity, const char *sentence) { (void)data, (void)severity, (void)sentence; }

static dsm_map *map_of_one_tile(void) {
  dsm_host host = {sizeof host, NULL, no_rays, go_on, say_nothing};
  dsm_box box = {{-1, -1, 0}, {1, 1, 1e8}};
  dsm_light light = {.size = sizeof light, .kind = DSM_LIGHT_PARALLEL, .direction = {0, 0, 1}, .casters = &box, .caster_count = 1};
  dsm_settings settings;
  settings_defaults(&settings);
  settings.resolution[0] = settings.resolution[1] = TILE_SIDE;
  dsm_map *map;
  assert_int_equal(map_create(&host, &light, &settings, &map), DSM_OK);
  assert_true(map->store.grids[0][0].across == 1 && map->store.grids[0][0].up == 1);
  return map;
}

/* The bilinear average between pixels, with all their depths moved by `shift`: a stored depth is off by a rounding, so that the answer
 * lies between those of the least and the most. */
static long double true_answer(const random_tile_maker *m, long double x, long double y, double z, int c) {
  long double i = floorl(x - 0.5L), j = floorl(y - 0.5L), lost = 0;
  for (int k = 0; k < 4; ++k) {
    int px = (int)i + (k & 1), py = (int)j + (k >> 1), place = py * TILE_SIDE + px;
    if (px < 0 || py < 0 || px >= TILE_SIDE || py >= TILE_SIDE) continue;
    long double across = x - 0.5L - i, up = y - 0.5L - j, weight = (k & 1 ? across : 1 - across) * (k >> 1 ? up : 1 - up);
    lost += weight * (1 - true_value(m->all.data + m->pixels[place].first, m->counts[place], z, FRONT, c));
  }
  return 1 - lost;
}

/* One place in the tile, at depths from near to far. */
static void look(const random_tile_maker *m, dsm_worker *worker, rng *r, double near_depth, long double *worst) {
  enum { DEPTHS = 8 };
  const face *f = &worker->map->projection.faces[0];
  double x = rng_between(r, -0.5, TILE_SIDE + 0.5), y = rng_between(r, -0.5, TILE_SIDE + 0.5), depths[DEPTHS], last[3] = {1, 1, 1};
  if (rng_below(r, 4) == 0) x = in_steps(x, 2), y = in_steps(y, 2);
  double u = f->u0 + x * f->pixel_u, v = f->v0 + y * f->pixel_v;
  long double true_x = ((long double)u - f->u0) * f->per_u, true_y = ((long double)v - f->v0) * f->per_v;
  for (int k = 0; k < DEPTHS; ++k) {
    double z = m->all.data[rng_below(r, (uint32_t)m->all.count)].z;
    depths[k] = rng_below(r, 3) ? rng_below(r, 2) ? z * rng_between(r, 0.9, 1.1) : z : nextafter(z, rng_below(r, 2) ? 0 : HUGE_VAL);
  }
  qsort(depths, DEPTHS, sizeof *depths, by_size);
  for (int k = 0; k < DEPTHS; ++k) {
    dsm_receiver at = {.plane_count = 0};
    for (int i = 0; i < 3; ++i) at.point[i] = u * f->axes.right[i] + v * f->axes.up[i] + depths[k] * f->axes.forward[i];
    double rgb[3], z = at.point[2], shift = m->as != ROUNDED ? 0 : 0x1p-23 * (z - near_depth) + 0x1p-51 * z + 1e-44;
    double rounding = m->as != ROUNDED ? 0 : VALUE_ROUNDING;
    dsm_result result = map_lookup(worker, &at, rgb);
    assert_seeded(r, result == DSM_OK || (result == DSM_OUTSIDE && rgb[0] == 1 && rgb[1] == 1 && rgb[2] == 1));
    for (int c = 0; c < 3; ++c) {
      assert_seeded(r, rgb[c] >= 0 && rgb[c] <= 1 && rgb[c] <= last[c] + 1e-15);
      assert_seeded(r, z > near_depth || rgb[c] == 1);
      last[c] = rgb[c];
      long double most = true_answer(m, true_x, true_y, z - shift, c), least = true_answer(m, true_x, true_y, z + shift, c);
      long double off = fmaxl(rgb[c] - most, least - rgb[c]);
      if (off - rounding > *worst) *worst = off - rounding;
      assert_seeded(r, off <= rounding + 2e-13L);
    }
  }
}

static void look_up(void **state) {
  (void)state;
  random_tile_maker m = {.base = {make_random, destroy_nothing}};
  long double worst = -1;
  FOR_EACH_CASE(r, 4000) {
    if (case_ % 100) continue;   /* one tile for a hundred places, and eight depths at each */
    fill(&m, &r);
    if (m.all.count == 0) continue;
    double near_depth = HUGE_VAL;
    for (size_t i = 0; i < m.all.count; ++i) near_depth = fmin(near_depth, m.all.data[i].z);
    dsm_map *map = map_of_one_tile();
    dsm_worker *worker;
    assert_int_equal(worker_create(map, NULL, &m.base, &worker), DSM_OK);
    for (int i = 0; i < 100; ++i) look(&m, worker, &r, near_depth, &worst);
    worker_destroy(worker);
    map_destroy(map);
  }
  print_message("look-up: beyond what storing rounds by %.3Lg at worst, %d tiles of deltas\n", worst, m.tiles_of_deltas);
  vertices_free(&m.all);
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(transmittance),
    cmocka_unit_test(sweep),
    cmocka_unit_test(compressors),
    cmocka_unit_test(look_up),
  };
  print_message("seeds from %llu on\n", (unsigned long long)number_from("DSM_SEED", 1));
  return cmocka_run_group_tests_name("random cases", tests, NULL, NULL);
}
