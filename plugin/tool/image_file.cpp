// SPDX-License-Identifier: AGPL-3.0-or-later
#include <OpenImageIO/deepdata.h>
#include <OpenImageIO/imageio.h>

#include <exception>
#include <memory>
#include <new>
#include <string>
#include <vector>

extern "C" {
#include "store/map_reason.h"
#include "store/new_file.h"
}
#include "tool/image_file.h"

namespace {

// What OpenImageIO says of a file, as a sentence.
dsm_result Refused(map_reason *why, const char *path, const std::string& problem)
{
    std::string text = problem.substr(0, problem.find('\n'));
    while (!text.empty() && (text.back() == '.' || text.back() == '?'))
        text.pop_back();
    return map_refused(why, "%s: %s.", path, text.empty() ? "something is wrong with it" : text.c_str());
}

// No exception gets out.
template<class Work> dsm_result Guarded(map_reason *why, const char *path, Work work) noexcept
{
    try
    {
        return work();
    }
    catch (const std::bad_alloc&)
    {
        return DSM_NO_MEMORY;
    }
    catch (const std::exception& e)
    {
        return map_refused(why, "%s: %s.", path, e.what());
    }
    catch (...)
    {
        return map_refused(why, "%s cannot be used.", path);
    }
}

// Replaces what was there as a whole, or not at all.
class NewFile
{
public:
    dsm_result Create(const char *path, map_reason *why)
    {
        dsm_result result = new_file_create(path, &file, why);
        pending = result == DSM_OK;
        return result;
    }
    const char *Name() const { return file.temporary; }
    dsm_result Keep(map_reason *why)
    {
        pending = false;
        return new_file_keep(&file, why);
    }
    ~NewFile()
    {
        if (pending)
            new_file_discard(&file);
    }

private:
    new_file file;
    bool pending = false;
};

const char *const Colours[] = {"R", "G", "B"};
const char *const Alphas[] = {"AR", "AG", "AB"};

// Channels of a deep image, in the order that it has them in memory.
OIIO::ImageSpec DeepSpec(const image_size& size)
{
    OIIO::ImageSpec spec(int(size.width), int(size.height), 0, OIIO::TypeDesc::FLOAT);
    spec.deep = true;
    auto add = [&spec](const char *name, OIIO::TypeDesc type) {
        spec.channelnames.push_back(name);
        spec.channelformats.push_back(type);
        spec.nchannels++;
    };
    for (const char *name : Colours)   // black: it takes light and gives none
        add(name, OIIO::TypeDesc::HALF);
    if (size.coloured)
        for (const char *name : Alphas)
            add(name, OIIO::TypeDesc::FLOAT);
    else
    {
        spec.alpha_channel = spec.nchannels;
        add("A", OIIO::TypeDesc::FLOAT);
    }
    spec.z_channel = spec.nchannels;
    add("Z", OIIO::TypeDesc::FLOAT);
    add("ZBack", OIIO::TypeDesc::FLOAT);
    spec["oiio:ColorSpace"] = "Linear";
    spec["compression"] = "zips";
    spec["DateTime"] = "";   // the same map, the same bytes
    return spec;
}

} // namespace

struct image_writer
{
    std::string path;
    NewFile target;
    std::unique_ptr<OIIO::ImageOutput> file;
    OIIO::ImageSpec spec;
    bool coloured = false;
    int row = 0;
};

struct image_reader
{
    OIIO::ImageSpec spec;
    OIIO::DeepData data;
    uint32_t width = 0;
    int z = -1, zBack = -1, alpha[3] = {-1, -1, -1};
};

dsm_result flat_image_write(const char *path, uint32_t width, uint32_t height, uint32_t channels, const float *values,
                            map_reason *why)
{
    return Guarded(why, path, [&]() -> dsm_result {
        auto file = OIIO::ImageOutput::create(path);
        if (!file)
        {
            OIIO::geterror();   // and forget it
            return map_refused(why, "%s: its ending names no image format that OpenImageIO can write.", path);
        }
        NewFile target;
        dsm_result result = target.Create(path, why);
        if (result != DSM_OK)
            return result;
        OIIO::ImageSpec spec(int(width), int(height), int(channels), OIIO::TypeDesc::FLOAT);
        if (channels < 3)
            spec.channelnames = channels == 2 ? std::vector<std::string>{"Y", "A"} : std::vector<std::string>{"Y"};
        spec.alpha_channel = channels % 2 ? -1 : int(channels) - 1;
        spec["oiio:ColorSpace"] = "Linear";
        spec["DateTime"] = "";
        if (!file->open(target.Name(), spec) || !file->write_image(OIIO::TypeDesc::FLOAT, values) || !file->close())
            return Refused(why, path, file->geterror());
        return target.Keep(why);
    });
}

