// SPDX-License-Identifier: MIT OR Apache-2.0
// The sources of frames. Every source has the same interface:
//
//   await open()                     begins; an Error says why it cannot, in words for people
//   natural                          its own size, or null if it can have any size
//   await take(width, height, now)   the next frame { rgba or grey, time_us, fresh }, or null while there is none; `fresh` marks
//                                    the first frame of a clip that begins again
//   await step(width, height)        the next frame, also while the page is stopped
//   run(on), speed(factor)           of sources with a clock of their own
//   await restart(), close()
//   onend(text, isError)             set by the page; called when no more frames will come
//   loops                            undefined, or whether a clip of `foveate live` begins again after its end

/** Frames per second of sources without times, as in `foveate simulate`. */
const RATE = 30;
/** The largest size in bytes of a scene whose frames are kept; of a larger scene every frame is made anew. */
const MAX_KEPT_BYTES = 100e6;
/** Longest wait in ms for the time of a frame; a later time is most likely wrong. */
const LONGEST_WAIT = 10_000;

/** The base of all sources without a clock of their own. */
class TimedSource {
  natural = null;
  onend = () => {};
  #due = 0;
  #factor = 1;
  number = 0;
  slow = true;
  async open() {}
  close() {}
  run() {}
  speed(factor) { this.#factor = factor; }
  async restart() { this.number = 0; this.#due = 0; }
  async take(width, height, now) {
    if (now < this.#due - 4) return null;
    const wait = 1000 / (RATE * this.#factor);
    this.#due = Math.max(this.#due + wait, now - wait);
    return this.step(width, height);
  }
  timeOf(number) { return Math.round(number * 1e6 / RATE); }
}

/** A built-in scene, which begins again after its last frame. */
export class Scene extends TimedSource {
  #engine; #scene; #side; #keptFrames = new Map(); #size = "";
  /** `side` is the side of a region, for which some scenes are made. */
  constructor(engine, scene, side) {
    super();
    this.#engine = engine;
    this.#scene = scene;
    this.#side = side;
  }
  async step(width, height) {
    if (this.number >= this.#scene.frames) this.number = 0;
    const number = this.number++;
    return { grey: this.#frame(width, height, number), time_us: this.timeOf(number), fresh: number === 0 };
  }
  #frame(width, height, number) {
    const side = this.#side(), size = `${width}x${height}, ${side}`;
    if (size !== this.#size) {
      this.#size = size;
      this.#keptFrames.clear();
    }
    let grey = this.#keptFrames.get(number);
    if (!grey) {
      grey = this.#engine.scene(this.#scene.name, width, height, number, side);
      if (this.#scene.frames * grey.length <= MAX_KEPT_BYTES) this.#keptFrames.set(number, grey);
    }
    return grey;
  }
}

/** Draws pictures at the size of the frame, cropped to its shape, and returns their pixels. */
class FrameCanvas {
  #canvas = document.createElement("canvas");
  #context = this.#canvas.getContext("2d", { willReadFrequently: true });
  pixels(picture, from, width, height) {
    if (this.#canvas.width !== width || this.#canvas.height !== height) Object.assign(this.#canvas, { width, height });
    const scale = Math.max(width / from.width, height / from.height);
    const [w, h] = [width / scale, height / scale];
    this.#context.drawImage(picture, (from.width - w) / 2, (from.height - h) / 2, w, h, 0, 0, width, height);
    return this.#context.getImageData(0, 0, width, height).data;
  }
}

/** Pictures as a clip, in the order of their names, with numbers by value. A single picture stays. */
export class Pictures extends TimedSource {
  #files; #frameCanvas = new FrameCanvas(); #last = null;
  constructor(files) {
    super();
    const order = new Intl.Collator("en", { numeric: true });
    this.#files = [...files].sort((a, b) => order.compare(a.name, b.name));
  }
  async open() {
    const { width, height } = await this.#picture(0);
    this.natural = { width, height };
  }
  async step(width, height) {
    const own = this.number % this.#files.length, number = this.number++;
    const picture = await this.#picture(own);
    const rgba = this.#frameCanvas.pixels(picture, picture, width, height);
    return { rgba, time_us: this.timeOf(number), fresh: this.#files.length > 1 && own === 0 };
  }
  async #picture(number) {
    const file = this.#files[number];
    if (this.#last?.file === file) return this.#last.picture;
    this.close();
    try {
      // The samples of the file without conversion, as the project's own reader takes them.
      const picture = await createImageBitmap(file, { colorSpaceConversion: "none", premultiplyAlpha: "none", imageOrientation: "none" });
      this.#last = { file, picture };
      return picture;
    } catch {
      throw new Error(`${file.name} is not a picture that this browser can read; use PNG, JPEG, WebP or AVIF`);
    }
  }
  close() {
    this.#last?.picture.close();
    this.#last = null;
  }
}

/** The frames of a <video>, each once. */
class VideoSource {
  natural = null;
  onend = () => {};
  slow = true;
  #hasNewFrame = false; #frameCanvas = new FrameCanvas(); #closed = false;
  constructor() {
    this.video = Object.assign(document.createElement("video"), { muted: true, playsInline: true });
    this.video.disableRemotePlayback = true;
  }
  watch() {
    const { videoWidth: width, videoHeight: height } = this.video;
    this.natural = { width, height };
    const next = (_, { mediaTime }) => {
      this.mediaTime = mediaTime;
      this.#hasNewFrame = true;
      if (!this.#closed) this.video.requestVideoFrameCallback(next);
    };
    this.video.requestVideoFrameCallback(next);
  }
  async take(width, height) {
    if (!this.#hasNewFrame) return null;
    this.#hasNewFrame = false;
    return this.draw(width, height);
  }
  draw(width, height) {
    const from = { width: this.video.videoWidth, height: this.video.videoHeight };
    return { rgba: this.#frameCanvas.pixels(this.video, from, width, height), time_us: Math.round(1e6 * (this.mediaTime ?? this.video.currentTime)) };
  }
  close() {
    this.#closed = true;
    this.video.pause();
  }
}

/** A clip that repeats. */
export class Clip extends VideoSource {
  #file; #link; #rate = 1 / RATE; #last = null; #again = false;
  constructor(file) {
    super();
    this.#file = file;
  }
  async open() {
    const { video } = this;
    this.#link = video.src = URL.createObjectURL(this.#file);
    await new Promise((done, refuse) => {
      const refused = () => refuse(new Error(`this browser cannot decode ${this.#file.name}` +
        `${video.error?.message ? ` (${video.error.message})` : ""}; \`foveate live ${this.#file.name}\` decodes it and shows it on this page`));
      video.onloadeddata = () => video.videoWidth ? done() : refused();
      video.onerror = refused;
    });
    video.onerror = () => this.onend(`${this.#file.name} cannot be decoded further (${video.error?.message || "damaged"}); Reset begins again`);
    video.onended = () => { this.#begin().then(() => video.play()).catch(() => {}); };
    this.watch();
  }
  draw(width, height) {
    this.mediaTime ??= this.video.currentTime;
    const { mediaTime } = this, frame = super.draw(width, height);
    if (this.#last !== null && mediaTime > this.#last) this.#rate = Math.min(mediaTime - this.#last, 1);
    this.#last = mediaTime;
    const fresh = this.#again;
    this.#again = false;
    return { ...frame, fresh };
  }
  run(on) {
    if (on) this.video.play().catch(() => {}); else this.video.pause();
  }
  speed(factor) { this.video.playbackRate = factor; }
  async take(width, height) {
    // A frame that was taken by a step is not taken again.
    return this.mediaTime === this.#last ? null : super.take(width, height);
  }
  async step(width, height) {
    const { video } = this, to = video.currentTime + this.#rate;
    if (this.#last === null) return this.draw(width, height);
    if (to >= video.duration) await this.#begin(); else await this.#seek(to);
    return this.draw(width, height);
  }
  async restart() {
    await this.#begin();
  }
  async #begin() {
    this.#again = true;
    this.#last = null;
    await this.#seek(0);
  }
  #seek(to) {
    return new Promise(done => {
      this.video.onseeked = () => { this.mediaTime = this.video.currentTime; done(); };
      this.video.currentTime = to;
    });
  }
  close() {
    super.close();
    URL.revokeObjectURL(this.#link);
  }
}

/** Advice for each refusal of a browser. */
const REFUSALS = new Map(Object.entries({
  NotAllowedError: "the browser did not give the camera; allow it beside the page's address and choose it again",
  NotFoundError: "there is no camera here; plug one in, or choose a scene or a clip",
  NotReadableError: "the camera is in use by another program; close that and choose the camera again",
  OverconstrainedError: "the camera has no such size; choose another size",
}));

/** A webcam. */
export class Webcam extends VideoSource {
  slow = false;
  #stream;
  async open(size) {
    if (!navigator.mediaDevices) throw new Error("a browser gives its camera only to pages from this computer or by https; open the page as a file, or by `foveate live`");
    const video = { width: { ideal: size?.width ?? 640 }, height: { ideal: size?.height ?? 480 }, frameRate: { ideal: 60 } };
    try {
      this.#stream = await navigator.mediaDevices.getUserMedia({ video });
    } catch (error) {
      throw new Error(REFUSALS.get(error.name) ?? `the camera does not start (${error.name}: ${error.message})`);
    }
    for (const track of this.#stream.getVideoTracks())
      track.onended = () => this.onend("the camera has been disconnected; plug it in and choose it again");
    this.video.srcObject = this.#stream;
    await this.video.play();
    this.watch();
  }
  run() {}
  speed() {}
  async step(width, height) { return this.draw(width, height); }
  async restart() {}
  close() {
    super.close();
    for (const track of this.#stream?.getTracks() ?? []) {
      track.onended = null;
      track.stop();
    }
  }
}

/** The text of the server at the end of a clip without a fault. */
const NORMAL_END = "the clip has ended";

/** Frames that `foveate live` decodes on this computer; `path` is where it serves them. A clip has its own times; what a camera
 * sends is shown when it comes. */
export class Computer {
  natural = null;
  slow = true;
  onend = () => {};
  loops = false;
  #path; #after = -1; #ended = false; #waiting = null; #first = true; #run = 0;
  /** The server gives frames only to the page that has opened its input last. */
  #viewer = Math.random().toString(36).slice(2);
  #factor = 1; #shown = { now: 0, time_us: 0 };
  constructor(path) { this.#path = path; }
  async open() {
    while (!this.#waiting) {
      this.#waiting = await this.#next();
      if (this.#ended) return;
    }
    const { width, height } = this.#waiting.head;
    this.natural = { width, height };
  }
  run() {}
  speed(factor) { this.#factor = factor; }
  async take(width, height, now) {
    if (this.#ended) return null;
    this.#waiting ??= await this.#next();
    if (!this.#waiting) return null;
    const { live, t_us: time_us } = this.#waiting.head;
    const due = this.#shown.now + Math.min((time_us - this.#shown.time_us) / 1000 / this.#factor, LONGEST_WAIT);
    if (!live && !this.#first && now < due - 4) return null;
    // A late frame does not make the next one come earlier.
    this.#shown = { now: Math.max(due, now - 4), time_us };
    return this.#show(width, height);
  }
  async step(width, height) {
    if (this.#ended) return null;
    this.#waiting ??= await this.#next();
    return this.#waiting && this.#show(width, height);
  }
  #show(width, height) {
    const frame = this.#waiting, fresh = this.#first;
    this.#waiting = null;
    this.#first = false;
    const same = frame.head.width === width && frame.head.height === height;
    const pixels = same ? { grey: frame.grey } : { rgba: scaled(frame, width, height) };
    return { ...pixels, time_us: frame.head.t_us, fresh };
  }
  async restart() {
    const answer = await fetch("restart", { method: "POST" }).catch(() => null);
    if (answer && !answer.ok) return this.onend(await answer.text());
    this.#run++;
    this.#after = -1;
    this.#viewer = Math.random().toString(36).slice(2);
    this.#ended = false;
    this.#waiting = null;
    this.#first = true;
  }
  async #next() {
    let bytes;
    const run = this.#run;
    try {
      const answer = await fetch(`${this.#path}?after=${this.#after}&viewer=${this.#viewer}`);
      if (!answer.ok) throw new Error(await answer.text());
      bytes = await answer.arrayBuffer();
    } catch {
      return this.#end("foveate live does not answer; start it again and open its new link");
    }
    // This frame was under way when the clip began again.
    if (run !== this.#run) return null;
    const length = new DataView(bytes).getUint32(0, true);
    const head = JSON.parse(new TextDecoder().decode(new Uint8Array(bytes, 4, length)));
    const grey = new Uint8Array(bytes, 4 + length);
    if (head.status === "failed") return this.#end(head.text);
    if (head.status === "taken") return this.#end("another page shows this input now; Reset brings it back to this one");
    if (!grey.length && head.status === "ended") return this.#endOfClip(head);
    if (!grey.length) return null;
    this.#after = head.number;
    return { head, grey };
  }
  /** Begins again, or says that the clip has ended. A clip that is damaged says so in its text. */
  #endOfClip({ text, live }) {
    if (this.loops && !live && text === NORMAL_END) {
      this.restart();
      return null;
    }
    return this.#end(`${text || NORMAL_END}; Reset begins again`, Boolean(text) && text !== NORMAL_END);
  }
  #end(text, isError = true) {
    this.#ended = true;
    this.onend(text, isError);
    return null;
  }
  close() { this.#ended = true; }
}

const frameCanvas = new FrameCanvas();
/** Returns grey pixels at another size, as RGBA. */
function scaled({ head: { width: from, height: rows }, grey }, width, height) {
  const picture = new OffscreenCanvas(from, rows), data = new ImageData(from, rows);
  const words = new Uint32Array(data.data.buffer);
  for (let place = 0; place < words.length; place++) words[place] = 0xFF000000 | grey[place] * 0x010101;
  picture.getContext("2d").putImageData(data, 0, 0);
  return frameCanvas.pixels(picture, picture, width, height);
}
