# SPDX-License-Identifier: MIT OR Apache-2.0
"""Mutations of a file: of its bytes, and of the numbers and words of a text."""
import random
import re

MAX_MUTATIONS = 4
# The largest number of bytes of an insertion, enough to exceed buffers and limits of a line.
MAX_INSERTION = 1 << 21
NUMBERS = [b"0", b"-1", b"1e308", b"-0.0", b"nan", b"inf", b"255", b"256", b"65535", b"65536", b"4294967295", b"4294967296",
           b"9223372036854775807", b"9223372036854775808", b"18446744073709551616", b"0x10", b"1_000", b"3.5", b""]
WORDS = [b"", b"\x00", b"\xff\xfe", b"\xc3\x28", b"../..", b"$(touch x)", b"'", b'"', b"\\", b"{", b"[",
         b"[[[[[[[[", b"a.b.c.d.e.f", b"__proto__", b"\r\n\r\n", b"\xef\xbb\xbf"]


def flip_bits(data, random):
    for _ in range(random.choice([1, 1, 2, 8, 64])):
        data[random.randrange(len(data))] ^= 1 << random.randrange(8)


def set_bytes(data, random):
    value = random.choice([0, 0x7F, 0x80, 0xFF])
    start = random.randrange(len(data))
    count = random.choice([1, 2, 4, 8])
    data[start:start + count] = bytes([value]) * len(data[start:start + count])


def zero_range(data, random):
    start = random.randrange(len(data))
    end = min(len(data), start + random.choice([16, 256, 2000]))
    data[start:end] = bytes(end - start)


def cut(data, random):
    del data[random.randrange(len(data)):]


def remove_range(data, random):
    start = random.randrange(len(data))
    del data[start:start + random.choice([1, 4, 64, 1024])]


def repeat_range(data, random):
    start = random.randrange(len(data))
    part = data[start:start + random.choice([1, 4, 64, 1024])]
    times = min(random.choice([1, 2, 100, 100_000]), MAX_INSERTION // max(1, len(part)))
    data[start:start] = part * times


def swap_ranges(data, random):
    first, second = sorted([random.randrange(len(data)), random.randrange(len(data))])
    count = min(random.choice([1, 8, 128]), second - first, len(data) - second)
    data[first:first + count], data[second:second + count] = data[second:second + count], data[first:first + count]


def append_noise(data, random):
    data += random.randbytes(random.choice([1, 16, 4096]))


def set_large_number(data, random):
    """Sets a field of 2, 4 or 8 bytes to a number near the end of its range."""
    size = random.choice([2, 4, 8])
    start = random.randrange(len(data))
    number = random.choice([1 << (8 * size - 1), (1 << (8 * size)) - 1, (1 << (8 * size - 1)) - 1, 1 << (4 * size)])
    data[start:start + size] = number.to_bytes(size, random.choice(["big", "little"]))[:len(data) - start]


def replace_number(data, random):
    numbers = list(re.finditer(rb"-?\d+(\.\d+)?", bytes(data)))
    if numbers:
        place = random.choice(numbers)
        data[place.start():place.end()] = random.choice(NUMBERS)


def insert_word(data, random):
    start = random.randrange(len(data))
    data[start:start] = random.choice(WORDS)


def repeat_line(data, random):
    lines = bytes(data).splitlines(keepends=True)
    place = random.randrange(len(lines))
    lines[place] *= random.choice([0, 2, 100])
    data[:] = b"".join(lines)


BYTE_MUTATIONS = [flip_bits, set_bytes, zero_range, cut, remove_range, repeat_range, swap_ranges, append_noise, set_large_number]
TEXT_MUTATIONS = [replace_number, replace_number, insert_word, repeat_line]


def mutate(sample, seed, is_text):
    """Returns the sample after one to four mutations, which depend only on the seed."""
    generator = random.Random(seed)
    data = bytearray(sample)
    mutations = BYTE_MUTATIONS + TEXT_MUTATIONS * 3 if is_text else BYTE_MUTATIONS
    for _ in range(generator.randint(1, MAX_MUTATIONS)):
        if data:
            generator.choice(mutations)(data, generator)
    return bytes(data)
