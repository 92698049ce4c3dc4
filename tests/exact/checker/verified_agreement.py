"""Do touchstone-check and touchstone-check-verified agree?

On certificates that `touchstone prove` writes (the built-in set, random curves and, if TOUCHSTONE_DATA names them, the
public data, in all separations), on the same with their curves written otherwise, on the list of altered certificates, whose
outcomes it says, on those that `touchstone step` writes of small scenes of all kinds (and of the public steps), on those of meshes,
which are not covered, and on mutants of all. Equal are exit status and output. Of a proof that is rejected the verified program names the part; then the certificate has
to be the same, by its label.
"""

import argparse
import fractions
import itertools
import os
import pathlib
import random
import re
import subprocess
import sys
import tempfile

# Reasons of the verified program, which knows less of them.
UNPROVED = re.compile("the (subinterval|contact) is not proved|there is no subinterval|the (last )?subinterval does not .*")
# Which of several pairs without an argument is found first depends on the tree.
PAIR = re.compile(r"(no argument for \w+) \d+ \d+")
# The verified program proves `at axes` by a witness, and sees some contacts that the other does not see.
UNSEEN = "an axis separates, or is not seen not to"
SEPARATIONS = [(), ("1e-3", "linf"), ("1e-3", "l2"), ("0.5", "linf"), ("0.5", "l2")]
# Fewer than the rejections that are printed, so that all are.
BATCH = 90


def run(program, path, options):
    done = subprocess.run([program, *options, str(path)], capture_output=True, text=True, timeout=600)
    return done.returncode, done.stdout.splitlines()


def is_same(line, verified_line):
    if PAIR.sub(r"\1", line) == PAIR.sub(r"\1", verified_line):
        return True
    one, other = (re.fullmatch(r"  line \d+( \(.*?\))?: (.*)", text) for text in (line, verified_line))
    return bool(one and other) and UNPROVED.fullmatch(other[2]) and one[1] == other[1]


def without_unseen_axes(lines, verified_lines):
    """The lines of touchstone-check without the rejections of `at axes` that only it rejects."""
    labels = [re.search(r" \(.*?\): ", line) for line in verified_lines]
    rejected = {label[0] for label in labels if label}
    kept = []
    for line in lines:
        label = re.search(r" \(.*?\): ", line)
        if not (line.endswith(UNSEEN) and label and label[0] not in rejected):
            kept.append(line)
    return kept


class Result:
    """What both programs answered to a stream."""

    def __init__(self, programs, path, options=()):
        (status, lines), (verified_status, verified_lines) = (run(program, path, options) for program in programs)
        self.accepted = self.rejected = self.unseen = 0
        self.difference = None
        if path.read_bytes().startswith(b"touchstone-meshes"):
            if verified_status != 2:
                self.difference = f"status {verified_status} of certificates of meshes, which are not covered"
            return
        counts = next(k for k, line in enumerate(lines) if line.startswith("rejected")) + 1
        self.accepted, self.rejected = (int(lines[k].split()[1]) for k in (0, counts - 1))
        # Of steps none is read behind the first that is rejected.
        is_of_steps = path.read_bytes().startswith(b"touchstone-steps")
        reached, verified_reached = (int(re.search(r"line (\d+)|$", said[-1])[1] or 0) for said in (lines, verified_lines))
        if is_of_steps and lines[-1].endswith(UNSEEN) and (
                int(verified_lines[0].split()[1]) > self.accepted or verified_reached > reached):
            self.unseen = 1
            return
        kept = without_unseen_axes(lines, verified_lines)
        self.unseen = len(lines) - len(kept)
        if self.unseen:
            kept[:counts] = verified_lines[:counts]
        elif status != verified_status:
            self.difference = f"status {status} and {verified_status}"
        if len(kept) != len(verified_lines):
            self.difference = f"{kept[:6]} and {verified_lines[:6]}"
        for line, verified_line in zip(kept, verified_lines):
            if not is_same(line, verified_line):
                self.difference = self.difference or f"{line!r} and {verified_line!r}"


# ---- The list ----

def expanded(row):
    """The rows for each choice in {a|b}; {} is the choice again."""
    group = re.search(r"\{(.*?)\}", row)
    if not group:
        return [row]
    choices = group[1].split("|")
    return [one for choice in choices
            for one in expanded((row[:group.start()] + choice + row[group.end():]).replace("{}", choice))]


