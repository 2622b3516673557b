// One picture of a scene: flat at once, in space as soon as WebGL is ready, with its choice of views.

function element(name, attributes = {}, ...children) {
  const made = document.createElement(name);
  for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
  made.append(...children.filter((child) => child !== null));
  return made;
}

function colours() {
  const style = getComputedStyle(document.documentElement);
  const names = [
    "ink",
    "muted",
    "environment",
    "contact",
    "part",
    "particle",
    "goal",
    "arrow",
    ...TRAIL_CLASSES,
  ];
  return Object.fromEntries(names.map((name) => [name, style.getPropertyValue("--" + name).trim()]));
}

// Calls back whenever the page turns light or dark.
function onColours(callback) {
  window.matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => callback(colours()));
}

const SPACE = { title: "In space" };
const CALM_FRAME_MS = 40;
const CALM_FRAMES = 4;
const CALM_MOST_MS = 1500;

// Until frames follow each other at once: the browser has then drawn what it had to. Who asks for a WebGL context before
// waits for all of that, and the page with him, up to a second and a half where no graphics card is.
async function calm() {
  const frame = () => new Promise(requestAnimationFrame);
  const start = await frame();
  let last = start;
  for (let inTime = 0; inTime < CALM_FRAMES && last - start < CALM_MOST_MS;) {
    const now = await frame();
    inTime = now - last < CALM_FRAME_MS ? inTime + 1 : 0;
    last = now;
  }
}

class ScenePicture {
  // @param turned: called when the picture has come to stand in space, or is flat again
  constructor(host, data, turned) {
    this.host = host;
    this.data = data;
    this.turned = turned;
    this.bounds = boundsOf(data);
    this.views = [...data.views, SPACE];
    this.view = data.views[0];
    this.space = false;
    this.stand(new SvgScene(host, data, this.bounds, colours()));
    onColours((palette) => this.scene.recolour(palette));
    new ResizeObserver(() => this.resize()).observe(host);
    this.rise();
  }

  stand(scene) {
    this.scene?.dispose();
    this.scene = scene;
    this.space = scene instanceof GlScene;
    this.host.dataset.renderer = this.space ? "webgl" : "svg";
  }

  async rise() {
    await calm();
    const inSpace = await GlScene.readyWithin(this.host, this.data, this.bounds, colours());
    if (!inSpace) return;
    this.stand(inSpace);
    inSpace.show(() => this.fall());
    inSpace.recolour(colours());
    this.setView(this.chosen ? this.view : SPACE);
    if (this.last) inSpace.draw(...this.last);
    this.resize();
    this.turned();
  }

  // Flat again: a browser may take the context away at any time.
  fall() {
    this.stand(new SvgScene(this.host, this.data, this.bounds, colours()));
    this.setView(this.view === SPACE ? this.data.views[0] : this.view);
    if (this.last) this.scene.draw(...this.last);
    this.turned();
  }

  resize() {
    if (!this.host.clientWidth) return;
    if (this.space) this.scene.resize(this.host.clientWidth, this.host.clientHeight);
    else this.scene.frame();
  }

  choose(view) {
    this.chosen = true;
    this.setView(view);
  }

  setView(view) {
    this.view = view;
    if (!this.space) {
      this.scene.setView(view);
      return;
    }
    if (!this.scene.width) this.resize();
    this.scene.lookAlong(view === SPACE ? this.slanting() : this.straight(view));
  }

  // From where the main view's plane is seen well, and depth too.
  slanting() {
    const view = this.data.views[0];
    return view.along === 2 && this.data.views.length === 1 ? [0.35, 0.8, -1.5] : [0.55, 1.2, -0.75];
  }

  straight(view) {
    const direction = [0, 0, 0];
    direction[view.along] = view.along === 2 ? -1 : 1;
    return direction;
  }

  draw(state, options) {
    this.last = [state, options];
    this.scene.draw(state, options);
  }
}
