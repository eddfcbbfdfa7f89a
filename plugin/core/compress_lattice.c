/* SPDX-License-Identifier: AGPL-3.0-or-later */
/*
 *   - - - - - \ - - - - - - - - -    a value that can be stored
 *              \
 *       given   o__                  A vertex that slides along one of its segments to such a value changes the other segment
 *                 \---__             alone, and by less than rounding it would: the more alike the two slopes, the less.
 *   - - - - - - - -\- - ---x__- -    another
 *
 * So vertices are first made in a tunnel that is only a little narrower than all of it. Then each has a few places to go to, and a
 * row of places that stays in the whole tunnel is found from front to back: which places of a vertex can be reached
 * depends on those of the one before alone.
 */
#include "core/compress_lattice.h"

#include <math.h>
#include <stdlib.h>

#include "core/compress.h"
#include "core/extremes.h"
#include "core/rounding.h"

#define ROUNDING 4e-16

/* Of the sites of a vertex that can be reached. */
enum { ENOUGH = 2 };

/* How much of the room for any rounding is left, in turn, until there is a way. */
static const double ROOM[] = {0.25, 0.5};

/* All of the input at one depth, and what the output may be there where it does not step. */
typedef struct { double z, before, after, low, high; } spot;

/* Where a vertex may go. */
typedef struct {
  double z, y;
  size_t next;       /* the first spot that is not in front of it */
  int from;          /* a site of the vertex before */
} site;

typedef struct { site sites[ENOUGH]; int count; } stop;

typedef struct {
  spot *spots;
  size_t count;
  double reach;      /* how far the output may be off */
  double most;       /* the value 1 in units of the lattice */
  double low, high;  /* of values that can stay level */
  size_t end_from;   /* from this spot on */
} lattice;

static void read_spots(lattice *l, const vertex *in, size_t count) {
  double v = 1;
  l->count = 0;
  for (size_t i = 0; i < count; ++i) {
    spot *s = &l->spots[l->count++];
    s->z = in[i].z;
    s->before = i ? lesser(1, greater(0, in[i].v.c[0])) : v;
    while (i + 1 < count && in[i + 1].z == s->z) ++i;
    v = s->after = lesser(1, greater(0, in[i].v.c[0]));
    s->low = greater(s->before, s->after) - l->reach;
    s->high = lesser(s->before, s->after) + l->reach;
  }
}

/* The first spot that is not in front of z, near spot k. */
static size_t spot_at(const lattice *l, double z, size_t k) {
  while (k > 0 && l->spots[k - 1].z >= z) --k;
  while (k < l->count && l->spots[k].z < z) ++k;
  return k;
}

enum { FRONT = 1, BACK = 2 };   /* of a spot: on which side the output is to be right */

static int is_right(const lattice *l, const site *s, int sides) {
  const spot *b = &l->spots[s->next], *a = b - 1;
  if (s->next < l->count && b->z == s->z)
    return (!(sides & FRONT) || fabs(s->y - b->before) <= l->reach) && (!(sides & BACK) || fabs(s->y - b->after) <= l->reach);
  double y = s->next == 0 ? 1 : a->after;
  if (s->next > 0 && s->next < l->count) y += (b->before - y) * ((s->z - a->z) / (b->z - a->z));
  return fabs(s->y - y) <= l->reach;
}

/* Whether the line from a to b is right between them. */
static int passes(const lattice *l, const site *a, const site *b) {
  const spot *k = &l->spots[a->next], *end = &l->spots[b->next];
  double slope = (b->y - a->y) / (b->z - a->z);
  for (k += k < end && k->z == a->z; k < end; ++k) {
    double y = a->y + slope * (k->z - a->z);
    if (y < k->low || y > k->high) return 0;
  }
  return 1;
}

/* Whether the output can stay level behind the last vertex. */
static int ends(const lattice *l, const site *s) {
  for (size_t k = s->next; k < l->end_from; ++k)
    if (l->spots[k].z > s->z && (s->y < l->spots[k].low || s->y > l->spots[k].high)) return 0;
  return l->low <= s->y && s->y <= l->high;
}

/* What is level behind depth z. */
static void find_end(lattice *l, double z) {
  size_t k = l->count;
  l->low = 0;
  l->high = 1;
  for (; k > 0 && l->spots[k - 1].z > z; --k) {
    l->low = greater(l->low, l->spots[k - 1].low);
    l->high = lesser(l->high, l->spots[k - 1].high);
  }
  l->end_from = k;
}

typedef struct { const vertex *v; size_t count, i; } given;

static int steps_before(const given *g) { return g->i > 0 && g->v[g->i - 1].z == g->v[g->i].z; }
static int steps_behind(const given *g) { return g->i + 1 < g->count && g->v[g->i + 1].z == g->v[g->i].z; }

