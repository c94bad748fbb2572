// The stage on which bodies and spheres stand: three.js with its own OrbitControls. What stands there is drawn as SVG at
// once, and by WebGL as soon as that is there; without WebGL it stays SVG.

import { OrthographicCamera, Vector3, WebGLRenderer } from 'three';
import { OrbitControls } from 'three/examples/jsm/controls/OrbitControls.js';
import { SVGRenderer } from 'three/examples/jsm/renderers/SVGRenderer.js';
import { h } from '../dom.js';
import { remark } from '../figure.js';
import { onPaper, onPaperFor } from '../print.js';
import { SHARPER } from '../save.js';
import { FONT, followWidth, widthOf } from '../width.js';
import { spreadNames } from './labels.js';

export const HOME = [0.76, -0.52, 0.42];  // from where the eye looks, at first
export const ABOVE = [0, -1e-5, 1];       // x to the right, y up
const AIR = 0.92;      // of the picture is filled
const LOWEST = 0.03;   // radians over a floor
const TURN = 0.12;     // radians by an arrow key
const SCREEN = Math.max(2, devicePixelRatio);  // pixels per CSS pixel: print is sharp too
const MOST_SOLID = 8;  // browsers allow some 16 WebGL contexts on a page
const ROW = 18;        // pixels of a name below a saved picture
// (In the elements, not in the style sheet: they go with a saved picture.)
const AXES = 'stroke: var(--soft); stroke-width: 1.4; font: 12px/1 system-ui, sans-serif';
const WORDS = 'fill: var(--ink); stroke: var(--paper); stroke-width: 3px; paint-order: stroke; text-anchor: middle; dominant-baseline: middle';

let solid = 0;  // stages drawn by WebGL
let spare = null;

/** Makes WebGL ready for the next stage, which then has no first picture as SVG; scene(): what compiles the shaders that it needs. */
export function warm(scene) {
  spare ??= makeWebgl();
  if (!spare) return;
  spare.setSize(1, 1);
  spare.render(scene(), new OrthographicCamera(-1, 1, 1, -1, 0, 1));
}

function makeWebgl() {
  if (spare) {
    const made = spare;
    spare = null;
    return made;
  }
  const canvas = document.createElement('canvas');
  const options = { antialias: true, alpha: true, preserveDrawingBuffer: true };
  const context = solid < MOST_SOLID ? canvas.getContext('webgl2', options) : null;
  if (!context) return null;
  ++solid;
  const renderer = new WebGLRenderer({ canvas, context, ...options });
  renderer.setPixelRatio(SCREEN);
  return renderer;
}

/** Resolves when the page has its first picture: WebGL may take seconds to come up, and nothing waits for it. */
async function afterFirstPicture() {
  if (document.readyState !== 'complete') await new Promise((resolve) => { addEventListener('load', resolve); });
  await new Promise((resolve) => { setTimeout(resolve); });
}

/** The lines and words of the overlay, as its style has them. */
function paintOverlay(pen, overlay) {
  const number = (element, name) => Number(element.getAttribute(name));
  for (const element of overlay.children) {
    const style = getComputedStyle(element);
    Object.assign(pen, { strokeStyle: style.stroke, fillStyle: style.fill, lineWidth: Number.parseFloat(style.strokeWidth), lineJoin: 'round', font: `12px ${FONT}`,
      textAlign: style.textAnchor === 'middle' ? 'center' : 'left', textBaseline: 'middle' });
    if (element.tagName === 'line') {
      pen.beginPath();
      pen.moveTo(number(element, 'x1'), number(element, 'y1'));
      pen.lineTo(number(element, 'x2'), number(element, 'y2'));
      pen.stroke();
    } else {
      pen.strokeText(element.textContent, number(element, 'x'), number(element, 'y'));
      pen.fillText(element.textContent, number(element, 'x'), number(element, 'y'));
    }
  }
}

export class Stage {
  /**
   * holder: the element to fill; height(width) in pixels; box: [low, high], what is to be seen; from: where the eye stands;
   * floor: no view from below; build(solid) -> {scene, update(), labels: [{text, at}]} of what stands there.
   */
  constructor(holder, { height, box, from, floor, build }) {
    Object.assign(this, { holder, height, from, build, follows: null, reach: 0, drawings: 0, endings: [] });
    this.camera = new OrthographicCamera(-1, 1, 1, -1, 0, 1);
    this.#measure(box);
    this.camera.up.set(0, 0, 1);
    this.renderer = new SVGRenderer();
    this.renderer.setPrecision(1);
    this.overlay = h('svg', { class: 'overlay', style: AXES, 'aria-hidden': 'true' });
    holder.append(this.renderer.domElement, this.overlay);
    this.controls = new OrbitControls(this.camera, holder);
    Object.assign(this.controls, { enableDamping: false, maxPolarAngle: floor ? Math.PI / 2 - LOWEST : Math.PI });
    holder.style.touchAction = 'pan-y';  // a finger scrolls the page
    this.#keys();
  }

