"""docs/results.md and docs/results.svg, made of rows of `touchstone bench` (docs/data) and docs/data/published.json."""

import html
import json
import math
import pathlib
import re

NONE = "–"
# Writes the picture of a page of `touchstone bench` into it.
READER = """<pre id="for-the-document"></pre><script>
document.getElementById("for-the-document").textContent = page.pictureOf(page.figures[0]);
</script></body>"""

COLUMNS = [
    "µs: processor time a query, all queries in one call, one thread, median of the repetitions of one run in which the "
    "methods take turns.",
    "÷ certified: the same as a multiple of the certified solver's time on the same queries in the same run.",
    "FN, FP: false negatives (collisions that it missed) and false positives (with their share of the queries that do "
    "not collide).",
    "late: times of impact above the exact one, and by how much of the step at most.",
    "asked: queries that the method was asked; where they are not all, an evenly spread sample, as large as the time "
    "allowed. Nothing is extrapolated. A method with * was asked fewer than the others of its table: compare shares, "
    "not counts.",
    "collide: of those asked, by the oracle, for the separation and norm of the row.",
    "at limit: queries that the method gave up at its limit of checks (1,000,000; IRF and UIRF 100,000) and called a "
    "collision.",
    "toi error: from the time that the method gives to the exact time of impact, in units of the motion's duration; – "
    "where it gives none.",
    "published: as printed, for the whole of the published data, on another machine.",
]
CONTACTS = {"end-contact": "contact at t=1, full significands", "decimal-end-contact": "contact at t=1, two decimals"}


def picture(tool, rows, folder, run):
    """The picture of the rows: speed against false positives."""
    lines, page = folder / "rows.jsonl", folder / "page.html"
    lines.write_text("".join(json.dumps(row) + "\n" for row in rows))
    run([tool, "bench", "--from", lines, "--page", page])
    page.write_text(page.read_text().replace("</body>", READER))
    dom = run(["chromium", "--headless", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage",
               "--virtual-time-budget=10000", f"--user-data-dir={folder}/profile", "--dump-dom", page.as_uri()])
    return html.unescape(re.search('<pre id="for-the-document">(.*?)</pre>', dom, re.DOTALL)[1])


# ---- Words -----------------------------------------------------------------------------------------------------------


def short(value):
    """Three digits, more for whole numbers from 1000."""
    if value is None:
        return NONE
    if math.isinf(float(value)):
        return "∞"
    return f"{value:.0f}" if 1000 <= abs(value) < 1e9 else f"{value:.3g}"


def counted_share(count, among):
    """A count, and its share of others: two digits, whole numbers from 100 %."""
    if count == 0:
        return "0"
    share = count / among
    return f"{count} ({f'{100 * share:.2g}' if share < 0.995 else f'{100 * share:.0f}'} %)"


def markdown(columns, rows):
    """A table of Markdown; what could be markup is escaped."""
    def line(texts):
        return "| " + " | ".join(re.sub(r"[\\`*[\]<>|~&$]|(?<![^\W_])_|_(?![^\W_])|:(?=//)", r"\\\g<0>", str(text))
                                 for text in texts) + " |"
    return [line(columns), line(["---"] * len(columns)), *map(line, rows), ""]


# ---- Rows ------------------------------------------------------------------------------------------------------------


def rows_of(data):
    """The rows of all runs of a file of data, without those of steps."""
    return [row for run in data["runs"] for row in run["rows"] if "method" in row]


def place_of(row):
    return f"{row['source']}, {row['kind']}"


def grouped(rows, key):
    groups = {}
    for row in rows:
        groups.setdefault(key(row), []).append(row)
    return groups


def time_ratio(row):
    return None if row["ns_per_query"] is None else row["ns_per_query"] / row["certified_ns_per_query"]


def false_positive_rate(row):
    misses = row["judged"] - row["collisions"]
    return row["false_positives"] / misses if misses else 0.0


def error_of(row, which):
    return row["toi_error"] and row["toi_error"][which]


# ---- Tables ----------------------------------------------------------------------------------------------------------

COUNTS = ["FN", "FP", "µs", "÷ certified", "late", "asked", "collide", "at limit"]


def counts_of(row):
    late = row.get("late") or {"count": 0}
    return [row["false_negatives"], counted_share(row["false_positives"], row["judged"] - row["collisions"]),
            short(row["ns_per_query"] / 1000), short(time_ratio(row)),
            f"{late['count']}, ≤ {short(late['greatest'])}" if late["count"] else row["late_toi"],
            row["timed"] if row["timed"] == row["queries"] else f"{row['timed']} of {row['queries']}", row["collisions"],
            row["at_limit"]]


def table_of(title, rows, head, foot, published, numbers):
    """A table of rows of one place. head and foot are columns and their cells, before and behind the counts; numbers gives the
    published ones of a row and its place, if there are any."""
    place = place_of(rows[0] | {"source": published["stands_beside"].get(rows[0]["source"], rows[0]["source"])})
    size = published["sizes"].get(place)
    columns = [*head, *COUNTS, *foot] + ([f"published ({size}) µs", "published FP", "published FN"] if size else [])
    return [f"### {title}", "", *markdown(columns, [
        [*(cell(row) for cell in head.values()), *counts_of(row), *(cell(row) for cell in foot.values()),
         *((numbers(row, place) or [NONE] * 3) if size else [])] for row in rows])]


