/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * module_oiio.cpp: the one file that knows OpenImageIO, linked into musurf_oiio.so only. No exception leaves it, and
 * nothing it was told by a file's header is allocated before it has been checked.
 */
#include <OpenImageIO/imageio.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fcntl.h>
#include <memory>
#include <string>
#include <sys/stat.h>
#include <unistd.h>
#include <vector>

#include "core/render/srgb.h"

namespace {

const long long most_pixels = 1LL << 27; /* 16384 x 8192: 1.6 GB as RGB floats */

float *refuse(char *message, size_t size, const std::string &why) {
    std::snprintf(message, size, "%s", why.substr(0, why.find('\n')).c_str());
    return nullptr;
}

/* libpng and libjpeg write to stderr what OpenImageIO then says again: while one of these lives, nothing arrives there. */
class Silence {
  public:
    Silence() {
        std::fflush(stderr);
        const int nowhere = open("/dev/null", O_WRONLY | O_CLOEXEC);
        if (nowhere < 0) return;
        stderr_ = fcntl(STDERR_FILENO, F_DUPFD_CLOEXEC, 3);
        if (stderr_ >= 0) dup2(nowhere, STDERR_FILENO);
        close(nowhere);
    }
    ~Silence() {
        if (stderr_ < 0) return;
        std::fflush(stderr);
        dup2(stderr_, STDERR_FILENO);
        close(stderr_);
    }
    Silence(const Silence &) = delete;
    Silence &operator=(const Silence &) = delete;

  private:
    int stderr_ = -1;
};

/* A flat picture of a size that can be believed; null and a message otherwise. */
std::unique_ptr<OIIO::ImageInput> open_picture(const char *file, const OIIO::ImageSpec *hints, char *message, size_t size) {
    struct stat status;
    std::string why;
    std::unique_ptr<OIIO::ImageInput> input;
    if (stat(file, &status) != 0)
        why = "no such file";
    else if (!S_ISREG(status.st_mode))
        why = "is not a regular file";
    else if (!(input = OIIO::ImageInput::open(file, hints)))
        why = OIIO::geterror(), why = why.empty() ? "is not an image of a known format" : why;
    if (input) {
        const OIIO::ImageSpec &spec = input->spec();
        const long long count = (long long)spec.width * spec.height;
        if (spec.width < 1 || spec.height < 1 || spec.depth > 1 || spec.nchannels < 1 || spec.deep)
            why = "is not a flat two-dimensional image";
        else if (count > most_pixels)
            why = "has " + std::to_string(spec.width) + " x " + std::to_string(spec.height) + " pixels; at most " +
                  std::to_string(most_pixels) + " are read";
    }
    if (why.empty()) return input;
    refuse(message, size, why);
    return nullptr;
}

float *read(const char *file, int *width, int *height, char *message, size_t size) {
    auto input = open_picture(file, nullptr, message, size);
    if (!input) return nullptr;
    const OIIO::ImageSpec spec = input->spec();
    const long long count = (long long)spec.width * spec.height;
    const int channels = spec.nchannels >= 3 ? 3 : 1;
    float *pixels = static_cast<float *>(std::malloc((size_t)count * 3 * sizeof(float)));
    if (!pixels) return refuse(message, size, "not enough memory for its pixels");
    if (!input->read_image(0, 0, 0, channels, OIIO::TypeDesc::FLOAT, pixels)) {
        std::free(pixels);
        const std::string why = input->geterror();
        return refuse(message, size,
                      why.empty() ? "is truncated or damaged" : "is truncated or damaged: " + why);
    }
    const bool srgb =
        spec.format.is_floating_point() ? false : spec.get_string_attribute("oiio:ColorSpace") != "Linear";
    for (long long i = srgb ? 0 : count * channels; i < count * channels; i++)
        pixels[i] = (float)mu_linear_from_srgb((double)pixels[i]);
    for (long long i = channels == 1 ? count : 0; i-- > 0;)
        pixels[3 * i] = pixels[3 * i + 1] = pixels[3 * i + 2] = pixels[i];
    *width = spec.width;
    *height = spec.height;
    return pixels;
}

/* The codes of one channel, of the file's own type. */
template <typename T>
bool read_as(OIIO::ImageInput &input, OIIO::TypeDesc type, int channel, double *out, long long count) {
    std::vector<T> codes((size_t)count);
    if (!input.read_image(0, 0, channel, channel + 1, type, codes.data())) return false;
    for (long long i = 0; i < count; i++) out[i] = (double)codes[(size_t)i];
    return true;
}

bool read_codes(OIIO::ImageInput &input, int channel, double *out, long long count) {
    switch (input.spec().format.basetype) {
    case OIIO::TypeDesc::UINT8: return read_as<uint8_t>(input, OIIO::TypeDesc::UINT8, channel, out, count);
    case OIIO::TypeDesc::INT8: return read_as<int8_t>(input, OIIO::TypeDesc::INT8, channel, out, count);
    case OIIO::TypeDesc::UINT16: return read_as<uint16_t>(input, OIIO::TypeDesc::UINT16, channel, out, count);
    case OIIO::TypeDesc::INT16: return read_as<int16_t>(input, OIIO::TypeDesc::INT16, channel, out, count);
    case OIIO::TypeDesc::UINT32: return read_as<uint32_t>(input, OIIO::TypeDesc::UINT32, channel, out, count);
    case OIIO::TypeDesc::INT32: return read_as<int32_t>(input, OIIO::TypeDesc::INT32, channel, out, count);
    case OIIO::TypeDesc::DOUBLE: return read_as<double>(input, OIIO::TypeDesc::DOUBLE, channel, out, count);
    default: return read_as<float>(input, OIIO::TypeDesc::FLOAT, channel, out, count);
    }
}

double *read_raw(const char *file, const char *channel, int *width, int *height, char *message, size_t size) {
    OIIO::ImageSpec hints;
    hints.attribute("oiio:UnassociatedAlpha", 1); /* colours are not multiplied by alpha */
    hints.attribute("oiio:RawColor", 1);
    auto input = open_picture(file, &hints, message, size);
    if (!input) return nullptr;
    const OIIO::ImageSpec spec = input->spec();
    const long long count = (long long)spec.width * spec.height;
    std::string names;
    int chosen = !channel && spec.nchannels == 1 ? 0 : -1;
    for (int c = 0; c < spec.nchannels; c++) {
        names += (c ? ", " : "") + std::string(spec.channel_name(c));
        if (channel && spec.channel_name(c) == channel) chosen = c;
    }
    if (chosen < 0) {
        refuse(message, size, channel ? "has no channel \"" + std::string(channel) + "\", but " + names
                                      : "has more than one channel; one is needed of " + names);
        return nullptr;
    }
    double *values = static_cast<double *>(std::malloc((size_t)count * sizeof(double)));
    if (values && read_codes(*input, chosen, values, count)) {
        *width = spec.width;
        *height = spec.height;
        return values;
    }
    const std::string why = values ? input->geterror() : "not enough memory for its pixels";
    std::free(values);
    refuse(message, size, "is truncated or damaged" + (why.empty() ? "" : ": " + why));
    return nullptr;
}

/* `count` channels side by side, whole-number codes as fractions of the largest, *step apart: those of these names, and if it
 * lacks one, an error if they were `named` by somebody, else the first. */
float *read_channels(const char *file, const char *const *names, bool named, int count, int *width, int *height,
                     double *step, char *message, size_t size) {
    OIIO::ImageSpec hints;
    hints.attribute("oiio:UnassociatedAlpha", 1);
    hints.attribute("oiio:RawColor", 1);
    auto input = open_picture(file, &hints, message, size);
    if (!input) return nullptr;
    const OIIO::ImageSpec spec = input->spec();
    std::vector<int> chosen(count, -1);
    std::string have, missing;
    for (int c = 0; c < spec.nchannels; c++) have += (c ? ", " : "") + std::string(spec.channel_name(c));
    for (int k = 0; names && k < count; k++) {
        for (int c = 0; c < spec.nchannels; c++)
            if (spec.channel_name(c) == names[k]) chosen[k] = c;
        if (chosen[k] < 0 && missing.empty()) missing = names[k];
    }
    if (named && !missing.empty()) return refuse(message, size, "has no channel \"" + missing + "\", but " + have);
    if (!names || !missing.empty()) {
        if (spec.nchannels < count)
            return refuse(message, size, "has too few channels, " + have + "; " + std::to_string(count) + " are needed");
        for (int k = 0; k < count; k++) chosen[k] = k;
    }
    const size_t pixels = (size_t)spec.width * (size_t)spec.height;
    std::vector<float> all(pixels * (size_t)spec.nchannels);
    if (!input->read_image(0, 0, 0, spec.nchannels, OIIO::TypeDesc::FLOAT, all.data())) {
        const std::string why = input->geterror();
        return refuse(message, size, "is truncated or damaged" + (why.empty() ? "" : ": " + why));
    }
    float *values = static_cast<float *>(std::malloc(pixels * (size_t)count * sizeof(float)));
    if (!values) return refuse(message, size, "not enough memory for its pixels");
    for (size_t i = 0; i < pixels; i++)
        for (int k = 0; k < count; k++) values[i * (size_t)count + (size_t)k] = all[i * (size_t)spec.nchannels + (size_t)chosen[k]];
    *width = spec.width;
    *height = spec.height;
    *step = spec.format.is_floating_point() ? 0 : 1 / (std::ldexp(1.0, 8 * (int)spec.format.size()) - 1);
    return values;
}

} // namespace

