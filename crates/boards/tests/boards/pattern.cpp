// SPDX-License-Identifier: MIT OR Apache-2.0
// A board behind a pattern: runs until a light says that all sums were right or one was wrong, and then lets a host read two
// registers.
//
//   program FOLDER
//
// FOLDER/host   the bytes that the host sends once the lights are on
// FOLDER/heard  written: the bytes that came after that
// Prints the lights, and the clocks until they were on.
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
    Host host;
    std::uint64_t clocks = 0, after = 0, lit = 0;
    std::size_t said = 0;
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
        host.listen(top->tx_o);
        if (host.sent(top->rx_i) && said < script.size()) host.send(script[said++]);
    }
    std::printf("%d %llu\n", top->led_o & 6, static_cast<unsigned long long>(lit));
    std::ofstream out(folder + "/heard", std::ios::binary);
    out.write(reinterpret_cast<const char *>(host.heard.data()), static_cast<std::streamsize>(host.heard.size()));
    top->final();
    return 0;
}
