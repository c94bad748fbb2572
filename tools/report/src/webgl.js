// What the figures drawn by three.js share. One renderer serves all of a page (browsers allow few WebGL contexts). A
// picture is read back and put on a 2-D canvas, which prints well; read back without waiting for it, since a canvas
// drawn on another one makes software WebGL warn of stalls on the console.

import { Matrix4, OrthographicCamera, WebGLRenderer } from 'three';
import { LineMaterial } from 'three/examples/jsm/lines/LineMaterial.js';
import { LineSegments2 } from 'three/examples/jsm/lines/LineSegments2.js';
import { LineSegmentsGeometry } from 'three/examples/jsm/lines/LineSegmentsGeometry.js';

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

/** Resolves when the page has its first picture: WebGL may take seconds to come up, and nothing waits for it. */
export async function afterFirstPicture() {
  if (document.readyState !== 'complete') await new Promise((resolve) => { addEventListener('load', resolve); });
  await new Promise((resolve) => { setTimeout(resolve); });
}

/** A curve as segments; null points are gaps, and none where there is nothing to draw. */
export function segments(points) {
  const positions = [];
  for (let i = 1; i < points.length; ++i) {
    if (points[i - 1] && points[i]) positions.push(...points[i - 1], ...points[i]);
  }
  return positions.length ? new LineSegmentsGeometry().setPositions(positions) : null;
}

/** Lines of a width in CSS pixels, which `render` turns into device pixels. */
export function lines(geometry, color, width, more = {}) {
  const object = new LineSegments2(geometry, Object.assign(new LineMaterial({ color, linewidth: width }), more));
  object.userData.width = width;
  object.frustumCulled = false;
  return object;
}

/** A camera without perspective that stands as {right, up, out} say; `reach`: how far it sees either way. */
export class Eye extends OrthographicCamera {
  constructor(reach) {
    super(-1, 1, 1, -1, -reach, reach);
    this.matrixAutoUpdate = false;
  }

  /** unit: pixels per length. */
  stand({ right, up, out }, target, unit, width, height) {
    const [halfWidth, halfHeight] = [width / 2 / unit, height / 2 / unit];
    Object.assign(this, { left: -halfWidth, right: halfWidth, top: halfHeight, bottom: -halfHeight });
    this.updateProjectionMatrix();
    const [x, y, z] = target;
    this.matrix.copy(new Matrix4(right[0], up[0], out[0], x, right[1], up[1], out[1], y, right[2], up[2], out[2], z,
      0, 0, 0, 1));
  }
}

/** -> the picture, as a promise of ImageData. */
export function render(scene, eye, width, height, scale) {
  scene.traverse(({ material, userData }) => {
    if (!userData.width) return;
    material.linewidth = userData.width * scale;
    material.resolution.set(width, height);
  });
  renderer.setSize(width, height, false);
  renderer.render(scene, eye);
  return readBack(width, height);
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