def query_lines(query):
    kind, points = query.split(" ", 1)
    ends = points.split(" > ") * (1 if " > " in points else 2)
    if kind == "over":
        kind, ends = "vertex_face", [end + ", 0 0 0, 4 0 0, 0 4 0" for end in ends]
    return ["touchstone-certificates 2", f"query {kind}"] + [f"point {p}" for end in ends for p in end.split(", ")]


def listed(path):
    """The certificates of the list, as texts without their header, each with True if it is accepted."""
    queries, last, is_after_row = [], "", False
    for line in path.read_text().splitlines():
        if not line or line.startswith("#") or " = " in line:
            continue
        is_row = line.startswith("  ")
        if not is_row:
            queries = (queries if not is_after_row else []) + expanded(line)
        is_after_row = is_row
        for query in queries if is_row else []:
            for row in expanded(line[2:]):
                row, arrow, _ = row.partition(" -> ")
                last = last if row.startswith("@") else row
                lines = query_lines(query) + last.split("; ") + ["end"]
                if row.startswith("@"):
                    number, text = row[1:].split(" ", 1)
                    text = re.sub(r"\\x(..)", lambda code: chr(int(code[1], 16)), text)
                    lines[int(number) - 1] = text.replace("; ", "\n")
                yield "\n".join(lines[1:]) + "\n", not arrow


def write_list(path, folder):
    """Write each certificate of the list as a stream, for the fuzzer to begin with."""
    folder.mkdir(exist_ok=True)
    for n, (text, _) in enumerate(listed(path)):
        stream = f"touchstone-certificates 2\n{text}certificates 1\n"
        (folder / f"{n}.cert").write_bytes(stream.encode("latin1"))


def list_results(programs, folder, path):
    """What both programs answer to the list, in the order of the expected outcomes."""
    certificates = list(listed(path))
    for accepted in (True, False):
        texts = [text for text, outcome in certificates if outcome == accepted]
        for first in range(0, len(texts), BATCH):
            # The query's label, if it has such a line.
            some = [re.sub("^(query .*\n)", rf"\g<1>label l{n}\n", text)
                    for n, text in enumerate(texts[first:first + BATCH])]
            count = sum(line.split(" ")[0] == "query" for text in some for line in text.split("\n"))
            stream = folder / "listed.cert"
            stream.write_bytes(("touchstone-certificates 2\n" + "".join(some) + f"certificates {count}\n").encode("latin1"))
            result = Result(programs, stream)
            if (result.rejected == 0) != accepted or (result.accepted == 0) == accepted:
                result.difference = f"{result.accepted} accepted and {result.rejected} refused of the list"
            yield result


# ---- Curves ----

GREATEST_DEGREE = 8


def write_random_curves(draw, folder, count):
    """Queries of all degrees, of rational curves up to 3 as the oracle is slow on others: files for `touchstone prove`."""
    starts = {"vf": [(1, 1, 0), (0, 0, 0), (4, 0, 0), (0, 4, 0)], "ee": [(-2, 0, 0), (2, 0, 0), (0, -2, 1), (0, 2, 1)]}
    folder.mkdir()
    for kind, points in starts.items():
        for form, greatest in (("degree", GREATEST_DEGREE), ("rational", 3)):
            for degree in range(greatest + 1):
                rows = [f"{form},{max(degree, 1)}"]
                for _ in range(count):
                    size = draw.choice([1, 2, 4])
                    for point in points:
                        for _ in range(degree + 1):
                            row = [x + size * draw.randint(-8, 8) / 4 for x in point]
                            rows.append(",".join(map(str, row + [draw.choice([0.5, 1, 2, 3])] * (form == "rational"))))
                    rows += rows[-4:] if degree == 0 else []  # at rest
                (folder / f"{form}{degree}_{kind}.csv").write_text("\n".join(rows) + "\n")


def number(word):
    return fractions.Fraction(float.fromhex(word)) if "x" in word else fractions.Fraction(word)


def curves_of(lines):
    """The first line of the points of a certificate, their control points (x, y, z, weight), and the line behind them."""
    begin = next(n for n, line in enumerate(lines) if line.startswith(("point", "curve", "rational")))
    end = next(n for n, line in enumerate(lines) if line.startswith(("separation", "claim")))
    curves = [[]]
    for line in lines[begin:end]:
        word, *words = line.split(" ")
        if word == "point":
            curves[-1].append(([number(word) for word in words] + [fractions.Fraction(1)])[:4])
        else:
            curves.append([])
    if curves[0]:  # straight lines: all points at t=0, then at t=1
        curves += [list(ends) for ends in zip(curves[0][:4], curves[0][4:])]
    return begin, curves[1:], end


