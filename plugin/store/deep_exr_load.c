/* SPDX-License-Identifier: AGPL-3.0-or-later */
#define _DEFAULT_SOURCE   /* MAP_ANONYMOUS */
#include <dlfcn.h>
#include <stdio.h>

#include "store/address_room.h"
#include "store/deep_exr.h"

/* OpenImageIO and its hundreds of libraries take 400 MB of addresses; and their threads some. */
static const size_t ROOM_TO_LOAD = (size_t)768 << 20;

static void *load(deep_error *error)
{
  void *library = dlopen(DEEP_EXR_LIBRARY, RTLD_NOW | RTLD_LOCAL | RTLD_NOLOAD);
  if (library)
    return library;
  if (!has_address_room(ROOM_TO_LOAD)) {
    snprintf(error->text, sizeof error->text, "there is too little memory to load it");
    return NULL;
  }
  library = dlopen(DEEP_EXR_LIBRARY, RTLD_NOW | RTLD_LOCAL | RTLD_NODELETE);
  if (!library) {
    const char *reason = dlerror();
    snprintf(error->text, sizeof error->text, "%s", reason ? reason : DEEP_EXR_LIBRARY " cannot be loaded");
  }
  return library;
}

/* Found through the run path of the library or program that this is linked into. It stays loaded: what it depends on has
 * threads of its own, and could not be taken away from under them. */
const deep_exr *deep_exr_load(deep_error *error)
{
  void *library = load(error);
  const deep_exr *table = library ? dlsym(library, "deep_exr_table") : NULL;
  if (!library)
    return NULL;
  if (!table)
    snprintf(error->text, sizeof error->text, DEEP_EXR_LIBRARY " is not what it should be");
  else if (table->size != sizeof(deep_exr)) {
    snprintf(error->text, sizeof error->text, DEEP_EXR_LIBRARY " is of another version");
    table = NULL;
  }
  dlclose(library);
  return table;
}
