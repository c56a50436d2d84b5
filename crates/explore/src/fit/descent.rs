// SPDX-License-Identifier: MIT OR Apache-2.0
//! The cheapest camera behind which a network agrees with its outputs for whole frames: a descent
//! from the task.
//!
//! The descent starts at the task, with every setting of what irrelevant regions show, and at a
//! camera that sends nearly all pixels. It examines cameras that differ from the best one so far in
//! one setting, the cheapest first, until one agrees enough; that camera becomes the best one. The
//! descent ends when no cheaper camera agrees enough.
//!
//! The cheapest of many cameras that agree enough on some frames agrees partly by chance. So the
//! descent compares the agreement that is to be expected of other frames. A camera that agrees
//! enough must also be confirmed by later frames, which are used for nothing else.

use std::collections::BTreeMap;

use foveate_camera::{
    Camera, CameraConfig, FeatureKind, Filter, Irrelevant, PeripheryConfig, Reference,
    SUMMARY_BLOCKS, SpatialConfig,
};
use foveate_design::{HardwareConfig, is_taken};

use super::agreed::Agreed;
use super::build::cheapest_rough;
use super::constraints::Held;
use super::looks::Search;
use super::network::{Cheapest, Jury, Part};
use super::target::scaled_by;
use crate::ExploreError;

/// The sides of regions that are tried besides the task's.
const SIDES: [u32; 2] = [8, 16];
/// The octaves by which the thresholds of the task are scaled.
const OCTAVES: [i32; 6] = [-1, 1, 2, 3, 4, 5];
/// The levels of a periphery in grey levels of 8 bits: means may differ by so much.
const LEVELS: [u32; 4] = [2, 4, 8, 12];
/// The numbers of changed pixels that make a region active.
const COUNTS: [u32; 6] = [1, 2, 3, 5, 8, 12];
/// The number of depths below the task's that are tried.
const FEWER_BITS: u32 = 3;

/// The state of the descent.
pub(super) struct Descent<'s, 'a> {
    search: &'s mut Search<'a>,
    jury: &'s Jury<'a>,
    hardware: &'s HardwareConfig,
    asked: Asked,
}

impl<'s, 'a> Descent<'s, 'a> {
    pub(super) fn new(
        search: &'s mut Search<'a>,
        jury: &'s Jury<'a>,
        hardware: &'s HardwareConfig,
    ) -> Self {
        Self { search, jury, hardware, asked: Asked::default() }
    }

    /// Descends from the task and from a camera that sends nearly all pixels, until nothing is
    /// cheaper. The search then contains the camera where the descent ends, or the camera that
    /// sends nearly all pixels if none meets the limits.
    pub(super) fn run(mut self) -> Result<Asked, ExploreError> {
        let all = nearly_all(self.search.task());
        let mut starts = ways_to_show(self.search.task());
        starts.push(all.clone());
        let mut best = self.cheapest(&starts, f64::INFINITY)?;
        loop {
            let (most, from) =
                best.as_ref().map_or((f64::INFINITY, &all), |(cost, config)| (*cost, config));
            match self.cheapest(&neighbors(from), most)? {
                Some(better) => best = Some(better),
                None => break,
            }
        }
        let (_, chosen) = best.unwrap_or((f64::INFINITY, all));
        let camera = chosen.validate()?;
        let expected = self.ask(&camera, None)?.expected.min(self.confirm(&camera, None)?.expected);
        if self.search.get(camera.config()).is_none() {
            self.look(camera.config(), expected)?;
        }
        Ok(self.asked)
    }

    /// Returns the cheapest camera that meets the limits and costs less than `most`.
    fn cheapest(
        &mut self,
        configs: &[CameraConfig],
        most: f64,
    ) -> Result<Option<(f64, CameraConfig)>, ExploreError> {
        let mut priced = self.priced(configs)?;
        priced.retain(|(cost, _)| *cost < most);
        priced.sort_by(|one, other| one.0.total_cmp(&other.0));
        for (cost, camera) in priced {
            let Some(expected) = self.expected(&camera)? else { continue };
            let config = camera.config();
            // Measuring all figures of a camera takes longer than running the network, so the
            // network runs first.
            if !self.search.limits_figures() || self.look(config, expected)? {
                return Ok(Some((cost, config.clone())));
            }
        }
        Ok(None)
    }

    /// Returns the agreement to expect of other frames, if it is enough on the frames of the search
    /// and on those that confirm.
    fn expected(&mut self, camera: &Camera) -> Result<Option<f64>, ExploreError> {
        let least = self.jury.goal.min_agreement;
        let searched = self.ask(camera, Some(least))?.expected;
        if searched < least {
            return Ok(None);
        }
        let confirmed = self.confirm(camera, Some(least))?.expected;
        Ok((confirmed >= least).then(|| searched.min(confirmed)))
    }

