/* SPDX-License-Identifier: AGPL-3.0-or-later */
/* Any bytes as an OpenEXR file, for the guard alone that stands before OpenEXR. Built and run by run.sh. */
#include <sys/stat.h>

#include "fuzzed_file.h"
#include "store/exr_layout.h"

int __wrap_open64(const char *path, int flags, ...);
int __wrap_fstat64(int file, struct stat *out);
int __wrap_close(int file);

int __wrap_open64(const char *path, int flags, ...) {
  (void)path, (void)flags;
  return 0;
}

int __wrap_fstat64(int file, struct stat *out) {
  (void)file;
  *out = (struct stat){.st_size = (off_t)fuzzed_size};
  return 0;
}

int __wrap_close(int file) {
  (void)file;
  return 0;
}

int LLVMFuzzerTestOneInput(const unsigned char *bytes, size_t size) {
  exr_layout *layout;
  fuzzed_file_set(bytes, size);
  if (exr_layout_open("", &layout) != DSM_OK) return 0;
  for (uint32_t part = 0; part < 3; ++part)
    for (uint32_t y = 0; y < 3; ++y)
      for (uint32_t x = 0; x < 3; ++x) exr_layout_tile(layout, part, x, y);
  exr_layout_close(layout);
  return 0;
}
