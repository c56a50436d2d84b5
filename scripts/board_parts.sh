#!/usr/bin/env bash
# SPDX-License-Identifier: MIT OR Apache-2.0
# Simulates the leaves around a core on a board (docs/boards.md) in Icarus Verilog: the self-checking benches of tb/board.
# Installs what is missing.
#
#   scripts/board_parts.sh            every bench
#   scripts/board_parts.sh --faults   also each fault of the list below, which a bench must find
#   scripts/board_parts.sh NAME...    the benches of these leaves
set -euo pipefail
cd "$(dirname "$0")/.."
faults=0
names=()
for option in "$@"; do
    case $option in
    -h | --help) sed -n '3,9s/^# \{0,1\}//p' "$0" && exit 0 ;;
    --faults) faults=1 ;;
    -*) echo "board_parts: unknown option $option; see scripts/board_parts.sh --help" >&2 && exit 2 ;;
    *) names+=("$option") ;;
    esac
done
scripts/install_tools.sh
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# Leaf, bench, and the parameters of each run. The first run of a bench is used for the faults.
runs() {
    cat <<'END'
clock_crossing   crossing_bench
clock_crossing   crossing_bench   DEPTH_BITS=2
clock_crossing   crossing_bench   DEPTH_BITS=3 SEED=2
dvp_capture      dvp_bench        FORMAT=4
dvp_capture      dvp_bench        FORMAT=0
dvp_capture      dvp_bench        FORMAT=0 LEFT=0 TOP=0 VSYNC_HIGH=0 SEED=2
dvp_capture      dvp_bench        FORMAT=1
dvp_capture      dvp_bench        FORMAT=1 LEFT=0 TOP=1 SEED=3
dvp_capture      dvp_bench        FORMAT=2
dvp_capture      dvp_bench        FORMAT=2 LEFT=8 TOP=0 VSYNC_HIGH=0 SEED=4
dvp_capture      dvp_bench        FORMAT=3
dvp_capture      dvp_bench        FORMAT=3 LEFT=1 TOP=4 VSYNC_HIGH=0 SEED=5
i2c_setup        i2c_bench        QUARTER=5
i2c_setup        i2c_bench        QUARTER=4 REGISTERED=0 PAUSE=1 SEED=2
i2c_setup        i2c_bench        QUARTER=9 ADDRESS_BYTES=1 REGISTERED=0 SEED=3
i2c_setup        i2c_bench        QUARTER=4 ADDRESS_BYTES=1 SEED=4
uart_sender      uart_bench       DIVISOR=4
uart_receiver    uart_bench       DIVISOR=16
uart_receiver    uart_bench       DIVISOR=5 SEED=2
uart_receiver    uart_bench       DIVISOR=104 SEED=3
packet_bytes     bytes_bench
packet_bytes     bytes_bench      SEED=2
uart_registers   registers_bench
packet_signature signature_bench
pattern_source   pattern_bench
pattern_source   pattern_bench    LANES=1 WORDS=150 LINES=70 WIDTH=10
pattern_source   pattern_bench    LANES=8 WORDS=65 LINES=300 WIDTH=16 FRAMES=2
pattern_source   pattern_bench    LANES=3 WORDS=2 LINES=2 WIDTH=5 FRAMES=200
array_pattern    array_pattern_bench    FRAMES=132
array_pattern    array_pattern_bench    COLUMNS=28 ROWS=4 FRAMES=5
array_pattern    array_pattern_bench    COLUMNS=1 ROWS=1 SIDE=64 FRAMES=2
array_pattern    array_pattern_bench    COLUMNS=4 ROWS=45 SIDE=3 FRAMES=12
array_turn       array_turn_bench
array_turn       array_turn_bench       PIXELS=64
array_turn       array_turn_bench       LEVEL_AT=1 TEMPORAL_AT=1 MINIMUM_AT=18 PIXELS=16
array_signature  array_signature_bench
array_signature  array_signature_bench  COLUMNS=1 ROWS=1 HEAD_BYTES=1 PIXELS=4
array_signature  array_signature_bench  COLUMNS=2 ROWS=3 HEAD_BYTES=6 SEED=2
array_snapshot   array_snapshot_bench
array_snapshot   array_snapshot_bench   COLUMNS=1 ROWS=1 HEAD_BYTES=1 PIXELS=4
array_snapshot   array_snapshot_bench   COLUMNS=3 ROWS=5 HEAD_BYTES=5 PIXELS=64 SEED=2
END
}

