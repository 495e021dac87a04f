"""Drawings that others made, opened as they are, and compared with what librsvg draws of them.

    drawings.py DUCTILE NODE_MODULES [--per-set N] [--json FILE]

A table: of every set, how many drawings open, how far the area of all their shapes together is from the rendered
one, and in how many the area of one shape is that of the same shape rendered alone, close up. Then how many single
shapes run through calibrate, check, limit and simulate. Ends with 1 where a share is below what is asked for (the
constants at the top), and with 77 where a tool or the sets are missing.
"""
import argparse
import concurrent.futures
import json
import re
import shutil
import struct
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as ElementTree
import zlib
from pathlib import Path

OPENED, WITHIN, ALONE, RUN = 0.95, 0.95, 0.95, 0.98  # of all drawings, of the opened ones, of single shapes twice
AREA_ERROR = 0.01
PIXELS = 384
SETS = {
    "bootstrap-icons": "bootstrap-icons/icons/*.svg",
    "@tabler/icons": "@tabler/icons/icons/*/*.svg",
    "@fortawesome": "@fortawesome/fontawesome-free/svgs/*/*.svg",
    "openmoji": "openmoji/color/svg/*.svg",
    "@discordapp/twemoji": "@discordapp/twemoji/dist/svg/*.svg",
    "@primer/octicons": "@primer/octicons/build/svg/*.svg",
    "feather-icons": "feather-icons/dist/icons/*.svg",
    "flag-icons": "flag-icons/flags/4x3/*.svg",
    "@mapbox/maki": "@mapbox/maki/icons/*.svg",
    "@carbon/icons": "@carbon/icons/svg/32/*.svg",
    "devicon": "devicon/icons/*/*.svg",
}
DEFINED = ("defs", "symbol", "clipPath", "mask", "pattern", "marker", "style")  # what is in these is shown elsewhere
# Paint is opaque steel here: what is half transparent counts whole.
OPAQUE = ("*{opacity:1!important;fill-opacity:1!important;stroke-opacity:1!important;stop-opacity:1!important;"
          "stop-color:#000!important;shape-rendering:geometricPrecision}")


def run(*command, timeout=120):
    try:
        done = subprocess.run(command, capture_output=True, timeout=timeout)
        return done.returncode, done.stdout, done.stderr.decode(errors="replace")
    except subprocess.TimeoutExpired:
        return -1, b"", f"takes more than {timeout} s"


def first_line(text):
    lines = [line for line in text.splitlines() if line and not line.startswith("warning:")]
    return lines[0] if lines else "no word"


