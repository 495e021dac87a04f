#!/usr/bin/env python3
"""Writes the frame scenes (or, with --check, compares them with what stands here).

Steel, 1 m deep, storeys and bays of 2.5 m, members 0.1 m high. Beams run through; a column stands between the floor
or the beam below and the beam above, and is welded to both. Each member has four parts a bay, 9·bays + 4 joints a
storey. Beams are cut at the face of every inner column but one part's height aside: a node is one part, and no part
lies against another that it is not joined to.
"""
import json
import math
import pathlib
import re
import sys

BAY, HEIGHT, PARTS = 2.5, 0.1, 4
STEEL = {"density": 7800, "E": 200e9, "fy": 350e6, "fracture_strain": 0.2, "damping_ratio": 0.05, "friction": 0.2}


def number(x):
    return int(x) if x == int(x) else round(x, 10)


def box(x0, y0, x1, y1):
    return [[number(x), number(y)] for x, y in ((x0, y0), (x1, y0), (x1, y1), (x0, y1))]


def frame(storeys, bays):
    bodies = [{"name": "floor", "type": "static", "outline": box(-10, -1, bays * BAY + 10, 0)}]
    joints = []
    half = HEIGHT / 2
    for s in range(storeys):
        top = BAY * (s + 1)
        for i in range(bays + 1):
            x, low = BAY * i, BAY * s + (half if s > 0 else 0)
            name, below = f"column_{s}_{i}", f"beam_{s - 1}" if s > 0 else "floor"
            bodies.append({"name": name, "outline": box(x - half, low, x + half, top - half), "material": "steel",
                           "split": {"pieces": PARTS, "along": [[number(x), number(low)], [number(x), number(top - half)]]}})
            joints += [[below, name], [name, f"beam_{s}"]]
        cuts = []
        for k in range(1, bays * PARTS):
            x = BAY * k / PARTS - (HEIGHT if k % PARTS == 0 else 0)
            cuts.append([[number(x), number(top - HEIGHT)], [number(x), number(top + HEIGHT)]])
        bodies.append({"name": f"beam_{s}", "outline": box(-half, top - half, bays * BAY + half, top + half),
                       "material": "steel", "split": {"cuts": cuts}})
    return {"gravity": [0, -10], "sleep": False, "materials": {"steel": dict(STEEL)}, "bodies": bodies,
            "joints": [{"between": pair} for pair in joints]}


def with_bomb(scene, mass, speed, radius=0.5):
    """A ball from the left against the outer column of the second storey, halfway up."""
    distance = 3.0
    drop = 10 * (distance / speed) ** 2 / 2
    scene["materials"]["bomb"] = {"density": round(mass / (math.pi * radius**2), 6), "E": 200e9, "fy": 1e9}
    scene["bodies"].append({"name": "bomb", "outline": {"circle": radius}, "material": "bomb",
                            "at": [-HEIGHT / 2 - radius - distance, round(1.5 * BAY + drop, 6)], "velocity": [speed, 0]})
    return scene


def pushed(scene, storeys, force):
    """Slowly, at the left end of every storey's beam."""
    scene["gravity_ramp"] = 2
    scene["loads"] = [{"body": f"beam_{s}", "at": [-HEIGHT / 2, number(BAY * (s + 1))], "force": [force, 0], "ramp": 2}
                      for s in range(storeys)]
    return scene


def text(scene):
    """JSON with one line a body, a joint, a material; 200e9 rather than 200000000000.0."""
    parts = []
    for key, value in scene.items():
        if key == "materials":
            inner = ",\n".join(f"    {json.dumps(k)}: {json.dumps(v)}" for k, v in value.items())
            parts.append(f'  "{key}": {{\n{inner}\n  }}')
        elif key in ("bodies", "joints", "loads"):
            inner = ",\n".join("    " + json.dumps(v) for v in value)
            parts.append(f'  "{key}": [\n{inner}\n  ]')
        else:
            parts.append(f'  "{key}": {json.dumps(value)}')
    plain = "{\n" + ",\n".join(parts) + "\n}\n"
    return re.sub(r"(\d+?)((?:000){2,})\.0\b", lambda m: f"{m[1]}e{len(m[2])}", plain)


SCENES = {
    "frame": lambda: frame(4, 4),
    "frame_large": lambda: frame(15, 15),
    "frame_pushed": lambda: pushed(frame(4, 4), 4, 435_000),
    "frame_bomb": lambda: with_bomb(frame(4, 4), 2000, 30),
    "frame_heavy_bomb": lambda: with_bomb(frame(4, 4), 20000, 30),
}

if __name__ == "__main__":
    folder = pathlib.Path(__file__).parent
    stale = []
    for name, make in SCENES.items():
        file = folder / f"{name}.scene.json"
        if sys.argv[1:] == ["--check"]:
            if not file.exists() or file.read_text() != text(make()):
                stale.append(file.name)
        else:
            file.write_text(text(make()))
    if stale:
        sys.exit(f"not what frame.py writes: {', '.join(stale)}; run it without --check")
