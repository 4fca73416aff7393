/** Draws no faster than the GPU can: a slow one, or none, must not keep messages waiting. Coarser pixels if it takes long. */

const RESTS = 0.7;  // of the time that a draw took
const FRAME_MS = 40;
const LONG_MS = 110;
const LONG_DRAWS = 4;
const COARSER = 0.8;
const COARSEST_PIXELS = 0.6;

/** Whether no GPU draws but the processor: without smooth edges then, which cost it most. */
export function draws_in_software() {
  const gl = document.createElement('canvas').getContext('webgl2');
  const names = gl?.getExtension('WEBGL_debug_renderer_info');
  return !gl || (names !== null && /swiftshader|llvmpipe|software/i.test(gl.getParameter(names.UNMASKED_RENDERER_WEBGL)));
}

export class Pace {
  /** @param {WebGL2RenderingContext} gl @param {number} pixels of the canvas for each of CSS */
  constructor(gl, pixels) {
    this.gl = gl;
    this.pixels = pixels;
    this.long_draws = 0;
    this.fence = null;
    this.rested_ms = 0;
  }

  /** Whether the last draw is done. @param {number} now_ms */
  is_ready(now_ms) {
    if (!this.fence) return now_ms >= this.rested_ms;
    if (this.gl.getSyncParameter(this.fence, this.gl.SYNC_STATUS) !== this.gl.SIGNALED) return false;
    this.gl.deleteSync(this.fence);
    this.fence = null;
    const took_ms = now_ms - this.began_ms;
    this.long_draws = took_ms > LONG_MS ? this.long_draws + 1 : 0;
    this.rested_ms = took_ms > FRAME_MS ? now_ms + RESTS * took_ms : now_ms;
    return now_ms >= this.rested_ms;
  }

  /** A draw was just handed to the GPU. */
  began(now_ms) {
    this.began_ms = now_ms;
    this.fence = this.gl.fenceSync(this.gl.SYNC_GPU_COMMANDS_COMPLETE, 0);
    this.gl.flush();
  }

  /** Fewer pixels if the last draws all took long. @returns {boolean} whether `pixels` has changed */
  adapt() {
    if (this.long_draws < LONG_DRAWS || this.pixels <= COARSEST_PIXELS) return false;
    this.pixels = Math.max(COARSEST_PIXELS, COARSER * this.pixels);
    this.long_draws = 0;
    return true;
  }
}
