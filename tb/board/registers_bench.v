// SPDX-License-Identifier: MIT OR Apache-2.0
// Drives uart_registers as a host and a core do: whole commands are executed and answered, others are not (docs/boards.md,
// docs/packets.md). The core is a memory of 1024 registers on AXI4-Lite that answers after a random time.
`timescale 1ns / 1ps
`default_nettype none

module registers_bench;

    parameter SEED = 1;
    localparam PAUSE = 300;
    integer seed = SEED, errors = 0;
    task fail(input [8*60-1:0] what);
        begin
            errors = errors + 1;
            if (errors == 20) begin
                $display("FAIL registers_bench: too many");
                $finish;
            end
            if (errors < 20) $display("FAIL registers_bench at %0t: %0s", $realtime, what);
        end
    endtask
    function integer up_to(input integer top);
        up_to = $unsigned($random(seed)) % (top + 1);
    endfunction

    reg clk = 0, rst = 1;
    always #5 clk = !clk;
    reg valid = 0, answer_ready = 0;
    reg [7:0] given = 0;
    reg [31:0] board = 32'h12340002;
    wire answer_valid, answer_last, awvalid, wvalid, bready, arvalid, rready;
    wire [7:0] answer;
    wire [11:0] awaddr, araddr;
    wire [31:0] wdata;
    wire [3:0] wstrb;
    reg awready = 0, wready = 0, bvalid = 0, arready = 0, rvalid = 0;
    reg [31:0] rdata = 0;
    uart_registers #(.PAUSE(PAUSE)) dut (
        .clk_i(clk), .rst_i(rst), .valid_i(valid), .byte_i(given), .answer_valid_o(answer_valid), .answer_byte_o(answer),
        .answer_last_o(answer_last), .answer_ready_i(answer_ready), .board_i(board), .m_awaddr_o(awaddr), .m_awvalid_o(awvalid),
        .m_awready_i(awready), .m_wdata_o(wdata), .m_wstrb_o(wstrb), .m_wvalid_o(wvalid), .m_wready_i(wready), .m_bvalid_i(bvalid),
        .m_bready_o(bready), .m_araddr_o(araddr), .m_arvalid_o(arvalid), .m_arready_i(arready), .m_rdata_i(rdata),
        .m_rvalid_i(rvalid), .m_rready_o(rready)
    );

    // The core: it takes address and data of a write in any order, and keeps an answer until it is taken.
    reg [31:0] registers[0:1023], model[0:1023];
    integer writes = 0, reads = 0;
    reg have_address = 0, have_data = 0;
    reg [11:0] address;
    reg [31:0] word;
    reg aw_held = 0, w_held = 0, ar_held = 0;
    reg [43:0] aw_was, w_was, ar_was;
    always @(posedge clk) if (!rst) begin
        if (aw_held && !(awvalid && awaddr === aw_was)) fail("the address of a write does not stay");
        if (w_held && !(wvalid && {wdata, wstrb} === w_was)) fail("what is written does not stay");
        if (ar_held && !(arvalid && araddr === ar_was)) fail("the address of a read does not stay");
        aw_held <= awvalid && !awready; aw_was <= awaddr;
        w_held  <= wvalid && !wready;   w_was  <= {wdata, wstrb};
        ar_held <= arvalid && !arready; ar_was <= araddr;
        if (awvalid && awready) begin
            if (have_address) fail("two addresses for one write");
            have_address = 1;
            address      = awaddr;
        end
        if (wvalid && wready) begin
            if (have_data) fail("data twice for one write");
            have_data = 1;
            word      = wdata;
            if (wstrb !== 4'hF) fail("not all strobes");
        end
        if (bvalid && bready) bvalid <= #1 0;
        else if (have_address && have_data && !bvalid && up_to(3) == 0) begin
            registers[address[11:2]] = word;
            writes       = writes + 1;
            bvalid       <= #1 1;
            have_address = 0;
            have_data    = 0;
        end
        if (rvalid && rready) begin
            rvalid <= #1 0;
            rdata  <= #1 $random(seed);
        end
        if (arvalid && arready) begin
            reads  = reads + 1;
            rdata  <= #1 $random(seed);
            wait_read = 1 + up_to(4);
            read_at   = araddr;
        end else if (wait_read > 0) begin
            wait_read = wait_read - 1;
            if (wait_read == 0) begin
                rvalid <= #1 1;
                rdata  <= #1 registers[read_at[11:2]];
            end
        end
        awready <= #1 up_to(2) == 0;
        wready  <= #1 up_to(2) == 0;
        arready <= #1 up_to(2) == 0;
    end
    integer wait_read = 0;
    reg [11:0] read_at;

    // The definition of CRC-32, byte by byte.
    function [31:0] crc_with(input [31:0] crc, input [7:0] value);
        integer i;
        begin
            crc_with = crc ^ value;
            for (i = 0; i < 8; i = i + 1) crc_with = crc_with[0] ? crc_with >> 1 ^ 32'hEDB88320 : crc_with >> 1;
        end
    endfunction
    reg [7:0] packet[0:23];
    task make(input is_write, input [15:0] where, input [31:0] value);
        integer i;
        reg [31:0] crc;
        begin
            for (i = 0; i < 24; i = i + 1) packet[i] = 0;
            packet[0] = 8'hFA;
            packet[1] = is_write ? 8'h16 : 8'h06;
            packet[2] = 3;
            {packet[5], packet[4]} = where;
            {packet[11], packet[10], packet[9], packet[8]} = value;
            seal;
        end
    endtask
    task seal;
        integer i;
        reg [31:0] crc;
        begin
            crc = ~0;
            for (i = 0; i < 20; i = i + 1) crc = crc_with(crc, packet[i]);
            {packet[23], packet[22], packet[21], packet[20]} = ~crc;
        end
    endtask
    integer gap;  // clocks between bytes
    task say(input integer bytes);
        integer i;
        for (i = 0; i < bytes; i = i + 1) begin
            @(posedge clk) #1 valid = 1;
            given = packet[i];
            @(posedge clk) #1 valid = 0;
            given = $random(seed);
            repeat (gap - 2 + up_to(5)) @(posedge clk);
        end
    endtask
    task rest;
        repeat (PAUSE + 5) @(posedge clk);
    endtask

    // Compares an answer with the expected packet.
    reg [7:0] heard[0:23];
    integer hears = 0, answers = 0;
    reg held = 0;
    reg [8:0] held_byte;
    always @(posedge clk) begin
        if (held && !(answer_valid && {answer_last, answer} === held_byte)) fail("a byte of an answer does not stay");
        held      <= answer_valid && !answer_ready && !rst;
        held_byte <= {answer_last, answer};
        if (answer_valid && answer_ready) begin
            if (hears == 24) fail("a byte too many in an answer");
            else begin
                heard[hears] = answer;
                if (answer_last !== (hears == 23)) fail("last is not with the last byte");
                hears = hears + 1;
            end
        end
        answer_ready <= #1 up_to(7) == 0;
    end
    task hear(input is_write, input [15:0] where, input [31:0] value);
        integer i, before_write, clocks;
        begin
            for (clocks = 0; clocks < 2000 && hears < 24; clocks = clocks + 1) @(posedge clk);
            if (hears < 24) fail("no answer");
            make(is_write, where, value);
            for (i = 0; i < 24; i = i + 1)
                if (hears == 24 && heard[i] !== packet[i]) begin
                    fail("not the answer that should come");
                    if (errors < 20) $display("  byte %0d: %h, not %h", i, heard[i], packet[i]);
                end
            hears   = 0;
            answers = answers + 1;
            repeat (up_to(20)) @(posedge clk);
        end
    endtask
    task silence;
        begin
            rest;
            if (hears != 0) fail("an answer to what is no command");
            hears = 0;
        end
    endtask

    integer n, i, did, k;
    reg [31:0] value;
    reg [15:0] where;
    reg is_write;
    initial begin
        for (n = 0; n < 1024; n = n + 1) begin
            registers[n] = $random(seed);
            model[n]     = registers[n];
        end
        repeat (4) @(posedge clk);
        #1 rst = 0;
        for (n = 0; n < 200; n = n + 1) begin
            gap      = 10 + up_to(30);
            is_write = up_to(1);
            where    = up_to(20) == 0 ? 4092 : {4'd0, up_to(1023), 2'd0};
            value    = is_write ? $random(seed) : 0;
            did      = writes + reads;
            // The bench does not check fields that the page does not name: the value in a read command, and the upper words.
            make(is_write, where, is_write ? value : $random(seed));
            if (n % 4 == 3) begin
                for (i = 12; i < 20; i = i + 1) packet[i] = $random(seed);
                seal;
            end
            say(24);
            if (is_write) model[where[11:2]] = value;
            hear(is_write, where, model[where[11:2]]);
            if (writes + reads != did + 1) fail("not done once");
        end
        gap = 20;
        // Addresses of the board: 0x1000, and others that read as 0. None of them reaches the core.
        did = writes + reads;
        for (n = 0; n < 40; n = n + 1) begin
            board    = $random(seed);
            is_write = n > 30;
            where    = n % 2 ? 16'h1000 : n == 0 ? 16'h1004 : n == 2 ? 16'h2000 : n == 4 ? 16'h9000 : 16'h1000 + ($random(seed) & 16'hEFFF);
            value    = is_write ? $random(seed) : where == 16'h1000 ? board : 0;
            make(is_write, where, is_write ? value : 0);
            say(24);
            hear(is_write, where, value);
        end
        if (writes + reads != did) fail("the board's address reaches the core");
        gap = 12;
        // One wrong bit, in any bit that is checked: the command is not executed or answered, and the next command is.
        for (n = 0; n < 24 * 8; n = n + 1) begin
            make(n & 1, 16'h0104, 32'hA5A5A5A5);
            packet[n/8][n%8] = !packet[n/8][n%8];
            did = writes + reads;
            say(24);
            silence;
            if (writes + reads != did) fail("a damaged command is done");
            if (n % 16 == 5) begin
                make(0, 16'h0104, 0);
                say(24);
                hear(0, 16'h0104, model[16'h0104/4]);
            end
        end
        // The CRC is right, but the mark, type, flags, length or column is wrong.
        for (n = 0; n < 24 * 8; n = n + 1) if (n != 12 && (n < 32 || n >= 48) && n < 64) begin
            make(1, 16'h0108, 32'h5A5A5A5A);
            packet[n/8][n%8] = !packet[n/8][n%8];
            seal;
            did = writes + reads;
            say(24);
            silence;
            if (writes + reads != did) fail("what is no REGISTER packet is done");
        end
        gap = 20;
        // A partial command of any length is dropped after a pause. A shorter interval does not count as a pause.
        for (n = 1; n < 24; n = n + 1) begin
            make(1, 16'h0200, n);
            say(n);
            silence;
            make(0, 16'h0200, 0);
            say(24);
            hear(0, 16'h0200, model[16'h0200/4]);
            make(1, 16'h0200, n);
            gap = n % 3 == 0 ? 280 : 20;
            say(24);
            gap = 20;
            model[16'h0200/4] = n;
            hear(1, 16'h0200, n);
        end
        // Bytes before a mark are left out, and so are bytes that come while an answer is sent.
        for (n = 0; n < 20; n = n + 1) begin
            for (i = 0; i < 24; i = i + 1) packet[i] = $random(seed) & 8'h7F;
            say(1 + up_to(20));
            make(0, 16'h0040, 0);
            say(24);
            say(1 + up_to(1));
            hear(0, 16'h0040, model[16]);
            rest;
        end
        // A reset within a command.
        for (n = 1; n < 24; n = n + 5) begin
            make(1, 16'h0044, 77);
            say(n);
            #1 rst = 1;
            @(posedge clk) #1 rst = 0;
            make(0, 16'h0044, 0);
            say(24);
            hear(0, 16'h0044, model[17]);
        end
        for (n = 0; n < 1024; n = n + 1) if (registers[n] !== model[n]) fail("a register is not what was written");
        if (errors == 0) $display("PASS registers_bench: %0d answers, %0d writes, %0d reads", answers, writes, reads);
        else $display("FAIL registers_bench: %0d errors", errors);
        $finish;
    end
    initial begin
        #100000000 $display("FAIL registers_bench: does not end");
        $finish;
    end

endmodule

`default_nettype wire
