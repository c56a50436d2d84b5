// SPDX-License-Identifier: MIT OR Apache-2.0
// Clocks `{= top =}`: reads one packed record of inputs per clock from the standard input and writes one packed record of
// outputs per clock to the standard output. Made from the list of ports.
//
//   argument 1   seed of the values that registers have before reset
//   argument 2   file for waves, in a build with tracing
//   argument 3   seconds: after all records, they are clocked again from memory, as often as fits into this time, and
//                the last line of the standard error says how long that took; the standard input must be a file
//
// Outputs are those after the rising edge, with the inputs of that edge still applied.

#include "V{= top =}.h"
#include "verilated.h"
#if VM_TRACE
#include "verilated_fst_c.h"
#endif

#include <chrono>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <type_traits>
#include <unistd.h>
#include <vector>

namespace {

constexpr std::size_t kInputBytes = {= inputs.record_bytes() =};
constexpr std::size_t kOutputBytes = {= outputs.record_bytes() =};
constexpr std::size_t kBatch = (std::size_t{1} << 18) / (kInputBytes + kOutputBytes) + 1;

template <int Bits>
using Storage = std::conditional_t<
    (Bits <= 8), CData,
    std::conditional_t<
        (Bits <= 16), SData,
        std::conditional_t<(Bits <= 32), IData,
                           std::conditional_t<(Bits <= 64), QData, VlWide<(Bits + 31) / 32>>>>>;

template <int Bits, typename Port>
constexpr bool kFits = std::is_same<std::remove_reference_t<Port>, Storage<Bits>>::value;

// Values travel with their lowest byte first.
template <typename Port>
void put(Port& port, const unsigned char* from, std::size_t bytes) {
    QData value = 0;
    for (std::size_t i = 0; i < bytes; ++i) value |= QData{from[i]} << (8 * i);
    port = static_cast<Port>(value);
}

template <std::size_t Words>
void put(VlWide<Words>& port, const unsigned char* from, std::size_t bytes) {
    for (std::size_t word = 0; word < Words; ++word) port[word] = 0;
    for (std::size_t i = 0; i < bytes; ++i) port[i / 4] |= EData{from[i]} << (8 * (i % 4));
}

template <typename Port>
void get(const Port& port, unsigned char* to, std::size_t bytes) {
    for (std::size_t i = 0; i < bytes; ++i) {
        to[i] = static_cast<unsigned char>(static_cast<QData>(port) >> (8 * i));
    }
}

template <std::size_t Words>
void get(const VlWide<Words>& port, unsigned char* to, std::size_t bytes) {
    for (std::size_t i = 0; i < bytes; ++i) {
        to[i] = static_cast<unsigned char>(port[i / 4] >> (8 * (i % 4)));
    }
}

using Top = V{= top =};

void apply(Top& top, const unsigned char* record) {
    {%- for field in inputs.fields() %}
    static_assert(kFits<{= field.port.bits() =}, decltype(top.{= field.port.name =})>,
                  "{= field.port.name =} must be {= field.port.bits() =} bits wide");
    put(top.{= field.port.name =}, record + {= field.offset =}, {= field.bytes =});
    {%- endfor %}
}

void collect(const Top& top, unsigned char* record) {
    {%- for field in outputs.fields() %}
    static_assert(kFits<{= field.port.bits() =}, decltype(top.{= field.port.name =})>,
                  "{= field.port.name =} must be {= field.port.bits() =} bits wide");
    get(top.{= field.port.name =}, record + {= field.offset =}, {= field.bytes =});
    {%- endfor %}
}

double seconds_since(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

// Returns the largest memory of the process so far in kilobytes, or 0 if the system does not report it.
long peak_kilobytes() {
    long peak = 0;
    if (std::FILE* const status = std::fopen("/proc/self/status", "r")) {
        char line[256];
        while (std::fgets(line, sizeof line, status) != nullptr) {
            if (std::strncmp(line, "VmHWM:", 6) == 0) peak = std::atol(line + 6);
        }
        std::fclose(status);
    }
    return peak;
}

// Clocks the records again and again, without files and without using the outputs. The inputs are unpacked at every clock;
// the time of that alone is measured afterwards.
bool time_from_memory(Top& top, std::size_t count, double at_least) {
    const long peak = peak_kilobytes();
    std::vector<unsigned char> records(count * kInputBytes);
    std::rewind(stdin);
    if (std::fread(records.data(), kInputBytes, count, stdin) != count) return false;
    std::size_t passes = 0;
    const auto start = std::chrono::steady_clock::now();
    do {
        for (std::size_t i = 0; i < count; ++i) {
            apply(top, records.data() + i * kInputBytes);
            top.{= clock =} = 0;
            top.eval();
            top.{= clock =} = 1;
            top.eval();
        }
        ++passes;
    } while (seconds_since(start) < at_least);
    const double seconds = seconds_since(start);
    const auto applying = std::chrono::steady_clock::now();
    for (std::size_t i = 0; i < count; ++i) apply(top, records.data() + i * kInputBytes);
    const double applied = seconds_since(applying) * static_cast<double>(passes);
    std::fprintf(stderr, "\nTIMED passes %zu seconds %.9f applying %.9f kilobytes %ld\n", passes,
                 seconds, applied, peak);
    return true;
}

}  // namespace

int main(int argc, char** argv) {
    // Keeps texts that the Verilog prints from between the records.
    std::FILE* const records_out = fdopen(dup(STDOUT_FILENO), "wb");
    if (records_out == nullptr || dup2(STDERR_FILENO, STDOUT_FILENO) < 0) return 2;

    const auto context = std::make_unique<VerilatedContext>();
    context->randReset(2);
    context->randSeed(argc > 1 ? std::atoi(argv[1]) : 1);
#if VM_TRACE
    context->traceEverOn(true);
#endif
    const auto top = std::make_unique<Top>(context.get());
#if VM_TRACE
    VerilatedFstC waves;
    top->trace(&waves, 99);
    waves.open(argc > 2 ? argv[2] : "waves.fst");
#endif

    const double timed = argc > 3 ? std::atof(argv[3]) : 0;
    std::size_t clocks = 0;
    std::vector<unsigned char> inputs(kBatch * kInputBytes);
    std::vector<unsigned char> outputs(kBatch * kOutputBytes);
    for (;;) {
        const std::size_t bytes = std::fread(inputs.data(), 1, inputs.size(), stdin);
        if (bytes == 0) break;
        if (bytes % kInputBytes != 0) {
            std::fprintf(stderr, "the input ends within a record\n");
            return 2;
        }
        const std::size_t records = bytes / kInputBytes;
        clocks += records;
        for (std::size_t i = 0; i < records; ++i) {
            apply(*top, inputs.data() + i * kInputBytes);
            top->{= clock =} = 0;
            top->eval();
#if VM_TRACE
            waves.dump(context->time());
#endif
            context->timeInc(1);
            top->{= clock =} = 1;
            top->eval();
#if VM_TRACE
            waves.dump(context->time());
#endif
            context->timeInc(1);
            collect(*top, outputs.data() + i * kOutputBytes);
        }
        if (std::fwrite(outputs.data(), kOutputBytes, records, records_out) != records) {
            std::fprintf(stderr, "cannot write the outputs\n");
            return 2;
        }
    }
    if (timed > 0 && !time_from_memory(*top, clocks, timed)) {
        std::fprintf(stderr, "the input cannot be read twice\n");
        return 2;
    }
#if VM_TRACE
    waves.close();
#endif
    top->final();
    return std::fclose(records_out) == 0 ? 0 : 2;
}
