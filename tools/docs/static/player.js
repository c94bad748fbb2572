// The motion of the front page, from above: the poses that `hamel run` computed when the site was built (window.hamelMotion).
document.addEventListener('DOMContentLoaded', () => {
  const place = document.getElementById('played'), motion = window.hamelMotion;
  if (!place || !motion) return;
  const canvas = place.querySelector('canvas'), pen = canvas.getContext('2d');
  const still = matchMedia('(prefers-reduced-motion: reduce)').matches;
  const length = motion.times[motion.times.length - 1];
  const points = motion.bodies.flatMap((body) => body.poses);
  const reach = (i, pick) => pick(...points.map((pose) => pose[i]));
  const middle = [0, 1].map((i) => (reach(i, Math.min) + reach(i, Math.max)) / 2);
  const size = [0, 1].map((i) => reach(i, Math.max) - reach(i, Math.min) + 0.8);
  const colours = { body: '#4a8fd8', accent: '#e0a100', dark: '#6b7785', light: '#9fb4cc' };

  // A vector of the body in space: the rotation by the quaternion (w, x, y, z).
  function turned([, , , w, x, y, z], [a, b, c]) {
    const tx = 2 * (y * c - z * b), ty = 2 * (z * a - x * c), tz = 2 * (x * b - y * a);
    return [a + w * tx + y * tz - z * ty, b + w * ty + z * tx - x * tz, c + w * tz + x * ty - y * tx];
  }

  // The outline of a shape from above, in the body's frame; lines stay open.
  function outline(shape) {
    const at = shape.at ?? [0, 0, 0];
    const around = (a, b) => [[-a, -b], [a, -b], [a, b], [-a, b]].map(([x, y]) => [at[0] + x, at[1] + y, at[2]]);
    if (shape.shape === 'box') return around(shape.size[0] / 2, shape.size[1] / 2);
    if (shape.shape === 'cylinder') return around(shape.radius, shape.length / 2);  // a wheel: its axle across
    if (shape.shape === 'line') return shape.points.map((p) => p.map((v, i) => v + at[i]));
    return around(shape.radius ?? 0.1, shape.radius ?? 0.1);
  }

  function draw(time) {
    const wide = Math.round(canvas.clientWidth * devicePixelRatio), high = Math.round(canvas.clientHeight * devicePixelRatio);
    if (canvas.width !== wide || canvas.height !== high) { canvas.width = wide; canvas.height = high; }
    pen.clearRect(0, 0, wide, high);
    const scale = Math.min(wide / size[0], high / size[1]);
    const pixel = ([x, y]) => [wide / 2 + (x - middle[0]) * scale, high / 2 - (y - middle[1]) * scale];
    const now = Math.max(0, motion.times.findLastIndex((t) => t <= time));
    for (const body of motion.bodies) {
      pen.strokeStyle = '#8aa0b8';
      pen.lineWidth = devicePixelRatio;
      pen.globalAlpha = 0.5;
      pen.beginPath();
      body.poses.slice(0, now + 1).forEach((pose, i) => pen[i ? 'lineTo' : 'moveTo'](...pixel(pose)));
      if (body.trail) pen.stroke();
      pen.globalAlpha = 1;
      const pose = body.poses[now];
      for (const shape of body.shapes) {
        const corners = outline(shape).map((p) => turned(pose, p)).map((p) => pixel([pose[0] + p[0], pose[1] + p[1]]));
        pen.fillStyle = pen.strokeStyle = colours[shape.color ?? 'body'] ?? shape.color;
        pen.lineWidth = 2 * devicePixelRatio;
        pen.beginPath();
        corners.forEach((corner, i) => pen[i ? 'lineTo' : 'moveTo'](...corner));
        if (shape.shape === 'line') pen.stroke(); else pen.fill();
      }
    }
  }

  const began = performance.now();
  function frame(now) {
    draw(((now - began) / 1000 * 1.5) % (length + 1));
    requestAnimationFrame(frame);
  }
  if (still) { draw(0.7 * length); addEventListener('resize', () => draw(0.7 * length)); } else requestAnimationFrame(frame);
});
