"""The programs of a page of docs/ in headless Chromium, with the npm package served from its folder.

    browser_test.py PACKAGE PAGE        exit 77: there is no Chromium here (Debian: chromium)
"""
import functools
import http.server
import json
import re
import sys
import tempfile
import threading
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))
import chromium  # noqa: E402


class Quiet(http.server.SimpleHTTPRequestHandler):
    extensions_map = {**http.server.SimpleHTTPRequestHandler.extensions_map, ".wasm": "application/wasm"}

    def log_message(self, *_):
        pass


def main():
    package, page = Path(sys.argv[1]).resolve(), Path(sys.argv[2])
    if not chromium.chromium():
        print("SKIPPED: there is no Chromium here (Debian: chromium)")
        return 77
    programs = re.findall(r"```js\n(.*?)```\n+```text\n(.*?)```", page.read_text(), re.S)
    assert programs, f"{page} has no programs"
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        (folder / "ductile").symlink_to(package)
        imports = {"ductile": "./ductile/index.js", "ductile/world": "./ductile/world.js"}
        for number, (program, _) in enumerate(programs):
            (folder / f"{number}.html").write_text(
                f"""<!doctype html><meta charset="utf-8"><link rel="icon" href="data:">
<script type="importmap">{json.dumps({"imports": imports})}</script>
<script>window.printed = ''; console.log = (...words) => {{ printed += words.join(' ') + '\\n'; }};</script>
<script type="module">{program}
window.done = true;</script>""")
        server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), functools.partial(Quiet, directory=name))
        threading.Thread(target=server.serve_forever, daemon=True).start()
        failed = 0
        for number, (_, prints) in enumerate(programs):
            with chromium.Page(f"http://127.0.0.1:{server.server_port}/{number}.html") as tab:
                tab.wait_for("window.done")
                printed = tab.evaluate("printed")
                if printed != prints or tab.errors:
                    failed += 1
                    print(f"the page says\n{prints}but it is\n{printed}{tab.errors or ''}")
        server.shutdown()
    print(f"{len(programs)} programs in Chromium, {failed} failed")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
