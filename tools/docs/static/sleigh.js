// A sleigh on one blade that can be dragged: the reduced equations of the Chaplygin sleigh, with and without its blade.
//
// State: x, y (blade), theta, v (along the blade), u (across it, 0 while the blade is down), omega. The mass centre is `offset`
// ahead of the blade; a spring pulls at the point that is dragged. Parameters are those of `hamel describe chaplygin_sleigh`.
(function () {
  const body = { mass: 1, inertia: 1, offset: 0.5 };

  // d/dt of the state under the force (fx, fy) at the point (px, py) of the body.
  function rates(state, blade, force) {
    const { theta, v, u, omega } = state;
    const { mass: m, inertia, offset: a } = body;
    const c = Math.cos(theta), s = Math.sin(theta);
    const along = force.x * c + force.y * s, across = -force.x * s + force.y * c;
    const torque = force.px * across - force.py * along;  // about the blade
    let dv, du, domega, reaction = 0;
    if (blade) {
      dv = a * omega * omega + along / m;
      domega = (torque - m * a * v * omega) / (inertia + m * a * a);
      du = 0;
      reaction = m * (v * omega + a * domega) - across;
    } else {
      domega = (torque - a * across) / inertia;  // about the mass centre
      dv = along / m + u * omega + a * omega * omega;
      du = across / m - v * omega - a * domega;
    }
    return { x: v * c - u * s, y: v * s + u * c, theta: omega, v: dv, u: du, omega: domega, reaction };
  }

  const names = ['x', 'y', 'theta', 'v', 'u', 'omega'];
  const moved = (state, rate, h) => Object.fromEntries(names.map((n) => [n, state[n] + h * rate[n]]));

  // One step of the classical Runge-Kutta method; force(state) is evaluated at each stage.
  function step(state, h, blade, force) {
    const k1 = rates(state, blade, force(state));
    const s2 = moved(state, k1, h / 2), k2 = rates(s2, blade, force(s2));
    const s3 = moved(state, k2, h / 2), k3 = rates(s3, blade, force(s3));
    const s4 = moved(state, k3, h), k4 = rates(s4, blade, force(s4));
    const mean = Object.fromEntries(names.map((n) => [n, (k1[n] + 2 * k2[n] + 2 * k3[n] + k4[n]) / 6]));
    return moved(state, mean, h);
  }

  function energy({ v, u, omega }) {
    const { mass: m, inertia, offset: a } = body;
    return 0.5 * m * (v * v + (u + a * omega) ** 2) + 0.5 * inertia * omega * omega;
  }

  const free = () => ({ x: 0, y: 0, px: 0, py: 0 });
  if (typeof module !== 'undefined') {
    module.exports = { step, energy, free };
    return;
  }

  document.addEventListener('DOMContentLoaded', () => {
    const place = document.getElementById('sleigh');
    if (!place) return;
    const canvas = place.querySelector('canvas'), pen = canvas.getContext('2d');
    const blade = place.querySelector('[name=blade]'), shown = place.querySelector('output');
    const begin = () => ({ x: 2, y: 1.2, theta: 0.2, v: -1.6, u: 0, omega: 0.3 });
    let state = begin(), trail = [], pull = null, last = 0, running = !matchMedia('(prefers-reduced-motion: reduce)').matches;

    // Pixels: the view is 8 m wide; the sleigh leaves on one side and comes back on the other.
    const scale = () => canvas.width / 8;
    const wrap = (value, size) => ((value + size / 2) % size + size) % size - size / 2;
    const height = () => canvas.height / scale();
    const toPixel = (x, y) => [canvas.width / 2 + x * scale(), canvas.height / 2 - y * scale()];
    const toMetres = (event) => {
      const box = canvas.getBoundingClientRect();
      return [(event.clientX - box.left) / box.width * 8 - 4, (0.5 - (event.clientY - box.top) / box.height) * height()];
    };
    const shape = [[1.05, 0], [0.75, 0.32], [-0.45, 0.32], [-0.45, -0.32], [0.75, -0.32]];

    function force(s) {
      if (!pull) return free();
      const c = Math.cos(s.theta), sn = Math.sin(s.theta);
      const x = s.x + pull.px * c - pull.py * sn, y = s.y + pull.px * sn + pull.py * c;
      const r = rates(s, blade.checked, free());
      const vx = r.x - s.omega * (y - s.y), vy = r.y + s.omega * (x - s.x);
      return { x: 12 * (pull.x - x) - 3 * vx, y: 12 * (pull.y - y) - 3 * vy, px: pull.px, py: pull.py };
    }

    function draw() {
      const style = getComputedStyle(document.body);
      const colour = (name) => style.getPropertyValue(name).trim();
      const wide = Math.round(canvas.clientWidth * devicePixelRatio), high = Math.round(canvas.clientHeight * devicePixelRatio);
      if (canvas.width !== wide || canvas.height !== high) { canvas.width = wide; canvas.height = high; }
      pen.clearRect(0, 0, wide, high);
      pen.lineWidth = 2 * devicePixelRatio;
      pen.strokeStyle = colour('--color-brand-primary');
      pen.globalAlpha = 0.6;
      pen.beginPath();
      trail.forEach(([x, y], i) => {
        const jumps = i > 0 && Math.hypot(x - trail[i - 1][0], y - trail[i - 1][1]) > 1;
        pen[i === 0 || jumps ? 'moveTo' : 'lineTo'](...toPixel(x, y));
      });
      pen.stroke();
      pen.globalAlpha = 1;
      const c = Math.cos(state.theta), s = Math.sin(state.theta);
      const at = (px, py) => toPixel(state.x + px * c - py * s, state.y + px * s + py * c);
      pen.fillStyle = '#4a8fd8';
      pen.strokeStyle = colour('--color-foreground-primary');
      pen.lineWidth = 1.5 * devicePixelRatio;
      pen.beginPath();
      shape.forEach(([x, y], i) => pen[i ? 'lineTo' : 'moveTo'](...at(x, y)));
      pen.closePath();
      pen.fill();
      pen.stroke();
      if (blade.checked) {
        pen.lineWidth = 5 * devicePixelRatio;
        pen.strokeStyle = '#e0a100';
        pen.beginPath();
        pen.moveTo(...at(-0.3, 0));
        pen.lineTo(...at(0.3, 0));
        pen.stroke();
      }
      pen.fillStyle = '#fff';
      pen.strokeStyle = '#1f2937';
      pen.lineWidth = 1.5 * devicePixelRatio;
      pen.beginPath();
      pen.arc(...at(body.offset, 0), 4 * devicePixelRatio, 0, 7);
      pen.fill();
      pen.stroke();
      if (pull) {
        pen.lineWidth = 1.5 * devicePixelRatio;
        pen.strokeStyle = colour('--color-foreground-primary');
        pen.setLineDash([6, 6]);
        pen.beginPath();
        pen.moveTo(...at(pull.px, pull.py));
        pen.lineTo(...toPixel(pull.x, pull.y));
        pen.stroke();
        pen.setLineDash([]);
      }
      const reaction = rates(state, blade.checked, force(state)).reaction;
      shown.textContent = `along ${state.v.toFixed(2)} m/s, across ${state.u.toFixed(2)} m/s, turning ${state.omega.toFixed(2)} rad/s, `
        + `energy ${energy(state).toFixed(3)} J, force of the blade ${reaction.toFixed(2)} N`;
    }

    function frame(now) {
      const passed = Math.min(0.05, (now - last) / 1000);
      last = now;
      if (running || pull) {
        const steps = 10;
        for (let i = 0; i < steps; i++) state = step(state, passed / steps, blade.checked, force);
        state.x = wrap(state.x, 8.4);
        state.y = wrap(state.y, height() + 0.4);
        trail.push([state.x, state.y]);
        if (trail.length > 900) trail.shift();
      }
      draw();
      requestAnimationFrame(frame);
    }

    canvas.addEventListener('pointerdown', (event) => {
      const [x, y] = toMetres(event), c = Math.cos(state.theta), s = Math.sin(state.theta);
      const dx = x - state.x, dy = y - state.y;
      if (Math.hypot(dx, dy) > 1.5) return;
      canvas.setPointerCapture(event.pointerId);
      pull = { x, y, px: Math.max(-0.45, Math.min(1.05, dx * c + dy * s)), py: Math.max(-0.32, Math.min(0.32, -dx * s + dy * c)) };
    });
    canvas.addEventListener('pointermove', (event) => { if (pull) [pull.x, pull.y] = toMetres(event); });
    for (const end of ['pointerup', 'pointercancel']) canvas.addEventListener(end, () => { pull = null; running = true; });
    canvas.addEventListener('keydown', (event) => {
      const pushes = { ArrowUp: ['v', 0.3], ArrowDown: ['v', -0.3], ArrowLeft: ['omega', 0.3], ArrowRight: ['omega', -0.3] };
      if (!pushes[event.key]) return;
      const [name, change] = pushes[event.key];
      state[name] += change;
      running = true;
      event.preventDefault();
    });
    blade.addEventListener('change', () => { if (blade.checked) state.u = 0; running = true; });
    place.querySelector('[name=again]').addEventListener('click', () => { state = begin(); trail = []; running = true; });
    requestAnimationFrame((now) => { last = now; frame(now); });
  });
}());
