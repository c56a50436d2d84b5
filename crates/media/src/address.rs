// SPDX-License-Identifier: MIT OR Apache-2.0
//! The addresses of cameras, and the form in which any address may be shown: without users,
//! passwords and keys, wherever they occur.
//!
//! * The user and the password before the host are left out.
//! * The values of a query, and of a path such as `/user=me_password=secret`, become `***`. So do
//!   fragments.
//! * An address with a syntax error may hold a part of a password where a host or a path should be.
//!   Only its scheme is shown.

use std::fmt;
use std::path::Path;

/// The text that replaces a secret.
const HIDDEN: &str = "***";
/// The text that follows the scheme of an address of which no other part may be shown.
const HIDDEN_ADDRESS: &str = "://***";
/// Secrets of at least this length are replaced everywhere, shorter ones only if they are a whole
/// word.
const LONG_SECRET: usize = 4;

/// The address of a network camera, with its secrets.
#[derive(Clone, PartialEq, Eq)]
pub(crate) struct CameraAddress {
    url: String,
}

impl CameraAddress {
    /// Returns the address if the input is one of a network camera. The scheme may have capital
    /// letters, which ffmpeg does not accept, so it is converted to small letters.
    pub(crate) fn from_input(input: &Path) -> Option<Self> {
        let (scheme, rest) = input.to_str()?.split_once("://")?;
        let scheme = scheme.to_ascii_lowercase();
        let is_camera = scheme == "rtsp" || scheme == "rtsps";
        is_camera.then(|| Self { url: format!("{scheme}://{rest}") })
    }

    /// Returns the address with all secrets, for ffmpeg.
    pub(crate) fn url(&self) -> &str {
        &self.url
    }

    pub(crate) fn without_secrets(&self) -> String {
        url_without_secrets(&self.url)
    }

    /// Removes the secrets of this address from a message of ffmpeg, as they were given and
    /// percent-decoded.
    pub(crate) fn redact(&self, said: &str) -> String {
        let mut text = said.replace(&self.url, &self.without_secrets());
        for secret in self.secrets() {
            text = replace_secret(&text, &secret);
        }
        text_without_secrets(&text)
    }

    /// Returns everything that [`url_without_secrets`] hides, the longest secret first.
    fn secrets(&self) -> Vec<String> {
        let rest = self.url.split_once("://").map_or("", |(_, rest)| rest);
        let mut found = Vec::new();
        if let Some((user, host)) = rest.rsplit_once('@') {
            found.push(user.to_owned());
            found.extend(user.split(':').map(str::to_owned));
            found.extend(user.split_once(':').map(|(_, password)| password.to_owned()));
            found.extend(secret_values(host));
        }
        found.extend(secret_values(rest));
        if self.without_secrets().ends_with(HIDDEN_ADDRESS) {
            // Any part may belong to a password, and ffmpeg may repeat it alone.
            found.extend(rest.split([':', '/', '?', '#', '@', '&', '=', ';']).map(str::to_owned));
        }
        let decoded: Vec<String> = found.iter().map(|secret| percent_decoded(secret)).collect();
        found.extend(decoded);
        found.retain(|secret| !secret.is_empty());
        found.sort_by_key(|secret| std::cmp::Reverse(secret.len()));
        found.dedup();
        found
    }
}

/// The debug format hides the secrets, too.
impl fmt::Debug for CameraAddress {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.without_secrets())
    }
}

/// Returns an input as results and messages may name it: an address without its secrets, any other
/// input unchanged.
#[must_use]
pub fn input_without_secrets(input: &Path) -> String {
    let text = input.display().to_string();
    if let Some(address) = CameraAddress::from_input(input) {
        return address.without_secrets();
    }
    if input.exists() {
        return text;
    }
    // An address that lacks a slash is not valid, but it may hold a password.
    let scheme = text.split_once(':').map(|(scheme, _)| scheme.to_ascii_lowercase());
    let is_known = |scheme: &str| ["rtsp", "rtsps", "rtmp", "http", "https"].contains(&scheme);
    match scheme {
        Some(scheme) if is_known(&scheme) && !text.contains("://") => format!("{scheme}:{HIDDEN}"),
        _ if text.contains("://") => url_without_secrets(&text),
        _ => text,
    }
}

