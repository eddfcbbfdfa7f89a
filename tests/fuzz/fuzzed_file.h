/* SPDX-License-Identifier: AGPL-3.0-or-later */
/*
 * The file that a fuzzed reader is given. The guard before OpenEXR (plugin/store/exr_layout.c) reads it from the fuzzer's memory,
 * through calls that the linker wraps: it asks for many little pieces.
 */
#ifndef TESTS_FUZZED_FILE_H
#define TESTS_FUZZED_FILE_H

#include <stdlib.h>
#include <string.h>
#include <sys/types.h>

int LLVMFuzzerTestOneInput(const unsigned char *bytes, size_t size);
ssize_t __wrap_pread64(int file, void *out, size_t size, off_t place);

static const unsigned char *fuzzed_bytes;
static size_t fuzzed_size;

ssize_t __wrap_pread64(int file, void *out, size_t size, off_t place) {
  (void)file;
  size_t left = (size_t)place < fuzzed_size ? fuzzed_size - (size_t)place : 0;
  if (size > left) size = left;
  if (size) memcpy(out, fuzzed_bytes + place, size);
  return (ssize_t)size;
}

static inline void fuzzed_file_set(const unsigned char *bytes, size_t size) {
  fuzzed_bytes = bytes;
  fuzzed_size = size;
}

#endif
