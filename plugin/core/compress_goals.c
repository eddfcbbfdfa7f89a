/* SPDX-License-Identifier: AGPL-3.0-or-later */
/*
 *    roof  ______                    A bundle holds all lines that lead to the end. Where the tunnel bends away from
 *                \  far              the last of them, this line's free part, from its last support to where it
 *      _________  \/                 leaves, is a goal: who reaches it is there with one segment more, and nobody
 *               \ /\ goal            gets there without. So the next bundle holds the lines that lead through the
 *        path --->  \____ near       goal, and so on to the start. Between the ends of a goal a line is on its free
 *                 \ /  floor         side before it has crossed it, and need not be looked at after.
 *
 * Places there are looked at again for the next bundle; their ranges do not overlap, so the whole is O(n).
 * Bundles see depths mirrored here.
 */
#include "core/compress_goals.h"
#include "core/extremes.h"

/* No line passes place k: the goal is the free part of the one that came furthest. */
static chord cut(search *s, size_t k, gate g, double least) {
  const place *from = &s->tunnel.places[k + 1], *to = &s->tunnel.places[k];
  int side = g.high < line_at(&s->lines.fall.line, -to->z) ? ROOF : FLOOR;
  const tangent *last = side == ROOF ? &s->lines.fall : &s->lines.rise;
  double margin = s->lines.level ? 0 : 2 * s->margin;
  point a = {-from->z, from->before}, b = {-to->z, to->after};
  point far = tunnel_exit(&s->tunnel, &last->line, a, b, side, margin, least);
  doubt_steep(s, &last->line, to->z);
  return (chord){{-last->support.z, last->support.y}, {-far.z, far.y}, side};
}

/* The bundle of all lines through the goal, up to its far end, which lies between places k and k + 1. */
static int begin_at_goal(search *s, const chord *goal, size_t k, double least) {
  const tunnel *t = &s->tunnel;
  gate near = gate_near(goal), far = gate_far(goal);
  bundle_begin_at(&s->lines, -goal->near.z, near.low, near.high);
  size_t i = k;
  while (i + 1 < t->count && t->places[i + 1].z < goal->near.z) ++i;
  for (; i > k; --i) {
    gate g = only(goal->side, tunnel_gate(t, i, BEFORE | AFTER, 2 * s->margin, least));
    if (!bundle_pass(&s->lines, -t->places[i].z, g.low, g.high)) return 0;
  }
  return bundle_pass(&s->lines, -goal->far.z, far.low, far.high);
}

static gate gate_back(const search *s, size_t k, int sides, double least) {
  const tunnel *t = &s->tunnel;
  double margin = s->lines.level ? 0 : 2 * s->margin;
  gate g = tunnel_gate(t, k, sides, margin, least);
  if (k == 0 && t->clear > 0) g.low = 1;   /* somewhere up to t->clear it has crossed 1 */
  if (k + 1 == t->count && s->lines.level && t->places[k].after == 0) g.high = 0;
  return g;
}

/* What may follow the wall at place k: of the gate behind it, what lines on the way lead to. */
static void put_wall(search *s, size_t k, double low, double high) {
  double z = s->tunnel.places[k].z;
  s->goals[s->goal_count++] = (chord){{z, low}, {z, high}, WALL};
}

/* One piece between two walls, from place `right` on. Sets its left wall, or 0 for the beginning. */
static int piece_back(search *s, size_t right, double least, size_t *left) {
  const tunnel *t = &s->tunnel;
  int is_last = s->goal_count == 0;
  bundle_begin(&s->lines, is_last);
  if (!is_last && tunnel_steps(t, right - 1)) {   /* a line leads from any value to any other */
    gate g = gate_back(s, right - 1, AFTER, least);
    put_wall(s, right - 1, g.low, g.high);
    *left = right - 1;
    return 1;
  }
  for (size_t k = right;; --k) {
    int wall = tunnel_steps(t, k) && (k < right || is_last), sides = BEFORE | AFTER;
    if (wall) sides = AFTER;
    else if (tunnel_steps(t, k)) sides = BEFORE;
    gate g = gate_back(s, k, sides, least);
    if (!bundle_pass(&s->lines, -t->places[k].z, g.low, g.high)) {
      if (k == right) return 0;
      chord goal = s->goals[s->goal_count++] = cut(s, k, g, least);
      if (!begin_at_goal(s, &goal, k, least)) return 0;
      g = gate_back(s, k, sides, least);
      if (!bundle_pass(&s->lines, -t->places[k].z, g.low, g.high)) return 0;
    }
    *left = k;
    if (!wall && k > 0) continue;
    if (wall) {
      double z = -t->places[k].z;
      put_wall(s, k, greater(g.low, line_at(&s->lines.fall.line, z)), lesser(g.high, line_at(&s->lines.rise.line, z)));
    }
    return 1;
  }
}

int find_goals(search *s) {
  const tunnel *t = &s->tunnel;
  double least = 0;
  for (size_t right = t->count - 1, left;; right = left) {
    if (!piece_back(s, right, least, &left)) return 0;
    if (left == 0 || is_clear_wall(t, left)) return 1;
    least = t->falls ? s->goals[s->goal_count - 1].near.y : 0;
  }
}