def coverage(png):
    """The sum over all pixels of a PNG's alpha, of 1 each (PNG specification: colour type 6 of 8 bits, filters)."""
    at, data = 8, b""
    while at < len(png):
        size, kind = struct.unpack(">I4s", png[at:at + 8])
        if kind == b"IHDR":
            width, height, depth, colour = struct.unpack(">IIBB", png[at + 8:at + 18])
            if (depth, colour) == (8, 2):  # cairo leaves out an alpha that is whole everywhere
                return width * height
            if (depth, colour) != (8, 6):
                raise RuntimeError(f"a PNG of {depth} bits, colour type {colour}")
        if kind == b"IDAT":
            data += png[at + 8:at + 8 + size]
        at += size + 12
    rows, stride = zlib.decompress(data), 4 * width
    before, total = bytearray(width), 0
    for y in range(height):  # filters work by channels, so alpha can be taken alone
        start = y * (stride + 1)
        filter_kind, alpha = rows[start], bytearray(rows[start + 4:start + stride + 1:4])
        if filter_kind == 1:
            left = 0
            for x in range(width):
                left = alpha[x] = (alpha[x] + left) & 255
        elif filter_kind == 2:
            alpha = bytearray((a + b) & 255 for a, b in zip(alpha, before))
        elif filter_kind == 3:
            left = 0
            for x in range(width):
                left = alpha[x] = (alpha[x] + (left + before[x]) // 2) & 255
        elif filter_kind == 4:
            left = corner = 0
            for x in range(width):
                up = before[x]
                p = left + up - corner
                a, b, c = abs(p - left), abs(p - up), abs(p - corner)
                near = left if a <= b and a <= c else up if b <= c else corner
                left = alpha[x] = (alpha[x] + near) & 255
                corner = up
        total += sum(alpha)
        before = alpha
    return total / 255


def rendered(file, folder, name):
    sheet = folder / "opaque.css"
    code, png, error = run("rsvg-convert", "-w", str(PIXELS), "-h", str(PIXELS), "--stylesheet", str(sheet), str(file))
    if code:
        raise RuntimeError("librsvg: " + first_line(error))
    return coverage(png)


def box_of(file):
    root = ElementTree.parse(file).getroot()
    if "viewBox" in root.attrib:
        return [float(x) for x in re.split(r"[\s,]+", root.attrib["viewBox"].strip())]
    def pixels(text):  # CSS Values and Units §6.2
        number, unit = re.match(r"([\d.]+)\s*([a-z]*)", text).groups()
        return float(number) * {"in": 96, "cm": 96 / 2.54, "mm": 96 / 25.4, "pt": 96 / 72, "pc": 16}.get(unit, 1)

    return [0, 0, pixels(root.attrib.get("width", "300")), pixels(root.attrib.get("height", "150"))]


def drawn_again(scene, box, file):
    """The bodies of a scene (y up from the bottom of the page, 1 m a unit), as a drawing of the same page."""
    x, y, width, height = box
    bottom = y + height
    data = ""
    for body in scene["bodies"]:
        if body["name"] == "floor":
            continue
        data += '<path fill-rule="evenodd" d="'
        for ring in [body["outline"], *body.get("holes", [])]:
            data += "M" + "L".join(f"{px:.9g},{bottom - py:.9g}" for px, py in ring) + "Z"
        data += '"/>'
    file.write_text(f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="{x} {y} {width} {height}" width="{width}" '
                    f'height="{height}" preserveAspectRatio="none">{data}</svg>')


def try_drawing(ductile, file):
    """(what went wrong in one line or "", error of the area or None, the scene or None)"""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        (folder / "opaque.css").write_text(OPAQUE)
        out = folder / "a.scene.json"
        code, _, error = run(ductile, "calibrate", str(file), "--scale", "1", "--to", "scene", "--out", str(out))
        if code:
            return f"{code}: {first_line(error)}", None, None
        left_out = [line for line in error.splitlines() if "(left out)" in line]
        scene = json.loads(out.read_text())
        try:
            box = box_of(file)
            # Both stretched over the same pixels, whatever the page's shape.
            text = file.read_text()
            root = re.search(r"<svg\b[^>]*>", text)
            tag = re.sub(r'\s(width|height|preserveAspectRatio)="[^"]*"', "", root[0])
            if "viewBox" not in tag:
                tag = tag[:-1] + f' viewBox="{box[0]} {box[1]} {box[2]} {box[3]}">'
            tag = tag[:4] + f' width="{box[2]}" height="{box[3]}" preserveAspectRatio="none"' + tag[4:]
            (folder / "as_it_is.svg").write_text(text[:root.start()] + tag + text[root.end():])
            expected = rendered(folder / "as_it_is.svg", folder, "expected")
            drawn_again(scene, box, folder / "again.svg")
            area = rendered(folder / "again.svg", folder, "area")
        except (RuntimeError, ElementTree.ParseError) as error:
            return "", str(error), scene
        return left_out[0] if left_out else "", abs(area - expected) / max(expected, 1), scene


def local_name(element):
    return element.tag.rpartition("}")[2] if isinstance(element.tag, str) else ""


def area_of(body):
    def ring(points):
        return abs(sum(a[0] * b[1] - b[0] * a[1] for a, b in zip(points, points[1:] + points[:1]))) / 2

    return ring(body["outline"]) - sum(ring(hole) for hole in body.get("holes", []))


def try_alone(file, scene):
    """The name of one shape that is drawn where it stands, and the error of its area; none where all are copies."""
    root = ElementTree.parse(file).getroot()
    parents = {child: parent for parent in root.iter() for child in parent}

    def within(element, kinds):
        while element is not None and local_name(element) not in kinds:
            element = parents.get(element)
        return element is not None

    counts, named = {}, {}
    for element in root.iter():
        kind = local_name(element)
        if kind not in ("path", "rect", "circle", "ellipse", "line", "polyline", "polygon"):
            continue
        counts[kind] = counts.get(kind, 0) + 1
        if not within(element, DEFINED):
            title = next((child.text for child in element if local_name(child) == "title"), None)
            name = element.get("id") or element.get("aria-label") or title or f"{kind} {counts[kind]}"
            named.setdefault(re.sub("[/#-]", "_", name.strip()), []).append(element)
    for name, elements in sorted(named.items()):
        bodies = [body for body in scene["bodies"] if re.fullmatch(re.escape(name) + r"( \d+)?", body["name"])]
        if len(elements) > 1 or not bodies or name == "floor":
            continue
        for element in root.iter():
            if element is not elements[0] and not list(element) and not within(element, DEFINED):
                element.set("data-other", "")
        x, y = ([point[axis] for body in bodies for point in body["outline"]] for axis in (0, 1))
        margin = 0.05 * max(max(x) - min(x), max(y) - min(y))
        box = box_of(file)
        close = [min(x) - margin, box[1] + box[3] - max(y) - margin, max(x) - min(x) + 2 * margin,
                 max(y) - min(y) + 2 * margin]
        for key, value in (("viewBox", " ".join(map(str, close))), ("width", str(close[2])), ("height", str(close[3])),
                           ("preserveAspectRatio", "none")):
            root.set(key, value)
        with tempfile.TemporaryDirectory() as folder:
            folder = Path(folder)
            (folder / "opaque.css").write_text(OPAQUE + "[data-other]{visibility:hidden!important}")
            ElementTree.ElementTree(root).write(folder / "alone.svg")
            expected = rendered(folder / "alone.svg", folder, "alone") / PIXELS**2 * close[2] * close[3]
        return name, abs(sum(map(area_of, bodies)) - expected) / max(expected, 1e-6 * close[2] * close[3])
    return None


def try_shape(ductile, scene, name):
    """The one body of a scene through four commands; what went wrong in one line, or ""."""
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "shape.scene.json"
        bodies = [body for body in scene["bodies"] if body["name"] in ("floor", name)]
        foot = min((point for body in bodies if body["name"] == name for point in body["outline"]), key=lambda p: p[1])
        support = {"body": name, "at": foot, "fix": ["x", "y", "angle"]}
        file.write_text(json.dumps({**scene, "bodies": bodies, "supports": [support]}))
        for command in (["calibrate"], ["check"], ["limit"], ["simulate", "--time", "0.5"]):
            code, _, error = run(ductile, command[0], str(file), *command[1:], timeout=60)
            if code:
                return f"{command[0]} {code}: {first_line(error)}"
    return ""


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("ductile")
    parser.add_argument("node_modules", type=Path)
    parser.add_argument("--per-set", type=int, default=50)
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--json", type=Path)
    arguments = parser.parse_args()
    if not shutil.which("rsvg-convert") or not arguments.node_modules.is_dir():
        print("SKIPPED: needs rsvg-convert (Debian: librsvg2-bin) and the packages of package.json")
        return 77
    pool = concurrent.futures.ThreadPoolExecutor(arguments.jobs)
    failures, rows, shapes = [], [], []
    print(f"{'set':<22}{'drawings':>9}{'opened':>8}{'within 1 %':>11}{'worst':>8}"
          f"{'alone':>7}{'within 1 %':>11}{'worst':>8}")
    for title, pattern in SETS.items():
        files = sorted(arguments.node_modules.glob(pattern))
        files = files[::max(1, len(files) // arguments.per_set)][:arguments.per_set]
        results = list(pool.map(lambda file: try_drawing(arguments.ductile, file), files))
        opened = within = 0
        worst = 0.0
        for file, (wrong, error, scene) in zip(files, results):
            if scene is not None:
                opened += 1
                bodies = [body for body in scene["bodies"] if body["name"] != "floor"]
                shapes.append((f"{title}/{file.name}", scene, bodies[len(bodies) // 2]["name"]))
            if wrong:
                failures.append(f"{title}/{file.name}: {wrong}")
            if isinstance(error, float):
                within += error <= AREA_ERROR
                worst = max(worst, error)
                if error > AREA_ERROR:
                    failures.append(f"{title}/{file.name}: area is off by {100 * error:.1f} %")
            elif error:
                failures.append(f"{title}/{file.name}: not compared: {error}")
        drawn = [(file, scene) for file, (_, _, scene) in zip(files, results) if scene is not None]
        tried = pool.map(lambda one: try_alone(*one), drawn)
        errors = [(*one, file) for one, (file, _) in zip(tried, drawn) if one]
        failures += [f"{title}/{file.name}, shape {name!r}: area is off by {100 * error:.1f} %"
                     for name, error, file in errors if error > AREA_ERROR]
        rows.append((title, len(files), opened, within, worst, len(errors), sum(e[1] <= AREA_ERROR for e in errors),
                     max((e[1] for e in errors), default=0)))
        print(f"{title:<22}{len(files):>9}{opened:>8}{within:>11}{100 * worst:>6.1f} %{len(errors):>7}"
              f"{rows[-1][6]:>11}{100 * rows[-1][7]:>6.1f} %", flush=True)
    drawings, opened, within, alone, alone_within = (sum(row[i] for row in rows) for i in (1, 2, 3, 5, 6))
    print(f"{'all':<22}{drawings:>9}{opened:>8}{within:>11}{'':>8}{alone:>7}{alone_within:>11}")
    words = list(pool.map(lambda shape: try_shape(arguments.ductile, *shape[1:]), shapes))
    ran = sum(word == "" for word in words)
    failures += [f"{title}, shape {name!r}: {word}" for (title, _, name), word in zip(shapes, words) if word]
    print(f"\nsingle shapes through calibrate, check, limit, simulate: {ran} of {len(shapes)}\n")
    for failure in failures:
        print(failure)
    if arguments.json:
        arguments.json.write_text(json.dumps({"sets": rows, "ran": [ran, len(shapes)], "failures": failures}, indent=1))
    if drawings < 10 * len(SETS):
        print("too few drawings: what is missing?")
        return 1
    if 2 * alone < drawings:
        print("too few shapes compared alone: how are they named?")
        return 1
    return 0 if (opened >= OPENED * drawings and within >= WITHIN * opened and alone_within >= ALONE * alone
                 and ran >= RUN * len(shapes)) else 1


if __name__ == "__main__":
    sys.exit(main())
