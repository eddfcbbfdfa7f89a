/* SPDX-License-Identifier: AGPL-3.0-or-later */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "../oracle/oracle.h"
#include "bake/bake_tile.h"
#include "map/pack_tile.h"
#include "bake/smooth_noise.h"
#include "core/transmittance.h"

static wanted_pixels all_wanted;   /* set in main */

static const tile *bake(stage *s, uint32_t x, uint32_t y, bake_scratch *scratch, tile_tally *tally) {
  bake_job job = {&s->map->host, &s->w, &s->map->projection, &s->map->settings, &s->map->light, NULL, NULL};
  tile_key key = {0, 0, x, y};
  const tile *t = NULL;
  *tally = (tile_tally){0};
  assert_int_equal(bake_tile(&job, scratch, &key, &all_wanted, &t, tally), DSM_OK);
  assert_non_null(t);
  return t;
}

/* Every pixel of a baked tile, at every depth, against the plain sum over rays traced again one by one: vertices may have
 * moved away from the light, so up to as far in front, as it never grows. */
static void pixels_are_their_rays_average(void **state) {
  (void)state;
  enum { HAIRS = 150, RAYS = 25 };
  static shape hair[HAIRS + 1];
  pixel_point path[RAYS];
  pixel_sample_path(RAYS, path);
  for (int k = 0; k < 12; ++k) {   /* from 6 on without the fog */
    rng r = rng_seeded((uint64_t)k);
    for (int i = 0; i < HAIRS; ++i)
      hair[i] = sphere_at(rng_between(&r, -1, 1), rng_between(&r, -1, 1), rng_between(&r, 2, 4), 0.08, k % 2 ? 0 : 0.5);
    hair[HAIRS] = fog_in((dsm_box){{-1, -1, 2}, {1, 1, 4}}, 0.2, 0.1, k < 3 ? 0.3 : 0.2, 0);
    if (k >= 9)
      for (int i = 0; i < HAIRS; i += 2) hair[i].pass[1] = 0.8;
    stage s;
    static const char *const tolerances[] = {"tolerance 0", "tolerance 0.01", "bias 0"};   /* the last: automatic */
    const double limits[] = {0, 0.01, 0.25 / 5 + 0.002};
    stage_open(&s, hair, HAIRS + (k < 6), spot_at(0, 0, 0, 0, 0, 1, 25), WORDS("resolution 40", "samples 25", tolerances[k % 3]));
    bake_scratch scratch = {0};
    tile_tally tally;
    const tile *t = bake(&s, 1, 1, &scratch, &tally);
    assert_int_equal(t->kind, TILE_STORED);
    for (int probe = 0; probe < 400; ++probe) {
      uint32_t px = rng_below(&r, TILE_SIDE), py = rng_below(&r, TILE_SIDE);
      double z = rng_between(&r, 1.9, 5), most[3] = {0, 0, 0}, least[3] = {0, 0, 0};
      rounding rule = rounding_for(&s.map->projection, 0, 0, 0, VALUE_BITS, limits[k % 3]);
      double moved = k < 6 ? 0 : rule.quantum * (rule.perspective ? z : 1);   /* in fog it is part of the tolerance */
      for (uint32_t i = 0; i < RAYS; ++i) {
        pixel_filter filter = {FILTER_BOX, 1};
        double o[2];
        dsm_ray ray;
        dsm_sink sink = {0};
        vertices list = {0};
        pixel_sample_offsets(&filter, pixel_sample_seed(0, 16 + px, 16 + py), &path[i], 1, &o);
        projection_ray(&s.map->projection, 0, 16 + px + 0.5 + o[0], 16 + py + 0.5 + o[1], &ray);
        assert_int_equal(sink_begin(&sink, &ray, 1), DSM_OK);
        assert_int_equal(trace_world(&s.w, &ray, 1, 0, &sink), DSM_OK);
        assert_int_equal(sink_order(&sink), DSM_OK);
        assert_int_equal(transmittance_build(sink.ordered, sink.count, 0, &list), DSM_OK);
        rgb front = vertices_at(list.data, list.count, z - moved), here = vertices_at(list.data, list.count, z);
        for (int c = 0; c < 3; ++c) {
          most[c] += front.c[c] / RAYS;
          least[c] += here.c[c] / RAYS;
        }
        sink_free(&sink);
        vertices_free(&list);
      }
      visibility stored = tile_visibility(t, py * TILE_SIDE + px);
      uint32_t hint = 0;
      rgb got = visibility_at(&stored, z - t->near_depth, &hint);
      for (int c = 0; c < 3; ++c) {
        double limit = limits[k % 3] + (k % 3 == 1 ? 1e-9 : 1e-5);
        if (got.c[c] > most[c] + limit || got.c[c] < least[c] - limit)
          fail_msg("seed %d: at depth %g of pixel %u, %u: %g, not %g to %g", k, z, px, py, got.c[c], least[c], most[c]);
      }
    }
    assert_true(tally.pixels == 256 && tally.rays == 256 * RAYS && tally.vertices > 0);
    tile_destroy(t);
    bake_scratch_free(&scratch);
    stage_close(&s);
  }
}

