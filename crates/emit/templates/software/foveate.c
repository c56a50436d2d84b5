/* SPDX-License-Identifier: MIT OR Apache-2.0 */
/* The functions of foveate.h. REGISTERS.md defines the registers, docs/packets.md of Foveate the packets. */
#include "foveate.h"

/* ---- Registers ---- */

static uint32_t read_mapped(void *base, uint32_t address) {
    return ((volatile uint32_t *)base)[address / 4];
}

static void write_mapped(void *base, uint32_t address, uint32_t value) {
    ((volatile uint32_t *)base)[address / 4] = value;
}

foveate_bus foveate_mapped(void *base) {
    const foveate_bus bus = {read_mapped, write_mapped, base};
    return bus;
}

const char *foveate_text(foveate_status status) {
    switch (status) {
    case FOVEATE_OK: return "ok";
    case FOVEATE_NO_CORE: return "no Foveate core at this address: register `identity` does not read FOVE";
    case FOVEATE_OTHER_VERSION: return "the registers of this core have another version than this driver";
    case FOVEATE_OTHER_DESIGN: return "this core has another design than is expected: its fingerprint differs";
    case FOVEATE_TOO_LARGE: return "a value has more bits than its register";
    case FOVEATE_BUSY: return "a map of classes still waits for the end of a frame";
    }
    return "not a status";
}

static uint32_t get(const foveate_core *core, uint32_t address) {
    return core->bus.read(core->bus.context, address);
}

static void put(const foveate_core *core, uint32_t address, uint32_t value) {
    core->bus.write(core->bus.context, address, value);
}

/* Returns a field of a register value. */
#define FIELD(value, name) (((value) & FOVEATE_##name##_MASK) >> FOVEATE_##name##_SHIFT)

foveate_status foveate_init(foveate_core *core, foveate_bus bus, uint64_t fingerprint) {
    foveate_design *const design = &core->design;
    core->bus = bus;
    if (get(core, FOVEATE_IDENTITY) != FOVEATE_IDENTITY_VALUE) return FOVEATE_NO_CORE;
    if (get(core, FOVEATE_VERSION) != FOVEATE_VERSION_VALUE) return FOVEATE_OTHER_VERSION;
    design->fingerprint = (uint64_t)get(core, FOVEATE_FINGERPRINT_HIGH) << 32 | get(core, FOVEATE_FINGERPRINT_LOW);
    const uint32_t frame = get(core, FOVEATE_FRAME);
    design->width = (uint16_t)FIELD(frame, FRAME_WIDTH);
    design->height = (uint16_t)FIELD(frame, FRAME_HEIGHT);
    const uint32_t grid = get(core, FOVEATE_GRID);
    design->columns = (uint16_t)FIELD(grid, GRID_COLUMNS);
    design->rows = (uint16_t)FIELD(grid, GRID_ROWS);
    const uint32_t region = get(core, FOVEATE_REGION);
    design->size = (uint8_t)FIELD(region, REGION_SIZE);
    design->pixel_bits = (uint8_t)FIELD(region, REGION_PIXEL_BITS);
    design->means = (uint8_t)FIELD(region, REGION_MEANS);
    design->irrelevant = (uint8_t)FIELD(region, REGION_IRRELEVANT);
    design->raw = FIELD(region, REGION_RAW) != 0;
    design->tick_rate = get(core, FOVEATE_TICK_RATE);
    if (fingerprint != FOVEATE_ANY_DESIGN && fingerprint != design->fingerprint) return FOVEATE_OTHER_DESIGN;
    return FOVEATE_OK;
}

/* Sets bits of `control` to 0 or 1, and keeps the others. `restart` reads as 0. */
static void control(const foveate_core *core, uint32_t mask, bool is_set) {
    const uint32_t others = get(core, FOVEATE_CONTROL) & ~mask;
    put(core, FOVEATE_CONTROL, is_set ? others | mask : others);
}

void foveate_start(const foveate_core *core) {
    control(core, FOVEATE_CONTROL_ENABLE_MASK, true);
}

void foveate_stop(const foveate_core *core) {
    control(core, FOVEATE_CONTROL_ENABLE_MASK, false);
}