/// Returns a text with the secrets of every address in it removed.
#[must_use]
pub fn text_without_secrets(text: &str) -> String {
    let is_scheme = |c: char| c.is_ascii_alphanumeric() || "+.-".contains(c);
    let ends = |c: char| c.is_whitespace() || "'`\"<>".contains(c);
    let mut shown = String::with_capacity(text.len());
    let mut rest = text;
    while let Some(at) = rest.find("://") {
        let scheme = rest[..at].trim_end_matches(is_scheme).len();
        let end = rest[at..].find(ends).map_or(rest.len(), |length| at + length);
        shown.push_str(&rest[..scheme]);
        shown.push_str(&url_without_secrets(&rest[scheme..end]));
        rest = &rest[end..];
    }
    shown + rest
}

fn url_without_secrets(url: &str) -> String {
    let Some((scheme, rest)) = url.split_once("://") else { return url.to_owned() };
    let (authority, after) = rest.split_at(rest.find(['/', '?', '#']).unwrap_or(rest.len()));
    let host = authority.rsplit_once('@').map_or(authority, |(_, host)| host);
    if after.contains('@') || !has_plain_port(host) {
        return format!("{scheme}{HIDDEN_ADDRESS}");
    }
    let (path, more) = after.split_at(after.find(['?', '#']).unwrap_or(after.len()));
    let segments: Vec<String> = path.split('/').map(segment_without_value).collect();
    let mut shown = format!("{scheme}://{host}{}", segments.join("/"));
    let (query, fragment) = more.split_once('#').map_or((more, None), |(q, f)| (q, Some(f)));
    if let Some(query) = query.strip_prefix('?') {
        let pairs = query.split('&').map(|pair| match pair.split_once('=') {
            Some((key, _)) => format!("{key}={HIDDEN}"),
            None => HIDDEN.to_owned(),
        });
        shown.push('?');
        shown.push_str(&pairs.collect::<Vec<_>>().join("&"));
    }
    if fragment.is_some() {
        shown.push('#');
        shown.push_str(HIDDEN);
    }
    shown
}

/// Returns true if only a decimal port follows the host, so that it cannot be a password.
fn has_plain_port(host: &str) -> bool {
    let after_address = host.rsplit_once(']').map_or(host, |(_, after)| after);
    let mut parts = after_address.split(':').skip(1);
    parts.all(|port| port.bytes().all(|byte| byte.is_ascii_digit()))
}

/// Hides the value in a segment of a path: `user=me&password=secret` becomes `user=***`.
fn segment_without_value(segment: &str) -> String {
    match segment.split_once('=') {
        Some((key, _)) => format!("{key}={HIDDEN}"),
        None => segment.to_owned(),
    }
}

/// Returns the values that follow an equals sign, a question mark or a hash.
fn secret_values(rest: &str) -> impl Iterator<Item = String> + '_ {
    let parts = rest.split(['/', '?', '&', '#', ';']).filter_map(|part| part.split_once('='));
    let bare = rest.split_once(['?', '#']).map(|(_, query)| query.split(['&', '#']));
    let bare = bare.into_iter().flatten().filter(|part| !part.contains('='));
    parts.map(|(_, value)| value.to_owned()).chain(bare.map(str::to_owned))
}

/// Replaces a secret in a text: everywhere if it is long, otherwise only as a whole word.
fn replace_secret(text: &str, secret: &str) -> String {
    let mut shown = String::with_capacity(text.len());
    let mut rest = text;
    while let Some(at) = rest.find(secret) {
        let (before, after) = (&rest[..at], &rest[at + secret.len()..]);
        let joins = |c: Option<char>| c.is_some_and(char::is_alphanumeric);
        let before_joins = joins(before.chars().next_back().or_else(|| shown.chars().next_back()));
        let is_word = !before_joins && !joins(after.chars().next());
        shown.push_str(before);
        shown.push_str(if is_word || secret.len() >= LONG_SECRET { HIDDEN } else { secret });
        rest = after;
    }
    shown + rest
}

