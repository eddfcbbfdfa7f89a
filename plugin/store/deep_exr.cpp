// SPDX-License-Identifier: AGPL-3.0-or-later
// The one symbol of the library that OpenImageIO hides behind.
#include "store/deep_exr_calls.h"

#include <OpenImageIO/hash.h>
#include <OpenImageIO/imageio.h>

void PrepareLibrary()
{
    OIIO::attribute("exr_threads", -1);
}

static int Digest(const void *bytes, size_t size, char out[41])
{
    deep_error ignored;
    return Guarded(&ignored, 0, [&]() -> int {
        OIIO::SHA1 sha(bytes, size);
        std::string digest = sha.digest();
        if (digest.size() != 40)
            return 0;
        memcpy(out, digest.c_str(), 41);
        return 1;
    });
}

extern "C" __attribute__((visibility("default")))
const deep_exr deep_exr_table = {
    sizeof(deep_exr), DeepCreate, DeepWrite, DeepFinish, DeepOpen, DeepAttribute, DeepHasParts, DeepRead, DeepClose, Digest,
};
