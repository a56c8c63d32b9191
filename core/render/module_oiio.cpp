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
#include <string>
#include <sys/stat.h>
#include <unistd.h>

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

/* IEC 61966-2-1 */
float linear_from_srgb(float c) {
    return c <= 0.04045f ? c / 12.92f : std::pow((c + 0.055f) / 1.055f, 2.4f);
}

float *read(const char *file, int *width, int *height, char *message, size_t size) {
    struct stat status;
    if (stat(file, &status) != 0) return refuse(message, size, "no such file");
    if (!S_ISREG(status.st_mode)) return refuse(message, size, "is not a regular file");
    auto input = OIIO::ImageInput::open(file);
    if (!input) {
        const std::string why = OIIO::geterror();
        return refuse(message, size, why.empty() ? "is not an image of a known format" : why);
    }
    const OIIO::ImageSpec spec = input->spec();
    if (spec.width < 1 || spec.height < 1 || spec.depth > 1 || spec.nchannels < 1 || spec.deep)
        return refuse(message, size, "is not a flat two-dimensional image");
    const long long count = (long long)spec.width * spec.height;
    if (count > most_pixels)
        return refuse(message, size,
                      "has " + std::to_string(spec.width) + " x " + std::to_string(spec.height) +
                          " pixels; at most " + std::to_string(most_pixels) + " are read");
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
        pixels[i] = linear_from_srgb(pixels[i]);
    for (long long i = channels == 1 ? count : 0; i-- > 0;)
        pixels[3 * i] = pixels[3 * i + 1] = pixels[3 * i + 2] = pixels[i];
    *width = spec.width;
    *height = spec.height;
    return pixels;
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
