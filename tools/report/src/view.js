// From where moving bodies are seen: two angles, a zoom, and what stands in the middle: all the room that the motion
// takes, or its first body.

import { ABOVE } from './camera.js';

const AIR = 0.92;     // of the picture is filled
const FAR = 40;       // so many times a body's reach is the room before it is followed at first
const AROUND = 3.2;   // so many times its reach is seen around a body that is followed
const ZOOMS = [0.2, 60];
const LOWEST = 0.03;  // radians over a floor

const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];

export class View {
  constructor({ box: [low, high], reach }, camera, floor) {
    Object.assign(this, { camera, floor, reach, low, high, centre: low.map((v, i) => (v + high[i]) / 2) });
    this.depth = 4 * Math.hypot(...high.map((v, i) => v - low[i]));
    this.goHome();
  }

  goHome() {
    this.turnTo(this.camera.home);
    this.follows = Math.max(...this.high.map((v, i) => v - this.low[i])) > FAR * this.reach;
  }

  turnTo(angles) {
    this.camera.goTo(angles);
    this.camera.turn(0, 0);
    this.fit = this.camera.frame();  // the room fills the picture as seen from here
    this.zoom = 1;
  }

  turn(right, up) {
    this.camera.turn(right, up);
    if (this.floor) this.camera.pitch = Math.max(LOWEST, this.camera.pitch);
  }

  zoomBy(factor) {
    this.zoom = Math.max(ZOOMS[0], Math.min(ZOOMS[1], this.zoom * factor));
  }

  /** {frame, target, unit, project} for a picture of width × height pixels; pose: of the first body. */
  seen(pose, width, height) {
    const frame = this.camera.frame();
    const half = (direction) => direction.reduce((sum, v, i) => sum + Math.abs(v) * (this.high[i] - this.low[i]) / 2, 0);
    const around = AROUND * this.reach;
    const whole = Math.min(width / 2 / half(this.fit.right), height / 2 / half(this.fit.up));
    const unit = (this.follows ? Math.min(width, height) / 2 / around : AIR * whole) * this.zoom;
    const target = this.follows && pose ? pose.at : this.centre;
    const [x, y] = [dot(frame.right, target), dot(frame.up, target)];
    const project = (p) => [width / 2 + unit * (dot(frame.right, p) - x), height / 2 - unit * (dot(frame.up, p) - y)];
    return { frame, target, unit, project };
  }

  /** Dragging and keys; `change` runs a change of the view and paints, `toggle` plays or pauses. */
  handle(canvas, change, toggle) {
    const perPixel = 0.009;
    canvas.addEventListener('pointerdown', (event) => canvas.setPointerCapture(event.pointerId));
    canvas.addEventListener('pointermove', (event) => {
      if (canvas.hasPointerCapture(event.pointerId)) change(() => this.turn(-event.movementX * perPixel, event.movementY * perPixel));
    });
    canvas.addEventListener('dblclick', () => change(() => this.goHome()));
    canvas.addEventListener('wheel', (event) => {
      if (!event.ctrlKey && !event.metaKey && document.activeElement !== canvas) return;  // a plain wheel scrolls the page
      event.preventDefault();
      change(() => this.zoomBy(Math.exp(-Math.max(-60, Math.min(60, event.deltaY)) * 0.004)));
    }, { passive: false });
    const keys = {
      ArrowLeft: () => this.turn(-0.12, 0), ArrowRight: () => this.turn(0.12, 0), ArrowUp: () => this.turn(0, 0.12),
      ArrowDown: () => this.turn(0, -0.12), '+': () => this.zoomBy(1.2), '-': () => this.zoomBy(1 / 1.2), 0: () => this.goHome(),
      t: () => this.turnTo(ABOVE),
    };
    canvas.addEventListener('keydown', (event) => {
      if (event.ctrlKey || event.metaKey || event.altKey) return;
      if (event.key === ' ') toggle();
      else if (Object.hasOwn(keys, event.key)) change(keys[event.key]);
      else return;
      event.preventDefault();
    });
  }
}
