#!/usr/bin/env python3
"""What assemblies.sh has left in a folder, as one table: assemblies.txt, assemblies.json, assemblies.html.

  assemblies_page.py FOLDER
"""

import html
import json
import pathlib
import re
import sys

COLUMNS = [
    ("pair", "{}"),
    ("outcome", "{}"),
    ("task_s", "{:.1f}"),
    ("plan_s", "{:.1f}"),
    ("evaluation_s", "{:.1f}"),
    ("steps", "{}"),
    ("succeeded", "{}"),
    ("wilson95", "{}"),
    ("within_reach", "{}"),
    ("done_but_wrong", "{}"),
    ("force_p99_N", "{:.0f}"),
    ("why", "{}"),
]
STYLE = """
body { font: 15px/1.5 system-ui, sans-serif; margin: 2rem auto; max-width: 75rem; padding: 0 1rem;
       color-scheme: light dark; }
table { border-collapse: collapse; width: 100%; }
th, td { border-bottom: 1px solid #8886; padding: .3rem .6rem; text-align: left; vertical-align: top; }
.scroll { overflow-x: auto; }
figure { display: inline-block; margin: 1rem; max-width: 22rem; }
figure svg { width: 100%; height: auto; background: white; }
"""


def last_line(file):
    lines = file.read_text(errors="replace").strip().splitlines() if file.exists() else []
    return lines[-1] if lines else ""


def row_of(folder):
    row = {"pair": folder.name}
    for stage in ("task", "plan", "evaluation"):
        file = folder / f"{stage}.seconds"
        if file.exists():
            row[f"{stage}_s"] = float(file.read_text())
    if not (folder / "task.yaml").exists():
        return {**row, "outcome": "no task", "why": last_line(folder / "task.err")}
    if not (folder / "plan.tnp").exists():
        return {**row, "outcome": "not planned", "why": last_line(folder / "plan.err")}
    row |= {"outcome": "planned", "steps": json.loads((folder / "plan.json").read_text())["steps"]}
    if not (folder / "evaluation.json").exists():
        return {**row, "why": last_line(folder / "evaluation.err")}
    summary = json.loads((folder / "evaluation.json").read_text())["plans"][0]["summary"]
    success = summary["success"]
    reach = summary["within"][-1]
    return row | {
        "succeeded": f"{success['succeeded']} of {success['runs']}",
        "wilson95": f"{100 * success['wilson95_low']:.1f}-{100 * success['wilson95_high']:.1f} %",
        "within_reach": f"{reach['succeeded']} of {reach['runs']}",
        "done_but_wrong": summary["done_but_wrong"],
        "force_p99_N": summary["contact_force_N_max"]["p99"],
    }


def cells(row):
    return [form.format(row[name]) if name in row else "" for name, form in COLUMNS]


def text_of(rows):
    table = [[name for name, _ in COLUMNS]] + [cells(row) for row in rows]
    widths = [max(len(line[i]) for line in table) for i in range(len(COLUMNS))]
    return "\n".join("  ".join(t.ljust(w) for t, w in zip(line, widths)).rstrip() for line in table)


def figure_of(folder, row):
    page = folder / "plan.html"
    picture = re.search(r"<svg\b.*?</svg>", page.read_text(), re.S) if page.exists() else None
    if not picture:
        return ""
    name = html.escape(row["pair"])
    # Names inside a picture are its own.
    svg = re.sub(r'(\bid="|url\(#|href="#)', rf"\g<1>{name}-", picture.group(0))
    return f'<figure>{svg}<figcaption><a href="{name}/plan.html">{name}</a></figcaption></figure>\n'


def page_of(folder, setting, rows):
    head = "".join(f"<th>{html.escape(name)}</th>" for name, _ in COLUMNS)
    body = "".join("<tr>" + "".join(f"<td>{html.escape(t)}</td>" for t in cells(row)) + "</tr>\n" for row in rows)
    figures = "".join(figure_of(folder / row["pair"], row) for row in rows)
    return (
        '<!doctype html>\n<html lang="en"><meta charset="utf-8">\n'
        '<meta name="viewport" content="width=device-width">\n'
        f"<title>Assemblies</title>\n<style>{STYLE}</style>\n<h1>Assemblies</h1>\n<p>{html.escape(setting)}</p>\n"
        f'<div class="scroll"><table><tr>{head}</tr>\n{body}</table></div>\n{figures}</html>\n'
    )


def write(file, text):
    part = file.with_name(file.name + ".part")
    part.write_text(text)
    part.replace(file)


def main():
    if len(sys.argv) != 2 or not (pathlib.Path(sys.argv[1]) / "setting.txt").exists():
        sys.exit("assemblies_page.py: give the output folder of assemblies.sh")
    folder = pathlib.Path(sys.argv[1])
    setting = (folder / "setting.txt").read_text().strip()
    rows = [row_of(file.parent) for file in sorted(folder.glob("*/task.seconds"))]
    planned = sum(row["outcome"] == "planned" for row in rows)
    text = f"{setting}\n{text_of(rows)}\n{planned} of {len(rows)} planned\n"
    write(folder / "assemblies.txt", text)
    write(folder / "assemblies.json", json.dumps({"setting": setting, "pairs": rows}, indent=1) + "\n")
    write(folder / "assemblies.html", page_of(folder, setting, rows))
    print(text, end="")
    print(f"page: {folder / 'assemblies.html'}")


if __name__ == "__main__":
    main()