def written_otherwise(draw, lines):
    """The certificate with points on the same curves of higher degrees, their weights multiplied by a number."""
    begin, curves, end = curves_of(lines)
    rewritten = []
    for control in curves:
        control = [[x * w for x in p] + [w] for *p, w in control]
        for _ in range(draw.choice([0, 0, 1, 2, GREATEST_DEGREE])):
            n = len(control)
            if n > GREATEST_DEGREE:
                break
            pairs = zip([control[0]] + control, control + [control[-1]])
            control = [[(k * x + (n - k) * y) / n for x, y in zip(p, q)] for k, (p, q) in enumerate(pairs)]
        size = fractions.Fraction(draw.choice([1, 1, 3]), draw.choice([1, 1, 7]))
        is_rational = size != 1 or any(w != 1 for *_, w in control)
        rewritten.append(f"{'rational' if is_rational else 'curve'} {len(control) - 1}")
        rewritten += [" ".join(map(str, ["point"] + [x / w for x in p] + [w * size] * is_rational)) for *p, w in control]
    return lines[:begin] + rewritten + lines[end:]


# ---- Mutants ----

FEATURES = ["vertex 0", "vertex 1", "edge 0 1", "edge 1 2", "face +", "face -", "axis x +", "axis z -",
            "cross y 0 1", "cross x 2 2"]
PLACES = ["triangle 0 1 2 x", "triangle 2 1 0 y", "triangle 0 2 3 z", "segment 0 1", "segment 1 1", "vertex 0",
          "vertex 2", "edge 0 1", "edge 2 0", "face", "axes", "plane"]


def changed_number(draw, word):
    digits = [i for i, c in enumerate(word) if c.isdigit()]
    kind = draw.randrange(6)
    if kind == 0 or not digits:
        return draw.choice(["0", "1", "-1", "1/2", "0x1p-1", "-0x1.8p+3", "1/0", "01", "0x1p+99999"])
    if kind == 1:
        return word[1:] if word.startswith("-") else "-" + word
    i = draw.choice(digits)
    return word[:i] + draw.choice("0123456789") + word[i + 1:]


CLAIMS = ["no_collision", "collision", "no_inversion", "inversion",
          *(f"time_of_{what} {times}" for what in ("impact", "inversion") for times in ("0 0", "1/4 1/2", "0 1"))]
STEP_CLAIMS = ["no_contact 0", "no_contact 1/2", "no_contact 1", "earliest 0 0", "earliest 0 1", "earliest 1/4 1/2"]


def mutant(draw, lines, claims=CLAIMS):
    """The certificate with one to three changes, but for its label."""
    lines = list(lines)
    for _ in range(draw.choice([1, 1, 1, 2, 3])):
        i = draw.randrange(len(lines))
        words = lines[i].split(" ")
        kind = draw.randrange(12)
        if words[0] == "label" or len(lines) < 4:
            continue
        if kind == 0:
            del lines[i]
        elif kind == 1:
            lines.insert(draw.randrange(1, len(lines)), lines[i])
        elif kind == 2 and words[0] == "separate":
            lines[i] = " ".join(words[:3] + [draw.choice(FEATURES)])
        elif kind <= 3 and words[0] == "at":
            lines[i] = "at " + draw.choice(PLACES)
        elif kind == 4 and words[0] == "claim":
            lines[i] = "claim " + draw.choice(claims)
        elif kind == 5:
            separation = f"separation {draw.choice(['0', '1', '1/1000', '0x1p-3'])} {draw.choice(['linf', 'l2'])}"
            places = [n for n, line in enumerate(lines) if line.startswith("separation ")]
            claim = [n for n, line in enumerate(lines) if line.startswith("claim")]
            if places:
                lines[places[0]] = separation
            elif claim:
                lines.insert(claim[0], separation)
        elif kind == 6 and words[0] == "query":
            lines[i] = draw.choice(["query vertex_face", "query edge_edge", "query tetrahedron"])
        elif kind == 6 and words[0] in ("curve", "rational"):
            lines[i] = " ".join([draw.choice(["curve", "rational"])] + words[1:])
        elif kind == 7 and words[0] == "point":
            j = draw.randrange(len(lines))
            if lines[j].startswith("point"):
                lines[i], lines[j] = lines[j], lines[i]
        elif len(words) > 1:
            j = draw.randrange(1, len(words))
            words[j] = changed_number(draw, words[j])
            lines[i] = " ".join(words)
    return lines


