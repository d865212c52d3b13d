/* A scratch folder per test program, whole files, and a generator of small PNGs. */
#ifndef TURNER_TEST_IMAGE_FOLDER_H
#define TURNER_TEST_IMAGE_FOLDER_H

#include <dirent.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static char folder[64];

static inline int folder_create(void **state)
{
    (void)state;
    strcpy(folder, "/tmp/turner-image-XXXXXX");
    return mkdtemp(folder) ? 0 : -1;
}

/* The path of a file in the folder; valid until the 32nd next call. */
static inline const char *in_folder(const char *name)
{
    static char paths[32][512];
    static int next;
    char *path = paths[next++ % 32];
    snprintf(path, sizeof paths[0], "%s/%s", folder, name);
    return path;
}

/* How many files lie in a folder. */
static inline int count_files(const char *path)
{
    int count = 0;
    DIR *directory = opendir(path);
    for (struct dirent *entry; directory && (entry = readdir(directory));)
        count += entry->d_name[0] != '.';
    if (directory)
        closedir(directory);
    return directory ? count : -1;
}

static inline int folder_destroy(void **state)
{
    (void)state;
    DIR *directory = opendir(folder);
    for (struct dirent *entry; directory && (entry = readdir(directory));) {
        if (entry->d_name[0] != '.')
            remove(in_folder(entry->d_name));
    }
    if (directory)
        closedir(directory);
    return rmdir(folder);
}

/* The bytes of a file, with a zero behind them; NULL when it cannot be read. Free it. */
static inline char *read_bytes(const char *path, size_t *size)
{
    FILE *file = fopen(path, "rb");
    if (!file)
        return NULL;
    char *bytes = calloc(1, 1 << 20);
    *size = bytes ? fread(bytes, 1, (1 << 20) - 1, file) : 0;
    fclose(file);
    return bytes;
}

static inline bool write_bytes(const char *path, const void *bytes, size_t size)
{
    FILE *file = fopen(path, "wb");
    bool done = file && fwrite(bytes, 1, size, file) == size;
    return file && fclose(file) == 0 && done;
}

static inline uint32_t png_crc(const uint8_t *bytes, size_t size)
{
    uint32_t crc = 0xffffffff;
    for (size_t i = 0; i < size; i++) {
        crc ^= bytes[i];
        for (int bit = 0; bit < 8; bit++)
            crc = crc & 1 ? crc >> 1 ^ 0xedb88320 : crc >> 1;
    }
    return ~crc;
}

static inline uint8_t *put32(uint8_t *at, uint32_t value)
{
    for (int shift = 24; shift >= 0; shift -= 8)
        *at++ = (uint8_t)(value >> shift);
    return at;
}

static inline uint8_t *png_chunk(uint8_t *at, const char *type, const uint8_t *data, size_t size)
{
    at = put32(at, (uint32_t)size);
    uint8_t *start = at;
    memcpy(at, type, 4);
    memcpy(at + 4, data, size);
    return put32(at + 4 + size, png_crc(start, size + 4));
}

/* Writes a PNG (PNG specification, 3rd edition; one stored deflate block, RFC 1951 3.2.4) of at
 * most 1000 bytes of pixels. Colour types: 0 grey, 2 RGB, 4 grey and alpha, 6 RGBA. `pixels` are
 * the samples in file order (16 bit: big-endian), without filter bytes. */
static inline bool write_png(const char *path, int width, int height, int depth, int colour_type,
                             const uint8_t *pixels)
{
    static const int channels[] = {1, 0, 3, 0, 2, 0, 4};
    uint8_t file[2048] = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'}, *at = file + 8;
    uint8_t header[13] = {0}, data[1100] = {0x78, 0x01, 0x01};
    put32(put32(header, (uint32_t)width), (uint32_t)height);
    header[8] = (uint8_t)depth;
    header[9] = (uint8_t)colour_type;
    size_t row = (size_t)(width * channels[colour_type] * depth / 8), raw = 0;
    uint8_t *rows = data + 7;
    for (int y = 0; y < height; y++, raw += row + 1)
        memcpy(rows + raw + 1, pixels + (size_t)y * row, row);
    data[3] = (uint8_t)raw;
    data[4] = (uint8_t)(raw >> 8);
    data[5] = (uint8_t)~data[3];
    data[6] = (uint8_t)~data[4];
    uint32_t a = 1, b = 0;
    for (size_t i = 0; i < raw; i++) {
        a = (a + rows[i]) % 65521;
        b = (b + a) % 65521;
    }
    put32(rows + raw, b << 16 | a);
    at = png_chunk(at, "IHDR", header, sizeof header);
    at = png_chunk(at, "IDAT", data, 7 + raw + 4);
    at = png_chunk(at, "IEND", data, 0);
    return write_bytes(path, file, (size_t)(at - file));
}

#endif
