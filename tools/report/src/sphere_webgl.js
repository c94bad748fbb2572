// The sphere by three.js. One renderer serves all spheres of a page (browsers allow few WebGL contexts). A picture
// is read back and put on a 2-D canvas, which prints well; read back without waiting for it, since a canvas drawn
// on another one makes software WebGL warn of stalls on the console.

import { AmbientLight, DirectionalLight, GreaterDepth, Matrix4, Mesh, MeshLambertMaterial, OrthographicCamera,
  Scene, SphereGeometry, WebGLRenderer } from 'three';
import { LineMaterial } from 'three/examples/jsm/lines/LineMaterial.js';
import { LineSegments2 } from 'three/examples/jsm/lines/LineSegments2.js';
import { LineSegmentsGeometry } from 'three/examples/jsm/lines/LineSegmentsGeometry.js';
import { graticule, RADIUS } from './camera.js';

let renderer;  // undefined: not tried yet; null: no WebGL here

export function webglWorks() {
  if (renderer !== undefined) return renderer !== null;
  renderer = null;
  const options = { antialias: true, alpha: false, depth: true };
  try {
    const canvas = document.createElement('canvas');
    const context = canvas.getContext('webgl2', options);
    if (context) renderer = new WebGLRenderer({ canvas, context, ...options });
  } catch {
    renderer = null;
  }
  renderer?.setClearColor(0xffffff, 1);
  return renderer !== null;
}

function segments(points) {
  const positions = [];
  for (let i = 1; i < points.length; ++i) {
    if (points[i - 1] && points[i]) positions.push(...points[i - 1], ...points[i]);
  }
  return positions.length ? new LineSegmentsGeometry().setPositions(positions) : null;
}

function lines(geometry, color, linewidth, behind) {
  const material = new LineMaterial({ color, linewidth });
  if (behind) Object.assign(material, { transparent: true, opacity: 0.25, depthFunc: GreaterDepth, depthWrite: false });
  const object = new LineSegments2(geometry, material);
  object.renderOrder = behind ? 1 : 2;
  object.frustumCulled = false;
  return object;
}

export function makeScene(curves) {
  const scene = new Scene();
  const eye = new OrthographicCamera(-1, 1, 1, -1, -4, 4);
  eye.matrixAutoUpdate = false;
  const light = new DirectionalLight(0xffffff, 1.3);
  light.position.set(-0.5, 0.7, 1);
  eye.add(light, light.target);
  scene.add(eye, new AmbientLight(0xffffff, 2.1));
  scene.add(new Mesh(new SphereGeometry(0.994, 128, 96), new MeshLambertMaterial({ color: 0xf0f3f7 })));
  const grid = graticule().map((points) => lines(segments(points), 0xc3cad2, 0.8, false));
  grid.forEach((line) => { line.renderOrder = 0.5; });
  scene.add(...grid);
  const drawn = curves.map(({ points, style }) => {
    const geometry = segments(points);
    if (!geometry) return [];
    return [lines(geometry, style.colour, 1.4, true), lines(geometry, style.colour, 2, false)];
  });
  scene.add(...drawn.flat());

  /** -> the picture, as a promise of ImageData. */
  const draw = (camera, width, height, scale) => {
    const { right, up, out } = camera.frame();
    const unit = 2 * RADIUS * Math.min(width, height);
    Object.assign(eye, { left: -width / unit, right: width / unit, top: height / unit, bottom: -height / unit });
    eye.updateProjectionMatrix();
    eye.matrix.copy(new Matrix4(right[0], up[0], out[0], 0, right[1], up[1], out[1], 0,
      right[2], up[2], out[2], 0, 0, 0, 0, 1));
    drawn.forEach((pair, i) => pair.forEach((line) => { line.visible = curves[i].show; }));
    for (const line of [...grid, ...drawn.flat()]) {
      line.userData.width ??= line.material.linewidth;
      line.material.linewidth = line.userData.width * scale;
      line.material.resolution.set(width, height);
    }
    renderer.setSize(width, height, false);
    renderer.render(scene, eye);
    return readBack(width, height);
  };
  return { draw };
}

async function readBack(width, height) {
  const gl = renderer.getContext();
  const buffer = gl.createBuffer();
  gl.bindBuffer(gl.PIXEL_PACK_BUFFER, buffer);
  gl.bufferData(gl.PIXEL_PACK_BUFFER, width * height * 4, gl.STREAM_READ);
  gl.readPixels(0, 0, width, height, gl.RGBA, gl.UNSIGNED_BYTE, 0);
  gl.bindBuffer(gl.PIXEL_PACK_BUFFER, null);
  const fence = gl.fenceSync(gl.SYNC_GPU_COMMANDS_COMPLETE, 0);
  gl.flush();
  while (gl.clientWaitSync(fence, 0, 0) === gl.TIMEOUT_EXPIRED) {
    await new Promise((resolve) => { setTimeout(resolve, 2); });
  }
  gl.deleteSync(fence);
  const upsideDown = new Uint8Array(width * height * 4);
  gl.bindBuffer(gl.PIXEL_PACK_BUFFER, buffer);
  gl.getBufferSubData(gl.PIXEL_PACK_BUFFER, 0, upsideDown);
  gl.bindBuffer(gl.PIXEL_PACK_BUFFER, null);
  gl.deleteBuffer(buffer);
  const image = new ImageData(width, height);
  const row = width * 4;
  for (let y = 0; y < height; ++y) {
    image.data.set(upsideDown.subarray((height - 1 - y) * row, (height - y) * row), y * row);
  }
  return image;
}
