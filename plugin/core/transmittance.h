/* SPDX-License-Identifier: AGPL-3.0-or-later */
/* The transmittance function of one ray, from its events (LV 3.2, figure 4). */
#ifndef DSM_CORE_TRANSMITTANCE_H
#define DSM_CORE_TRANSMITTANCE_H

#include "core/events.h"
#include "core/vertices.h"

#define TRANSMITTANCE_GONE 1e-12   /* less light than this in a channel is none */

/* What is left of a channel's light behind a surface. */
static inline double transmittance_behind(double front, double surface) {
  double v = front * surface;
  return v < TRANSMITTANCE_GONE ? 0 : v;
}

/* Appends to `out` the product of all steps and of the exponentials of all spans, which may overlap, in
 * exact steps and with vertices inserted until the piecewise linear error is at most max(tolerance/4, 1e-6)
 * in every channel. `events` are in order of front depth. Once light is gone in all channels nothing more is
 * appended. Stays in [0,1] and never grows.
 *
 * No exponential reaches 0, so a span of transmittance 0 in a channel counts as e^-745 there, the most that
 * a double cannot tell from 0. A channel below TRANSMITTANCE_GONE is 0. Where all are, the function ends with
 * an exact 0. */
dsm_result transmittance_build(const event *events, size_t count, double tolerance, vertices *out);

#endif
