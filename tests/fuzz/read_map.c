/* SPDX-License-Identifier: AGPL-3.0-or-later */
/*
 * Any bytes as a map's file: opened as a render opens it, and every tile read. Built and run by run.sh.
 *
 * Nothing is asked of the result but that it is one: no crash, no leak, no hang, no allocation beyond what the file's own size
 * can explain, and tiles that make sense if they are accepted.
 */
#include <fcntl.h>
#include <stdio.h>
#include <unistd.h>

#include "fuzzed_file.h"
#include "fuzzed_map.h"

void __sanitizer_weak_hook_strcmp(void *caller, const char *a, const char *b, int result);

/* The fuzzer would learn from each comparison of names in OpenEXR's own lists, which are most of all. */
void __sanitizer_weak_hook_strcmp(void *caller, const char *a, const char *b, int result) {
  (void)caller, (void)a, (void)b, (void)result;
}

/* What loads by itself elsewhere is linked in here, with sanitizers. */
const deep_exr *deep_exr_load(deep_error *error) {
  (void)error;
  return &deep_exr_table;
}

static char path[64];

static void forget_file(void) { unlink(path); }

/* The file lies in memory, and is made once. */
static void put(const unsigned char *bytes, size_t size) {
  static int file = -1;
  if (file < 0) {
    snprintf(path, sizeof path, "/dev/shm/deep-shadow-fuzz-%ld.exr", (long)getpid());
    file = open(path, O_RDWR | O_CREAT | O_TRUNC, 0600);
    atexit(forget_file);
  }
  if (file < 0 || ftruncate(file, (off_t)size) || pwrite(file, bytes, size, 0) != (ssize_t)size) abort();
  fuzzed_file_set(bytes, size);
}

int LLVMFuzzerTestOneInput(const unsigned char *bytes, size_t size) {
  put(bytes, size);
  read_whole_map(path);
  return 0;
}