void foveate_let_wait(const foveate_core *core, bool waits) {
    control(core, FOVEATE_CONTROL_WAIT_MASK, waits);
}

bool foveate_is_busy(const foveate_core *core) {
    return (get(core, FOVEATE_STATUS) & FOVEATE_STATUS_BUSY_MASK) != 0;
}

void foveate_restart(const foveate_core *core) {
    control(core, FOVEATE_CONTROL_RESTART_MASK, true);
}

bool foveate_is_restarting(const foveate_core *core) {
    return (get(core, FOVEATE_STATUS) & FOVEATE_STATUS_RESTARTING_MASK) != 0;
}

foveate_status foveate_set(const foveate_core *core, const foveate_threshold *thresholds, size_t count) {
    for (size_t at = 0; at < count; ++at)
        if ((thresholds[at].value & ~thresholds[at].mask) != 0) return FOVEATE_TOO_LARGE;
    const uint32_t before = get(core, FOVEATE_CONTROL);
    if (count > 1) foveate_stop(core);
    for (size_t at = 0; at < count; ++at) put(core, thresholds[at].address, thresholds[at].value);
    if (count > 1) put(core, FOVEATE_CONTROL, before);
    return FOVEATE_OK;
}

#ifdef FOVEATE_ZONE_WORD
foveate_status foveate_set_classes(const foveate_core *core, const uint8_t *classes) {
    const size_t regions = (size_t)core->design.columns * core->design.rows, per_word = 16;
    for (size_t at = 0; at < regions; ++at)
        if (classes[at] > FOVEATE_ALWAYS) return FOVEATE_TOO_LARGE;
    if (FIELD(get(core, FOVEATE_ZONE_CONTROL), ZONE_CONTROL_PENDING) != 0) return FOVEATE_BUSY;
    put(core, FOVEATE_ZONE_ADDRESS, 0);
    for (size_t first = 0; first < regions; first += per_word) {
        uint32_t word = 0;
        for (size_t at = first; at < regions && at < first + per_word; ++at)
            word |= (uint32_t)classes[at] << 2 * (at - first);
        put(core, FOVEATE_ZONE_WORD, word);
    }
    put(core, FOVEATE_ZONE_CONTROL, FOVEATE_ZONE_CONTROL_COMMIT_MASK);
    return FOVEATE_OK;
}

uint16_t foveate_map_version(const foveate_core *core) {
    return (uint16_t)FIELD(get(core, FOVEATE_ZONE_CONTROL), ZONE_CONTROL_VERSION);
}

/* FRAME packets have the version of a map in place of a column. */
#define HAS_MAPS true
#else
#define HAS_MAPS false
#endif

uint32_t foveate_events(const foveate_core *core) {
    return get(core, FOVEATE_EVENTS);
}

void foveate_clear(const foveate_core *core, uint32_t events) {
    put(core, FOVEATE_EVENTS, events);
}

void foveate_enable_interrupts(const foveate_core *core, uint32_t events) {
    put(core, FOVEATE_INTERRUPT_ENABLE, events);
}

void foveate_pretend(const foveate_core *core, uint32_t events) {
    put(core, FOVEATE_INTERRUPT_TEST, events);
}

foveate_counts foveate_count(const foveate_core *core) {
    foveate_counts counts;
    counts.frames = get(core, FOVEATE_FRAMES);
    counts.repaired = (uint16_t)FIELD(get(core, FOVEATE_REPAIRED), REPAIRED);
    counts.skipped = (uint16_t)FIELD(get(core, FOVEATE_SKIPPED), SKIPPED);
    counts.dropped = (uint16_t)FIELD(get(core, FOVEATE_DROPPED), DROPPED);
    return counts;
}

/* ---- Packets ---- */

enum {
    MARK = 0xFA,
    WORD = 8, /* bytes */
    FIRST = 1,
    RAW = 2,
    SUMMARY = 4
};

static const uint8_t MAGIC[WORD] = {'F', 'O', 'V', 'E', 'A', 'T', 'E', '\n'};

static uint16_t u16(const uint8_t *bytes) {
    return (uint16_t)(bytes[0] | bytes[1] << 8);
}