/* Of each four rays the first counts; the others report nothing, or what is not so. */
static dsm_result trace_few(void *data, const dsm_ray *rays, uint32_t count, double tolerance, dsm_sink *sink) {
  static const double dark[3] = {0, 0, 0};
  assert_true(sink_pixel_rays(sink) == 16 && count % 16 == 0);
  dsm_result result = trace_world(data, rays, count, tolerance, sink);
  for (uint32_t i = 0; i < count && result == DSM_OK; ++i) {
    if (i % 4 == 0) continue;
    if (i % 4 == 2) result = sink_surface(sink, i, rays[i].near_depth, dark);
    if (result == DSM_OK) result = sink_spare(sink, i);
  }
  return result;
}

static void spared_rays_do_not_count(void **state) {
  (void)state;
  enum { RAYS = 16 };
  pixel_point path[RAYS];
  pixel_sample_path(RAYS, path);
  for (int k = 0; k < 4; ++k) {   /* with fog and without; glass, and a ground that nothing passes */
    shape all[] = {sphere_at(0, 0, 3, 0.9, k & 1 ? 0 : 0.5), fog_in((dsm_box){{-1, -1, 2}, {1, 1, 4}}, 0.6, 0.6, 0.6, 0)};
    stage s;
    stage_open(&s, all, k < 2 ? 2 : 1, spot_at(0, 0, 0, 0, 0, 1, 25), WORDS("resolution 40", "samples 16", "tolerance 0"));
    s.map->host.trace = trace_few;
    bake_scratch scratch = {0};
    tile_tally tally;
    const tile *t = bake(&s, 1, 1, &scratch, &tally);
    for (uint32_t place = 0; place < TILE_PIXELS; ++place)
      for (double z = 2; z < 4.2; z += 0.1) {
        double want = 0;
        for (uint32_t i = 0; i < RAYS; i += 4) {
          pixel_filter filter = {FILTER_BOX, 1};
          uint32_t px = 16 + place % TILE_SIDE, py = 16 + place / TILE_SIDE;
          double o[2];
          dsm_ray ray;
          dsm_sink sink = {0};
          vertices list = {0};
          pixel_sample_offsets(&filter, pixel_sample_seed(0, px, py), &path[i], 1, &o);
          projection_ray(&s.map->projection, 0, px + 0.5 + o[0], py + 0.5 + o[1], &ray);
          assert_int_equal(sink_begin(&sink, &ray, 1), DSM_OK);
          assert_int_equal(trace_world(&s.w, &ray, 1, 0, &sink), DSM_OK);
          assert_int_equal(sink_order(&sink), DSM_OK);
          assert_int_equal(transmittance_build(sink.ordered, sink.count, 0, &list), DSM_OK);
          want += vertices_at(list.data, list.count, z).c[0] / 4;
          sink_free(&sink);
          vertices_free(&list);
        }
        visibility stored = tile_visibility(t, place);
        uint32_t hint = 0;
        double got = visibility_at(&stored, z - t->near_depth, &hint).c[0];
        if (fabs(got - want) > 2e-5) fail_msg("case %d: at depth %g of pixel %u: %g, not %g", k, z, place, got, want);
      }
    tile_destroy(t);
    bake_scratch_free(&scratch);
    stage_close(&s);
  }
}

