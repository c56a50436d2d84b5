// SPDX-License-Identifier: MIT OR Apache-2.0
// A board with the pull-ups of its I2C bus, and with a sensor that may pull the data line down.
`default_nettype none

module board_bench (
    input  wire             clk_i,      // the clock of the board and of the core, as there is no PLL here
    input  wire             pclk_i,     // the clock of the sensor's pixels
    input  wire             vsync_i,    // vsync of the sensor
    input  wire             href_i,
    input  wire [`DATA-1:0] data_i,
    input  wire             sda_low_i,  // the sensor pulls the data line down
    output wire             scl_o,      // the clock line of I2C
    output wire             sda_o,
    input  wire             rx_i,       // serial line from the host
    output wire             tx_o,
    output wire [      1:0] led_o
);

    wire scl, sda;
    pullup (scl);
    pullup (sda);
    assign sda = sda_low_i ? 1'b0 : 1'bz;
    assign scl_o = scl;
    assign sda_o = sda;
    board u_board (
        .clk_i(clk_i), .sensor_xclk_o(), .sensor_pclk_i(pclk_i), .sensor_vsync_i(vsync_i), .sensor_href_i(href_i),
        .sensor_data_i(data_i), .sensor_scl(scl), .sensor_sda(sda), .rx_i(rx_i), .tx_o(tx_o), .led_o(led_o)
    );

endmodule

`default_nettype wire
