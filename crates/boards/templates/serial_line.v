    uart_sender #(.DIVISOR({= divisor =})) u_sender (
        .clk_i(clk), .rst_i(rst), .valid_i(sent_valid), .byte_i(sent), .ready_o(sent_ready), .tx_o(tx_o)
    );
    uart_receiver #(.DIVISOR({= divisor =})) u_receiver (
        .clk_i(clk), .rst_i(rst), .rx_i(rx_i), .valid_o(heard_valid), .byte_o(heard)
    );
    uart_registers #(.PAUSE({= 40 * divisor =})) u_registers (
        .clk_i(clk), .rst_i(rst), .valid_i(heard_valid), .byte_i(heard), .answer_valid_o(answer_valid),
        .answer_byte_o(answer), .answer_last_o(answer_last), .answer_ready_i(answer_ready), .board_i(status),
        .m_awaddr_o(awaddr), .m_awvalid_o(awvalid), .m_awready_i(awready), .m_wdata_o(wdata), .m_wstrb_o(wstrb),
        .m_wvalid_o(wvalid), .m_wready_i(wready), .m_bvalid_i(bvalid), .m_bready_o(bready), .m_araddr_o(araddr),
        .m_arvalid_o(arvalid), .m_arready_i(arready), .m_rdata_i(rdata), .m_rvalid_i(rvalid), .m_rready_o(rready)
    );
