// SPDX-License-Identifier: MIT OR Apache-2.0
// Functions that the tests run in the page. Bytes are passed as base64.
/* global engine */

const base64 = (bytes) => {
  let text = "";
  for (let at = 0; at < bytes.length; at += 0x8000) text += String.fromCharCode(...bytes.subarray(at, at + 0x8000));
  return btoa(text);
};
const bytes = (text) => Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));

/** Returns the frames of a scene. */
window.scene = (name, width, height, count, side) =>
  Array.from({ length: count }, (_, number) => base64(engine.scene(name, width, height, number, side)));

/** Shows grey or colour frames to a camera. Returns all results of each. */
window.run = ({ toml, width, height, frames, colours, explained }) => {
  const camera = engine.configure(toml, width, height);
  try {
    camera.record();
    const outcomes = frames.map((frame) => {
      const sent = colours ? camera.stepRgba(bytes(frame)) : camera.step(bytes(frame));
      const { screen, regions, input } = camera;
      void [screen, regions, input];
      return { sent, hash: camera.hash(), screen: base64(camera.screen), input: base64(camera.input), regions: base64(camera.regions) };
    });
    const explanations = (explained ?? []).map(([x, y, name]) => camera.explain(x, y, name));
    return { facts: camera.facts, outcomes, events: camera.events(), explanations };
  } finally {
    camera.free();
  }
};

/** Returns the message of the error that a call throws. */
window.refused = (call) => {
  try {
    call();
  } catch (error) {
    return error.message;
  }
  return null;
};

/** Returns the pixels of image files, four bytes each, as a page gets them. */
window.decoded = async (files) => {
  const pictures = [];
  for (const file of files) {
    const image = await createImageBitmap(new Blob([bytes(file)], { type: "image/png" }));
    const context = new OffscreenCanvas(image.width, image.height).getContext("2d", { willReadFrequently: true });
    context.drawImage(image, 0, 0);
    pictures.push(base64(context.getImageData(0, 0, image.width, image.height).data));
  }
  return pictures;
};

/** Returns pictures of the camera, four bytes per pixel. */
window.watched = async (count) => {
  const stream = await navigator.mediaDevices.getUserMedia({ video: true });
  const video = Object.assign(document.createElement("video"), { srcObject: stream, muted: true });
  await video.play();
  const { videoWidth: width, videoHeight: height } = video;
  const context = new OffscreenCanvas(width, height).getContext("2d", { willReadFrequently: true });
  const pictures = [];
  while (pictures.length < count) {
    await new Promise((resolve) => video.requestVideoFrameCallback(resolve));
    context.drawImage(video, 0, 0);
    pictures.push(base64(context.getImageData(0, 0, width, height).data));
  }
  stream.getTracks().forEach((track) => track.stop());
  return { width, height, pictures };
};
