"""docs/results.md and docs/results.svg, made of the page of `touchstone report` and docs/data/published.json.

The page's own script computes tables and fronts and draws the picture (`verify/report/*.js`); this adds the sentences of the
document.
"""

import html
import json
import re

# Writes into the page what a document needs of it.
READER = """<pre id="for-the-document"></pre><script>
const tables = (section) => section.tables.map((table) => ({ title: table.title, markdown: report.markdownOf(table) }));
const sections = [...page.contents.top, ...page.contents.further];
document.getElementById("for-the-document").textContent = JSON.stringify({
  origin: page.contents.origin,
  meanings: page.contents.meanings,
  sections: sections.map((section) => ({ title: section.title, id: section.id, tables: tables(section) })),
  figures: page.contents.figures.map(({ form, y_label, panels }) => ({ form, y_label, panels })),
  picture: page.pictureOf(page.contents.figures[0]) });
</script></body>"""


def read_page(page, folder, run):
    """What the page of a report, a file in the folder, says once its script has run in a browser."""
    page.write_text(page.read_text().replace("</body>", READER))
    dom = run(["chromium", "--headless", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage",
               "--virtual-time-budget=10000", f"--user-data-dir={folder}/profile", "--dump-dom", page.as_uri()])
    return json.loads(html.unescape(re.search('<pre id="for-the-document">(.*?)</pre>', dom, re.DOTALL)[1]))


def place_of(measurement):
    return f"{measurement['group']}, {measurement['kind']}"


def findings(data):
    """A line for each group and kind."""
    field = [m for m in data["measurements"] if m["experiment"] == "field"]
    for place in dict.fromkeys(map(place_of, field)):
        def names(test):
            return ", ".join(f"`{m['method']}`" for m in field if place_of(m) == place and test(m)) or "none"

        yield (f"- **{place}**: with false negatives: {names(lambda m: m['false_negatives'])}. "
               f"Without false positives: {names(lambda m: not m['false_positives'])}. Faster than `certified` on the same "
               "queries: " + names(lambda m: m["method"] != "certified" and m["ns_per_query"] is not None
                                   and m["ns_per_query"] < m["certified_ns_per_query"]) + ".")


def fronts(figures):
    """The methods on the Pareto fronts, each with its comparisons."""
    comparisons = {}
    for figure in figures:
        if figure["form"] == "points":
            for panel in figure["panels"]:
                names = ", ".join(point["label"] for point in panel["front"]) or "none"
                comparisons.setdefault(names, []).append(f"{figure['y_label'].partition(', of the')[0]} ({panel['title']})")
    yield ("On the Pareto front of time against false positives and of time against the error of the time of impact, of those "
           "without a miss:")
    yield ""
    yield from (f"- {names}: {'; '.join(of)}" for names, of in sorted(comparisons.items()))


def differences(data, published):
    measured = {m["method"] for m in data["measurements"]}
    yield from (f"- {text}" for text in published["differences"]["general"])
    yield from (f"- `{method}`: {of['text']}" for method, of in published["differences"]["methods"].items() if method in measured)


def document(data, published, said):
    """The document in Markdown, of the measurements, the published numbers and what the page says."""
    lines = ["# Results", "", f"Written by `./run results`; not edited by hand. Made{said['origin']} by", "",
             "```", data["command"], "```", "",
             f"The truth is the exact oracle's. Published: {published['work']}, on another machine.", "",
             "## In sentences", "", *findings(data), "", *fronts(said["figures"]), ""]
    for section in said["sections"]:
        lines += [f"## {section['title']}", ""]
        if section["id"] == "filters":
            lines += [published["filters"]["text"], "", published["filters"]["plainest_miss"]["text"], ""]
        for table in section["tables"]:
            lines += [f"### {table['title']}", "", table["markdown"]]
    lines += ["## The columns", "", *(f"- {meaning}" for meaning in said["meanings"]), "",
              "## Why the numbers differ from the published ones", "", *differences(data, published), ""]
    return "\n".join(lines)
