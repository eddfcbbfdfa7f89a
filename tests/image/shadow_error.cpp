// SPDX-License-Identifier: AGPL-3.0-or-later
// shadow_error REFERENCE IMAGE [X Y]: how far two pictures differ, over red, green and blue as they stand (linear values: give it
// OpenEXR). They are of one size, or the reference is what the image shows from column X and row Y on. Prints "rmse max share";
// share is that of the pixels of which any channel differs by more than 0.1. Exit status 2: a file cannot be read, sizes do not
// fit, or a value is not finite.
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

namespace {

struct Picture {
    int width = 0, height = 0, channels = 0;
    std::vector<float> values;

    // Grey pictures repeat their only channel.
    float at(std::size_t pixel, int channel) const
    {
        return values[pixel * channels + (channels < 3 ? 0 : channel)];
    }
};

bool read(const std::string &name, Picture &picture)
{
    auto input = OIIO::ImageInput::open(name);
    if (!input) {
        std::fprintf(stderr, "shadow_error: %s: %s\n", name.c_str(), OIIO::geterror().c_str());
        return false;
    }
    const OIIO::ImageSpec &spec = input->spec();
    if (spec.deep || spec.width < 1 || spec.height < 1 || spec.nchannels < 1) {
        std::fprintf(stderr, "shadow_error: %s: not a flat picture\n", name.c_str());
        return false;
    }
    picture.width = spec.width;
    picture.height = spec.height;
    picture.channels = spec.nchannels;
    picture.values.resize(std::size_t(spec.width) * spec.height * spec.nchannels);
    if (!input->read_image(0, 0, 0, spec.nchannels, OIIO::TypeDesc::FLOAT, picture.values.data())) {
        std::fprintf(stderr, "shadow_error: %s: %s\n", name.c_str(), input->geterror().c_str());
        return false;
    }
    return true;
}

} // namespace

int main(int argc, char **argv)
{
    if (argc != 3 && argc != 5) {
        std::fprintf(stderr, "usage: shadow_error REFERENCE IMAGE [X Y]\n");
        return 2;
    }
    const int left = argc == 5 ? std::atoi(argv[3]) : 0, top = argc == 5 ? std::atoi(argv[4]) : 0;
    Picture reference, image;
    if (!read(argv[1], reference) || !read(argv[2], image))
        return 2;
    const bool fits = argc == 5 ? left >= 0 && top >= 0 && left + reference.width <= image.width && top + reference.height <= image.height
                                : reference.width == image.width && reference.height == image.height;
    if (!fits) {
        std::fprintf(stderr, "shadow_error: %dx%d at %d,%d does not fit %dx%d\n", reference.width, reference.height, left, top, image.width, image.height);
        return 2;
    }

    const std::size_t pixels = std::size_t(reference.width) * reference.height;
    double squares = 0, largest = 0;
    std::size_t beyond = 0;
    for (std::size_t pixel = 0; pixel < pixels; pixel++) {
        const std::size_t there = (pixel / reference.width + top) * image.width + pixel % reference.width + left;
        double worst = 0;
        for (int channel = 0; channel < 3; channel++) {
            const double difference = double(image.at(there, channel)) - double(reference.at(pixel, channel));
            if (!std::isfinite(difference)) {
                std::fprintf(stderr, "shadow_error: a value at pixel %zu,%zu is not finite\n", pixel % reference.width, pixel / reference.width);
                return 2;
            }
            squares += difference * difference;
            worst = std::max(worst, std::abs(difference));
        }
        largest = std::max(largest, worst);
        beyond += worst > 0.1;
    }
    std::printf("%.6g %.6g %.6g\n", std::sqrt(squares / (3.0 * double(pixels))), largest, double(beyond) / double(pixels));
    return 0;
}
