/* The only file that speaks to OpenImageIO, which is C++ and may throw: nothing leaves a function
 * of this file but a turner_oiio_result. */
#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <exception>
#include <memory>
#include <string>

#include <sys/stat.h>

extern "C" {
#include "image/oiio.h"
}

namespace {

/* No thread pools: pictures are small beside the work of drawing them. */
void start()
{
    static const bool started =
        OIIO::attribute("threads", 1) && OIIO::attribute("exr_threads", -1);
    (void)started;
}

/* One line, without the full stop and line end that some of the libraries below put there. */
std::string reason(std::string text)
{
    while (!text.empty() && (text.back() == '\n' || text.back() == '.' || text.back() == ' '))
        text.pop_back();
    std::replace(text.begin(), text.end(), '\n', ' ');
    return text.empty() ? "no reason given" : text;
}

OIIO::TypeDesc type_of(enum turner_sample sample)
{
    switch (sample) {
    case TURNER_SAMPLE_U8: return OIIO::TypeDesc::UINT8;
    case TURNER_SAMPLE_U16: return OIIO::TypeDesc::UINT16;
    default: return OIIO::TypeDesc::FLOAT;
    }
}

enum turner_oiio_result failed(char *reason_, const std::string &why)
{
    size_t length = std::min(why.size(), size_t(TURNER_OIIO_REASON - 1));
    std::memcpy(reason_, why.data(), length);
    reason_[length] = 0;
    return TURNER_OIIO_FAILED;
}

OIIO::ImageSpec describe(const struct turner_oiio_picture &picture)
{
    OIIO::ImageSpec spec(picture.width, picture.height, 3, type_of(picture.sample));
    spec.attribute("DateTime", ""); /* or TIFF would get the time of writing */
    if (picture.srgb)
        spec.attribute("oiio:ColorSpace", "sRGB");
    if (std::strcmp(picture.codec, "jpeg") == 0) {
        spec.attribute("CompressionQuality", 95);
        spec.attribute("jpeg:subsampling", "4:4:4");
    }
    std::string lines;
    for (size_t i = 0; i < picture.text_count; i++)
        lines += std::string(picture.texts[i].key) + ": " + picture.texts[i].value + "\n";
    if (std::strcmp(picture.codec, "tiff") == 0 && !lines.empty())
        spec.attribute("ImageDescription", lines);
    return spec;
}

enum turner_oiio_result write_picture(const struct turner_oiio_picture &picture,
                                      void (*take)(void *user, const void *bytes, size_t size),
                                      void *user, char *why)
{
    start();
    OIIO::Filesystem::IOVecOutput file;
    std::unique_ptr<OIIO::ImageOutput> output = OIIO::ImageOutput::create(picture.codec);
    if (!output || !output->set_ioproxy(&file))
        return failed(why, std::string("this OpenImageIO cannot write ") + picture.codec);
    /* no has_error here: every TIFF, good as it is, leaves a complaint about its Exif directory */
    bool written = output->open("", describe(picture)) &&
                   output->write_image(type_of(picture.sample), picture.samples) &&
                   output->close();
    if (!written)
        return failed(why, reason(output->geterror()));
    take(user, file.buffer().data(), file.buffer().size());
    return TURNER_OIIO_OK;
}

enum turner_oiio_result read_picture(const char *path,
                                     float *(*begin)(void *user, int width, int height),
                                     void *user, int *channels, int *steps, char *why)
{
    start();
    struct stat status;
    if (stat(path, &status) != 0)
        return failed(why, std::string(std::strerror(errno)) + "; check its name");
    if (!S_ISREG(status.st_mode))
        return failed(why, "it is not an ordinary file; name a picture");
    OIIO::ImageSpec wish;
    wish.attribute("oiio:UnassociatedAlpha", 1); /* colours as stored, not multiplied by alpha */
    std::unique_ptr<OIIO::ImageInput> input = OIIO::ImageInput::open(path, &wish);
    if (!input)
        return failed(why, reason(OIIO::geterror()) +
                               "; check that it is a whole picture of the kind its name says");
    const OIIO::ImageSpec spec = input->spec();
    if (spec.deep || spec.depth > 1 || spec.nchannels < 1 ||
        std::strcmp(input->format_name(), "null") == 0)
        return failed(why, "it is not a flat picture; turn it into EXR or PNG first");
    /* one channel: grey; two: grey and alpha */
    *channels = spec.nchannels < 3 ? 1 : 3;
    *steps = spec.format.is_floating_point() ? 0 : spec.format.size() == 1 ? 255 : 65535;
    float *rgba = begin(user, spec.width, spec.height);
    if (!rgba)
        return TURNER_OIIO_REFUSED;
    OIIO::stride_t pixel = 4 * sizeof(float);
    /* has_error: a TIFF or JPEG that ends early is read with success, the error only noted */
    if (!input->read_image(0, 0, 0, *channels, OIIO::TypeDesc::FLOAT, rgba, pixel) ||
        input->has_error() || !input->close())
        return failed(why, reason(input->geterror()) + "; check that the file is whole");
    return TURNER_OIIO_OK;
}

enum turner_oiio_result encode(const struct turner_oiio_picture *picture,
                               void (*take)(void *user, const void *bytes, size_t size),
                               void *user, char *why)
{
    try {
        return write_picture(*picture, take, user, why);
    } catch (const std::exception &error) {
        return failed(why, reason(error.what()));
    } catch (...) {
        return failed(why, "OpenImageIO failed");
    }
}

enum turner_oiio_result decode(const char *path, float *(*begin)(void *user, int width, int height),
                               void *user, int *channels, int *steps, char *why)
{
    try {
        return read_picture(path, begin, user, channels, steps, why);
    } catch (const std::exception &error) {
        return failed(why, reason(error.what()));
    } catch (...) {
        return failed(why, "OpenImageIO failed");
    }
}

} // namespace

extern "C" __attribute__((visibility("default"))) const struct turner_oiio *turner_oiio_module(void)
{
    static const struct turner_oiio module = {TURNER_VERSION, encode, decode};
    return &module;
}
