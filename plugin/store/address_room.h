/* SPDX-License-Identifier: AGPL-3.0-or-later */
/*
 * Libraries that end the program where memory ends: OpenImageIO asks for the size of a file where no exception may leave, OpenEXR takes apart
 * what it has only half made, and what they depend on starts threads as it is loaded. So who calls them looks first whether
 * there is far more than they need.
 */
#ifndef DSM_STORE_ADDRESS_ROOM_H
#define DSM_STORE_ADDRESS_ROOM_H

#include <stddef.h>
#include <sys/mman.h>

/* Whether the process may take so many bytes more. They are not taken. */
static inline int has_address_room(size_t bytes)
{
  void *room = mmap(NULL, bytes, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  if (room == MAP_FAILED)
    return 0;
  munmap(room, bytes);
  return 1;
}

#endif
