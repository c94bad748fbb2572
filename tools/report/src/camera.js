// How the unit sphere and moving bodies are looked at: from far away (orthographic), z up, turned by two angles.

export const HOME = { yaw: -0.6, pitch: 0.42 };
export const ABOVE = { yaw: -Math.PI / 2, pitch: Math.PI / 2 };  // x to the right, y up
const STEEPEST = Math.PI / 2 - 0.001;
export const RADIUS = 0.39;  // of the sphere, as a part of the picture's shorter side

export class Camera {
  constructor(home = HOME) { this.goTo(home); this.home = home; }

  goTo({ yaw, pitch }) { Object.assign(this, { yaw, pitch }); }

  goHome() { this.goTo(this.home); }

  copy() { return Object.assign(new Camera(), this); }

  turn(right, up) {
    this.yaw += right;
    this.pitch = Math.max(-STEEPEST, Math.min(STEEPEST, this.pitch + up));
  }

  /** The eye's three directions in space: right, up, towards the eye. */
  frame() {
    const [cy, sy, cp, sp] = [Math.cos(this.yaw), Math.sin(this.yaw), Math.cos(this.pitch), Math.sin(this.pitch)];
    return { right: [-sy, cy, 0], up: [-cy * sp, -sy * sp, cp], out: [cy * cp, sy * cp, sp] };
  }

  /** A function from a point in space to [x, y, depth] in pixels of a width × height picture; depth > 0: in front. */
  projector(width, height) {
    const { right, up, out } = this.frame();
    const unit = RADIUS * Math.min(width, height);
    const dot = (a, p) => a[0] * p[0] + a[1] * p[1] + a[2] * p[2];
    return (p) => [width / 2 + unit * dot(right, p), height / 2 - unit * dot(up, p), dot(out, p)];
  }
}

/** Meridians and parallels every 30 degrees, as lists of points. */
export function graticule() {
  const lines = [];
  const circle = (at) => Array.from({ length: 73 }, (_, i) => at((i * Math.PI) / 36));
  for (let k = 0; k < 6; ++k) {
    const a = (k * Math.PI) / 6;
    lines.push(circle((t) => [Math.cos(t) * Math.cos(a), Math.cos(t) * Math.sin(a), Math.sin(t)]));
  }
  for (let k = -2; k <= 2; ++k) {
    const b = (k * Math.PI) / 6;
    lines.push(circle((t) => [Math.cos(b) * Math.cos(t), Math.cos(b) * Math.sin(t), Math.sin(b)]));
  }
  return lines;
}
