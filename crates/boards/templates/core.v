    // The core.
    wire packet_valid, packet_ready, packet_last;
    wire [63:0] packet;
    wire [11:0] awaddr, araddr;
    wire [31:0] wdata, rdata;
    wire [3:0] wstrb;
    wire awvalid, awready, wvalid, wready, bvalid, bready, arvalid, arready, rvalid, rready;
    wire [7:0] unused_keep;
    wire [1:0] unused_written, unused_read;
    wire unused_interrupt;
    rcm_axi #(.TICK_RATE(32'd{= core_mhz =}000000)) u_core (
        .aclk(clk), .aresetn(!rst), .s_axis_video_tdata(pixel), .s_axis_video_tvalid(pixel_valid),
        .s_axis_video_tready(pixel_ready), .s_axis_video_tuser(sof), .s_axis_video_tlast(eol),
        .m_axis_packets_tdata(packet), .m_axis_packets_tkeep(unused_keep), .m_axis_packets_tvalid(packet_valid),
        .m_axis_packets_tready(packet_ready), .m_axis_packets_tlast(packet_last), .s_axi_awaddr(awaddr), .s_axi_awprot(3'd0),
        .s_axi_awvalid(awvalid), .s_axi_awready(awready), .s_axi_wdata(wdata), .s_axi_wstrb(wstrb), .s_axi_wvalid(wvalid),
        .s_axi_wready(wready), .s_axi_bresp(unused_written), .s_axi_bvalid(bvalid), .s_axi_bready(bready), .s_axi_araddr(araddr),
        .s_axi_arprot(3'd0), .s_axi_arvalid(arvalid), .s_axi_arready(arready), .s_axi_rdata(rdata), .s_axi_rresp(unused_read),
        .s_axi_rvalid(rvalid), .s_axi_rready(rready), .interrupt_o(unused_interrupt)
    );

    // The serial line: packets and answers go out, commands come in.
    wire sent_valid, sent_ready, heard_valid, answer_valid, answer_ready, answer_last;
    wire [7:0] sent, heard, answer;
