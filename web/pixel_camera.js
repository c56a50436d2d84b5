// SPDX-License-Identifier: MIT OR Apache-2.0
// Counts the events of an ordinary event camera, for comparison. The rule is that of `foveate simulate --pixel-events
// --log` (crates/simulator/src/output/pixel_camera.rs), in integers, and a test compares the counts.

/** Bytes of an event. */
export const PIXEL_EVENT_BYTES = 4;
/** The threshold in millionths, so that 200000 is a contrast of 0.2. */
const CONTRAST = 200_000;
/** The grey level below which a pixel is linear. */
const LINEAR_UP_TO = 20;

/** Returns an 8-bit value at the depth of the camera: low bits are dropped, or bits are repeated below. */
const atDepth = (value, bits) => bits <= 8 ? value >> (8 - bits) : (value << 8 | value) >> (16 - bits);

/** Returns the level of every 8-bit value for a camera of `bits` bits. */
function levels(bits) {
  return Int32Array.from({ length: 256 }, (_, value) => {
    const grey = atDepth(value, bits) * 255 / (2 ** bits - 1);
    return Math.round(1e6 * (grey <= LINEAR_UP_TO ? grey * Math.log(LINEAR_UP_TO) / LINEAR_UP_TO : Math.log(grey)));
  });
}

export class PixelCamera {
  /** Makes a camera for pixels of `bits` bits, of which 8 are shown. */
  constructor(bits) {
    this.levels = levels(bits);
    this.remembered = null;
  }

  /** Takes the next frame, 8-bit grey. Returns its number of events. */
  step(grey) {
    const { levels } = this;
    if (!this.remembered) {
      this.remembered = Int32Array.from(grey, value => levels[value]);
      return 0;
    }
    const { remembered } = this;
    let events = 0;
    for (let place = 0; place < grey.length; place++) {
      const change = levels[grey[place]] - remembered[place];
      if (change < CONTRAST && change > -CONTRAST) continue;
      const steps = Math.trunc(change / CONTRAST);
      remembered[place] += steps * CONTRAST;
      events += Math.abs(steps);
    }
    return events;
  }
}
