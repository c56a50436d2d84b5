/* SPDX-License-Identifier: MIT OR Apache-2.0 */
/*
 * Driver of a Foveate core on AXI: its registers, and the packets that it sends. C99, without a heap or an operating system,
 * for processors of either byte order. One driver serves several cores: it reads their differences from registers.
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

/* Access to registers: over a bus of the processor, a serial line, or a simulation. Addresses are in bytes, relative to the base
 * of the core. */
typedef struct {
    uint32_t (*read)(void *context, uint32_t address);
    void (*write)(void *context, uint32_t address, uint32_t value);
    void *context;
} foveate_bus;

/* Returns the access to registers that are in the address space of the processor, in its own byte order. */
foveate_bus foveate_mapped(void *base);

typedef enum {
    FOVEATE_OK,
    FOVEATE_NO_CORE,       /* `identity` has another value: the address is wrong, or the core has no clock */
    FOVEATE_OTHER_VERSION, /* the core has another version of registers than this driver */
    FOVEATE_OTHER_DESIGN,  /* the core has another fingerprint than the expected one */
    FOVEATE_TOO_LARGE,     /* a value has more bits than its register; nothing was written */
    FOVEATE_BUSY           /* a map of classes still waits for the end of a frame; nothing was written */
} foveate_status;

/* Returns the text of a status, in English. */
const char *foveate_text(foveate_status status);

/* The properties of a core, read from its registers. */
typedef struct {
    uint64_t fingerprint;
    uint32_t tick_rate; /* Hz: ticks per second of the time in packets */
    uint16_t width, height;
    uint16_t columns, rows; /* number of columns and rows of regions */
    uint8_t size;           /* N, pixels of a side of a region */
    uint8_t pixel_bits;     /* P, bits of a pixel */
    uint8_t means;          /* q, blocks of a side of a region; 0 without summaries */
    uint8_t irrelevant;     /* FOVEATE_ZERO, FOVEATE_HOLD or FOVEATE_MEAN */
    bool raw;               /* raw pixels are sent; false: denoised ones */
} foveate_design;

/* The values that the screen shows for an irrelevant region. */
#define FOVEATE_ZERO 0u
#define FOVEATE_HOLD 1u
#define FOVEATE_MEAN 2u

typedef struct {
    foveate_bus bus;
    foveate_design design;
} foveate_core;

/* Fingerprints that foveate_init can expect: that of the design of foveate_registers.h, and any. */
#define FOVEATE_THIS_DESIGN (((uint64_t)FOVEATE_FINGERPRINT_HIGH_VALUE << 32) | FOVEATE_FINGERPRINT_LOW_VALUE)
#define FOVEATE_ANY_DESIGN 0u

/* Reads the properties of a core. Changes no register. */
foveate_status foveate_init(foveate_core *core, foveate_bus bus, uint64_t fingerprint);

/* Lets frames begin, or be left out. A frame that is under way goes on. After a reset, a core is started. */
void foveate_start(const foveate_core *core);
void foveate_stop(const foveate_core *core);
/* Chooses whether the source waits until its frame may begin (true), or the frame is skipped. After a reset it is skipped. */
void foveate_let_wait(const foveate_core *core, bool waits);
/* Returns whether a frame is under way. */
bool foveate_is_busy(const foveate_core *core);
/* Requests that all references become invalid between two frames. The second function returns whether that is still to come. */
void foveate_restart(const foveate_core *core);
bool foveate_is_restarting(const foveate_core *core);

/* A threshold and its new value. */
typedef struct {
    uint32_t address, mask, value;
} foveate_threshold;