  /** The first picture, as SVG, behind what `first` sets; then by WebGL. Where that is ready (`warm`), by WebGL at once. */
  async draw(first = () => {}) {
    const ready = spare !== null && this.#takeWebgl();
    this.unpainted(() => {
      this.rebuild();
      this.goTo(this.from);
      first();
    });
    this.paint();
    this.controls.addEventListener('change', () => { if (!this.painting) this.paint(); });
    const isDark = matchMedia('(prefers-color-scheme: dark)');
    const repaint = () => this.rebuild();
    isDark.addEventListener('change', repaint);
    this.endings.push(followWidth(this.holder, () => this.paint()), () => isDark.removeEventListener('change', repaint),
      onPaper(() => isDark.matches && this.rebuild(), () => isDark.matches && this.rebuild()));  // in the colours of paper
    if (ready) return;
    await afterFirstPicture();
    if (this.disposed) return;
    if (!this.#useWebgl()) this.holder.closest('figure').append(remark('Drawn without WebGL, which this browser does not offer here.'));
  }

  /** Changes that are painted together, later. */
  unpainted(change) {
    this.held = true;
    change();
    this.held = false;
  }

  #takeWebgl() {
    const renderer = makeWebgl();
    if (!renderer) return false;
    this.renderer.domElement.replaceWith(renderer.domElement);
    this.renderer = renderer;
    return true;
  }

