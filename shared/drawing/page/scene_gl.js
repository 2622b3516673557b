// The scene in space, drawn by WebGL with an orthographic camera, in millimetres.

class GlScene {
  // Hidden in its host until it is shown; null where the browser has no WebGL that works. What it is drawn by is made
  // beside the page's own work.
  static async readyWithin(host, data, bounds, palette) {
    const canvas = element("canvas", {
      role: "img",
      "aria-label": "The part, its particles and the environment in space",
      hidden: "",
    });
    const context = canvas.getContext("webgl2", { antialias: true, alpha: true });
    if (!context) return null;
    host.append(canvas);
    let made = null;
    try {
      made = new GlScene(canvas, context, data, bounds, palette);
      made.renderer.compile(made.scene, made.camera);
      await calm();
      if (made.works()) return made;
    } catch {
      // As where it works no better.
    }
    made?.dispose();
    canvas.remove();
    return null;
  }

  constructor(canvas, context, data, bounds, palette) {
    const T = TenonLibraries;
    this.data = data;
    this.bounds = bounds;
    this.canvas = canvas;
    this.context = context;
    // Before the renderer's own listener, which would write to the console.
    canvas.addEventListener("webglcontextlost", (event) => this.lose(event));
    this.renderer = new T.WebGLRenderer({ canvas, context, antialias: true, alpha: true });
    this.renderer.debug.checkShaderErrors = false; // works() does
    this.renderer.localClippingEnabled = true;
    this.renderer.setPixelRatio(Math.min(window.devicePixelRatio, 2));
    this.scene = new T.Scene();
    this.centre = bounds.low.map((value, i) => 500 * (value + bounds.high[i]));
    this.size = 1e3 * Math.hypot(...bounds.high.map((value, i) => value - bounds.low[i]));
    this.camera = new T.OrthographicCamera(-1, 1, 1, -1, -4 * this.size, 8 * this.size);
    this.camera.up.set(0, 0, 1);
    this.controls = new T.OrbitControls(this.camera, this.canvas);
    this.controls.addEventListener("change", () => this.render());
    // Controls forbid all of it: a finger that goes aside turns the scene, one that goes up scrolls the page.
    canvas.style.touchAction = "pan-y";
    const ambient = new T.HemisphereLight(0xffffff, 0x8a8f99, 2.2);
    ambient.position.set(0, 0, 1);
    const sun = new T.DirectionalLight(0xffffff, 1.4);
    sun.position.set(-0.5, -0.8, 1.2);
    this.scene.add(ambient, sun);
    this.cutter = new T.Plane(new T.Vector3(0, 1, 0), -1e3 * data.goal[1]);
    this.build();
    this.recolour(palette);
  }

  geometryOf(shape) {
    const geometry = new TenonLibraries.BufferGeometry();
    const points = new Float32Array(shape.points_m.map((value) => 1e3 * value));
    geometry.setAttribute("position", new TenonLibraries.BufferAttribute(points, 3));
    geometry.setIndex(shape.triangles);
    const flat = geometry.toNonIndexed();
    flat.computeVertexNormals();
    return flat;
  }

  // One group of faces and edges for each shape, made of the given materials.
  bodyOf(shapes, faces, edges) {
    const T = TenonLibraries;
    const group = new T.Group();
    for (const shape of shapes) {
      const geometry = this.geometryOf(shape);
      const mesh = new T.Mesh(geometry, faces);
      mesh.name = shape.name;
      group.add(mesh);
      if (edges) group.add(new T.LineSegments(new T.EdgesGeometry(geometry, 28), edges));
    }
    return group;
  }

  build() {
    const T = TenonLibraries;
    const { environment, held } = this.data.scene;
    this.materials = sceneMaterials();
    const m = this.materials;
    this.environment = this.bodyOf(environment, m.environment, m.environmentEdges);
    this.nominal = this.bodyOf(this.data.nominal ? environment : [], m.nominal, m.nominalEdges);
    if (this.data.nominal) this.place(this.nominal, this.data.nominal);
    this.particles = this.data.particles.map(() => this.bodyOf(held, m.particle, m.particleEdges));
    this.front = this.bodyOf(held, m.front, m.frontEdges);
    this.goal = new T.Group();
    for (const shape of held) {
      this.goal.add(new T.LineSegments(new T.EdgesGeometry(this.geometryOf(shape), 28), m.goal));
    }
    this.place(this.goal, this.data.goal);
    this.paths = this.data.particles.map((chain) => this.lineOf(chain.poses.length + 1, m.path));
    this.track = this.lineOf(0, m.whisker);
    this.track.renderOrder = 2;
    this.draws = this.pointsOf(this.data.draws.length, m.draws);
    this.tips = this.pointsOf(this.data.particles.length, m.tips);
    this.tips.renderOrder = 3;
    this.whisker = new T.LineSegments(this.emptyGeometry(6), m.whisker);
    this.whisker.renderOrder = 3;
    this.arrow = new T.Group();
    const unit = this.size / 100;
    const shaft = new T.Mesh(new T.CylinderGeometry(0.28 * unit, 0.28 * unit, 1, 12), m.arrow);
    const head = new T.Mesh(new T.ConeGeometry(0.9 * unit, 2.4 * unit, 20), m.arrow);
    this.arrow.add(shaft, head);
    this.arrow.renderOrder = 4;
    this.rings = new T.Group();
    this.buildTrails();
    this.scene.add(this.environment, this.nominal, ...this.particles, this.front, this.goal, ...this.paths);
    this.scene.add(this.draws, this.track, this.tips, this.whisker, this.arrow, this.rings);
  }

