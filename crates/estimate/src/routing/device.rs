// SPDX-License-Identifier: MIT OR Apache-2.0
//! The devices that a design can be placed on. A further device that nextpnr supports is one more
//! row.

use foveate_tools::Tool;

/// A family of devices, with the same cells, synthesis and place-and-route program.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum DeviceFamily {
    /// Lattice ECP5.
    Ecp5,
    /// Lattice iCE40 UltraPlus, with single-port RAM and multipliers.
    Ice40Up,
    /// Lattice iCE40 HX.
    Ice40Hx,
    /// Gowin GW2A.
    Gowin,
}

/// A device with its package and speed grade.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct RouteDevice {
    /// The name of the device on the command line.
    pub name: &'static str,
    /// The name of the part.
    pub part: &'static str,
    /// The package; only the clock has a pin.
    pub package: &'static str,
    /// The speed grade, if the family has several.
    pub speed: Option<&'static str>,
    pub(crate) family: DeviceFamily,
    /// The option that selects the part in nextpnr.
    flag: &'static str,
}

const fn ecp5(
    name: &'static str,
    part: &'static str,
    flag: &'static str,
    speed: &'static str,
) -> RouteDevice {
    RouteDevice {
        name,
        part,
        package: "CABGA381",
        speed: Some(speed),
        family: DeviceFamily::Ecp5,
        flag,
    }
}

const fn ice40(
    name: &'static str,
    part: &'static str,
    flag: &'static str,
    package: &'static str,
    family: DeviceFamily,
) -> RouteDevice {
    RouteDevice { name, part, package, speed: None, family, flag }
}

const fn gowin(
    name: &'static str,
    part: &'static str,
    flag: &'static str,
    speed: &'static str,
) -> RouteDevice {
    RouteDevice {
        name,
        part,
        package: "QN88",
        speed: Some(speed),
        family: DeviceFamily::Gowin,
        flag,
    }
}

/// All devices. An ECP5 without a speed grade in its name has the slowest grade, 6.
pub const ROUTE_DEVICES: &[RouteDevice] = &[
    ecp5("ecp5-85k", "LFE5U-85F", "--85k", "6"),
    ecp5("ecp5-45k", "LFE5U-45F", "--45k", "6"),
    ecp5("ecp5-25k", "LFE5U-25F", "--25k", "6"),
    ecp5("ecp5-85k-8", "LFE5U-85F", "--85k", "8"),
    ice40("up5k", "iCE40UP5K", "--up5k", "sg48", DeviceFamily::Ice40Up),
    ice40("hx8k", "iCE40HX8K", "--hx8k", "ct256", DeviceFamily::Ice40Hx),
    ice40("hx4k", "iCE40HX4K", "--hx4k", "tq144", DeviceFamily::Ice40Hx),
    ice40("hx1k", "iCE40HX1K", "--hx1k", "tq144", DeviceFamily::Ice40Hx),
    gowin("gw2a-18", "GW2AR-18C", "--device=GW2AR-LV18QN88C8/I7", "C8/I7"),
];

impl RouteDevice {
    /// Returns the device of that name.
    #[must_use]
    pub fn by_name(name: &str) -> Option<&'static Self> {
        ROUTE_DEVICES.iter().find(|device| device.name == name)
    }

    /// Returns the part with package and speed grade, as in an order.
    #[must_use]
    pub fn full_name(&self) -> String {
        let speed = self.speed.map_or_else(String::new, |speed| format!(", speed {speed}"));
        format!("{} in {}{speed}", self.part, self.package)
    }

    /// Returns the variant of nextpnr that supports the device.
    #[must_use]
    pub fn tool(&self) -> Tool {
        match self.family {
            DeviceFamily::Ecp5 => Tool::NextpnrEcp5,
            DeviceFamily::Ice40Up | DeviceFamily::Ice40Hx => Tool::NextpnrIce40,
            DeviceFamily::Gowin => Tool::NextpnrGowin,
        }
    }

    /// Returns the arguments of nextpnr other than netlist and seed.
    pub(crate) fn arguments(&self) -> Vec<String> {
        let target = self.family.target_mhz().to_string();
        if self.family == DeviceFamily::Gowin {
            // Part and speed grade are one argument, and even the clock needs a pin.
            let words = [self.flag, "--vopt", "family=GW2A-18C", "--vopt", "cst=pins.cst"];
            let freq = ["--freq", &target, "--timing-allow-fail"];
            return words.into_iter().chain(freq).map(str::to_owned).collect();
        }
        let speed = self.speed.map(|speed| ["--speed", speed]);
        let pins = match self.family {
            DeviceFamily::Ecp5 => "--lpf-allow-unconstrained",
            DeviceFamily::Ice40Up | DeviceFamily::Ice40Hx => "--pcf-allow-unconstrained",
            DeviceFamily::Gowin => "",
        };
        [self.flag, "--package", self.package]
            .into_iter()
            .chain(speed.into_iter().flatten())
            .chain([pins, "--freq", &target, "--timing-allow-fail"])
            .map(str::to_owned)
            .collect()
    }
}

impl DeviceFamily {
    /// Returns the synthesis command of the family, without `-top`.
    pub(crate) fn synthesis_command(self) -> &'static str {
        match self {
            Self::Ecp5 => "synth_ecp5 -abc9",
            Self::Ice40Up => "synth_ice40 -device u -spram -dsp",
            Self::Ice40Hx => "synth_ice40 -device hx",
            Self::Gowin => "synth_gowin -noiopads",
        }
    }

    /// Returns the macro that makes the Verilog use the family's own memories.
    pub(crate) fn memory_macro(self) -> Option<&'static str> {
        match self {
            Self::Ecp5 => Some("FOVEATE_ECP5"),
            Self::Ice40Up | Self::Ice40Hx | Self::Gowin => None,
        }
    }

    /// Returns whether look-up tables can be memory. If they cannot, a memory that requests
    /// distributed RAM becomes another memory of the family.
    pub(crate) fn has_distributed_ram(self) -> bool {
        match self {
            Self::Ecp5 | Self::Gowin => true,
            Self::Ice40Up | Self::Ice40Hx => false,
        }
    }

    /// Returns the constraint for the pin of the clock where nextpnr does not choose one: a file
    /// that its arguments name, and its text.
    pub(crate) fn pin_file(self, clock: &str) -> Option<(&'static str, String)> {
        match self {
            Self::Ecp5 | Self::Ice40Up | Self::Ice40Hx => None,
            Self::Gowin => Some(("pins.cst", format!("IO_LOC \"{clock}\" 4;\n"))),
        }
    }

    /// Returns the oldest Yosys whose netlists nextpnr accepts for the family: major, minor, and
    /// both as text.
    pub(crate) fn oldest_yosys(self) -> (u32, u32, &'static str) {
        match self {
            Self::Ecp5 | Self::Ice40Up | Self::Ice40Hx => (0, 23, "0.23"),
            Self::Gowin => (0, 45, "0.45"),
        }
    }

    /// Returns a clock frequency that no design of this project reaches, so that nextpnr continues
    /// to optimize. The result depends only weakly on it, because the weight of a path depends on
    /// its distance from the worst path.
    fn target_mhz(self) -> u32 {
        match self {
            Self::Ecp5 => 400,
            Self::Ice40Up => 100,
            Self::Ice40Hx => 200,
            Self::Gowin => 300,
        }
    }
}
