"""The pages of docs/, as a reader works through them: files are written, commands run, programs compiled and run.

    pages.py list   DOCS OUT                       writes the C++ programs of all pages to OUT, prints their names
    pages.py check  PAGE COMMAND PROGRAMS [--keep] runs one page; with --keep pictures go where the page shows them

On a page, in their order:
  ```json or ```xml after a line that ends in `NAME`:  is written to NAME
  ```sh                                       runs in that folder, with `ductile` in its path
  ```cpp with a main                          runs there, compiled
  ```text after either                        is what it prints; a line `…` stands for any lines, a `…` in a line for anything
  ![…](…/pictures/NAME)                       is what a command of the page drew as NAME
  […](PATH)                                   is there
"""
import os
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

BLOCK = re.compile(r"(?P<lead>[^\n]*)\n\n?```(?P<kind>\w+)\n(?P<text>.*?)^```$", re.M | re.S)


def blocks(page):
    return [(m["lead"], m["kind"], m["text"]) for m in BLOCK.finditer(page.read_text())]


def programs(page):
    return [text for _, kind, text in blocks(page) if kind == "cpp" and "int main(" in text]


def program_name(page, number):
    return f"docs_{page.parent.name}_{page.stem}_{number}"


def matches(expected, printed):
    pattern = "\n".join(".*" if line == "…" else re.escape(line).replace("…", "[^\n]*")
                        for line in expected.rstrip("\n").split("\n"))
    return re.fullmatch(pattern, printed.rstrip("\n"), re.S)


def without_numbers(picture):
    """What a picture shows, whatever the last digits: they move with the solver and the drawing's style."""
    return re.sub(r"-?\d+(\.\d+)?(e-?\d+)?", "#", picture.read_text())


def check(page, command, folder, keep):
    scratch = Path(tempfile.mkdtemp(prefix="ductile."))
    (scratch / "bin").mkdir()
    (scratch / "bin/ductile").symlink_to(command)
    path = dict(os.environ, PATH=f"{scratch / 'bin'}:{os.environ['PATH']}")
    printed, failed, number, did = None, [], 0, 0
    for lead, kind, text in blocks(page):
        if kind in ("json", "xml"):
            name = re.search(r"`([\w.]+)`:$", lead)
            if name:
                (scratch / name[1]).write_text(text)
        elif kind == "sh" or (kind == "cpp" and "int main(" in text):
            what = ["bash", "-ec", text] if kind == "sh" else [str(folder / program_name(page, number))]
            number += kind == "cpp"
            ran = subprocess.run(what, cwd=scratch, env=path, stdin=subprocess.DEVNULL, capture_output=True, text=True)
            printed = ran.stdout
            did += 1
            if ran.returncode != 0:
                failed.append(f"{text}ended with {ran.returncode}\n{ran.stdout}{ran.stderr}")
        elif kind == "text" and printed is not None:
            if not matches(text, printed):
                failed.append(f"the page says\n{text}but it is\n{printed}")
            printed = None
    for name in re.findall(r"\]\(\.\./pictures/([\w.]+)\)", page.read_text()):
        shown, drawn = page.parent.parent / "pictures" / name, scratch / name
        if not drawn.exists():
            failed.append(f"no command of the page draws {name}")
        elif keep:
            shutil.copy(drawn, shown)
        elif shown.suffix == ".svg" and without_numbers(shown) != without_numbers(drawn):
            failed.append(f"{name} is not what the page's commands draw now")
    shutil.rmtree(scratch)
    links = [link for link in re.findall(r"\]\(([^)#\s]+)", BLOCK.sub("", page.read_text())) if not link.startswith("http")]
    failed += [f"it links to {link}, which is not there" for link in links if not (page.parent / link).exists()]
    if did + len(links) == 0:
        failed.append("the page runs nothing and links to nothing")
    print("\n".join(failed) or f"{did} commands and programs, {len(links)} links")
    return 1 if failed else 0


def main():
    if sys.argv[1] == "list":
        docs, out = Path(sys.argv[2]), Path(sys.argv[3])
        out.mkdir(parents=True, exist_ok=True)
        for page in sorted(docs.glob("*/*.md")):
            print(f"page {page.parent.name}/{page.stem}")
            for number, text in enumerate(programs(page)):
                name = program_name(page, number)
                source = out / f"{name}.cpp"
                if not source.exists() or source.read_text() != text:
                    source.write_text(text)
                print(f"program {name}")
        return 0
    return check(Path(sys.argv[2]), Path(sys.argv[3]).resolve(), Path(sys.argv[4]).resolve(), "--keep" in sys.argv)


if __name__ == "__main__":
    sys.exit(main())
