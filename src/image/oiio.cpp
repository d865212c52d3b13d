/* The only file that speaks to OpenImageIO, which is C++ and may throw: nothing leaves a function
 * of this file but a turner_result. */
#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <memory>
#include <string>
#include <vector>

#include <sys/stat.h>

extern "C" {
#include "image/atomic.h"
#include "image/codec.h"
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

OIIO::ImageSpec describe(const struct turner_format *format, int width, int height,
                         const struct turner_image_encoding *encoding)
{
    OIIO::ImageSpec spec(width, height, 3, type_of(format->sample));
    if (encoding->channel_count) {
        spec.nchannels += int(encoding->channel_count);
        spec.channelformats.assign(3, spec.format);
    }
    for (size_t i = 0; i < encoding->channel_count; i++) {
        const struct turner_image_channel &channel = encoding->channels[i];
        spec.channelnames.push_back(channel.name);
        spec.channelformats.push_back(channel.whole ? OIIO::TypeDesc(OIIO::TypeDesc::UINT32)
                                                    : spec.format);
    }
    spec.attribute("DateTime", ""); /* or EXR and TIFF would get the time of writing */
    if (format->sample != TURNER_SAMPLE_FLOAT && !encoding->linear)
        spec.attribute("oiio:ColorSpace", "sRGB");
    if (std::strcmp(format->codec, "jpeg") == 0) {
        spec.attribute("CompressionQuality", 95);
        spec.attribute("jpeg:subsampling", "4:4:4");
    }
    bool attributes = !std::strcmp(format->codec, "openexr") || !std::strcmp(format->codec, "png");
    std::string lines;
    for (size_t i = 0; i < encoding->text_count; i++) {
        const struct turner_image_text &text = encoding->texts[i];
        lines += std::string(text.key) + ": " + text.value + "\n";
        if (attributes)
            spec.attribute(text.key, text.value);
    }
    if (std::strcmp(format->codec, "tiff") == 0 && !lines.empty())
        spec.attribute("ImageDescription", lines);
    return spec;
}

/* Has no error of its own: what failed is with `output`. */
bool write_plain(OIIO::ImageOutput *output, const struct turner_format *format,
                 const struct turner_image *image, const struct turner_image_encoding *encoding)
{
    std::unique_ptr<void, decltype(&std::free)> samples(
        turner_format_pack(format, image, encoding), std::free);
    return output->write_image(type_of(format->sample), samples.get());
}

/* A few rows at a time: with every layer, all of them would take several times the picture. */
bool write_with_channels(OIIO::ImageOutput *output, const struct turner_image *image,
                         const struct turner_image_encoding *encoding)
{
    const int rows = 64; /* a multiple of the lines that OpenEXR compresses together */
    std::vector<uint32_t> words(size_t(rows) * image->width * (3 + encoding->channel_count));
    for (int row = 0; row < image->height; row += rows) {
        int count = std::min(rows, image->height - row);
        turner_format_pack_rows(words.data(), image, encoding, row, count);
        if (!output->write_scanlines(row, row + count, 0, OIIO::TypeDesc::UNKNOWN, words.data()))
            return false;
    }
    return true;
}

enum turner_result write_picture(const char *path, const struct turner_format *format,
                                 const struct turner_image *image,
                                 const struct turner_image_encoding *encoding)
{
    start();
    OIIO::Filesystem::IOVecOutput file;
    std::unique_ptr<OIIO::ImageOutput> output = OIIO::ImageOutput::create(format->codec);
    if (!output || !output->set_ioproxy(&file)) {
        return turner_fail(TURNER_OUTPUT, "cannot write %s: this OpenImageIO cannot write %s; use "
                                          "another ending", path, format->codec);
    }
    /* no has_error here: every TIFF, good as it is, leaves a complaint about its Exif directory */
    bool written = output->open(path, describe(format, image->width, image->height, encoding)) &&
                   (encoding->channel_count ? write_with_channels(output.get(), image, encoding)
                                            : write_plain(output.get(), format, image, encoding)) &&
                   output->close();
    if (!written) {
        return turner_fail(TURNER_OUTPUT, "cannot write %s: %s; use another ending", path,
                           reason(output->geterror()).c_str());
    }
    return turner_atomic_write(path, file.buffer().data(), file.buffer().size());
}

enum turner_result unreadable(const char *path, const std::string &why)
{
    return turner_fail(TURNER_BAD_INPUT, "cannot read picture %s: %s", path, why.c_str());
}

enum turner_result read_picture(struct turner_image *image, const char *path, int *channels,
                                int *steps)
{
    start();
    struct stat status;
    if (stat(path, &status) != 0)
        return unreadable(path, std::string(std::strerror(errno)) + "; check its name");
    if (!S_ISREG(status.st_mode))
        return unreadable(path, "it is not an ordinary file; name a picture");
    OIIO::ImageSpec wish;
    wish.attribute("oiio:UnassociatedAlpha", 1); /* colours as stored, not multiplied by alpha */
    std::unique_ptr<OIIO::ImageInput> input = OIIO::ImageInput::open(path, &wish);
    if (!input) {
        return unreadable(path, reason(OIIO::geterror()) +
                                    "; check that it is a whole picture of the kind its name says");
    }
    const OIIO::ImageSpec spec = input->spec();
    if (spec.deep || spec.depth > 1 || spec.nchannels < 1 ||
        std::strcmp(input->format_name(), "null") == 0)
        return unreadable(path, "it is not a flat picture; turn it into EXR or PNG first");
    /* one channel: grey; two: grey and alpha */
    *channels = spec.nchannels < 3 ? 1 : 3;
    *steps = spec.format.is_floating_point() ? 0 : spec.format.size() == 1 ? 255 : 65535;
    enum turner_result result = turner_image_create(image, spec.width, spec.height);
    if (result != TURNER_OK)
        return turner_fail(result, "cannot read picture %s: %s", path, turner_message());
    OIIO::stride_t pixel = 4 * sizeof(float);
    /* has_error: a TIFF or JPEG that ends early is read with success, the error only noted */
    if (!input->read_image(0, 0, 0, *channels, OIIO::TypeDesc::FLOAT, image->rgba, pixel) ||
        input->has_error() || !input->close()) {
        return unreadable(path, reason(input->geterror()) + "; check that the file is whole");
    }
    return TURNER_OK;
}

} // namespace

extern "C" enum turner_result turner_codec_write(const char *path,
                                                 const struct turner_format *format,
                                                 const struct turner_image *image,
                                                 const struct turner_image_encoding *encoding)
{
    try {
        return write_picture(path, format, image, encoding);
    } catch (const std::exception &error) {
        return turner_fail(TURNER_OUTPUT, "cannot write %s: %s; use another ending", path,
                           reason(error.what()).c_str());
    } catch (...) {
        return turner_fail(TURNER_OUTPUT, "cannot write %s: OpenImageIO failed; use another ending",
                           path);
    }
}

extern "C" enum turner_result turner_codec_read(struct turner_image *image, const char *path,
                                                int *channels, int *steps)
{
    *image = {};
    try {
        return read_picture(image, path, channels, steps);
    } catch (const std::exception &error) {
        return unreadable(path, reason(error.what()));
    } catch (...) {
        return unreadable(path, "OpenImageIO failed");
    }
}
