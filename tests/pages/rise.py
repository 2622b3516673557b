"""What a page with WebGL does while its scene rises from flat to space, once it stands there, and when it falls back.

A page is flat at first, and for good where WebGL does not work.
"""
import math

ROOT = "document.documentElement.dataset"
RENDERER = "document.querySelector('.canvas').dataset.renderer"
PRESSED = "document.querySelector('.views [aria-pressed=true]').textContent"
FOCUSED = "document.activeElement.textContent.slice(0, 40)"
VIEWS = "document.querySelector('.views').innerText"
# Of headings, views and legend: the first words, and px from the left and from the top of the page.
PLACES = """[...document.querySelectorAll('main h2, main h3, .views button, .legend > *, .now')].map(e =>
  [e.textContent.slice(0, 20), e.getBoundingClientRect().left, e.getBoundingClientRect().top + scrollY])"""
# Where they are as the first frame of a page that can be used begins.
AT_FIRST = f"""new MutationObserver((_, observer) => {{
  if (document.documentElement?.dataset.ready !== 'true') return;
  observer.disconnect();
  requestAnimationFrame(() => {{ window.placesAtFirst = {PLACES}; }});
}}).observe(document, {{ attributes: true, subtree: true }});"""
# Every program fails to link, as where a driver refuses a shader.
NO_SHADERS = "WebGL2RenderingContext.prototype.linkProgram = () => { window.linked = true; };"
LOSE = """(() => { const context = document.querySelector('.canvas canvas').getContext('webgl2');
  context.getExtension('WEBGL_lose_context').loseContext(); })()"""
KEYS = {" ": {"key": " ", "code": "Space", "windowsVirtualKeyCode": 32, "text": " "},
        "ArrowRight": {"key": "ArrowRight", "code": "ArrowRight", "windowsVirtualKeyCode": 39}}
PHONE = (390, 800)
WHILE = "new Promise(done => setTimeout(done, 2500))"  # as a fall takes, or a rise at most
TWO_FRAMES = "new Promise(done => requestAnimationFrame(() => requestAnimationFrame(() => done())))"


def rise(browser):
    """Until the scene stands in space: the page is flat, and can be used, before."""
    browser.wait_for(f"{RENDERER} === 'webgl'")


def opened(browser, file, script=None, **options):
    """The page as it can be used. @param script: runs before the page's own"""
    script = script and browser.call("Page.addScriptToEvaluateOnNewDocument", source=script)["identifier"]
    browser.open(file, **options)
    browser.wait_for(f"{ROOT}.ready === 'true'")
    if script:
        browser.call("Page.removeScriptToEvaluateOnNewDocument", identifier=script)


def keep_view(browser, file, failures):
    """A view chosen while the page is still flat stays the chosen one in space, and its button keeps the focus."""
    opened(browser, file)
    flat = browser.evaluate("(() => { const first = document.querySelector('.views button'); first.focus();"
                            f" first.click(); return {RENDERER} + ' ' + first.textContent; }})()")
    rise(browser)
    pressed, focused = browser.evaluate(PRESSED), browser.evaluate(FOCUSED)
    failures.check(flat == f"svg {pressed}", f"{file.stem}: '{flat}' was chosen, in space it is '{pressed}'")
    failures.check(focused == pressed, f"{file.stem}: the focus was on '{pressed}', in space it is on '{focused}'")
    failures.check(not browser.said(), f"{file.stem}: says something while it rises")


def stay_put(browser, file, failures, webgl):
    """Nothing moves between the first frame that can be used and the scene in space, or where there is none."""
    for width in (1400, 390):
        opened(browser, file, AT_FIRST, width=width)
        if webgl:
            rise(browser)
        browser.evaluate(TWO_FRAMES)
        first, last = browser.evaluate("placesAtFirst"), browser.evaluate(PLACES)
        failures.check([place[0] for place in first] == [place[0] for place in last],
                       f"{file.stem}: at {width} px stood {first}, then {last}")
        for (name, left, top), (_, left_then, top_then) in zip(first, last):
            moved = math.hypot(left_then - left, top_then - top)
            failures.check(moved <= 1.0, f"{file.stem}: at {width} px '{name}' moves by {moved:.0f} px")


def fall_back(browser, file, failures):
    """Where the context is lost, or no shader links, the flat scene stands with step and view as chosen."""
    for view in ("In space", ""):
        opened(browser, file, fragment="#step=1.5")
        rise(browser)
        if not view:
            browser.evaluate("document.querySelector('.views button:not([aria-pressed=true])').click()")
        before, step_before = browser.evaluate(PRESSED), browser.evaluate(f"{ROOT}.step")
        browser.said()
        browser.evaluate(LOSE)
        browser.evaluate(WHILE)
        check_flat(browser, f"{file.stem}, lost", failures)
        pressed, step = browser.evaluate(PRESSED), browser.evaluate(f"{ROOT}.step")
        failures.check(pressed == before or before == "In space", f"{file.stem}: '{before}' was chosen, now '{pressed}'")
        failures.check(step == step_before, f"{file.stem}: falls back from step {step_before} to {step}")
    opened(browser, file, NO_SHADERS)
    browser.wait_for("window.linked")
    browser.evaluate(WHILE)
    check_flat(browser, f"{file.stem}, without shaders", failures)


