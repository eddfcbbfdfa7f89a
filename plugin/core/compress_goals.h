/* SPDX-License-Identifier: AGPL-3.0-or-later */
/* The way back of compress_minimal: from the end, which parts of the tunnel lead there with how many segments. */
#ifndef DSM_CORE_COMPRESS_GOALS_H
#define DSM_CORE_COMPRESS_GOALS_H

#include "core/compress_tunnel.h"

/* The side on which a chord leaves the tunnel at its far end. A WALL is upright instead: the values, near to far,
 * that may follow a tall step. */
enum { FLOOR = -1, WALL, ROOF };

/* A piece of a line that the path crosses. It touches the other side of the tunnel at its near end. */
typedef struct {
  point near, far;
  int side;
} chord;

typedef struct {
  tunnel tunnel;
  bundle lines;
  chord *goals;         /* room for two a place; the last one comes first on the way */
  size_t goal_count;
  double margin;        /* goals keep two from the sides of the tunnel, paths one */
  int doubtful;         /* rounding may matter */
} search;

/* 0: lost, because of rounding. */
int find_goals(search *s);

/* Is place k the first wall, reached by the level line at 1? */
static inline int is_clear_wall(const tunnel *t, size_t k) {
  return k == t->clear && tunnel_steps(t, k) && 1 - t->places[k].before <= t->tolerance;
}

/* A line through a chord has crossed it where it comes out on the chord's side, and need pass on that side only. */
static inline gate only(int side, gate g) {
  if (side == ROOF) g.high = HUGE_VAL;
  else g.low = -HUGE_VAL;
  return g;
}

/* What lines that cross a chord pass at its ends. */
static inline gate gate_near(const chord *c) { return only(c->side, (gate){c->near.y, c->near.y}); }
static inline gate gate_far(const chord *c) { return only(-c->side, (gate){c->far.y, c->far.y}); }

/* A line so steep that a rounded depth shifts its value by more than the margin allows. */
static inline void doubt_steep(search *s, const line *l, double z) {
  if (!(fabs(l->slope * z) * 0x1p-52 <= s->margin / 8)) s->doubtful = 1;
}

#endif