def certificates(path):
    """The certificates of a stream, as lists of lines."""
    found = []
    for line in path.read_text().splitlines()[1:-1]:
        if line.startswith("query"):
            found.append([])
        found[-1].append(line)
    return found


def without_label(lines):
    return [line for line in lines if not line.startswith("label")]


def write_stream(path, some, first=0):
    """Some certificates, each with a label of its own if it begins with its kind."""
    lines = ["touchstone-certificates 2"]
    for n, certificate in enumerate(some, first):
        place = 1 if certificate[0].startswith("query") else 0
        lines += certificate[:place] + [f"label m{n}"] * place + without_label(certificate[place:])
    lines.append(f"certificates {sum(line.startswith('query') for line in lines)}")
    path.write_text("\n".join(lines) + "\n")


def stream_results(programs, path, some):
    """What both programs answer to many certificates; streams on which they differ are kept."""
    some = iter(some)
    for first in itertools.count(0, BATCH):
        batch = list(itertools.islice(some, BATCH))
        if not batch:
            return
        write_stream(path, batch, first)
        result = Result(programs, path)
        if result.difference:
            kept = pathlib.Path(f"different-{first}.cert")
            kept.write_bytes(path.read_bytes())
            print(f"  kept: {kept}")
        yield result


# ---- Steps ----

def scene(draw, folder):
    """Write two frames of a small scene of all kinds of elements; the arguments of touchstone step."""
    grid, bodies, size = draw.choice([4, 16, 1000]), draw.randint(2, 4), draw.choice([0.5, 1, 2])
    vertices, lines = [], []
    for body in range(bodies):
        first, count = len(vertices), draw.choice([1, 2, 3, 4, 5])
        base, move = ([draw.uniform(-size, size) for _ in range(3)] for _ in range(2))
        for _ in range(count):
            start = [round((x + draw.uniform(-1, 1)) * grid) / grid for x in base]
            vertices.append((start, [round((x + m + draw.uniform(-.2, .2)) * grid) / grid for x, m in zip(start, move)]))
        lines.append(f"g g{body % 3}")
        kinds = [("f", 3), ("f", 3), ("l", 2), ("p", 1)] if count > 2 else [("l", 2), ("p", 1)] if count > 1 else [("p", 1)]
        for kind, corners in kinds[:1] + [kind for kind in kinds[1:] if draw.random() < .5]:
            lines.append(" ".join([kind] + [str(first + 1 + i) for i in draw.sample(range(count), corners)]))
    for end in range(2):
        text = "".join("v " + " ".join(map(repr, vertex[end])) + "\n" for vertex in vertices)
        (folder / f"{end}.obj").write_text(text + "\n".join(lines) + "\n")
    options = draw.choice([[], ["--min-separation", "0.125"], ["--min-separation", "0.01", "--norm", "l2"]])
    if draw.random() < .4:
        (folder / "radii").write_text("".join(f"g{body},{0.1 / (body + 1)}\n" for body in range(min(bodies, 3))))
        options = options + ["--radii", folder / "radii"]
    if draw.random() < .3:
        (folder / "separations").write_text("g0,g1,0.3\n")
        options = options + ["--separations", folder / "separations"]
    if draw.random() < .3:
        options = options + ["--apart", *draw.sample(["g0", "g1"], 2)]
    return [folder / "0.obj", folder / "1.obj", *options]


def prove_step(tool, arguments, path):
    done = subprocess.run([tool, "step", *arguments, "--no-intersections", "--threads", "1", "--prove", path],
                          capture_output=True, text=True)
    if done.returncode > 1:
        sys.exit(f"touchstone step: {done.stderr}")


# What is demanded of mutants of steps.
DEMANDS = [(), (), ("--claim", "free"), ("--claim", "sequence"), ("--claim", "free", "--rules", "1 pair of groups held apart"),
           ("--rules", "1 vertex left out"), ("--separation", "0"), ("--separation", "0", "--norm", "l2"),
           ("--separation", "0.125")]


def at_rest(draw, body):
    """The step behind this one in which nothing moves, or in which one number of the scene is another."""
    body = list(body)
    first, count = 2, int(body[1].split(" ")[1])
    for n in range(first, first + count):
        body[n] = " ".join(body[n].split(" ")[3:] * 2)
    if draw.random() < .3:
        n = draw.randrange(1, next(n for n, line in enumerate(body) if line.startswith("separation ")))
        body[n] = " ".join([*body[n].split(" ")[:-1], changed_number(draw, body[n].split(" ")[-1])])
    return body


