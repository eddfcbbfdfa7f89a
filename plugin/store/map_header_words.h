/* SPDX-License-Identifier: AGPL-3.0-or-later */
/* Words that a header says in place of numbers. */
#ifndef DSM_STORE_MAP_HEADER_WORDS_H
#define DSM_STORE_MAP_HEADER_WORDS_H

#include "store/map_header.h"

static const char *const light_words[] = {"point", "spot", "parallel"};   /* DSM_LIGHT_… */
static const char *const filter_words[] = {"box", "triangle", "gaussian"};   /* filter_kind */
static const char *const depth_words[] = {"regular", "jittered"};

#endif
