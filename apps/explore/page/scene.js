"use strict";
// The 3-D view: bones, wrap surfaces and muscles in the ground's frame, y upwards.

const viridis = [[68, 1, 84], [71, 44, 122], [59, 81, 139], [44, 113, 142], [33, 144, 141],
                 [39, 173, 129], [92, 200, 99], [170, 220, 50], [253, 231, 37]];

/// @param x 0 … 1
function viridisAt(x) {
  const place = Math.min(Math.max(x, 0), 1) * (viridis.length - 1);
  const low = Math.min(Math.floor(place), viridis.length - 2);
  return viridis[low].map((c, i) => (c + (place - low) * (viridis[low + 1][i] - c)) / 255);
}

/// Reads numbers one after the other.
class Numbers {
  constructor(values) { this.values = values; this.at = 0; }
  next() { return this.values[this.at++]; }
  take(count) { this.at += count; return this.values.subarray(this.at - count, this.at); }
}

/// A placement (rotation row by row, then translation).
function matrixOf(X) {
  return new THREE.Matrix4().set(X[0], X[1], X[2], X[9], X[3], X[4], X[5], X[10],
                                 X[6], X[7], X[8], X[11], 0, 0, 0, 1);
}

const sides = 10;  // of a tube

/// A tube along a line whose points change.
class Tube {
  constructor(group) {
    this.mesh = new THREE.Mesh(new THREE.BufferGeometry(), new THREE.MeshLambertMaterial());
    this.mesh.frustumCulled = false;
    this.capacity = 0;
    group.add(this.mesh);
  }

  reserve(points) {
    if (points <= this.capacity) return;
    this.capacity = 2 * points;
    const geometry = this.mesh.geometry;
    geometry.setAttribute("position", new THREE.BufferAttribute(new Float32Array(3 * sides * this.capacity), 3));
    geometry.setAttribute("normal", new THREE.BufferAttribute(new Float32Array(3 * sides * this.capacity), 3));
    const index = [];
    for (let k = 0; k + 1 < this.capacity; ++k) {
      for (let i = 0; i < sides; ++i) {
        const a = k * sides + i, b = k * sides + (i + 1) % sides;
        index.push(a, b, a + sides, b, b + sides, a + sides);
      }
    }
    geometry.setIndex(index);
  }

  /// @param line  x y z of each point [m]
  show(line, radius, colour) {
    const points = line.length / 3;
    this.mesh.visible = points >= 2;
    if (points < 2) return;
    this.reserve(points);
    const geometry = this.mesh.geometry;
    const position = geometry.attributes.position.array, normal = geometry.attributes.normal.array;
    const at = k => new THREE.Vector3(line[3 * k], line[3 * k + 1], line[3 * k + 2]);
    const along = new THREE.Vector3(), across = new THREE.Vector3(), third = new THREE.Vector3();
    for (let k = 0; k < points; ++k) {
      const ahead = at(Math.min(k + 1, points - 1)).sub(at(Math.max(k - 1, 0)));
      if (ahead.lengthSq() > 0) along.copy(ahead).normalize();
      // the frame is carried along: across stays as near as it can to what it was
      if (k === 0) across.set(Math.abs(along.x) < 0.8 ? 1 : 0, Math.abs(along.x) < 0.8 ? 0 : 1, 0);
      across.addScaledVector(along, -across.dot(along)).normalize();
      third.crossVectors(along, across);
      for (let i = 0; i < sides; ++i) {
        const angle = 2 * Math.PI * i / sides, c = Math.cos(angle), s = Math.sin(angle);
        const to = 3 * (k * sides + i);
        for (let axis = 0; axis < 3; ++axis) {
          const n = c * across.getComponent(axis) + s * third.getComponent(axis);
          normal[to + axis] = n;
          position[to + axis] = line[3 * k + axis] + radius * n;
        }
      }
    }
    geometry.attributes.position.needsUpdate = geometry.attributes.normal.needsUpdate = true;
    geometry.setDrawRange(0, 6 * sides * (points - 1));
    this.mesh.material.color.setRGB(...colour, "srgb");
  }
}

