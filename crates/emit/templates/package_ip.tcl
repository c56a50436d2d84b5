# SPDX-License-Identifier: MIT OR Apache-2.0
# {= banner =}
#
# Makes IP for Vivado of the core on AXI; run it in the folder of the core:
#
#     vivado -mode batch -source package_ip.tcl
#
# The folder ip/ can then stand in the list of IP repositories of a project (ip_repo_paths). Its address map has every register.
# The project's own tests run this in a Tcl interpreter with stubs of Vivado's commands, and not in Vivado.
set top {= top =}
set files {
{%- for file in files %}
    {= file =}
{%- endfor %}
}
# Name, offset in bytes, what it is, and its fields: name, lowest bit, width, access, what is written to change it, what it means.
set registers {
{%- for register in registers %}
    {= register =}
{%- endfor %}
}

foreach file $files {
    if {![file exists $file]} {
        error "$file is missing: run this in the folder of the core"
    }
}
if {[file exists ip]} {
    error "the folder ip is there already: move it away, or remove it"
}

create_project package ip/project -part xcvu9p-flga2104-2L-e
add_files -norecurse $files
set_property top $top [current_fileset]
update_compile_order -fileset sources_1

# The attributes of the ports say which buses there are; these are looked for, so that none is missing in silence.
ipx::package_project -root_dir ip -vendor foveate -library camera -taxonomy /UserIP -import_files
set core [ipx::current_core]
set_property name $top $core
set_property version 1.0 $core
set_property display_name {Foveate core} $core
set_property description "{= description =}" $core
foreach bus {s_axis_video m_axis_packets s_axi aclk aresetn interrupt_o} {
    if {[ipx::get_bus_interfaces $bus -of_objects $core] eq ""} {
        error "Vivado has found no interface $bus in $top"
    }
}
foreach bus {s_axis_video m_axis_packets s_axi} {
    ipx::associate_bus_interfaces -busif $bus -clock aclk $core
}
ipx::associate_bus_interfaces -clock aclk -reset aresetn $core

# Vivado has made a map of one nameless block.
ipx::remove_all_memory_map $core
set map [ipx::add_memory_map s_axi $core]
set_property slave_memory_map_ref s_axi [ipx::get_bus_interfaces s_axi -of_objects $core]
set block [ipx::add_address_block registers $map]
set_property usage register $block
set_property range 4096 $block
set_property width 32 $block
foreach described $registers {
    lassign $described name offset doc fields
    set register [ipx::add_register $name $block]
    set_property address_offset $offset $register
    set_property size 32 $register
    set_property description $doc $register
    foreach described $fields {
        lassign $described name low width access written doc
        set field [ipx::add_field $name $register]
        set_property bit_offset $low $field
        set_property bit_width $width $field
        set_property access $access $field
        set_property modified_write_value $written $field
        set_property description $doc $field
    }
}

ipx::create_xgui_files $core
ipx::update_checksums $core
ipx::check_integrity $core
ipx::save_core $core
close_project
puts "ip/ has $top with [llength $registers] registers"
