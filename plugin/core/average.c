/* SPDX-License-Identifier: AGPL-3.0-or-later */
/*
 * Where drift could come from, and what stops it. The value is a compensated sum, and is summed afresh once
 * for every `count` vertices, which costs a constant a vertex. The slope of a ramp can be 10^20 times that
 * of another, and would leave its rounding behind when it is taken out of a running sum; so slopes are the
 * leaves of a tree of sums, in which a ramp that has ended is exactly gone. Step functions, the usual ones
 * (opaque hair), never touch the tree.
 */
#include "core/average.h"

#include <stdlib.h>

#include "core/compensated.h"

#define STEEPEST 1e280   /* a steeper ramp is a step at its far end */

/* A function and its next vertex, and the value that the sum holds of it once that vertex is reached. */
struct average_cursor {
  double z;
  size_t next, end;
  rgb held;
  uint32_t function;
};

typedef struct {
  const average_input *in;
  struct average_cursor *heap;   /* the first `alive` by depth; then those that stay as they are */
  rgb *slopes;                   /* [1]: the sum; [count + i]: weighted slope of function i now */
  size_t count, alive;
  compensated value[3];
  int rose[3], fell[3];          /* at this depth, by a step */
} sweep;

static double total(const compensated *of) { return fmin(1, fmax(0, compensated_total(of))); }

static int is_zero(rgb a) { return a.c[0] == 0 && a.c[1] == 0 && a.c[2] == 0; }

static void sift_down(struct average_cursor *heap, size_t count, size_t i) {
  struct average_cursor moved = heap[i];
  for (size_t child; (child = 2 * i + 1) < count; i = child) {
    if (child + 1 < count && heap[child + 1].z < heap[child].z) ++child;
    if (!(heap[child].z < moved.z)) break;
    heap[i] = heap[child];
  }
  heap[i] = moved;
}

static void set_slope(sweep *s, uint32_t function, rgb slope) {
  size_t leaf = s->count + function;
  if (is_zero(s->slopes[leaf]) && is_zero(slope)) return;
  s->slopes[leaf] = slope;
  for (leaf /= 2; leaf >= 1; leaf /= 2) s->slopes[leaf] = rgb_add(s->slopes[2 * leaf], s->slopes[2 * leaf + 1]);
}

static void start(sweep *s) {
  for (size_t i = 0; i < 2 * s->count; ++i) s->slopes[i] = rgb_grey(0);
  for (int c = 0; c < 3; ++c) s->value[c] = (compensated){1, 0};
  size_t alive = 0, still = s->count;
  for (uint32_t i = 0; i < s->count; ++i) {
    struct average_cursor cursor = {0, s->in->first[i], s->in->first[i + 1], rgb_grey(1), i};
    if (cursor.next < cursor.end && s->in->weights[i] > 0) {
      cursor.z = s->in->all[cursor.next].z;
      s->heap[alive++] = cursor;
    } else {
      s->heap[--still] = cursor;
    }
  }
  s->alive = alive;
  for (size_t i = alive / 2; i-- > 0;) sift_down(s->heap, alive, i);
}

/* Takes one function past its vertices at its depth: a step changes the value, the next segment changes the
 * slope. */
static void advance(sweep *s, struct average_cursor *cursor) {
  const vertex *all = s->in->all;
  double weight = s->in->weights[cursor->function];
  size_t i = cursor->next;
  while (i + 1 < cursor->end && all[i + 1].z == cursor->z) ++i;
  rgb jump = rgb_sub(all[i].v, cursor->held), slope = rgb_grey(0);
  for (int c = 0; c < 3; ++c) {
    if (jump.c[c] == 0) continue;
    compensated_add(&s->value[c], weight * jump.c[c]);
    s->rose[c] |= jump.c[c] > 0;
    s->fell[c] |= jump.c[c] < 0;
  }
  cursor->held = all[i].v;
  cursor->next = i + 1;
  if (cursor->next < cursor->end) {
    cursor->z = all[i + 1].z;
    slope = rgb_sub(all[i + 1].v, all[i].v);
    for (int c = 0; c < 3; ++c) slope.c[c] = weight * (slope.c[c] / (cursor->z - all[i].z));
    if (fabs(slope.c[0]) < STEEPEST && fabs(slope.c[1]) < STEEPEST && fabs(slope.c[2]) < STEEPEST) {
      cursor->held = all[i + 1].v;
    } else {
      slope = rgb_grey(0);
    }
  }
  set_slope(s, cursor->function, slope);
}