    /// Returns the cost of each camera. It leaves out invalid cameras, and cameras that no
    /// organization can build.
    fn priced(&self, configs: &[CameraConfig]) -> Result<Vec<(f64, Camera)>, ExploreError> {
        let mut cameras: Vec<Camera> = Vec::new();
        let taken = configs.iter().filter(|config| is_taken(config));
        for camera in taken.filter_map(|config| config.validate().ok()) {
            if !cameras.contains(&camera) {
                cameras.push(camera);
            }
        }
        let costs = match self.jury.goal.cheapest {
            Cheapest::Bytes => self.jury.bytes_sent(&cameras, self.asked.count())?,
            Cheapest::Area => {
                let cost = |camera: &Camera| cheapest_rough(camera.config(), self.hardware);
                cameras.iter().map(cost).collect()
            }
        };
        Ok(costs.into_iter().zip(cameras).collect())
    }

    /// Returns the agreement of a camera on the frames of the search; the exact agreement if there
    /// is no `least`.
    fn ask(&mut self, camera: &Camera, least: Option<f64>) -> Result<Agreed, ExploreError> {
        let asked = self.asked.count();
        let ask = || self.jury.ask(camera, Part::Search, least, asked);
        known_or(&mut self.asked.searched, camera, least, ask)
    }

    /// Returns the agreement of a camera on the later frames that confirm.
    fn confirm(&mut self, camera: &Camera, least: Option<f64>) -> Result<Agreed, ExploreError> {
        let asked = self.asked.count();
        let ask = || self.jury.ask(camera, Part::Confirmation, least, asked);
        known_or(&mut self.asked.confirmed, camera, least, ask)
    }

    /// Measures all figures of a camera. Returns whether all limits hold, including the one on the
    /// expected agreement.
    fn look(&mut self, config: &CameraConfig, expected: f64) -> Result<bool, ExploreError> {
        let mut holds = false;
        for mut look in self.search.look(std::slice::from_ref(config))? {
            look.held.push(Held::expected_agreement(expected, self.jury.goal.min_agreement));
            holds = look.holds();
            self.search.replace(look);
        }
        Ok(holds)
    }
}

/// Returns the known agreement of a camera, or calls `ask`. Without `least`, a known upper bound is
/// not enough.
fn known_or(
    known: &mut BTreeMap<String, Agreed>,
    camera: &Camera,
    least: Option<f64>,
    ask: impl FnOnce() -> Result<Agreed, ExploreError>,
) -> Result<Agreed, ExploreError> {
    let key = camera.config().to_toml();
    let enough = |agreed: &&Agreed| least.is_some() || !agreed.at_most;
    if let Some(agreed) = known.get(&key).filter(enough) {
        return Ok(*agreed);
    }
    let agreed = ask()?;
    known.insert(key, agreed);
    Ok(agreed)
}

/// Returns a camera that sends much more than the task's. If the network disagrees behind this
/// camera, it disagrees behind all others.
fn nearly_all(task: &CameraConfig) -> CameraConfig {
    const OCTAVES: f64 = -2.0;
    let mut config = scaled_by(task, OCTAVES, OCTAVES);
    let fits = |blocks: &&u32| task.region.size.is_multiple_of(**blocks);
    config.render.irrelevant = Irrelevant::Mean;
    config.periphery.blocks = SUMMARY_BLOCKS.iter().filter(fits).max().copied();
    config.periphery.level = Some(1 << task.frame.pixel_bits.saturating_sub(8));
    config.denoise.filter = Filter::None;
    config.temporal.reference = Reference::LastSent;
    config.temporal.min_count = config.temporal.min_count.min(1);
    config
}

/// Returns the camera with every setting of what irrelevant regions show.
fn ways_to_show(config: &CameraConfig) -> Vec<CameraConfig> {
    let mut found = Vec::new();
    for &irrelevant in Irrelevant::ALL {
        let blocks: Vec<Option<u32>> = match irrelevant {
            Irrelevant::Zero | Irrelevant::Hold => vec![None],
            Irrelevant::Mean => SUMMARY_BLOCKS.iter().copied().map(Some).collect(),
        };
        for blocks in blocks {
            let mut other = config.clone();
            other.render.irrelevant = irrelevant;
            other.periphery.blocks = blocks;
            other.periphery.level = blocks.and(other.periphery.level);
            found.push(other);
        }
    }
    found
}

