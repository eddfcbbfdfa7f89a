/* SPDX-License-Identifier: AGPL-3.0-or-later */
#include "bake/tile_need.h"

#include <math.h>
#include <stdlib.h>

/* Depths at which pixels are compared: so many evenly apart, as many that have the same number of vertices between them, and
 * behind everything. */
enum { EVEN = 8, RANKED = 8, DEPTHS = EVEN + RANKED + 1, MOST_RANKED = 512 };

/* A bend b of three pixels in a row is an error of about b / sqrt(8): where a step between two values lies in a pixel, what
 * interpolation misses, and what the bends of that pixel and its neighbours add up to, have this ratio. */
static const double SQUARED_BENDS = 8;

/* As for the noise: of the root mean square over a picture, what is bent may have more. */
static const double BEND_SHARE = 4;

/* Of the variance that noise is thought to have. A few rays that an edge parts look as if they knew nothing of each other, though they
 * are stratified: the rest of what they bend is taken for an edge. */
static const double NOISE_KNOWN = 0.1;

/* Of the squared bend: what bends where rays meet volumes alone is no edge but a curve, or chance, as one ray tells little of a pixel. */
static const double SMOOTH = 8;

/* Lines of few pixels may bend by so many times the aim, root mean square. An eighth of that is missed between them; a step less than as
 * high is taken for a curve. Less where it is seen on a ground, as a shadow's rim. */
static const double SPARSE_BEND = 16;
static const double GROUND_BEND = 6;

/* Pixel widths by which a surface may stand out of the line through its neighbours (measured: with more, fluted columns of scenes/parallel_light.pov
 * are missed). Planes do so by chance where light meets them at more than about 45 degrees, as rays lie anywhere in their pixels. */
static const double ROUGH = 1;

/* What that counts as, in units of what is let pass: enough for all of a finer level, also as a mean with eight neighbours of no need. */
static const double ROUGH_ERROR = 50;

/* Less light than this behind everything: the last surface is opaque, a ground on which shadows are seen. */
static const double DARK = 0.02;

/* Pixel widths in front of it: the slanted ground itself takes about one. */
static const double ABOVE_GROUND[] = {1.5, 3, 6};
enum { HEIGHTS = sizeof ABOVE_GROUND / sizeof *ABOVE_GROUND };

/* The bounds of visibility around one depth, of all pixels, in one channel. */
typedef struct { double low[TILE_PIXELS], high[TILE_PIXELS]; } layer;

