// Intervals of time in which something held, such as "the page was hidden".

const MOST = 20; // more are summed up, not listed

export class Intervals {
  /** @param {boolean} holds  whether it holds from the start, at 0 ms */
  constructor(holds) {
    this.list = [];
    this.total_ms = 0;
    this.since = holds ? 0 : null;
  }

  /** Say whether it holds from now on; times are in ms from the start. */
  set(holds, now_ms) {
    if (holds === (this.since !== null)) return;
    if (holds) {
      this.since = now_ms;
      return;
    }
    this.total_ms += now_ms - this.since;
    if (this.list.length < MOST) this.list.push([Math.round(this.since), Math.round(now_ms)]);
    this.since = null;
  }

  /** End, and tell: `{name_ms, name_intervals}`. */
  facts(name, now_ms) {
    this.set(false, now_ms);
    return { [`${name}_ms`]: Math.ceil(this.total_ms), [`${name}_intervals`]: this.list };
  }
}
