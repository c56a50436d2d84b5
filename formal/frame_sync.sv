// SPDX-License-Identifier: MIT OR Apache-2.0
// The four states of docs/sync.md, and consequences: the core gets only whole frames, a marked beat from outside begins a
// frame or is an error, and a frame that is completed ends.
module properties #(parameter BEATS = 5) (input wire clk_i, rst_i, valid, sof, open);
    `include "reset.vh"
    localparam SEEK = 2'd0, START = 2'd1, INSIDE = 2'd2, FILL = 2'd3;
    wire ready, beat, error;
    frame_sync #(.BEATS(BEATS), .BEAT_BITS($clog2(BEATS))) dut (
        .clk_i(clk_i), .rst_i(rst_i), .valid_i(valid), .sof_i(sof), .open_i(open), .ready_o(ready), .valid_o(beat),
        .error_o(error)
    );

    // A model of the page, with a count of the beats of the current frame.
    reg [1:0] state;
    reg [9:0] had;
    reg expected_error;
    wire comes = open && valid && state != FILL;
    wire passed = open && (state == FILL || (valid && (state == INSIDE ? !sof : sof)));
    wire whole = had + 1 == BEATS;
    always @(posedge clk_i) begin
        expected_error <= 0;
        if (rst_i) begin
            state <= SEEK;
            had   <= 0;
        end else begin
            case (state)
                SEEK: if (comes && sof) {state, had} <= {INSIDE, 10'd1};
                START: if (comes) begin
                    if (sof) {state, had} <= {INSIDE, 10'd1};
                    else begin
                        state <= SEEK;
                        expected_error <= 1;
                    end
                end
                INSIDE: if (comes) begin
                    if (sof) begin
                        state <= FILL;
                        expected_error <= 1;
                    end else begin
                        had <= whole ? 0 : had + 1;
                        if (whole) state <= START;
                    end
                end
                FILL: if (open) begin
                    had <= whole ? 0 : had + 1;
                    if (whole) state <= SEEK;
                end
            endcase
        end
    end

    // The view of the core: the beats of a frame, counted separately.
    reg [9:0] seen;
    always @(posedge clk_i) begin
        if (rst_i) seen <= 0;
        else if (open && beat) seen <= seen == BEATS - 1 ? 0 : seen + 1;
    end

    // While a frame is completed, the core takes a beat at every edge at which it is open, so the frame ends after that many.
    reg [9:0] filled;
    always @(posedge clk_i) begin
        if (rst_i || state != FILL) filled <= 0;
        else if (open) filled <= filled + 1;
    end

    always @* if (started) begin
        assert(had < BEATS);
        assert((had == 0) == (state == SEEK || state == START));
        assert(ready == (open && state != FILL));
        assert((open && beat) == passed);
        assert(error == expected_error);
        assert(seen == had);
        // A frame begins with a marked beat from outside, and no other beat from outside is marked.
        if (open && beat && seen == 0) assert(valid && sof && state != FILL);
        if (open && beat && seen != 0 && state != FILL) assert(valid && !sof);
        if (state == FILL) assert(filled + 1 < BEATS && filled < had);
        else assert(filled == 0 || filled < BEATS);
    end
endmodule
