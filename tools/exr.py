"""Reads the OpenEXR files that turner writes, with the standard library alone.

    import exr
    picture = exr.read("picture.exr")
    picture.width, picture.height
    picture.channels["depth.Z"]    # an array of width × height floats or unsigned, row by row
    picture.attributes["turner:version"]

Files of one part, in scan lines, uncompressed or zip, without half floats; anything else is a
ValueError. The format: https://openexr.com/en/latest/OpenEXRFileLayout.html
"""

import array
import struct
import sys
import zlib

UINT, HALF, FLOAT = range(3)
NONE, RLE, ZIPS, ZIP = range(4)


class Picture:
    """width, height, channels {name: array}, attributes {name: str of text ones, else bytes}"""


def _name(data, at):
    end = data.index(0, at)
    return data[at:end].decode(), end + 1


def _header(data):
    if data[:4] != b"\x76\x2f\x31\x01":
        raise ValueError("not an OpenEXR file")
    if struct.unpack_from("<I", data, 4)[0] & ~0x400 != 2:  # 0x400: long names
        raise ValueError("not one part of scan lines")
    at, attributes = 8, {}
    while data[at]:
        name, at = _name(data, at)
        kind, at = _name(data, at)
        size, = struct.unpack_from("<i", data, at)
        value = data[at + 4:at + 4 + size]
        attributes[name] = value.decode() if kind == "string" else value
        at += 4 + size
    return attributes, at + 1


def _channels(value):
    at = 0
    while value[at]:
        name, at = _name(value, at)
        kind, _, x, y = struct.unpack_from("<iIii", value, at)
        if kind == HALF or (x, y) != (1, 1):
            raise ValueError(f"channel {name} is of a kind that turner does not write")
        yield name, kind
        at += 16


def _unzip(packed):
    """Undoes zlib, then the differences, then the split into even and odd bytes."""
    data = bytearray(zlib.decompress(packed))
    for i in range(1, len(data)):
        data[i] = (data[i - 1] + data[i] - 128) & 255
    half = (len(data) + 1) // 2
    out = bytearray(len(data))
    out[0::2], out[1::2] = data[:half], data[half:]
    return bytes(out)


def read(path):
    with open(path, "rb") as file:
        data = file.read()
    picture = Picture()
    picture.attributes, at = _header(data)
    x0, y0, x1, y1 = struct.unpack("<4i", picture.attributes["dataWindow"])
    picture.width, picture.height = x1 - x0 + 1, y1 - y0 + 1
    kinds = list(_channels(picture.attributes["channels"]))
    compression = picture.attributes["compression"][0]
    if compression not in (NONE, ZIPS, ZIP):
        raise ValueError("compressed in another way than zip")
    lines = 16 if compression == ZIP else 1
    planes = {name: [b""] * picture.height for name, _ in kinds}
    row_bytes = 4 * picture.width
    for offset, in struct.iter_unpack("<Q", data[at:at + 8 * -(-picture.height // lines)]):
        y, size = struct.unpack_from("<ii", data, offset)
        rows = range(y - y0, min(y - y0 + lines, picture.height))
        block = data[offset + 8:offset + 8 + size]
        if size < len(rows) * len(kinds) * row_bytes:  # what does not shrink is stored as it is
            block = _unzip(block)
        pieces = (block[i:i + row_bytes] for i in range(0, len(block), row_bytes))
        for row in rows:
            for name, _ in kinds:
                planes[name][row] = next(pieces)
    picture.channels = {}
    for name, kind in kinds:
        picture.channels[name] = array.array("f" if kind == FLOAT else "I", b"".join(planes[name]))
        if sys.byteorder == "big":
            picture.channels[name].byteswap()
    return picture
