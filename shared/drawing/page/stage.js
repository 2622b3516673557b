// The scene with its views, the player and a legend under it, and what happens now beside it.

function wantsNoMotion() {
  return window.matchMedia("(prefers-reduced-motion: reduce)").matches;
}

// Whether the part ends so deep between other things that one has to look inside.
function hidesGoal(data) {
  let highest = -Infinity;
  for (const shape of data.scene.environment) {
    for (let i = 2; i < shape.points_m.length; i += 3) highest = Math.max(highest, shape.points_m[i]);
  }
  return data.coordinates.includes(2) && data.goal[2] < highest - 1e-3;
}

// A box of the legend that turns one of the options on and off.
function optionBox(options, name, colour, text, changed) {
  const box = element("input", { type: "checkbox" });
  box.checked = options[name];
  box.addEventListener("change", () => {
    options[name] = box.checked;
    changed();
  });
  return element(
    "label",
    { class: "key" },
    box,
    element("i", { style: `background:var(--${colour})` }),
    text,
  );
}

// Only a scene in space is cut open. Its room is kept while there is none.
function cutBox(options, changed) {
  const box = optionBox(options, "cut", "environment", "cut open", changed);
  box.classList.add("in-space");
  return box;
}

function keyOf(colour, ...children) {
  return element(
    "span",
    { class: "key" },
    element("i", { style: `background:var(--${colour})` }),
    ...children,
  );
}

function termLine(label, text) {
  return element("p", {}, element("span", { class: "term" }, label), " ", text);
}

// Room for the longest of what an element says in turn, however wide it is, so that what stands below it stays where it
// is while it changes.
class Room {
  // contents: a function that makes all that it says, a list of elements each
  constructor(host, contents) {
    this.host = host;
    this.contents = contents;
    this.measure(); // before the page is first seen
    new ResizeObserver(() => {
      if (host.clientWidth !== this.width) this.measure();
    }).observe(host);
  }

  measure() {
    this.width = this.host.clientWidth;
    if (!this.width) return;
    const copy = element("div", { class: "measured", "aria-hidden": "true" });
    copy.style.width = this.width + "px";
    for (const lines of this.contents()) {
      copy.append(element("div", { class: this.host.className }, ...lines));
    }
    this.host.after(copy);
    const heights = [...copy.children].map((child) => child.getBoundingClientRect().height);
    copy.remove();
    this.host.style.setProperty("--room", Math.ceil(Math.max(0, ...heights)) + "px");
  }
}

class Stage {
  constructor(host, data, controls, legend) {
    this.host = host;
    const canvas = element("div", { class: "canvas" });
    this.views = element("div", { class: "views", role: "group", "aria-label": "Views" });
    this.now = element("aside", { class: "now", "aria-label": "What happens now" });
    host.append(element("div", { class: "picture" }, this.views, canvas, ...controls, legend), this.now);
    this.picture = new ScenePicture(canvas, data, () => this.markView());
    this.views.append(...this.picture.views.map((view) => this.viewButton(view)));
    this.markView();
  }

  viewButton(view) {
    const button = element("button", { type: "button" }, view.title);
    button.classList.toggle("in-space", view === SPACE);
    button.addEventListener("click", () => {
      this.picture.choose(view);
      this.markView();
    });
    return button;
  }

  // A button that goes hands its focus on to the view that is shown instead.
  markView() {
    const { space, views, view } = this.picture;
    const left = !space && document.activeElement?.matches(".views .in-space");
    [...this.views.children].forEach((button, i) => {
      button.setAttribute("aria-pressed", views[i] === view);
      if (left && views[i] === view) button.focus();
    });
  }

  comeIntoView() {
    this.host.scrollIntoView({ behavior: wantsNoMotion() ? "auto" : "smooth", block: "nearest" });
  }
}
