/**
 * How old the map on the screen is. The bridge says once a second how old the newest layers were; since then this
 * page's clock runs. A slow connection delivers late: that shows as stamps that fall behind the arrivals by more than
 * they did at best, or by much more than those of poses, which are small and quick. A recording that is played slower than it was made falls behind evenly for as long as it plays,
 * which no connection does, and is not counted.
 */
const WINDOW_S = 20;
const SLOWEST_LIVE = 0.9;    // seconds of stamps a second
const MAKING_S = 0.3;        // a map may be that much later than a pose of its stamp: it had to be made first
const OTHER_CLOCK_S = 5;     // stamps that jump this far are of another recording

export const STALE_S = 0.5;
export const SILENT_S = 1;

const behind_s = ({ at_s, stamp_s }) => at_s - stamp_s;

function within_window(arrivals, stamp_s, now_s) {
  return [...arrivals.filter(({ at_s }) => at_s >= now_s - WINDOW_S), { at_s: now_s, stamp_s }];
}

/** Whether stamps fall behind in the older half of a long window and in the newer one: what a link holds up shows in one. */
function plays_slowly(arrivals) {
  const [oldest, middle, newest] = [arrivals[0], arrivals[arrivals.length >> 1], arrivals.at(-1)];
  const is_slow = (from, to) => to.stamp_s - from.stamp_s < SLOWEST_LIVE * (to.at_s - from.at_s);
  return newest.at_s - oldest.at_s > WINDOW_S / 2 && is_slow(oldest, middle) && is_slow(middle, newest);
}

export class MapAge {
  constructor() {
    this.reset();
  }

  reset() {
    this.arrivals = [];  // {at_s, stamp_s}
    this.poses = [];     // likewise
    this.base_s = 0;
  }

  /** @param {number} stamp_s of the data, on its own clock @param {number} now_s on this page's */
  on_map(stamp_s, now_s) {
    const before = this.arrivals.at(-1);
    if (before && (stamp_s < before.stamp_s || stamp_s - before.stamp_s > OTHER_CLOCK_S + now_s - before.at_s))
      this.arrivals = this.poses = [];
    this.arrivals = within_window(this.arrivals, stamp_s, now_s);
  }

  /** @param {number} stamp_s of a pose, on the maps' clock */
  on_pose(stamp_s, now_s) {
    if (stamp_s < this.poses.at(-1)?.stamp_s) this.poses = [];
    this.poses = within_window(this.poses, stamp_s, now_s);
  }

  /** @param {number} age_s of the newest layers, as the bridge saw them: their age here when they came is what is kept */
  on_status(age_s, now_s) {
    const newest = this.arrivals.at(-1);
    this.base_s = Math.max(0, newest ? age_s - (now_s - newest.at_s) : age_s);
  }

  /** Seconds that the newest map came later than the quickest of the window did. */
  late_s() {
    const newest = this.arrivals.at(-1);
    if (!newest || plays_slowly(this.arrivals)) return 0;
    return behind_s(newest) - Math.min(...this.arrivals.map(behind_s), ...this.poses.map((pose) => behind_s(pose) + MAKING_S));
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
