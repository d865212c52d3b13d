/* OpenEXR through its C interface: scanlines, ZIP, channels of floats and whole numbers. */
#include <openexr.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "image/codec.h"

#define SHORT_NAME 31 /* longest that readers of before OpenEXR 1.7 take */

static int64_t write_at(exr_const_context_t context, void *user, const void *bytes, uint64_t size,
                        uint64_t offset, exr_stream_error_func_ptr_t error)
{
    (void)context, (void)error;
    /* turner_atomic_end has the reason */
    return turner_atomic_put(user, bytes, size, offset) ? (int64_t)size : -1;
}

static void stay_silent(exr_const_context_t context, exr_result_t code, const char *message)
{
    (void)context, (void)code, (void)message; /* what it returns is reported */
}

#define EXR_TRY(call)                          \
    do {                                       \
        exr_result_t exr_try_result = (call);  \
        if (exr_try_result != EXR_ERR_SUCCESS) \
            return exr_try_result;             \
    } while (0)

/* Channels are kept in the order of their names, as the format wants them. */
static exr_result_t describe(exr_context_t file, int part, const struct turner_image *image,
                             const struct turner_image_encoding *encoding)
{
    bool long_names = false;
    for (size_t i = 0; i < encoding->text_count; i++)
        long_names |= strlen(encoding->texts[i].key) > SHORT_NAME;
    EXR_TRY(exr_set_longname_support(file, long_names));
    EXR_TRY(exr_initialize_required_attr_simple(file, part, image->width, image->height,
                                                EXR_COMPRESSION_ZIP));
    for (int c = 0; c < 3; c++)
        EXR_TRY(exr_add_channel(file, part, (const char *[]){"R", "G", "B"}[c], EXR_PIXEL_FLOAT,
                                EXR_PERCEPTUALLY_LOGARITHMIC, 1, 1));
    for (size_t i = 0; i < encoding->channel_count; i++)
        EXR_TRY(exr_add_channel(file, part, encoding->channels[i].name,
                                encoding->channels[i].whole ? EXR_PIXEL_UINT : EXR_PIXEL_FLOAT,
                                EXR_PERCEPTUALLY_LOGARITHMIC, 1, 1));
    for (size_t i = 0; i < encoding->text_count; i++)
        EXR_TRY(exr_attr_set_string(file, part, encoding->texts[i].key, encoding->texts[i].value));
    return EXR_ERR_SUCCESS;
}

/* Where the rows of a channel begin, and from one pixel to the next (bytes). */
static const void *values_of(int *stride, const char *name, const struct turner_image *image,
                             const struct turner_image_encoding *encoding)
{
    for (size_t i = 0; i < encoding->channel_count; i++) {
        const struct turner_image_channel *channel = &encoding->channels[i];
        if (strcmp(channel->name, name) == 0) {
            *stride = (int)(channel->stride * sizeof(float));
            return channel->values;
        }
    }
    *stride = 4 * sizeof(float);
    return image->rgba + (strcmp(name, "R") == 0 ? 0 : strcmp(name, "G") == 0 ? 1 : 2);
}

static exr_result_t write_block(exr_context_t file, int part, exr_encode_pipeline_t *pipeline,
                                int row, const struct turner_image *image,
                                const struct turner_image_encoding *encoding)
{
    exr_chunk_info_t block;
    EXR_TRY(exr_write_scanline_chunk_info(file, part, row, &block));
    if (row == 0)
        EXR_TRY(exr_encoding_initialize(file, part, &block, pipeline));
    else
        EXR_TRY(exr_encoding_update(file, part, &block, pipeline));
    for (int i = 0; i < pipeline->channel_count; i++) {
        exr_coding_channel_info_t *channel = &pipeline->channels[i];
        int stride;
        const uint8_t *values = values_of(&stride, channel->channel_name, image, encoding);
        channel->user_pixel_stride = stride;
        channel->user_line_stride = stride * image->width;
        channel->user_bytes_per_element = sizeof(float);
        channel->user_data_type = channel->data_type;
        channel->encode_from_ptr =
            values + (size_t)row * (size_t)image->width * (size_t)stride;
    }
    if (row == 0)
        EXR_TRY(exr_encoding_choose_default_routines(file, part, pipeline));
    return exr_encoding_run(file, part, pipeline);
}

static exr_result_t write_all(exr_context_t file, const struct turner_image *image,
                              const struct turner_image_encoding *encoding)
{
    int part;
    int32_t rows;
    EXR_TRY(exr_add_part(file, NULL, EXR_STORAGE_SCANLINE, &part));
    EXR_TRY(describe(file, part, image, encoding));
    EXR_TRY(exr_write_header(file));
    EXR_TRY(exr_get_scanlines_per_chunk(file, part, &rows));
    exr_encode_pipeline_t pipeline = EXR_ENCODE_PIPELINE_INITIALIZER;
    exr_result_t result = EXR_ERR_SUCCESS;
    for (int row = 0; result == EXR_ERR_SUCCESS && row < image->height; row += rows)
        result = write_block(file, part, &pipeline, row, image, encoding);
    exr_encoding_destroy(file, &pipeline);
    return result;
}

enum turner_result turner_encode_exr(struct turner_atomic *output,
                                     const struct turner_format *format,
                                     const struct turner_image *image,
                                     const struct turner_image_encoding *encoding)
{
    (void)format; /* there is one */
    exr_context_initializer_t start = EXR_DEFAULT_CONTEXT_INITIALIZER;
    start.user_data = output;
    start.write_fn = write_at;
    start.error_handler_fn = stay_silent;
    exr_context_t file = NULL;
    exr_result_t result = exr_start_write(&file, output->path, EXR_WRITE_FILE_DIRECTLY, &start);
    if (result == EXR_ERR_SUCCESS)
        result = write_all(file, image, encoding);
    if (file) {
        exr_result_t finished = exr_finish(&file);
        result = result == EXR_ERR_SUCCESS ? finished : result;
    }
    if (result != EXR_ERR_SUCCESS)
        return turner_fail(TURNER_OUTPUT, "cannot write %s: %s; use another ending", output->path,
                           exr_get_default_error_message(result));
    return TURNER_OK;
}