/// Returns the cameras that differ in one setting.
fn neighbors(config: &CameraConfig) -> Vec<CameraConfig> {
    let bits = config.frame.pixel_bits;
    let with = |change: &dyn Fn(&mut CameraConfig)| {
        let mut other = config.clone();
        change(&mut other);
        other
    };
    let mut found = ways_to_show(config);
    for octaves in OCTAVES.map(f64::from) {
        let ways = [(octaves, octaves), (octaves, 0.0), (0.0, octaves)];
        found.extend(ways.map(|(spatial, temporal)| scaled_by(config, spatial, temporal)));
    }
    for &kind in FeatureKind::ALL {
        let alone = vec![SpatialConfig::new(kind).with_defaults(bits)];
        let alone = with(&|config| config.spatial.clone_from(&alone));
        found.extend([0.0, 1.0, 2.0].map(|octaves| scaled_by(&alone, octaves, 0.0)));
    }
    found.extend(SIDES.map(|side| with(&|config| config.region.size = side)));
    found.extend(Filter::ALL.iter().map(|&filter| with(&|config| config.denoise.filter = filter)));
    let references = Reference::ALL.iter();
    found.extend(references.map(|&one| with(&|config| config.temporal.reference = one)));
    found.extend(COUNTS.map(|count| with(&|config| config.temporal.min_count = count)));
    if config.validate().is_ok_and(|camera| camera.periphery().is_some()) {
        let levels = LEVELS.map(|level| level_at(level, bits));
        found.extend(levels.map(|level| with(&|config| config.periphery.level = level)));
    }
    found.extend((1..=FEWER_BITS.min(bits - 1)).map(|fewer| config.at_depth(bits - fewer)));
    found
}

/// Converts the level of a periphery from 8 bits to another depth.
fn level_at(level: u32, bits: u32) -> Option<u32> {
    let periphery = PeripheryConfig { level: Some(level), ..PeripheryConfig::default() };
    CameraConfig { periphery, ..CameraConfig::default() }.at_depth(bits).periphery.level
}

/// The agreement of the network behind cameras, by their configurations.
#[derive(Debug, Default)]
pub(super) struct Asked {
    /// The agreement on the frames of the search.
    searched: BTreeMap<String, Agreed>,
    /// The agreement on later frames, for cameras that agreed enough before.
    confirmed: BTreeMap<String, Agreed>,
}

impl Asked {
    /// Returns the number of cameras.
    pub(super) fn count(&self) -> usize {
        self.searched.len()
    }

    /// Returns the exact agreement of a camera, and its agreement on later frames if it is known.
    pub(super) fn of(&self, config: &CameraConfig) -> (Agreed, Option<Agreed>) {
        let text = config.to_toml();
        (self.searched[&text], self.confirmed.get(&text).copied())
    }

    /// Returns the reasons of the network for choosing this camera; `least` is the agreement that
    /// was to be reached.
    pub(super) fn reasons(&self, chosen: &CameraConfig, least: f64) -> Vec<String> {
        self.not_confirmed(least).into_iter().chain(self.steps(chosen)).collect()
    }

    /// Returns a sentence with the number of cameras that later frames did not confirm.
    fn not_confirmed(&self, least: f64) -> Option<String> {
        let failed = |agreed: &&Agreed| agreed.at_most || agreed.expected < least;
        let count = self.confirmed.values().filter(failed).count();
        let all = self.confirmed.len();
        (count > 0).then(|| {
            format!(
                "later frames did not confirm {count} of {all} cameras that agreed enough before"
            )
        })
    }

    /// Returns a line for each camera that differs from the chosen one in one setting, in the order
    /// of the keys.
    fn steps(&self, chosen: &CameraConfig) -> Vec<String> {
        let own = settings(&chosen.to_toml());
        let step = |(text, agreed): (&String, &Agreed)| {
            let other = settings(text);
            let mut changed = other.iter().filter(|setting| !own.contains(setting));
            let lost = own.iter().filter(|setting| !other.contains(setting)).count();
            let setting = changed.next().filter(|_| lost <= 1 && changed.next().is_none())?;
            let bound = if agreed.at_most { "at most " } else { "" };
            let share = 100.0 * agreed.share;
            let expected = 100.0 * agreed.expected;
            let elsewhere = (!agreed.at_most).then(|| format!(", {expected:.1} % elsewhere"));
            let elsewhere = elsewhere.unwrap_or_default();
            Some(format!("{setting}: agreement {bound}{share:.1} %{elsewhere}"))
        };
        self.searched.iter().filter_map(step).collect()
    }
}

/// Returns the settings of a configuration, each with the names of its tables.
fn settings(toml: &str) -> Vec<String> {
    let table: toml::Table = toml.parse().expect("a configuration is written as TOML");
    let mut found = Vec::new();
    gather("", &toml::Value::Table(table), &mut found);
    found
}

fn gather(name: &str, value: &toml::Value, found: &mut Vec<String>) {
    match value {
        toml::Value::Table(table) => {
            for (key, value) in table {
                let name = if name.is_empty() { key.clone() } else { format!("{name}.{key}") };
                gather(&name, value, found);
            }
        }
        toml::Value::Array(entries) => {
            entries.iter().for_each(|entry| gather(name, entry, found));
        }
        value => found.push(format!("{name} = {value}")),
    }
}
