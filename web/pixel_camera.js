// SPDX-License-Identifier: MIT OR Apache-2.0
// An ordinary event camera, for comparison: how many events it would send. The rule is that of `foveate simulate --pixel-events
// --log` (crates/simulator/src/output/pixel_camera.rs), in integers, and a test compares the counts.

/** Bytes of an event. */
export const PIXEL_EVENT_BYTES = 4;
/** A level in millionths, so that 200000 is a contrast of 0.2. */
const CONTRAST = 200_000;
/** Below this grey level a pixel is linear. */
const LINEAR_UP_TO = 20;

/** A value of 8 bits as the camera has it: low bits dropped, or repeated below. */
const converted = (value, bits) => bits <= 8 ? value >> (8 - bits) : (value << 8 | value) >> (16 - bits);

/** The level of every 8-bit value for a camera of `bits` bits. */
function levels(bits) {
  return Int32Array.from({ length: 256 }, (_, value) => {
    const grey = converted(value, bits) * 255 / (2 ** bits - 1);
    return Math.round(1e6 * (grey <= LINEAR_UP_TO ? grey * Math.log(LINEAR_UP_TO) / LINEAR_UP_TO : Math.log(grey)));
  });
}

export class PixelCamera {
  /** For pixels of `bits` bits, of which 8 are shown. */
  constructor(bits) {
    this.levels = levels(bits);
    this.remembered = null;
  }

  /** Takes the next frame, 8-bit grey, and says how many events it brings. */
  step(grey) {
    const { levels } = this;
    if (!this.remembered) {
      this.remembered = Int32Array.from(grey, value => levels[value]);
      return 0;
    }
    const { remembered } = this;
    let events = 0;
    for (let place = 0; place < grey.length; place++) {
      const moved = levels[grey[place]] - remembered[place];
      if (moved < CONTRAST && moved > -CONTRAST) continue;
      const steps = Math.trunc(moved / CONTRAST);
      remembered[place] += steps * CONTRAST;
      events += Math.abs(steps);
    }
    return events;
  }
}
