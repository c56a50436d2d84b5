// SPDX-License-Identifier: MIT OR Apache-2.0
// The host's end of a serial line, in clocks of the board: a bit has DIVISOR clocks.
#include <vector>

namespace {

using Bytes = std::vector<unsigned char>;

struct Host {
    Bytes heard;
    int wait = 0, bits = 0;
    unsigned byte = 0;
    bool bad = false;  // a byte had no stop bit

    // Samples the line at a clock.
    void listen(bool tx) {
        if (bits == 0) {
            if (!tx) {
                wait = DIVISOR + DIVISOR / 2;
                bits = 1;
            }
            return;
        }
        if (--wait > 0) return;
        wait = DIVISOR;
        if (bits <= 8) {
            byte = byte >> 1 | (tx ? 0x80U : 0U);
            ++bits;
        } else {
            if (!tx) bad = true;
            heard.push_back(byte & 0xFF);
            bits = 0;
        }
    }

    int send_bits = 0, send_wait = 0;
    unsigned sending = 0;

    // Drives the line at a clock while a byte is sent. Returns whether the next byte may begin.
    template <typename Level>
    bool sent(Level &rx) {
        if (send_wait > 0) {
            --send_wait;
        } else if (send_bits > 0) {
            rx = sending & 1;
            sending >>= 1;
            --send_bits;
            send_wait = DIVISOR - 1;
        } else {
            return true;
        }
        return false;
    }

    void send(unsigned char next) {
        sending = 0x200U | static_cast<unsigned>(next) << 1;
        send_bits = 10;
    }
};

}  // namespace
