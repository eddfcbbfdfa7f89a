/* SPDX-License-Identifier: AGPL-3.0-or-later */
#define _XOPEN_SOURCE 700   /* realpath */
#include "store/new_file.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum { TRIES = 1000, ENDING = 40 };

static dsm_result refuse(const new_file *file, int error, map_reason *why)
{
  char reason[200];
  if (strerror_r(error, reason, sizeof reason))
    snprintf(reason, sizeof reason, "error %d", error);
  return map_refused(why, "The file \"%s\" cannot be written: %s.", file->target, reason);
}

static dsm_result check_target(const new_file *file, map_reason *why)
{
  struct stat there;
  int named = file->target[0] != '\0';
  if (named && stat(file->target, &there))
    return errno == ENOENT ? DSM_OK : refuse(file, errno, why);
  if (!named || !S_ISREG(there.st_mode))
    return map_refused(why, "The file \"%s\" cannot be written: this is not the name of a file.", file->target);
  return access(file->target, W_OK) ? refuse(file, errno, why) : DSM_OK;
}

/* The process's number keeps programs apart, trying keeps threads apart. */
static int open_new(char *name, size_t size, const char *target)
{
  int descriptor = -1;
  for (int i = 0; i < TRIES; i++) {
    snprintf(name, size, "%s.%ld-%d.part", target, (long)getpid(), i);
    descriptor = open(name, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (descriptor >= 0 || errno != EEXIST)
      break;
  }
  return descriptor;
}

static void forget(new_file *file)
{
  free(file->target);
  free(file->temporary);
  *file = (new_file){NULL, NULL};
}

dsm_result new_file_create(const char *path, new_file *file, map_reason *why)
{
  file->target = realpath(path, NULL);
  if (!file->target)
    file->target = strdup(path);
  size_t size = file->target ? strlen(file->target) + ENDING : 0;
  file->temporary = size ? malloc(size) : NULL;
  if (!file->temporary) {
    forget(file);
    return map_no_memory(why);
  }
  dsm_result result = check_target(file, why);
  if (result == DSM_OK) {
    int descriptor = open_new(file->temporary, size, file->target);
    if (descriptor < 0)
      result = refuse(file, errno, why);
    else
      close(descriptor);
  }
  if (result != DSM_OK)
    forget(file);
  return result;
}

/* 0: what was written is on the disk; else an error number. */
static int flush(const char *name)
{
  int descriptor = open(name, O_RDONLY | O_CLOEXEC), error = 0;
  if (descriptor < 0)
    return errno;
  if (fsync(descriptor) && errno != EINVAL)   /* some file systems cannot */
    error = errno;
  close(descriptor);
  return error;
}

dsm_result new_file_keep(new_file *file, map_reason *why)
{
  int error = flush(file->temporary);
  if (!error && rename(file->temporary, file->target))
    error = errno;
  if (!error) {
    forget(file);
    return DSM_OK;
  }
  dsm_result result = refuse(file, error, why);
  new_file_discard(file);
  return result;
}

void new_file_discard(new_file *file)
{
  unlink(file->temporary);
  forget(file);
}
