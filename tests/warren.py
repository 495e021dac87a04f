"""A Warren girder of 8 m in two fields, as tests draw it in the window and in the page, and what its file says then."""
import json
import math
import subprocess

NODES = {"a": (-4, 2), "b": (0, 2), "c": (4, 2), "d": (-2, 4), "e": (2, 4)}
BEAMS = ["ab", "bc", "ad", "db", "be", "ec", "de"]
# In the order of the menu: what it is exported as, the file's ending, and what is in it.
EXPORTS = (("Box2D definitions", "box2d.json", '"beam1/0"'), ("C++ source", "cpp", "build_new(b2World"),
           ("R.U.B.E. level", "rube.json", '"joint"'), ("picture", "svg", "</svg>"), ("replay", "html", "</html>"))
LEFT = ["ab", "ad", "db"]  # the half that a mirror in x = 0 makes the whole of, without the upper chord


def ends_of(body):
    (x, y), angle = body["at"], body.get("angle", 0)
    span = body["outline"][1][0] - body["outline"][0][0]
    return tuple(sorted([(round(x, 6), round(y, 6)),
                         (round(x + span * math.cos(angle), 6), round(y + span * math.sin(angle), 6))]))


def is_in(file, command, verdict, load, area=0.2 * 0.1):
    """A saved scene is the girder on two supports, and the command checks it as the window did: its reserve is that of the
    `verdict`, and by statics each support carries half of all weight and of the `load`, N. `area`: of the beams' section, m²."""
    scene = json.loads(file.read_text())
    ends = [ends_of(body) for body in scene["bodies"][1:]]
    expected = [tuple(sorted(tuple(map(float, NODES[end])) for end in beam)) for beam in BEAMS]
    assert sorted(ends) == sorted(expected), ends
    checked = subprocess.run([command, "check", file, "--json"], capture_output=True, text=True)
    assert (checked.returncode, checked.stderr) == (0, ""), checked
    answer = json.loads(checked.stdout)
    assert answer["loose"] == [] and f"{answer['reserve']:.3g}" in verdict, (answer["reserve"], verdict)
    weight = 9.81 * 7850 * area * sum(math.dist(*beam) for beam in ends)  # steel
    supports = [joint for joint in answer["joints"] if joint["name"].startswith("support/")]
    assert len(supports) == 2, supports
    for joint in supports:
        force = math.hypot(joint["N"], joint["Q"])
        assert abs(force / ((weight + load) / 2) - 1) < 1e-6, (force, weight, load)
