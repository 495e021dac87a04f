"""Two runs of the report side by side: what is computed must be equal to the digit, ratios within their spread.

    compare.py FIRST SECOND      folders that `ductile report --out` wrote; exit 1 where they differ
"""
import json
import sys
from pathlib import Path


def main(first, second):
    exact = ratios = 0
    wrong = []
    for file in sorted(Path(first, "data").glob("*.json")):
        a, b = (json.loads(Path(folder, "data", file.name).read_text()) for folder in (first, second))
        for one, two in zip(a["tables"], b["tables"], strict=True):
            columns = [c["name"] for c in one["columns"]]
            measured = [c["measured"] for c in one["columns"]]
            if len(one["rows"]) != len(two["rows"]) and any(measured[:2]):
                continue  # what stays is for the clock to say
            for row, other in zip(one["rows"], two["rows"], strict=True):
                where = f"{file.stem}-{one['name']}: {', '.join(str(v) for v in row[:2])}"
                for name, by_clock, x, y in zip(columns, measured, row, other):
                    if by_clock:
                        continue
                    exact += 1
                    if x != y:
                        wrong.append(f"{where}: {name} is {x}, then {y}")
                if "from" in columns and "to" in columns:
                    low, high = columns.index("from"), columns.index("to")
                    ratios += 1
                    if row[high] < other[low] or other[high] < row[low]:
                        wrong.append(f"{where}: {columns[low - 1]} is {row[low - 1]:.3g} ({row[low]:.3g} … "
                                     f"{row[high]:.3g}), then {other[low - 1]:.3g}")
    print("\n".join(wrong + [f"{exact} numbers to the digit, {ratios} ratios within their spread: "
                             f"{len(wrong)} differ"]))
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
