/* SPDX-License-Identifier: AGPL-3.0-or-later */
/*
 * No linear-time optimum is known for three tunnels that share their breaks. This keeps what is good about the one
 * for a single tunnel but breaks at input depths only: each break stands for all values that a path can have
 * there, an interval a channel, and each segment reaches as far as one line in each channel does that begins in
 * those intervals. The values are chosen on the way back, when it is known what has to be reached.
 */
#include "core/compress_colour.h"

#include <stdint.h>
#include <stdlib.h>

#include "core/compress_tunnel.h"
#include "core/extremes.h"

#define MARGIN 1e-12

typedef struct {
  size_t place;
  int behind;         /* a wall's far side; its near side is the break before */
  gate values[3];
} joint;

typedef struct {
  tunnel tunnels[3];
  bundle lines[3];
  joint *joints;
  size_t joint_count;
  gate level[3];      /* values from which the output can stay level to the end, */
  size_t level_from;  /* from this place on */
  double margin;
} job;

static double clamp(double x, double low, double high) { return x < low ? low : x > high ? high : x; }

static int is_wall(const job *j, size_t k) {
  return tunnel_steps(&j->tunnels[0], k) || tunnel_steps(&j->tunnels[1], k) || tunnel_steps(&j->tunnels[2], k);
}

static gate gate_of(const job *j, int c, size_t k, int sides, double margins) {
  return tunnel_gate(&j->tunnels[c], k, sides, margins * j->margin, 0);
}

static void find_level(job *j) {
  size_t k = j->tunnels[0].count;
  for (int c = 0; c < 3; ++c) {
    j->level[c] = (gate){0, 1};
    if (j->tunnels[c].places[k - 1].after == 0) j->level[c].high = 0;
  }
  for (int behind = 1; behind && k > 0;) {
    gate next[3];
    behind = !is_wall(j, --k);
    int passes = 1;
    for (int c = 0; c < 3; ++c) {
      gate g = gate_of(j, c, k, behind ? BEFORE | AFTER : AFTER, 2);
      next[c] = (gate){greater(g.low, j->level[c].low), lesser(g.high, j->level[c].high)};
      passes &= next[c].low <= next[c].high;
    }
    if (!passes) {
      ++k;
      break;
    }
    for (int c = 0; c < 3; ++c) j->level[c] = next[c];
  }
  j->level_from = k;
}

static int ends_level(const job *j, joint *at) {
  if (at->place < j->level_from) return 0;
  joint end = *at;
  for (int c = 0; c < 3; ++c) {
    end.values[c].low = greater(end.values[c].low, j->level[c].low);
    end.values[c].high = lesser(end.values[c].high, j->level[c].high);
    if (end.values[c].low > end.values[c].high) return 0;
  }
  *at = end;
  return 1;
}

static void begin(job *j, const joint *from) {
  j->joints[j->joint_count++] = *from;
  for (int c = 0; c < 3; ++c) {
    bundle_begin(&j->lines[c], 0);
    bundle_pass(&j->lines[c], j->tunnels[c].places[from->place].z, from->values[c].low, from->values[c].high);
  }
}

/* Leads the bundles through place k; 0 leaves them useless. Sets what values its lines have there. */
static int pass(job *j, size_t k, int sides, joint *at) {
  const joint *from = &j->joints[j->joint_count - 1];
  *at = (joint){.place = k};
  for (int c = 0; c < 3; ++c) {
    double z = j->tunnels[c].places[k].z;
    gate g = gate_of(j, c, k, sides, 2);
    if (!bundle_pass(&j->lines[c], z, g.low, g.high)) return 0;
    at->values[c].low = greater(g.low, line_at(&j->lines[c].fall.line, z));
    at->values[c].high = greater(at->values[c].low, lesser(g.high, line_at(&j->lines[c].rise.line, z)));
    if (j->tunnels[c].falls) at->values[c].high = lesser(at->values[c].high, from->values[c].high);
    if (at->values[c].low > at->values[c].high) return 0;
  }
  return 1;
}

/* What may follow a wall whose front is `front`. */
static joint behind_wall(const job *j, const joint *front) {
  joint b = {.place = front->place, .behind = 1};
  for (int c = 0; c < 3; ++c) {
    b.values[c] = gate_of(j, c, front->place, AFTER, 2);
    if (j->tunnels[c].falls) b.values[c].high = lesser(b.values[c].high, front->values[c].high);
  }
  return b;
}

