"""Pictures that no page has, drawn from what the programs say: of beliefs, of a search's course, of an arm's frames, of
the monitor's screen, and of the table of allowed dependencies. Each function returns a small SVG file's text."""
import html
import json
import pathlib
import re
import struct
import sys

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1] / "monitor"))
from terminal import Terminal  # pylint: disable=wrong-import-position

BLUE, GREEN, GREY, RED, VIOLET = "#1f6eb4", "#2a7f3f", "#777", "#c0392b", "#7d3c98"


def svg(width, height, parts, more="style='background:#fff' font-family='sans-serif' font-size='12'"):
    return (f"<svg xmlns='http://www.w3.org/2000/svg' {more} role='img' viewBox='0 0 {width:g} {height:g}' "
            f"width='{width:g}' height='{height:g}'>\n" + "\n".join(parts) + "\n</svg>\n")


def text(x, y, words, more=""):
    return f"<text x='{x:.1f}' y='{y:.1f}'{' ' + more if more else ''}>{html.escape(words)}</text>"


def line(x1, y1, x2, y2, stroke=GREY, more=""):
    return f"<path d='M{x1:.1f} {y1:.1f}L{x2:.1f} {y2:.1f}' stroke='{stroke}' fill='none'{' ' + more if more else ''}/>"


def polygon(points, more):
    return f"<polygon points='{' '.join(f'{x:.1f},{y:.1f}' for x, y in points)}' {more}/>"


def page_data(page):
    """What a page draws its moving pictures from."""
    return json.loads(re.search(r"<script[^>]*id=['\"]?page-data['\"]?[^>]*>(.*?)</script>", page, re.S)[1])


def outline(shape, right, up, at=(0.0, 0.0, 0.0)):
    """The convex hull of a shape that is moved and not turned, as it is seen along an axis."""
    flat = shape["points_m"]
    points = sorted({(round(flat[i + right] + at[right], 6), round(flat[i + up] + at[up], 6)) for i in range(0, len(flat), 3)})

    def half(ordered):
        hull = []
        for x, y in ordered:
            while len(hull) > 1 and ((hull[-1][0] - hull[-2][0]) * (y - hull[-2][1])
                                     - (hull[-1][1] - hull[-2][1]) * (x - hull[-2][0])) <= 0:
                hull.pop()
            hull.append((x, y))
        return hull[:-1]

    return half(points) + half(points[::-1])


def beliefs(page, shown, window_mm):
    """The particles of a plan in the plane before and after some of its steps.

    @param shown (index of the node, words)  @param window_mm lowest and highest x, lowest and highest y
    """
    data = page_data(page)
    scale = 0.45  # px a mm
    (x0, x1, y0, y1), gap, head = window_mm, 12, 40
    width, height = scale * (x1 - x0), scale * (y1 - y0)
    parts = []
    for panel, (node, words) in enumerate(shown):
        left = gap + panel * (width + gap)

        def place(points, left=left):
            return [(left + scale * (1e3 * x - x0), head + scale * (y1 - 1e3 * y)) for x, y in points]

        spread = data["nodes"][node]["spread"]
        parts += [text(left, 16, words, "font-weight='bold'"),
                  text(left, 32, f"deviation: x {1e3 * spread[0]:.1f}, y {1e3 * spread[1]:.1f} mm", "fill='#444'"),
                  f"<svg x='{left:.1f}' y='{head}' width='{width:.1f}' height='{height:.1f}' "
                  f"viewBox='{left:.1f} {head} {width:.1f} {height:.1f}'>"]
        parts += [polygon(place(outline(shape, 0, 1)), f"fill='{'#eee' if shape['name'] == 'table' else '#999'}'")
                  for shape in data["scene"]["environment"]]
        for shape in data["scene"]["held"]:
            parts.append(polygon(place(outline(shape, 0, 1, data["goal"])),
                                 f"fill='none' stroke='{GREEN}' stroke-width='2' stroke-dasharray='5 3'"))
            parts += [polygon(place(outline(shape, 0, 1, particle["poses"][node])),
                              f"fill='{BLUE}' fill-opacity='0.2' stroke='{BLUE}'") for particle in data["particles"]]
        parts += ["</svg>", f"<rect x='{left:.1f}' y='{head}' width='{width:.1f}' height='{height:.1f}' fill='none' "
                            f"stroke='#bbb'/>"]
    return svg(gap + len(shown) * (width + gap), head + height + gap, parts)


