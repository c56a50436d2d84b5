// SPDX-License-Identifier: MIT OR Apache-2.0
// A board on a bench: a sensor whose outputs are read from a file, a slave on I2C, and a host on the serial line.
//
//   program FOLDER PCLK_PS NACKS
//
// FOLDER/wires   two bytes for each rising edge of pclk: {vsync, href, stopped} and data; with `stopped` there is no edge
// FOLDER/host    the bytes that the host sends, each after the microsecond at which it may be sent, 4 bytes, little-endian
// FOLDER/heard   written: the bytes that came
// FOLDER/setup   written: a line for each acknowledged write on I2C, and the lights at the end
// NACKS          number of bytes on I2C that are not acknowledged
#include "Vboard_bench.h"
#include "verilated.h"

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <memory>
#include <string>
#include <vector>

namespace {

Bytes read(const std::string &path) {
    std::ifstream file(path, std::ios::binary);
    return Bytes(std::istreambuf_iterator<char>(file), {});
}

// An I2C slave that accepts every write.
struct Slave {
    std::FILE *log;
    int nacks;
    bool scl = true, sda = true, active = false, pulls = false;
    int bits = 0;
    unsigned byte = 0;
    Bytes bytes;

    void see(bool new_scl, bool new_sda) {
        if (scl && new_scl && sda != new_sda) {
            if (!new_sda) {  // a start condition
                active = true;
                bits = 0;
                byte = 0;
                bytes.clear();
            } else if (active) {  // a stop condition
                active = false;
                if (bytes.size() > 1) {
                    for (const auto value : bytes) std::fprintf(log, "%02X ", value);
                    std::fprintf(log, "\n");
                }
            }
        } else if (active && !scl && new_scl) {
            if (bits < 8) byte = byte << 1 | new_sda;
            ++bits;
        } else if (active && scl && !new_scl) {
            if (bits == 8) {
                if (nacks > 0) {
                    --nacks;
                    active = false;
                } else {
                    pulls = true;
                    bytes.push_back(byte & 0xFF);
                }
            } else if (bits == 9) {
                pulls = false;
                bits = 0;
                byte = 0;
            }
        }
        scl = new_scl;
        sda = new_sda;
    }
};

}  // namespace

int main(int count, char **words) {
    if (count != 4) return 2;
    const std::string folder = words[1];
    const std::uint64_t pclk_half = std::strtoull(words[2], nullptr, 10) / 2;
    constexpr std::uint64_t kHalf = 500000ULL / MHZ;
    const Bytes wires = read(folder + "/wires"), script = read(folder + "/host");
    const auto top = std::make_unique<Vboard_bench>();
    std::FILE *log = std::fopen((folder + "/setup").c_str(), "w");
    Slave slave{log, std::atoi(words[3])};
    Host host;
    std::uint64_t clock_at = kHalf, pclk_at = pclk_half + 137, now = 0, quiet = 0;
    std::size_t wire = 0, said = 0;
    top->rx_i = 1;
    while (quiet < QUIET) {
        now = clock_at < pclk_at ? clock_at : pclk_at;
        if (now == pclk_at) {
            pclk_at += pclk_half;
            if (top->pclk_i) {
                top->pclk_i = 0;
            } else if (wire + 1 < wires.size()) {
                // The values at the rising edge were driven at the falling edge.
                if (!(wires[wire] & 4)) top->pclk_i = 1;
                wire += 2;
            }
            if (!top->pclk_i && wire + 1 < wires.size()) {
                top->vsync_i = wires[wire] & 1;
                top->href_i = wires[wire] >> 1 & 1;
                top->data_i = wires[wire + 1];
            }
        }
        if (now == clock_at) {
            clock_at += kHalf;
            top->clk_i = !top->clk_i;
        }
        top->sda_low_i = slave.pulls;
        top->eval();
        if (now + kHalf != clock_at || !top->clk_i) continue;
        slave.see(top->scl_o, top->sda_o);
        const auto before = host.heard.size();
        host.listen(top->tx_o);
        quiet = host.heard.size() != before || host.bits || wire + 1 < wires.size() ? 0 : quiet + 1;
        if (host.sent(top->rx_i) && said + 4 < script.size()) {
            std::uint64_t at = 0;
            for (int byte = 3; byte >= 0; --byte) at = at << 8 | script[said + byte];
            if (now / 1000000 >= at) {
                host.send(script[said + 4]);
                said += 5;
            }
            quiet = 0;
        }
    }
    std::fprintf(log, "lights %d\n", top->led_o);
    std::fclose(log);
    std::ofstream out(folder + "/heard", std::ios::binary);
    out.write(reinterpret_cast<const char *>(host.heard.data()), static_cast<std::streamsize>(host.heard.size()));
    top->final();
    return host.bad ? 1 : 0;
}