/// Decodes percent escapes: `%73ecret` becomes `secret`.
fn percent_decoded(text: &str) -> String {
    let mut bytes = Vec::with_capacity(text.len());
    let mut rest = text.as_bytes();
    while let [first, more @ ..] = rest {
        let digit = |at: usize| more.get(at).and_then(|&byte| char::from(byte).to_digit(16));
        match (first, digit(0), digit(1)) {
            (b'%', Some(high), Some(low)) => {
                bytes.push(u8::try_from(16 * high + low).unwrap_or_default());
                rest = &more[2..];
            }
            _ => {
                bytes.push(*first);
                rest = more;
            }
        }
    }
    String::from_utf8_lossy(&bytes).into_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_address_is_shown_with_its_secrets() {
        for (url, shown) in [
            ("rtsp://me:secret@10.0.0.7:554/live", "rtsp://10.0.0.7:554/live"),
            ("rtsp://me:s@cret@camera", "rtsp://camera"),
            ("rtsp://camera/live", "rtsp://camera/live"),
            ("rtsp://[fe80::1]:554/live", "rtsp://[fe80::1]:554/live"),
            ("RTSP://me:secret@camera/live", "RTSP://camera/live"),
            (
                "rtsp://camera/live?user=me&password=secret",
                "rtsp://camera/live?user=***&password=***",
            ),
            ("rtsp://camera?secret", "rtsp://camera?***"),
            ("rtsp://camera/live#secret", "rtsp://camera/live#***"),
            ("rtsp://camera/live?a=1#secret", "rtsp://camera/live?a=***#***"),
            ("rtsp://camera/user=me&password=secret&channel=1", "rtsp://camera/user=***"),
            ("rtsp://camera/live;password=secret/1", "rtsp://camera/live;password=***/1"),
            ("http://me:secret@host/a", "http://host/a"),
            // With an unescaped separator in the password, the start of the host is not known.
            ("rtsp://me:se/cret@10.0.0.7:554/live", "rtsp://***"),
            ("rtsp://me:secret?more@10.0.0.7/live", "rtsp://***"),
            ("rtsp://me:secret/10.0.0.7/live", "rtsp://***"),
            ("rtsp://me:secret@10.0.0.7/live?x=a@b", "rtsp://***"),
        ] {
            assert_eq!(url_without_secrets(url), shown);
            let text = format!("before `{url}' and {url}: after");
            assert!(
                !text_without_secrets(&text).contains("secret"),
                "{}",
                text_without_secrets(&text)
            );
            assert!(!input_without_secrets(Path::new(url)).contains("secret"));
        }
        for text in ["no address", "a:b", "://", "a ://b", "scene:street"] {
            assert_eq!(text_without_secrets(text), text);
            assert_eq!(input_without_secrets(Path::new(text)), text);
        }
        assert_eq!(input_without_secrets(Path::new("rtsp:/me:secret@camera")), "rtsp:***");
    }

    #[test]
    fn what_ffmpeg_repeats_has_no_secrets() {
        let url = "RTSP://m%65:s%65cret@camera/live?token=ab&key=longer";
        let address = CameraAddress::from_input(Path::new(url)).unwrap();
        assert!(address.url().starts_with("rtsp://m%65"));
        for (said, shown) in [
            ("s%65cret or secret is wrong", "*** or *** is wrong"),
            ("tab ab longer xlongerx", "tab *** *** x***x"),
            ("rtsp://camera/live?token=ab: refused", "rtsp://camera/live?token=***"),
            ("tcp://camera:554?timeout=1 failed", "tcp://camera:554?timeout=*** failed"),
            ("user me", "user ***"),
        ] {
            assert!(address.redact(said).starts_with(shown), "{}", address.redact(said));
        }
        assert!(!format!("{address:?}").contains("ecret"));
        assert!(CameraAddress::from_input(Path::new("http://camera")).is_none());
    }
}