/* Whether a site can be reached from one of the vertex before, and lies in the tunnel itself. */
static int reach(const lattice *l, const given *g, const stop *before, site *s) {
  int step = steps_before(g), sides = step ? BACK : steps_behind(g) ? FRONT : FRONT | BACK;
  if (g->i == 0 && s->y < 1) sides = BACK;   /* a step from 1, the near side of which is not stored */
  if (!is_right(l, s, sides)) return 0;
  if (g->i + 1 == g->count && !ends(l, s)) return 0;
  if (g->i == 0) return 1;
  int falls = g->v[g->i].v.c[0] <= g->v[g->i - 1].v.c[0];
  for (s->from = 0; s->from < before->count; ++s->from) {
    const site *a = &before->sites[s->from];
    if ((falls && s->y > a->y) || (step ? s->z != a->z : !(s->z > a->z))) continue;
    if (step || passes(l, a, s)) return 1;
  }
  return 0;
}

/* The depth at which the line through two given vertices has the value y; NAN if it has not. */
static double crossing(const vertex *a, const vertex *b, double y) {
  double fall = a->v.c[0] - b->v.c[0];
  return fall == 0 ? NAN : a->z + (a->v.c[0] - y) / fall * (b->z - a->z);
}

/* Finds the sites of a vertex that can be reached. */
static void find_sites(const lattice *l, const given *g, const stop *before, size_t near, stop *out) {
  const vertex *v = &g->v[g->i];
  double exact = v->v.c[0] * l->most, nearest = floor(exact + 0.5), other = exact < nearest ? nearest - 1 : nearest + 1;
  const double values[2] = {nearest / l->most, other / l->most};
  int slides = g->i > 0 && !steps_before(g) && !steps_behind(g), on_it = fabs(exact - nearest) < 1e-9;
  out->count = 0;
  for (int line = 0; line < 3; ++line)   /* to the next vertex, from the one before, and neither */
    for (int k = 0; k < (on_it ? 1 : 2) && out->count < ENOUGH; ++k) {
      double z = v->z;
      if (line < 2 && (on_it || !slides || (line == 0 && g->i + 1 == g->count))) continue;
      if (line < 2) z = crossing(v - line, v - line + 1, values[k]);
      site s = {z, values[k], 0, 0};
      if (!(l->spots[0].z <= z && z <= l->spots[l->count - 1].z && values[k] >= 0 && values[k] <= 1)) continue;
      s.next = spot_at(l, z, near);
      if (reach(l, g, before, &s)) out->sites[out->count++] = s;
    }
}

/* Moves all vertices to the lattice. 0: there is no way; nothing has moved. */
static int move(lattice *l, stop *stops, vertex *v, size_t count) {
  size_t near = 0;
  given g = {v, count, 0};
  find_end(l, v[count - 1].z);
  for (; g.i < count; ++g.i) {
    near = spot_at(l, v[g.i].z, near);
    find_sites(l, &g, g.i ? &stops[g.i - 1] : NULL, near, &stops[g.i]);
    if (stops[g.i].count == 0) return 0;
  }
  int from = 0;
  for (size_t i = count; i-- > 0;) {
    const site *s = &stops[i].sites[from];
    v[i] = (vertex){s->z, rgb_grey(s->y)};
    from = s->from;
  }
  return 1;
}

/* Compresses and moves, with so much room for rounding; *found 0: there is no way. */
static dsm_result try_room(lattice *l, const vertex *in, size_t count, double tolerance, double spent, double room, vertices *out,
                           int *found) {
  size_t start = out->count;
  dsm_result result = compress_minimal_after(in, count, 1, tolerance, spent + room, out);
  size_t made = out->count - start;
  *found = !result && made == 0;
  if (result || made == 0) return result;
  stop *stops = malloc(made * sizeof *stops);
  if (stops) *found = move(l, stops, out->data + start, made);
  if (!*found) out->count = start;
  free(stops);
  return stops ? DSM_OK : DSM_NO_MEMORY;
}

dsm_result compress_rounded(const vertex *in, size_t count, int channels, double tolerance, double spent, uint32_t value_bits,
                            vertices *out) {
  double most = rounding_of_bits(value_bits), whole = tolerance - spent - VALUE_ROUNDING;
  dsm_result result = DSM_OK;
  int found = 0;
  if (channels == 1 && value_bits < VALUE_BITS && whole > most && count > 0) {
    lattice l = {.spots = malloc(count * sizeof(spot)), .reach = whole + ROUNDING, .most = (double)((1u << value_bits) - 1)};
    if (!l.spots) return DSM_NO_MEMORY;
    read_spots(&l, in, count);
    for (size_t i = 0; i < sizeof ROOM / sizeof *ROOM && !result && !found; ++i)
      result = try_room(&l, in, count, tolerance, spent, VALUE_ROUNDING + ROOM[i] * (most - VALUE_ROUNDING), out, &found);
    free(l.spots);
  }
  return result || found ? result : compress_minimal_after(in, count, channels, tolerance, spent + most, out);
}