def sequence(draw, streams):
    """A stream of one to three steps of others, some of which begin where the last one ended."""
    bodies = [draw.choice(streams)[1:-1] for _ in range(draw.choice([1, 1, 2]))]
    if draw.random() < .5 and sum(line.startswith("step") for line in bodies[-1]) == 1:
        bodies.append(at_rest(draw, bodies[-1]))
    lines = [line for body in bodies for line in body]
    return ["touchstone-steps 2", *lines, f"steps {sum(line.split(' ')[0] == 'step' for line in lines)}"]


# A vertex that falls onto a face, from START to END.
FALL = ("step\nvertices 4\n0 0 1 0 0 1\n4 0 1 4 0 1\n0 4 1 0 4 1\n1 1 START 1 1 END\nfaces 1\n0 1 2\nedges 0\npoints 1\n3\n"
        "groups 0\napart 0\nradii 0\nseparations 0\nseparation 0 linf\nclaim no_contact 1\nsweep x\nvertex_face\n3 0\n"
        "separate 0 1 face +\nedge_edge\nvertex_edge\nvertex_vertex\nend\n")


def fall(start, end, text="", instead=""):
    return FALL.replace("START", start).replace("END", end).replace(text, instead)


def shifted_contact(programs, folder):
    """A vertex that falls onto a face: it ends one unit in the last place above it, and on it. Both programs accept the one, refuse the other."""
    for end, status in (("0x1.0000000000001p+0", 0), ("0x1p+0", 1), ("0x1.fffffffffffffp-1", 1)):
        path = folder / "shifted.cert"
        path.write_text(f"touchstone-steps 2\n{fall('3', end)}steps 1\n")
        result = Result(programs, path)
        if result.accepted != (status == 0):
            result.difference = f"end {end}: {result.accepted} accepted"
        yield result


def gaps(programs, folder):
    """Two steps of the fall, the second one of which begins where the first one ends, or has another number in one of its lists."""
    path = folder / "gaps.cert"
    for follows, start, text, instead in (
            (True, "2", "", ""), (True, "2", "separation 0", "separation 1/8"), (False, "0x1.0000000000001p+1", "", ""),
            (False, "2", "4 0 1 4", "0x1.0000000000001p+2 0 1 4"),
            (False, "2", "\n0 1 2", "\n1 2 0"), (False, "2", "edges 0", "edges 1\n0 1"), (False, "2", "points 1", "points 2\n3"),
            (False, "2", "groups 0", "groups 4\n0\n0\n0\n0"), (False, "2", "apart 0", "apart 1\n0 1"),
            (False, "2", "radii 0", "radii 1\n0"), (False, "2", "separations 0", "separations 1\n0 0 0")):
        path.write_text(f"touchstone-steps 2\n{fall('3', '2')}{fall(start, '0x1.8p+0', text, instead)}steps 2\n")
        result = Result(programs, path)
        said = run(programs[1], path, ())[1][-1]
        if result.accepted != 2 or not said.startswith("2 steps, each " + ("from" if follows else "by itself")):
            result.difference = result.difference or f"{text!r}, {instead!r}: {said!r}"
        yield result


# ---- The comparison ----

