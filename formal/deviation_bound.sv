// SPDX-License-Identifier: MIT OR Apache-2.0
// The sum of the deviations from the mean of the same pixels fits into the width that a design gives it, for all pixels.
module properties (input wire [`P*`N*`N-1:0] region);
    localparam PIXELS = `N * `N;
    localparam WIDE = 32;
    reg [WIDE-1:0] sum, total, mean, scaled;
    integer i;
    always @* begin
        sum = 0;
        for (i = 0; i < PIXELS; i = i + 1) sum = sum + region[i*`P+:`P];
        mean = ((sum << `U_DEVIATION_FRACTION) + PIXELS / 2) / PIXELS;
        total = 0;
        for (i = 0; i < PIXELS; i = i + 1) begin
            scaled = region[i*`P+:`P] << `U_DEVIATION_FRACTION;
            total = total + (scaled > mean ? scaled - mean : mean - scaled);
        end
        assert(total >> `U_DEVIATION_SUM_BITS == 0);
    end
endmodule