/* Of a slanted sheet of glass the automatic tolerance keeps the plateaus to 0.002 and few vertices. */
static void slanted_glass_is_small_and_exact(void **state) {
  (void)state;
  shape ball = sphere_at(0, 0, 5, 1, 0.5);
  for (int k = 0; k < 3; ++k) {
    stage s;
    stage_open(&s, &ball, 1, parallel_at(0, 0, 0, 0, 0, 1), WORDS("resolution 128", k == 0 ? "samples 16" : k == 1 ? "samples 64" : "samples 256"));
    bake_scratch scratch = {0};
    tile_tally tally;
    const tile *t = bake(&s, 2, 3, &scratch, &tally);
    assert_true(tally.vertices < tally.pixels * (k == 0 ? 14u : 20u));
    for (uint32_t i = 0; i < TILE_PIXELS; ++i) {
      visibility v = tile_visibility(t, i);
      uint32_t hint = 0;
      double front = visibility_at(&v, 3.9 - t->near_depth, &hint).c[0], middle = visibility_at(&v, 5 - t->near_depth, &hint).c[0];
      double behind = visibility_at(&v, 6.1 - t->near_depth, &hint).c[0];
      double x = 16 * 2 + (int)(i % 16) - 63.5, y = 16 * 3 + (int)(i / 16) - 63.5;
      if (hypot(x, y) > 61) continue;   /* at the rim there is noise on the plateaus too */
      assert_true(front == 1 && fabs(middle - 0.5) <= 0.0021 && fabs(behind - 0.25) <= 0.0021);
    }
    tile_destroy(t);
    bake_scratch_free(&scratch);
    stage_close(&s);
  }
}

/* What storing rounds makes no tall step of the step of one ray in 16, though it is as tall as the tolerance. */
static void steps_of_one_ray_merge(void **state) {
  (void)state;
  enum { HAIRS = 400 };
  static shape hair[HAIRS];
  rng r = rng_seeded(7);
  uint64_t vertices[2];
  for (int i = 0; i < HAIRS; ++i)
    hair[i] = sphere_at(rng_between(&r, -1, 1), rng_between(&r, -1, 1), rng_between(&r, 2, 4), 0.05, 0);
  for (int k = 0; k < 2; ++k) {
    stage s;
    stage_open(&s, hair, HAIRS, spot_at(0, 0, 0, 0, 0, 1, 25), WORDS("resolution 40", "samples 16", k ? "tolerance 0.0624" : "tolerance 0.0625"));
    bake_scratch scratch = {0};
    tile_tally tally;
    tile_destroy(bake(&s, 1, 1, &scratch, &tally));
    vertices[k] = tally.vertices;
    bake_scratch_free(&scratch);
    stage_close(&s);
  }
  print_message("tolerance of one ray: %llu vertices, of less: %llu\n", (unsigned long long)vertices[0], (unsigned long long)vertices[1]);
  assert_true(2 * vertices[0] < vertices[1]);
}

static void nothing_in_the_way_is_the_shared_tile(void **state) {
  (void)state;
  shape all[] = {sphere_at(-0.9, -0.9, 5, 0.1, 0), sphere_at(0.9, 0.9, 5, 0.1, 0)};
  stage s;
  stage_open(&s, all, 2, parallel_at(0, 0, 0, 0, 0, 1), WORDS("resolution 64"));
  bake_scratch scratch = {0};
  tile_tally tally;
  assert_ptr_equal(bake(&s, 0, 2, &scratch, &tally), &tile_lit);
  assert_true(tally.vertices == 0 && tally.rays == 4096);
  bake_scratch_free(&scratch);
  stage_close(&s);
}

