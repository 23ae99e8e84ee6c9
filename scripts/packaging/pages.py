"""Collects the files of the documentation site: pages, pictures, and every file of the repository that a page links to.

The order of the pages is defined in docs/README.md: its headings and its list of links become SUMMARY.md. Fails if a
page of docs is missing from that list, or if a link names no file.
"""

import pathlib
import re
import shutil
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
INDEX = ROOT / "docs" / "README.md"
LINK = re.compile(r"\]\(<?([^)\s>]+)>?\)")
ITEM = re.compile(r"- \[(.+)\]\(([^)]+)\)")


def fail(text):
    sys.exit(f"scripts/docs: {text}")


def text_of(page):
    """The page without its blocks of code, where brackets are not links."""
    return re.sub(r"^```.*?^```", "", page.read_text(encoding="utf-8"), flags=re.DOTALL | re.MULTILINE)


def targets(page):
    """Files and folders of the repository that `page` links to."""
    for link in LINK.findall(text_of(page)):
        path = link.split("#")[0]
        if path and not re.match(r"[a-z]+:", path):
            target = (page.parent / path).resolve()
            if not target.exists():
                fail(f"{page.relative_to(ROOT)} links to {link}, which is not there")
            if ROOT not in target.parents:
                fail(f"{page.relative_to(ROOT)} links to {link}, which is outside the repository")
            yield target


def summary():
    """SUMMARY.md of the site, and its pages in order."""
    pages = [ROOT / "README.md", INDEX]
    lines = ["# Summary", "", "[contact-afu](README.md)", "[Documentation](docs/README.md)"]
    for line in INDEX.read_text(encoding="utf-8").splitlines():
        item = ITEM.match(line)
        if line.startswith("## "):
            lines += ["", line[1:], ""]
        elif item:
            page = (INDEX.parent / item[2]).resolve()
            if page.suffix != ".md" or not page.is_file():
                fail(f"docs/README.md lists {item[2]}, which is no page")
            pages.append(page)
            lines.append(f"- [{item[1]}]({page.relative_to(ROOT)})")
    unlisted = sorted(page.name for page in INDEX.parent.glob("*.md") if page not in pages)
    if unlisted:
        fail(f"docs/README.md does not list {', '.join(unlisted)}")
    return "\n".join(lines) + "\n", pages


def copy(path, out):
    to = out / path.relative_to(ROOT)
    if path.is_file():
        to.parent.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(path, to)
        if path.suffix == ".md":
            # mdBook writes README.md as index.html, but turns links to it into README.html.
            text = to.read_text(encoding="utf-8")
            to.write_text(re.sub(r"(\]\([^)\s]*)README\.md(?=[)#])", r"\1index.md", text), encoding="utf-8")
    elif not (to / "index.html").exists():
        # A link to a folder shows its contents.
        to.mkdir(parents=True, exist_ok=True)
        names = sorted(entry.name for entry in path.iterdir() if entry.is_file())
        items = "\n".join(f'<li><a href="{name}">{name}</a></li>' for name in names)
        title = path.relative_to(ROOT)
        page = f'<!doctype html><html lang="en"><meta charset="utf-8"><title>{title}</title><h1>{title}</h1><ul>{items}</ul></html>\n'
        (to / "index.html").write_text(page, encoding="utf-8")
        for name in names:
            copy(path / name, out)


def main():
    out = pathlib.Path(sys.argv[1])
    shutil.rmtree(out, ignore_errors=True)
    pages_folder = out / "pages"
    text, pages = summary()
    for page in pages:
        copy(page, pages_folder)
        for target in targets(page):
            if target.suffix == ".md" and target not in pages:
                fail(f"{page.relative_to(ROOT)} links to {target.relative_to(ROOT)}, which docs/README.md does not list")
            copy(target, pages_folder)
    (pages_folder / "SUMMARY.md").write_text(text, encoding="utf-8")
    shutil.copyfile(ROOT / "docs" / "book.toml", out / "book.toml")


main()
