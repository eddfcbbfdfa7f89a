/* SPDX-License-Identifier: AGPL-3.0-or-later */
#include "core/pixel_sample.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/hash.h"

/* Two points at a time: x, y, x, y. */
typedef uint32_t lanes __attribute__((vector_size(16)));

static inline lanes reverse_bits_of_all(lanes x)
{
  x = x << 16 | x >> 16;
  x = (x & 0x00ff00ffu) << 8 | (x >> 8 & 0x00ff00ffu);
  x = (x & 0x0f0f0f0fu) << 4 | (x >> 4 & 0x0f0f0f0fu);
  x = (x & 0x33333333u) << 2 | (x >> 2 & 0x33333333u);
  return (x & 0x55555555u) << 1 | (x >> 1 & 0x55555555u);
}

static uint32_t reverse_bits(uint32_t x)
{
  return reverse_bits_of_all((lanes){x})[0];
}

/* Second dimension of Sobol' (the first is reverse_bits): column i of Pascal's triangle modulo 2. */
static uint32_t sobol_second(uint32_t index)
{
  uint32_t x = 0, column = 0x80000000u;
  for (; index; index >>= 1, column ^= column >> 1)
    if (index & 1)
      x ^= column;
  return x;
}

/* Nested uniform scrambling of a reversed number by a hash in which each bit depends on lower bits only:
 * Laine and Karras 2011, as used by Burley 2020, with the better constants of Vegdahl 2021. */
static inline lanes scramble(lanes reversed, lanes seed)
{
  lanes x = reversed;
  x ^= x * 0x3d20adeau;
  x += seed;
  x *= seed >> 16 | 1u;
  x ^= x * 0x05526c56u;
  x ^= x * 0x53a22864u;
  return reverse_bits_of_all(x);
}

pixel_seed pixel_sample_seed(uint32_t face, uint32_t x, uint32_t y)
{
  uint64_t h = hash_mix(hash_mix((uint64_t)face + 0x9e3779b97f4a7c15u) ^ ((uint64_t)x << 32 | y));
  return (pixel_seed){(uint32_t)h, (uint32_t)(h >> 32)};
}

/* Inverse of the normal distribution function, relative error 1.2e-9 (Acklam 2003). */
static double normal_inverse(double p)
{
  static const double a[] = {-3.969683028665376e+01, 2.209460984245205e+02, -2.759285104469687e+02,
                             1.383577518672690e+02, -3.066479806614716e+01, 2.506628277459239e+00};
  static const double b[] = {-5.447609879822406e+01, 1.615858368580409e+02, -1.556989798598866e+02,
                             6.680131188771972e+01, -1.328068155288572e+01};
  static const double c[] = {-7.784894002430293e-03, -3.223964580411365e-01, -2.400758277161838e+00,
                             -2.549732539343734e+00, 4.374664141464968e+00, 2.938163982698783e+00};
  static const double d[] = {7.784695709041462e-03, 3.224671290700398e-01, 2.445134137142996e+00,
                             3.754408661907416e+00};
  double tail = p < 0.5 ? p : 1 - p;
  if (tail >= 0.02425) {
    double q = p - 0.5, r = q * q;
    return (((((a[0] * r + a[1]) * r + a[2]) * r + a[3]) * r + a[4]) * r + a[5]) * q
         / (((((b[0] * r + b[1]) * r + b[2]) * r + b[3]) * r + b[4]) * r + 1);
  }
  double q = sqrt(-2 * log(tail));
  double x = (((((c[0] * q + c[1]) * q + c[2]) * q + c[3]) * q + c[4]) * q + c[5])
           / ((((d[0] * q + d[1]) * q + d[2]) * q + d[3]) * q + 1);
  return p < 0.5 ? x : -x;
}

/* The gaussian is RenderMan's, exp(-2 x^2): two standard deviations, cut at the support. */
double pixel_filter_inverse(filter_kind kind, double u)
{
  static const double cut = 0.022750131948179195;   /* of the normal distribution, below -2 */
  if (kind == FILTER_TRIANGLE)
    return u < 0.5 ? sqrt(2 * u) - 1 : 1 - sqrt(2 - 2 * u);
  if (kind == FILTER_GAUSSIAN)
    return fmax(-1, fmin(1, 0.5 * normal_inverse(cut + u * (1 - 2 * cut))));
  return 2 * u - 1;
}

/* Whole numbers as the middles of their boxes in [0,1]. */
static inline void put_numbers(lanes x, double numbers[4])
{
  typedef int32_t signed_lanes __attribute__((vector_size(16)));
  typedef double quad __attribute__((vector_size(32)));
  quad u = (__builtin_convertvector((signed_lanes)(x ^ 0x80000000u), quad) + (0x1p31 + 0.5)) * 0x1p-32;
  memcpy(numbers, &u, sizeof u);
}

static inline void filter_numbers(const pixel_filter *filter, double *numbers, uint32_t count)
{
  double half = 0.5 * filter->width;
  if (filter->kind == FILTER_BOX)
    for (uint32_t i = 0; i < count; i++)
      numbers[i] = half * (2 * numbers[i] - 1);
  else
    for (uint32_t i = 0; i < count; i++)
      numbers[i] = half * pixel_filter_inverse(filter->kind, numbers[i]);
}

void pixel_sample_offsets(const pixel_filter *filter, pixel_seed seed, const pixel_point *points, uint32_t count,
                          double (*offsets)[2])
{
  lanes seeds = {seed.x, seed.y, seed.x, seed.y}, x;
  double last[4];
  uint32_t i = 0;
  for (; i + 1 < count; i += 2) {
    memcpy(&x, points + i, sizeof x);
    put_numbers(scramble(x, seeds), offsets[i]);
  }
  if (i < count) {
    put_numbers(scramble((lanes){points[i].x, points[i].y}, seeds), last);
    memcpy(offsets[i], last, sizeof offsets[i]);
  }
  filter_numbers(filter, offsets[0], 2 * count);
}

static uint64_t spread_bits(uint32_t value)   /* a zero between any two bits */
{
  uint64_t x = value;
  x = (x | x << 16) & 0x0000ffff0000ffffu;
  x = (x | x << 8) & 0x00ff00ff00ff00ffu;
  x = (x | x << 4) & 0x0f0f0f0f0f0f0f0fu;
  x = (x | x << 2) & 0x3333333333333333u;
  return (x | x << 1) & 0x5555555555555555u;
}

static uint64_t morton_code(const pixel_point *p)
{
  return spread_bits(reverse_bits(p->x)) << 1 | spread_bits(reverse_bits(p->y));
}

static int compare_places(const void *a, const void *b)
{
  uint64_t x = morton_code(a), y = morton_code(b);
  return (x > y) - (x < y);
}

void pixel_sample_path(uint32_t count, pixel_point *path)
{
  for (uint32_t i = 0; i < count; i++)   /* the first dimension is the index with its bits reversed */
    path[i] = (pixel_point){i, reverse_bits(sobol_second(i))};
  qsort(path, count, sizeof *path, compare_places);
}