typedef struct { uint32_t most, calls; uint64_t rays; } batches;

static dsm_result count_batches(void *data, const dsm_ray *rays, uint32_t count, double tolerance, dsm_sink *sink) {
  batches *b = data;
  (void)rays;
  (void)sink;
  assert_true(tolerance == 0.002);
  ++b->calls;
  b->rays += count;
  if (count > b->most) b->most = count;
  return DSM_OK;
}

/* Whole pixels a batch, of four equal shares, or as many as have 1024 rays; 4096 rays at most unless one pixel has more. And no ray outside the face. */
static void batches_are_whole_pixels(void **state) {
  (void)state;
  static const char *const samples[] = {"samples 1", "samples 3", "samples 16", "samples 17", "samples 1000", "samples 4096"};
  const uint32_t count[] = {1, 3, 16, 17, 1000, 4096}, most[] = {256, 768, 1024, 64 * 17, 4000, 4096}, calls[] = {1, 1, 4, 4, 64, 256};
  for (int k = 0; k < 6; ++k) {
    shape ball = sphere_at(0, 0, 5, 1, 0);
    stage s;
    batches b = {0};
    stage_open(&s, &ball, 1, parallel_at(0, 0, 0, 0, 0, 1), WORDS("resolution 20", samples[k]));
    dsm_host host = s.map->host;
    host.trace = count_batches;
    host.pause = NULL;
    bake_job job = {&host, &b, &s.map->projection, &s.map->settings, &s.map->light, NULL, NULL};
    bake_scratch scratch = {0};
    tile_tally tally = {0};
    const tile *t;
    assert_int_equal(bake_tile(&job, &scratch, &(tile_key){0, 0, 0, 0}, &all_wanted, &t, &tally), DSM_OK);
    assert_true(b.most == most[k] && b.calls == calls[k] && b.rays == 256u * count[k]);
    b = (batches){0};
    assert_int_equal(bake_tile(&job, &scratch, &(tile_key){0, 0, 1, 1}, &all_wanted, &t, &tally), DSM_OK);
    assert_true(b.rays == 16u * count[k]);   /* 4 x 4 pixels of that tile are on the face */
    bake_scratch_free(&scratch);
    stage_close(&s);
  }
}

static void packing_keeps_steps_and_drops_coincidence(void **state) {
  (void)state;
  vertices list = {0};
  baked_pixel pixels[TILE_PIXELS] = {{0}};
  /* at 1e9 doubles are 1.2e-7 apart; floats relative to the near depth keep that */
  const double z[] = {1e9, 1e9 + 1e-6, 1e9 + 1e-6, 1e9 + 1000, 1e9 + 1000 + 1e-6, 1e9 + 1000 + 2e-6};
  for (int i = 0; i < 6; ++i) assert_int_equal(vertices_push(&list, z[i], rgb_grey(1 - i * 0.1)), DSM_OK);
  list.data[4].v.c[2] = 0.55;
  pixels[3] = (baked_pixel){.first = 0, .count = 3};
  pixels[4] = (baked_pixel){.first = 3, .count = 3, .coloured = 1};
  pixels[5] = (baked_pixel){.marked = 1};
  const rounding rule = rounding_least();
  const tile *t;
  assert_int_equal(pack_tile(pixels, &list, &rule, &t), DSM_OK);
  assert_true(t->near_depth == 1e9);
  assert_true(tile_is_marked(t, 5) && !tile_is_marked(t, 3) && tile_visibility(t, 0).count == 0);
  visibility v = tile_visibility(t, 3);
  assert_true(v.count == 3 && v.channels == 1 && visibility_depth(&v, 0) == 0 && visibility_depth(&v, 1) > 0
              && visibility_depth(&v, 1) == visibility_depth(&v, 2));
  assert_true(visibility_stored(&v, 0, 0) == VALUE_STEPS && visibility_stored(&v, 2, 0) == lround(0.8 * VALUE_STEPS));
  v = tile_visibility(t, 4);   /* grey, whatever it was called: the one vertex that has a colour is dropped */
  assert_true(v.count == 2 && v.channels == 1 && visibility_depth(&v, 0) == visibility_depth(&v, 1));
  assert_true(visibility_stored(&v, 0, 0) == lround(0.7 * VALUE_STEPS) && visibility_stored(&v, 1, 0) == lround(0.5 * VALUE_STEPS));
  tile_destroy(t);
  vertices_free(&list);
}

