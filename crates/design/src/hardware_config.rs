// SPDX-License-Identifier: MIT OR Apache-2.0
//! The table `[hardware]` of a configuration: the organization with the keys that only it has, and
//! the keys that every organization has.

use crate::keys::{HARDWARE_KEYS, own_keys};
use crate::{
    FrameStoreKind, InterfaceKind, LaneMemoryKind, Organization, Pipelining, PixelFeed,
    ThresholdSource,
};
use foveate_camera::{ConfigError, toml_text};
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use toml::{Table, Value};

/// The table `[hardware]`: the organization and its properties.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct HardwareConfig {
    /// The structure of the hardware, and the keys that only this structure has.
    #[serde(flatten)]
    pub organization: OrganizationConfig,
    /// The number of registers in the arithmetic.
    pub pipelining: Pipelining,
    /// True if the core has an input that marks the start of a frame and finds its frames again
    /// after an error.
    pub sync: bool,
    /// The source of the thresholds: input ports, or constants in the core.
    pub thresholds: ThresholdSource,
}

/// An organization with the keys that only it has.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
#[serde(tag = "organization")]
pub enum OrganizationConfig {
    /// One RPU per region.
    #[default]
    #[serde(rename = "pipelined")]
    Pipelined,
    /// Lanes that regions share, under one sequencer.
    #[serde(rename = "serial")]
    Serial(SerialConfig),
    /// One core for all regions.
    #[serde(rename = "raster")]
    Raster(RasterConfig),
}

/// The keys that only the serial organization has.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct SerialConfig {
    /// Regions per lane K, 1..=M.
    pub fold: u32,
    /// The order in which pixels enter. If the key is left out, it is `parallel`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub feed: Option<PixelFeed>,
    /// The kind of memory of the lanes, which affects the cycle counts. If the key is left out, the
    /// memory is distributed where that takes at most 128 memory LUTs, else block; see
    /// [`crate::LaneMemory`].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub memory: Option<LaneMemoryKind>,
}

impl Default for SerialConfig {
    fn default() -> Self {
        Self { fold: 1, feed: None, memory: None }
    }
}

/// The keys that only the raster organization has.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct RasterConfig {
    /// Pixels that the core takes per clock, K: 1, 2 or 4. If the key is left out, it is 1.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub pixels_per_clock: Option<u32>,
    /// The memory of the frame store. If the key is left out, it is `block`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub store: Option<FrameStoreKind>,
    /// True if the pixels of active regions leave the core. If the key is left out, they do.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub forward: Option<bool>,
    /// The interface of the core. If the key is left out, the core has plain ports.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub interface: Option<InterfaceKind>,
}

/// Makes the configuration of an organization with the defaults of its own keys.
impl From<Organization> for OrganizationConfig {
    fn from(organization: Organization) -> Self {
        match organization {
            Organization::Pipelined => Self::Pipelined,
            Organization::Serial => Self::Serial(SerialConfig::default()),
            Organization::Raster => Self::Raster(RasterConfig::default()),
        }
    }
}

impl OrganizationConfig {
    /// Returns the organization without its keys.
    #[must_use]
    pub fn kind(&self) -> Organization {
        match self {
            Self::Pipelined => Organization::Pipelined,
            Self::Serial(_) => Organization::Serial,
            Self::Raster(_) => Organization::Raster,
        }
    }
}

impl HardwareConfig {
    /// Returns the keys of the serial organization. If the organization is another one, it becomes
    /// serial first, with the defaults of these keys.
    pub fn make_serial(&mut self) -> &mut SerialConfig {
        match self.organization {
            OrganizationConfig::Serial(_) => {}
            OrganizationConfig::Pipelined | OrganizationConfig::Raster(_) => {
                self.organization = Organization::Serial.into();
            }
        }
        match &mut self.organization {
            OrganizationConfig::Serial(own) => own,
            OrganizationConfig::Pipelined | OrganizationConfig::Raster(_) => {
                unreachable!("it has just become serial")
            }
        }
    }

    /// Returns the keys of the raster organization. If the organization is another one, it becomes
    /// raster first, with the defaults of these keys.
    pub fn make_raster(&mut self) -> &mut RasterConfig {
        match self.organization {
            OrganizationConfig::Raster(_) => {}
            OrganizationConfig::Pipelined | OrganizationConfig::Serial(_) => {
                self.organization = Organization::Raster.into();
            }
        }
        match &mut self.organization {
            OrganizationConfig::Raster(own) => own,
            OrganizationConfig::Pipelined | OrganizationConfig::Serial(_) => {
                unreachable!("it has just become raster")
            }
        }
    }

