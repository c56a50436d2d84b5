// SPDX-License-Identifier: MIT OR Apache-2.0
// Drives the buses of `{= top =}`. Reads one command per line from the standard input, and writes one line per word or answer of
// the core, with its clock, to the standard output. Made from the design.
//
//   argument 1   seed of gaps, stalls, delays, and of the values that registers have before reset
//   argument 2   file for waves, in a build with tracing
//
//   beat F DATA       offers pixels until they are taken; F is 1 with the first of a frame, 2 with the last of a line
//   gaps P, stalls P  from now on, offers or takes nothing in P percent of the clocks
//   hold N            takes no word for N clocks
//   write A D S       starts a write of D to register A with strobes S, and does not wait for the answer
//   read A            starts a read of register A, and does not wait for the answer
//   apart V           1: an access does not wait for the answers to earlier ones; 0: it waits for all of them
//   join              waits until all accesses are answered
//   interrupt V       reports an interrupt_o that differs from V
//   clear A D         from now on writes D to A at every clock at which a write can start; clear 0 0 ends that
//   rises             reports how often interrupt_o rose since the last of these commands, and how often at the edge of a `clear`
//   align P           waits for a clock whose number is P modulo 2
//   clocks N, idle N  waits N clocks, or until no word has been on the port for N clocks
//   taken             waits until the write that was started last has been taken
//   within            waits until a word of a packet has been taken that is not the last
//   reset N           resets the core for N clocks
//   patience N        a command that waits for more than N clocks is reported as stuck
//
// All inputs that mean nothing are random.

#include "V{= top =}.h"
#include "verilated.h"
#if VM_TRACE
#include "verilated_fst_c.h"
#endif

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <deque>
#include <memory>
#include <string>
#include <vector>

namespace {

using Top = V{= top =};
using Words = std::vector<std::uint32_t>;

constexpr std::size_t kVideoWords = {= video_words =};
constexpr std::size_t kOutputs = 13;

template <typename Port>
void put(Port& port, const Words& words) {
    QData value = words[0];
    if (words.size() > 1) value |= QData{words[1]} << 32;
    port = static_cast<Port>(value);
}

template <std::size_t Count>
void put(VlWide<Count>& port, const Words& words) {
    for (std::size_t word = 0; word < Count; ++word) port[word] = word < words.size() ? words[word] : 0;
}
{%- if has_store %}

template <typename Port>
Words get(const Port& port) {
    const QData value = port;
    return {static_cast<std::uint32_t>(value), static_cast<std::uint32_t>(value >> 32)};
}

template <std::size_t Count>
Words get(const VlWide<Count>& port) {
    Words words;
    for (std::size_t word = 0; word < Count; ++word) words.push_back(port[word]);
    return words;
}
{%- endif %}

// SplitMix64.
class Random {
  public:
    explicit Random(std::uint64_t seed) : state_(seed) {}
    std::uint64_t next() {
        std::uint64_t z = state_ += 0x9e3779b97f4a7c15U;
        z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9U;
        z = (z ^ (z >> 27)) * 0x94d049bb133111ebU;
        return z ^ (z >> 31);
    }
    bool percent(unsigned long long of) { return next() % 100 < of; }
    std::uint32_t word() { return static_cast<std::uint32_t>(next()); }

  private:
    std::uint64_t state_;
};

struct Access {
    std::uint64_t order;
    std::uint32_t address, data, strobe;
};

// An access: reads or writes that are offered, and those that are taken and wait for their answers.
struct Transfer {
    bool busy = false;
    bool address_taken = false, data_taken = false;
    unsigned address_delay = 0, data_delay = 0;
    Access access{};
    std::deque<Access> taken{};
    // The next answer is taken only after it was offered.
    bool takes_late = false;

    bool waits() const { return busy || !taken.empty(); }
    void take() {
        taken.push_back(access);
        busy = address_taken = data_taken = false;
    }
};

class Bench {
  public:
    Bench(VerilatedContext& context, Top& top, std::uint64_t seed) : context_(context), top_(top), random_(seed) {}