def course(statistics):
    """Of a search: what its best path costs and what none can cost less than, over its expansions."""
    ran = statistics["course"]
    left, right, top, bottom = 64, 620, 16, 190
    most, last = 1.08 * max(cost for cost in ran["cost"] if cost), ran["expansions"][-1]

    def at(expansion, cost):
        return left + (right - left) * expansion / last, bottom - (bottom - top) * cost / most

    parts = []
    for cost in range(0, int(most) + 1, 20000):
        _, y = at(0, cost)
        parts += [line(left, y, right, y, "#ddd"), text(left - 8, y + 4, str(cost), "text-anchor='end'")]
    for expansion in ran["expansions"]:
        parts.append(text(at(expansion, 0)[0], bottom + 18, str(expansion), "text-anchor='middle'"))
    way = ""
    for number, (expansion, bound) in enumerate(zip(ran["expansions"], ran["lower_bound"])):
        x, y = at(expansion, bound)
        way += f"M{x:.1f} {y:.1f}" if number == 0 else f"H{x:.1f}V{y:.1f}"
    parts.append(f"<path d='{way}' fill='none' stroke='{GREEN}' stroke-width='2'/>")
    parts.append(text(left + 8, at(0, ran["lower_bound"][-1])[1] - 8, f"no path costs less: {ran['lower_bound'][-1]:.0f} "
                      "at the end", f"fill='{GREEN}'"))
    for expansion, cost in zip(ran["expansions"], ran["cost"]):
        if cost:
            x, y = at(expansion, cost)
            parts += [f"<circle cx='{x:.1f}' cy='{y:.1f}' r='5' fill='{BLUE}'/>",
                      text(x - 10, y + 4, f"the path that was found: {cost:.0f}", f"text-anchor='end' fill='{BLUE}'")]
    parts.append(text((left + right) / 2, bottom + 38, "expansions", "text-anchor='middle'"))
    return svg(right + 20, bottom + 48, parts)


def arm_frames(page, dry_run, cell):
    """A gantry at a plan's start from the side: its frames, and the lengths of the cell file between them.

    @param page of the plan, for its shapes  @param cell the cell file, as data
    """
    data = page_data(page)
    task, tool, sensor = (cell[key]["position_m"] for key in ("task_in_base", "tool_in_flange", "sensor_in_flange"))
    flange = [joint["position"] for joint in dry_run["start_joints"]]
    tip = [a + b for a, b in zip(flange, tool)]
    scale, left, top = 1.1, 90, 40  # px a mm
    highest_mm = 1e3 * flange[2] + 40

    def px(x, z):
        return left + scale * 1e3 * x, top + scale * (highest_mm - 1e3 * z)

    parts = []
    for shape in data["scene"]["environment"]:
        parts.append(polygon([px(*point) for point in outline(shape, 0, 2, task)], "fill='#ccc' stroke='#999'"))
    for shape in data["scene"]["held"]:
        parts.append(polygon([px(*point) for point in outline(shape, 0, 2, tip)],
                             f"fill='{BLUE}' fill-opacity='0.25' stroke='{BLUE}'"))
    at_sensor = [a + b for a, b in zip(flange, sensor)]
    parts.append(line(*px(flange[0], flange[2] + 0.035), *px(tip[0], tip[2]), GREY, "stroke-width='2'"))
    for name, (x, _, z), colour in (("base", (0.0, 0.0, 0.0), GREY), ("task", task, RED), ("tool", tip, BLUE),
                                    ("sensor", at_sensor, VIOLET), ("flange", flange, GREEN)):
        u, v = px(x, z)
        parts += [line(u, v, u + 24, v, colour, "stroke-width='3'"), line(u, v, u, v - 24, colour, "stroke-width='3'"),
                  f"<circle cx='{u:.1f}' cy='{v:.1f}' r='4' fill='{colour}'/>",
                  text(u - 8, v + 4, name, f"text-anchor='end' font-weight='bold' fill='{colour}'")]

    def measure(column, low, high, words, colour):
        u = px(column, 0)[0]
        (_, v1), (_, v2) = px(0, low), px(0, high)
        return [line(u, v1, u, v2, colour), line(u - 5, v1, u + 5, v1, colour), line(u - 5, v2, u + 5, v2, colour),
                text(u + 9, (v1 + v2) / 2 + 4, words, f"fill='{colour}'")]

    column = flange[0] + 0.075
    parts += measure(column + 0.03, at_sensor[2], flange[2], f"sensor_in_flange: z {1e3 * sensor[2]:.0f} mm", VIOLET)
    parts += measure(column, tip[2], flange[2], f"tool_in_flange: z {1e3 * tool[2]:.0f} mm", BLUE)
    parts += measure(column, task[2], tip[2], f"start of the plan: {1e3 * (tip[2] - task[2]):.0f} mm above", GREY)
    (u0, v0), (u1, v1) = px(0, 0), px(task[0], task[2])
    parts += [line(u0, v0, u0, v1, RED, "stroke-dasharray='5 3'"), line(u0, v1, u1 - 45, v1, RED, "stroke-dasharray='5 3'"),
              text(u0 + 6, v1 + 18, f"task_in_base: x {1e3 * task[0]:.0f}, z {1e3 * task[2]:.0f} mm", f"fill='{RED}'")]
    return svg(px(column, 0)[0] + 260, v1 + 40, parts)


