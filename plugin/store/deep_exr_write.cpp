// SPDX-License-Identifier: AGPL-3.0-or-later
#include "store/deep_exr_calls.h"

#include <memory>
#include <string>
#include <vector>

#include <OpenImageIO/deepdata.h>
#include <OpenImageIO/imageio.h>

using namespace OIIO;

struct deep_writer
{
    std::string path;
    std::unique_ptr<ImageOutput> output;
    std::vector<ImageSpec> specs;
    uint32_t part = 0;
};

static ImageSpec SpecOf(const deep_part& part, int width, int height)
{
    ImageSpec spec(int(part.across) * DEEP_SIDE, int(part.up) * DEEP_SIDE, int(part.channel_count), TypeFloat);
    spec.full_width = width;
    spec.full_height = height;
    spec.tile_width = spec.tile_height = DEEP_SIDE;
    spec.deep = !part.flat;
    spec.channelnames.assign(part.channels, part.channels + part.channel_count);
    for (uint32_t c = 0; c < part.channel_count; c++)
        spec.channelformats.push_back(part.integers >> c & 1 ? TypeUInt32 : TypeFloat);
    spec.attribute("oiio:subimagename", part.name);
    spec.attribute("DateTime", "");   // the same map, the same bytes
    return spec;
}

deep_writer *DeepCreate(const char *path, const deep_part *parts, uint32_t partCount, const deep_attribute *attributes,
                        uint32_t attributeCount, deep_error *error)
{
    return GuardedWithRoom(error, (deep_writer *)nullptr, [&]() -> deep_writer * {
        PrepareLibrary();
        auto writer = std::make_unique<deep_writer>();
        writer->path = path;
        int width = 0, height = 0;   // parts of a file share one display window
        for (uint32_t i = 0; i < partCount; i++)
        {
            width = std::max(width, int(parts[i].across) * DEEP_SIDE);
            height = std::max(height, int(parts[i].up) * DEEP_SIDE);
        }
        for (uint32_t i = 0; i < partCount; i++)
            writer->specs.push_back(SpecOf(parts[i], width, height));
        for (uint32_t i = 0; i < attributeCount; i++)
            writer->specs[0].attribute(attributes[i].name, attributes[i].text);
        writer->output = ImageOutput::create("openexr");
        if (!writer->output)
        {
            Say(error, geterror());
            return nullptr;
        }
        if (!writer->output->open(writer->path, int(partCount), writer->specs.data()))
        {
            Say(error, writer->output->geterror());
            return nullptr;
        }
        return writer.release();
    });
}

int DeepWrite(deep_writer *writer, uint32_t part, uint32_t x, uint32_t y, const deep_tile *tile, deep_error *error)
{
    return GuardedWithRoom(error, 0, [&]() -> int {
        for (; writer->part < part; writer->part++)
            if (!writer->output->open(writer->path, writer->specs[writer->part + 1], ImageOutput::AppendSubimage))
                return Say(error, writer->output->geterror()), 0;
        const ImageSpec& spec = writer->specs[part];
        int left = int(x) * DEEP_SIDE, low = int(y) * DEEP_SIDE;
        if (!spec.deep)
        {
            // all channels have 32 bits, and so TypeUnknown, as they are in the file, is as they are here
            if (!writer->output->write_tile(left, low, 0, TypeUnknown, tile->words))
                return Say(error, writer->output->geterror()), 0;
            return 1;
        }
        DeepData data;
        data.init(DEEP_PIXELS, spec.nchannels, spec.channelformats, spec.channelnames);
        data.set_all_samples(tile->count);
        const uint32_t *words = tile->words;
        for (int p = 0; p < DEEP_PIXELS; p++)
        {
            size_t size = size_t(tile->count[p]) * size_t(spec.nchannels);
            if (size)
                memcpy(data.data_ptr(p, 0, 0), words, size * sizeof *words);
            words += size;
        }
        if (!writer->output->write_deep_tiles(left, left + DEEP_SIDE, low, low + DEEP_SIDE, 0, 1, data))
            return Say(error, writer->output->geterror()), 0;
        return 1;
    });
}

void DeepFinish(deep_writer *writer)
{
    deep_error ignored;
    Guarded(&ignored, 0, [&]() {
        std::unique_ptr<deep_writer> owned(writer);
        if (owned)
            owned->output->close();
        return 1;
    });
}
