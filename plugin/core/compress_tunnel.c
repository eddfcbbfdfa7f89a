/* SPDX-License-Identifier: AGPL-3.0-or-later */
#include "core/compress_tunnel.h"
#include "core/extremes.h"

#include <stdint.h>

#define ROUNDING 4e-16

static double clamp(double x, double low, double high) { return x < low ? low : x > high ? high : x; }

static double mix(double z, const place *a, const place *b) {
  return a->after + (b->before - a->after) * ((z - a->z) / (b->z - a->z));
}

/* Puts a place where the input is down to 1 - tolerance between its last place and p, if a depth lies there. */
static int put_clear_end(tunnel *t, const place *p) {
  const place *a = &t->places[t->count - 1];
  double z = a->z + (p->z - a->z) * ((a->after - (1 - t->tolerance)) / (a->after - p->before));
  if (1 - mix(z, a, p) > t->tolerance + ROUNDING) z = nextafter(z, a->z);   /* a steep ramp, a rounded depth */
  double v = mix(z, a, p);
  if (!(z > a->z && z < p->z) || 1 - v > t->tolerance + ROUNDING) return 0;
  t->places[t->count++] = (place){z, v, v};
  return 1;
}

int tunnel_read(tunnel *t, const vertex *in, size_t count, int channel, bounds within, int split) {
  double tolerance = within.tolerance;
  t->count = 0;
  t->tolerance = tolerance;
  t->tall = within.tall;
  t->falls = 1;
  t->clear = SIZE_MAX;
  int clear = 1;
  double v = 1;
  for (size_t i = 0; i < count;) {
    size_t last = i;
    while (last + 1 < count && in[last + 1].z == in[i].z) ++last;
    place p = {in[i].z, i == 0 ? 1 : clamp(in[i].v.c[channel], 0, 1), clamp(in[last].v.c[channel], 0, 1)};
    i = last + 1;
    t->falls &= p.before <= v && p.after <= p.before;
    v = p.after;
    if (clear && (1 - p.before > tolerance || 1 - p.after > tolerance)) {
      clear = 0;
      t->clear = split && 1 - p.before > tolerance && put_clear_end(t, &p) ? t->count - 1 : t->count;
    }
    t->places[t->count++] = p;
  }
  return !clear;
}

point tunnel_exit(const tunnel *t, const line *l, point a, point b, int side, double margin, double least) {
  double reach = side * (t->tolerance - margin), limit = side > 0 ? 1 : least;
  double ya = line_at(l, a.z), yb = line_at(l, b.z), first = 1;
  /* The wall runs along the input, but never beyond the limit. */
  double room[2][2] = {{side * (a.y + reach - ya), side * (b.y + reach - yb)},
                       {side * (limit - ya), side * (limit - yb)}};
  for (int i = 0; i < 2; ++i)
    if (room[i][1] < 0) first = lesser(first, greater(0, room[i][0]) / (greater(0, room[i][0]) - room[i][1]));
  double z = first < 1 ? a.z + first * (b.z - a.z) : b.z;
  return (point){z, line_at(l, z)};
}

double tunnel_steepness(const tunnel *t) {
  double most = 0;
  for (size_t k = 1; k < t->count; ++k) {
    const place *a = &t->places[k - 1], *b = a + 1;
    double fall = a->after - b->before, z = b->z > -a->z ? b->z : -a->z;
    if (fabs(fall) * z > most * (b->z - a->z)) most = fabs(fall) * z / (b->z - a->z);
  }
  return most;
}

/* The output in front of z; `i` is its first vertex at or behind z. */
static double front(const vertex *out, size_t count, size_t i, double z) {
  if (i == 0) return 1;
  const vertex *a = &out[i - 1], *b = a + 1;
  if (i == count) return a->v.c[0];
  return b->z == z ? b->v.c[0] : a->v.c[0] + (b->v.c[0] - a->v.c[0]) * ((z - a->z) / (b->z - a->z));
}

int tunnel_holds(const tunnel *t, const vertex *out, size_t count) {
  double most = t->tolerance + ROUNDING;
  size_t i = 0;
  for (size_t k = 0; k < t->count; ++k) {
    const place *p = &t->places[k];
    for (; i < count && out[i].z < p->z; ++i) {
      if (i && !(out[i].z >= out[i - 1].z)) return 0;
      if (i && out[i].z == out[i - 1].z && !(k && out[i].z == p[-1].z && tunnel_steps(t, k - 1))) return 0;
      if (k && out[i].z > p[-1].z && fabs(out[i].v.c[0] - mix(out[i].z, p - 1, p)) > most) return 0;
    }
    double before = front(out, count, i, p->z), after = before;
    size_t here = 0;
    for (; i + here < count && out[i + here].z == p->z; ++here) after = out[i + here].v.c[0];
    if (fabs(before - p->before) > most || fabs(after - p->after) > most) return 0;
    if (here > 1 + (size_t)tunnel_steps(t, k)) return 0;
  }
  return 1;
}
