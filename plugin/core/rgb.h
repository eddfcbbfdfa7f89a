/* SPDX-License-Identifier: AGPL-3.0-or-later */
/* Three linear channels, red, green and blue. */
#ifndef DSM_CORE_RGB_H
#define DSM_CORE_RGB_H

#include <math.h>

typedef struct { double c[3]; } rgb;

static inline rgb rgb_grey(double v) { return (rgb){{v, v, v}}; }
static inline rgb rgb_add(rgb a, rgb b) { return (rgb){{a.c[0] + b.c[0], a.c[1] + b.c[1], a.c[2] + b.c[2]}}; }
static inline rgb rgb_sub(rgb a, rgb b) { return (rgb){{a.c[0] - b.c[0], a.c[1] - b.c[1], a.c[2] - b.c[2]}}; }
static inline rgb rgb_mul(rgb a, rgb b) { return (rgb){{a.c[0] * b.c[0], a.c[1] * b.c[1], a.c[2] * b.c[2]}}; }
static inline rgb rgb_scale(double s, rgb a) { return (rgb){{s * a.c[0], s * a.c[1], s * a.c[2]}}; }
static inline rgb rgb_lerp(rgb a, rgb b, double t) { return rgb_add(a, rgb_scale(t, rgb_sub(b, a))); }
static inline int rgb_is_grey(rgb a) { return a.c[0] == a.c[1] && a.c[1] == a.c[2]; }
static inline double rgb_max(rgb a) { return fmax(a.c[0], fmax(a.c[1], a.c[2])); }

#endif