def check_flat(browser, name, failures):
    shown = browser.evaluate("[...document.querySelectorAll('.canvas > *')].map(e => e.localName).join()")
    failures.check(shown == "svg", f"{name}: the scene is drawn by '{shown}'")
    failures.check("In space" not in browser.evaluate(VIEWS), f"{name}: still offers the view in space")
    said = [text for text in browser.said() if not text.startswith("WebGL: CONTEXT_LOST")]  # the browser's own
    failures.check(not said, f"{name}: says {said}")


def type_key(browser, key):
    browser.call("Input.dispatchKeyEvent", type="keyDown", **KEYS[key])
    browser.call("Input.dispatchKeyEvent", type="keyUp", **{k: v for k, v in KEYS[key].items() if k != "text"})


def tick_by_key(browser, file, failures):
    """Space ticks the box that has the focus, and plays where the slider has it, along which arrows lead by steps."""
    opened(browser, file)
    name = file.stem
    state = "[document.querySelector('.legend input').checked, document.documentElement.dataset.playing]"
    browser.evaluate("document.querySelector('.legend input').focus()")
    ticked, _ = browser.evaluate(state)
    type_key(browser, " ")
    failures.check(browser.evaluate(state) == [not ticked, "false"],
                   f"{name}: space on a box that was {ticked}: [ticked, playing] {browser.evaluate(state)}")
    browser.evaluate("document.querySelector('.controls button').click()")
    browser.evaluate("document.querySelector('.scrub input').focus()")
    value = "document.querySelector('.scrub input').value"
    text = "document.querySelector('.scrub input').getAttribute('aria-valuetext')"
    before, said = browser.evaluate(value), browser.evaluate(text)
    type_key(browser, "ArrowRight")
    after = browser.evaluate(value)
    stops = browser.evaluate("[...document.querySelectorAll('.ticks i')].map(i => parseFloat(i.style.left))")
    share = 100 * float(after) / float(browser.evaluate("document.querySelector('.scrub input').max"))
    failures.check(float(after) > float(before) and min(abs(share - stop) for stop in stops) < 0.2,
                   f"{name}: an arrow on the slider leads from {before} to {after}, '{said}'")
    type_key(browser, " ")
    failures.check(browser.evaluate(f"{ROOT}.playing") == "true", f"{name}: space on the slider does not play")


def scroll_over_the_scene(browser, file, failures):
    """On a phone one finger that goes up over the scene in space scrolls the page; one that goes aside turns the scene."""
    width, height = PHONE
    opened(browser, file, width=width, height=height)
    rise(browser)
    browser.call("Emulation.setTouchEmulationEnabled", enabled=True)
    browser.evaluate("document.querySelector('.canvas').scrollIntoView({ block: 'center' })")
    touch = browser.evaluate("getComputedStyle(document.querySelector('.canvas canvas')).touchAction")
    failures.check(touch == "pan-y", f"{file.stem}: touch over the scene is '{touch}'")
    box = browser.evaluate("(() => { const r = document.querySelector('.canvas').getBoundingClientRect();"
                           " return { x: r.left, y: r.top, width: r.width, height: r.height, scale: 1 }; })()")
    picture = lambda: browser.call("Page.captureScreenshot", format="png",
                                   clip={**box, "y": box["y"] + browser.evaluate("scrollY")})["data"]
    before, scrolled = picture(), browser.evaluate("scrollY")
    middle = {"x": box["x"] + box["width"] / 2, "y": box["y"] + box["height"] / 2}
    drag(browser, middle, {"x": 80, "y": 0})
    browser.evaluate(TWO_FRAMES)
    failures.check(browser.evaluate("scrollY") == scrolled, f"{file.stem}: a finger that goes aside scrolls")
    failures.check(picture() != before, f"{file.stem}: a finger that goes aside does not turn the scene")
    drag(browser, middle, {"x": 0, "y": -120})
    browser.evaluate(TWO_FRAMES)
    failures.check(browser.evaluate("scrollY") > scrolled + 50, f"{file.stem}: a finger over the scene does not scroll")
    browser.call("Emulation.setTouchEmulationEnabled", enabled=False)


def drag(browser, start, way, steps=12):
    at = lambda share: [{"x": start["x"] + share * way["x"], "y": start["y"] + share * way["y"]}]
    browser.call("Input.dispatchTouchEvent", type="touchStart", touchPoints=at(0))
    for step in range(1, steps + 1):
        browser.call("Input.dispatchTouchEvent", type="touchMove", touchPoints=at(step / steps))
    browser.call("Input.dispatchTouchEvent", type="touchEnd", touchPoints=[])
