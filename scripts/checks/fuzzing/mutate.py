# SPDX-License-Identifier: MIT OR Apache-2.0
"""Mutations of a file: of its bytes, and of the numbers and words of a text."""
import random
import re

MOST = 4
# The largest number of bytes of an insertion, enough to exceed buffers and limits of a line.
LONGEST = 1 << 21
NUMBERS = [b"0", b"-1", b"1e308", b"-0.0", b"nan", b"inf", b"255", b"256", b"65535", b"65536", b"4294967295", b"4294967296",
           b"9223372036854775807", b"9223372036854775808", b"18446744073709551616", b"0x10", b"1_000", b"3.5", b""]
WORDS = [b"", b"\x00", b"\xff\xfe", b"\xc3\x28", b"../..", b"$(touch x)", b"'", b'"', b"\\", b"{", b"[",
         b"[[[[[[[[", b"a.b.c.d.e.f", b"__proto__", b"\r\n\r\n", b"\xef\xbb\xbf"]


def flip_bits(data, draw):
    for _ in range(draw.choice([1, 1, 2, 8, 64])):
        data[draw.randrange(len(data))] ^= 1 << draw.randrange(8)


def set_bytes(data, draw):
    value = draw.choice([0, 0x7F, 0x80, 0xFF])
    start = draw.randrange(len(data))
    count = draw.choice([1, 2, 4, 8])
    data[start:start + count] = bytes([value]) * len(data[start:start + count])


def zero_range(data, draw):
    start = draw.randrange(len(data))
    end = min(len(data), start + draw.choice([16, 256, 2000]))
    data[start:end] = bytes(end - start)


def cut(data, draw):
    del data[draw.randrange(len(data)):]


def remove_range(data, draw):
    start = draw.randrange(len(data))
    del data[start:start + draw.choice([1, 4, 64, 1024])]


def repeat_range(data, draw):
    start = draw.randrange(len(data))
    part = data[start:start + draw.choice([1, 4, 64, 1024])]
    times = min(draw.choice([1, 2, 100, 100_000]), LONGEST // max(1, len(part)))
    data[start:start] = part * times


def swap_ranges(data, draw):
    one, other = sorted([draw.randrange(len(data)), draw.randrange(len(data))])
    count = min(draw.choice([1, 8, 128]), other - one, len(data) - other)
    data[one:one + count], data[other:other + count] = data[other:other + count], data[one:one + count]


def append_noise(data, draw):
    data += draw.randbytes(draw.choice([1, 16, 4096]))


def set_large_number(data, draw):
    """Sets a field of 2, 4 or 8 bytes to a number near the end of its range."""
    size = draw.choice([2, 4, 8])
    start = draw.randrange(len(data))
    number = draw.choice([1 << (8 * size - 1), (1 << (8 * size)) - 1, (1 << (8 * size - 1)) - 1, 1 << (4 * size)])
    data[start:start + size] = number.to_bytes(size, draw.choice(["big", "little"]))[:len(data) - start]


def replace_number(data, draw):
    found = list(re.finditer(rb"-?\d+(\.\d+)?", bytes(data)))
    if found:
        place = draw.choice(found)
        data[place.start():place.end()] = draw.choice(NUMBERS)


def insert_word(data, draw):
    start = draw.randrange(len(data))
    data[start:start] = draw.choice(WORDS)


def repeat_line(data, draw):
    lines = bytes(data).splitlines(keepends=True)
    place = draw.randrange(len(lines))
    lines[place] *= draw.choice([0, 2, 100])
    data[:] = b"".join(lines)


BYTE_MUTATIONS = [flip_bits, set_bytes, zero_range, cut, remove_range, repeat_range, swap_ranges, append_noise, set_large_number]
TEXT_MUTATIONS = [replace_number, replace_number, insert_word, repeat_line]


def mutated(sample, seed, is_text):
    """Returns the sample after one to four mutations, which depend only on the seed."""
    draw = random.Random(seed)
    data = bytearray(sample)
    mutations = BYTE_MUTATIONS + TEXT_MUTATIONS * 3 if is_text else BYTE_MUTATIONS
    for _ in range(draw.randint(1, MOST)):
        if data:
            draw.choice(mutations)(data, draw)
    return bytes(data)