/* The value behind depth z, afresh from all functions. */
static void sum_afresh(sweep *s, double z) {
  for (int c = 0; c < 3; ++c) s->value[c] = (compensated){0, 0};
  for (size_t i = 0; i < s->count; ++i) {
    const struct average_cursor *cursor = &s->heap[i];
    rgb v = cursor->held;
    if (!is_zero(s->slopes[s->count + cursor->function])) {
      const vertex *b = &s->in->all[cursor->next], *a = b - 1;
      v = rgb_lerp(a->v, b->v, (z - a->z) / (b->z - a->z));
    }
    for (int c = 0; c < 3; ++c) compensated_add(&s->value[c], s->in->weights[cursor->function] * v.c[c]);
  }
}

static dsm_result emit(vertices *out, double z, rgb before, rgb after, rgb old_slope, rgb new_slope) {
  int steps = !is_zero(rgb_sub(before, after));
  if (!steps && is_zero(rgb_sub(old_slope, new_slope))) return DSM_OK;
  dsm_result result = vertices_push(out, z, before);
  return result || !steps ? result : vertices_push(out, z, after);
}

/* The value in front of a depth and behind it. Rounding must not make light grow where no function grows,
 * nor make a step or a slope where there is none; `last` is the value at the depth before, `slope` the slope
 * since. */
static void settle(const sweep *s, const rgb *front, rgb slope, rgb last, rgb *before, rgb *after) {
  for (int c = 0; c < 3; ++c) {
    double b = s->rose[c] || s->fell[c] ? front->c[c] : total(&s->value[c]), a;
    if (slope.c[c] <= 0) b = fmin(b, last.c[c]);
    if (slope.c[c] >= 0) b = fmax(b, last.c[c]);
    a = s->rose[c] || s->fell[c] ? total(&s->value[c]) : b;
    before->c[c] = b;
    after->c[c] = s->rose[c] ? a : fmin(a, b);
  }
}

dsm_result average_sweep(const average_input *in, average_scratch *scratch, vertices *out) {
  if (in->count == 0) return DSM_OK;
  if (in->count > scratch->room) {
    average_free(scratch);
    scratch->heap = malloc(in->count * sizeof *scratch->heap);
    scratch->slopes = malloc(2 * (size_t)in->count * sizeof *scratch->slopes);
    if (!scratch->heap || !scratch->slopes) return average_free(scratch), DSM_NO_MEMORY;
    scratch->room = in->count;
  }
  sweep s = {.in = in, .heap = scratch->heap, .slopes = scratch->slopes, .count = in->count};
  start(&s);

  size_t begin = out->count, since = 0;
  double z = 0;
  rgb last = rgb_grey(1), front, before, after;
  dsm_result result = DSM_OK;
  while (!result && s.alive > 0) {
    rgb slope = s.slopes[1];
    double step = s.heap[0].z - z;
    z = s.heap[0].z;
    for (int c = 0; c < 3; ++c) {
      if (slope.c[c] != 0) compensated_add(&s.value[c], slope.c[c] * step);
      front.c[c] = total(&s.value[c]);
      s.rose[c] = s.fell[c] = 0;
    }
    for (; s.alive > 0 && s.heap[0].z == z; ++since) {
      advance(&s, &s.heap[0]);
      if (s.heap[0].next == s.heap[0].end) {
        struct average_cursor finished = s.heap[0];
        s.heap[0] = s.heap[--s.alive];
        s.heap[s.alive] = finished;
      }
      if (s.alive > 1) sift_down(s.heap, s.alive, 0);
    }
    if (since >= s.count || s.alive == 0) {   /* at the end too: what is dark must be exactly 0 */
      sum_afresh(&s, z);
      since = 0;
    }
    settle(&s, &front, slope, last, &before, &after);
    result = emit(out, z, before, after, slope, s.slopes[1]);
    last = after;
  }
  if (result) out->count = begin;
  return result;
}

void average_free(average_scratch *scratch) {
  free(scratch->heap);
  free(scratch->slopes);
  *scratch = (average_scratch){0};
}
