/** The last minute: a strip that shows how it was, and a handle to look back. */
import { find } from './dom.js';

const GAP_S = 0.6;  // between kept maps, beyond their usual step: there was none to keep

export class Scrubber {
  /** @param {import('../data/history.js').History} history @param {(time_s: number | null) => void} on_look null: live */
  constructor(history, on_look) {
    this.history = history;
    this.on_look = on_look;
    this.time_s = null;
    this.slider = find('slider');
    this.slider.min = String(-history.span_s);
    this.slider.addEventListener('input', () => this.look(Number(this.slider.value)));
    find('live').addEventListener('click', () => this.look(0));
  }

  look(back_s) {
    this.time_s = back_s > -0.15 || this.history.entries.length === 0 ? null : this.now_s + back_s;
    this.on_look(this.time_s);
  }

  /** @param {number} now_s on the page's clock */
  update(now_s) {
    this.now_s = now_s;
    const back_s = this.time_s === null ? 0 : Math.max(-this.history.span_s, this.time_s - now_s);
    this.slider.value = String(back_s);
    this.slider.setAttribute('aria-valuetext', back_s === 0 ? 'live' : `${(-back_s).toFixed(0)} seconds back`);
    find('live').textContent = this.time_s === null ? 'Live' : 'Back to live';
    find('live').setAttribute('aria-pressed', String(this.time_s === null));
    find('kept').textContent = `${this.history.span_s} s · ${this.history.rate_hz.toFixed(1)} maps/s kept`;
    this.draw(now_s);
  }

  draw(now_s) {
    const strip = find('strip');
    const width = (strip.width = strip.clientWidth * devicePixelRatio);
    const height = (strip.height = strip.clientHeight * devicePixelRatio);
    const context = strip.getContext('2d');
    const style = getComputedStyle(document.body);
    const { entries, span_s, step_s } = this.history;
    const x_of = (time_s) => width * (1 - (now_s - time_s) / span_s);
    const paint = (name, from_s, to_s) => {
      context.fillStyle = style.getPropertyValue(name);
      context.fillRect(x_of(from_s), 0, Math.max(1, x_of(to_s) - x_of(from_s)), height);
    };
    entries.forEach(({ time_s, value }, i) => {
      const next_s = entries[i + 1]?.time_s ?? now_s;
      const kept_s = Math.min(next_s, time_s + step_s + GAP_S);
      paint(value.missing.length ? '--strip-missing' : '--strip', time_s, kept_s);
      if (next_s > kept_s) paint('--strip-gap', kept_s, next_s);
    });
  }
}
