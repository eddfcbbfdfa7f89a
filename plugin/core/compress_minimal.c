/* SPDX-License-Identifier: AGPL-3.0-or-later */
/*
 * The fewest vertices within a tolerance: a minimum-link path in the tunnel around the input (Imai & Iri 1986;
 * Suri 1986; Guibas et al. 1991), in linear time.
 *
 *      1 ----.  origin               First backwards, to find the goals (compress_goals.c): what each segment has to
 *             \\\                     cross so that the rest can be done with as few segments as possible. Then
 *              \ \ \  bundle         forwards, here: each segment is a line from the middle of the bundle that
 *             --\--\--\-- goal       leaves the segment before and passes its goal. What a path has in hand is
 *                \  \  \            shared among the segments to come: each looks further ahead than its goal, but
 *                                   not so far as it could get.
 *
 * A tall step is a wall. What can follow it with the fewest segments is an interval of values; nobody needs to
 * pay a segment in front of the wall for a better start behind it, because one segment more makes good any start.
 *
 * Goals are found in a tunnel that is narrower by two margins, paths in one narrower by one, so that depths and
 * values can be rounded. That is not enough where lines are steep, or where a line is known by two points that nearly coincide, a short
 * goal's ends for one: so the result is checked.
 */
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "core/compress.h"
#include "core/compress_colour.h"
#include "core/compress_goals.h"
#include "core/extremes.h"

#define MARGIN 1e-10            /* so wide that rounding matters only to lines as steep as 5e4 over their depth */
#define LEAST_TOLERANCE 1e-12   /* below, rounding is all */
#define PASSABLE 1.99           /* of the tolerance: a step that a line can pass */
#define STEP_ROUNDING 4e-16     /* of a step that is the difference of two averages */
#define ALL SIZE_MAX

typedef struct {
  search search;
  vertices *out;
  double value, depth;   /* of the last vertex */
} job;

static double clamp(double x, double low, double high) { return x < low ? low : x > high ? high : x; }

/* The start of a segment: a point behind a wall, or the free part of the segment before (near its goal first). */
typedef struct {
  chord from;
  line line;      /* of the segment before */
  size_t place;   /* the first one behind from.near */
} origin;

/* A piece on the way: between two walls, or the beginning or the end. */
typedef struct {
  size_t right;
  int ends_at_wall;
  size_t links;      /* segments to come */
  double least;      /* what follows needs that much */
} piece;

static void put(job *j, dsm_result *result, double z, double y) {
  y = clamp(y, 0, 1);
  if (j->search.tunnel.falls) y = lesser(y, j->value);
  /* Depths that rounding made the same. Only the value behind a wall is meant to stand where another does. */
  if (!(z > j->depth)) j->search.doubtful = 1;
  if (!*result) *result = vertices_push(j->out, z, rgb_grey(y));
  j->value = y;
  j->depth = z;
}

static gate gate_ahead(const job *j, const piece *p, size_t k) {
  const tunnel *t = &j->search.tunnel;
  int sides = k == p->right && p->ends_at_wall ? BEFORE : BEFORE | AFTER;
  gate g = tunnel_gate(t, k, sides, j->search.margin, p->least);
  if (!p->ends_at_wall && k + 1 == t->count && t->places[k].after == 0) g.high = 0;
  return g;
}

/* What a bundle is led through: all places up to `stop`, or as far as the goal only, which asks less of a line. */
typedef struct {
  const chord *goal;   /* NULL: the wall or the end */
  size_t stop;
  int beyond;
  size_t passed;       /* set: the first place behind the goal, if it was reached, or ALL */
  line first;          /* and a line from the middle of the bundle so far */
} target;

