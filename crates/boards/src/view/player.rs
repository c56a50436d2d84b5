// SPDX-License-Identifier: MIT OR Apache-2.0
//! The page of `foveate live`, on which a camera runs in the browser, with frames that this machine
//! decodes.

use std::fmt::Write as _;
use std::net::SocketAddr;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, OnceLock};
use std::time::Duration;

use foveate_camera::CameraConfig;
use foveate_design::Preset;
use foveate_media::InputOptions;
use serde_json::Value;

use super::server::HttpAnswer;
use crate::view::camera_page::camera_page;
use crate::view::frame_player::FramePlayer;
use crate::view::server::{PageServer, PageSite};
use crate::view::{ViewError, start_thread};

/// The time that a browser waits for a frame.
const FRAME_WAIT: Duration = Duration::from_secs(1);

/// The options of a player: its inputs, its camera and its address.
#[derive(Clone, Debug)]
pub struct PlayerOptions {
    /// The inputs, as for `foveate simulate`. Without inputs, the page offers scenes, the browser's
    /// camera, and files that the browser decodes.
    pub inputs: Vec<String>,
    /// The options for reading the inputs.
    pub input: InputOptions,
    /// The preset with which the page begins; the page has its own if this is `None`.
    pub preset: Option<String>,
    /// The camera with which the page begins, if it differs from the preset.
    pub camera: Option<CameraConfig>,
    /// The address at which browsers find the page. It must be an address of this machine alone.
    pub address: SocketAddr,
}

/// A page with a camera, which is served until this value is dropped.
#[derive(Debug)]
pub struct Player {
    site: Arc<PlayerSite>,
    server: PageServer,
    settings: String,
}

impl Player {
    /// Opens the inputs and serves the page.
    ///
    /// # Errors
    /// Fails if the inputs or the address cannot be used.
    pub fn open(options: PlayerOptions) -> Result<Self, ViewError> {
        let PlayerOptions { inputs, input, preset, camera, address } = options;
        let settings = link_settings(preset.as_deref(), camera.as_ref())?;
        let opened = if inputs.is_empty() { None } else { Some(FramePlayer::open(inputs, input)?) };
        let (frames, source) = opened.unzip();
        let (page, is_over) = (OnceLock::new(), AtomicBool::new(false));
        let site = Arc::new(PlayerSite { frames, page, is_over });
        let server = PageServer::start(address, Arc::clone(&site))?;
        if let Some(source) = source {
            let site = Arc::clone(&site);
            start_thread("reader", move || {
                if let Some(frames) = &site.frames {
                    frames.run(source);
                }
            })?;
        }
        Ok(Self { site, server, settings })
    }

    /// Returns the link of the page, with its settings.
    #[must_use]
    pub fn link(&self) -> String {
        let link = self.server.link();
        if self.settings.is_empty() { link.to_owned() } else { format!("{link}#{}", self.settings) }
    }

    /// Returns the messages since the last call.
    #[must_use]
    pub fn take_messages(&self) -> Vec<String> {
        self.site.frames.as_ref().map(FramePlayer::take_messages).unwrap_or_default()
    }

    /// Returns the number of frames that were decoded.
    #[must_use]
    pub fn frames_decoded(&self) -> u64 {
        self.site.frames.as_ref().map_or(0, FramePlayer::frame_count)
    }
}

impl Drop for Player {
    fn drop(&mut self) {
        self.site.is_over.store(true, Ordering::Relaxed);
        if let Some(frames) = &self.site.frames {
            frames.end();
        }
        self.server.wake();
    }
}

/// The page, and the frames of the inputs if there are inputs.
#[derive(Debug)]
struct PlayerSite {
    frames: Option<FramePlayer>,
    /// The text of the page. It is made for the first browser, because compressing the engine takes
    /// a while.
    page: OnceLock<String>,
    is_over: AtomicBool,
}

