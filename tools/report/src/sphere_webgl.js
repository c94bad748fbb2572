// The sphere by three.js.

import { AmbientLight, DirectionalLight, GreaterDepth, Mesh, MeshLambertMaterial, Scene, SphereGeometry } from 'three';
import { graticule, RADIUS } from './camera.js';
import { Eye, lines, render, segments } from './webgl.js';

const BEHIND = { transparent: true, opacity: 0.25, depthFunc: GreaterDepth, depthWrite: false };

function ordered(object, renderOrder) {
  return Object.assign(object, { renderOrder });
}

export function makeScene(curves) {
  const scene = new Scene();
  const eye = new Eye(4);
  const light = new DirectionalLight(0xffffff, 1.3);
  light.position.set(-0.5, 0.7, 1);
  eye.add(light, light.target);
  scene.add(eye, new AmbientLight(0xffffff, 2.1));
  scene.add(new Mesh(new SphereGeometry(0.994, 128, 96), new MeshLambertMaterial({ color: 0xf0f3f7 })));
  scene.add(...graticule().map((points) => ordered(lines(segments(points), 0xc3cad2, 0.8), 0.5)));
  const drawn = curves.map(({ points, style }) => {
    const geometry = segments(points);
    if (!geometry) return [];
    return [ordered(lines(geometry, style.colour, 1.4, BEHIND), 1), ordered(lines(geometry, style.colour, 2), 2)];
  });
  scene.add(...drawn.flat());

  /** -> the picture, as a promise of ImageData. */
  const draw = (camera, width, height, scale) => {
    eye.stand(camera.frame(), [0, 0, 0], RADIUS * Math.min(width, height), width, height);
    drawn.forEach((pair, i) => pair.forEach((line) => { line.visible = curves[i].show; }));
    return render(scene, eye, width, height, scale);
  };
  return { draw };
}
