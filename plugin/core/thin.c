/* SPDX-License-Identifier: AGPL-3.0-or-later */
#include "core/thin.h"

#include "core/extremes.h"

/* All lines from the vertex `from` that pass the vertices behind it, up to the one at hand. */
typedef struct {
  const vertex *from;
  double low[3], high[3];      /* slopes */
  double least, most;          /* of the noise behind `from` and all that are passed */
} fan;

static void begin(fan *f, const vertex *from, double noise) {
  f->from = from;
  f->least = f->most = noise;
  for (int c = 0; c < 3; ++c) {
    f->low[c] = -HUGE_VAL;
    f->high[c] = HUGE_VAL;
  }
}

/* Can the line from f->from to `next` stand for `here`, which is between? Narrows the fan if so. */
static int passes(fan *f, const vertex *here, const vertex *next, double noise, double slack) {
  double run = here->z - f->from->z, all = next->z - f->from->z;
  double least = lesser(f->least, noise), most = greater(f->most, noise);
  if (!(run > 0 && next->z > here->z) || most > 2 * least) return 0;
  for (int c = 0; c < 3; ++c) {
    double y = f->from->v.c[c], slope = (next->v.c[c] - y) / all;
    f->low[c] = greater(f->low[c], (here->v.c[c] - slack - y) / run);
    f->high[c] = lesser(f->high[c], (here->v.c[c] + slack - y) / run);
    if (!(f->low[c] <= slope && slope <= f->high[c])) return 0;
  }
  f->least = least;
  f->most = most;
  return 1;
}

void thin_vertices(vertices *list, double *noise, double slack) {
  if (list->count < 3 || !(slack > 0)) return;
  vertex *v = list->data;
  size_t kept = 1;
  fan f;
  begin(&f, &v[0], noise ? noise[0] : 0);
  for (size_t i = 1; i < list->count; ++i) {
    double here = noise ? noise[i] : 0;
    if (i + 1 < list->count && passes(&f, &v[i], &v[i + 1], here, slack)) continue;
    if (noise) noise[kept - 1] = f.most;
    v[kept] = v[i];
    if (noise) noise[kept] = here;
    begin(&f, &v[kept++], here);
  }
  if (noise) noise[kept - 1] = f.most;
  list->count = kept;
}
