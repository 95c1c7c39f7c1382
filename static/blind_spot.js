// The blind spot: a dot moves to the left of a mark until the left eye loses it, several times.
//
// It moves so many degrees per second at the distance found so far, whatever the frame rate; mark and
// dot stand so that the middle of both is before the head, and the mark goes further to the right
// where the dot came to the screen's end: that reaches beyond 80 cm on a laptop.

import { text } from "./texts.js";

const SPEED_DEG_PER_S = 3;
const STEP_DEG = 0.15; // by key
const NEAREST_DEG = [7, 9.5]; // the dot starts here, at random, so that nobody presses by rhythm
const DOT_DEG = 0.7;
const FIRST_GUESS_MM = 600;
const MARGIN_PX = 24;
const MISSES = 2;
const LONGEST_TAP_MS = 250; // a press this soon after the start is a slip

export class BlindSpot {
  /**
   * @param {HTMLElement} stage
   * @param {{moved: string, repetitions: number, angle_deg: number, eye_mm: number,
   *          mm_per_px: number, onEnd: (found: object | null) => void}} options  CSS pixels
   */
  constructor(stage, options) {
    this.stage = stage;
    this.options = options;
    this.places_px = []; // device pixels from the middle of the field: [mark, dot]
    this.distances = [];
    this.misses = 0;
    this.reach = 0;
    this.stop = new AbortController();
    const on = (part, name, action) =>
      part.addEventListener(name, action, { signal: this.stop.signal });
    this.find = (what) => stage.querySelector(what);
    on(document, "keydown", (event) => this.key(event));
    on(document, "keyup", (event) => event.key === " " && event.preventDefault());
    on(this.find("[data-gone]"), "click", (event) => this.gone(event.timeStamp));
    on(this.find("[data-next]"), "click", () => this.begin());
    on(this.find("[data-spot-end]"), "click", () => this.end(null));
    for (const button of stage.querySelectorAll("[data-move]")) {
      on(button, "click", () => this.move(Number(button.dataset.move)));
    }
    stage.hidden = false;
    document.documentElement.dataset.view = "spot";
    for (const words of stage.querySelectorAll("[data-spot-words]")) {
      words.hidden = words.dataset.spotWords !== options.moved;
    }
    this.say("");
    this.begin();
  }

  close() {
    this.stop.abort();
    this.isMoving = false;
    this.stage.hidden = true;
    delete document.documentElement.dataset.view;
  }

  end(found) {
    this.close();
    this.options.onEnd(found);
  }

  say(words) {
    this.find("[data-spot-news]").textContent = words;
  }

  /** The distance as far as it is known: the median of what was found. */
  get distance_mm() {
    const sorted = [...this.distances].sort((a, b) => a - b);
    const half = sorted.length >> 1;
    if (!sorted.length) return FIRST_GUESS_MM;
    return sorted.length % 2 ? sorted[half] : (sorted[half - 1] + sorted[half]) / 2;
  }

  /** CSS pixels that so many degrees take, before the eye. */
  pixels(degrees) {
    return (this.distance_mm * Math.tan((degrees * Math.PI) / 180)) / this.options.mm_per_px;
  }

  begin() {
    const half = this.find("[data-spot-field]").clientWidth / 2;
    const furthest = half - MARGIN_PX;
    const apart = this.pixels(this.options.angle_deg);
    this.mark = Math.min(furthest, apart / 2 + this.reach);
    const [least, most] = NEAREST_DEG;
    this.from = this.mark - this.pixels(least + (most - least) * Math.random());
    this.last = -furthest;
    this.dot = this.from;
    const size = `${Math.max(10, this.pixels(DOT_DEG))}px`;
    this.find("[data-dot]").style.width = size;
    this.find("[data-dot]").style.height = size;
    this.place(this.find("[data-fixation]"), this.mark);
    this.draw();
    this.setMoving(true);
    this.began = performance.now();
    if (this.options.moved === "by_itself") requestAnimationFrame((now) => this.frame(now));
  }

  setMoving(isMoving) {
    this.isMoving = isMoving;
    const isByKey = this.options.moved === "by_key";
    this.find("[data-gone]").hidden = !isMoving;
    this.find("[data-next]").hidden = isMoving;
    for (const button of this.stage.querySelectorAll("[data-move]")) {
      button.hidden = !(isMoving && isByKey);
    }
    this.find("[data-dot]").hidden = !isMoving;
    this.find(isMoving ? "[data-gone]" : "[data-next]").focus({ preventScroll: true });
  }

  place(part, x) {
    part.style.transform = `translate(${x}px, 0) translate(-50%, -50%)`;
  }

  draw() {
    this.place(this.find("[data-dot]"), this.dot);
  }

  /** Where the dot is at a moment of the page's clock. */
  dotAt(now) {
    return this.from - (Math.max(0, now - this.began) / 1000) * this.pixels(SPEED_DEG_PER_S);
  }

  frame(now) {
    if (!this.isMoving) return;
    this.dot = this.dotAt(now);
    this.draw();
    if (this.dot <= this.last) return this.missed();
    requestAnimationFrame((later) => this.frame(later));
  }

  move(way) {
    if (!this.isMoving) return;
    this.dot = Math.min(this.from, this.dot + way * this.pixels(STEP_DEG));
    this.draw();
    if (this.dot <= this.last) this.missed();
  }

  key(event) {
    const isByKey = this.options.moved === "by_key";
    if (event.key === " ") {
      event.preventDefault(); // nor does the button that has the focus hear it
      if (event.repeat) return;
      if (this.isMoving) this.gone(event.timeStamp);
      else this.begin();
    } else if (isByKey && event.key === "ArrowLeft") this.move(-1);
    else if (isByKey && event.key === "ArrowRight") this.move(1);
    else if (event.key === "Escape" && !document.fullscreenElement) this.end(null);
  }

  /** The dot has vanished: note both places, and how far away that makes the eye. */
  gone(moment) {
    if (!this.isMoving) return;
    if (this.options.moved === "by_itself") {
      if (moment - this.began < LONGEST_TAP_MS) return;
      this.dot = Math.max(this.last, this.dotAt(moment));
    }
    this.misses = 0;
    this.places_px.push([this.mark * devicePixelRatio, this.dot * devicePixelRatio]);
    this.distances.push(this.distanceOf(this.mark, this.dot));
    this.setMoving(false);
    const left = this.options.repetitions - this.places_px.length;
    if (left > 0) return this.say(text("calibration.spot_got", { left }));
    this.end({ places_px: this.places_px, distance_mm: this.distance_mm });
  }

  /** The server's formula (study/design/viewing.py): the eye is before the middle, a little left. */
  distanceOf(mark, dot) {
    const { angle_deg, eye_mm, mm_per_px } = this.options;
    const tangent = Math.tan((angle_deg * Math.PI) / 180);
    const apart = (mark - dot) * mm_per_px;
    const product = (mark * mm_per_px + eye_mm) * (dot * mm_per_px + eye_mm);
    return (apart + Math.sqrt(Math.max(0, apart ** 2 - 4 * tangent ** 2 * product))) / (2 * tangent);
  }

  missed() {
    this.setMoving(false);
    this.misses += 1;
    const half = this.find("[data-spot-field]").clientWidth / 2;
    this.reach += half / 4;
    const words = this.misses < MISSES ? "spot_missed" : "spot_far";
    this.say(text(`calibration.${words}`));
  }
}