static int find_joints(job *j, size_t first) {
  size_t count = j->tunnels[0].count;
  joint at = {.place = first}, next;
  for (int c = 0; c < 3; ++c) at.values[c] = (gate){1, 1};
  for (size_t k = first + 1;; ++k) {
    int wall = is_wall(j, at.place) && !at.behind;
    if (wall) {
      j->joints[j->joint_count++] = at;
      at = behind_wall(j, &at);
      for (int c = 0; c < 3; ++c)
        if (at.values[c].low > at.values[c].high) return 0;
    }
    if (ends_level(j, &at)) {
      j->joints[j->joint_count++] = at;
      return 1;
    }
    begin(j, &at);
    for (; k < count; ++k) {
      int ends = is_wall(j, k);
      if (!pass(j, k, ends ? BEFORE : BEFORE | AFTER, &next)) break;
      at = next;
      if (ends) break;
      if (ends_level(j, &at)) {
        j->joints[j->joint_count++] = at;
        return 1;
      }
    }
    if (k == count || at.place == j->joints[j->joint_count - 1].place) return 0;
    if (!is_wall(j, k) || at.place != k) --k;   /* not passed: the next segment begins in front of it */
  }
}

/* The value at the joint `from` of a line that ends in y at the joint `to`. */
static double value_back(job *j, int c, const joint *from, const joint *to, double y) {
  const tunnel *t = &j->tunnels[c];
  bundle *b = &j->lines[c];
  gate g = from->values[c];
  if (t->falls) g.low = greater(g.low, y);
  if (from->place == to->place) return clamp(t->places[from->place].before, g.low, greater(g.low, g.high));
  bundle_begin(b, 0);
  bundle_pass(b, -t->places[to->place].z, y, y);
  for (size_t k = to->place - 1; k > from->place; --k) {
    gate between = gate_of(j, c, k, BEFORE | AFTER, 1);
    bundle_pass(b, -t->places[k].z, between.low, between.high);
  }
  double z = -t->places[from->place].z;
  double low = greater(g.low, line_at(&b->fall.line, z)), high = lesser(g.high, line_at(&b->rise.line, z));
  if (low > high) return low;
  return from->behind ? clamp(t->places[from->place].after, low, high) : low + (high - low) / 2;
}

static dsm_result put_joints(job *j, vertices *out) {
  size_t n = j->joint_count, start = out->count;
  for (size_t i = 0; i < n; ++i) {
    dsm_result result = vertices_push(out, j->tunnels[0].places[j->joints[i].place].z, rgb_grey(0));
    if (result) {
      out->count = start;
      return result;
    }
  }
  for (int c = 0; c < 3; ++c) {
    const tunnel *t = &j->tunnels[c];
    const joint *end = &j->joints[n - 1];
    double y = clamp(t->places[t->count - 1].after, end->values[c].low, end->values[c].high);
    out->data[start + n - 1].v.c[c] = y;
    for (size_t i = n - 1; i > 0; --i) {
      y = value_back(j, c, &j->joints[i - 1], &j->joints[i], y);
      out->data[start + i - 1].v.c[c] = y;
    }
  }
  return DSM_OK;
}

dsm_result compress_colour(const vertex *in, size_t count, bounds within, vertices *out, int *lost) {
  size_t most = count + 3, bytes = 3 * (sizeof(place) + 4 * sizeof(point)) + 2 * sizeof(joint);
  char *memory = most > SIZE_MAX / bytes ? NULL : malloc(most * bytes);
  if (!memory) return DSM_NO_MEMORY;
  job j = {.margin = lesser(MARGIN, within.tolerance * 0x1p-20), .joints = (joint *)memory};
  point *points = (point *)(j.joints + 2 * most);
  place *places = (place *)(points + 12 * most);
  int dims = 0;
  size_t clear = SIZE_MAX;
  for (int c = 0; c < 3; ++c) {
    j.lines[c].floor_room = points + 4 * (size_t)c * most;
    j.lines[c].roof_room = j.lines[c].floor_room + 2 * most;
    j.tunnels[c].places = places + (size_t)c * most;
    dims |= tunnel_read(&j.tunnels[c], in, count, c, within, 0);
    if (j.tunnels[c].clear < clear) clear = j.tunnels[c].clear;
    j.tunnels[c].clear = 0;
  }
  dsm_result result = DSM_OK;
  *lost = 0;
  if (dims) {
    int starts_at_wall = is_wall(&j, clear);
    for (int c = 0; c < 3; ++c) starts_at_wall &= 1 - j.tunnels[c].places[clear].before <= within.tolerance;
    find_level(&j);
    *lost = (clear == 0 && !starts_at_wall) || !find_joints(&j, starts_at_wall ? clear : clear - 1);
    if (!*lost) {
      /* The front of a wall that level light reaches need not be said. */
      if (starts_at_wall) {
        ++j.joints;
        --j.joint_count;
      }
      result = put_joints(&j, out);
    }
  }
  free(memory);
  return result;
}
