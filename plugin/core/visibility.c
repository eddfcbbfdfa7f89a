/* SPDX-License-Identifier: AGPL-3.0-or-later */
#include "core/visibility.h"

rgb visibility_at(const visibility *function, double z, uint32_t *hint)
{
  visibility_place place;
  if (function->count == 0) {
    *hint = 0;
    return rgb_grey(1);
  }
  if (!visibility_find(function, visibility_key_of(function->codes, z), hint, &place))
    return rgb_grey(1);
  if (function->channels == 1)
    return rgb_grey(visibility_value(function, &place, 0));
  return (rgb){{visibility_value(function, &place, 0), visibility_value(function, &place, 1),
                visibility_value(function, &place, 2)}};
}
