/* SPDX-License-Identifier: AGPL-3.0-or-later */
/* Fewer vertices at once, where a function has far more than its shape needs: before anything dear is done. */
#ifndef DSM_CORE_THIN_H
#define DSM_CORE_THIN_H

#include "core/vertices.h"

/* Leaves out vertices of `list`, in place, so that the function stays within `slack` of what it was. Those that
 * stay keep their values, and steps stay. `noise` has a number a vertex, for what follows it, and is thinned along:
 * a vertex that stays gets the largest of those it now stands for, not more than twice the least. NULL: none. */
void thin_vertices(vertices *list, double *noise, double slack);

#endif