def log_until(log, cycles):
    """The log of a run up to a cycle, all of it at one time, and one message more that comes much later."""
    kept, at, seen = b"", 0, 0
    while seen < cycles:
        _, number, _, channel, size = struct.unpack_from(">IqqII", log, at)
        end = at + 28 + channel + size
        seen += log[at + 28:at + 28 + channel] == b"TENON_CYCLE"
        event = struct.pack(">IqqII", 0xEDA1DA01, number, 10**15, channel, size) + log[at + 28:end]
        kept, at = kept + event, end
    return kept + struct.pack(">IqqII", 0xEDA1DA01, number + 1, 10**15 + 10**10, channel, size) + event[28:]


TINTS = {"default": "#ddd", "green": "#5fd35f", "brown": "#e5c454", "yellow": "#e5c454", "red": "#ff6b6b", "cyan": "#6fd3e5",
         "black": "#111", "white": "#fff", "blue": "#7aa2ff", "magenta": "#e08ae0"}
DARK = {"green": "#3fa34d", "brown": "#c9a227", "yellow": "#c9a227", "red": "#c0392b", "cyan": "#2a8fa3"}


def screen(command, folder, columns, rows, until):
    """What a program shows on a terminal once a row matches. How long ago a message came is left out: it hangs on when
    one looks."""
    # A machine that stands still for a second makes what is shown stale.
    for _ in range(10):
        terminal = Terminal(command, columns, rows, folder=folder)
        try:
            if not terminal.wait_for(until):
                raise SystemExit(f"FAILED: no row {until!r} in\n{terminal.text()}")
            terminal.read(0.3)
            buffer = [[terminal.screen.buffer[row][column] for column in range(columns)] for row in range(rows)]
        finally:
            terminal.close()
        if buffer[0][0].data == "L":
            break
    wide, high, border = 7.4, 16, 10
    parts = [f"<rect width='{2 * border + columns * wide:.1f}' height='{2 * border + rows * high}' rx='6' fill='#1b1d21'/>"]
    for number, cells in enumerate(buffer):
        said = re.sub(r"cycle \d+\.\d s ago(, )?", lambda match: " " * len(match[0]), "".join(cell.data for cell in cells))
        runs = []
        for column, (cell, character) in enumerate(zip(cells, said)):
            style = ((cell.bg, cell.fg) if cell.reverse else (cell.fg, cell.bg)) + (cell.bold,)
            if runs and runs[-1][1] == style:
                runs[-1][2] += character
            else:
                runs.append([column, style, character])
        for column, (front, back, bold), words in runs:
            x, y = border + column * wide, border + number * high
            if back != "default":
                parts.append(f"<rect x='{x:.1f}' y='{y}' width='{len(words) * wide:.1f}' height='{high}' "
                             f"fill='{DARK.get(back, '#888')}'/>")
            # Word groups by themselves: not every viewer keeps several spaces.
            for group in re.finditer(r"\S+(?: \S+)*", words):
                parts.append(text(x + group.start() * wide, y + 12, group[0], f"fill='{TINTS.get(front, '#ddd')}' textLength="
                                  f"'{len(group[0]) * wide:.1f}'{' font-weight=' + repr('bold') if bold else ''}"))
    return svg(2 * border + columns * wide, 2 * border + rows * high, parts,
               "font-family='monospace' font-size='12'")


