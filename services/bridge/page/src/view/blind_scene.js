/** In place of Scene where a browser has no WebGL 2: nothing is drawn, all else of the page goes on. */
export class BlindScene {
  constructor() {
    this.is_blind = true;
    this.view = null;
    this.ground = { range: null };
    this.voxels = { mesh: { visible: false }, left_out: 0 };
    this.camera = { set_mode() {} };
  }

  set_colours() {}
  set_layer() {}
  set_shown() {}
  show(view) { this.view = view; }
  resize() {}
  draw() {}
}
