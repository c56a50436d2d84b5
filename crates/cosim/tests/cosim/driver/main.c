/* SPDX-License-Identifier: MIT OR Apache-2.0 */
/* Software for a processor beside a core, as a user would write it with the driver. It sends commands to core.cpp on its standard
 * output, and reads answers from its standard input. The screen after each frame goes into the file of argument 1. */
#include "foveate.h"

#include <stdio.h>
#include <stdlib.h>

#define CHECK(right)                                             \
    do {                                                         \
        if (!(right)) {                                          \
            fprintf(stderr, "line %d: not %s\n", __LINE__, #right); \
            exit(1);                                             \
        }                                                        \
    } while (0)

enum { MOST = 1 << 20 };

static unsigned answer(void) {
    unsigned value;
    fflush(stdout);
    CHECK(scanf("%u", &value) == 1);
    return value;
}

static uint32_t read_core(void *context, uint32_t address) {
    CHECK(context == stdout);
    printf("r %u\n", (unsigned)address);
    return answer();
}

static void write_core(void *context, uint32_t address, uint32_t value) {
    char ok[3];
    CHECK(context == stdout);
    printf("w %u %u\n", (unsigned)address, (unsigned)value);
    fflush(stdout);
    CHECK(scanf("%2s", ok) == 1);
}

static unsigned interrupt(void) {
    printf("i\n");
    return answer();
}

/* Sets the classes of all regions in turn, from the class `first` on: the classes of the model in mod.rs. */
static void set_classes(const foveate_core *core, unsigned first) {
#ifdef FOVEATE_ZONE_WORD
    static uint8_t classes[MOST];
    const size_t regions = (size_t)core->design.columns * core->design.rows;
    for (size_t at = 0; at < regions; ++at) classes[at] = (uint8_t)((first + at) % 4);
    const uint16_t version = foveate_map_version(core);
    classes[regions - 1] = 4;
    CHECK(foveate_set_classes(core, classes) == FOVEATE_TOO_LARGE && foveate_map_version(core) == version);
    classes[regions - 1] = (uint8_t)((first + regions - 1) % 4);
    /* A map that other software left half written moves the address on. */
    write_core(stdout, FOVEATE_ZONE_WORD, UINT32_MAX);
    CHECK(foveate_set_classes(core, classes) == FOVEATE_OK);
    CHECK(foveate_map_version(core) == version + 1);
#else
    CHECK(core && first < 4);
#endif
}

static unsigned map_version(const foveate_core *core) {
#ifdef FOVEATE_ZONE_WORD
    return foveate_map_version(core);
#else
    return core ? 0 : 1;
#endif
}

/* Plays a frame, and puts its packets on the screen and the screen into the file. Returns the number of packets. */
static unsigned play(const foveate_core *core, unsigned number, bool is_first, FILE *file) {
    static uint8_t buffer[MOST], bytes[MOST];
    static uint16_t numbers[MOST];
    foveate_packet packet;
    foveate_reader reader = {&core->design, buffer, 0, 0, true};
    unsigned count = 0, frames = 0, regions = 0;
    printf("f %u\n", number);
    reader.size = answer();
    CHECK(reader.size <= MOST && getchar() == '\n');
    CHECK(fread(buffer, 1, reader.size, stdin) == reader.size);
    for (; foveate_next(&reader, &packet); ++count) {
        foveate_paint(&core->design, &packet, bytes, core->design.width);
        foveate_paint16(&core->design, &packet, numbers, core->design.width);
        regions += packet.type == FOVEATE_PACKET_REGION;
        if (packet.type == FOVEATE_PACKET_FRAME) {
            ++frames;
            CHECK(packet.version == FOVEATE_FORMAT && packet.first == is_first);
            CHECK(packet.fingerprint == core->design.fingerprint);
            CHECK(packet.map_version == map_version(core));
        }
        if (packet.type == FOVEATE_PACKET_END) {
            CHECK(packet.regions == regions && packet.dropped == 0 && packet.rows == 0);
            for (size_t at = 0; at < (size_t)core->design.width * core->design.height; ++at) {
                const unsigned pixel = core->design.pixel_bits <= 8 ? bytes[at] : numbers[at];
                putc((int)(pixel & 255), file);
                putc((int)(pixel >> 8), file);
            }
        }
    }
    CHECK(reader.lost == 0 && reader.size == 0 && frames <= 1);
    return count;
}

int main(int count, char **arguments) {
    static const foveate_threshold thresholds[] = {THRESHOLDS};
    const size_t all = sizeof thresholds / sizeof thresholds[0];
    const foveate_bus bus = {read_core, write_core, stdout};
    const foveate_threshold large[] = {thresholds[0], {thresholds[0].address, thresholds[0].mask, thresholds[0].mask + 1}};
    foveate_core core;
    FILE *file;
    CHECK(count == 2);
    file = fopen(arguments[1], "wb");
    CHECK(file);

    CHECK(foveate_init(&core, bus, FOVEATE_THIS_DESIGN + 1) == FOVEATE_OTHER_DESIGN);
    CHECK(foveate_init(&core, bus, FOVEATE_ANY_DESIGN) == FOVEATE_OK);
    CHECK(foveate_init(&core, bus, FOVEATE_THIS_DESIGN) == FOVEATE_OK);
    CHECK(core.design.tick_rate == 100000000);

    /* A call with several thresholds leaves `control` as it was, and writes none if one value is too large. */
    foveate_let_wait(&core, true);
    CHECK(foveate_set(&core, large, 2) == FOVEATE_TOO_LARGE);
    CHECK(read_core(stdout, thresholds[0].address) != thresholds[0].value);
    CHECK(foveate_set(&core, thresholds, all) == FOVEATE_OK);
    for (size_t at = 0; at < all; ++at) CHECK(read_core(stdout, thresholds[at].address) == thresholds[at].value);
    CHECK(read_core(stdout, FOVEATE_CONTROL) == (FOVEATE_CONTROL_ENABLE_MASK | FOVEATE_CONTROL_WAIT_MASK));
    foveate_let_wait(&core, false);

    for (unsigned frame = 0; frame < 4; ++frame) {
        if (frame > 0) set_classes(&core, frame);
        CHECK(play(&core, frame, frame == 0, file) > 0);
    }
    CHECK(!foveate_is_busy(&core));

    foveate_stop(&core);
    CHECK(play(&core, 4, false, file) == 0);
    foveate_start(&core);
    CHECK(play(&core, 5, false, file) > 0);

    foveate_restart(&core);
    while (foveate_is_restarting(&core)) {}
    CHECK(play(&core, 6, true, file) > 0);

    CHECK(foveate_events(&core) == FOVEATE_EVENTS_FRAME_DONE_MASK);
    foveate_clear(&core, FOVEATE_EVENTS_FRAME_DONE_MASK);
    CHECK(foveate_events(&core) == 0);
    foveate_enable_interrupts(&core, FOVEATE_EVENTS_SOF_LATE_MASK);
    CHECK(interrupt() == 0);
    foveate_pretend(&core, FOVEATE_EVENTS_SOF_LATE_MASK);
    CHECK(interrupt() == 1 && foveate_events(&core) == FOVEATE_EVENTS_SOF_LATE_MASK);
    foveate_clear(&core, FOVEATE_EVENTS_SOF_LATE_MASK);
    CHECK(interrupt() == 0);

    const foveate_counts counts = foveate_count(&core);
    CHECK(counts.repaired == 0 && counts.skipped == 0 && counts.dropped == 0);
    fprintf(stderr, "%u", (unsigned)counts.frames);
    return fclose(file);
}