# Leaf, and a change that its bench must find.
planted() {
    cat <<'END'
clock_crossing   s/{~read_seen_q\[DEPTH_BITS-:2\], read/{~read_seen_q[DEPTH_BITS-:1], read_seen_q[DEPTH_BITS-1], read/
clock_crossing   s/next_gray != write_seen_q/next_gray != write_first_q || rst_i/
clock_crossing   s/words_q\[next_read\[/words_q[read_q[/
clock_crossing   s/flush_q       <= rst_i || (flush_q \&\& there_q)/flush_q       <= rst_i/
clock_crossing   s/wire write = write_i \&\& !full_o/wire write = write_i/
dvp_capture      s/wire href = .*/wire href = href_q[1];/
dvp_capture      s/wire between = .*/wire between = vsync_q[1];/
dvp_capture      s/stale_q <= href \&\& (between || stale_q)/stale_q <= 1'b0/
dvp_capture      s/VSYNC_HIGH ? vsync_i : !vsync_i/!vsync_i/
dvp_capture      s/data_q  <= next_q/data_q  <= data_i/
dvp_capture      s/second_q <= line \&\& !second_q/second_q <= !second_q/
dvp_capture      s/{first_q, data_q} : {data_q, first_q}/{data_q, first_q} : {first_q, data_q}/
dvp_capture      s/LAST_COLUMN = COLUMNS - 1/LAST_COLUMN = COLUMNS/
dvp_capture      s/FIRST_COLUMN = -LEFT/FIRST_COLUMN = 1 - LEFT/
dvp_capture      s/LAST_LINE = LINES - 1/LAST_LINE = LINES/
dvp_capture      s/FIRST_LINE = -TOP/FIRST_LINE = 1 - TOP/
dvp_capture      s/lines_done_q   = 1'b1/lines_done_q   = 1'b0/
dvp_capture      s/if (!line) held_eol_q <= 1'b1;//
dvp_capture      s/{held_eol_q || !line, held_sof_q/{held_eol_q, held_sof_q/
dvp_capture      s/keep = comes \&\& !(held_q \&\& full)/keep = comes/
dvp_capture      s/first_q <= between || (first_q \&\& !keep)/first_q <= between || (first_q \&\& !comes)/
dvp_capture      s/told_q + {2'd0, more}/seen/
i2c_setup        s/{count_q\[5:4\], ~count_q\[2:0\]}/{count_q[5:4], count_q[2:0]}/
i2c_setup        s/tries_q != 2'd2/tries_q != 2'd1/
i2c_setup        s/tries_q <= again ? tries_q + 1'b1 : 2'd0/tries_q <= tries_q + 1'b1/
i2c_setup        s/refused_q <= sda_q;/refused_q <= 1'b0;/
i2c_setup        s/if (refused_q \&\& !again) failed_o <= 1'b1/if (refused_q) failed_o <= 1'b1/
i2c_setup        s/BITS: if (quarter_q != 2'd0) sda/BITS: sda/
i2c_setup        s/STOP) \&\& !quarter_q\[1\]/STOP) \&\& quarter_q == 2'd0/
i2c_setup        s/START: sda_low_o <= quarter_q\[1\]/START: sda_low_o <= |quarter_q/
i2c_setup        s/else if (tick) count_q <= next_count/else count_q <= next_count/
i2c_setup        s/quarter_q\[1\];$/1'b1;/
uart_sender      s/bits_q <= {1'b1, byte_i, 1'b0}/bits_q <= {1'b1, byte_i[0], byte_i[1], byte_i[2], byte_i[3], byte_i[4], byte_i[5], byte_i[6], byte_i[7], 1'b0}/
uart_sender      s/LAST = DIVISOR - 1/LAST = DIVISOR - 2/
uart_sender      s/initial bits_q = 10'd1;//
uart_receiver    s/valid_q <= !bits_q\[0\] \&\& rx_q/valid_q <= !bits_q[0]/
uart_receiver    s/|| (start_q \&\& rx_q)//
uart_receiver    s/busy_q \&\& before_q \&\& !rx_q/busy_q \&\& !rx_q/
uart_receiver    s/HALF = (DIVISOR - 1) \/ 2 - 1/HALF = DIVISOR - 1/
uart_receiver    s/before_q <= 1'b0/before_q <= 1'b1/
packet_bytes     s/packet_q <= valid_i \&\& !answer_valid_i/packet_q <= valid_i/
packet_bytes     s/packet_q <= !(valid_i \&\& ready_o \&\& last_i)/packet_q <= !(valid_i \&\& ready_o)/
packet_bytes     s/answer_q <= !(answer_valid_i \&\& ready_i \&\& answer_last_i)/answer_q <= !(answer_valid_i \&\& ready_i)/
packet_bytes     s/data_i\[{place_q, 3'd0}+:8\]/data_i[{~place_q, 3'd0}+:8]/
packet_bytes     s/answer_q <= answer_valid_i;/answer_q <= answer_valid_i \&\& !valid_i;/
uart_registers   s/MARK = 8'hFA/MARK = 8'hFB/
uart_registers   s/WORDS = 8'h03/WORDS = 8'h02/
uart_registers   s/ || in_crc);/);/
uart_registers   s/(place_q\[4:3\] == 2'd0 || in_crc)/in_crc/
uart_registers   s/in_crc ? crc_q\[0\] : now/now/
uart_registers   s/else if (place_q == 5'd0) crc_q/else if (rst_i) crc_q/
uart_registers   s/else if (forget) place_q/else if (1'b0) place_q/
uart_registers   s/time_q  <= hear || tells_q/time_q  <= tells_q/
uart_registers   s/address_q == 16'h1000 ? board_i : 32'd0/board_i/
uart_registers   s/wire core = address_q\[15:12\] == 4'd0/wire core = 1'b1/
uart_registers   s/else if (does_q \&\& !write_q) value_q/else if (does_q) value_q/
uart_registers   s/w_q \&\& !m_wready_i/w_q \&\& !m_awready_i/
uart_registers   s/wrong_q <= moves_q \&\& wrong \&\& !byte_ends/wrong_q <= 1'b0/
uart_registers   s/done = does_q \&\& (!core || m_bvalid_i || m_rvalid_i)/done = does_q/
packet_signature s/type_bits == ROW || //
packet_signature s/type_bits == REGION || //
packet_signature s/REGION || type_bits == END/REGION/
packet_signature s/take = valid_i \&\& ready_i/take = valid_i/
packet_signature s/crc_q    <= data_i\[63:32\]/crc_q    <= data_i[31:0]/
packet_signature s/if (add_end_q) frames_q/if (add_q) frames_q/
pattern_source   s/start_q - 7'd3/start_q - 7'd2/
pattern_source   s/MIX_STEP = 5 \* LANES/MIX_STEP = 4 * LANES/
pattern_source   s/line_mix_q + 8'd19/line_mix_q + 8'd17/
pattern_source   s/right\[6:4\] == 3'd0/right[6:3] == 4'd0/
pattern_source   s/!third_q || ready_i/ready_i/
pattern_source   s/second_y_q     <= y_q/second_y_q     <= y_q + 1'b1/
pattern_source   s/(lane_x_q \& second_y_q)/(lane_x_q | second_y_q)/
array_pattern    s/start_q - 7'd3/start_q - 7'd2/
array_pattern    s/mix_y_q + 8'd19/mix_y_q + 8'd17/
array_pattern    s/MIX = 5 \* X/MIX = 4 * X/
array_pattern    s/MIX = 19 \* Y/MIX = 18 * Y/
array_pattern    s/down\[6:4\] == 3'd0/down[6:3] == 4'd0/
array_pattern    s/column_square\[column\] \&\& row_square\[row\]/column_square[column]/
array_pattern    s/x\[5:0\] \& y\[5:0\]/x[5:0] | y[5:0]/
array_pattern    s/== 2'd3;/== 2'd2;/
array_pattern    s/soon_q   <= first_q/soon_q   <= second_q \&\& first_q/
array_pattern    s/fourth_q <= third_q/fourth_q <= second_q/
array_turn       s/soon_i \&\& !busy_q/soon_i/
array_turn       s/count_q == LEVEL_AT/count_q == TEMPORAL_AT/
array_turn       s/count_q == MINIMUM_AT/count_q == TEMPORAL_AT/
array_turn       s/!rst_i \&\& (begin_o/(begin_o/
array_signature  s/numbered(REGION\[31:0\])/numbered(32'd0)/
array_signature  s/forward_valid_i\[REGION\] ? more : crc_q/more/
array_signature  s/decided_i ? ~next : chain/decided_i ? ~crc_q : chain/
array_signature  s/decided_i ? ~next : chain/decided_i ? next : chain/
array_signature  s/decided_i ? parts\[32\*PIECES+:32\] : next/decided_i ? parts[32*PIECES+:32] : more/
array_signature  s/if (decided_i \&\& before_q) left_q/if (decided_i) left_q/
array_signature  s/left_q <= COLUMNS\[LEFT_BITS-1:0\]/left_q <= COLUMNS[LEFT_BITS-1:0] - 1'b1/
array_signature  s/FROM+2\*node+1/FROM+2*node/
array_signature  s/done_q <= ends\[LEVELS\]/done_q <= ends[0]/
array_snapshot   s/next_q\[6:0\] == frame_i/next_q[5:0] == frame_i[5:0]/
array_snapshot   s/in_column_q\[at\]/in_column_q[0]/
array_snapshot   s/row_i == row/row_i[0] == row[0] || row_i == row/
array_snapshot   s/decided_q       <= decided_first_q/decided_q       <= decided_i/
array_snapshot   s/wire keep = keeps_q \&\& leaves/wire keep = leaves/
array_snapshot   s/if (keeps_q \&\& decided_q)/if (keeps_q \&\& decided_first_q)/
array_snapshot   s/waits_q    <= 1'b1;/waits_q    <= !keeps_q;/
array_snapshot   s/wire \[31:0\] part = .*/wire [31:0] part = part_q | ({24'd0, pixel} << {count_q[1:0], 3'd0});/
array_snapshot   s/count_q  <= {COUNT_BITS{1'b0}};/count_q  <= count_q;/
array_snapshot   s/there_q ? word_q : 32'd0/word_q/
END
}

# simulate LEAVES BENCH PARAMETERS...: prints the output of the bench; true if it passes.
simulate() {
    local rtl=$1 bench=$2 parameters=() parameter
    shift 2
    for parameter in "$@"; do parameters+=("-P$bench.$parameter"); done
    # The modules that a leaf instantiates, and those behind it in its bench.
    local -A with=([dvp_bench]='dvp_capture clock_crossing axi_video raster_memory' [crossing_bench]=clock_crossing [i2c_bench]=i2c_setup
        [uart_bench]='uart_sender uart_receiver' [bytes_bench]=packet_bytes [registers_bench]='uart_registers packet_crc'
        [signature_bench]=packet_signature [pattern_bench]=pattern_source
        [array_pattern_bench]=array_pattern [array_turn_bench]=array_turn [array_signature_bench]='array_signature packet_crc'
        [array_snapshot_bench]=array_snapshot)
    local files=() leaf
    for leaf in ${with[$bench]}; do files+=("$rtl/$leaf.v"); done
    iverilog -g2012 -s "$bench" "${parameters[@]}" -o "$work/bench" "${files[@]}" "tb/board/$bench.v" || return 1
    timeout 120 vvp -n "$work/bench" >"$work/log" || true
    tail -n 20 "$work/log"
    # A bench that ends without a verdict has not passed.
    grep -q '^PASS' "$work/log" && ! grep -q '^FAIL' "$work/log"
}

chosen() { [ ${#names[@]} -eq 0 ] || printf '%s\n' "${names[@]}" | grep -qx "$1"; }
for name in "${names[@]}"; do
    runs | grep -q "^$name " || { echo "board_parts: there is no leaf $name; there are $(runs | cut -d' ' -f1 | uniq | xargs)" >&2 && exit 2; }
done

mkdir "$work/plain"
cp rtl/*.v rtl/board/*.v "$work/plain"
began=$SECONDS
bad=0 good=0
while read -r leaf bench parameters; do
    chosen "$leaf" || continue
    # shellcheck disable=SC2086
    if simulate "$work/plain" "$bench" $parameters; then good=$((good + 1)); else
        bad=$((bad + 1))
        echo "FAILED: $bench $parameters"
    fi
done < <(runs)
echo "$good runs passed, $bad failed, $((SECONDS - began)) s"
[ "$bad" -eq 0 ] || exit 1
[ "$faults" -eq 1 ] || exit 0

found=0
began=$SECONDS
mkdir "$work/rtl"
while read -r leaf change; do
    chosen "$leaf" || continue
    cp "$work/plain"/*.v "$work/rtl"
    sed -i "$change" "$work/rtl/$leaf.v"
    if cmp -s "$work/plain/$leaf.v" "$work/rtl/$leaf.v"; then
        echo "board_parts: \`$change\` changes nothing in $leaf.v; correct it"
        bad=$((bad + 1))
        continue
    fi
    # A fault counts as found if the bench reports it, not if the bench cannot be built.
    seen=0
    while read -r of bench parameters && [ $seen -eq 0 ]; do
        [ "$of" = "$leaf" ] || continue
        # shellcheck disable=SC2086
        if ! simulate "$work/rtl" "$bench" $parameters >"$work/said" 2>&1 && grep -q '^FAIL' "$work/said"; then seen=1; fi
    done < <(runs)
    if [ $seen -eq 1 ]; then found=$((found + 1)); else
        bad=$((bad + 1))
        echo "NOT FOUND: $leaf $change"
    fi
done < <(planted)
echo "$found faults found, $bad not as they should be, $((SECONDS - began)) s"
[ "$bad" -eq 0 ]