static uint32_t u32(const uint8_t *bytes) {
    return u16(bytes) | (uint32_t)u16(bytes + 2) << 16;
}

static uint64_t u64(const uint8_t *bytes) {
    return u32(bytes) | (uint64_t)u32(bytes + 4) << 32;
}

/* The CRC-32 of Ethernet, half a byte at a time, with a table of 64 bytes. */
static uint32_t crc32(const uint8_t *bytes, size_t size) {
    static const uint32_t TABLE[16] = {0x00000000, 0x1DB71064, 0x3B6E20C8, 0x26D930AC, 0x76DC4190, 0x6B6B51F4,
                                       0x4DB26158, 0x5005713C, 0xEDB88320, 0xF00F9344, 0xD6D6A3E8, 0xCB61B38C,
                                       0x9B64C2B0, 0x86D3D2D4, 0xA00AE278, 0xBDBDF21C};
    uint32_t crc = 0xFFFFFFFF;
    for (size_t at = 0; at < size; ++at) {
        crc ^= bytes[at];
        crc = crc >> 4 ^ TABLE[crc & 15];
        crc = crc >> 4 ^ TABLE[crc & 15];
    }
    return ~crc;
}

static size_t lane(const foveate_design *design) {
    return design->pixel_bits <= 8 ? 1 : 2;
}

/* Returns the number of bits per region in a ROW packet. */
static size_t decision_bits(const foveate_design *design) {
    return design->means > 0 ? 4 : 2;
}

static size_t words(size_t bytes) {
    return (bytes + WORD - 1) / WORD;
}

static size_t square(size_t side) {
    return side * side;
}

/* Returns the number of words of the packet with this head, head and tail included, or 0 if no packet of the design has it. */
static size_t length(const foveate_design *design, const uint8_t *head) {
    const unsigned type = head[1] & 15, flags = head[1] >> 4;
    const unsigned row = u16(head + 4), column = u16(head + 6);
    size_t carried;
    bool right;
    switch (type) {
    case FOVEATE_PACKET_FRAME:
        carried = 5;
        right = flags <= FIRST && (HAS_MAPS || column == 0);
        break;
    case FOVEATE_PACKET_ROW:
        carried = words((design->columns * decision_bits(design) + 7) / 8);
        right = flags == 0 && row < design->rows && column == design->columns;
        break;
    case FOVEATE_PACKET_REGION: {
        const bool is_summary = (flags & SUMMARY) != 0;
        carried = words(square(is_summary ? design->means : design->size) * lane(design));
        right = (flags & ~(unsigned)SUMMARY) == (design->raw ? RAW : 0u) && (!is_summary || design->means > 0) &&
                row < design->rows && column < design->columns;
        break;
    }
    case FOVEATE_PACKET_END:
        carried = 1;
        right = flags <= 1 && row <= design->rows && column == 0;
        break;
    default: return 0;
    }
    return right && head[0] == MARK && u16(head + 2) == carried + 2 ? carried + 2 : 0;
}

/* Returns whether the payload of a packet is right for its type. */
static bool is_sound(const uint8_t *bytes, unsigned type) {
    if (type != FOVEATE_PACKET_FRAME) return true;
    for (size_t at = 0; at < WORD; ++at)
        if (bytes[WORD + at] != MAGIC[at]) return false;
    return true;
}

static void read_packet(foveate_packet *packet, const uint8_t *bytes, size_t size) {
    const foveate_packet none = {0};
    const unsigned flags = bytes[1] >> 4;
    *packet = none;
    packet->type = bytes[1] & 15;
    packet->frame = u32(bytes + size - WORD);
    packet->carried = bytes + WORD;
    switch (packet->type) {
    case FOVEATE_PACKET_FRAME:
        packet->version = u16(bytes + 4);
        packet->first = (flags & FIRST) != 0;
        packet->map_version = u16(bytes + 6);
        packet->fingerprint = u64(bytes + 2 * WORD);
        packet->time = u64(bytes + 3 * WORD);
        break;
    case FOVEATE_PACKET_END:
        packet->rows = u16(bytes + 4);
        packet->regions = u32(bytes + WORD);
        packet->dropped = u32(bytes + WORD + 4);
        break;
    default:
        packet->summary = (flags & SUMMARY) != 0;
        packet->row = u16(bytes + 4);
        packet->column = u16(bytes + 6);
    }
}