/// A solid of revolution between two points: wide at both ends.
function boneMesh(from, to, fromRadius, toRadius, shaftRadius, material) {
  const start = new THREE.Vector3(...from), end = new THREE.Vector3(...to);
  const length = start.distanceTo(end);
  const outline = [];
  for (let k = 0; k <= 24; ++k) {
    const s = k / 24;
    const head = s < 0.2 ? fromRadius : s > 0.8 ? toRadius : shaftRadius;
    const blend = s < 0.2 ? s / 0.2 : s > 0.8 ? (1 - s) / 0.2 : 1;
    const radius = head + (shaftRadius - head) * (3 - 2 * blend) * blend * blend;
    const cap = Math.min(1, Math.sqrt(Math.max(0, Math.min(s, 1 - s)) * 14));
    outline.push(new THREE.Vector2(radius * cap, s * length));
  }
  const mesh = new THREE.Mesh(new THREE.LatheGeometry(outline, 18), material);
  mesh.position.copy(start);
  const direction = end.clone().sub(start).normalize();
  mesh.quaternion.setFromUnitVectors(new THREE.Vector3(0, 1, 0), direction);
  return mesh;
}

function wrapMesh(kind, X, radius, length, outer, semiAxes, material) {
  const group = new THREE.Group();
  let geometry;
  if (kind === 0) {
    geometry = new THREE.CylinderGeometry(radius, radius, length, 32);
    geometry.rotateX(Math.PI / 2);  // its axis is z
  } else if (kind === 3) {
    geometry = new THREE.TorusGeometry(outer, radius, 12, 40);
  } else {
    geometry = new THREE.SphereGeometry(kind === 1 ? radius : 1, 28, 18);
    if (kind === 2) geometry.scale(...semiAxes);
  }
  group.add(new THREE.Mesh(geometry, material));
  group.applyMatrix4(matrixOf(X));
  return group;
}

class View {
  constructor(canvas) {
    this.renderer = new THREE.WebGLRenderer({ canvas, antialias: true, alpha: true, preserveDrawingBuffer: true });
    this.scene = new THREE.Scene();
    this.camera = new THREE.PerspectiveCamera(35, 1, 0.01, 100);
    this.controls = new THREE.OrbitControls(this.camera, canvas);
    this.controls.addEventListener("change", () => this.render());
    this.scene.add(new THREE.HemisphereLight(0xffffff, 0x8a8478, 2.2));
    const sun = new THREE.DirectionalLight(0xffffff, 1.6);
    sun.position.set(1.5, 2, 2.5);
    this.scene.add(sun);
    this.boneMaterial = new THREE.MeshLambertMaterial({ color: 0xe8dfca });
    this.wrapMaterial = new THREE.MeshLambertMaterial(
      { color: 0x6aa9d8, transparent: true, opacity: 0.28, depthWrite: false, side: THREE.DoubleSide });
    this.bodies = [];
    this.tubes = [];
    this.muscleGroup = new THREE.Group();
    this.scene.add(this.muscleGroup);
    this.wrapsAreShown = false;
    this.shapes = new Float64Array();
  }

