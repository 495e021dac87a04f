"""The report's figures as SVG files, as its page draws them in headless Chromium.

    figures.py FOLDER      FOLDER/index.html → FOLDER/figures/*.svg: of each row of tabs the one that is open
"""
import sys
import urllib.parse
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "tests"))
from chromium import Page, chromium  # noqa: E402

folder = Path(sys.argv[1])
if not chromium():
    sys.exit("figures.py: no chromium here (Debian: chromium); the page itself needs none")
(folder / "figures").mkdir(exist_ok=True)
with Page(folder / "index.html") as page:
    page.wait_for("document.documentElement?.dataset.ready === 'yes'")
    for name in page.evaluate("[...document.querySelectorAll('.plot')].map(p => p.id)"):
        url = page.evaluate(f"Plotly.toImage(document.getElementById('{name}'), {{format: 'svg', width: 900, height: 480}})")
        (folder / "figures" / f"{name}.svg").write_text(urllib.parse.unquote(url.split(",", 1)[1]))
