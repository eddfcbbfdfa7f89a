/* SPDX-License-Identifier: AGPL-3.0-or-later */
/*
 * The vertices of all functions are met in order of depth, which a merge sort of runs that are sorted already gives;
 * then each costs a constant, but for the tree below.
 *
 * Where drift could come from, and what stops it. The value is a compensated sum, and is summed afresh once
 * for every `count` vertices, which costs a constant a vertex. The slope of a ramp can be 10^20 times that
 * of another, and would leave its rounding behind when it is taken out of a running sum; so slopes are the
 * leaves of a tree of sums, in which a ramp that has ended is exactly gone. Step functions, the usual ones
 * (opaque hair), never touch the tree.
 */
#include "core/average.h"

#include <stdlib.h>
#include <string.h>

#include "core/compensated.h"
#include "core/depth_sort.h"
#include "core/extremes.h"

#define STEEPEST 1e280   /* a steeper ramp is a step at its far end */

/* A function between two of its depths. */
struct average_cursor {
  const vertex *next, *end;   /* vertices that have not been met */
  double z, until;            /* the last depth met, and the next, or infinity */
  rgb v, slope;               /* the value behind z, and its change with depth */
  rgb held;                   /* what the sum holds of it once `until` is reached */
};

typedef struct {
  const average_input *in;
  struct average_cursor *functions;
  double *slopes;   /* [channels…]: the sum; [channels * (count + i)…]: weighted slope of function i now */
  size_t count;
  compensated value[3];
  int rose[3], fell[3];   /* at this depth, by a step */
  double *gaps;     /* [i]: squared difference of functions i and i + 1; NULL: the noise is not wanted */
  double squares, pairs;  /* the sum of `gaps`, and how many of them are not 0 */
  noise_scale scale;
} sweep;

/* Each is made twice, for one channel and for three, which halves the work of grey. */
#define FOR_CHANNELS static inline __attribute__((always_inline))

static double total(const compensated *of) { return lesser(1, greater(0, compensated_total(of))); }

FOR_CHANNELS int differ(int channels, rgb a, rgb b) {
  int different = 0;
  for (int c = 0; c < channels; ++c) different |= a.c[c] != b.c[c];
  return different;
}

FOR_CHANNELS void set_slope(sweep *s, int channels, uint32_t function, const double *slope) {
  size_t n = (size_t)channels, leaf = s->count + function;
  int idle = 1;
  for (size_t c = 0; c < n; ++c) {
    idle &= slope[c] == 0 && s->slopes[n * leaf + c] == 0;
    s->slopes[n * leaf + c] = slope[c];
  }
  if (idle) return;
  while (leaf /= 2) {
    double *to = &s->slopes[n * leaf];
    const double *from = &s->slopes[n * 2 * leaf];
    for (size_t c = 0; c < n; ++c) to[c] = from[c] + from[n + c];
  }
}

/* Takes one function past its vertices at its next depth: a step changes the value, the next segment changes the
 * slope. */
FOR_CHANNELS void advance(sweep *s, int channels, uint32_t function) {
  struct average_cursor *f = &s->functions[function];
  const vertex *last = f->next;
  double weight = s->in->weights[function], slope[3] = {0, 0, 0};
  int steep = 0, ramp = 0;
  while (last + 1 < f->end && last[1].z == f->until) ++last;
  for (int c = 0; c < channels; ++c) {
    double jump = last->v.c[c] - f->held.c[c];
    if (jump == 0) continue;
    compensated_add(&s->value[c], weight * jump);
    s->rose[c] |= jump > 0;
    s->fell[c] |= jump < 0;
  }
  f->z = f->until;
  f->v = f->held = last->v;
  f->next = last + 1;
  f->until = HUGE_VAL;
  if (f->next < f->end) {
    f->until = last[1].z;
    for (int c = 0; c < channels; ++c) {
      slope[c] = (last[1].v.c[c] - last->v.c[c]) / (f->until - f->z);
      steep |= !(fabs(slope[c]) < STEEPEST);
      ramp |= slope[c] != 0;
    }
    if (ramp && !steep) f->held = last[1].v;
  }
  for (int c = 0; c < channels; ++c) {
    f->slope.c[c] = steep ? 0 : slope[c];
    slope[c] = weight * f->slope.c[c];
  }
  set_slope(s, channels, function, slope);
}

