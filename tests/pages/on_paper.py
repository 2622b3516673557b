"""What a page is in print: all that it says, and nothing wider than the paper."""
from browser import PAPER

# Of a button that leads somewhere: what it says, and how much of it is seen.
JUMPS = "[...document.querySelectorAll('button.jump')].filter(e => !e.closest('details:not([open])'))"


def print_page(browser, file, failures, pictures):
    """@return the text that is printed"""
    browser.open(file, dark=True)
    browser.wait_for("document.documentElement.dataset.ready === 'true' || !document.getElementById('page-data')")
    browser.to_paper()
    name = f"{file.stem}_paper"
    if pictures:
        browser.picture(pictures / f"{name}.png")
    missing = browser.evaluate(f"{JUMPS}.filter(e => !e.innerText.trim() || !e.offsetHeight).map(e => e.textContent)")
    failures.check(not missing, f"{name}: leaves out {missing}")
    framed = browser.evaluate(f"{JUMPS}.filter(e => getComputedStyle(e).borderTopWidth !== '0px').length")
    failures.check(framed == 0, f"{name}: {framed} buttons on paper")
    wide = browser.evaluate("document.documentElement.scrollWidth")
    failures.check(wide <= PAPER, f"{name}: {wide} px wide, the paper {PAPER}")
    paper = browser.evaluate("getComputedStyle(document.documentElement).getPropertyValue('--paper').trim()")
    failures.check(paper == "#faf9f6", f"{name}: on {paper}")
    for said in browser.said():
        failures.check(False, f"{name}: says {said}")
    return browser.evaluate("document.body.innerText")
