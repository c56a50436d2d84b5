/* SPDX-License-Identifier: MIT OR Apache-2.0 */
/*
 * Driver of a Foveate core on AXI: its registers, and the packets that leave. C99 without a heap, without an operating system,
 * and for processors of either byte order. One driver serves several cores: what differs between them is read from registers.
 *
 *     foveate_core core;
 *     foveate_status status = foveate_init(&core, foveate_mapped((void *)0x43C00000), FOVEATE_ANY_DESIGN);
 *     if (status != FOVEATE_OK) fail(foveate_text(status));
 *
 *     const foveate_threshold both[] = {FOVEATE_THRESHOLD(EDGE_LEVEL, 120), FOVEATE_THRESHOLD(EDGE_MIN, 4)};
 *     status = foveate_set(&core, both, 2);
 *
 *     foveate_packet packet;
 *     foveate_reader reader = {.design = &core.design, .bytes = buffer, .size = received};
 *     while (foveate_next(&reader, &packet)) foveate_paint(&core.design, &packet, screen, core.design.width);
 */
#ifndef FOVEATE_H
#define FOVEATE_H

#include "foveate_registers.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* How registers are read and written: over a bus that the processor sees, a serial line, a simulation. Addresses are in bytes,
 * below the base of the core. */
typedef struct {
    uint32_t (*read)(void *context, uint32_t address);
    void (*write)(void *context, uint32_t address, uint32_t value);
    void *context;
} foveate_bus;

/* Registers that the processor sees at an address, in its own byte order. */
foveate_bus foveate_mapped(void *base);

typedef enum {
    FOVEATE_OK,
    FOVEATE_NO_CORE,       /* `identity` reads something else: a wrong address, or no clock */
    FOVEATE_OTHER_VERSION, /* its registers are not those of this driver */
    FOVEATE_OTHER_DESIGN,  /* its fingerprint is another */
    FOVEATE_TOO_LARGE      /* a value has more bits than its register; nothing was written */
} foveate_status;

/* A status in English. */
const char *foveate_text(foveate_status status);

/* What a core is, as its registers say. */
typedef struct {
    uint64_t fingerprint;
    uint32_t tick_rate; /* Hz: the time in packets counts so many in a second */
    uint16_t width, height;
    uint16_t columns, rows; /* of regions */
    uint8_t size;           /* N, pixels of a side of a region */
    uint8_t pixel_bits;     /* P */
    uint8_t means;          /* q, means of a side; 0 without summaries */
    uint8_t irrelevant;     /* FOVEATE_ZERO, FOVEATE_HOLD or FOVEATE_MEAN */
    bool raw;               /* raw pixels leave */
} foveate_design;

/* What the screen shows of an irrelevant region. */
#define FOVEATE_ZERO 0u
#define FOVEATE_HOLD 1u
#define FOVEATE_MEAN 2u

typedef struct {
    foveate_bus bus;
    foveate_design design;
} foveate_core;

/* The design that foveate_registers.h was made for, to be expected by foveate_init; and none in particular. */
#define FOVEATE_THIS_DESIGN (((uint64_t)FOVEATE_FINGERPRINT_HIGH_VALUE << 32) | FOVEATE_FINGERPRINT_LOW_VALUE)
#define FOVEATE_ANY_DESIGN 0u

/* Reads what a core is. It changes no register. */
foveate_status foveate_init(foveate_core *core, foveate_bus bus, uint64_t fingerprint);

/* Frames begin, or are left out. A frame that is under way goes on. Cores are started after a reset. */
void foveate_start(const foveate_core *core);
void foveate_stop(const foveate_core *core);
/* Whether a source waits until its frame may begin, or the frame is skipped. After a reset it is skipped. */
void foveate_let_wait(const foveate_core *core, bool waits);
/* Whether a frame is under way. */
bool foveate_is_busy(const foveate_core *core);
/* All references are forgotten between two frames, and whether that is still to come. */
void foveate_restart(const foveate_core *core);
bool foveate_is_restarting(const foveate_core *core);

