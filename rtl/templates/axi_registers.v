// SPDX-License-Identifier: MIT OR Apache-2.0
// {= banner =}
//
// The registers of the core on AXI4-Lite; REGISTERS.md defines them. An address without a register reads as 0, and a write to
// it has no effect. No output to the bus follows an input in the same clock, so no side of a handshake waits for another.
`default_nettype none

module {= module =} (
    input  wire        clk_i,     // clock, rising edge
    input  wire        rst_i,     // synchronous reset, active high
    input  wire [11:0] awaddr_i,   // address of a write, in bytes
    input  wire        awvalid_i,  // an address of a write is offered
    output wire        awready_o,  // the address is taken
    input  wire [31:0] wdata_i,    // the value that is written
    input  wire [ 3:0] wstrb_i,    // one bit per byte of the value: this byte is written
    input  wire        wvalid_i,   // a value is offered
    output wire        wready_o,   // the value is taken
    output wire        bvalid_o,   // the write is done
    input  wire        bready_i,   // the answer to the write is taken
    input  wire [11:0] araddr_i,   // address of a read, in bytes
    input  wire        arvalid_i,  // an address of a read is offered
    output wire        arready_o,  // the address is taken
    output wire [31:0] rdata_o,    // the value that was read
    output wire        rvalid_o,   // the value is on rdata_o
    input  wire        rready_i,   // the value is taken
    input  wire        begin_i,   // the core takes over all thresholds at this edge
{%- if has_window %}
    output wire [ 8:0] place_o,   // number of the four values that are read of the upper half of the addresses
    input  wire [31:0] values_i,  // these four values, one clock later
{%- endif %}
{%- for port in ports %}
    {= port.declaration =}  // {= port.doc =}
{%- endfor %}
);
{%- for register in state %}
    reg {= register.range =} {= register.name =}_q;
{%- endfor %}

    // Address and value of a write are taken together, and not before the last answer is taken. The same is true of a read.
    reg write_q, answered_q, read_q, found_q;
    wire [9:0] written = awaddr_i[11:2];
    wire [9:0] asked = araddr_i[11:2];
    wire unused_bits = |awaddr_i[1:0] || |araddr_i[1:0] || |wdata_i || |wstrb_i || begin_i;
    always @(posedge clk_i) begin
        write_q    <= awvalid_i && wvalid_i && !write_q && !(answered_q && !bready_i);
        answered_q <= write_q || (answered_q && !bready_i);
        read_q     <= arvalid_i && !read_q && !(found_q && !rready_i);
        found_q    <= read_q || (found_q && !rready_i);
        if (rst_i) begin
            write_q    <= 1'b0;
            answered_q <= 1'b0;
            read_q     <= 1'b0;
            found_q    <= 1'b0;
        end
    end
    assign awready_o = write_q;
    assign wready_o = write_q;
    assign bvalid_o = answered_q;
    assign arready_o = read_q;
    assign rvalid_o = found_q;

    // Writes to registers.
    always @(posedge clk_i) begin
{%- for taken in taken_thresholds %}
        if (begin_i) {= taken.0 =}_q <= {= taken.1 =};
{%- endfor %}
{%- for command in commands %}
        {= command =}_q <= 1'b0;
{%- endfor %}
        if (write_q) begin
{%- for write in writes %}
            if (written == 10'd{= write.word =} && wstrb_i[{= write.byte =}]) {= write.target =} <= wdata_i{= write.range =};
{%- endfor %}
        end
{%- for event in events %}
        if ({= event.name =}_i || interrupt_test_{= event.name =}_q) events_{= event.name =}_q <= 1'b1;
        else if (write_q && written == 10'd{= event.word =} && wstrb_i[{= event.byte =}] && wdata_i[{= event.bit =}]) events_{= event.name =}_q <= 1'b0;
{%- endfor %}
        if (rst_i) begin
{%- for register in state %}
            {= register.name =}_q <= {= register.reset =};
{%- endfor %}
        end
    end

    // Reads of registers.
    reg [31:0] found;
    reg [31:0] found_data_q;
    always @* begin
        case (asked)
{%- for read in reads %}
            10'd{= read.0 =}: found = { {= read.1 =} };
{%- endfor %}
            default: found = 32'd0;
        endcase
    end
    always @(posedge clk_i) if (read_q) found_data_q <= {% if has_window %}asked[9] ? values_i : {% endif %}found;
    assign rdata_o = found_data_q;
{%- if has_window %}
    assign place_o = asked[8:0];
{%- endif %}
{% for output in outputs %}
    assign {= output.0 =}_o = {= output.1 =};
{%- endfor %}
{%- for field in external_fields %}
    assign {= field.name =}_o = {= field.value =};
    assign {= field.name =}_write_o = write_q && written == 10'd{= field.word =}{% if field.needs_all_bytes %} && &wstrb_i{% endif %};
{%- endfor %}
{%- if !has_window %}
    assign interrupt_o = {% for event in events %}{% if !loop.first %} || {% endif %}(events_{= event.name =}_q && interrupt_enable_{= event.name =}_q){% endfor %};
{%- endif %}

endmodule

`default_nettype wire