def field_tables(rows, published):
    """The paper's table 1, a table for each place."""
    foot = {f"toi error, {name}": lambda row, which=which: short(error_of(row, which)) for name, which in
            (("median", "p50"), ("max", "max"))}
    for place, of in grouped(rows, place_of).items():
        most = max(row["timed"] for row in of)
        yield from table_of(place, of, {"method": lambda row, most=most: row["method"] + "*" * (row["timed"] < most)}, foot,
                            published, lambda row, at: published["field"]["numbers"].get(row["method"], {}).get(at))


def separation_tables(rows, published, method):
    """The paper's tables over the minimum separation: of a method beside Tight-Inclusion and the certified solver."""
    def numbers(row, at):
        of = published["separation"]["numbers"].get(row["method"], {}).get(at, {})
        return of.get(f"{row['min_separation']:.0e}")

    head = {"d": lambda row: f"{row['min_separation']:.0e}", "method": lambda row: row["method"],
            "norm": lambda row: "L∞" if row["norm"] == "linf" else "L2"}
    for place, of in grouped(rows, place_of).items():
        chosen = [row for distance in published["distances"] for name in (method, "tight_inclusion", "certified") for row in of
                  if row["method"] == name and row["min_separation"] == distance]
        yield from table_of(place, chosen, head, {}, published, numbers)


def filter_tables(rows):
    """The contacts that Tight-Inclusion misses with each filter: contacts at t=1 by scale, and the families in which one of
    them misses some."""
    tables = {title: [] for title in (*CONTACTS.values(), "built-in families")}
    for (source, kind, level), of in grouped(rows, lambda row: (row["source"], row["kind"], row["level"])).items():
        is_family = level is None
        if is_family and not any(row["false_negatives"] for row in of):
            continue
        tables["built-in families" if is_family else CONTACTS[source]].append(
            [pathlib.Path(source).stem if is_family else f"{10.0 ** (level - 4):g}", kind, of[0]["collisions"],
             *(counted_share(row["false_negatives"], row["collisions"]) for row in of)])
    methods = [f"{name} FN" for name in dict.fromkeys(row["method"] for row in rows)]
    for title, lines in tables.items():
        first = "family" if title == "built-in families" else "scale"
        yield from (f"### {title}", "", *markdown([first, "kind", "collide", *methods], lines))


# ---- Sentences -------------------------------------------------------------------------------------------------------


def findings(rows):
    """A line for each group and kind."""
    for place, of in grouped(rows, place_of).items():
        def names(test, of=of):
            return ", ".join(f"`{row['method']}`" for row in of if test(row)) or "none"

        yield (f"- **{place}**: with false negatives: {names(lambda row: row['false_negatives'])}. "
               f"Without false positives: {names(lambda row: not row['false_positives'])}. Faster than `certified` on the same "
               "queries: " + names(lambda row: row["method"] != "certified" and row["ns_per_query"] is not None
                                   and row["ns_per_query"] < row["certified_ns_per_query"]) + ".")


def front_of(points):
    """The points (time, error, name) than which no other is as small in both and smaller in one, by ascending time."""
    return sorted((a for a in points if not any(b[0] <= a[0] and b[1] <= a[1] and b[:2] != a[:2] for b in points)),
                  key=lambda point: point[0])


def fronts(rows):
    """The methods on the Pareto fronts, each with its comparisons."""
    comparisons = {}
    for said, error in (("false positives", false_positive_rate),
                        ("error of the time of impact, median", lambda row: error_of(row, "p50")),
                        ("error of the time of impact, greatest", lambda row: error_of(row, "max"))):
        for place, of in grouped(rows, place_of).items():
            front = front_of([(row["ns_per_query"], float(error(row)), row["method"]) for row in of
                              if error(row) is not None and row["ns_per_query"] is not None
                              and not row["false_negatives"] and not row["late_toi"]])
            names = ", ".join(name for _, _, name in front) or "none"
            comparisons.setdefault(names, []).append(f"{said} ({place})")
    yield ("On the Pareto front of time against false positives and of time against the error of the time of impact, of those "
           "without a miss:")
    yield ""
    yield from (f"- {names}: {'; '.join(of)}" for names, of in sorted(comparisons.items()))


def differences(rows, published):
    measured = {row["method"] for row in rows}
    yield from (f"- {text}" for text in published["differences"]["general"])
    yield from (f"- `{method}`: {of['text']}" for method, of in published["differences"]["methods"].items() if method in measured)


def document(results, separations, filters, published):
    """The document in Markdown, of the three files of rows and the published numbers."""
    rows = rows_of(results)
    commands = dict.fromkeys(run["command"] for data in (results, separations, filters) for run in data["runs"])
    lines = ["# Results", "", "Written by `./run results`; not edited by hand. Made with Touchstone "
             f"{results['version']} on {results['machine']}, {results['date']} by", "", "```", *commands, "```", "",
             *([results["note"], ""] if "note" in results else []),
             f"The truth is the exact oracle's. Published: {published['work']}, on another machine.", "",
             "## In sentences", "", *findings(rows), "", *fronts(rows), "",
             "## Table 1: all methods", "", *field_tables(rows, published)]
    for number, (name, method) in enumerate((("MSRF", "msrf"), ("FPRF", "fprf")), 2):
        lines += [f"## Table {number}: {name} over the minimum separation d", "",
                  *separation_tables(rows_of(separations), published, method)]
    lines += ["## What Tight-Inclusion misses with each filter", "", published["filters"]["text"], "",
              published["filters"]["plainest_miss"]["text"], "", *filter_tables(rows_of(filters)),
              "## The columns", "", *(f"- {meaning}" for meaning in COLUMNS), "",
              "## Why the numbers differ from the published ones", "", *differences(rows, published), ""]
    return "\n".join(lines)
