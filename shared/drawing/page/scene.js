// One picture of a scene, in space where WebGL is to be had and flat otherwise, with its choice of views.

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

class ScenePicture {
  constructor(host, data) {
    this.host = host;
    this.data = data;
    const bounds = boundsOf(data);
    this.space = HAS_WEB_GL;
    this.scene = this.space
      ? new GlScene(host, data, bounds, colours())
      : new SvgScene(host, data, bounds, colours());
    host.dataset.renderer = this.space ? "webgl" : "svg";
    this.views = this.space ? [SPACE, ...data.views] : data.views;
    this.setView(this.views[0]);
    if (this.space) {
      new ResizeObserver(() => this.resize()).observe(host);
      this.resize();
    }
    onColours((palette) => this.scene.recolour(palette));
  }

  resize() {
    if (this.host.clientWidth) this.scene.resize(this.host.clientWidth, this.host.clientHeight);
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
    this.scene.draw(state, options);
  }
}
