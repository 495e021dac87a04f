"""R.U.B.E. levels that others made: they run, keep what is theirs, and calibrate by naming materials alone.

    levels.py DUCTILE CLONES [--json FILE]

CLONES holds the repositories of the list below, as OWNER/NAME; those that are not there are cloned. A table: of each
repository, how many levels come back from `calibrate --to rube` as they were, run in `simulate` and in `view`, as they
are and with every moving body of steel; and how many of their weld and revolute joints are calibrated then. Ends with 1
where a share is below what is asked for, and with 77 where no repository is reached or there is no display.
"""
import argparse
import json
import os
import re
import subprocess
import sys
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))
import xwindow

LEVELS, CALIBRATED = 40, 0.8
REPOSITORIES = {
    "JesseTG/RubeLoader": "97ee599d838e66054e1594a4d364e8786636efdd",
    "VonHirsch/AndEngineJb2dJson": "3a98a57e140768ef8dd1bd6fa11dde3039699735",
    "indiumindeed/RubeLoader": "05855c8b70b0110bcbf00b9d2336010ea271a86a",
    "kaa/berzerk": "c4934b841495d639c58d9dd10bcbfe4144dcf2df",
    "netonjm/RubeLoader": "2b747fc0c39f316dfd1fb7a03f44dab9635c1a47",
    "ptrandem/FarseerXnaRubeLoader": "efa8ed38f95fd92cc7321a633f8a45cc6549f6ae",
    "yiwei-lee/nyu-smg13-groupgame": "eab3acc459802d856bcd930b491c03c5a587d33a",
}
STEEL = [{"name": "ductile.material", "string": "S355"}, {"name": "ductile.depth", "float": 0.1}]


def run(*command, env=None):
    try:
        done = subprocess.run(command, capture_output=True, timeout=300, text=True, env=env)
        return done.returncode, done.stdout, (done.stderr.splitlines() or ["no word"])[0]
    except subprocess.TimeoutExpired:
        return -1, "", "takes more than 300 s"


def reached(clones):
    """The repositories that are there, or can be cloned: the first that cannot tells of the others, too."""
    found = {}
    for name, commit in REPOSITORIES.items():
        if not (clones / name).is_dir():
            try:
                subprocess.run(["git", "clone", "--quiet", f"https://github.com/{name}", str(clones / name)],
                               capture_output=True, check=True, timeout=120, env={**os.environ, "GIT_TERMINAL_PROMPT": "0"})
            except (subprocess.CalledProcessError, subprocess.TimeoutExpired, FileNotFoundError):
                return found
        found[name] = commit
    return found


def levels(folder, commit):
    """Every level of a repository, once: its path and its JSON. Some stand in JavaScript, as `var level = {…};`."""
    def git(*arguments):
        return subprocess.run(["git", "-C", str(folder), *arguments], capture_output=True, check=True).stdout

    seen = set()
    for path in git("ls-tree", "-r", "-z", "--name-only", commit).decode().split("\0"):
        if not path.endswith((".json", ".js")):
            continue
        text = git("show", f"{commit}:{path}").decode(errors="replace").lstrip("\ufeff")
        if '"body"' not in text or '"fixture"' not in text:
            continue
        try:
            level = json.loads(re.sub(r"^\s*(var\s+)?[\w.]+\s*=\s*", "", text).rstrip().rstrip(";"))
        except ValueError:
            continue  # a program that makes levels
        key = json.dumps(level, sort_keys=True)
        if isinstance(level, dict) and isinstance(level.get("body"), list) and key not in seen:
            seen.add(key)
            yield path, level


def try_level(ductile, level, screen, folder):
    """Counts for the table, and what went wrong, each in one line."""
    wrong, plain, steel = [], folder / "plain.json", folder / "steel.json"
    plain.write_text(json.dumps(level))
    code, text, error = run(ductile, "calibrate", str(plain), "--to", "rube")
    same = code == 0 and json.loads(text) == level
    if not same:
        wrong.append(f"calibrate --to rube {code}: " + (error if code else "is not what it was"))
    for body in level["body"]:
        if body.get("type") == 2:
            body["customProperties"] = body.get("customProperties", []) + STEEL
    steel.write_text(json.dumps(level))
    ran = shown = 0
    for file in (plain, steel):
        code, _, error = run(ductile, "simulate", str(file), "--time", "2")
        ran += code == 0
        if code:
            wrong.append(f"simulate {file.stem} {code}: {error}")
        code, _, error = run(ductile, "view", str(file), "--frames", "5", "--screenshot", str(folder / "a.png"), env=screen.env)
        shown += code == 0
        if code:
            wrong.append(f"view {file.stem} {code}: {error}")
    joints = [joint for joint in level.get("joint", []) if joint["type"] in ("weld", "revolute")]
    code, text, error = run(ductile, "calibrate", str(steel), "--to", "rube")
    calibrated = 0
    if code:
        wrong.append(f"calibrate {code}: {error}")
    else:
        after = json.loads(text).get("joint", [])[:len(level.get("joint", []))]
        calibrated = sum(any(p["name"] == "ductile.N" for p in joint.get("customProperties", [])) for joint in after)
    return same, ran == 2, shown == 2, len(joints), calibrated, wrong


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("ductile")
    parser.add_argument("clones", type=Path)
    parser.add_argument("--json", type=Path)
    arguments = parser.parse_args()
    if xwindow.missing():
        print("SKIPPED:", xwindow.missing())
        return 77
    found = reached(arguments.clones)
    if not found:
        print("SKIPPED: none of the repositories is reached")
        return 77
    screen, failures, rows = xwindow.Screen(), [], []
    print(f"{'repository':<38}{'levels':>7}{'as it was':>10}{'simulate':>9}{'view':>6}{'joints':>8}{'calibrated':>11}")
    try:
        for name, commit in found.items():
            counts = [0] * 6
            for path, level in levels(arguments.clones / name, commit):
                with tempfile.TemporaryDirectory() as folder:
                    *row, wrong = try_level(arguments.ductile, level, screen, Path(folder))
                counts = [a + b for a, b in zip(counts, [1, *row])]
                failures += [f"{name}/{path}: {line}" for line in wrong]
            rows.append([name, *counts])
            print(f"{name:<38}{counts[0]:>7}{counts[1]:>10}{counts[2]:>9}{counts[3]:>6}{counts[4]:>8}{counts[5]:>11}", flush=True)
    finally:
        screen.close()
    total = [sum(row[i] for row in rows) for i in range(1, 7)]
    print(f"{'all':<38}{total[0]:>7}{total[1]:>10}{total[2]:>9}{total[3]:>6}{total[4]:>8}{total[5]:>11}")
    for failure in failures:
        print(failure)
    if arguments.json:
        arguments.json.write_text(json.dumps({"rows": rows, "failures": failures}, indent=1))
    whole = len(found) == len(REPOSITORIES)
    if whole and total[0] < LEVELS:
        print("too few levels: what is missing?")
        return 1
    return 0 if total[1] == total[2] == total[3] == total[0] and total[5] >= CALIBRATED * total[4] else 1


if __name__ == "__main__":
    sys.exit(main())