/* A threshold by its name in foveate_registers.h: FOVEATE_THRESHOLD(EDGE_LEVEL, 120). */
#define FOVEATE_THRESHOLD(name, value) \
    { FOVEATE_##name, FOVEATE_##name##_MASK, (value) }

/* Sets thresholds that take effect together, from the next frame on. While several are written no frame begins: a frame that
 * comes in these few clocks is left out. */
foveate_status foveate_set(const foveate_core *core, const foveate_threshold *thresholds, size_t count);

#ifdef FOVEATE_ZONE_WORD
/* The classes of regions. */
enum { FOVEATE_NORMAL = 0, FOVEATE_OFF = 1, FOVEATE_KEEN = 2, FOVEATE_ALWAYS = 3 };

/* Writes a map and commits it: frames that begin later use it. `classes` has columns * rows classes of regions, row by row. Nothing is
 * written, and the result is FOVEATE_TOO_LARGE, if a class is above FOVEATE_ALWAYS; or FOVEATE_BUSY, if the map before still waits for
 * the end of a frame: then call it again later. The second function returns the version of the map that was committed last, modulo
 * 2^16, which the FRAME packets of frames with this map have. */
foveate_status foveate_set_classes(const foveate_core *core, const uint8_t *classes);
uint16_t foveate_map_version(const foveate_core *core);
#endif

/* Returns, or clears, the events since they were cleared last: bits as FOVEATE_EVENTS_..._MASK. */
uint32_t foveate_events(const foveate_core *core);
void foveate_clear(const foveate_core *core, uint32_t events);
/* Chooses the events that raise interrupt_o, or raises events as if they had happened, to try a handler. */
void foveate_enable_interrupts(const foveate_core *core, uint32_t events);
void foveate_pretend(const foveate_core *core, uint32_t events);

typedef struct {
    uint32_t frames;                     /* frames that were offered, modulo 2^32 */
    uint16_t repaired, skipped, dropped; /* repaired frames, skipped frames, dropped regions, modulo 2^16 */
} foveate_counts;

foveate_counts foveate_count(const foveate_core *core);

enum { FOVEATE_PACKET_FRAME = 1, FOVEATE_PACKET_ROW = 2, FOVEATE_PACKET_REGION = 4, FOVEATE_PACKET_END = 5 };

/* The version of packets that this driver reads. */
#define FOVEATE_FORMAT 1u

/* A whole packet. Its payload stays in the bytes of the reader. */
typedef struct {
    uint8_t type;
    uint16_t version;     /* FRAME: version of the packets; if it is not FOVEATE_FORMAT, this driver cannot read the other packets */
    bool first;           /* FRAME: the first frame since a reset or restart; the screen is black */
    bool summary;         /* REGION: means in place of pixels */
    uint16_t row, column; /* row and column of regions; ROW has a row, REGION both */
    uint32_t frame;       /* number of the packet's frame */
    uint16_t map_version; /* FRAME: version of the map of classes that the frame uses; 0 without zones */
    uint64_t fingerprint; /* FRAME: fingerprint of the design */
    uint64_t time;        /* FRAME: time at which the frame began, in ticks */
    uint32_t regions;     /* END: number of REGION packets of the frame */
    uint32_t dropped;     /* END: number of regions of the frame that were dropped */
    uint16_t rows;        /* END: number of ROW packets of the frame that were dropped */
    const uint8_t *carried;
} foveate_packet;

/* The bytes in which packets are searched. */
typedef struct {
    const foveate_design *design;
    const uint8_t *bytes; /* the bytes that are not searched yet */
    size_t size;          /* number of these bytes */
    size_t lost;          /* number of bytes so far that belong to no packet */
    bool ended;           /* no more bytes come, so that an incomplete packet is damage */
} foveate_reader;

/* Finds the next whole packet. Returns false if there is none. `bytes` and `size` are then the rest, which may be the beginning
 * of a packet: put it before the bytes that come next. */
bool foveate_next(foveate_reader *reader, foveate_packet *packet);

enum { FOVEATE_SRS = 1, FOVEATE_TRS = 2, FOVEATE_SUMMARY = 4 };

/* Returns the decision of a ROW packet for a column: FOVEATE_SRS, FOVEATE_TRS, FOVEATE_SUMMARY (it sends one now), or-ed. */
unsigned foveate_decision(const foveate_design *design, const foveate_packet *row, unsigned column);

/* Returns a pixel or a mean of a REGION packet; they are numbered row by row. */
unsigned foveate_value(const foveate_design *design, const foveate_packet *region, unsigned index);

/* Puts a packet on a screen of bytes, or of 16-bit numbers where P > 8 (foveate_paint16), of width x height pixels; `stride`
 * is the number of pixels from one line of the screen to the next. After END, the screen shows the frame. A call with pixels
 * of the wrong size has no effect. */
void foveate_paint(const foveate_design *design, const foveate_packet *packet, uint8_t *screen, size_t stride);
void foveate_paint16(const foveate_design *design, const foveate_packet *packet, uint16_t *screen, size_t stride);

#ifdef __cplusplus
}
#endif

#endif