  /// The numbers of Core.shapes().
  setShapes(values, count) {
    const same = values.length === this.shapes.length && values.every((x, i) => x === this.shapes[i]);
    if (same && this.bodies.length === count) return;
    this.shapes = values;
    this.bodies.forEach(body => {
      body.traverse(part => part.geometry && part.geometry.dispose());
      this.scene.remove(body);
    });
    const from = new Numbers(values);
    this.bodies = [];
    for (let i = 0; i < count; ++i) {
      const body = new THREE.Group();
      body.matrixAutoUpdate = false;
      for (let n = from.next(); n > 0; --n) {
        const b = from.take(9);
        body.add(boneMesh(b.subarray(0, 3), b.subarray(3, 6), b[6], b[7], b[8], this.boneMaterial));
      }
      for (let n = from.next(); n > 0; --n) {
        const j = from.take(4);
        const ball = new THREE.Mesh(new THREE.SphereGeometry(j[3], 20, 14), this.boneMaterial);
        ball.position.set(j[0], j[1], j[2]);
        body.add(ball);
      }
      for (let n = from.next(); n > 0; --n) {
        const w = from.take(19);
        const wrap = wrapMesh(w[0], w.subarray(1, 13), w[13], w[14], w[15], w.subarray(16, 19), this.wrapMaterial);
        wrap.visible = this.wrapsAreShown;
        wrap.userData.isWrap = true;
        body.add(wrap);
      }
      this.scene.add(body);
      this.bodies.push(body);
    }
  }

  showWraps(shown) {
    this.wrapsAreShown = shown;
    this.bodies.forEach(body => body.children.forEach(part => {
      if (part.userData.isWrap) part.visible = shown;
    }));
    this.render();
  }

  /// The numbers of Core.drawing().
  /// @param largest  activation that has the last colour
  setDrawing(values, largest) {
    const from = new Numbers(values);
    this.box = new THREE.Box3();
    this.bodies.forEach(body => {
      body.matrix.copy(matrixOf(from.take(12)));
      body.matrixWorldNeedsUpdate = true;
    });
    let i = 0;
    for (; from.at < values.length; ++i) {
      const points = from.next();
      from.next();  // force
      const activation = from.next(), radius = from.next();
      if (!this.tubes[i]) this.tubes[i] = new Tube(this.muscleGroup);
      const line = from.take(3 * points);
      const colour = Number.isNaN(activation) ? [0.6, 0.6, 0.6] : viridisAt(activation / largest);
      this.tubes[i].show(line, radius, colour);
      for (let k = 0; k < points; ++k) this.box.expandByPoint(new THREE.Vector3(...line.subarray(3 * k, 3 * k + 3)));
    }
    for (; i < this.tubes.length; ++i) this.tubes[i].mesh.visible = false;
    if (!this.isFitted) this.lookFrom("side");
    this.render();
  }

  /// @param side  side (along −z), front (along −x), top, isometric
  lookFrom(side) {
    const box = this.box.clone();
    this.scene.updateMatrixWorld(true);
    this.bodies.forEach(body => body.children.forEach(part => {
      if (!part.userData.isWrap) box.expandByObject(part);
    }));
    if (box.isEmpty()) box.expandByPoint(new THREE.Vector3(-0.5, -0.5, -0.5)).expandByPoint(new THREE.Vector3(0.5, 0.5, 0.5));
    const middle = box.getCenter(new THREE.Vector3()), size = box.getSize(new THREE.Vector3()).length();
    const direction = { side: [0, 0, 1], front: [1, 0, 0], top: [0, 1, 0.001], isometric: [1, 0.7, 1] }[side];
    const distance = 0.5 * size / Math.sin(this.camera.fov * Math.PI / 360) / Math.min(1, this.camera.aspect) * 0.95;
    this.camera.position.copy(middle).addScaledVector(new THREE.Vector3(...direction).normalize(), distance);
    this.camera.near = distance / 100;
    this.camera.far = distance * 20;
    this.camera.updateProjectionMatrix();
    this.controls.target.copy(middle);
    this.controls.update();
    this.isFitted = true;
  }

  resize() {
    const { clientWidth, clientHeight } = this.renderer.domElement;
    if (!clientWidth || !clientHeight) return;
    this.renderer.setPixelRatio(Math.min(window.devicePixelRatio, 2));
    this.renderer.setSize(clientWidth, clientHeight, false);
    this.camera.aspect = clientWidth / clientHeight;
    this.camera.updateProjectionMatrix();
    this.render();
  }

  render() {
    this.renderer.render(this.scene, this.camera);
  }
}