static int compare(const void *a, const void *b)
{
  double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

/* Depths to compare at; returns how many. */
static uint32_t choose_depths(const baked_pixel pixels[TILE_PIXELS], const vertices *stored, double depths[DEPTHS])
{
  double near_depth = INFINITY, far_depth = -INFINITY, ranked[MOST_RANKED];
  size_t count = 0, taken = 0, seen = 0;
  for (uint32_t i = 0; i < TILE_PIXELS; i++)
    count += pixels[i].count;
  if (count == 0)
    return 0;
  size_t stride = (count + MOST_RANKED - 1) / MOST_RANKED;
  for (uint32_t i = 0; i < TILE_PIXELS; i++)
    for (size_t k = 0; k < pixels[i].count; k++, seen++) {
      double z = stored->data[pixels[i].first + k].z;
      near_depth = fmin(near_depth, z);
      far_depth = fmax(far_depth, z);
      if (seen % stride == 0)
        ranked[taken++] = z;
    }
  qsort(ranked, taken, sizeof *ranked, compare);
  for (uint32_t k = 0; k < EVEN; k++)
    depths[k] = near_depth + (far_depth - near_depth) * (k + 0.5) / EVEN;
  for (uint32_t k = 0; k < RANKED; k++)
    depths[EVEN + k] = ranked[(size_t)((k + 0.5) / RANKED * (double)taken)];
  depths[EVEN + RANKED] = INFINITY;
  return DEPTHS;
}

static double width_at(const need_limits *limits, double z)
{
  return limits->width * z + limits->width_at_least;
}

static void fill_layer(const baked_pixel pixels[TILE_PIXELS], const vertices *stored, const need_limits *limits, double z,
                       int channel, layer *out)
{
  double thick = z < INFINITY ? width_at(limits, z) : 0;
  for (uint32_t i = 0; i < TILE_PIXELS; i++) {
    const vertex *v = stored->data + pixels[i].first;
    size_t n = pixels[i].count;
    out->low[i] = n ? vertices_at(v, n, z + thick).c[channel] : 1;
    out->high[i] = n ? vertices_at(v, n, z - thick).c[channel] : 1;
  }
}

/* What is left so many pixel widths in front of the ground, where there is one: then low == high. Elsewhere anything goes. */
static void fill_above_ground(const baked_pixel pixels[TILE_PIXELS], const vertices *stored, const need_limits *limits,
                              double widths, int channel, layer *out)
{
  for (uint32_t i = 0; i < TILE_PIXELS; i++) {
    const vertex *v = stored->data + pixels[i].first;
    size_t n = pixels[i].count;
    out->low[i] = 0;
    out->high[i] = 1;
    if (n && rgb_max(v[n - 1].v) < DARK)
      out->low[i] = out->high[i] = vertices_at(v, n, v[n - 1].z - widths * width_at(limits, v[n - 1].z)).c[channel];
  }
}

static int is_known(const baked_pixel *p)
{
  return !p->marked && !p->absent;
}

static int is_smooth(const baked_pixel *p)
{
  return !p->surface && (p->volume || p->clear);
}

/* The least bend that values between the bounds can have. */
static double least_bend(const layer *l, uint32_t before, uint32_t here, uint32_t after)
{
  double hollow = l->low[before] + l->low[after] - 2 * l->high[here];
  double hill = 2 * l->low[here] - l->high[before] - l->high[after];
  double more = hollow > hill ? hollow : hill;   /* fmax is a call, and this is called for each pixel and depth */
  return more > 0 ? more : 0;
}

/* Its square, less what noise is expected to make of it. */
static double squared_bend(const baked_pixel pixels[TILE_PIXELS], const layer *l, uint32_t before, uint32_t here, uint32_t after)
{
  double bend = least_bend(l, before, here, after);
  if (is_smooth(&pixels[before]) && is_smooth(&pixels[here]) && is_smooth(&pixels[after]))
    bend /= sqrt(SMOOTH);
  return bend * bend - NOISE_KNOWN * (pixels[before].variance + 4 * pixels[here].variance + pixels[after].variance);
}

/* Of a pixel in both directions, where it has two neighbours in the tile. */
static double bends_at(const baked_pixel pixels[TILE_PIXELS], const layer *l, uint32_t i)
{
  double sum = 0;
  for (uint32_t axis = 0; axis < 2; axis++) {
    uint32_t at = axis ? i / TILE_SIDE : i % TILE_SIDE, step = axis ? TILE_SIDE : 1;
    if (at > 0 && at < TILE_SIDE - 1 && is_known(&pixels[i - step]) && is_known(&pixels[i + step]))
      sum += squared_bend(pixels, l, i - step, i, i + step);
  }
  return sum;
}

/* The mean of a known pixel and its neighbours in the tile. */
static double around(const baked_pixel pixels[TILE_PIXELS], const double values[TILE_PIXELS], uint32_t place)
{
  tile_patch patch = tile_around(place);
  double sum = 0, count = 0;
  for (uint32_t k = 0; k < patch.count; k++) {
    int known = is_known(&pixels[patch.place[k]]);
    sum += known ? values[patch.place[k]] : 0;
    count += known;
  }
  return sum / count;
}

static int has_colour(const baked_pixel pixels[TILE_PIXELS])
{
  for (uint32_t i = 0; i < TILE_PIXELS; i++)
    if (pixels[i].coloured)
      return 1;
  return 0;
}

/* Whether a look-up next to the pixel can meet anything but full light or none. */
static int is_in_question(const layer *l, uint32_t place, double aim)
{
  tile_patch patch = tile_around(place);
  double low = 1, high = 0;
  for (uint32_t k = 0; k < patch.count; k++) {
    double least = l->low[patch.place[k]], most = l->high[patch.place[k]];
    low = least < low ? least : low;
    high = most > high ? most : high;
  }
  return high > aim * aim && low < 1 - aim * aim;
}

/* Keeps the largest of what bends at each pixel. */
static void keep_largest(const baked_pixel pixels[TILE_PIXELS], const layer *l, double aim, double most[TILE_PIXELS])
{
  for (uint32_t i = 0; i < TILE_PIXELS; i++) {
    if (!is_known(&pixels[i]))
      continue;
    double bends = bends_at(pixels, l, i) / SQUARED_BENDS;
    if (bends > most[i] && is_in_question(l, i, aim))
      most[i] = bends;
  }
}

static int is_at_border(uint32_t place)
{
  uint32_t x = place % TILE_SIDE, y = place / TILE_SIDE;
  return x == 0 || x == TILE_SIDE - 1 || y == 0 || y == TILE_SIDE - 1;
}

/* Whether interpolation fails at a pixel: where it bends, and where it lies between two that do, as the one in the middle of which an edge
 * runs. At the tile's border, where a neighbour is not seen, any neighbour that is seen stands for it. */
static int is_bent(const double most[TILE_PIXELS], uint32_t place, double least)
{
  if (!is_at_border(place))
    return most[place] > least || (most[place - 1] > least && most[place + 1] > least)
        || (most[place - TILE_SIDE] > least && most[place + TILE_SIDE] > least);
  tile_patch patch = tile_around(place);
  for (uint32_t k = 0; k < patch.count; k++)
    if (most[patch.place[k]] > least)
      return 1;
  return 0;
}

/* The depth behind which less than half of the light is left; infinite: there is none. */
static double surface_of(const baked_pixel *p, const vertices *stored)
{
  const vertex *v = stored->data + p->first;
  if (p->volume || !is_known(p))
    return INFINITY;
  for (size_t k = 0; k < p->count; k++)
    if (rgb_max(v[k].v) < 0.5)
      return v[k].z;
  return INFINITY;
}

/* Whether it stands out of the line through its neighbours' by so much that it may shadow them. */
static int is_rough(const double depth[TILE_PIXELS], const need_limits *limits, uint32_t i)
{
  for (uint32_t axis = 0; axis < 2; axis++) {
    uint32_t at = axis ? i / TILE_SIDE : i % TILE_SIDE, step = axis ? TILE_SIDE : 1;
    if (at == 0 || at == TILE_SIDE - 1)
      continue;
    double bend = fabs(depth[i - step] + depth[i + step] - 2 * depth[i]);
    if (bend > ROUGH * width_at(limits, depth[i]) && bend < INFINITY)
      return 1;
  }
  return 0;
}

/* Grooves no wider than a pixel bend no visibility at any one depth, as each depth counts with a pixel's width around it. At the first level
 * alone: finer ones would find the same again and again on whatever is slanted. */
static void keep_rough(const baked_pixel pixels[TILE_PIXELS], const vertices *stored, const need_limits *limits, double least,
                       double most[TILE_PIXELS])
{
  double depth[TILE_PIXELS];
  for (uint32_t i = 0; i < TILE_PIXELS; i++)
    depth[i] = surface_of(&pixels[i], stored);
  for (uint32_t i = 0; i < TILE_PIXELS; i++)
    if (is_rough(depth, limits, i))
      most[i] = fmax(most[i], ROUGH_ERROR * least);
}

static unsigned char need_of(double times)
{
  return times > 1 ? (unsigned char)fmin(NEED_MOST, 1 + NEED_OCTAVE * log2(times)) : 0;
}

/* Whether finer levels would be marked there, too: look-ups are ray-traced in any case. */
static int is_amid_marks(const baked_pixel pixels[TILE_PIXELS], uint32_t place)
{
  tile_patch patch = tile_around(place);
  for (uint32_t k = 0; k < patch.count; k++)
    if (!pixels[patch.place[k]].marked)
      return 0;
  return 1;
}

void tile_need(baked_pixel pixels[TILE_PIXELS], const vertices *stored, const need_limits *limits)
{
  double depths[DEPTHS], most[TILE_PIXELS], share = BEND_SHARE * limits->aim, least = share * share;
  uint32_t count = choose_depths(pixels, stored, depths);
  int channels = has_colour(pixels) ? 3 : 1;
  layer l;
  for (uint32_t i = 0; i < TILE_PIXELS; i++)
    most[i] = -INFINITY;   /* less than noise makes of it is below 0 */
  for (int c = 0; c < channels && count > 0; c++) {
    for (uint32_t k = 0; k < count; k++) {
      fill_layer(pixels, stored, limits, depths[k], c, &l);
      keep_largest(pixels, &l, limits->aim, most);
    }
    for (uint32_t k = 0; k < HEIGHTS; k++) {
      fill_above_ground(pixels, stored, limits, ABOVE_GROUND[k], c, &l);
      keep_largest(pixels, &l, limits->aim, most);
    }
  }
  for (uint32_t i = 0; i < TILE_PIXELS; i++)
    most[i] = most[i] > -INFINITY ? most[i] : 0;
  if (limits->first)
    keep_rough(pixels, stored, limits, least, most);
  for (uint32_t i = 0; i < TILE_PIXELS; i++) {
    pixels[i].need = pixels[i].marked && !is_amid_marks(pixels, i) ? NEED_ALWAYS : 0;
    if (is_known(&pixels[i]) && is_bent(most, i, least))
      pixels[i].need = need_of(around(pixels, most, i) / least);
  }
}

/* The mean square of what lines of three pixels bend, in both directions. */
static double mean_bend(const layer *l, const sparse_grid *grid)
{
  double sum = 0;
  for (uint32_t k = 0; k < grid->side; k++)
    for (uint32_t i = 1; i + 1 < grid->side; i++) {
      double across = least_bend(l, sparse_place(grid, i - 1, k), sparse_place(grid, i, k), sparse_place(grid, i + 1, k));
      double up = least_bend(l, sparse_place(grid, k, i - 1), sparse_place(grid, k, i), sparse_place(grid, k, i + 1));
      sum += across * across + up * up;
    }
  return sum / (grid->side * (grid->side - 2));
}

int sparse_is_enough(const baked_pixel pixels[TILE_PIXELS], const vertices *stored, const need_limits *limits, const sparse_grid *grid,
                     int ground)
{
  double depths[DEPTHS], most = (ground ? GROUND_BEND : SPARSE_BEND) * limits->aim;
  uint32_t count = choose_depths(pixels, stored, depths);
  int channels = has_colour(pixels) ? 3 : 1;
  layer l;
  for (int c = 0; c < channels; c++)
    for (uint32_t k = 0; k < count; k++) {
      fill_layer(pixels, stored, limits, depths[k], c, &l);
      if (mean_bend(&l, grid) > most * most)
        return 0;
    }
  return 1;
}
