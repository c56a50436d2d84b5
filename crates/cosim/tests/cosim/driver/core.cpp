// SPDX-License-Identifier: MIT OR Apache-2.0
// A core on AXI as a processor sees it. Each line of the standard input is a command, and its answer goes to the standard output:
//
//   r A     reads a register              -> its value
//   w A V   writes a register             -> ok
//   f K     plays frame K of argument 1, until no more packets leave -> number of bytes, and the bytes of the packets
//   i       -> interrupt_o
#include "Vrcm_axi.h"
#include "verilated.h"

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <vector>

namespace {

constexpr int kWidth = WIDTH, kHeight = HEIGHT, kBits = BITS, kLanes = LANES, kQuiet = QUIET;

struct Core {
    Vrcm_axi top;
    std::vector<std::uint8_t> left;  // the bytes of packets that left
    int quiet = 0;                   // clocks since the last of them

    void clock() {
        top.eval();
        if (top.m_axis_packets_tvalid && top.m_axis_packets_tready) {
            for (int byte = 0; byte < 8; ++byte) left.push_back(top.m_axis_packets_tdata >> (8 * byte) & 0xFF);
            quiet = 0;
        } else {
            ++quiet;
        }
        top.aclk = 1;
        top.eval();
        top.aclk = 0;
        top.eval();
    }
    void reset() {
        top.m_axis_packets_tready = 1;
        for (int at = 0; at < 8; ++at) clock();
        top.aresetn = 1;
        clock();
        left.clear();
    }
    std::uint32_t read(unsigned address) {
        top.s_axi_araddr = address;
        top.s_axi_arvalid = top.s_axi_rready = 1;
        std::uint32_t value = 0;
        for (bool answered = false; !answered;) {
            top.eval();
            const bool taken = top.s_axi_arready && top.s_axi_arvalid;
            answered = top.s_axi_rvalid;
            value = top.s_axi_rdata;
            clock();
            if (taken) top.s_axi_arvalid = 0;
        }
        top.s_axi_rready = 0;
        return value;
    }
    void write(unsigned address, std::uint32_t value) {
        top.s_axi_awaddr = address;
        top.s_axi_wdata = value;
        top.s_axi_wstrb = 15;
        top.s_axi_awvalid = top.s_axi_wvalid = top.s_axi_bready = 1;
        for (bool answered = false; !answered;) {
            top.eval();
            const bool address_taken = top.s_axi_awready && top.s_axi_awvalid;
            const bool data_taken = top.s_axi_wready && top.s_axi_wvalid;
            answered = top.s_axi_bvalid;
            clock();
            if (address_taken) top.s_axi_awvalid = 0;
            if (data_taken) top.s_axi_wvalid = 0;
        }
        top.s_axi_bready = 0;
    }
    void play(const std::uint16_t* frame) {
        for (int y = 0; y < kHeight; ++y)
            for (int x = 0; x < kWidth; x += kLanes) {
                std::uint64_t word = 0;
                for (int lane = 0; lane < kLanes && x + lane < kWidth; ++lane)
                    word |= std::uint64_t{frame[y * kWidth + x + lane]} << (kBits * lane);
                top.s_axis_video_tdata = word;
                top.s_axis_video_tuser = x == 0 && y == 0;
                top.s_axis_video_tlast = x + kLanes >= kWidth;
                top.s_axis_video_tvalid = 1;
                for (bool taken = false; !taken;) {
                    top.eval();
                    taken = top.s_axis_video_tready;
                    clock();
                }
            }
        top.s_axis_video_tvalid = 0;
        for (quiet = 0; quiet < kQuiet;) clock();
    }
};

}  // namespace

int main(int, char** arguments) {
    std::vector<std::uint16_t> frames;
    std::FILE* file = std::fopen(arguments[1], "rb");
    for (int low; file && (low = std::getc(file)) != EOF;) frames.push_back(low | std::getc(file) << 8);

    auto core = std::make_unique<Core>();
    core->reset();
    unsigned address, value;
    for (char what; std::scanf(" %c", &what) == 1;) {
        if (what == 'r' && std::scanf("%u", &address) == 1) {
            std::printf("%u\n", core->read(address));
        } else if (what == 'w' && std::scanf("%u %u", &address, &value) == 2) {
            core->write(address, value);
            std::printf("ok\n");
        } else if (what == 'f' && std::scanf("%u", &value) == 1) {
            core->play(&frames.at(std::size_t{value} * kWidth * kHeight));
            std::printf("%zu\n", core->left.size());
            std::fwrite(core->left.data(), 1, core->left.size(), stdout);
            core->left.clear();
        } else if (what == 'i') {
            core->top.eval();
            std::printf("%d\n", core->top.interrupt_o);
        } else {
            return 2;
        }
        std::fflush(stdout);
    }
}
