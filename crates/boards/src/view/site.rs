// SPDX-License-Identifier: MIT OR Apache-2.0
//! The content of `foveate view`: a stream of packets, and the registers of a board.

use super::server::{HttpAnswer, PageSite, stream_page};
use crate::view::board::BoardRegisters;
use crate::view::shared_stream::SharedStream;
use serde_json::Value;
use std::sync::Arc;
use std::time::Duration;

/// The time that a browser waits for a change.
const CHANGE_WAIT: Duration = Duration::from_secs(1);

/// A stream, and the board that sends it.
#[derive(Debug)]
pub(crate) struct StreamSite {
    pub(crate) live: Arc<SharedStream>,
    pub(crate) board: Arc<BoardRegisters>,
}

impl PageSite for StreamSite {
    fn command(&self) -> &'static str {
        "foveate view"
    }

    fn page(&self, nonce: &str) -> String {
        stream_page(nonce, &self.board.describe())
    }

    fn answer(&self, method: &str, subpath: &str, query: &str, body: &[u8]) -> Option<HttpAnswer> {
        Some(match (method, subpath) {
            ("GET", "next") => {
                let after = query.strip_prefix("after=").and_then(|after| after.parse().ok());
                HttpAnswer::binary(self.live.changes_after(after.unwrap_or(0), CHANGE_WAIT))
            }
            ("POST", "register") => self.write(body),
            (_, "next" | "register") => HttpAnswer::method_not_allowed(),
            _ => return None,
        })
    }

    fn is_over(&self) -> bool {
        self.live.is_over()
    }
}

impl StreamSite {
    /// Writes a register: `{"address": 256, "value": 4}`.
    fn write(&self, body: &[u8]) -> HttpAnswer {
        let asked: Value = serde_json::from_slice(body).unwrap_or_default();
        let Some((address, value)) = asked["address"].as_u64().zip(asked["value"].as_u64()) else {
            return HttpAnswer::text("400 Bad Request", "a register has an address and a value");
        };
        match self.board.write(address, value) {
            Ok(()) => HttpAnswer::text("200 OK", "written"),
            Err(why) => HttpAnswer::text("409 Conflict", &why),
        }
    }
}