    // Returns false if a line is not a command.
    bool take(char* line) {
        char* rest = nullptr;
        char* const word = strtok_r(line, " \n", &rest);
        if (word == nullptr) return true;
        std::array<unsigned long long, 3> numbers{};
        if (std::strcmp(word, "beat") == 0) return beat(rest);
        for (auto& number : numbers) {
            const char* const text = strtok_r(nullptr, " \n", &rest);
            if (text != nullptr) number = std::strtoull(text, nullptr, 16);
        }
        const std::string what = word;
        if (what == "gaps") gaps_ = numbers[0];
        else if (what == "stalls") stalls_ = numbers[0];
        else if (what == "hold") held_ = numbers[0];
        else if (what == "write" || what == "read") {
            auto& queue = what == "write" ? writes_ : reads_;
            queue.push_back({order_++, static_cast<std::uint32_t>(numbers[0]), static_cast<std::uint32_t>(numbers[1]),
                             static_cast<std::uint32_t>(numbers[2])});
        } else if (what == "apart") apart_ = numbers[0] != 0;
        else if (what == "patience") patience_ = numbers[0];
        else if (what == "interrupt") {
            if (top_.interrupt_o != numbers[0]) wrong("interrupt_o", "it is not what it must be");
        } else if (what == "clear") {
            clears_ = numbers[0] != 0;
            clear_ = {0, static_cast<std::uint32_t>(numbers[0]), static_cast<std::uint32_t>(numbers[1]), 0xF};
        } else if (what == "rises") {
            std::printf("rises %llu %llu %llu\n", clock_, rises_, met_);
            rises_ = met_ = 0;
        } else if (what == "taken") {
            return wait([this] { return writes_.empty() && !write_.busy; });
        } else if (what == "within") {
            return wait([this] { return within_; });
        } else if (what == "align") {
            return wait([this, numbers] { return clock_ % 2 == numbers[0] % 2; });
        } else if (what == "join") return wait([this] { return settled(); });
        else if (what == "clocks") {
            const auto end = clock_ + numbers[0];
            return wait([this, end] { return clock_ >= end; });
        } else if (what == "idle") {
            const auto clocks = numbers[0];
            busy_ = clock_;
            return wait([this, clocks] { return (clears_ || settled()) && held_ == 0 && clock_ - busy_ >= clocks; });
        } else if (what == "reset") return reset(numbers[0]);
        else return false;
        return true;
    }

    void finish() {
        std::printf("end %llu %llu\n", clock_, blocked_);
#if VM_TRACE
        waves_.close();
#endif
        top_.final();
    }

#if VM_TRACE
    void trace(const char* file) {
        top_.trace(&waves_, 99);
        waves_.open(file);
    }
#endif

  private:
    template <typename Done>
    bool wait(Done done) {
        const auto end = clock_ + patience_;
        while (!done()) {
            if (clock_ >= end) return wrong(offering_ ? "s_axis_video" : "m_axis_packets", "it does not go on"), false;
            step();
        }
        return true;
    }

    bool beat(char* rest) {
        const char* const flags = strtok_r(nullptr, " \n", &rest);
        const char* const digits = strtok_r(nullptr, " \n", &rest);
        if (flags == nullptr || digits == nullptr) return false;
        flags_ = static_cast<unsigned>(std::strtoul(flags, nullptr, 16));
        pixels_.assign(kVideoWords, 0);
        std::size_t end = std::strlen(digits);
        for (auto& word : pixels_) {
            const std::size_t begin = end > 8 ? end - 8 : 0;
            word = static_cast<std::uint32_t>(std::strtoul(std::string(digits + begin, end - begin).c_str(), nullptr, 16));
            end = begin;
        }
        taken_ = false;
        wanting_ = true;
        const bool passes = wait([this] { return taken_; });
        wanting_ = false;
        return passes;
    }

    bool reset(unsigned long long clocks) {
        writes_.clear();
        reads_.clear();
        write_ = {};
        read_ = {};
        wanting_ = offering_ = false;
        held_ = rises_ = met_ = 0;
        clears_ = within_ = false;
        resetting_ = true;
        answer_stays_b_ = answer_stays_r_ = false;
        for (unsigned long long count = 0; count < clocks; ++count) step();
        if (top_.m_axis_packets_tvalid || top_.s_axi_bvalid || top_.s_axi_rvalid) wrong("aresetn", "something is valid");
        resetting_ = false;
        std::printf("reset %llu\n", clock_);
        return true;
    }

    bool settled() const { return writes_.empty() && reads_.empty() && !write_.waits() && !read_.waits(); }

    void wrong(const char* port, const char* text) { std::printf("wrong %llu %s %s\n", clock_, port, text); }

    // One clock: the inputs change, the outputs are checked not to follow them, and then the edge comes.
    void step() {
        drive_video();
        drive_registers();
        drive_sink();
        drive_store();
        top_.aresetn = !resetting_;
        top_.aclk = 0;
        top_.eval();
        dump();
        if (clock_ > 0 && !resetting_ && outputs() != before_) wrong("outputs", "one follows an input in the same clock");
        see_video();
        const bool waits = see_packets();
        const QData word = top_.m_axis_packets_tdata;
        const bool last = top_.m_axis_packets_tlast;
        see_registers();
        see_store();
        const bool was_raised = top_.interrupt_o;
        const bool is_cleared = clears_ && top_.s_axi_awvalid && top_.s_axi_awready && top_.s_axi_wvalid && top_.s_axi_wready;
        top_.aclk = 1;
        top_.eval();
        dump();
        ++clock_;
        if (waits && !resetting_ && !(top_.m_axis_packets_tvalid && top_.m_axis_packets_tdata == word && top_.m_axis_packets_tlast == last)) {
            wrong("m_axis_packets", "a word that was not taken has not stayed");
        }
        if (top_.m_axis_packets_tvalid) busy_ = clock_;
        if (!was_raised && top_.interrupt_o && !resetting_) {
            ++rises_;
            met_ += is_cleared;
        }
        before_ = outputs();
    }

