// SPDX-License-Identifier: AGPL-3.0-or-later
// The functions of deep_exr_table, and what they share. C++ only.
#ifndef DSM_STORE_DEEP_EXR_CALLS_H
#define DSM_STORE_DEEP_EXR_CALLS_H

#include <algorithm>
#include <cstring>
#include <exception>
#include <new>
#include <string>

#include "store/address_room.h"
#include "store/deep_exr.h"

// The first line of the text, without full stops at its end.
inline void Say(deep_error *error, const std::string& text)
{
    std::string line = text.substr(0, text.find_first_of("\r\n"));
    line.erase(line.find_last_not_of(". ") + 1);
    size_t length = std::min(line.size(), sizeof error->text - 1);
    memcpy(error->text, line.data(), length);
    error->text[length] = '\0';
}

// No exception gets out.
template<class Result, class Work> Result Guarded(deep_error *error, Result failed, Work work) noexcept
{
    try
    {
        return work();
    }
    catch (const std::bad_alloc&)
    {
        memcpy(error->text, DEEP_NO_MEMORY, sizeof DEEP_NO_MEMORY);
    }
    catch (const std::exception& e)
    {
        try { Say(error, e.what()); } catch (...) { error->text[0] = '\0'; }
    }
    catch (...)
    {
        error->text[0] = '\0';
    }
    return failed;
}

// Far more than a call for one tile needs.
const size_t kRoomToWork = size_t(32) << 20;

// The same for what begins something or goes on with it: not where memory is short. What ends it is done in any case.
template<class Result, class Work> Result GuardedWithRoom(deep_error *error, Result failed, Work work) noexcept
{
    if (has_address_room(kRoomToWork))
        return Guarded(error, failed, work);
    memcpy(error->text, DEEP_NO_MEMORY, sizeof DEEP_NO_MEMORY);
    return failed;
}

// OpenEXR works on the calling thread.
void PrepareLibrary();

deep_writer *DeepCreate(const char *path, const deep_part *parts, uint32_t partCount, const deep_attribute *attributes,
                        uint32_t attributeCount, deep_error *error);
int DeepWrite(deep_writer *writer, uint32_t part, uint32_t x, uint32_t y, const deep_tile *tile, deep_error *error);
void DeepFinish(deep_writer *writer);
deep_reader *DeepOpen(const char *path, deep_error *error);
const char *DeepAttribute(deep_reader *reader, const char *name);
int DeepHasParts(deep_reader *reader, const deep_part *parts, uint32_t partCount, deep_error *error);
int DeepRead(deep_reader *reader, uint32_t part, uint32_t x, uint32_t y, deep_tile *tile, deep_error *error);
void DeepClose(deep_reader *reader);

#endif