/* The value behind depth z, afresh from all functions. */
static void sum_afresh(sweep *s, int channels, double z) {
  for (int c = 0; c < channels; ++c) {
    s->value[c] = (compensated){0, 0};
    for (size_t i = 0; i < s->count; ++i) {
      const struct average_cursor *f = &s->functions[i];
      double v = f->slope.c[c] != 0 ? f->v.c[c] + f->slope.c[c] * (z - f->z) : f->v.c[c];
      compensated_add(&s->value[c], s->in->weights[i] * v);
    }
  }
}

FOR_CHANNELS double gap(const struct average_cursor *a, const struct average_cursor *b, int c, double z) {
  double of_a = a->v.c[c] + (a->slope.c[c] != 0 ? a->slope.c[c] * (z - a->z) : 0);
  double of_b = b->v.c[c] + (b->slope.c[c] != 0 ? b->slope.c[c] * (z - b->z) : 0);
  return of_a - of_b;
}

/* Functions i and i + 1 from depth z until one of them turns: the larger of their squared differences there. */
FOR_CHANNELS void renew_gap(sweep *s, int channels, uint32_t i, double z) {
  const struct average_cursor *a = &s->functions[i], *b = a + 1;
  double until = lesser(a->until, b->until), square = 0, was = s->gaps[i];
  for (int c = 0; c < channels; ++c) {
    double here = gap(a, b, c, z), there = until < HUGE_VAL ? gap(a, b, c, until) : 0;
    square = greater(square, greater(here * here, there * there));
  }
  s->gaps[i] = square;
  s->squares += square - was;
  s->pairs += (square > 0) - (was > 0);
  if (s->pairs == 0) s->squares = 0;   /* without the rounding of those that were */
}

typedef struct { double allowed, variance; } noise;   /* see noise_profile */

static void put_noise(noise_profile *profile, size_t place, noise n) {
  profile->allowed[place] = n.allowed;
  profile->variance[place] = n.variance;
}

static void raise_noise(noise_profile *profile, size_t place, noise n) {
  profile->allowed[place] = greater(profile->allowed[place], n.allowed);
  profile->variance[place] = greater(profile->variance[place], n.variance);
}

/* The noise behind depth z, where the functions of `met` have turned. */
FOR_CHANNELS noise noise_behind(sweep *s, int channels, double z, const depth_key *met, const depth_key *end) {
  for (; met < end; ++met) {
    uint32_t i = (uint32_t)met->index;
    if (i > 0) renew_gap(s, channels, i - 1, z);
    if (i + 1 < s->count) renew_gap(s, channels, i, z);
  }
  return (noise){noise_allowed(s->squares, s->pairs, &s->scale), noise_variance(s->squares, &s->scale)};
}

/* The value in front of a depth and behind it. Rounding must not make light grow where no function grows,
 * nor make a step or a slope where there is none; `last` is the value at the depth before, `slope` the slope
 * since. */
FOR_CHANNELS void settle(const sweep *s, int channels, const rgb *front, const double *slope, rgb last, rgb *before,
                         rgb *after) {
  for (int c = 0; c < channels; ++c) {
    int steps = s->rose[c] || s->fell[c];
    double now = total(&s->value[c]), b = steps ? front->c[c] : now, a;
    if (slope[c] <= 0) b = lesser(b, last.c[c]);
    if (slope[c] >= 0) b = greater(b, last.c[c]);
    a = steps ? now : b;
    before->c[c] = b;
    after->c[c] = s->rose[c] ? a : lesser(a, b);
  }
  if (channels == 3) return;
  *before = rgb_grey(before->c[0]);
  *after = rgb_grey(after->c[0]);
}