    std::array<QData, kOutputs> outputs() const {
        return {top_.s_axis_video_tready, top_.m_axis_packets_tvalid, top_.m_axis_packets_tdata, top_.m_axis_packets_tkeep,
                top_.m_axis_packets_tlast, top_.s_axi_awready, top_.s_axi_wready, top_.s_axi_bvalid,
                top_.s_axi_arready, top_.s_axi_rvalid, top_.s_axi_rdata,
                static_cast<QData>(top_.s_axi_bresp << 2 | top_.s_axi_rresp), top_.interrupt_o};
    }

    void drive_video() {
        if (wanting_ && !offering_) offering_ = !random_.percent(gaps_);
        top_.s_axis_video_tvalid = offering_;
        Words words = pixels_;
        if (!offering_) {
            words.assign(kVideoWords, 0);
            for (auto& word : words) word = random_.word();
        }
        put(top_.s_axis_video_tdata, words);
        top_.s_axis_video_tuser = offering_ ? flags_ & 1 : random_.next() & 1;
        top_.s_axis_video_tlast = offering_ ? flags_ >> 1 & 1 : random_.next() & 1;
    }

    void see_video() {
        if (!offering_ || resetting_) return;
        if (top_.s_axis_video_tready) {
            taken_ = true;
            wanting_ = offering_ = false;
        } else {
            ++blocked_;
        }
    }

    void drive_sink() {
        top_.m_axis_packets_tready = held_ == 0 && !random_.percent(stalls_);
        if (held_ > 0) --held_;
    }

    // Reports a word that is taken. Returns whether a word stays on the port.
    bool see_packets() {
        if (resetting_ || !top_.m_axis_packets_tvalid) return false;
        if (top_.m_axis_packets_tkeep != 0xFF) wrong("m_axis_packets_tkeep", "it is not all ones");
        if (!top_.m_axis_packets_tready) return true;
        within_ = !top_.m_axis_packets_tlast;
        std::printf("packet %llu %016llx %d\n", clock_, static_cast<unsigned long long>(top_.m_axis_packets_tdata),
                    static_cast<int>(top_.m_axis_packets_tlast));
        return false;
    }

    void begin(Transfer& transfer, std::deque<Access>& own, const Transfer& other, const std::deque<Access>& others) {
        if (transfer.busy || own.empty()) return;
        const bool is_alone = transfer.taken.empty() && !other.waits();
        const bool is_next = is_alone && (others.empty() || own.front().order < others.front().order);
        if (!apart_ && !is_next) return;
        transfer.busy = true;
        transfer.address_delay = static_cast<unsigned>(random_.next() % 4);
        transfer.data_delay = static_cast<unsigned>(random_.next() % 4);
        transfer.access = own.front();
        own.pop_front();
    }

    // A write of `clear` is offered at once, and its answer is taken at once.
    void begin_clear() {
        if (!clears_ || write_.busy || !writes_.empty()) return;
        write_.busy = true;
        write_.address_delay = write_.data_delay = 0;
        write_.access = clear_;
    }

    void drive_registers() {
        if (!resetting_) {
            begin_clear();
            begin(write_, writes_, read_, reads_);
            begin(read_, reads_, write_, writes_);
        }
        top_.s_axi_awvalid = write_.busy && !write_.address_taken && write_.address_delay == 0;
        top_.s_axi_wvalid = write_.busy && !write_.data_taken && write_.data_delay == 0;
        top_.s_axi_arvalid = read_.busy && !read_.address_taken && read_.address_delay == 0;
        top_.s_axi_awaddr = (top_.s_axi_awvalid ? write_.access.address : random_.word()) & 0xFFF;
        top_.s_axi_wdata = top_.s_axi_wvalid ? write_.access.data : random_.word();
        top_.s_axi_wstrb = (top_.s_axi_wvalid ? write_.access.strobe : random_.word()) & 0xF;
        top_.s_axi_araddr = (top_.s_axi_arvalid ? read_.access.address : random_.word()) & 0xFFF;
        top_.s_axi_awprot = random_.word() & 7;
        top_.s_axi_arprot = random_.word() & 7;
        top_.s_axi_bready = clears_ || (random_.percent(50) && (top_.s_axi_bvalid || !write_.takes_late));
        top_.s_axi_rready = random_.percent(50) && (top_.s_axi_rvalid || !read_.takes_late);
    }