/* The estimate of noise: right for an edge within a factor, nothing where rays agree. */
static void noise_is_measured(void **state) {
  (void)state;
  enum { N = 64 };
  pixel_point path[N];
  size_t first[N + 1];
  double weights[N], estimate = 0, error = 0;
  pixel_sample_path(N, path);
  enum { PIXELS = 300 };
  for (uint32_t p = 0; p < PIXELS; ++p) {
    vertices all = {0}, mean = {0};
    average_scratch scratch = {0};
    double edge = (p + 0.5) / PIXELS - 0.5, covered = 0;
    for (uint32_t i = 0; i < N; ++i) {
      double o[2];
      pixel_sample_offsets(&(pixel_filter){FILTER_BOX, 1}, pixel_sample_seed(0, p, 0), &path[i], 1, &o);
      first[i] = all.count;
      weights[i] = 1.0 / N;
      assert_int_equal(vertices_push(&all, 1, rgb_grey(1)), DSM_OK);
      assert_int_equal(vertices_push(&all, 1, rgb_grey(0.5)), DSM_OK);
      if (o[0] + 0.3 * o[1] < edge) {
        covered += 1.0 / N;
        assert_int_equal(vertices_push(&all, 2, rgb_grey(0.5)), DSM_OK);
        assert_int_equal(vertices_push(&all, 2, rgb_grey(0)), DSM_OK);
      }
    }
    first[N] = all.count;
    average_input in = {all.data, first, weights, N};
    noise_profile profile = {0};
    assert_int_equal(average_and_noise(&in, &scratch, &profile, &mean), DSM_OK);
    for (size_t i = 0; i < mean.count; ++i)
      if (mean.data[i].z < 2) assert_true(profile.allowed[i] == 0);
    double behind = profile.allowed[mean.count - 1];
    if (covered > 0 && covered < 1) assert_true(behind > 0 && behind <= 0.25 / 8);
    /* the truth, by the area on one side of a slightly slanted line */
    double want = 0;
    for (int k = 0; k < 500; ++k) want += fmax(0, fmin(1, edge - 0.3 * ((k + 0.5) / 500 - 0.5) + 0.5)) / 500;
    estimate += 4 * behind * behind / PIXELS;   /* half the error is allowed */
    error += 0.25 * (covered - want) * (covered - want) / PIXELS;
    noise_free(&profile);
    average_free(&scratch);
    vertices_free(&mean);
    vertices_free(&all);
  }
  assert_true(sqrt(estimate) > 0.8 * sqrt(error) && sqrt(estimate) < 8 * sqrt(error));
}

int main(void) {
  memset(&all_wanted, 1, sizeof all_wanted);
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(pixels_are_their_rays_average),
    cmocka_unit_test(spared_rays_do_not_count),
    cmocka_unit_test(slanted_glass_is_small_and_exact),
    cmocka_unit_test(steps_of_one_ray_merge),
    cmocka_unit_test(nothing_in_the_way_is_the_shared_tile),
    cmocka_unit_test(batches_are_whole_pixels),
    cmocka_unit_test(packing_keeps_steps_and_drops_coincidence),
    cmocka_unit_test(noise_is_measured),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
