"""A bridge from nothing in the window of `ductile view`, by pointer alone and by keys alone.

    make_test.py COMMAND SCENES      exit 77: no window can be opened here
"""
import json
import math
import shutil
import sys
import tempfile
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))
import driven  # noqa: E402
import warren  # noqa: E402
import xwindow  # noqa: E402
from warren import BEAMS, NODES  # noqa: E402

COMMAND, SCENES = sys.argv[1], Path(sys.argv[2])

def setUpModule():
    global screen
    screen = xwindow.Screen(2560, 1440)


def tearDownModule():
    screen.close()


class Bridge(driven.Window):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.path = Path(self.folder.name)
        shutil.copy(SCENES / "cantilever.scene.json", self.path)
        self.open(COMMAND, screen, self.path / "cantilever.scene.json")

    def tearDown(self):
        self.close()
        self.folder.cleanup()

    def bodies(self):
        return {name.split("/")[0] for name in self.state["pieces"]} - {"floor"}

    def at(self, x, y):
        """A point of the world, px."""
        state = self.state
        x0, y0, x1, y1 = state["view"]
        return ((x0 + x1) / 2 + (x - state["centre"][0]) * state["scale"],
                (y0 + y1) / 2 - (y - state["centre"][1]) * state["scale"])

    def go(self, *to):
        """The cursor, by arrows, which repeat where frames take long."""
        for axis, back, on in ((0, "Left", "Right"), (1, "Down", "Up")):
            while abs(off := to[axis] - self.state["cursor"][axis]) > 1e-9:
                self.key(on if off > 0 else back)

    def is_the_bridge(self, load, **section):
        self.assertFalse(self.state["changed"])
        self.assertIn("Saved", self.state["message"])
        warren.is_in(self.path / "new.scene.json", COMMAND, self.state["verdict"], load, **section)

    def test_by_pointer_alone(self):
        self.control("tab make")
        self.control("new")
        self.wait(lambda: self.state["file"] == str(self.path / "new.scene.json"))
        self.assertEqual((self.state["tool"], self.bodies()), (1, set()))
        for beam in BEAMS:
            start, end = (self.at(*NODES[node]) for node in beam)
            self.drag(start, (end[0] + 2, end[1] - 1))  # it snaps
        self.assertEqual(len(self.bodies()), 7)
        self.assertIn("no joint holds", self.state["verdict"])
        self.control("tool support")
        self.click(self.at(*NODES["a"]))
        self.click(self.at(*NODES["c"]))
        self.click(self.at(*NODES["c"]))  # a roller
        self.assertTrue(self.state["verdict"].startswith("yields at"), self.state["verdict"])
        before = self.state["usage"]
        self.assertGreater(before, 0)
        self.control("tool load")
        self.click(self.at(*NODES["b"]))
        self.assertGreater(self.state["usage"], before)
        # Moved and back, deleted and back.
        self.control("tool move")
        loaded = self.state["usage"]
        self.drag(self.at(*NODES["d"]), self.at(-2, 6))
        self.assertNotEqual(self.state["usage"], loaded)
        self.control("undo")
        self.assertEqual(self.state["usage"], loaded)
        self.control("tool delete")
        self.click(self.at(0, 4))
        self.assertEqual(len(self.bodies()), 6)
        self.control("undo")
        self.control("redo")
        self.control("undo")
        self.assertEqual(len(self.bodies()), 7)
        # Run, and once more under what breaks it.
        self.control("play")
        self.wait(lambda: self.state["step"] > 20)
        self.assertEqual(self.state["events"], 0)
        self.control("play")
        self.control("restart")
        self.control("tool load")
        self.control("load force", 0.75)
        self.click(self.at(*NODES["b"]))
        self.assertEqual(self.state["usage"], 1)  # it yields
        self.control("play")
        self.wait(lambda: self.state["broken"] > 0)
        self.control("play")
        self.control("undo")
        self.control("save")
        self.is_the_bridge(load=100e3)
        # For other programs and people, run again.
        self.control("play")
        self.wait(lambda: self.state["step"] > 20)
        self.control("play")
        for name, ending, word in warren.EXPORTS:
            self.control("export")
            self.control("export " + name)
            file = self.path / f"new.{ending}"
            self.wait(lambda: str(file) in self.state["message"])
            self.assertIn(word, file.read_text())
        self.wait(lambda: not self.state["message"])  # good news goes away

    def test_by_keys_alone(self):
        def go(node):
            self.go(*NODES[node])

        self.key("n", "Control_L")
        self.wait(lambda: self.state["file"] == str(self.path / "new.scene.json"))
        for beam in BEAMS:
            go(beam[0])
            self.key("Return")
            go(beam[1])
            self.key("Return")
        self.assertEqual(len(self.bodies()), 7)
        self.key("Return")  # begun, and given up
        self.key("Up")
        self.key("Escape")
        self.assertEqual((self.state["tool"], len(self.bodies())), (1, 7))
        self.key("3")
        while self.state["cursor"] != [-4, 2]:
            self.key("q")
        self.key("Return")
        self.key("q")  # around to the last
        self.assertEqual(self.state["cursor"], [4, 2])
        self.key("Return")
        self.key("Return")
        self.assertTrue(self.state["verdict"].startswith("yields at"), self.state["verdict"])
        self.key("4")
        go("b")
        self.key("Return")
        self.key("5")
        go("e")
        self.key("Return")
        self.key("Right")
        self.key("Return")
        self.key("z", "Control_L")
        self.key("6")
        go("e")
        self.key("Return")
        self.assertEqual(len(self.bodies()), 6)
        self.key("z", "Control_L")
        self.assertEqual(len(self.bodies()), 7)
        self.key("p")
        self.pause_at(20)
        self.assertEqual(self.state["events"], 0)
        self.key("r")
        # Under what bends and breaks it, whose number is typed.
        self.key("4")
        go("b")
        self.reach("load force")
        self.key("Return")
        self.type("20 MN")
        self.key("Return")
        self.key("Escape")
        self.assertEqual((self.state["focus"], self.state["usage"] < 1), ("", True))
        self.key("Return")
        self.assertEqual(self.state["usage"], 1)  # it yields
        self.key("p")
        self.wait(lambda: self.state["broken"] > 0)
        self.key("p")
        self.key("z", "Control_L")
        self.key("s", "Control_L")
        self.is_the_bridge(load=100e3)
        for number, (_, ending, word) in enumerate(warren.EXPORTS, 1):
            self.key("e", "Control_L")
            self.key(str(number))
            file = self.path / f"new.{ending}"
            self.wait(lambda: str(file) in self.state["message"])
            self.assertIn(word, file.read_text())

    def test_half_of_it_mirrored(self):
        """Of HEB 100, chosen by its name, and pinned where the halves meet."""
        self.control("tab make")
        self.control("new")
        self.wait(lambda: self.state["file"] == str(self.path / "new.scene.json"))
        self.control("beam section", 0.2)
        self.wait(lambda: "section name" in self.state["controls"])
        for letter in "heb100":
            self.key(letter)
        self.key("Return")
        for beam in warren.LEFT:
            self.drag(*(self.at(*NODES[node]) for node in beam))
        self.control("tool support")
        self.click(self.at(*NODES["a"]))
        self.click(self.at(*NODES["a"]))  # a roller
        self.control("tool choose")
        self.drag(self.at(-4.5, 1.5), self.at(0.5, 4.5))
        self.assertEqual(len(self.state["chosen"]), 3)
        self.control("mirror")
        self.click(self.at(0, 3))
        self.assertEqual(len(self.bodies()), 6)
        self.control("undo")
        self.assertEqual(len(self.bodies()), 3)
        self.control("redo")
        self.control("tool beam")
        self.drag(self.at(*NODES["d"]), self.at(*NODES["e"]))
        self.control("tool support")
        self.click(self.at(*NODES["c"]))  # what was a roller
        self.click(self.at(*NODES["c"]))
        self.click(self.at(*NODES["c"]))
        self.click(self.at(*NODES["c"]))  # a hinge
        self.assertTrue(self.state["verdict"].startswith("yields at"), self.state["verdict"])
        self.control("save")
        # EN 10365: flanges of 100 by 10 mm, a web of 6 mm, fillets of 12 mm.
        self.is_the_bridge(load=0, area=2 * 0.1 * 0.01 + 0.08 * 0.006 + (4 - math.pi) * 0.012**2)

    def test_a_road_between_banks_that_a_vehicle_is_to_cross(self):
        """A beam of 0.2 by 0.1 m and 8 m between two polygons, of S355; what it bears by M = b h²/4 f_y."""
        span, plastic = 8, 0.1 * 0.2**2 / 4 * 355e6
        weight = 9.81 * 7850 * 0.2 * 0.1
        self.control("tab make")
        self.control("new")
        self.wait(lambda: self.state["file"] == str(self.path / "new.scene.json"))
        self.control("tool block")
        for side in -1, 1:
            corners = [(4 * side, 0), (8 * side, 0), (8 * side, 3), (4 * side, 3)]
            for corner in corners + corners[-1:]:
                self.click(self.at(*corner))
        self.assertEqual(self.bodies(), {"block1", "block2"})
        self.control("tool beam")
        self.drag(self.at(-4, 3), self.at(4, 3))
        self.assertTrue(self.state["verdict"].startswith("yields at"), self.state["verdict"])
        self.key("k")
        self.assertAlmostEqual(self.state["collapse"] / (plastic / (weight * span**2 / 8)), 1, 6)
        self.key("k")
        self.assertIsNone(self.state["collapse"])
        self.key("i")  # diagrams
        self.key("u")  # and peaks
        # It bears what is a tenth of its own weight, and not what is much heavier.
        self.key("v")
        self.assertEqual(self.state["tool"], 0)
        self.wait(lambda: self.state["crossing"] == "the vehicle is across")
        self.assertEqual(self.state["events"], 0)
        self.control("mass", 0.53)  # some 100 t
        self.control("vehicle")
        self.wait(lambda: self.state["crossing"] == "the vehicle is down")
        self.assertGreater(self.state["events"], 0)
        self.control("restart")
        self.assertEqual(self.state["crossing"], "")
        # As deep as it must be under a load in its middle.
        self.key("4")
        self.click(self.at(0, 3))
        self.key("1")
        self.click(self.at(-2, 3))
        self.control("tab edit")
        self.control("size for reserve")
        self.assertIn("has a reserve of 1.5", self.state["message"])
        self.key("s", "Control_L")
        depth = next(body["depth"] for body in json.loads((self.path / "new.scene.json").read_text())["bodies"]
                     if body["name"] == "beam1")
        bears, asks = plastic / 0.1, 1.5 * weight / 0.1 * span**2 / 8  # N m for each m of depth
        self.assertAlmostEqual(depth / (1.5 * 100e3 * span / 4 / (bears - asks)), 1, 6)

    def test_opens_what_a_folder_has_and_what_was_opened_last(self):
        (self.path / "more").mkdir()
        shutil.copy(SCENES / "CS1.scene.json", self.path / "more")
        (self.path / "more" / "notes.txt").touch()
        self.key("o", "Control_L")
        self.wait(lambda: "open more/" in self.state["controls"])
        self.type("mor")
        self.key("Return")
        self.wait(lambda: "open CS1.scene.json" in self.state["controls"])
        self.assertNotIn("open notes.txt", self.state["controls"])
        self.type("cs")
        self.key("Return")
        self.wait(lambda: self.state["file"] == str(self.path / "more" / "CS1.scene.json"))
        self.key("o", "Control_L")
        self.control("open cantilever.scene.json##recent")
        self.wait(lambda: self.state["file"] == str(self.path / "cantilever.scene.json"))
        kept = (Path(self.kept.name) / "ductile" / "recent").read_text().splitlines()
        self.assertEqual(kept, [str(self.path / "cantilever.scene.json"), str(self.path / "more" / "CS1.scene.json")])
        self.key("o", "Control_L")
        self.wait(lambda: "open filter" in self.state["controls"])
        self.key("Escape")
        self.wait(lambda: "open filter" not in self.state["controls"])

    def make_a_column_by_keys(self):
        """In a new scene: beam1, from (0, 0) to (0, 2), chosen."""
        self.key("n", "Control_L")
        self.wait(lambda: self.state["file"] == str(self.path / "new.scene.json"))
        self.key("Return")
        self.go(0, 2)
        self.key("Return")
        self.key("9")
        self.key("Return")
        self.key("Return")

    def test_turned_by_an_angle_that_is_typed(self):
        self.make_a_column_by_keys()
        self.key("t", "Control_L")
        self.reach("turn angle")
        self.key("Return")
        self.type("30")
        self.key("Return")
        self.key("Escape")
        self.key("Return")  # about (0, 2)
        self.key("Return")
        self.assertEqual(self.state["chosen"], ["beam1"])
        self.key("s", "Control_L")
        beam = json.loads((self.path / "new.scene.json").read_text())["bodies"][1]
        self.assertAlmostEqual(beam["angle"], math.radians(90 + 30), 9)
        for here, expected in zip(beam["at"], (2 * math.sin(math.radians(30)), 2 - 2 * math.cos(math.radians(30)))):
            self.assertAlmostEqual(here, expected, 9)

    def test_grouped_it_is_moved_as_one_and_costs_what_its_mass_does(self):
        self.control("tab make")
        self.control("new")
        self.wait(lambda: self.state["file"] == str(self.path / "new.scene.json"))
        self.drag(self.at(-4, 2), self.at(-2, 2))
        self.drag(self.at(1, 2), self.at(3, 2))
        self.control("tool choose")
        self.drag(self.at(-4.5, 1.5), self.at(3.5, 2.5))
        self.assertEqual(len(self.state["chosen"]), 2)
        self.key("g", "Control_L")
        self.click(self.at(-3, 2))
        self.assertEqual(sorted(self.state["chosen"]), ["beam1", "beam2"])
        self.click(self.at(0, 6))  # nothing
        self.assertEqual(self.state["chosen"], [])
        self.control("tool move")
        self.drag(self.at(2, 2), self.at(2, 3))
        self.key("s", "Control_L")

        def ends():
            bodies = json.loads((self.path / "new.scene.json").read_text())["bodies"]
            return [warren.ends_of(body) for body in bodies if body["name"] != "floor"]

        self.assertEqual(ends(), [((-4, 3), (-2, 3)), ((1, 3), (3, 3))])
        self.control("tool choose")
        self.click(self.at(-3, 3))
        self.key("g", "Control_L", "Shift_L")
        self.click(self.at(-3, 3))
        self.assertEqual(self.state["chosen"], ["beam1"])
        self.assertEqual(self.state["cost"], 0)
        self.reach("price")
        self.key("Return")
        self.type("1.5")
        self.key("Return")
        self.key("Escape")
        costs = 1.5 * 7850 * 2 * 2 * 0.2 * 0.1
        self.assertAlmostEqual(self.state["cost"] / costs, 1, 9)
        # Its file keeps both.
        self.key("z", "Control_L")
        self.key("z", "Control_L")
        self.assertEqual(self.state["cost"], 0)
        self.key("y", "Control_L")
        self.key("y", "Control_L")
        self.click(self.at(-3, 3))
        self.click(self.at(2, 3), "Shift_L")
        self.assertEqual(self.state["chosen"], ["beam1", "beam2"])
        self.key("g", "Control_L")
        self.key("s", "Control_L")
        self.key("bracketright")
        self.wait(lambda: self.state["file"] == str(self.path / "cantilever.scene.json"))
        self.key("o", "Control_L")
        self.control("open new.scene.json##recent")
        self.wait(lambda: self.state["file"] == str(self.path / "new.scene.json"))
        self.assertAlmostEqual(self.state["cost"] / costs, 1, 9)
        self.key("9")
        self.click(self.at(-3, 3))
        self.assertEqual(sorted(self.state["chosen"]), ["beam1", "beam2"])

    def test_turned_by_its_grip(self):
        """A beam of 2 m about its middle, from lying to standing; 28 px above it is the grip, at a scale of a half 14."""
        self.control("tab make")
        self.control("new")
        self.wait(lambda: self.state["file"] == str(self.path / "new.scene.json"))
        self.drag(self.at(1, 3), self.at(3, 3))
        self.control("tool choose")
        self.click(self.at(1.5, 3))
        (x, y), right = self.at(2, 3), self.at(4, 3)
        self.drag((x, y - 14), (right[0], y))  # by 90°
        self.key("s", "Control_L")
        beam = json.loads((self.path / "new.scene.json").read_text())["bodies"][1]
        self.assertEqual(warren.ends_of(beam), ((2, 2), (2, 4)))

    def test_imports_a_drawing_beside_what_is_there(self):
        (self.path / "plate.svg").write_text('<svg xmlns="http://www.w3.org/2000/svg" width="2000mm" height="1000mm" '
                                             'viewBox="0 0 2 1"><rect id="plate" width="2" height="1"/></svg>')
        self.make_a_column_by_keys()
        self.key("i", "Control_L")
        self.wait(lambda: "open plate.svg" in self.state["controls"])
        self.type("plate")
        self.key("Return")
        self.assertEqual((self.state["message"], self.state["tool"], self.bodies()), ("", 11, {"beam1"}))
        self.click(self.at(3, 1))
        self.assertEqual(self.bodies(), {"beam1", "plate"})
        self.key("s", "Control_L")
        plate = json.loads((self.path / "new.scene.json").read_text())["bodies"][2]
        xs, ys = zip(*((x + dx, y + dy) for (x, y), (dx, dy) in ((plate["at"], corner) for corner in plate["outline"])))
        self.assertEqual([round(value, 9) for value in (min(xs), max(xs), min(ys), max(ys))], [3, 5, 1, 2])

    def test_a_slanting_load_that_grows_and_a_spring(self):
        self.make_a_column_by_keys()
        self.key("4")
        for slider, value in ("load force", "20 kN"), ("load direction", "0"), ("load ramp", "3"):
            self.reach(slider)
            self.key("Return")
            self.type(value)
            self.key("Return")
            self.key("Escape")
        self.key("Return")  # at (0, 2)
        self.key("7")
        self.control("line", 0.2)
        self.wait(lambda: "line: spring" in self.state["controls"])
        self.control("line: spring")
        self.drag(self.at(0, 2), self.at(-2, 0))
        self.key("s", "Control_L")
        scene = json.loads((self.path / "new.scene.json").read_text())
        self.assertEqual(scene["loads"], [{"body": "beam1", "at": [0, 2], "force": [20e3, 0], "ramp": 3}])
        self.assertEqual(len([name for name in self.state["pieces"] if name.startswith("beam1")]), 6)
        self.key("minus")
        self.drag(self.at(-1, 1), self.at(1, 1))
        self.assertEqual([name for name in self.state["pieces"] if name.startswith("beam1")], ["beam1/0", "beam1/1"])
        line = scene["joints"][-1]
        self.assertEqual((line["between"], line["stiffness_axial"]), (["beam1", "floor"], 1e6))

    def test_copied_pasted_and_cut(self):
        self.make_a_column_by_keys()
        self.assertEqual(self.state["chosen"], ["beam1"])
        self.key("c", "Control_L")
        self.key("v", "Control_L")
        self.go(0.5, 2)
        self.key("Return")
        self.assertEqual(self.bodies(), {"beam1", "beam2"})  # before it is let go
        self.go(1, 2)
        self.key("Return")
        self.assertEqual(self.state["chosen"], ["beam2"])
        self.key("x", "Control_L")
        self.assertEqual(self.bodies(), {"beam1"})
        self.key("z", "Control_L")
        self.assertEqual(self.bodies(), {"beam1", "beam2"})
        self.key("z", "Control_L")
        self.assertEqual(self.bodies(), {"beam1"})


if __name__ == "__main__":
    lacking = driven.missing(COMMAND, SCENES)
    if lacking:
        print("skipped:", lacking)
        sys.exit(77)
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]], verbosity=2)
