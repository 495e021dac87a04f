"""bench/compare.py flags a ratio that got worse, and neither a time nor what a second run takes back.

    compare_test.py COMPARE.py
"""
import json
import stat
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

COMPARE = sys.argv.pop(1)
# A benchmark program that gives these ratios and times, one pair per run.
FAKE = """#!/usr/bin/env python3
import json, pathlib
left = pathlib.Path(__file__).with_name("left.json")
(ratio, time), *rest = json.loads(left.read_text())
left.write_text(json.dumps(rest))
print(json.dumps({"benchmarks": [{"name": "joint/a/iterations:60/manual_time", "vs_stock": ratio, "us": time}]}))
"""


class Compare(unittest.TestCase):
    def compare(self, runs, *more):
        with tempfile.TemporaryDirectory() as folder:
            bench, ratios = Path(folder) / "bench", Path(folder) / "ratios.json"
            bench.write_text(FAKE)
            bench.chmod(bench.stat().st_mode | stat.S_IXUSR)
            ratios.write_text('{"joint/a vs_stock": 1.0}')
            (Path(folder) / "left.json").write_text(json.dumps(runs))
            run = subprocess.run([sys.executable, COMPARE, str(bench), str(ratios), *more], capture_output=True, text=True)
            self.assertEqual(run.stderr, "")
            return run.returncode, run.stdout, json.loads(ratios.read_text())

    def test_a_worse_ratio_is_flagged(self):
        code, said, _ = self.compare([[1.5, 1], [1.4, 1], [1.6, 1]])
        self.assertEqual(code, 1)
        self.assertIn("WORSE", said)

    def test_noise_is_not(self):
        for runs in ([[1.1, 1]], [[0.5, 1]], [[1.5, 1], [1.0, 1]], [[1.5, 1], [1.5, 1], [1.1, 1]]):
            code, said, _ = self.compare(runs)
            self.assertEqual((code, "WORSE" in said), (0, False), runs)

    def test_a_time_is_not(self):
        self.assertEqual(self.compare([[1.0, 1000]])[0], 0)

    def test_update_commits(self):
        self.assertEqual(self.compare([[1.5, 1]], "--update")[2], {"joint/a vs_stock": 1.5})


unittest.main(verbosity=2)
