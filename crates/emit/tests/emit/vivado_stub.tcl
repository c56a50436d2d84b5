# SPDX-License-Identifier: MIT OR Apache-2.0
# Vivado's commands as far as package_ip.tcl needs them; run it in the folder of a core: tclsh vivado_stub.tcl package_ip.tcl
#
# They check what they are given: options, files, interfaces (those that attributes in the Verilog name), clocks, resets, and that
# registers and fields have places of their own. What is not a command here is an error. At the end it says what was packaged.
set objects [dict create]  ;# what there is, by its name: its properties
set project closed
set saved 0
set interfaces [dict create]
set clocked [dict create]

proc fail {text} { error "stub: $text" }
# Arguments as options, those that take a value and those that do not, and the rest.
proc options {arguments with without} {
    set found [dict create rest {}]
    for {set at 0} {$at < [llength $arguments]} {incr at} {
        set argument [lindex $arguments $at]
        if {$argument in $with} {
            dict set found $argument [lindex $arguments [incr at]]
        } elseif {$argument in $without} {
            dict set found $argument 1
        } elseif {[string match -* $argument]} {
            fail "unknown option $argument"
        } else {
            dict lappend found rest $argument
        }
    }
    return $found
}
proc made {name kind parent} {
    global objects
    if {![dict exists $objects $parent]} { fail "$kind $name has no parent: $parent" }
    set object $parent/$kind:$name
    if {[dict exists $objects $object]} { fail "$object is there twice" }
    dict set objects $object [dict create]
    return $object
}
proc of {kind} {
    global objects
    return [dict keys $objects */$kind:*]
}
proc property {object name} {
    global objects
    if {![dict exists $objects $object $name]} { fail "$object has no $name" }
    return [dict get $objects $object $name]
}

proc create_project {args} {
    if {$::project ne "closed"} { fail "a project is open" }
    set given [options $args {-part} {-force}]
    lassign [dict get $given rest] name folder
    if {![dict exists $given -part]} { fail "no part" }
    file mkdir $folder
    set ::project $name
}
proc close_project {} { if {$::project eq "closed"} { fail "no project" }; set ::project closed }
proc current_fileset {} { return fileset }
proc add_files {args} {
    foreach file [join [dict get [options $args {} {-norecurse}] rest]] {
        if {![file exists $file]} { fail "no file $file" }
        lappend ::added $file
    }
}
proc update_compile_order {args} { options $args {-fileset} {} }
proc set_property {name value object} {
    global objects
    set known {
        fileset {top}
        core {name version display_name description}
        interface {slave_memory_map_ref}
        map {} block {usage range width}
        register {address_offset size description}
        field {bit_offset bit_width access modified_write_value description}
    }
    if {$object eq "fileset"} {
        set kind fileset
        dict set objects fileset top {}
    } elseif {![dict exists $objects $object]} {
        fail "no object $object"
    } else {
        regexp {([a-z]+)(:[^/]*)?$} $object -> kind
    }
    if {$name ni [dict get $known $kind]} { fail "a $kind has no property $name" }
    dict set objects $object $name $value
}

namespace eval ipx {
    proc package_project {args} {
        set given [options $args {-root_dir -vendor -library -taxonomy} {-import_files}]
        set top [property fileset top]
        set text ""
        foreach file $::added { set handle [open $file]; append text [read $handle] \n; close $handle }
        if {![regexp "\nmodule $top\\M" $text]} { fail "no module $top" }
        dict set ::objects core [dict create]
        foreach {- type name} [regexp -all -inline {X_INTERFACE_INFO = "xilinx\.com:(\S+):1\.0 (\S+) \S+"} $text] {
            dict set ::interfaces $name $type
            dict set ::objects core/interface:$name [dict create]
        }
    }
    proc current_core {} { return core }
    proc get_bus_interfaces {args} {
        set given [options $args {-of_objects} {}]
        set name core/interface:[dict get $given rest]
        return [expr {[dict exists $::objects $name] ? $name : ""}]
    }
    proc associate_bus_interfaces {args} {
        set given [options $args {-busif -clock -reset} {}]
        foreach {option type} {-clock signal:clock -reset signal:reset} {
            if {![dict exists $given $option]} continue
            set name [dict get $given $option]
            if {![dict exists $::interfaces $name] || [dict get $::interfaces $name] ne $type} { fail "$name is no $type" }
        }
        if {[dict exists $given -busif]} { dict set ::clocked [dict get $given -busif] 1 }
        if {[dict exists $given -reset]} { dict set ::clocked reset 1 }
    }
    proc remove_all_memory_map {core} {}
    proc add_memory_map {name core} { return [made $name map $core] }
    proc add_address_block {name map} { return [made $name block $map] }
    proc add_register {name block} { return [made $name register $block] }
    proc add_field {name register} { return [made $name field $register] }
    proc create_xgui_files {core} {}
    proc update_checksums {core} {}
    proc check_integrity {core} {}
    proc save_core {core} {
        set places {}
        foreach register [of register] {
            if {[string match */field:* $register]} continue
            set offset [expr {[property $register address_offset]}]
            if {$offset % 4 || $offset + 4 > 4096 || $offset in $places} { fail "$register is at $offset" }
            lappend places $offset
            set bits 0
            foreach field [dict keys $::objects $register/field:*] {
                if {[property $field access] ni {read-only read-write write-only}} { fail "access of $field" }
                if {[property $field modified_write_value] ni {modify oneToClear}} { fail "writes of $field" }
                for {set bit 0} {$bit < [property $field bit_width]} {incr bit} {
                    set mask [expr {1 << ([property $field bit_offset] + $bit)}]
                    if {$mask >= 1 << 32 || $bits & $mask} { fail "bits of $field" }
                    set bits [expr {$bits | $mask}]
                }
            }
        }
        foreach bus {s_axis_video m_axis_packets s_axi reset} {
            if {![dict exists $::clocked $bus]} { fail "$bus has no clock or reset" }
        }
        if {[property core/interface:s_axi slave_memory_map_ref] ne "s_axi"} { fail "s_axi has no map" }
        set ::saved 1
    }
}

source [lindex $argv 0]
if {!$saved || $project ne "closed"} { fail "the core is not saved, or the project is open" }
puts "[llength $added] files, [dict size $interfaces] interfaces, [llength [of register]] registers and fields"
