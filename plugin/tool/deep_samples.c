/* SPDX-License-Identifier: AGPL-3.0-or-later */
#include "tool/deep_samples.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>

typedef struct {
  deep_samples *out;
  size_t begin;      /* of this function's samples */
  int channels;
  float z;           /* where the last sample ends */
  rgb left;          /* what is left of the light there */
  rgb before_step;   /* and in front of the last sample, where that is a step */
} writer;

static dsm_result push(deep_samples *list, const deep_sample *sample)
{
  if (list->count == list->capacity) {
    size_t capacity = list->capacity + list->capacity / 2 + 16;
    deep_sample *data = capacity <= SIZE_MAX / sizeof *data ? realloc(list->data, capacity * sizeof *data) : NULL;
    if (!data)
      return DSM_NO_MEMORY;
    list->data = data;
    list->capacity = capacity;
  }
  list->data[list->count++] = *sample;
  return DSM_OK;
}

void deep_samples_free(deep_samples *list)
{
  free(list->data);
  *list = (deep_samples){0};
}

double exponential_sag(double a, double b)
{
  if (!(b < a))
    return 0;
  if (b <= 0)
    return a;
  double ratio = b / a, fall = log(ratio);
  if (ratio > 1 - 1e-6)
    return a * fall * fall / 8;
  double t = log((ratio - 1) / fall) / fall;
  return a * (1 - (1 - ratio) * t - exp(fall * t));
}

/* A sample from where the last one ended to `z`, behind which `target` is left. */
static dsm_result put(writer *w, float z, rgb target)
{
  deep_samples *list = w->out;
  if (list->count > w->begin && list->data[list->count - 1].z == z && w->z == z) {   /* a second step there: make it one */
    list->count--;
    w->left = w->before_step;
  }
  deep_sample sample = {w->z, z, {0, 0, 0}};
  int takes = 0;
  for (int c = 0; c < 3; c++) {
    int from = w->channels == 3 ? c : 0;
    if (w->left.c[from] > 0)
      sample.alpha[c] = (float)fmin(1, fmax(0, 1 - target.c[from] / w->left.c[from]));
    takes |= sample.alpha[c] > 0;
  }
  w->z = z;
  if (!takes)
    return DSM_OK;
  w->before_step = w->left;
  w->left = target;
  return push(list, &sample);
}

/* What leaves less than a float's rounding of 1 has an alpha of 1, and takes all at once. */
static int hangs_too_low(rgb a, rgb b, int channels, double tolerance)
{
  for (int c = 0; c < channels; c++)
    if (exponential_sag(a.c[c], b.c[c] < 0x1p-24 * a.c[c] ? 0 : b.c[c]) > tolerance)
      return 1;
  return 0;
}

/* The share of the segment at which a sample that starts at share `from` has to end. */
static double reach(const vertex *a, const vertex *b, double from, int channels, double tolerance)
{
  rgb start = rgb_lerp(a->v, b->v, from);
  if (!hangs_too_low(start, b->v, channels, tolerance))
    return 1;
  double low = from, high = 1;
  for (int i = 0; i < 20; i++) {
    double middle = 0.5 * (low + high);
    if (hangs_too_low(start, rgb_lerp(a->v, b->v, middle), channels, tolerance))
      high = middle;
    else
      low = middle;
  }
  return low;
}

/* Splits are at depths that are floats, and there the value is exact. Where floats are too far apart for that, the rest is
 * one sample. */
static dsm_result put_segment(writer *w, const vertex *a, const vertex *b, double tolerance)
{
  dsm_result result = DSM_OK;
  double length = b->z - a->z;
  w->z = (float)a->z;
  for (double share = 0; share < 1 && result == DSM_OK;) {
    double end = reach(a, b, share, w->channels, tolerance), exact = a->z + end * length;
    float z = (float)exact;
    if ((double)z > exact)
      z = nextafterf(z, 0);
    end = end < 1 ? ((double)z - a->z) / length : 1;
    if (!(end > share) || end >= 1) {
      end = 1;
      z = (float)b->z;
    }
    result = put(w, z, rgb_lerp(a->v, b->v, end));
    share = end;
  }
  return result;
}

dsm_result deep_samples_of(const vertex *data, size_t count, int channels, double tolerance, deep_samples *out)
{
  writer w = {out, out->count, channels, 0, rgb_grey(1), rgb_grey(1)};
  dsm_result result = DSM_OK;
  for (size_t i = 0; i < count && result == DSM_OK; i++) {
    if (i && (float)data[i].z > (float)data[i - 1].z)
      result = put_segment(&w, &data[i - 1], &data[i], tolerance);
    else {
      w.z = (float)data[i].z;
      result = put(&w, w.z, data[i].v);
    }
  }
  if (result != DSM_OK)
    out->count = w.begin;
  return result;
}
