/* SPDX-License-Identifier: MIT OR Apache-2.0 */
/* Prints what the driver finds in the bytes of the standard input, which it receives in pieces: a line for each packet, and the
 * number of bytes that belong to no packet. */
#include "foveate.h"

#include <stdio.h>
#include <string.h>

enum { MOST = 1 << 16 };

int main(void) {
    static uint8_t buffer[MOST];
    const foveate_design design = {
        .columns = FOVEATE_GRID_COLUMNS_VALUE,
        .rows = FOVEATE_GRID_ROWS_VALUE,
        .width = FOVEATE_FRAME_WIDTH_VALUE,
        .height = FOVEATE_FRAME_HEIGHT_VALUE,
        .size = FOVEATE_REGION_SIZE_VALUE,
        .pixel_bits = FOVEATE_REGION_PIXEL_BITS_VALUE,
        .means = FOVEATE_REGION_MEANS_VALUE,
        .irrelevant = FOVEATE_REGION_IRRELEVANT_VALUE,
        .raw = FOVEATE_REGION_RAW_VALUE,
    };
    foveate_reader reader = {&design, buffer, 0, 0, false};
    foveate_packet packet;
    while (!reader.ended) {
        size_t piece;
        memmove(buffer, reader.bytes, reader.size);
        reader.bytes = buffer;
        piece = fread(buffer + reader.size, 1, 37, stdin);
        reader.size += piece;
        reader.ended = piece == 0;
        while (foveate_next(&reader, &packet)) {
            unsigned sum = 0;
            if (packet.type == FOVEATE_PACKET_ROW)
                for (unsigned column = 0; column < design.columns; ++column)
                    sum = sum * 31 + foveate_decision(&design, &packet, column);
            if (packet.type == FOVEATE_PACKET_REGION) {
                const unsigned side = packet.summary ? design.means : design.size;
                for (unsigned at = 0; at < side * side; ++at) sum = sum * 31 + foveate_value(&design, &packet, at);
            }
            if (packet.type == FOVEATE_PACKET_END) sum = packet.regions + 31 * packet.dropped + 961 * packet.rows;
            printf("%u %u %u %u %u %u\n", packet.type, (unsigned)packet.frame,
                   packet.type == FOVEATE_PACKET_FRAME ? packet.version : packet.row, packet.column, packet.summary, sum);
        }
    }
    printf("lost %u\n", (unsigned)reader.lost);
    return 0;
}