FOLDERS = {"shared": "#555", "lcmtypes": "#8a6d3b", "planner": BLUE, "executor": RED, "hw": VIOLET, "sim": GREEN}


def may_use(cmake):
    """The table of .cmake/Tenon.cmake: what each library and each program may use, Tenon's own and others'."""
    cmake = re.sub(r"#.*", "", cmake)
    libraries = re.search(r"set\(TENON_LIBRARIES\s+(.*?)\)", cmake, re.S)[1].split()
    rows = {name: words.split() for name, words in re.findall(r"set\(TENON_MAY_USE_([\w-]+)\s+([^)]*)\)", cmake)}
    return libraries, {name: rows[name] for name in rows if name in libraries or name.startswith("tenon-")}


def folder_of(library):
    return library.split("_")[0]


def room_of(library):
    return library.partition("_")[2] or library


def ordered(libraries, rows):
    """Folder by folder, who uses after who is used. A cycle is an error."""
    def depth(library):
        return 1 + max((depth(used) for used in rows[library] if used in libraries and folder_of(used) == folder_of(library)),
                       default=0)
    return sorted(libraries, key=lambda library: (list(FOLDERS).index(folder_of(library)), depth(library)))


def house(cmake):
    """The folders with their rooms, what these use beyond their own folder, and the programs that compose them."""
    libraries, rows = may_use(cmake)
    order = ordered(libraries, rows)
    wide, gap, high = 222, 12, 17
    parts = []

    def others(library):
        """Folders but the floor, and libraries of others, that a room uses."""
        used = [folder_of(one) for one in rows[library] if one in libraries]
        used = sorted({one for one in used if one not in ("shared", folder_of(library))}, key=list(FOLDERS).index)
        foreign = sorted({one.split("::")[0].removeprefix("Tenon") for one in rows[library] if one not in libraries})
        foreign = [one for one in foreign if one not in ("Threads", "Eigen3", "nlohmann_json", "console_bridge")]
        return used, foreign

    def room(x, y, width, library, name):
        used, foreign = others(library)
        colour = FOLDERS[folder_of(library)]
        said = [f"<rect x='{x:.1f}' y='{y:.1f}' width='{width:.1f}' height='{high - 3}' fill='#fff' stroke='{colour}'/>",
                text(x + 6, y + 11, name, "font-size='11'")]
        told = [f"<tspan fill='{FOLDERS[one]}' font-weight='bold'>{one}</tspan>" for one in used]
        told = (["\u2192 " + ", ".join(told)] if told else []) + ([f"<tspan fill='#777'>{', '.join(foreign)}</tspan>"]
                                                                if foreign else [])
        if told:
            said.append(f"<text x='{x + width - 6:.1f}' y='{y + 11:.1f}' text-anchor='end' font-size='10'>"
                        f"{' '.join(told)}</text>")
        return said

    # The programs, each with the rooms that it composes.
    programs = sorted(name for name in rows if name.startswith("tenon-"))
    columns = ["planner", "executor", "hw", "sim"]
    total = len(columns) * wide + (len(columns) - 1) * gap
    each = (total - (len(programs) - 1) * gap) / len(programs)
    lines = max(sum(1 for one in rows[name] if one in libraries) for name in programs)
    top, tall = 10, 24 + 13 * lines
    for number, name in enumerate(programs):
        x = gap + number * (each + gap)
        parts += [f"<rect x='{x:.1f}' y='{top}' width='{each:.1f}' height='{tall}' rx='4' fill='#f4f4f4' stroke='#999'/>",
                  text(x + 6, top + 15, name, "font-weight='bold'")]
        composed = [one for one in order[::-1] if one in rows[name]]
        for at, one in enumerate(composed):
            words = room_of(one) if "_" not in one or folder_of(one) != "shared" else one.replace("_", "/", 1)
            parts.append(text(x + 6, top + 30 + 13 * at, words, f"font-size='10' fill='{FOLDERS[folder_of(one)]}'"))
    # The four folders, who uses above who is used.
    top += tall + 18
    most = max(sum(folder_of(one) == folder for one in order) for folder in columns)
    tall = 26 + most * high + 4
    for number, folder in enumerate(columns):
        x = gap + number * (wide + gap)
        of = [one for one in order if folder_of(one) == folder]
        parts += [f"<rect x='{x}' y='{top}' width='{wide}' height='{tall}' rx='4' fill='#f4f4f4' stroke='{FOLDERS[folder]}' "
                  f"stroke-width='2'/>", text(x + 8, top + 17, f"{folder}/", f"font-weight='bold' fill='{FOLDERS[folder]}'")]
        for at, one in enumerate(reversed(of)):
            parts += room(x + 8, top + tall - 4 - high * (len(of) - at), wide - 16, one, room_of(one))
        parts.append(line(x + wide / 2, top + tall, x + wide / 2, top + tall + 13, FOLDERS["shared"], "stroke-width='2'"))
        parts.append(polygon([(x + wide / 2 - 5, top + tall + 11), (x + wide / 2 + 5, top + tall + 11),
                              (x + wide / 2, top + tall + 18)], f"fill='{FOLDERS['shared']}'"))
    # The floor.
    top += tall + 20
    floor = [one for one in order if folder_of(one) in ("shared", "lcmtypes")]
    third = (total - 16) / 3
    tall = 26 + high * -(-len(floor) // 3) + 4
    parts += [f"<rect x='{gap}' y='{top}' width='{total}' height='{tall}' rx='4' fill='#f4f4f4' stroke='{FOLDERS['shared']}' "
              f"stroke-width='2'/>", text(gap + 8, top + 17, "shared/, lcmtypes/", f"font-weight='bold' "
                                          f"fill='{FOLDERS['shared']}'")]
    for number, one in enumerate(floor):
        parts += room(gap + 8 + third * (number % 3), top + 26 + high * (number // 3), third - 8, one, one.replace("_", "/", 1))
    return svg(total + 2 * gap, top + tall + 10, parts)


def matrix(cmake):
    """Who may use whom, library by library and program by program."""
    libraries, rows = may_use(cmake)
    order = ordered(libraries, rows)
    programs = sorted(name for name in rows if name.startswith("tenon-"))
    cell, left, top = 14, 170, 150
    parts = []
    for number, name in enumerate(order + programs):
        y = top + cell * number
        colour = FOLDERS.get(folder_of(name), "#000")
        dots = ""
        for used in rows[name]:
            if used not in libraries:
                continue
            column = order.index(used)
            if name in libraries and column >= number:
                raise SystemExit(f"FAILED: {name} uses {used}, which stands above it: a cycle between folders")
            dots += f"M{left + cell * column + 3} {y + 3}h8v8h-8z"
        parts += [line(left, y + cell, left + cell * len(order), y + cell, "#eee"),
                  text(left - 6, y + 11, name, f"text-anchor='end' font-size='11' fill='{colour}'")]
        parts += [f"<path d='{dots}' fill='{colour}'/>"] if dots else []
        if name in libraries:
            x = left + cell * number
            parts += [text(x + 11, top - 6, name, f"font-size='11' fill='{colour}' transform='rotate(-60 {x + 11} {top - 6})'"),
                      f"<path d='M{x + 3} {y + 3}h8v8h-8z' fill='none' stroke='#ccc'/>",
                      line(x + cell, top, x + cell, top + cell * len(order + programs), "#eee")]
    return svg(left + cell * len(order) + 90, top + cell * len(order + programs) + 10, parts)
