/* SPDX-License-Identifier: AGPL-3.0-or-later */
/* Numbers as text with decimal points, whatever the host's language. */
#ifndef DSM_STORE_PLAIN_NUMBERS_H
#define DSM_STORE_PLAIN_NUMBERS_H

#include <locale.h>

typedef struct { locale_t plain, before; } number_style;

/* For the calling thread, until restore_numbers. 0: no memory, and nothing to restore. */
static inline int plain_numbers(number_style *style)
{
  style->plain = newlocale(LC_NUMERIC_MASK, "C", (locale_t)0);
  if (!style->plain)
    return 0;
  style->before = uselocale(style->plain);
  return 1;
}

static inline void restore_numbers(const number_style *style)
{
  uselocale(style->before);
  freelocale(style->plain);
}

#endif
