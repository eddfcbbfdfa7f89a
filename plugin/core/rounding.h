/* SPDX-License-Identifier: AGPL-3.0-or-later */
/*
 * How far the numbers of stored vertices may be rounded.
 *
 *   Values    in as few bits as keep the rounding within four 15ths of the tolerance. Compression leaves room for it, mostly for a
 *             quarter of it: see compress_lattice.c. More rounding would cost more in vertices than it spares in bits (measured: hair).
 *   Depths    to multiples of a quantum. A pixel has seen all that lies within its own width, so where along its
 *             rays a surface was need not be known better by far: quanta take up to 16 tolerances of the pixel's width, and at
 *             most a 16th of it; but 4 where values have all their bits, as the tolerance asked for is finer than what rays tell.
 *             Coarser levels halve the tolerance, but not this share of their wider pixels: what is finer than that in the levels
 *             they are made of would cost them vertices (measured: hair, a third of the levels' bytes).
 *             Depths move away from the light only, by less than a quantum, so no surface comes to
 *             shadow itself. Where there are volumes, which dim at any depth, quanta are so small that moving the
 *             fastest fall changes visibility by no more than a 16th of the tolerance; for that, too, compression leaves room.
 *
 * Without tolerance depths are floats, and values have 16 bits.
 */
#ifndef DSM_CORE_ROUNDING_H
#define DSM_CORE_ROUNDING_H

#include "core/projection.h"
#include "core/visibility.h"

static const double ROUNDING_OF_VALUES = 4.0 / 15, ROUNDING_OF_DEPTHS = 1.0 / 16;   /* of the tolerance */

/* Of one tile. */
typedef struct {
  uint32_t value_bits;
  double slack;          /* error of visibility that moved vertices may make in volumes */
  double quantum;        /* at most, as a share of the depth (perspective) or in scene units; 0: depths are floats */
  int perspective;
} rounding;

static inline double rounding_of_bits(uint32_t bits)
{
  return 0.5 / ((1u << bits) - 1) + (bits < VALUE_BITS ? VALUE_ROUNDING : 0);
}

static inline uint32_t rounding_value_bits(double tolerance)
{
  uint32_t bits = 1;
  while (bits < VALUE_BITS && rounding_of_bits(bits) > ROUNDING_OF_VALUES * tolerance)
    bits++;
  return bits;
}

/* What that of depths takes of the tolerance. */
static inline double rounding_of_depths(int volume, double tolerance)
{
  return volume ? ROUNDING_OF_DEPTHS * tolerance : 0;
}

/* Nothing is rounded but to floats and 65535ths. */
static inline rounding rounding_least(void)
{
  return (rounding){VALUE_BITS, 0, 0, 0};
}

/* For tiles of a level whose least tolerance is this, after it was halved so often. */
static inline rounding rounding_for(const projection *p, uint32_t face_index, uint32_t level, uint32_t halvings, uint32_t value_bits,
                                    double tolerance)
{
  const face *f = &p->faces[face_index];
  double pixel = (double)(1u << level) * (f->pixel_u < f->pixel_v ? f->pixel_u : f->pixel_v);
  double share = (value_bits < VALUE_BITS ? 16 : 4) * tolerance * (double)(1u << halvings);
  share = share < 1.0 / 16 ? share : 1.0 / 16;
  return (rounding){value_bits, ROUNDING_OF_DEPTHS * tolerance, share * pixel, p->perspective};
}

/* How much farther from the light than what it has seen a vertex of a level may be, at most: a quantum of the level itself, and
 * those of the finer ones that it is made of. Scene units, at a depth. */
static inline double rounding_reach(const projection *p, uint32_t face_index, uint32_t level, double depth)
{
  rounding most = rounding_for(p, face_index, level, 0, VALUE_BITS, 0.5);
  return 2 * most.quantum * (most.perspective ? depth : 1);
}

#endif