/* Linear RGB in malloc'ed memory, or NULL and one line in `message`. Not for two threads at once: it turns stderr off. */
extern "C" __attribute__((visibility("default"))) float *
mu_oiio_read(const char *file, int *width, int *height, char *message, size_t size) {
    try {
        const Silence silence;
        return read(file, width, height, message, size);
    } catch (const std::exception &trouble) {
        return refuse(message, size, trouble.what());
    } catch (...) {
        return refuse(message, size, "cannot be read as an image");
    }
}

/* One channel as it is stored, in malloc'ed memory, or NULL and one line in `message`. Not for two threads at once either. */
extern "C" __attribute__((visibility("default"))) double *
mu_oiio_read_raw(const char *file, const char *channel, int *width, int *height, char *message, size_t size) {
    try {
        const Silence silence;
        return read_raw(file, channel, width, height, message, size);
    } catch (const std::exception &trouble) {
        refuse(message, size, trouble.what());
    } catch (...) {
        refuse(message, size, "cannot be read as an image");
    }
    return nullptr;
}

/* Channels of any picture as they are stored, but whole-number codes as fractions of the largest: side by side, in malloc'ed
 * memory, or NULL and one line in `message`. Not for two threads at once either. */
extern "C" __attribute__((visibility("default"))) float *
mu_oiio_read_channels(const char *file, const char *const *names, int named, int count, int *width, int *height,
                      double *step, char *message, size_t size) {
    try {
        const Silence silence;
        return read_channels(file, names, named != 0, count, width, height, step, message, size);
    } catch (const std::exception &trouble) {
        return refuse(message, size, trouble.what());
    } catch (...) {
        return refuse(message, size, "cannot be read as an image");
    }
}