  // Paths of runs and the marks at their ends, by outcome.
  buildTrails() {
    const T = TenonLibraries;
    this.trails = Object.fromEntries(
      TRAIL_CLASSES.map((name) => {
        const line = new T.LineBasicMaterial({
          transparent: true,
          opacity: name === "succeeded" ? 0.35 : 0.75,
        });
        const mark = new T.LineBasicMaterial({ depthTest: false, transparent: true });
        const pair = [line, mark].map((material) => new T.LineSegments(this.emptyGeometry(0), material));
        pair[1].renderOrder = 3;
        for (const object of pair) object.frustumCulled = false;
        this.scene.add(...pair);
        return [name, pair];
      }),
    );
  }

  drawTrails(trails) {
    if (trails === this.shownTrails) return;
    this.shownTrails = trails;
    for (const name of TRAIL_CLASSES) {
      const own = trails.filter((trail) => trail.class === name);
      const unit = this.size / 130;
      const ends = own.flatMap((trail) => trailMark(name, trail.points[trail.points.length - 1], unit / 1e3));
      const parts = own.flatMap((trail) =>
        trail.points.slice(1).flatMap((point, i) => [trail.points[i], point]),
      );
      [parts, ends].forEach((points, i) => {
        this.trails[name][i].geometry.dispose();
        this.trails[name][i].geometry = this.emptyGeometry(points.length);
        this.setPoints(this.trails[name][i], points);
      });
    }
  }

  emptyGeometry(count) {
    const geometry = new TenonLibraries.BufferGeometry();
    geometry.setAttribute("position", new TenonLibraries.BufferAttribute(new Float32Array(3 * count), 3));
    return geometry;
  }

  lineOf(count, material) {
    const line = new TenonLibraries.Line(this.emptyGeometry(count), material);
    line.frustumCulled = false;
    return line;
  }

  pointsOf(count, material) {
    const points = new TenonLibraries.Points(this.emptyGeometry(count), material);
    points.frustumCulled = false;
    return points;
  }

  place(object, pose) {
    object.position.set(1e3 * pose[0], 1e3 * pose[1], 1e3 * pose[2]);
    object.quaternion.set(pose[4], pose[5], pose[6], pose[3]);
  }

  recolour(palette) {
    this.palette = palette;
    const m = this.materials;
    m.environment.color.set(palette.environment);
    m.touched.color.set(palette.contact);
    m.environmentEdges.color.set(palette.ink);
    m.nominal.color.set(palette.muted);
    m.nominalEdges.color.set(palette.muted);
    m.front.color.set(palette.part);
    m.frontEdges.color.set(palette.ink);
    m.particle.color.set(palette.particle);
    m.particleEdges.color.set(palette.particle);
    m.goal.color.set(palette.goal);
    m.path.color.set(palette.particle);
    m.whisker.color.set(palette.ink);
    m.draws.color.set(palette.muted);
    m.tips.color.set(palette.particle);
    m.arrow.color.set(palette.arrow);
    for (const name of TRAIL_CLASSES) {
      for (const object of this.trails[name]) object.material.color.set(palette[name]);
    }
    this.render();
  }

  setPoints(object, poses) {
    const attribute = object.geometry.attributes.position;
    poses.forEach((pose, i) => attribute.setXYZ(i, 1e3 * pose[0], 1e3 * pose[1], 1e3 * pose[2]));
    attribute.needsUpdate = true;
    object.geometry.setDrawRange(0, poses.length);
  }

  draw(state, options) {
    const m = this.materials;
    this.environment.children.forEach((child) => {
      if (child.isMesh) child.material = state.touched.has(child.name) ? m.touched : m.environment;
    });
    const clip = options.cut ? [this.cutter] : [];
    for (const material of [m.environment, m.touched, m.environmentEdges]) material.clippingPlanes = clip;
    this.particles.forEach((group, i) => {
      group.visible = options.particles;
      this.place(group, state.particles[i]);
    });
    this.front.visible = state.front !== null;
    if (state.front) this.place(this.front, state.front);
    this.track.geometry.dispose();
    this.track.geometry = this.emptyGeometry(state.track.length);
    this.setPoints(this.track, state.track);
    this.drawTrails(options.paths ? state.trails : NO_TRAILS);
    this.setPoints(this.tips, state.particles);
    this.setPoints(this.draws, state.draws);
    this.draws.visible = options.draws;
    const move = Math.floor(state.time);
    this.paths.forEach((line, i) => {
      line.visible = options.paths;
      const past = this.data.particles[i].poses.slice(0, move + 1);
      this.setPoints(line, [...past, state.particles[i]]);
    });
    this.drawWhiskers(state);
    this.drawArrow(state);
    this.drawRings(state);
    this.render();
  }

