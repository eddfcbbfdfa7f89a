/* SPDX-License-Identifier: AGPL-3.0-or-later */
#define _FILE_OFFSET_BITS 64   /* also where `long` has 32 */
#include "map/spool.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

typedef struct {
  off_t offset;
  uint32_t size;   /* bytes; 0: not here */
} spooled;

struct spool {
  int file, full;
  off_t end;
  spooled tiles[];
};

/* The descriptor of a new file that has lost its name already, or -1. */
static int open_nameless(const char *beside)
{
  static const char ending[] = ".XXXXXX";
  size_t length = strlen(beside);
  char *path = malloc(length + sizeof ending);
  if (!path)
    return -1;
  memcpy(path, beside, length);
  memcpy(path + length, ending, sizeof ending);
  int file = mkstemp(path);
  if (file >= 0) {
    unlink(path);
    fcntl(file, F_SETFD, FD_CLOEXEC);   /* a program that the host starts has no use for it */
  }
  free(path);
  return file;
}

dsm_result spool_create(const char *beside, uint64_t count, spool **out)
{
  *out = NULL;
  if (count > (SIZE_MAX - sizeof(spool)) / sizeof(spooled))
    return DSM_NO_MEMORY;
  spool *s = calloc(1, sizeof *s + count * sizeof *s->tiles);
  if (!s)
    return DSM_NO_MEMORY;
  s->file = open_nameless(beside);
  if (s->file < 0) {
    free(s);
    return DSM_REFUSED;
  }
  *out = s;
  return DSM_OK;
}

void spool_destroy(spool *s)
{
  if (!s)
    return;
  close(s->file);
  free(s);
}

dsm_result spool_write(spool *s, uint64_t number, const tile *t)
{
  if (s->tiles[number].size)
    return DSM_OK;
  if (s->full)
    return DSM_REFUSED;
  for (size_t done = 0; done < t->size;) {
    ssize_t n = pwrite(s->file, (const char *)t + done, t->size - done, s->end + (off_t)done);
    if (n > 0)
      done += (size_t)n;
    else if (n == 0 || errno != EINTR) {
      s->full = 1;
      return DSM_REFUSED;
    }
  }
  s->tiles[number] = (spooled){s->end, t->size};
  s->end += t->size;
  return DSM_OK;
}

dsm_result spool_read(const spool *s, uint64_t number, const tile **out)
{
  spooled where = s->tiles[number];
  *out = NULL;
  if (!where.size)
    return DSM_OK;
  tile *t = malloc(where.size);
  if (!t)
    return DSM_NO_MEMORY;
  for (size_t done = 0; done < where.size;) {
    ssize_t n = pread(s->file, (char *)t + done, where.size - done, where.offset + (off_t)done);
    if (n > 0)
      done += (size_t)n;
    else if (n == 0 || errno != EINTR) {
      free(t);
      return DSM_REFUSED;
    }
  }
  atomic_init(&t->used, 0);
  *out = t;
  return DSM_OK;
}

int spool_is_full(const spool *s)
{
  return s->full;
}
