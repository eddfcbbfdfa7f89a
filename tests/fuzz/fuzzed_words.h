/* SPDX-License-Identifier: AGPL-3.0-or-later */
/*
 * What a map's reader is told through deep_exr_table, as bytes for the fuzzer. record_words.c writes them, read_words.c plays them.
 *
 *   name text '\n' | name text '\n' … | 0 | tile | tile …      one line for each attribute that was asked for, then all
 *                                                              tiles in the order in which they were read
 *   tile: runs of pixels, until there are DEEP_PIXELS: how many (a byte, 0 for all that are left), samples of each (two bytes);
 *         then the samples' words, four bytes each. The lowest byte comes first.
 */
#ifndef TESTS_FUZZED_WORDS_H
#define TESTS_FUZZED_WORDS_H

enum { RUN_BYTES = 3, WORD_BYTES = 4 };

#endif