/* The bundle of lines from the origin to the target. Returns the first place that it does not pass, or ALL. */
static size_t look_ahead(job *j, const piece *p, const origin *o, target *to) {
  const place *places = j->search.tunnel.places;
  const chord *from = &o->from, *crossed = to->beyond ? NULL : to->goal;
  /* The ends of chords to pass, by depth; a goal that begins in front of the origin is crossed from there. */
  struct { double z; gate gate; } ends[3];
  int count = 0, next = 0;
  if (from->side != WALL) ends[count].z = from->far.z, ends[count++].gate = gate_far(from);
  if (crossed && crossed->far.z > from->near.z) {
    int i = count++;
    if (i && crossed->far.z < ends[0].z) ends[1] = ends[0], i = 0;
    ends[i].z = crossed->far.z, ends[i].gate = gate_far(crossed);
  }
  if (to->goal) ends[count].z = to->goal->near.z, ends[count++].gate = gate_near(to->goal);

  gate begin = from->side == WALL ? (gate){from->near.y, from->near.y} : gate_near(from);
  bundle_begin_at(&j->search.lines, from->near.z, begin.low, begin.high);
  to->passed = ALL;
  for (size_t k = o->place;; ++k) {
    double z = k <= to->stop ? places[k].z : HUGE_VAL;
    for (; next < count && ends[next].z <= z; ++next)
      if (!bundle_pass(&j->search.lines, ends[next].z, ends[next].gate.low, ends[next].gate.high)) return k;
    if (k > to->stop || (crossed && next == count)) return ALL;
    gate g = gate_ahead(j, p, k);
    if (z < from->far.z) g = only(from->side, g);   /* not behind a wall, which has no extent */
    if (crossed && z > crossed->far.z) g = only(crossed->side, g);
    if (!bundle_pass(&j->search.lines, z, g.low, g.high)) return k;
    if (next < count || to->passed != ALL) continue;
    to->passed = k;
    to->first = bundle_middle(&j->search.lines, j->search.tunnel.falls ? 0 : HUGE_VAL);
  }
}

/* Where lines of the bundle that end at z may be, and of those the nearest to the true value. */
static double aim(const job *j, double z, double y) {
  const bundle *b = &j->search.lines;
  double low = line_at(&b->fall.line, z), high = line_at(&b->rise.line, z);
  if (j->search.tunnel.falls && b->rise.line.slope > 0) {
    double bottom;
    bundle_heights(b, 0, z, &bottom, &high);
  }
  return clamp(y, low, greater(low, high));
}

/* A line from the origin that passes `goal`, or reaches the wall or the end if it is NULL. */
static int choose(job *j, const piece *p, const origin *o, const chord *goal, line *l) {
  const tunnel *t = &j->search.tunnel;
  bundle *b = &j->search.lines;
  double steepest = t->falls ? 0 : HUGE_VAL;
  target to = {goal, p->right, 1, ALL, {{0, 0}, 0}};
  if (goal && p->links == 1) {
    for (to.stop = o->place; to.stop < p->right && t->places[to.stop].z < goal->near.z;) ++to.stop;
  }
  size_t blocked = look_ahead(j, p, o, &to);
  if (goal && to.passed == ALL) {
    to.beyond = 0;
    if (look_ahead(j, p, o, &to) != ALL) return 0;
    *l = bundle_middle(b, steepest);
  } else if (p->links == 1) {
    if (blocked != ALL) return 0;
    if (!goal || t->falls) {
      const place *end = &t->places[to.stop];
      gate g = gate_ahead(j, p, to.stop);
      double y = aim(j, end->z, clamp(p->ends_at_wall ? end->before : t->places[p->right].after, g.low, g.high));
      bundle_pass(b, end->z, y, y);
    }
    *l = bundle_middle(b, steepest);
  } else if (!goal) {
    return 0;
  } else {
    /* Between a line that just passes the goal and one that comes as far as can be: an equal share of what is in
     * hand for each segment to come. */
    double share = 1 - 1 / (double)p->links;
    *l = bundle_middle(b, steepest);
    l->at.y += (1 - share) * (line_at(&to.first, l->at.z) - l->at.y);
    l->slope += (1 - share) * (to.first.slope - l->slope);
  }
  doubt_steep(&j->search, l, t->places[p->right].z);
  return 1;
}

/* How deep a line meets that of a chord, between its ends. */
static double meeting(const line *l, point a, point b) {
  double before = line_at(l, a.z) - a.y, after = line_at(l, b.z) - b.y;
  if (before == after) return a.z;
  double z = a.z + clamp(before / (before - after), 0, 1) * (b.z - a.z);
  return clamp(z, lesser(a.z, b.z), greater(a.z, b.z));
}