/* A threshold and its new value. */
typedef struct {
    uint32_t address, mask, value;
} foveate_threshold;

/* One by its name in foveate_registers.h: FOVEATE_THRESHOLD(EDGE_LEVEL, 120). */
#define FOVEATE_THRESHOLD(name, value) \
    { FOVEATE_##name, FOVEATE_##name##_MASK, (value) }

/* Sets thresholds that hold together from the next frame on. While several are written no frame begins: one that comes in
 * these few clocks is left out. */
foveate_status foveate_set(const foveate_core *core, const foveate_threshold *thresholds, size_t count);

/* What has happened since it was cleared: bits as FOVEATE_EVENTS_..._MASK. */
uint32_t foveate_events(const foveate_core *core);
void foveate_clear(const foveate_core *core, uint32_t events);
/* Which of these raise interrupt_o; and as if they had happened, to try a handler. */
void foveate_enable_interrupts(const foveate_core *core, uint32_t events);
void foveate_pretend(const foveate_core *core, uint32_t events);

typedef struct {
    uint32_t frames;                     /* that came: modulo 2^32 */
    uint16_t repaired, skipped, dropped; /* frames, frames, regions: modulo 2^16 */
} foveate_counts;

foveate_counts foveate_count(const foveate_core *core);

enum { FOVEATE_PACKET_FRAME = 1, FOVEATE_PACKET_ROW = 2, FOVEATE_PACKET_REGION = 4, FOVEATE_PACKET_END = 5 };

/* The version of packets that this driver reads. */
#define FOVEATE_FORMAT 1u

/* A packet that is whole. What it carries stays in the bytes of the reader. */
typedef struct {
    uint8_t type;
    uint16_t version;     /* FRAME: of the packets; if it is not FOVEATE_FORMAT, this driver cannot read the others */
    bool first;           /* FRAME: the camera has forgotten all before; the screen is black */
    bool summary;         /* REGION: means in place of pixels */
    uint16_t row, column; /* of regions; ROW has a row, REGION both */
    uint32_t frame;       /* number of its frame */
    uint64_t fingerprint; /* FRAME: of the design */
    uint64_t time;        /* FRAME: in ticks */
    uint32_t regions;     /* END: REGION packets of the frame */
    uint32_t dropped;     /* END: regions of the frame that were dropped */
    uint16_t rows;        /* END: ROW packets of the frame that were dropped */
    const uint8_t *carried;
} foveate_packet;

/* Bytes in which packets are looked for. */
typedef struct {
    const foveate_design *design;
    const uint8_t *bytes; /* what is not looked at yet */
    size_t size;          /* of it */
    size_t lost;          /* bytes so far that are no packet */
    bool ended;           /* no more bytes come: what looks like the beginning of a packet is none */
} foveate_reader;

/* The next whole packet; false if there is none. Then `bytes` and `size` are the rest, from which a packet may grow: put it
 * before the bytes that come next. */
bool foveate_next(foveate_reader *reader, foveate_packet *packet);

enum { FOVEATE_SRS = 1, FOVEATE_TRS = 2, FOVEATE_SUMMARY = 4 };

/* The decision of a ROW about a region: FOVEATE_SRS, FOVEATE_TRS, FOVEATE_SUMMARY (it sends one now), or-ed. */
unsigned foveate_decision(const foveate_design *design, const foveate_packet *row, unsigned column);

/* A pixel or a mean of a REGION, row by row. */
unsigned foveate_value(const foveate_design *design, const foveate_packet *region, unsigned index);

/* Puts a packet on a screen of bytes, or of 16-bit numbers where P > 8 (foveate_paint16), of width x height pixels; `stride`
 * is how many pixels of the screen lie between two lines. When END has come, the screen shows the frame. A call with pixels
 * of the wrong size does nothing. */
void foveate_paint(const foveate_design *design, const foveate_packet *packet, uint8_t *screen, size_t stride);
void foveate_paint16(const foveate_design *design, const foveate_packet *packet, uint16_t *screen, size_t stride);

#ifdef __cplusplus
}
#endif

#endif