def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--programs", default="build/release", help="folder of touchstone and touchstone-check")
    parser.add_argument("--verified", default="build/verified/touchstone-check-verified")
    parser.add_argument("--count", type=int, default=20, help="queries of each built-in family and kind")
    parser.add_argument("--mutants", type=int, default=10_000)
    parser.add_argument("--step-mutants", type=int, default=2_000)
    parser.add_argument("--seed", type=int, default=2021)
    parser.add_argument("--no-data", action="store_true", help="leave out the public data")
    parser.add_argument("--write-list", type=pathlib.Path, metavar="FOLDER", help="write the list there, and nothing else")
    arguments = parser.parse_args()
    cases = pathlib.Path(__file__).parent
    if arguments.write_list:
        return write_list(cases / "certificates.txt", arguments.write_list)
    tool = f"{arguments.programs}/touchstone"
    programs = (f"{arguments.programs}/touchstone-check", arguments.verified)
    draw = random.Random(arguments.seed)
    data = os.environ.get("TOUCHSTONE_DATA", "")
    count = ["--count", str(arguments.count)]
    sources = [("built-in set", count), ("built-in curves", ["--degree", "2", "--degree", "3", "--degree", "rational", *count])]
    if data and not arguments.no_data:
        sources += [(name, [f"{data}/{name}"]) for name in ("handcrafted", "simulation")]
    differences = 0

    def report(name, results):
        nonlocal differences
        found = [result.difference for result in results if result.difference]
        differences += len(found)
        accepted, rejected, unseen = (
            sum(getattr(result, count) for result in results) for count in ("accepted", "rejected", "unseen"))
        print(f"{name:44} {accepted:9,} {rejected:9,} {unseen:13,} {len(found):11}", flush=True)
        for text in found[:5]:
            print("  " + text)

    print(f"{'certificates':44} {'accepted':>9} {'rejected':>9} {'verified only':>13} {'differences':>11}")
    with tempfile.TemporaryDirectory() as folder:
        path = pathlib.Path(folder) / "some.cert"
        originals, curved = [], []
        write_random_curves(draw, pathlib.Path(folder) / "curves", 1 + arguments.count // 10)
        for name, source in sources + [("random curves", [f"{folder}/curves"])]:
            for separation in SEPARATIONS:
                for claim in ("time_of_impact", "collision"):
                    options = ["--claim", claim]
                    if separation:
                        options += ["--min-separation", separation[0], "--norm", separation[1]]
                    done = subprocess.run([tool, "prove", *source, *options, "--threads", "1", "--prove", path],
                                          capture_output=True, text=True)
                    if done.returncode != 0:
                        sys.exit(f"touchstone prove: {done.stderr}")
                    of = " ".join(separation) or "contact"
                    report(f"{name}, {of}, {claim}", [Result(programs, path)])
                    if name == "built-in set":
                        originals += certificates(path)
                    elif name.endswith("curves"):
                        curved += certificates(path)
        report("list of altered certificates",
               list(list_results(programs, pathlib.Path(folder), cases / "certificates.txt")))
        report("not covered: meshes", [Result(programs, cases / "corpus/meshes.cert")])
        rewritten = [written_otherwise(draw, draw.choice(curved)) for _ in range(10 * arguments.count)]
        results = list(stream_results(programs, path, rewritten))
        for result in results:
            if result.rejected > 0:
                result.difference = result.difference or f"{result.rejected} refused"
        report("curves written otherwise", results)
        cells = [text.splitlines() for text, outcome in listed(cases / "certificates.txt")
                    if outcome and text.startswith("query tetrahedron")]
        for name, some, count in (("mutants", originals, arguments.mutants), ("mutants of curves", curved, arguments.mutants),
                                  ("mutants of tetrahedra", cells, arguments.mutants // 5),
                                  ("mutants of curves written otherwise", rewritten, arguments.mutants // 50)):
            mutants = (mutant(draw, without_label(draw.choice(some))) for _ in range(count))
            report(name, list(stream_results(programs, path, mutants)))
        report("a contact shifted in", list(shifted_contact(programs, pathlib.Path(folder))))
        report("gaps between steps", list(gaps(programs, pathlib.Path(folder))))
        steps, results = [(cases / "corpus/steps.cert").read_text().splitlines()], [Result(programs, cases / "corpus/steps.cert")]
        for n in range(10 * arguments.count):
            prove_step(tool, [*scene(draw, pathlib.Path(folder)), draw.choice(["--free", "--earliest"])], path)
            if path.exists():
                steps.append(path.read_text().splitlines())
                results.append(Result(programs, path))
                path.unlink()
        report("steps of small scenes", results)
        if data and not arguments.no_data:
            results = []
            for frames in sorted(pathlib.Path(data).glob("simulation/*/frames")):
                prove_step(tool, [*sorted(frames.glob("*.ply")), "--earliest"], path)
                results.append(Result(programs, path))
            report("public steps", results)
        results = []
        for n in range(arguments.step_mutants):
            lines = sequence(draw, steps)
            path.write_text("\n".join(mutant(draw, lines, STEP_CLAIMS) if n % 3 else lines) + "\n")
            results.append(Result(programs, path, draw.choice(DEMANDS)))
            if results[-1].difference:
                pathlib.Path(f"different-step-{n}.cert").write_bytes(path.read_bytes())
        report("mutants of steps", results)
    sys.exit(1 if differences else 0)


if __name__ == "__main__":
    main()