static void pass(foveate_reader *reader, size_t bytes) {
    reader->bytes += bytes;
    reader->size -= bytes;
}

bool foveate_next(foveate_reader *reader, foveate_packet *packet) {
    while (reader->size > 0) {
        const uint8_t *const bytes = reader->bytes;
        const bool may_begin = bytes[0] == MARK;
        if (may_begin && reader->size < WORD && !reader->ended) return false;
        const size_t size = may_begin && reader->size >= WORD ? length(reader->design, bytes) * WORD : 0;
        if (size > reader->size && !reader->ended) return false;
        if (size > 0 && size <= reader->size && crc32(bytes, size - 4) == u32(bytes + size - 4) &&
            is_sound(bytes, bytes[1] & 15)) {
            read_packet(packet, bytes, size);
            pass(reader, size);
            return true;
        }
        pass(reader, 1);
        ++reader->lost;
    }
    return false;
}

unsigned foveate_decision(const foveate_design *design, const foveate_packet *row, unsigned column) {
    const size_t bits = decision_bits(design), at = column * bits;
    return row->carried[at / 8] >> at % 8 & ((1u << bits) - 1);
}

unsigned foveate_value(const foveate_design *design, const foveate_packet *region, unsigned index) {
    return lane(design) == 1 ? region->carried[index] : u16(region->carried + 2 * (size_t)index);
}

/* A screen of bytes or of 16-bit numbers. */
typedef struct {
    uint8_t *bytes;
    uint16_t *numbers;
    size_t stride;
} screen_of;

static void dot(const screen_of *screen, size_t x, size_t y, unsigned value) {
    const size_t at = y * screen->stride + x;
    if (screen->bytes)
        screen->bytes[at] = (uint8_t)value;
    else
        screen->numbers[at] = (uint16_t)value;
}

/* Paints a region with the values of a REGION packet, or black without a packet. Pixels outside of the frame are left out. */
static void paint_region(const foveate_design *design, const screen_of *screen, unsigned row, unsigned column,
                         const foveate_packet *region) {
    const unsigned side = region && region->summary ? design->means : design->size;
    const unsigned block = design->size / side;
    for (unsigned y = 0; y < design->size; ++y)
        for (unsigned x = 0; x < design->size; ++x) {
            const size_t left = (size_t)column * design->size + x, top = (size_t)row * design->size + y;
            if (left >= design->width || top >= design->height) continue;
            dot(screen, left, top, region ? foveate_value(design, region, y / block * side + x / block) : 0);
        }
}

static void paint(const foveate_design *design, const foveate_packet *packet, const screen_of *screen) {
    switch (packet->type) {
    case FOVEATE_PACKET_FRAME:
        if (!packet->first) return;
        for (unsigned row = 0; row < design->rows; ++row)
            for (unsigned column = 0; column < design->columns; ++column)
                paint_region(design, screen, row, column, NULL);
        return;
    case FOVEATE_PACKET_ROW:
        if (design->irrelevant != FOVEATE_ZERO) return;
        for (unsigned column = 0; column < design->columns; ++column)
            if ((foveate_decision(design, packet, column) & FOVEATE_SRS) == 0)
                paint_region(design, screen, packet->row, column, NULL);
        return;
    case FOVEATE_PACKET_REGION: paint_region(design, screen, packet->row, packet->column, packet); return;
    default: return;
    }
}

void foveate_paint(const foveate_design *design, const foveate_packet *packet, uint8_t *pixels, size_t stride) {
    const screen_of screen = {pixels, NULL, stride};
    if (lane(design) == 1) paint(design, packet, &screen);
}

void foveate_paint16(const foveate_design *design, const foveate_packet *packet, uint16_t *pixels, size_t stride) {
    const screen_of screen = {NULL, pixels, stride};
    if (lane(design) == 2) paint(design, packet, &screen);
}
