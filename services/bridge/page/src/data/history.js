/** The last minute, thinned so that it fits into a given memory. */

const SPAN_S = 60;
const FINEST_STEP_S = 0.1;

export class History {
  /** @param {number} budget_bytes that all entries together may take */
  constructor(budget_bytes, span_s = SPAN_S) {
    this.budget_bytes = budget_bytes;
    this.span_s = span_s;
    this.step_s = FINEST_STEP_S;
    this.clear();
  }

  clear() {
    this.entries = [];
    this.bytes = 0;
  }

  /** Whether an entry of that time and size is to be kept: at most as many a second as fit for the whole span. */
  wants(time_s, bytes) {
    const most_entries = Math.floor(this.budget_bytes / bytes) - 1;
    if (most_entries < 1) return false;
    this.step_s = Math.max(FINEST_STEP_S, Math.ceil((10 * this.span_s) / most_entries) / 10);
    const newest = this.entries.at(-1);
    return !newest || time_s - newest.time_s > this.step_s - FINEST_STEP_S / 2;
  }

  /** @param {number} time_s not before the newest entry's @param {object} value whatever is to be shown again */
  push(time_s, value, bytes) {
    this.entries.push({ time_s, value, bytes });
    this.bytes += bytes;
    while (this.entries[0].time_s < time_s - this.span_s || this.bytes > this.budget_bytes)
      this.bytes -= this.entries.shift().bytes;
  }

  /** The newest entry that is not after `time_s`, else the oldest; undefined if there is none. */
  at(time_s) {
    return this.entries.findLast((entry) => entry.time_s <= time_s) ?? this.entries[0];
  }

  /** How many entries a second are kept at most. */
  get rate_hz() {
    return 1 / this.step_s;
  }
}
