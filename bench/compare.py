"""Benchmarks against the ratios that are committed: flags a ratio, never a time, that is worse beyond noise.

    compare.py BENCH RATIOS.json [--filter REGEX] [--update]      exit 1: some ratio is worse

A ratio is a counter vs_NAME: the median over pairs of runs in turn, so it does not know how fast the machine is. What is
worse the first time is run again, twice: it counts when it is worse each time.
"""
import argparse
import json
import subprocess
import sys
from pathlib import Path

NOISE = 0.25  # medians of one build differ by up to that between runs on a busy machine


def measure(bench, only):
    run = subprocess.run([bench, "--benchmark_format=json", f"--benchmark_filter={only}"], check=True, text=True,
                         stdout=subprocess.PIPE)
    ratios = {}
    for b in json.loads(run.stdout or '{"benchmarks": []}')["benchmarks"]:
        name = b["name"].removesuffix("/manual_time").split("/iterations:")[0]
        for counter, value in b.items():
            if counter.startswith("vs_"):
                ratios[f"{name} {counter}"] = value
    return ratios


def worse(ratios, committed):
    return {k: v for k, v in ratios.items() if k in committed and v > committed[k] * (1 + NOISE)}


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("bench")
    parser.add_argument("file", type=Path)
    parser.add_argument("--filter", default=".")
    parser.add_argument("--update", action="store_true", help="commit to what is measured now")
    args = parser.parse_args()
    committed = json.loads(args.file.read_text()) if args.file.exists() else {}
    ratios = measure(args.bench, args.filter)
    if args.update:
        args.file.write_text(json.dumps({k: float(f"{v:.3g}") for k, v in {**committed, **ratios}.items()}, indent=1) + "\n")
        return 0
    flagged = worse(ratios, committed)
    for _ in range(2):
        if flagged:
            again = measure(args.bench, "|".join(f"^{name.split(' ')[0]}(/|$)" for name in flagged))
            flagged = {k: min(v, again.get(k, v)) for k, v in flagged.items() if k in worse(again, committed)}
    for name, value in ratios.items():
        was = committed.get(name)
        print(f"{'WORSE' if name in flagged else 'new' if was is None else 'ok':<6}{name:<60}{value:>9.3g}"
              + (f"{was:>9.3g}" if was is not None else ""))
    return 1 if flagged else 0


sys.exit(main())
