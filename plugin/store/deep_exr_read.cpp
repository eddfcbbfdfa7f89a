// SPDX-License-Identifier: AGPL-3.0-or-later
#include "store/deep_exr_calls.h"

#include <algorithm>
#include <cstdlib>
#include <memory>
#include <string>
#include <vector>

#include <OpenImageIO/deepdata.h>
#include <OpenImageIO/imageio.h>

using namespace OIIO;

struct deep_reader
{
    std::unique_ptr<ImageInput> input;
    ImageSpec first;
    std::vector<std::vector<int>> places;   // of a part's channels in the file
    bool flat = false;
    DeepData data;                          // kept for its memory, as is
    std::vector<uint32_t> pixels;           // a flat tile
};

deep_reader *DeepOpen(const char *path, deep_error *error)
{
    return GuardedWithRoom(error, (deep_reader *)nullptr, [&]() -> deep_reader * {
        PrepareLibrary();
        auto reader = std::make_unique<deep_reader>();
        reader->input = ImageInput::create("openexr");
        if (!reader->input)
        {
            Say(error, geterror());
            return nullptr;
        }
        if (!reader->input->open(path, reader->first))
        {
            Say(error, reader->input->geterror());
            return nullptr;
        }
        return reader.release();
    });
}

const char *DeepAttribute(deep_reader *reader, const char *name)
{
    deep_error ignored;
    return Guarded(&ignored, (const char *)nullptr, [&]() -> const char * {
        const ParamValue *found = reader->first.find_attribute(name, TypeString);
        return found ? found->get_ustring().c_str() : nullptr;
    });
}

// Where the file keeps each channel of `part`; empty if it is another part.
static std::vector<int> PlacesOfChannels(const ImageSpec& spec, const deep_part& part)
{
    std::vector<int> places;
    bool same = spec.deep == !part.flat && spec.x == 0 && spec.y == 0 && spec.width == int(part.across) * DEEP_SIDE
             && spec.height == int(part.up) * DEEP_SIDE && spec.depth == 1 && spec.tile_width == DEEP_SIDE
             && spec.tile_height == DEEP_SIDE && spec.nchannels == int(part.channel_count)
             && spec.get_string_attribute("oiio:subimagename") == part.name;
    for (uint32_t c = 0; same && c < part.channel_count; c++)
    {
        int place = spec.channelindex(part.channels[c]);
        same = place >= 0 && spec.channelformat(place) == (part.integers >> c & 1 ? TypeUInt32 : TypeFloat);
        places.push_back(place);
    }
    return same ? places : std::vector<int>();
}

int DeepHasParts(deep_reader *reader, const deep_part *parts, uint32_t partCount, deep_error *error)
{
    return GuardedWithRoom(error, 0, [&]() -> int {
        reader->places.clear();
        reader->flat = partCount > 0 && parts[0].flat;
        for (uint32_t i = 0; i < partCount; i++)
        {
            if (!reader->input->seek_subimage(int(i), 0))
                return 0;
            reader->places.push_back(PlacesOfChannels(reader->input->spec(), parts[i]));
            if (reader->places.back().empty())
                return 0;
        }
        return !reader->input->seek_subimage(int(partCount), 0);
    });
}

static size_t CountSamples(const DeepData& data, deep_tile *tile)
{
    size_t sum = 0;
    for (int p = 0; p < DEEP_PIXELS; p++)
        sum += tile->count[p] = uint32_t(data.samples(p));
    return sum;
}

// Also for no words at all: who reads them may point there.
static bool MakeRoom(deep_tile *tile, size_t words)
{
    if (tile->words && tile->room >= words)
        return true;
    free(tile->words);
    tile->room = std::max(words, size_t(1));
    tile->words = static_cast<uint32_t *>(malloc(tile->room * sizeof *tile->words));
    if (!tile->words)
        tile->room = 0;
    return tile->words != nullptr;
}

// One sample a pixel, channels in the order of the part's own.
static int ReadFlat(deep_reader *reader, uint32_t part, int left, int low, deep_tile *tile, deep_error *error)
{
    const std::vector<int>& places = reader->places[part];
    reader->pixels.resize(DEEP_PIXELS * places.size());
    if (!reader->input->read_native_tiles(int(part), 0, left, left + DEEP_SIDE, low, low + DEEP_SIDE, 0, 1, 0,
                                          int(places.size()), reader->pixels.data()))
        return Say(error, reader->input->geterror()), 0;
    if (!MakeRoom(tile, reader->pixels.size()))
        return Say(error, DEEP_NO_MEMORY), 0;
    for (size_t p = 0; p < DEEP_PIXELS; p++)
    {
        tile->count[p] = 1;
        for (size_t c = 0; c < places.size(); c++)
            tile->words[p * places.size() + c] = reader->pixels[p * places.size() + size_t(places[c])];
    }
    return 1;
}

int DeepRead(deep_reader *reader, uint32_t part, uint32_t x, uint32_t y, deep_tile *tile, deep_error *error)
{
    return GuardedWithRoom(error, 0, [&]() -> int {
        int left = int(x) * DEEP_SIDE, low = int(y) * DEEP_SIDE;
        DeepData& data = reader->data;
        const std::vector<int>& places = reader->places.at(part);
        if (reader->flat)
            return ReadFlat(reader, part, left, low, tile, error);
        if (!reader->input->read_native_deep_tiles(int(part), 0, left, left + DEEP_SIDE, low, low + DEEP_SIDE, 0, 1, 0,
                                                   int(places.size()), data))
            return Say(error, reader->input->geterror()), 0;
        if (data.pixels() != DEEP_PIXELS || data.samplesize() != places.size() * sizeof *tile->words)
            return Say(error, "a tile of another shape"), 0;
        if (!MakeRoom(tile, CountSamples(data, tile) * places.size()))
            return Say(error, DEEP_NO_MEMORY), 0;
        uint32_t *word = tile->words;
        for (int p = 0; p < DEEP_PIXELS; p++)
        {
            const char *sample = static_cast<const char *>(data.data_ptr(p, 0, 0));
            if (places.size() == 1)
            {
                if (tile->count[p])
                    memcpy(word, sample, tile->count[p] * sizeof *word);
                word += tile->count[p];
                continue;
            }
            for (uint32_t s = 0; s < tile->count[p]; s++, sample += places.size() * sizeof *word)
                for (int place : places)
                    memcpy(word++, sample + size_t(place) * sizeof *word, sizeof *word);
        }
        return 1;
    });
}

void DeepClose(deep_reader *reader)
{
    deep_error ignored;
    Guarded(&ignored, 0, [&]() { return delete reader, 1; });
}
