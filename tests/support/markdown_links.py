"""Links of documents that lead nowhere.

A script finds this module by `sys.path.append(str(pathlib.Path(__file__).resolve().parents[1] / "support"))`.
"""
import re

FENCED = re.compile(r"^```.*?^```$", re.M | re.S)
LINK = re.compile(r"\]\(([^)\s]+)\)")


def without_blocks(text):
    """Blocks of code blanked out; the lines stay where they are."""
    return FENCED.sub(lambda match: "\n" * match[0].count("\n"), text)


def anchors_of(document):
    """The fragments under which a document's headings are reached."""
    anchors = set()
    for heading in re.findall(r"^#+ (.*)$", without_blocks(document.read_text(encoding="utf-8")), re.M):
        words = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", heading.strip()).lower()
        anchors.add(re.sub(r"[^\w\- ]", "", words).replace(" ", "-"))
    return anchors


def dead_links(documents):
    """Yields `FILE:LINE: LINK` of every relative link whose file, or heading in it, is not there."""
    for document in documents:
        text = without_blocks(document.read_text(encoding="utf-8"))
        for match in LINK.finditer(text):
            name, _, fragment = match[1].partition("#")
            if re.match(r"[a-z]+:", name):
                continue
            target = document.parent / name if name else document
            headed = fragment and target.suffix == ".md"
            if not target.exists() or (headed and fragment not in anchors_of(target)):
                yield f"{document}:{text.count(chr(10), 0, match.start()) + 1}: {match[1]}"
