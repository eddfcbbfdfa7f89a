/* SPDX-License-Identifier: AGPL-3.0-or-later */
#include <dlfcn.h>
#include <stdio.h>

#include "store/deep_exr.h"

/* Found through the run path of the library or program that this is linked into. It stays loaded: what it depends on has
 * threads of its own, and could not be taken away from under them. */
const deep_exr *deep_exr_load(deep_error *error)
{
  void *library = dlopen(DEEP_EXR_LIBRARY, RTLD_NOW | RTLD_LOCAL | RTLD_NODELETE);
  const deep_exr *table = library ? dlsym(library, "deep_exr_table") : NULL;
  if (!table) {
    const char *reason = dlerror();
    snprintf(error->text, sizeof error->text, "%s", reason ? reason : DEEP_EXR_LIBRARY " is not what it should be");
  }
  else if (table->size != sizeof(deep_exr)) {
    snprintf(error->text, sizeof error->text, DEEP_EXR_LIBRARY " is of another version");
    table = NULL;
  }
  if (library)
    dlclose(library);
  return table;
}
