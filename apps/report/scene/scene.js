"use strict";
// The 3-D view of explore's page and of reports: bones, wrap surfaces and muscles in the ground's frame, y upwards
// unless setUp() says otherwise.

const viridis = [[68, 1, 84], [71, 44, 122], [59, 81, 139], [44, 113, 142], [33, 144, 141],
                 [39, 173, 129], [92, 200, 99], [170, 220, 50], [253, 231, 37]];

/// @param x 0 … 1
function viridisAt(x) {
  const place = Math.min(Math.max(x, 0), 1) * (viridis.length - 1);
  const low = Math.min(Math.floor(place), viridis.length - 2);
  return viridis[low].map((c, i) => (c + (place - low) * (viridis[low + 1][i] - c)) / 255);
}

/// The colours of activation 0 to the largest, from left to right.
function drawColours(canvas) {
  const context = canvas.getContext("2d");
  for (let x = 0; x < canvas.width; ++x) {
    context.fillStyle = `rgb(${viridisAt(x / (canvas.width - 1)).map(c => Math.round(255 * c))})`;
    context.fillRect(x, 0, 1, canvas.height);
  }
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

/// The solids of all bodies.
class Limb {
  constructor(parent, boneMaterial, wrapMaterial) {
    Object.assign(this, { boneMaterial, wrapMaterial, bodies: [], shapes: new Float64Array(), wrapsAreShown: false });
    this.group = new THREE.Group();
    parent.add(this.group);
  }

  /// The numbers of Core.shapes().
  setShapes(values, count) {
    const same = values.length === this.shapes.length && values.every((x, i) => x === this.shapes[i]);
    if (same && this.bodies.length === count) return;
    this.shapes = values;
    this.bodies.forEach(body => {
      body.traverse(part => part.geometry && part.geometry.dispose());
      this.group.remove(body);
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
      this.group.add(body);
      this.bodies.push(body);
    }
  }

  showWraps(shown) {
    this.wrapsAreShown = shown;
    this.bodies.forEach(body => body.children.forEach(part => {
      if (part.userData.isWrap) part.visible = shown;
    }));
  }

  /// @param from  Numbers: the placement of each body
  place(from) {
    this.bodies.forEach(body => {
      body.matrix.copy(matrixOf(from.take(12)));
      body.matrixWorldNeedsUpdate = true;
    });
  }

  expand(box) {
    this.bodies.forEach(body => body.children.forEach(part => {
      if (!part.userData.isWrap) box.expandByObject(part);
    }));
  }
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
    this.root = new THREE.Group();  // the ground
    this.scene.add(this.root);
    this.wrapMaterial = new THREE.MeshLambertMaterial(
      { color: 0x6aa9d8, transparent: true, opacity: 0.28, depthWrite: false, side: THREE.DoubleSide });
    this.limb = new Limb(this.root, new THREE.MeshLambertMaterial({ color: 0xe8dfca }), this.wrapMaterial);
    this.ghost = null;
    this.tubes = [];
    this.muscleGroup = new THREE.Group();
    this.root.add(this.muscleGroup);
    this.bounds = null;  // what the view has room for; null: what it shows
  }

  /// @param up  direction in the ground's frame that is upwards
  setUp(up) {
    this.root.quaternion.setFromUnitVectors(new THREE.Vector3(...up), new THREE.Vector3(0, 1, 0));
  }

  setShapes(values, count) { this.limb.setShapes(values, count); }

  showWraps(shown) {
    this.limb.showWraps(shown);
    this.render();
  }

  /// Another posture, translucent; shown with the next drawing.
  /// @param numbers  begins with the placements of its bodies
  setGhost(shapes, count, numbers) {
    if (!this.ghost) {
      const material = new THREE.MeshLambertMaterial(
        { color: 0xd55e00, transparent: true, opacity: 0.35, depthWrite: false,
          polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 4 });
      this.ghost = new Limb(this.root, material, this.wrapMaterial);
    }
    this.ghost.setShapes(shapes, count);
    this.ghost.place(new Numbers(numbers));
    this.ghost.group.visible = true;
  }

  hideGhost() {
    if (this.ghost) this.ghost.group.visible = false;
  }

  /// The numbers of Core.drawing().
  /// @param largest  activation that has the last colour
  setDrawing(values, largest) {
    const from = new Numbers(values);
    this.lines = new THREE.Box3();
    this.limb.place(from);
    let i = 0;
    for (; from.at < values.length; ++i) {
      const points = from.next();
      from.next();  // force
      const activation = from.next(), radius = from.next();
      if (!this.tubes[i]) this.tubes[i] = new Tube(this.muscleGroup);
      const line = from.take(3 * points);
      const colour = Number.isNaN(activation) ? [0.6, 0.6, 0.6] : viridisAt(activation / largest);
      this.tubes[i].show(line, radius, colour);
      for (let k = 0; k < points; ++k) this.lines.expandByPoint(new THREE.Vector3(...line.subarray(3 * k, 3 * k + 3)));
    }
    for (; i < this.tubes.length; ++i) this.tubes[i].mesh.visible = false;
    if (!this.isFitted) this.lookFrom("side");
    this.render();
  }

  /// The box of what is shown.
  content() {
    this.scene.updateMatrixWorld(true);
    const box = this.lines.isEmpty() ? this.lines.clone() : this.lines.clone().applyMatrix4(this.root.matrixWorld);
    this.limb.expand(box);
    if (this.ghost && this.ghost.group.visible) this.ghost.expand(box);
    return box;
  }

  /// @param side  side (along −z), front (along −x), top, isometric
  lookFrom(side) {
    const box = (this.bounds || this.content()).clone();
    if (box.isEmpty()) box.expandByPoint(new THREE.Vector3(-0.5, -0.5, -0.5)).expandByPoint(new THREE.Vector3(0.5, 0.5, 0.5));
    const middle = box.getCenter(new THREE.Vector3()), half = box.getSize(new THREE.Vector3()).multiplyScalar(0.5);
    const direction = new THREE.Vector3(...{ side: [0, 0, 1], front: [1, 0, 0], top: [0, 1, 0.001], isometric: [1, 0.7, 1] }[side]).normalize();
    // as near as every corner of the box allows
    const right = new THREE.Vector3(0, 1, 0).cross(direction).normalize(), up = direction.clone().cross(right);
    const slope = Math.tan(this.camera.fov * Math.PI / 360);
    let distance = 1e-3;
    for (let i = 0; i < 8; ++i) {
      const corner = new THREE.Vector3(i & 1 ? half.x : -half.x, i & 2 ? half.y : -half.y, i & 4 ? half.z : -half.z);
      distance = Math.max(distance, corner.dot(direction) + 1.08 * Math.max(
        Math.abs(corner.dot(up)) / slope, Math.abs(corner.dot(right)) / (slope * this.camera.aspect)));
    }
    this.camera.position.copy(middle).addScaledVector(direction, distance);
    this.camera.near = distance / 100;
    this.camera.far = distance * 20;
    this.camera.updateProjectionMatrix();
    this.controls.target.copy(middle);
    this.controls.update();
    this.isFitted = true;
  }

  /// Turns the view about its middle [rad].
  turn(around, down) {
    const away = this.camera.position.clone().sub(this.controls.target);
    const distance = away.length(), angle = Math.atan2(away.x, away.z) + around;
    const tilt = Math.min(Math.max(Math.acos(away.y / distance) + down, 0.01), Math.PI - 0.01);
    away.set(Math.sin(tilt) * Math.sin(angle), Math.cos(tilt), Math.sin(tilt) * Math.cos(angle));
    this.camera.position.copy(this.controls.target).addScaledVector(away, distance);
    this.controls.update();
    this.render();
  }

  /// @param factor  of the distance from the middle
  zoom(factor) {
    const away = this.camera.position.clone().sub(this.controls.target);
    this.camera.position.copy(this.controls.target).addScaledVector(away, factor);
    this.controls.update();
    this.render();
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