  #useWebgl() {
    const taken = this.#takeWebgl();
    if (taken) this.rebuild();
    return taken;
  }

  /** What draws the picture as it stands on a canvas of its own, at once, `sharper` pixels per CSS pixel -> () => canvas. */
  film(sharper, transparent) {
    this.rebuild();
    this.goTo(this.from);
    if (!this.#useWebgl()) throw new Error('this browser offers no WebGL');
    this.renderer.setPixelRatio(sharper);
    const canvas = document.createElement('canvas');
    const pen = canvas.getContext('2d');
    return () => {
      this.paint();
      const { domElement } = this.renderer;
      [canvas.width, canvas.height] = [this.holder.clientWidth, this.height(this.holder.clientWidth)].map((size) => Math.round(size * sharper));
      pen.fillStyle = getComputedStyle(document.documentElement).getPropertyValue('--paper');
      if (!transparent) pen.fillRect(0, 0, canvas.width, canvas.height);
      pen.drawImage(domElement, 0, 0, canvas.width, canvas.height);
      pen.scale(sharper, sharper);
      paintOverlay(pen, this.overlay);
      return canvas;
    };
  }

  /** Ends what it holds beside its elements: a browser has few WebGL contexts. */
  dispose() {
    if (this.disposed) return;
    this.disposed = true;
    this.endings.forEach((end) => end());
    this.controls.dispose();
    if (!this.renderer.isWebGLRenderer) return;
    this.renderer.dispose();
    this.renderer.forceContextLoss();
    --solid;
  }

  /** Another box is to be seen, from where the eye is; what stands there is built again. */
  see(box) {
    this.#measure(box);
    this.#stand(this.camera.position.clone().sub(this.controls.target));
    this.rebuild();
  }

  #measure(box) {
    this.size = new Vector3(...box[1]).sub(new Vector3(...box[0]));
    this.centre = new Vector3(...box[0]).addScaledVector(this.size, 0.5);
    this.depth = 4 * this.size.length();
    this.camera.far = 2 * this.depth;
  }

  rebuild() {
    this.shown = this.build(this.renderer.isWebGLRenderer === true);
    this.paint();
  }

  /** Looks along `from`, all in sight. */
  goTo(from) {
    this.camera.zoom = 1;
    this.#stand(new Vector3(...from));
    this.controls.update();
    this.paint();
  }

  /** Stands far off the middle, all in sight. */
  #stand(from) {
    this.controls.target.copy(this.follows?.() ?? this.centre);
    this.camera.position.copy(this.controls.target).addScaledVector(from.normalize(), this.depth);
    this.camera.lookAt(this.controls.target);
    this.camera.updateMatrixWorld();
    const half = (axis) => {
      const along = new Vector3().setFromMatrixColumn(this.camera.matrixWorld, axis);
      return (Math.abs(along.x) * this.size.x + Math.abs(along.y) * this.size.y + Math.abs(along.z) * this.size.z) / 2;
    };
    this.fit = [half(0), half(1)];
  }

  /** The eye goes with a point that moves, `reach` around it in sight; null: it stays. */
  follow(point, reach) {
    Object.assign(this, { follows: point, reach });
    this.goTo(this.camera.position.clone().sub(this.controls.target).toArray());
  }

  paint() {
    const { camera, controls, holder, renderer } = this;
    const width = holder.clientWidth;
    if (this.held || !width || !this.shown || !this.fit) return;
    const height = this.height(width);
    const at = this.follows?.();
    if (at) {
      camera.position.add(at).sub(controls.target);
      controls.target.copy(at);
    }
    const unit = at ? Math.min(width, height) / 2 / this.reach : AIR * Math.min(width / 2 / this.fit[0], height / 2 / this.fit[1]);
    Object.assign(camera, { left: -width / 2 / unit, right: width / 2 / unit, top: height / 2 / unit, bottom: -height / 2 / unit });
    camera.updateProjectionMatrix();
    camera.updateMatrixWorld();
    holder.style.height = `${height}px`;
    renderer.setSize(width, height);
    this.shown.update(camera, width, height);
    renderer.render(this.shown.scene, camera);
    this.#label(width, height);
    holder.dataset.drawings = ++this.drawings;
  }

  /**
   * The picture as it stands -> SVG on paper, of lines and faces, or (solid) as WebGL draws it where that is there. Below it the
   * names: [{name, colour}, …].
   */
  picture(solid, names = []) {
    const { renderer, holder: { clientWidth: width } } = this;
    const height = this.height(width);
    const write = (element) => new XMLSerializer().serializeToString(element);
    let drawn = '';
    onPaperFor(() => {
      if (!solid && renderer.isWebGLRenderer) this.renderer = new SVGRenderer();
      if (this.renderer.isWebGLRenderer) renderer.setPixelRatio(SHARPER);
      this.rebuild();
      const { domElement } = this.renderer;
      drawn = (this.renderer.isWebGLRenderer ? `<image width="${width}" height="${height}" href="${domElement.toDataURL()}"/>` : write(domElement)) + write(this.overlay);
      if (this.renderer.isWebGLRenderer) renderer.setPixelRatio(SCREEN);
      this.renderer = renderer;
    });
    this.rebuild();
    const below = names.map(({ name, colour }, i) => write(h('text', { x: 14, y: height + (i + 0.5) * ROW, style: `fill: ${colour}; font: 12px/1 system-ui, sans-serif` }, name)));
    const tall = height + names.length * ROW;
    return `<svg xmlns="http://www.w3.org/2000/svg" width="${width}" height="${tall}" viewBox="0 0 ${width} ${tall}">${drawn}${below.join('')}</svg>`;
  }

  /** The space axes in a corner, and the names of what is to be seen. */
  #label(width, height) {
    Object.entries({ width, height, viewBox: `0 0 ${width} ${height}` }).forEach(([name, value]) => this.overlay.setAttribute(name, value));
    const text = (words, x, y) => h('text', { x, y, style: WORDS }, words);
    const [x, y] = [34, height - 34];
    const axes = ['x', 'y', 'z'].flatMap((name, k) => {
      const axis = new Vector3().setComponent(k, 1).transformDirection(this.camera.matrixWorldInverse);
      if (Math.hypot(axis.x, axis.y) < 0.15) return [];  // it points at the eye
      return [h('line', { x1: x, y1: y, x2: x + 19 * axis.x, y2: y - 19 * axis.y }), text(name, x + 27 * axis.x, y - 27 * axis.y)];
    });
    const names = this.shown.labels.map(({ text: words, at, up = 0 }) => {
      const place = new Vector3(...at()).project(this.camera);
      return { words, across: (1 + place.x) * width / 2, down: (1 - place.y) * height / 2 - up, half: widthOf(words) / 2 };
    });
    const labels = spreadNames(names).flatMap((down, i) => (down === null ? [] : [text(names[i].words, names[i].across, down)]));
    this.overlay.replaceChildren(...axes, ...labels, this.shown.scale ? h('text', { x: 70, y: height - 12, style: `${WORDS}; text-anchor: start` }, this.shown.scale) : '');
  }

  #keys() {
    const { holder, controls, camera } = this;
    holder.addEventListener('wheel', (event) => {  // a plain wheel scrolls the page
      controls.enableZoom = event.ctrlKey || event.metaKey || document.activeElement === holder;
    }, { capture: true, passive: true });
    holder.addEventListener('dblclick', () => this.goTo(this.from));
    const keys = { ArrowLeft: () => controls.rotateLeft(TURN), ArrowRight: () => controls.rotateLeft(-TURN), ArrowUp: () => controls.rotateUp(-TURN),
      ArrowDown: () => controls.rotateUp(TURN), '+': () => { camera.zoom *= 1.2; }, '-': () => { camera.zoom /= 1.2; }, 0: () => this.goTo(this.from) };
    holder.addEventListener('keydown', (event) => {
      if (!Object.hasOwn(keys, event.key) || event.ctrlKey || event.metaKey || event.altKey) return;
      event.preventDefault();
      keys[event.key]();
      this.paint();
    });
  }
}