dsm_result image_writer_open(const char *path, const image_size *size, const deep_attribute *attributes,
                             uint32_t attribute_count, image_writer **out, map_reason *why)
{
    *out = nullptr;
    return Guarded(why, path, [&]() -> dsm_result {
        std::unique_ptr<image_writer> writer(new image_writer);
        writer->path = path;
        writer->spec = DeepSpec(*size);
        writer->coloured = size->coloured != 0;
        writer->file = OIIO::ImageOutput::create(path);
        OIIO::geterror();
        if (!writer->file || !writer->file->supports("deepdata"))
            return map_refused(why, "%s: only OpenEXR files (.exr) can hold a deep image.", path);
        dsm_result result = writer->target.Create(path, why);
        if (result != DSM_OK)
            return result;
        OIIO::ImageSpec spec = writer->spec;
        for (uint32_t i = 0; i < attribute_count; i++)
            spec.attribute(attributes[i].name, attributes[i].text);
        if (!writer->file->open(writer->target.Name(), spec))
            return Refused(why, path, writer->file->geterror());
        *out = writer.release();
        return DSM_OK;
    });
}

dsm_result image_writer_row(image_writer *writer, const deep_sample *samples, const size_t *first, map_reason *why)
{
    return Guarded(why, writer->path.c_str(), [&]() -> dsm_result {
        const OIIO::ImageSpec& spec = writer->spec;
        const int z = spec.channelindex("Z"), zBack = spec.channelindex("ZBack"), alpha = 3;
        OIIO::DeepData row;
        row.init(spec.width, spec.nchannels, spec.channelformats, spec.channelnames);
        std::vector<unsigned int> counts;
        for (int x = 0; x < spec.width; x++)
            counts.push_back(static_cast<unsigned int>(first[x + 1] - first[x]));
        row.set_all_samples(counts);
        for (int x = 0; x < spec.width; x++)
            for (size_t i = first[x]; i < first[x + 1]; i++)
            {
                const int index = int(i - first[x]);
                row.set_deep_value(x, z, index, samples[i].z);
                row.set_deep_value(x, zBack, index, samples[i].z_back);
                for (int c = 0; c < (writer->coloured ? 3 : 1); c++)
                    row.set_deep_value(x, alpha + c, index, samples[i].alpha[c]);
            }
        if (!writer->file->write_deep_scanlines(writer->row, writer->row + 1, 0, row))
            return Refused(why, writer->path.c_str(), writer->file->geterror());
        writer->row++;
        return DSM_OK;
    });
}

dsm_result image_writer_close(image_writer *writer, int keep, map_reason *why)
{
    if (!writer)
        return DSM_OK;
    std::unique_ptr<image_writer> owned(writer);
    return Guarded(why, writer->path.c_str(), [&]() -> dsm_result {
        if (!writer->file->close() && keep)
            return Refused(why, writer->path.c_str(), writer->file->geterror());
        return keep ? writer->target.Keep(why) : DSM_OK;
    });
}

dsm_result image_reader_open(const char *path, image_size *size, image_reader **out, map_reason *why)
{
    *out = nullptr;
    return Guarded(why, path, [&]() -> dsm_result {
        auto file = OIIO::ImageInput::open(path);
        if (!file)
            return Refused(why, path, OIIO::geterror());
        const OIIO::ImageSpec& spec = file->spec();
        if (!spec.deep)
            return map_refused(why, "%s is not a deep image.", path);
        std::unique_ptr<image_reader> reader(new image_reader);
        reader->width = size->width = uint32_t(spec.width);
        size->height = uint32_t(spec.height);
        reader->z = spec.channelindex("Z");
        reader->zBack = spec.channelindex("ZBack");
        const int grey = spec.channelindex("A");
        for (int c = 0; c < 3; c++)
            reader->alpha[c] = spec.channelindex(Alphas[c]);
        size->coloured = reader->alpha[0] >= 0 && reader->alpha[1] >= 0 && reader->alpha[2] >= 0;
        if (!size->coloured)
            reader->alpha[0] = reader->alpha[1] = reader->alpha[2] = grey;
        if (reader->z < 0 || reader->alpha[0] < 0)
            return map_refused(why, "%s has no channels Z and A, or AR, AG and AB.", path);
        if (!file->read_native_deep_image(0, 0, reader->data))
            return Refused(why, path, file->geterror());
        reader->spec = spec;
        *out = reader.release();
        return DSM_OK;
    });
}

const char *image_reader_attribute(const image_reader *reader, const char *name)
{
    const OIIO::ParamValue *value = reader->spec.find_attribute(name, OIIO::TypeDesc::STRING);
    return value ? value->get_ustring().c_str() : nullptr;
}

uint32_t image_reader_count(const image_reader *reader, uint32_t x, uint32_t y)
{
    return uint32_t(reader->data.samples(int64_t(y) * reader->width + x));
}

deep_sample image_reader_sample(const image_reader *reader, uint32_t x, uint32_t y, uint32_t index)
{
    const int64_t pixel = int64_t(y) * reader->width + x;
    deep_sample sample;
    sample.z = sample.z_back = reader->data.deep_value(pixel, reader->z, int(index));
    if (reader->zBack >= 0)
        sample.z_back = reader->data.deep_value(pixel, reader->zBack, int(index));
    for (int c = 0; c < 3; c++)
        sample.alpha[c] = reader->data.deep_value(pixel, reader->alpha[c], int(index));
    return sample;
}

void image_reader_close(image_reader *reader)
{
    delete reader;
}
