/**
 * How old the map on the screen is. The bridge says once a second how old the newest layers were; since then this
 * page's clock runs. A slow connection delivers late: that shows as stamps that fall behind the arrivals by more than
 * they did at best. A recording that is played slower than it was made falls behind evenly for as long as it plays,
 * which no connection does, and is not counted.
 */
const WINDOW_S = 20;
const SLOWEST_LIVE = 0.9;    // seconds of stamps a second, over the whole window
const OTHER_CLOCK_S = 5;     // stamps that jump this far are of another recording

export const STALE_S = 0.5;
export const SILENT_S = 1;

export class MapAge {
  constructor() {
    this.reset();
  }

  reset() {
    this.arrivals = [];  // {at_s, stamp_s}
    this.base_s = 0;
    this.status_seen = false;
  }

  /** @param {number} stamp_s of the data, on its own clock @param {number} now_s on this page's */
  on_map(stamp_s, now_s) {
    const before = this.arrivals.at(-1);
    if (before && (stamp_s < before.stamp_s || stamp_s - before.stamp_s > OTHER_CLOCK_S + now_s - before.at_s))
      this.arrivals = [];
    this.arrivals.push({ at_s: now_s, stamp_s });
    while (this.arrivals[0].at_s < now_s - WINDOW_S) this.arrivals.shift();
  }

  /** @param {number} age_s of the newest layers, as the bridge saw them: their age here when they came is what is kept */
  on_status(age_s, now_s) {
    const newest = this.arrivals.at(-1);
    this.status_seen = true;
    this.base_s = Math.max(0, newest ? age_s - (now_s - newest.at_s) : age_s);
  }

  /** Seconds that the newest map came later than the quickest of the window did. */
  late_s() {
    const oldest = this.arrivals[0];
    const newest = this.arrivals.at(-1);
    if (!newest || newest === oldest) return 0;
    const span_s = newest.at_s - oldest.at_s;
    if (span_s > WINDOW_S / 2 && newest.stamp_s - oldest.stamp_s < SLOWEST_LIVE * span_s) return 0;
    const behind_s = this.arrivals.map(({ at_s, stamp_s }) => at_s - stamp_s);
    return behind_s.at(-1) - Math.min(...behind_s);
  }

  /** Infinity if no map has come. */
  age_s(now_s) {
    const newest = this.arrivals.at(-1);
    return newest ? this.base_s + this.late_s() + (now_s - newest.at_s) : Infinity;
  }

  silent_s(now_s) {
    const newest = this.arrivals.at(-1);
    return newest ? now_s - newest.at_s : Infinity;
  }

  /** Maps a second over the last three seconds. */
  rate_hz(now_s) {
    return this.arrivals.filter(({ at_s }) => at_s > now_s - 3).length / 3;
  }
}
