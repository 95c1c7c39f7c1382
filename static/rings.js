// Landolt rings (ISO 8596): a ring five gaps wide, whose stroke is as wide as its gap.

// Gaps in the screen's own pixels, in steps of about a tenth of a logarithm.
const GAPS_PX = [40, 32, 25, 20, 16, 13, 10, 8, 6, 5, 4, 3, 2, 1];
const FIRST_PX = 20;
export const LARGEST_PX = 5.5 * GAPS_PX[0]; // the largest ring, with a little white around it
const MOST_RINGS = 60;

/** Finds the smallest gap that is told reliably: quickly down, then several rings at each size. */
export class Staircase {
  constructor({ directions, least_px, needed }) {
    this.gaps = GAPS_PX.filter((gap) => gap >= least_px);
    this.turns = Array.from({ length: directions }, (_, i) => (8 / directions) * i);
    this.needed = needed;
    this.at = this.gaps.indexOf(FIRST_PX);
    this.isQuick = true;
    this.counts = this.gaps.map(() => ({ right: 0, wrong: 0, isSettled: false }));
    this.shown = 0;
    this.last = null;
  }

  /** The next ring, or null when there is nothing more to find out. */
  next() {
    if (!this.counts[this.at] || this.counts[this.at].isSettled) return null;
    if (this.shown >= MOST_RINGS) return null;
    const others = this.turns.filter((turn) => turn !== this.last);
    this.last = others[Math.floor(Math.random() * others.length)];
    this.shown += 1;
    return { gap_px: this.gaps[this.at], direction: this.last };
  }

  answer(isRight) {
    const count = this.counts[this.at];
    count[isRight ? "right" : "wrong"] += 1;
    if (this.isQuick) this.descend(isRight);
    else if (count.right >= this.needed) this.settle(count, +1);
    else if (count.wrong > 1) this.settle(count, -1);
  }

  /** One ring for each size, down to the first mistake or the smallest; then one larger again. */
  descend(isRight) {
    this.isQuick = isRight && this.at < this.gaps.length - 1;
    if (this.isQuick) this.at += 1;
    else if (!isRight) this.at -= 1;
  }

  settle(count, way) {
    count.isSettled = true;
    this.at += way;
  }
}

/** Draw a ring on whole pixels of the screen, in the middle of its place. */
export function drawRing(canvas, { gap_px, direction }) {
  const side = 5 * gap_px;
  canvas.width = side;
  canvas.height = side;
  canvas.style.width = `${side / devicePixelRatio}px`;
  canvas.style.height = `${side / devicePixelRatio}px`;
  const context = canvas.getContext("2d");
  context.fillStyle = "#fff";
  context.fillRect(0, 0, side, side);
  context.translate(side / 2, side / 2);
  context.beginPath();
  context.arc(0, 0, 2.5 * gap_px, 0, 2 * Math.PI);
  context.arc(0, 0, 1.5 * gap_px, 0, 2 * Math.PI, true);
  context.fillStyle = "#000";
  context.fill();
  context.rotate((direction * Math.PI) / 4);
  context.fillStyle = "#fff";
  context.fillRect(0, -gap_px / 2, 3 * gap_px, gap_px);
}
