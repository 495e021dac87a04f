"""The replay of `ductile simulate --replay`, in headless Chromium: it plays, slides, hovers, and asks for nothing.

    replay_test.py COMMAND      exit 77: there is no chromium here
"""
import json
import subprocess
import sys
import tempfile
import time
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))
from chromium import Page, chromium  # noqa: E402
from breaking_bar import breaking_bar  # noqa: E402

COMMAND = sys.argv.pop(1)

SCENE = breaking_bar("tag <script>")
PREFIX = {"n": 1e-9, "µ": 1e-6, "m": 1e-3, "": 1, "k": 1e3, "M": 1e6, "G": 1e9}
READY = "document.documentElement?.dataset.ready === 'yes'"
SHOWN = "document.getElementById('time').textContent"


def value(text, unit):
    """'-3.215 MN m' → -3.215e6."""
    number, rest = text.split(" ", 1)
    return float(number) * PREFIX[rest[:len(rest) - len(unit)]]


class Replay(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        folder = Path(cls.folder.name)
        (folder / "bar.scene.json").write_text(json.dumps(SCENE))
        cls.file = folder / "bar.html"
        run = subprocess.run([COMMAND, "simulate", str(folder / "bar.scene.json"), "--time", "2", "--json",
                              "--replay", str(cls.file)], check=True, capture_output=True, text=True)
        cls.result = json.loads(run.stdout)
        cls.page = Page(cls.file)
        cls.page.wait_for(READY)

    @classmethod
    def tearDownClass(cls):
        cls.page.__exit__()
        cls.folder.cleanup()

    def tearDown(self):
        self.assertEqual(self.page.requests, [self.page.url])
        self.assertEqual(self.page.errors, [])

    def slide(self, frame):
        self.page.evaluate(f"{{const s = document.getElementById('slider'); s.value = {frame};"
                           "s.dispatchEvent(new Event('input'))}")

    def hover(self, name):
        """Points at what the tooltip calls `name`; the tooltip's lines, and where."""
        found = self.page.evaluate("""(name => {
          const canvas = document.getElementById('scene'), tip = document.getElementById('tip');
          const box = canvas.getBoundingClientRect();
          for (let y = box.y + 5; y < box.bottom; y += 9)
            for (let x = box.x + 5; x < box.right; x += 9) {
              canvas.dispatchEvent(new PointerEvent('pointermove', {clientX: x, clientY: y}));
              if (tip.style.display === 'block' && tip.textContent.split('\\n')[0] === name) return [x, y];
            }
          return null;
        })(%s)""" % json.dumps(name))
        self.assertIsNotNone(found, f"nothing in the picture is {name}")
        self.page.mouse("mouseMoved", found[0] + 40, found[1] + 40)
        self.page.mouse("mouseMoved", *found)
        return self.page.evaluate("document.getElementById('tip').textContent").split("\n"), found

    def picture(self):
        return self.page.evaluate("new Promise(done => requestAnimationFrame(() => requestAnimationFrame(() =>"
                                  "done(document.getElementById('scene').toDataURL()))))")

    def test_says_what_it_is(self):
        self.assertEqual(self.page.evaluate("document.title"), "bar.scene.json")
        about = self.page.evaluate("document.getElementById('about').textContent")
        self.assertIn("6 pieces, 5 joints", about)
        self.assertIn("120 steps", about)

    def test_plays(self):
        self.slide(0)
        still = self.picture()
        self.page.click(*self.page.middle("#play"))
        start = time.monotonic()
        self.page.wait_for(f"parseFloat({SHOWN}) > 0.5")
        self.assertGreater(time.monotonic() - start, 0.3, "a second lasts a second")
        self.page.click(*self.page.middle("#play"))
        stopped = self.page.evaluate(SHOWN)
        self.assertNotEqual(self.picture(), still)
        time.sleep(0.2)
        self.assertEqual(self.page.evaluate(SHOWN), stopped)
        self.page.click(*self.page.middle("#play"))
        self.page.wait_for("document.getElementById('play').textContent === 'Play'")  # at the end
        self.assertEqual(self.page.evaluate(SHOWN), "2.000 s of 2.00 s")

    def test_slides(self):
        self.slide(0)
        x, y, width, height = self.page.evaluate(
            "(r => [r.x, r.y, r.width, r.height])(document.getElementById('slider').getBoundingClientRect())")
        middle = y + height / 2
        self.page.mouse("mouseMoved", x + 8, middle)
        self.page.mouse("mousePressed", x + 8, middle, "left", 1)
        pictures = {self.picture()}
        for share in (0.25, 0.5, 0.75):
            self.page.mouse("mouseMoved", x + share * width, middle, "left", 1)
            self.assertAlmostEqual(float(self.page.evaluate(SHOWN).split()[0]), 2 * share, delta=0.06)
            pictures.add(self.picture())
        self.page.mouse("mouseReleased", x + 0.75 * width, middle, "left")
        self.assertEqual(len(pictures), 4)

    def test_hovers_with_the_numbers_of_the_run(self):
        self.slide(120)
        joints = {joint["name"]: joint for joint in self.result["joints"]}
        for name in ("wall-bar/0", "bar/0-bar/1", "bar/1-bar/2"):
            lines, _ = self.hover(name)
            told = {line.split("  ")[0]: line.split("  ")[1:] for line in lines[1:]}
            scale = max(abs(joints[name]["N"]), abs(joints[name]["Q"]))
            for row, unit in (("N", "N"), ("Q", "N"), ("M", "N m")):
                # 12 bits are kept, 4 digits are shown.
                self.assertAlmostEqual(value(told[row][0], unit), joints[name][row],
                                       delta=1e-3 * (abs(joints[name]["M"]) if row == "M" else scale))
                usage = joints[name]["usage"][row]
                self.assertAlmostEqual(float(told[row][1].split()[0]) / 100, usage, delta=1e-3)
            self.assertAlmostEqual(float(told["plastic rotation"][0].split()[0]), joints[name]["plastic_rotation"],
                                   delta=1e-3 * abs(joints[name]["plastic_rotation"]) + 1e-9)
            self.assertAlmostEqual(value(told["dissipated"][0], "J"), joints[name]["dissipated"],
                                   delta=1e-3 * joints[name]["dissipated"] + 1e-9)
        self.assertGreater(joints["wall-bar/0"]["dissipated"], 1e3)  # or the comparison says little
        lines, _ = self.hover("bar/3")
        piece = next(p for p in self.result["pieces"] if p["name"] == "bar/3")
        _, x, _, _, y, _ = lines[1].replace("  ", " ").split()
        self.assertAlmostEqual(float(x), piece["position"][0], delta=2e-3)
        self.assertAlmostEqual(float(y), piece["position"][1], delta=2e-3)

    def test_keeps_a_joint_that_is_clicked(self):
        self.slide(60)
        _, place = self.hover("bar/0-bar/1")
        self.page.click(*place)
        self.page.mouse("mouseMoved", 30, 80)
        self.page.wait_for("document.getElementById('chosen').textContent === 'bar/0-bar/1'")
        self.assertGreater(self.page.evaluate("document.getElementById('numbers').rows.length"), 5)

    def test_events_are_listed_and_lead_there(self):
        broke = next(j for j in self.result["joints"] if j["broken"])
        texts = self.page.evaluate("[...document.querySelectorAll('#events button')].map(b => b.textContent)")
        text = next(t for t in texts if t.endswith("breaks in rotation"))
        self.assertIn(broke["name"], text)
        self.page.evaluate(f"document.querySelectorAll('#events button')[{texts.index(text)}].click()")
        self.assertAlmostEqual(float(self.page.evaluate(SHOWN).split()[0]), broke["broken_at"], delta=2e-3)
        self.assertEqual(len(self.page.evaluate("[...document.querySelectorAll('#marks i')].map(i => i.title)")),
                         len(texts))

    def test_keys(self):
        self.slide(50)
        self.page.evaluate("document.activeElement.blur()")
        self.page.key("ArrowRight", 39)
        self.assertEqual(self.page.evaluate("document.getElementById('slider').value"), "51")
        self.page.key("ArrowLeft", 37)
        self.page.key("ArrowLeft", 37)
        self.assertEqual(self.page.evaluate("document.getElementById('slider').value"), "49")
        self.page.key(" ", 32)
        self.assertEqual(self.page.evaluate("document.getElementById('play').textContent"), "Pause")
        self.page.key(" ", 32)
        self.assertEqual(self.page.evaluate("document.getElementById('play').textContent"), "Play")

    def test_light_and_dark(self):
        ground = "getComputedStyle(document.body).backgroundColor"
        light = self.page.evaluate(ground)
        with Page(self.file, dark=True) as dark:
            dark.wait_for(READY)
            self.assertNotEqual(dark.evaluate(ground), light)
            dark.click(*dark.middle("#theme"))
            self.assertEqual(dark.evaluate(ground), light)

    def test_fits_a_telephone(self):
        """Nothing is wider than the screen, and every control is on it."""
        with Page(self.file, width=390, height=844, scale=2) as page:
            page.wait_for(READY)
            boxes = page.evaluate("""[...document.querySelectorAll('footer button, footer select, footer input, #scene')].map(
                (control) => { const r = control.getBoundingClientRect(); return [r.left, r.top, r.right, r.bottom]; })""")
            self.assertGreater(len(boxes), 8)
            for left, top, right, bottom in boxes:
                self.assertTrue(0 <= left < right <= 390 and 0 <= top < bottom <= 844, (left, top, right, bottom))
            self.assertEqual(page.evaluate("document.documentElement.scrollWidth"), 390)
            self.assertGreater(page.evaluate("document.getElementById('scene').clientHeight"), 844 / 3)

    def test_could_not_ask_if_it_wanted_to(self):
        with Page(self.file) as page:
            page.wait_for(READY)
            self.assertEqual(page.evaluate("fetch('http://127.0.0.1:9/').then(() => 'asked', () => 'refused')"), "refused")
            self.assertIn("Content Security Policy", json.dumps(page.errors))


if chromium() is None:
    print("skipped: there is no chromium to look at the page with (Debian package chromium)")
    sys.exit(77)
unittest.main()
