// SPDX-License-Identifier: MIT OR Apache-2.0
// Drives dvp_capture and axi_video with a sensor. The expected values are written from docs/boards.md: pixels, SOF and EOL of
// each line that is sent, and for every row of its table the frame that the core sees and the counter that counts.
`timescale 1ns / 1ps
`default_nettype none

module dvp_bench;

    parameter FORMAT = 0;
    parameter VSYNC_HIGH = 1;
    parameter LEFT = 3;
    parameter TOP = 2;
    parameter SEED = 1;
    localparam W = 8, H = 4;                     // size of the frame that the core takes
    localparam ACROSS = LEFT + W + 2, DOWN = TOP + H + 1;  // size of the frame that the sensor sends
    localparam BUS_BITS = FORMAT > 2 ? 4 : 8;

    integer seed = SEED;
    integer errors = 0;
    task fail(input [8*60-1:0] what);
        begin
            errors = errors + 1;
            if (errors == 20) begin
                $display("FAIL dvp_bench: too many");
                $finish;
            end
            if (errors < 20) $display("FAIL dvp_bench format %0d, scenario %0d, at %0t: %0s", FORMAT, scenario, $realtime, what);
        end
    endtask
    integer scenario = 0;

    // Clocks without a common period. Pixels come no faster than clk.
    reg clk = 0, pclk = 0, rst = 1;
    always #5 clk = !clk;
    real half = 7.3;      // half of the period of pclk
    integer jitter = 0;   // jitter of a half period, in hundredths of it, in both directions
    function integer between_0_and(input integer top);
        between_0_and = $unsigned($random(seed)) % (top + 1);
    endfunction

    // The sensor: a list of edges, so that the noise generator knows the neighbors of an edge.
    localparam MOST = 20000;
    reg vsyncs[0:MOST-1], hrefs[0:MOST-1];
    reg [7:0] datas[0:MOST-1];
    integer edges = 0;
    integer stand_at = -1;  // before this edge pclk stands still
    reg vsync = !VSYNC_HIGH, href = 0;
    reg [7:0] data = 0;
    task put(input v, input h, input [7:0] d);
        begin
            vsyncs[edges] = v;
            hrefs[edges]  = h;
            datas[edges]  = d;
            edges         = edges + 1;
        end
    endtask
    function [7:0] anything(input dummy);
        anything = $random(seed);
    endfunction
    function [7:0] scene(input integer frame, input integer line, input integer column);
        scene = ((line - TOP) * W + column - LEFT + frame * 2 * W * H) ^ 8'h5A;  // the taken pixels differ from each other within four frames
    endfunction
    task put_pixel(input [7:0] p);
        case (FORMAT)
            0: put(0, 1, p);
            1: begin put(0, 1, p); put(0, 1, anything(0)); end
            2: begin put(0, 1, anything(0)); put(0, 1, p); end
            3: begin put(0, 1, {4'd0, p[7:4]}); put(0, 1, {4'd0, p[3:0]}); end
            default: begin put(0, 1, {4'd0, p[3:0]}); put(0, 1, {4'd0, p[7:4]}); end
        endcase
    endtask
    task blank(input integer n);
        repeat (n) put(0, 0, anything(0));
    endtask

    // The expected output: of each line the pixels inside the crop, the first of a frame with SOF, the last of a line with EOL.
    reg [9:0] expected[0:MOST-1];  // {eol, sof, pixel}
    integer expect_line[0:MOST-1], expect_frame[0:MOST-1];
    integer expects = 0, lines_sent = 0, frames_sent = 0;
    integer line_number = -1;      // number of the next line after vsync; -1: there was no vsync
    reg started;                   // the frame has had its SOF
    task vertical(input integer n);
        begin
            repeat (n) put(1, 0, anything(0));
            line_number = 0;
            started     = 0;
            frames_sent = frames_sent + 1;
        end
    endtask
    // Sends n pixels of a line of the scene, from column `from` on.
    task line(input integer frame, input integer number, input integer from, input integer n);
        integer k;
        begin
            for (k = 0; k < n; k = k + 1) begin
                put_pixel(scene(frame, number, from + k));
                if (line_number >= TOP && line_number < TOP + H && k >= LEFT && k < LEFT + W) begin
                    expected[expects]    = {k == n - 1 || k == LEFT + W - 1, !started, scene(frame, number, from + k)};
                    expect_line[expects] = lines_sent;
                    expect_frame[expects] = frames_sent;
                    expects              = expects + 1;
                    started              = 1;
                end
            end
            lines_sent = lines_sent + 1;
            if (line_number >= 0) line_number = line_number + 1;
        end
    endtask
    task frame_as_it_is(input integer frame);
        integer l;
        begin
            vertical(6);
            blank(9);
            for (l = 0; l < DOWN; l = l + 1) begin
                line(frame, l, 0, ACROSS);
                blank(7);
            end
            blank(12);
        end
    endtask

    // Noise: one wrong value where two values before and two after are right, without other noise within two values.
    integer noises = 0;
    task noise(input integer percent);
        integer i, last_h, last_v;
        begin
            last_h = -9;
            last_v = -9;
            for (i = 2; i < edges - 2; i = i + 1) begin
                if (i - last_h > 2 && hrefs[i-2] == hrefs[i] && hrefs[i-1] == hrefs[i] && hrefs[i+1] == hrefs[i] && hrefs[i+2] == hrefs[i]
                    && between_0_and(99) < percent) begin
                    last_h = i;
                end
                // The value is flipped after the values behind it have been examined.
                if (i - last_v > 2 && vsyncs[i-2] == vsyncs[i] && vsyncs[i-1] == vsyncs[i] && vsyncs[i+1] == vsyncs[i] && vsyncs[i+2] == vsyncs[i]
                    && between_0_and(99) < percent) begin
                    last_v = i;
                end
                flip_h[i] = last_h == i;
                flip_v[i] = last_v == i;
            end
            for (i = 2; i < edges - 2; i = i + 1) begin
                if (flip_h[i]) hrefs[i] = !hrefs[i];
                if (flip_v[i]) vsyncs[i] = !vsyncs[i];
                noises = noises + flip_h[i] + flip_v[i];
            end
        end
    endtask
    reg flip_h[0:MOST-1], flip_v[0:MOST-1];

    real now_half;
    task play;
        integer i;
        begin
            for (i = 0; i < edges; i = i + 1) begin
                if (i == stand_at) #3000;
                vsync    = VSYNC_HIGH ? vsyncs[i] : !vsyncs[i];
                href     = hrefs[i];
                data     = datas[i];
                now_half = half * (100.0 + (jitter ? between_0_and(jitter * 2) - jitter : 0)) / 100.0;
                #(now_half) pclk = 1;
                #(now_half) pclk = 0;
            end
            edges    = 0;
            stand_at = -1;
        end
    endtask

    wire valid, sof, eol, lost, video_ready;
    wire [7:0] pixel;
    reg stall = 0;
    integer stalls = 0;  // percent of clocks
    reg stall_now = 0;
    always @(posedge clk) stall_now <= #1 between_0_and(99) < stalls;
    wire gate = !stall && !stall_now;
    wire ready = video_ready && gate;
    dvp_capture #(
        .BUS_BITS(BUS_BITS), .FORMAT(FORMAT), .VSYNC_HIGH(VSYNC_HIGH), .LEFT(LEFT), .TOP(TOP), .COLUMNS(W), .LINES(H),
        .COLUMN_BITS($clog2(LEFT + W)), .LINE_BITS($clog2(TOP + H))
    ) dut (
        .pclk_i(pclk), .vsync_i(vsync), .href_i(href), .data_i(data[BUS_BITS-1:0]), .clk_i(clk), .rst_i(rst), .valid_o(valid),
        .pixel_o(pixel), .sof_o(sof), .eol_o(eol), .ready_i(ready), .lost_o(lost)
    );
    wire begins, idle, word, first, skips, repair, sof_early, sof_late, eol_early, eol_late;
    wire [7:0] seen;
    axi_video #(.WIDTH(8), .LANES(1), .WORDS(W), .LINES(H), .WORD_BITS(3), .LINE_BITS(2)) core (
        .clk_i(clk), .rst_i(rst), .valid_i(valid && gate), .pixel_i(pixel), .sof_i(sof), .eol_i(eol), .ready_o(video_ready), .admit_i(1'b1),
        .late_i(1'b0), .begin_o(begins), .idle_o(idle), .valid_o(word), .pixel_o(seen), .sof_o(first), .ready_i(1'b1), .skip_o(skips),
        .repair_o(repair), .sof_early_o(sof_early), .sof_late_o(sof_late), .eol_early_o(eol_early), .eol_late_o(eol_late)
    );

    // Checks the output. With losses pixels are missing, but a line still has its end and a frame its start.
    integer at = 0, losses = 0, missing = 0, taken = 0;
    reg blind = 0, lossy = 0, last_eol = 1, frame_open = 0;
    integer last_line = -1, last_frame = -1;
    reg held = 0;
    reg [9:0] held_word;
    always @(posedge clk) begin
        if (rst || blind) held <= 0;
        else begin
            if (held && !(valid && {eol, sof, pixel} === held_word)) fail("a pixel that waits changes");
            held      <= valid && !ready;
            held_word <= {eol, sof, pixel};
            if (lost) losses = losses + 1;
            if (valid && ready) begin
                taken = taken + 1;
                if (lossy) begin
                    while (at < expects && expected[at][7:0] !== pixel) begin
                        at      = at + 1;
                        missing = missing + 1;
                    end
                    if (at == expects) fail("a pixel that was not sent");
                    else begin
                        if (last_line >= 0 && last_eol !== (last_line != expect_line[at])) fail("EOL is not at the end of a line");
                        if (sof !== (last_frame != expect_frame[at])) fail("SOF is not at the start of a frame");
                        last_eol   = eol;
                        last_line  = expect_line[at];
                        last_frame = expect_frame[at];
                    end
                end else if (at == expects) fail("a pixel that was not sent");
                else if ({eol, sof, pixel} !== expected[at]) begin
                    fail("not the pixel, SOF or EOL that was sent");
                    if (errors < 20) $display("  {eol, sof, pixel} %b %b %h, not %b %b %h", eol, sof, pixel, expected[at][9], expected[at][8], expected[at][7:0]);
                end
                at = at + 1;
            end
        end
    end

    // The frames that the core sees, one by one, and the counters of events.
    reg [7:0] want[0:MOST-1];
    integer wants = 0, saw = 0;
    integer counts[0:4];
    always @(posedge clk) if (!rst && !blind) begin
        if (word) begin
            if (!lossy) begin
                if (saw == wants) fail("the core sees a pixel too many");
                else if (seen !== want[saw]) begin
                    fail("the core does not see what it should");
                    if (errors < 20) $display("  pixel %0d of frames: %h, not %h", saw, seen, want[saw]);
                end
                if (first !== (saw % (W * H) == 0)) fail("the core sees no start of a frame");
            end
            saw = saw + 1;
        end
        counts[0] = counts[0] + sof_early;
        counts[1] = counts[1] + sof_late;
        counts[2] = counts[2] + eol_early;
        counts[3] = counts[3] + eol_late;
        counts[4] = counts[4] + repair;
    end
    task want_pixel(input [7:0] p);
        begin
            want[wants] = p;
            wants       = wants + 1;
        end
    endtask
    task want_line(input integer frame, input integer number);
        integer c;
        for (c = 0; c < W; c = c + 1) want_pixel(scene(frame, number, LEFT + c));
    endtask
    task want_frame(input integer frame);
        integer l;
        for (l = 0; l < H; l = l + 1) want_line(frame, TOP + l);
    endtask

    task begin_scenario;
        integer i;
        begin
            scenario = scenario + 1;
            for (i = 0; i < 5; i = i + 1) counts[i] = 0;
            losses = 0;
        end
    endtask
    // Ends a scenario. The vsync of the next frame closes it.
    task ends(input integer sofs_early, input integer eols_early, input integer repairs);
        begin
            blank(8);
            play;
            #2000;
            if (at != expects) fail("pixels did not come");
            if (saw != wants) fail("pixels did not reach the core");
            if (counts[0] != sofs_early) fail("sof_early");
            if (counts[2] != eols_early) fail("eol_early");
            if (counts[4] != repairs) fail("repaired");
            if (counts[1] != 0 || counts[3] != 0) fail("sof_late or eol_late");
            if (losses != 0) fail("lost");
        end
    endtask

    integer n, l, c, cut;
    initial begin
        for (n = 0; n < 5; n = n + 1) counts[n] = 0;
        repeat (5) @(posedge clk);
        #1 rst = 0;

        // 1: no pixel is taken before the first vsync.
        begin_scenario;
        for (l = 0; l < 3; l = l + 1) begin
            line(0, l, 0, ACROSS);
            blank(5);
        end
        for (n = 0; n < 3; n = n + 1) begin
            frame_as_it_is(n);
            want_frame(n);
        end
        ends(0, 0, 0);

        // 2: pclk of any rate: as fast as pixels may come, slow, and with jitter.
        for (n = 0; n < 6; n = n + 1) begin
            begin_scenario;
            case (n)
                0: half = FORMAT == 0 ? 5.001 : 2.501;
                1: half = FORMAT == 0 ? 5.03 : 2.57;
                2: half = 61.7;
                3: half = 9.999;
                4: half = 10.01;
                default: begin half = 14.1; jitter = 30; end
            endcase
            repeat (3) begin
                frame_as_it_is(n);
                want_frame(n);
            end
            ends(0, 0, 0);
        end
        half = 7.3; jitter = 0;

        // 8: noise on href and vsync.
        begin_scenario;
        for (n = 0; n < 12; n = n + 1) begin
            frame_as_it_is(n);
            want_frame(n);
        end
        noise(25);
        ends(0, 0, 0);
        if (noises < 100) fail("too little noise to show something");

        // 9: a line is lost. The next lines are one line higher, and the last line comes twice. The sensor sends H lines at most.
        begin_scenario;
        for (n = 0; n < 3; n = n + 1) begin
            vertical(6);
            blank(5);
            for (l = 0; l < TOP + H; l = l + 1) begin
                if (l != TOP + n) line(n, l, 0, ACROSS);
                else repeat (ACROSS) blank(FORMAT == 0 ? 1 : 2);
                blank(6);
            end
            blank(20);
            for (l = 0; l < H; l = l + 1) if (l != n) want_line(n, TOP + l);
            want_line(n, TOP + H - 1);
        end
        // The frame is found to be damaged when the next one begins.
        frame_as_it_is(3);
        want_frame(3);
        ends(3, 0, 3);

        // 10: href falls early, and the last pixel fills the rest of the line. Every length, in every line.
        begin_scenario;
        for (n = 0; n < (W - 1) * H; n = n + 1) begin
            vertical(6);
            blank(5);
            // One edge with href is not a line.
            cut = FORMAT == 0 && LEFT == 0 && n % (W - 1) == 0 ? 2 : 1 + n % (W - 1);
            for (l = 0; l < DOWN; l = l + 1) begin
                line(n, l, 0, l == TOP + n / (W - 1) ? LEFT + cut : ACROSS);
                blank(6);
            end
            for (l = 0; l < H; l = l + 1)
                if (l != n / (W - 1)) want_line(n, TOP + l);
                else for (c = 0; c < W; c = c + 1) want_pixel(scene(n, TOP + l, LEFT + (c < cut ? c : cut - 1)));
        end
        ends(0, (W - 1) * H, (W - 1) * H);

        // 11: href falls for two edges and more. There are two short lines, and the lines after line H are left out.
        begin_scenario;
        for (n = 2; n < 5; n = n + 1) begin
            vertical(6);
            blank(5);
            for (l = 0; l < DOWN; l = l + 1) begin
                if (l == TOP + 1) begin
                    line(n, l, 0, LEFT + 3);
                    blank(n);
                    line(n, l, LEFT + 3, LEFT + 4);
                end else line(n, l, 0, ACROSS);
                blank(6);
            end
            want_line(n, TOP);
            for (c = 0; c < W; c = c + 1) want_pixel(scene(n, TOP + 1, LEFT + (c < 3 ? c : 2)));
            for (c = 0; c < W; c = c + 1) want_pixel(scene(n, TOP + 1, LEFT + 3 + LEFT + (c < 4 ? c : 3)));
            want_line(n, TOP + 2);
        end
        ends(0, 6, 3);

        // 12: vsync between two lines of a frame. Its last line is repeated up to H, and the next frame begins.
        begin_scenario;
        for (n = 1; n < H; n = n + 1) begin
            vertical(6);
            blank(5);
            for (l = 0; l < TOP + n; l = l + 1) begin
                line(n, l, 0, ACROSS);
                blank(6);
            end
            vertical(n + 1);
            blank(40);
            for (l = 0; l < DOWN; l = l + 1) begin
                line(n + 10, l, 0, ACROSS);
                blank(6);
            end
            for (l = 0; l < H; l = l + 1) want_line(n, TOP + (l < n ? l : n - 1));
            want_frame(n + 10);
        end
        ends(H - 1, 0, H - 1);

        // 13: vsync within a line. The line ends, and the rest of it is left out.
        begin_scenario;
        vertical(6);
        blank(5);
        for (l = 0; l < TOP + 2; l = l + 1) begin
            line(1, l, 0, ACROSS);
            blank(6);
        end
        line(1, TOP + 2, 0, LEFT + 2);
        n = edges;
        vertical(2);
        hrefs[n] = 1;
        hrefs[n+1] = 1;
        // href stays 1 after vsync: this is not a line of the next frame.
        repeat (5) put_pixel(8'hEE);
        blank(40);
        for (l = 0; l < DOWN; l = l + 1) begin
            line(2, l, 0, ACROSS);
            blank(6);
        end
        want_line(1, TOP);
        want_line(1, TOP + 1);
        repeat (H - 2) for (c = 0; c < W; c = c + 1) want_pixel(scene(1, TOP + 2, LEFT + (c < 2 ? c : 1)));
        want_frame(2);
        // The short line is repaired, and the frame was too short. It counts once.
        ends(1, 1, 1);

        // 14: href and vsync change at one edge, in both directions, without blank lines between the lines and vsync.
        begin_scenario;
        for (n = 0; n < 2; n = n + 1) begin
            vertical(6);
            for (l = 0; l < TOP + H; l = l + 1) begin
                line(n, l, 0, LEFT + W);
                if (l != TOP + H - 1) blank(2);
            end
            want_frame(n);
        end
        vertical(20);
        ends(0, 0, 0);

        // 15: pclk stands still within a line and after one; the frame waits.
        begin_scenario;
        for (n = 0; n < 2; n = n + 1) begin
            frame_as_it_is(n);
            stand_at = edges - (n == 0 ? 60 : 13);
            want_frame(n);
            play;
        end
        ends(0, 0, 0);

        // 16: a reset of clk in the middle of a frame, while pclk stands still and the queue is full: no earlier pixel comes.
        begin_scenario;
        blind = 1;
        for (n = 0; n < 3; n = n + 1) begin
            stall = 1;
            frame_as_it_is(n);
            stand_at = 15 + (TOP + 3) * (7 + ACROSS * (FORMAT == 0 ? 1 : 2));
            fork
                play;
                begin
                    wait (pclk == 1);
                    for (c = 0; c < 80; c = pclk ? 0 : c + 1) @(posedge clk);
                    if (!valid) fail("nothing waits, so a reset shows nothing");
                    #1 rst = 1;
                    repeat (1 + n) @(posedge clk);
                    #1 rst = 0;
                    stall = 0;
                    repeat (100) begin
                        @(negedge clk);
                        if (valid) fail("a pixel of before a reset");
                    end
                end
            join
        end
        #2000;
        blind     = 0;
        at        = expects;
        begin_scenario;
        frame_as_it_is(2);
        want_frame(2);
        ends(0, 0, 0);

        // 18: a core that sometimes takes no pixel, but not for longer than the queue can hold: no pixel is lost or changed.
        begin_scenario;
        stalls = 40;
        half   = 13.0;
        for (n = 0; n < 8; n = n + 1) begin
            frame_as_it_is(n);
            want_frame(n);
        end
        ends(0, 0, 0);
        stalls = 0;

        // 19: a core that takes no pixel for long. Pixels are lost and counted, but lines still have their ends and frames their
        // starts. In the last frames pixels come faster than clk, for the time of a line, and the start of a frame is lost.
        for (n = 0; n < 13; n = n + 1) begin
            begin_scenario;
            half       = (n % 2 ? 5.1 : 8.9) / (n > 9 ? 1.8 : 1) / (n > 9 && FORMAT != 0 ? 2 : 1);
            lossy      = 1;
            missing    = 0;
            last_line  = -1;
            last_frame = -1;
            saw        = 0;
            frame_as_it_is(n);
            frame_as_it_is(n + 1);
            fork
                play;
                begin
                    c = taken;
                    wait (taken > c + n);
                    stall = 1;
                    #((7 + ACROSS * (FORMAT == 0 ? 1 : 2)) * 2 * half * (1.3 + 0.4 * n + (n > 9 ? DOWN - 2 : 0))) stall = 0;
                end
            join
            // The last pixel needs edges of pclk to leave.
            blank(8);
            play;
            #3000;
            missing = missing + expects - at;
            at      = expects;
            if (losses != missing) begin
                fail("lost does not count what is missing");
                $display("  lost %0d, missing %0d", losses, missing);
            end
            if (n > 5 && losses == 0) fail("nothing was lost, so nothing is shown");
            if (losses > 0 && n < 10 && counts[2] == 0 && counts[0] == 0) fail("losses are not seen as eol_early");
            if (counts[3] != 0) fail("eol_late with losses");
            if (losses > 0) lossy_scenarios = lossy_scenarios + 1;
            total_lost = total_lost + losses;
        end
        half = 7.3;
        // 32: after these scenarios the capture works as before.
        begin_scenario;
        for (n = 0; n < 2; n = n + 1) frame_as_it_is(5);
        play;
        #3000;
        lossy = 0;
        at    = expects;
        wants = 0;
        saw   = 0;
        begin_scenario;
        frame_as_it_is(7);
        want_frame(7);
        ends(0, 0, 0);

        if (errors == 0)
            $display("PASS dvp_bench format %0d, vsync %0d, crop %0d %0d: %0d pixels, %0d wrong values at an edge, %0d lost in %0d scenarios", FORMAT,
                     VSYNC_HIGH, LEFT, TOP, taken, noises, total_lost, lossy_scenarios);
        else $display("FAIL dvp_bench format %0d: %0d errors", FORMAT, errors);
        $finish;
    end
    integer lossy_scenarios = 0, total_lost = 0;
    initial begin
        #20000000 $display("FAIL dvp_bench format %0d, scenario %0d: does not end", FORMAT, scenario);
        $finish;
    end

endmodule

`default_nettype wire