    /// Gives every region a unit of its own (fold 1), if the organization lets regions share one.
    pub fn unfold(&mut self) {
        match &mut self.organization {
            OrganizationConfig::Serial(own) => own.fold = 1,
            OrganizationConfig::Pipelined | OrganizationConfig::Raster(_) => {}
        }
    }

    /// Reads a table that has nothing but the table `[hardware]`, or nothing. It must have no
    /// unknown key.
    pub(crate) fn from_table(table: &Table) -> Result<Self, ConfigError> {
        let CommonKeys { organization, pipelining, sync, thresholds } = read_keys(table)?;
        // A value of the wrong type is refused as such, also where the key has no place.
        let (serial, raster) = (read_keys(table)?, read_keys(table)?);
        refuse_foreign_keys(organization, table)?;
        let organization = match organization {
            Organization::Pipelined => OrganizationConfig::Pipelined,
            Organization::Serial => OrganizationConfig::Serial(serial),
            Organization::Raster => OrganizationConfig::Raster(raster),
        };
        Ok(Self { organization, pipelining, sync, thresholds })
    }

    /// Returns a short description of the hardware, such as "serial, raster feed, fold 4".
    #[must_use]
    pub fn description(&self) -> String {
        let mut words = vec![self.organization.kind().name().to_owned()];
        let pipelining = || format!("{} pipelining", self.pipelining);
        let more_pipelining = || match self.pipelining {
            Pipelining::Plain => None,
            Pipelining::Deep => Some(pipelining()),
        };
        match &self.organization {
            OrganizationConfig::Pipelined => words.extend(more_pipelining()),
            OrganizationConfig::Serial(own) => {
                words.push(format!("{} feed", own.feed.unwrap_or_default()));
                words.push(format!("fold {}", own.fold));
                words.extend(own.memory.map(|memory| format!("{memory} memory")));
                words.extend(more_pipelining());
            }
            OrganizationConfig::Raster(own) => {
                words.extend(own.pixels_per_clock.map(|pixels| {
                    let plural = if pixels == 1 { "" } else { "s" };
                    format!("{pixels} pixel{plural} per clock")
                }));
                words.push(pipelining());
                words.extend(own.store.map(|store| format!("{store} store")));
                words.extend((own.forward == Some(false)).then(|| "no forwarding".to_owned()));
                match own.interface.unwrap_or_default() {
                    InterfaceKind::Ports => {}
                    InterfaceKind::Axi => words.push(format!("interface {}", InterfaceKind::Axi)),
                }
            }
        }
        words.extend(self.sync.then(|| "frame sync".to_owned()));
        words.join(", ")
    }
}

/// The keys of `[hardware]` that every organization has.
#[derive(Default, Deserialize)]
#[serde(default)]
struct CommonKeys {
    organization: Organization,
    pipelining: Pipelining,
    sync: bool,
    thresholds: ThresholdSource,
}

/// Reads some of the keys of `[hardware]`, and ignores the others.
fn read_keys<T: DeserializeOwned + Default>(table: &Table) -> Result<T, ConfigError> {
    /// The table around `[hardware]`, so that messages have the whole path of a key.
    #[derive(Deserialize)]
    struct OuterTable<T: Default> {
        #[serde(default)]
        hardware: T,
    }
    toml_text::read_table(HARDWARE_KEYS.iter(), table.clone())
        .map(|OuterTable { hardware }| hardware)
}

/// Refuses the keys that only another organization has, whatever their values, except `fold = 1`.
fn refuse_foreign_keys(organization: Organization, table: &Table) -> Result<(), ConfigError> {
    let Some(Value::Table(written)) = table.get("hardware") else { return Ok(()) };
    for &owner in Organization::ALL.iter().filter(|&&other| other != organization) {
        for &key in own_keys(owner) {
            match (key, written.get(key)) {
                (_, None) | ("fold", Some(Value::Integer(1))) => {}
                ("fold", Some(fold)) => return Err(organization.folding_error(fold.to_string())),
                (_, Some(value)) => {
                    let (key, value) = (format!("hardware.{key}"), value.to_string());
                    let remedy = format!(
                        "only the {owner} organization has this key; leave the key out, or use \
                         organization = \"{owner}\""
                    );
                    return Err(organization.combination_error(&key, value, &remedy));
                }
            }
        }
    }
    Ok(())
}