/* The free part of a line from where it crosses the goal. */
static origin leave(const job *j, const piece *p, const line *l, const chord *goal, size_t k) {
  const tunnel *t = &j->search.tunnel;
  double z = meeting(l, goal->far, goal->near);
  while (k <= p->right && t->places[k].z <= z) ++k;
  origin o = {.from = {{z, line_at(l, z)}, {z, line_at(l, z)}, ROOF}, .line = *l, .place = k};
  for (; k <= p->right; ++k) {
    gate g = gate_ahead(j, p, k);
    const place *q = &t->places[k];
    double y = line_at(l, q->z);
    o.from.far = (point){q->z, y};
    if (g.low <= y && y <= g.high) continue;
    o.from.side = y > g.high ? ROOF : FLOOR;
    point start = {q[-1].z, q[-1].after};
    if (start.z < z) start = (point){z, start.y + (q->before - start.y) * ((z - start.z) / (q->z - start.z))};
    o.from.far = tunnel_exit(t, l, start, (point){q->z, q->before}, o.from.side, j->search.margin, p->least);
    break;
  }
  return o;
}

/* The vertex where two segments meet, on the free part of the first. */
static void put_meeting(job *j, dsm_result *result, const origin *o, const line *l) {
  double z = meeting(l, o->from.near, o->from.far);
  put(j, result, z, line_at(fabs(l->slope) < fabs(o->line.slope) ? l : &o->line, z));
}

/* The last vertex, from where the output stays level: the true value as far as the segment gets there. */
static void put_end(job *j, dsm_result *result, const origin *o, const chord *goal) {
  const tunnel *t = &j->search.tunnel;
  const point *a = &o->from.near, *b = &o->from.far;
  double y = goal->near.y, z = a->z;
  if (t->falls && b->y < a->y) {
    y = t->places[t->count - 1].after;
    y = y == 0 ? 0 : clamp(y, b->y, a->y);
    z = meeting(&(line){*a, (b->y - a->y) / (b->z - a->z)}, (point){a->z, y}, (point){b->z, y});
  }
  put(j, result, z, y);
}

static dsm_result walk(job *j, int *lost) {
  const tunnel *t = &j->search.tunnel;
  dsm_result result = DSM_OK;
  size_t left = 0, k;
  origin o = {.from = {{t->places[0].z, 1}, {t->places[t->clear].z, 1}, ROOF}, .line = {{0, 1}, 0}, .place = 1};
  if (is_clear_wall(t, t->clear)) left = t->clear;
  for (int first = 1;; first = 0) {
    if (!first || is_clear_wall(t, left)) {
      const chord *w = &j->search.goals[--j->search.goal_count];
      double y = t->places[left].after, high = t->falls ? lesser(w->far.y, j->value) : w->far.y;
      point behind = {t->places[left].z, lesser(high, greater(w->near.y, y))};
      j->depth = -HUGE_VAL;
      put(j, &result, behind.z, behind.y);
      o = (origin){.from = {behind, behind, WALL}, .place = left + 1};
    }
    piece p = {.right = left};
    while (++p.right < t->count && !tunnel_steps(t, p.right)) continue;
    p.ends_at_wall = p.right < t->count;
    if (!p.ends_at_wall) p.right = t->count - 1;
    for (k = j->search.goal_count; k > 0 && j->search.goals[k - 1].side != WALL; --k) ++p.links;
    p.links += (size_t)p.ends_at_wall;
    if (p.ends_at_wall && t->falls) p.least = j->search.goals[k - 1].near.y;

    if (o.from.side == WALL && p.ends_at_wall && p.right == left + 1) {   /* no need to look for a line */
      gate g = gate_ahead(j, &p, p.right);
      put(j, &result, t->places[p.right].z, clamp(t->places[p.right].before, g.low, g.high));
      p.links = 0;
    }
    for (; p.links > 0 && !result; --p.links) {
      const chord *goal = p.links == 1 && p.ends_at_wall ? NULL : &j->search.goals[--j->search.goal_count];
      line l;
      if (!choose(j, &p, &o, goal, &l)) {
        *lost = 1;
        return result;
      }
      if (o.from.side != WALL) put_meeting(j, &result, &o, &l);
      if (goal) {
        o = leave(j, &p, &l, goal, o.place);
        if (p.links == 1) put_end(j, &result, &o, goal);
      } else {
        gate g = gate_ahead(j, &p, p.right);
        put(j, &result, t->places[p.right].z, clamp(line_at(&l, t->places[p.right].z), g.low, g.high));
      }
    }
    if (result || !p.ends_at_wall) return result;
    left = p.right;
  }
}