  // Two standard deviations each way along every direction that the task is uncertain in.
  drawWhiskers(state) {
    const ends = [];
    for (let axis = 0; axis < 3 && state.spread; ++axis) {
      for (const sign of [-2, 2]) {
        const end = state.mean.slice();
        end[axis] += sign * state.spread[axis];
        ends.push(end);
      }
    }
    this.setPoints(this.whisker, ends);
  }

  drawArrow(state) {
    this.arrow.visible = Boolean(state.arrow);
    if (!state.arrow) return;
    const T = TenonLibraries;
    const along = new T.Vector3(...state.arrow.along).multiplyScalar(1e3);
    const length = Math.min(along.length(), 0.22 * this.size);
    this.arrow.visible = length > 0;
    if (length === 0) return;
    along.normalize();
    this.arrow.position.set(...state.arrow.from.map((value) => 1e3 * value));
    this.arrow.quaternion.setFromUnitVectors(new T.Vector3(0, 1, 0), along);
    const [shaft, head] = this.arrow.children;
    shaft.scale.y = length;
    shaft.position.y = length / 2;
    head.position.y = length;
  }

  drawRings(state) {
    const T = TenonLibraries;
    this.rings.clear();
    for (const flash of state.flashes) {
      const radius = (0.012 + 0.04 * flash.age) * this.size;
      const material = new T.MeshBasicMaterial({
        color: this.palette.contact,
        transparent: true,
        opacity: 1 - flash.age,
        depthTest: false,
        side: T.DoubleSide,
      });
      const ring = new T.Mesh(new T.RingGeometry(0.82 * radius, radius, 40), material);
      ring.position.set(...flash.at.map((value) => 1e3 * value));
      ring.quaternion.copy(this.camera.quaternion);
      this.rings.add(ring);
    }
  }

  // Looks along a vector of the task frame.
  lookAlong(direction) {
    const T = TenonLibraries;
    const away = new T.Vector3(...direction).normalize().multiplyScalar(-2 * this.size);
    const centre = new T.Vector3(...this.centre);
    this.camera.up.set(
      0,
      Math.abs(away.z) > 1.99 * this.size ? 1 : 0,
      Math.abs(away.z) > 1.99 * this.size ? 0 : 1,
    );
    this.camera.position.copy(centre).add(away);
    this.controls.target.copy(centre);
    this.camera.zoom = 1;
    this.controls.update();
    this.fit();
  }

  // In the middle, and as large as everything that has to be seen allows, from where the camera is.
  fit() {
    const T = TenonLibraries;
    this.camera.updateMatrixWorld();
    const box = new T.Box3();
    for (const point of this.bounds.points) {
      const seen = new T.Vector3(...point.map((value) => 1e3 * value));
      box.expandByPoint(seen.applyMatrix4(this.camera.matrixWorldInverse));
    }
    const middle = box.getCenter(new T.Vector3());
    const shift = new T.Vector3(middle.x, middle.y, 0).applyQuaternion(this.camera.quaternion);
    this.camera.position.add(shift);
    this.controls.target.add(shift);
    this.controls.update();
    const size = box.getSize(new T.Vector3());
    this.reach = [size.x / 2, size.y / 2];
    this.frame();
  }

  frame() {
    const half = 1.06 * Math.max(this.reach[1], (this.reach[0] * this.height) / this.width);
    Object.assign(this.camera, { top: half, bottom: -half, right: (half * this.width) / this.height });
    this.camera.left = -this.camera.right;
    this.camera.updateProjectionMatrix();
    this.render();
  }

  resize(width, height) {
    this.width = width;
    this.height = height;
    this.renderer.setSize(width, height);
    if (this.reach) this.frame();
    // What there was, setSize has cleared.
    if (this.painted) this.paint();
  }

  // @param lost: called when the browser takes the context away
  show(lost) {
    this.lost = lost;
    this.canvas.hidden = false;
  }

  lose(event) {
    event.stopImmediatePropagation();
    this.lost?.();
  }

  // Whether every program so far links: where one does not, what it draws is missing.
  works() {
    const { context } = this;
    const links = ({ program }) => context.getProgramParameter(program, context.LINK_STATUS);
    return !context.isContextLost() && this.renderer.info.programs.every(links);
  }

  dispose() {
    cancelAnimationFrame(this.asked);
    this.controls.dispose();
    this.renderer.dispose();
    this.canvas.remove();
  }

  // Once a frame, however much has changed: building a scene changes most of it several times over.
  render() {
    if (!this.asked) this.asked = requestAnimationFrame(() => this.paint());
  }

  paint() {
    cancelAnimationFrame(this.asked);
    this.asked = 0;
    this.painted = true;
    if (this.width && !this.context.isContextLost()) this.renderer.render(this.scene, this.camera);
  }
}
