# SPDX-License-Identifier: MIT OR Apache-2.0
"""A clip for the camera of a browser. Every picture has its number as a band of black and white squares at the top, so that a test
knows which picture the browser got."""

SIZE = (320, 240)
SQUARE = 32
FRAMES = 60
BITS = SIZE[0] // SQUARE


def squares(number):
    """Returns the bits of the number, then of its complement as far as there is room: a picture that is not of the clip has no such bits."""
    half = BITS // 2
    bits = [number % FRAMES >> bit & 1 for bit in range(half + 1)]
    return bits + [1 - bit for bit in bits[: BITS - half - 1]]


def luma(number):
    """Returns the luma of a picture: the band, and below it stripes that move and a slope."""
    width, height = SIZE
    band = b"".join(bytes([235 if bit else 16]) * SQUARE for bit in squares(number))
    lines = [band] * SQUARE
    for y in range(SQUARE, height):
        lines.append(bytes(40 + (y // 2 + (90 if (x + 5 * number) // 24 % 3 == 0 else 0)) % 180 for x in range(width)))
    return b"".join(lines)


def write(path):
    """Writes the clip as YUV4MPEG2, grey."""
    width, height = SIZE
    grey = bytes([128]) * (width * height // 2)
    with path.open("wb") as file:
        file.write(f"YUV4MPEG2 W{width} H{height} F30:1 Ip A1:1 C420jpeg\n".encode())
        for number in range(FRAMES):
            file.write(b"FRAME\n" + luma(number) + grey)


def number_of(rgba, width=SIZE[0]):
    """Returns the number of a picture from the pixels of a canvas; None if it is no picture of the clip."""
    square = SQUARE * width // SIZE[0]
    row = square // 2 * width
    bits = [rgba[4 * (row + square * index + square // 2)] > 128 for index in range(BITS)]
    number = sum(bit << index for index, bit in enumerate(bits[: BITS // 2 + 1]))
    return number if [bool(bit) for bit in squares(number)] == bits and number < FRAMES else None