/* Where rounding matters, or channels share their depths, the greedy's result can be shorter, or the only one. */
static dsm_result compete_with_greedy(const vertex *in, size_t count, int channels, bounds within, vertices *out,
                                      size_t start, int lost) {
  size_t middle = out->count, mine = middle - start;
  dsm_result result = greedy_within(in, count, channels, within, lost ? SIZE_MAX : mine, out);
  size_t theirs = out->count - middle;
  out->count = result ? start : middle;
  if (result || (!lost && mine <= theirs)) return result;
  memmove(out->data + start, out->data + middle, theirs * sizeof(vertex));
  out->count = start + theirs;
  return DSM_OK;
}

static dsm_result compress_in(char *memory, size_t most, const vertex *in, size_t count, bounds within, vertices *out, int *lost,
                              int *doubtful) {
  size_t start = out->count;
  job j = {.out = out, .value = 1, .depth = -HUGE_VAL};
  search *s = &j.search;
  s->margin = lesser(MARGIN, within.tolerance * 0x1p-20);
  s->goals = (chord *)(void *)memory;
  s->tunnel.places = (place *)(s->goals + 2 * most);
  s->lines.floor_room = (point *)(s->tunnel.places + most);
  s->lines.roof_room = s->lines.floor_room + 2 * most;

  dsm_result result = DSM_OK;
  if (tunnel_read(&s->tunnel, in, count, 0, within, 1)) {
    s->doubtful = tunnel_steepness(&s->tunnel) * 0x1p-52 > s->margin / 8;
    *lost = !find_goals(s);
    if (!*lost) result = walk(&j, lost);
    if (!*lost && !result) *lost = !tunnel_holds(&s->tunnel, out->data + start, out->count - start);
  }
  *doubtful = s->doubtful;
  if (*lost || result) out->count = start;
  return result;
}

static dsm_result compress_grey(const vertex *in, size_t count, bounds within, vertices *out, int *lost,
                                int *doubtful) {
  enum { BYTES = sizeof(place) + 4 * sizeof(point) + 2 * sizeof(chord), FEW = 48 };
  _Alignas(chord) char few[FEW * BYTES];   /* what 16 rays meet needs no allocation */
  size_t most = count + 3;
  char *memory = most <= FEW ? few : most > SIZE_MAX / BYTES ? NULL : malloc(most * BYTES);
  if (!memory) return DSM_NO_MEMORY;
  dsm_result result = compress_in(memory, most, in, count, within, out, lost, doubtful);
  if (memory != few) free(memory);
  return result;
}

dsm_result compress_minimal_after(const vertex *in, size_t count, int channels, double tolerance, double spent,
                                  vertices *out) {
  double rest = greater(0, tolerance - spent);
  bounds within = {rest, lesser(spent > 0 ? tolerance + STEP_ROUNDING : tolerance, PASSABLE * rest)};
  if (rest < LEAST_TOLERANCE) return compress_greedy(in, count, channels, rest, out);
  size_t start = out->count;
  int lost = 0, doubtful = channels > 1;
  dsm_result result = channels > 1 ? compress_colour(in, count, within, out, &lost)
                                   : compress_grey(in, count, within, out, &lost, &doubtful);
  if (result || !(lost || doubtful)) return result;
  return compete_with_greedy(in, count, channels, within, out, start, lost);
}

dsm_result compress_minimal(const vertex *in, size_t count, int channels, double tolerance, vertices *out) {
  return compress_minimal_after(in, count, channels, tolerance, 0, out);
}
