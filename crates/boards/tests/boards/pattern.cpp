// SPDX-License-Identifier: MIT OR Apache-2.0
// A board behind a pattern: runs until a light says right or wrong, and then lets a host read two registers.
//
//   program FOLDER
//
// FOLDER/host   bytes that the host sends once the lights are on
// FOLDER/heard  is written: the bytes that came since then
// prints the lights, and the clocks until then
#include "Vboard.h"
#include "verilated.h"

#include <cstdint>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <memory>
#include <string>
#include <vector>

int main(int count, char **words) {
    if (count != 2) return 2;
    const std::string folder = words[1];
    std::ifstream file(folder + "/host", std::ios::binary);
    const std::vector<char> script(std::istreambuf_iterator<char>(file), {});
    const auto top = std::make_unique<Vboard>();
    std::vector<char> heard;
    std::uint64_t clocks = 0, after = 0, lit = 0;
    std::size_t said = 0;
    int send_bits = 0, send_wait = 0, wait = 0, bits = 0;
    unsigned sending = 0, byte = 0;
    top->rx_i = 1;
    while (after < AFTER && clocks < LIMIT) {
        top->clk_p_i = 1;
        top->clk_n_i = 0;
        top->eval();
        top->clk_p_i = 0;
        top->clk_n_i = 1;
        top->eval();
        ++clocks;
        if (!(top->led_o & 6)) continue;
        if (after++ == 0) lit = clocks;
        // A byte that comes.
        if (bits == 0) {
            if (!top->tx_o) {
                wait = DIVISOR + DIVISOR / 2;
                bits = 1;
            }
        } else if (--wait == 0) {
            wait = DIVISOR;
            if (bits <= 8) {
                byte = byte >> 1 | (top->tx_o ? 0x80U : 0U);
                ++bits;
            } else {
                heard.push_back(static_cast<char>(byte & 0xFF));
                bits = 0;
            }
        }
        // One that is sent.
        if (send_wait > 0) {
            --send_wait;
        } else if (send_bits > 0) {
            top->rx_i = sending & 1;
            sending >>= 1;
            --send_bits;
            send_wait = DIVISOR - 1;
        } else if (said < script.size()) {
            sending = 0x200U | static_cast<unsigned char>(script[said++]) << 1;
            send_bits = 10;
        }
    }
    std::printf("%d %llu\n", top->led_o & 6, static_cast<unsigned long long>(lit));
    std::ofstream out(folder + "/heard", std::ios::binary);
    out.write(heard.data(), static_cast<std::streamsize>(heard.size()));
    top->final();
    return 0;
}
