// One clip on its stage: shown pixel for pixel, hidden until its first frame, counted play by play.
//
// CSS width = native width / devicePixelRatio, placed on the device's pixel grid, so that no browser
// resamples the stimulus. The curtain, in the surround's grey, covers the video except while a frame
// of a running play is on the screen.

import { PlayRecord } from "./certificate.js";
import { enterFullscreen, screenFacts, watchScreen } from "./screen.js";

const STUCK_MS = 10000; // without progress for so long a play is given up

const nextFrame = () =>
  new Promise((resolve) => {
    requestAnimationFrame(resolve);
    setTimeout(resolve, 200); // no frames come to a page that nobody sees
  });

export class Player {
  /**
   * @param {HTMLElement} stage
   * @param {{width: number, height: number, frames: number,
   *          onStart: () => void, onFirstFrame: (shown_ms: number) => void,
   *          onPlay: (play: object) => void,
   *          onBroken: (code: string) => void, onTooSmall: () => void}} options
   */
  constructor(stage, options) {
    this.stage = stage;
    this.options = options;
    this.video = stage.querySelector("video");
    this.isWatched = false;
    this.unwatchScreen = watchScreen(() => this.layOut());
    this.stop = new AbortController();
    const on = (target, name, act) => target.addEventListener(name, act, { signal: this.stop.signal });
    on(document, "visibilitychange", () => document.hidden && this.interrupt("hidden"));
    on(window, "pagehide", () => this.interrupt("left"));
    // The way to stop is covered while a clip plays: the key that leaves things leaves it, too.
    on(document, "keydown", ({ key }) => key === "Escape" && this.interrupt("stopped"));
    on(document, "fullscreenchange", () => document.fullscreenElement || this.interrupt("stopped"));
    on(this.video, "ended", () => this.end());
    // Keys of the keyboard and power savers may pause a video; there is no control to go on with.
    on(this.video, "pause", () => this.video.ended || this.interrupt("paused"));
    // Somebody puts another file in the place of the clip: nothing on this page does during a play.
    on(this.video, "emptied", () => this.interrupt("replaced"));
    for (const button of stage.querySelectorAll("[data-play]")) {
      button.addEventListener("click", () => this.play());
    }
    this.show();
  }

  /** Leave the stage for good. */
  close() {
    this.interrupt("left");
    this.unwatchScreen();
    this.stop.abort();
    delete document.documentElement.dataset.view;
    this.video.removeAttribute("src");
    this.video.load();
  }

  set state(name) {
    this.stage.dataset.state = name;
  }

  get state() {
    return this.stage.dataset.state;
  }

  /**
   * Take a clip's address; the Play button appears once its first frame can be decoded.
   * @param {object} facts  what every record of a play of this clip says of it
   */
  async open(url, facts) {
    this.state = "loading";
    this.facts = facts;
    this.decoded = 0;
    await new Promise((resolve, reject) => {
      this.video.addEventListener("loadeddata", resolve, { once: true });
      this.video.addEventListener("error", () => reject(this.video.error), { once: true });
      this.video.src = url;
      this.video.load();
    });
    this.address = this.video.currentSrc;
    const { videoWidth, videoHeight } = this.video;
    if (videoWidth !== this.options.width || videoHeight !== this.options.height) {
      throw new Error(`SIZE-${videoWidth}x${videoHeight}`);
    }
    this.video.addEventListener("error", () => this.options.onBroken("DECODE"), { once: true });
    this.state = this.isWatched ? "watched" : "ready";
  }

  /** Size and place the video on whole device pixels, in the middle of the stage. */
  layOut() {
    const ratio = devicePixelRatio;
    const { width, height } = this.options;
    const stage = this.stage.getBoundingClientRect();
    // Browsers lay out in 1/64 pixel and round down: without the small addition 640 device pixels
    // at a ratio of 1.5 become 639.98, and the whole clip is resampled.
    const px = (device) => `${(device + 0.005) / ratio}px`;
    const toGrid = (origin, offset) => Math.round((origin + offset) * ratio) - origin * ratio;
    const style = this.video.style;
    style.width = px(width);
    style.height = px(height);
    style.left = px(toGrid(stage.left, (stage.width - width / ratio) / 2));
    style.top = px(toGrid(stage.top + scrollY, (stage.height - height / ratio) / 2));
  }

  /** True where the whole clip is inside the window at its own size. */
  get fits() {
    const facts = screenFacts();
    return (
      facts.viewport_width_px >= this.options.width && facts.viewport_height_px >= this.options.height
    );
  }

  /** Let the stage fill the window. */
  show() {
    document.documentElement.dataset.view = "clip";
    scrollTo(0, 0);
    this.layOut();
  }

  async play() {
    if (this.record || this.state === "starting") return; // a double click plays once
    this.show();
    if (!this.fits) await this.takeTheScreen();
    if (!this.fits) {
      this.options.onTooSmall();
      return;
    }
    this.layOut();
    this.state = "starting";
    this.options.onStart();
    try {
      await this.rewind();
      this.begin();
      await this.video.play();
    } catch (error) {
      if (this.record) this.options.onBroken(`PLAY-${error.name}`);
    }
  }

  async rewind() {
    if (this.video.currentTime === 0) return;
    const isThere = new Promise((resolve) =>
      this.video.addEventListener("seeked", resolve, { once: true }),
    );
    this.video.currentTime = 0;
    await isThere;
  }

  /** Ask for full screen and wait until the window has its new size. */
  async takeTheScreen() {
    await enterFullscreen();
    for (let frame = 0; frame < 60 && document.fullscreenElement && !this.fits; frame += 1) {
      await new Promise(requestAnimationFrame);
    }
  }

  /** Start the record of one play. */
  begin() {
    this.record = new PlayRecord(this.video, {
      frames: this.options.frames,
      decoded: this.decoded,
      onFirstFrame: (shown_ms) => {
        this.state = "playing";
        this.options.onFirstFrame(shown_ms);
      },
    });
    let place = -1;
    this.watchdog = setInterval(() => {
      if (this.video.currentTime === place) this.interrupt("stuck");
      place = this.video.currentTime;
    }, STUCK_MS);
  }

  /** A play that ran to its end: its last frame's callback may come after the event. */
  async end() {
    const { record } = this;
    if (!record) return;
    await nextFrame();
    await nextFrame();
    if (this.record === record) this.finish("end", "watched");
  }

  /** A play that cannot count: the page was covered or left, or the clip stood still. */
  interrupt(reason) {
    if (!this.record) return;
    this.finish(reason, "interrupted");
    this.video.pause();
  }

  finish(endedBy, state) {
    clearInterval(this.watchdog);
    const play = { ...this.record.finish(endedBy), ...this.facts };
    if (this.video.currentSrc !== this.address) play.clip_sha256 = ""; // not the file that was checked
    this.record = null;
    this.decoded = this.video.getVideoPlaybackQuality?.().totalVideoFrames ?? 0;
    this.state = state;
    this.options.onPlay(play);
  }
}
