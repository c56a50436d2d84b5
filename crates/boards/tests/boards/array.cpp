// SPDX-License-Identifier: MIT OR Apache-2.0
// An array on a board: runs until a light says that all sums were right or one was wrong, and then lets a host send commands,
// each after the answer to the one before.
//
//   program FOLDER [+faultN]
//
// FOLDER/host   the commands: a byte, and the 24 bytes of the command; if the byte is 1, it is sent until bit 1 of its answer is 1
// FOLDER/heard  written: the last answer to each command
// FOLDER/sums   written: the sum after each frame
// Prints the lights, the clocks until they were on, and the first frame with the thresholds that were written last.
#include "Varray_bench.h"
#include "verilated.h"

#include <cstdint>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <memory>
#include <string>
#include <vector>

int main(int count, char **words) {
    if (count < 2) return 2;
    Verilated::commandArgs(count, words);
    const std::size_t length = 24;
    const std::string folder = words[1];
    std::ifstream file(folder + "/host", std::ios::binary);
    const std::vector<char> script(std::istreambuf_iterator<char>(file), {});
    const auto top = std::make_unique<Varray_bench>();
    Host host;
    Bytes heard;
    std::vector<std::uint32_t> sums;
    std::uint64_t clocks = 0, lit = 0;
    std::size_t at = 0, said = 0;
    bool is_broken = false;
    top->rx_i = 1;
    while (clocks < LIMIT && !is_broken && !(lit && at == script.size())) {
        top->clk_p_i = 1;
        top->clk_n_i = 0;
        top->eval();
        top->clk_p_i = 0;
        top->clk_n_i = 1;
        top->eval();
        ++clocks;
        if (top->done_o) sums.push_back(top->sum_o);
        if (!(top->led_o & 6)) continue;
        if (!lit) lit = clocks;
        // The line rests between answers.
        Bytes &answer = host.heard;
        const auto before = answer.size();
        host.listen(top->tx_o);
        is_broken = host.bad || (answer.size() != before && said < length);
        // After a whole answer, sends the command again, or the next one.
        if (answer.size() == length) {
            if (script[at] == 0 || (answer[8] & 2)) {
                heard.insert(heard.end(), answer.begin(), answer.end());
                at += 1 + length;
            }
            answer.clear();
            said = 0;
        }
        if (host.sent(top->rx_i) && at < script.size() && said < length) {
            host.send(script[at + 1 + said++]);
        }
    }
    std::printf("%d %llu %u\n", top->led_o & 6, static_cast<unsigned long long>(lit), top->from_o);
    std::ofstream out(folder + "/heard", std::ios::binary);
    out.write(reinterpret_cast<const char *>(heard.data()), static_cast<std::streamsize>(heard.size()));
    std::ofstream added(folder + "/sums", std::ios::binary);
    added.write(reinterpret_cast<const char *>(sums.data()), static_cast<std::streamsize>(4 * sums.size()));
    top->final();
    return is_broken || at < script.size();
}