FOR_CHANNELS dsm_result run(sweep *s, int channels, const depth_key *keys, size_t places, noise_profile *profile,
                            vertices *out) {
  size_t since = 0, begin = out->count;
  double z = 0;
  noise now = {0, 0};
  rgb last = rgb_grey(1), front = last, before = last, after = last;
  dsm_result result = DSM_OK;
  for (size_t i = 0, met; i < places && !result; i = met) {
    double slope[3] = {0, 0, 0}, step = keys[i].z - z;
    noise was = now;
    int turns = 0;
    z = keys[i].z;
    for (int c = 0; c < channels; ++c) {
      slope[c] = s->slopes[channels + c];
      if (slope[c] != 0) compensated_add(&s->value[c], slope[c] * step);
      front.c[c] = total(&s->value[c]);
      s->rose[c] = s->fell[c] = 0;
    }
    for (met = i; met < places && keys[met].z == z; ++met, ++since) advance(s, channels, (uint32_t)keys[met].index);
    if (since >= s->count || met == places) {   /* at the end too: what is dark must be exactly 0 */
      sum_afresh(s, channels, z);
      since = 0;
    }
    settle(s, channels, &front, slope, last, &before, &after);
    for (int c = 0; c < channels; ++c) turns |= slope[c] != s->slopes[channels + c];
    int steps = differ(channels, before, after);
    last = after;
    if (profile) now = noise_behind(s, channels, z, keys + i, keys + met);
    if (steps || turns) {
      if (profile) put_noise(profile, out->count - begin, steps ? was : now);
      result = vertices_push(out, z, before);
    }
    if (steps && !result) {
      if (profile) put_noise(profile, out->count - begin, now);
      result = vertices_push(out, z, after);
    }
    if (profile && out->count > begin)   /* where no vertex is put, the last one answers for more */
      raise_noise(profile, out->count - begin - 1, now);
  }
  return result;
}

/* The depths at which functions have vertices, in order; those of one depth in the order of the functions. */
static size_t list_places(const average_input *in, depth_key *keys) {
  size_t places = 0;
  for (uint32_t i = 0; i < in->count; ++i) {
    if (!(in->weights[i] > 0)) continue;
    const vertex *v = in->all + in->first[i], *end = in->all + in->first[i + 1];
    for (; v < end; ++v)
      if (v + 1 == end || v[1].z != v->z) keys[places++] = (depth_key){v->z, i};
  }
  depth_sort(keys, places, keys + places);
  return places;
}

static int are_grey(const average_input *in) {
  int grey = 1;
  for (size_t i = in->first[0]; i < in->first[in->count]; ++i) grey &= rgb_is_grey(in->all[i].v);
  return grey;
}

static dsm_result make_room(average_scratch *scratch, size_t vertices, size_t functions) {
  if (scratch->room_vertices >= vertices && scratch->room_functions >= functions) return DSM_OK;
  average_free(scratch);
  vertices += vertices / 2;
  scratch->keys = malloc(2 * vertices * sizeof *scratch->keys);
  scratch->functions = malloc(functions * sizeof *scratch->functions);
  scratch->numbers = malloc(7 * functions * sizeof *scratch->numbers);   /* six for slopes, one for gaps */
  if (!scratch->keys || !scratch->functions || !scratch->numbers) {
    average_free(scratch);
    return DSM_NO_MEMORY;
  }
  scratch->room_vertices = vertices;
  scratch->room_functions = functions;
  return DSM_OK;
}

dsm_result average_and_noise(const average_input *in, average_scratch *scratch, noise_profile *profile, vertices *out) {
  size_t begin = out->count, count = in->count ? in->first[in->count] - in->first[0] : 0;
  if (count == 0) return DSM_OK;
  dsm_result result = make_room(scratch, count, in->count);
  if (!result && profile) result = noise_reserve(profile, 2 * count);
  if (result) return result;

  sweep s = {.in = in, .functions = scratch->functions, .slopes = scratch->numbers, .count = in->count};
  if (profile) s.gaps = s.slopes + 6 * s.count, s.scale = noise_scale_of((double)s.count);
  memset(s.slopes, 0, 7 * s.count * sizeof *s.slopes);
  for (int c = 0; c < 3; ++c) s.value[c] = (compensated){1, 0};
  for (uint32_t i = 0; i < in->count; ++i) {
    struct average_cursor f = {in->all + in->first[i], in->all + in->first[i + 1], 0, HUGE_VAL,
                               rgb_grey(1), rgb_grey(0), rgb_grey(1)};
    if (f.next < f.end && in->weights[i] > 0) f.until = f.next->z;
    s.functions[i] = f;
  }
  size_t places = list_places(in, scratch->keys);
  result = are_grey(in) ? run(&s, 1, scratch->keys, places, profile, out)
                        : run(&s, 3, scratch->keys, places, profile, out);
  if (result) out->count = begin;
  return result;
}

dsm_result average_sweep(const average_input *in, average_scratch *scratch, vertices *out) {
  return average_and_noise(in, scratch, NULL, out);
}

void average_free(average_scratch *scratch) {
  free(scratch->keys);
  free(scratch->functions);
  free(scratch->numbers);
  *scratch = (average_scratch){0};
}