impl PageSite for PlayerSite {
    fn command(&self) -> &'static str {
        "foveate live"
    }

    fn page(&self, _nonce: &str) -> String {
        let frames = self.frames.as_ref().map(|_| "frames");
        self.page.get_or_init(|| camera_page(frames)).clone()
    }

    /// The page itself has a policy for what it may load.
    fn policy(&self, _nonce: &str) -> String {
        "base-uri 'none'; form-action 'none'; frame-ancestors 'none'".to_owned()
    }

    fn answer(&self, method: &str, subpath: &str, query: &str, _body: &[u8]) -> Option<HttpAnswer> {
        let frames = self.frames.as_ref()?;
        Some(match (method, subpath) {
            ("GET", "frames") => {
                let value = |key| {
                    query
                        .split('&')
                        .find_map(|pair| pair.split_once('=').filter(|(name, _)| *name == key))
                };
                let after = value("after").and_then(|(_, after)| after.parse().ok());
                let viewer = value("viewer").map(|(_, viewer)| viewer);
                HttpAnswer::binary(frames.frame_after(after, viewer, FRAME_WAIT))
            }
            ("POST", "restart") => match frames.restart() {
                Ok(()) => HttpAnswer::text("200 OK", "the input begins again"),
                Err(why) => HttpAnswer::text("409 Conflict", &why),
            },
            (_, "frames" | "restart") => HttpAnswer::method_not_allowed(),
            _ => return None,
        })
    }

    fn is_over(&self) -> bool {
        self.is_over.load(Ordering::Relaxed)
    }
}

/// Returns the settings that the page takes from its link: the preset, and every key of the camera
/// whose value differs from the preset's.
fn link_settings(preset: Option<&str>, camera: Option<&CameraConfig>) -> Result<String, ViewError> {
    let mut text = preset.map(|name| format!("preset={name}")).unwrap_or_default();
    let Some(camera) = camera else { return Ok(text) };
    let name = preset.unwrap_or("paper");
    if preset.is_none() {
        text = format!("preset={name}");
    }
    let (before, present) =
        (dotted_keys(&Preset::find(name)?.config()?.camera), dotted_keys(camera));
    let is_feature = |key: &str| key.starts_with("spatial.");
    let differs = |(key, value): &&(String, Value)| {
        !before.iter().any(|(other, old)| other == key && old == value)
    };
    let feature_differs = before.iter().filter(|(key, _)| is_feature(key)).count()
        != present.iter().filter(|(key, _)| is_feature(key)).count()
        || present.iter().filter(differs).any(|(key, _)| is_feature(key));
    // The keys of features are numbered, so all of them are given if one differs.
    let is_included = |entry: &&(String, Value)| {
        if is_feature(&entry.0) { feature_differs } else { differs(entry) }
    };
    for (key, value) in present.iter().filter(is_included) {
        let value = value.to_string().replace('"', "%22").replace(' ', "%20");
        write!(text, "&{key}={value}").expect("a String takes everything");
    }
    Ok(text)
}

/// Returns every key of a camera with its value. Keys are dotted, such as `spatial.0.level`. The
/// size of the frame is left out, because the input gives it.
fn dotted_keys(camera: &CameraConfig) -> Vec<(String, Value)> {
    fn walk(path: &str, value: Value, found: &mut Vec<(String, Value)>) {
        let inner =
            |name: &str| if path.is_empty() { name.to_owned() } else { format!("{path}.{name}") };
        match value {
            Value::Object(table) => {
                table.into_iter().for_each(|(name, value)| walk(&inner(&name), value, found));
            }
            Value::Array(list) => {
                let numbered = list.into_iter().enumerate();
                numbered.for_each(|(at, value)| walk(&inner(&at.to_string()), value, found));
            }
            Value::Null => {}
            value => found.push((path.to_owned(), value)),
        }
    }
    let mut found = Vec::new();
    walk("", serde_json::to_value(camera).unwrap_or_default(), &mut found);
    found.retain(|(key, _)| key != "frame.width" && key != "frame.height");
    found
}

#[cfg(test)]
mod tests {
    use foveate_design::DesignConfig;

    use super::link_settings;

    #[test]
    fn the_link_has_the_keys_that_differ_from_the_preset() {
        let settings_of = |preset, set: &[&str]| {
            let toml = foveate_design::Preset::find(preset).unwrap().toml;
            let camera = DesignConfig::from_toml_with(toml, set).unwrap().camera;
            link_settings(Some(preset), Some(&camera)).unwrap()
        };
        assert_eq!(settings_of("fovea", &[]), "preset=fovea");
        assert_eq!(
            settings_of("fovea", &["region.size=16", "render.irrelevant='hold'", "frame.width=64"]),
            "preset=fovea&region.size=16&render.irrelevant=%22hold%22"
        );
        let all = settings_of("fovea", &["spatial.0.level=77"]);
        assert!(
            all.contains("spatial.0.feature=%22") && all.contains("spatial.0.level=77"),
            "{all}"
        );
        assert_eq!(link_settings(None, None).unwrap(), "");
        assert!(link_settings(Some("nonsense"), Some(&DesignConfig::default().camera)).is_err());
    }
}