    void answered(Transfer& transfer) {
        if (!transfer.taken.empty()) transfer.taken.pop_front();
        transfer.takes_late = random_.percent(50);
    }

    void see_registers() {
        if (resetting_) return;
        if (top_.s_axi_bvalid && write_.taken.empty()) wrong("s_axi_b", "nothing was written");
        if (top_.s_axi_rvalid && read_.taken.empty()) wrong("s_axi_r", "nothing was asked");
        if (top_.s_axi_bvalid && top_.s_axi_bresp != 0) wrong("s_axi_bresp", "it is not OKAY");
        if (top_.s_axi_rvalid && top_.s_axi_rresp != 0) wrong("s_axi_rresp", "it is not OKAY");
        const bool stays_b = top_.s_axi_bvalid && !top_.s_axi_bready;
        if (answer_stays_b_ && !top_.s_axi_bvalid) wrong("s_axi_b", "an answer that was not taken has not stayed");
        answer_stays_b_ = stays_b;
        const bool stays_r = top_.s_axi_rvalid && !top_.s_axi_rready;
        if (answer_stays_r_ && !(top_.s_axi_rvalid && top_.s_axi_rdata == answer_)) wrong("s_axi_r", "an answer that was not taken has not stayed");
        answer_stays_r_ = stays_r;
        answer_ = top_.s_axi_rdata;
        if (top_.s_axi_bvalid && top_.s_axi_bready) answered(write_);
        if (top_.s_axi_rvalid && top_.s_axi_rready) {
            const auto address = read_.taken.empty() ? 0 : read_.taken.front().address;
            std::printf("read %llu %x %x\n", clock_, address, static_cast<unsigned>(top_.s_axi_rdata));
            answered(read_);
        }
        if (top_.s_axi_awvalid && top_.s_axi_awready) write_.address_taken = true;
        if (top_.s_axi_wvalid && top_.s_axi_wready) write_.data_taken = true;
        if (write_.address_taken && write_.data_taken) write_.take();
        if (top_.s_axi_arvalid && top_.s_axi_arready) read_.take();
        if (write_.address_delay > 0) --write_.address_delay;
        if (write_.data_delay > 0) --write_.data_delay;
        if (read_.address_delay > 0) --read_.address_delay;
    }
{% if has_store %}
    // A memory for references that is never late.
    void drive_store() {
        top_.reference_valid_i = !store_.empty();
        Words words(4, random_.word());
        put(top_.reference_pixel_i, store_.empty() ? words : store_.front());
    }

    void see_store() {
        if (top_.underrun_o && !resetting_) wrong("underrun_o", "a reference was missing");
        if (top_.reference_ready_o && !store_.empty()) store_.pop_front();
        if (top_.store_valid_o) store_.push_back(get(top_.store_pixel_o));
        if (resetting_ || top_.forget_o) store_.clear();
    }

    std::deque<Words> store_;
{%- else %}
    void drive_store() {}
    void see_store() {}
{%- endif %}

    void dump() {
#if VM_TRACE
        waves_.dump(context_.time());
#endif
        context_.timeInc(1);
    }

    VerilatedContext& context_;
    Top& top_;
    Random random_;
#if VM_TRACE
    VerilatedFstC waves_;
#endif
    unsigned long long clock_ = 0, blocked_ = 0, busy_ = 0, held_ = 0, gaps_ = 0, stalls_ = 0, patience_ = 100000;
    unsigned long long rises_ = 0, met_ = 0;
    std::array<QData, kOutputs> before_{};
    bool resetting_ = false, apart_ = false, clears_ = false, within_ = false;
    Access clear_{};
    bool wanting_ = false, offering_ = false, taken_ = false;
    unsigned flags_ = 0;
    Words pixels_ = Words(kVideoWords, 0);
    std::uint64_t order_ = 0;
    std::deque<Access> writes_, reads_;
    Transfer write_, read_;
    bool answer_stays_b_ = false, answer_stays_r_ = false;
    QData answer_ = 0;
};

}  // namespace

int main(int argc, char** argv) {
    const auto seed = argc > 1 ? std::strtoull(argv[1], nullptr, 10) : 1;
    const auto context = std::make_unique<VerilatedContext>();
    context->randReset(2);
    context->randSeed(static_cast<int>(seed % 0x7ffffffe + 1));
#if VM_TRACE
    context->traceEverOn(true);
#endif
    const auto top = std::make_unique<Top>(context.get());
    Bench bench(*context, *top, seed);
#if VM_TRACE
    bench.trace(argc > 2 ? argv[2] : "waves.fst");
#endif
    std::array<char, 256> line{};
    while (std::fgets(line.data(), line.size(), stdin) != nullptr && bench.take(line.data())) {
    }
    bench.finish();
    return std::fclose(stdout) == 0 ? 0 : 2;
}
