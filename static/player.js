// One clip on its stage: shown pixel for pixel, hidden until its first frame, counted play by play.
//
// CSS width = native width / devicePixelRatio, placed on the device's pixel grid, so that no browser
// resamples the stimulus. The curtain, in the surround's grey, covers the video except while a frame
// of a running play is on the screen.

import { enterFullscreen, screenFacts, watchScreen } from "./screen.js";

export class Player {
  /**
   * @param {HTMLElement} stage
   * @param {{width: number, height: number, frames: number,
   *          onFirstFrame: () => void, onPlay: (play: object) => void,
   *          onBroken: (code: string) => void, onTooSmall: () => void}} options
   */
  constructor(stage, options) {
    this.stage = stage;
    this.options = options;
    this.video = stage.querySelector("video");
    this.isWatched = false;
    this.unwatchScreen = watchScreen(() => this.layOut());
    this.hiding = () => document.hidden && this.interrupt();
    document.addEventListener("visibilitychange", this.hiding);
    this.video.addEventListener("ended", () => this.end());
    for (const button of stage.querySelectorAll("[data-play]")) {
      button.addEventListener("click", () => this.play());
    }
    this.show();
  }

  /** Leave the stage for good. */
  close() {
    this.unwatchScreen();
    document.removeEventListener("visibilitychange", this.hiding);
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

  /** Take a clip's address; the Play button appears once its first frame can be decoded. */
  async open(url, source) {
    this.state = "loading";
    this.source = source;
    await new Promise((resolve, reject) => {
      this.video.addEventListener("loadeddata", resolve, { once: true });
      this.video.addEventListener("error", () => reject(this.video.error), { once: true });
      this.video.src = url;
      this.video.load();
    });
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
    this.show();
    if (!this.fits) await this.takeTheScreen();
    if (!this.fits) {
      this.options.onTooSmall();
      return;
    }
    this.layOut();
    this.state = "starting";
    this.begin();
    try {
      this.video.currentTime = 0;
      await this.video.play();
    } catch (error) {
      if (this.current) this.options.onBroken(`PLAY-${error.name}`);
    }
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
    this.current = {
      started_at: new Date().toISOString(),
      quality: this.video.getVideoPlaybackQuality?.(),
      first: null,
      last: null,
      shownAt: null,
    };
    if (this.video.requestVideoFrameCallback) this.countFrames(this.current);
    else this.video.addEventListener("timeupdate", () => this.raiseCurtain(), { once: true });
  }

  /** presentedFrames counts frames handed to the screen, also those whose callback was missed. */
  countFrames(play) {
    this.video.requestVideoFrameCallback((now, { presentedFrames }) => {
      if (this.current !== play) return;
      play.first ??= presentedFrames;
      play.last = presentedFrames;
      if (play.shownAt === null) this.raiseCurtain();
      this.countFrames(play);
    });
  }

  raiseCurtain() {
    if (!this.current || this.current.shownAt !== null) return;
    this.current.shownAt = performance.now();
    this.state = "playing";
    this.options.onFirstFrame();
  }

  /** A play that ran to its end. */
  end() {
    if (!this.current) return;
    const play = this.finish(true);
    this.state = "watched";
    this.options.onPlay(play);
  }

  /** A play that cannot count: the page was covered while the clip ran. */
  interrupt() {
    if (!this.current) return;
    this.video.pause();
    const play = this.finish(false);
    this.state = "interrupted";
    this.options.onPlay(play);
  }

  finish(isComplete) {
    const play = this.current;
    this.current = null;
    const before = play.quality;
    const after = this.video.getVideoPlaybackQuality?.();
    const shown = this.video.getBoundingClientRect().width * devicePixelRatio;
    return {
      is_complete: isComplete,
      was_hidden: document.hidden,
      source: this.source,
      started_at: play.started_at,
      duration_ms: play.shownAt === null ? null : Math.round(performance.now() - play.shownAt),
      expected_frames: this.options.frames,
      presented_frames: play.first === null ? null : play.last - play.first + 1,
      dropped_frames: after ? after.droppedVideoFrames - before.droppedVideoFrames : null,
      shown_scale: Math.round((shown / this.options.width) * 1e4) / 1e4,
      ...screenFacts(),
    };
  }
}
