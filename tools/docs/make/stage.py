"""stage.py ROOT BUILD: the sources of the site in BUILD/docs/source.

They consist of the pages of tools/docs/pages and the READMEs that they include, with the links of both rewritten to pages of the site; of one
page for each file of the repository that is linked to; and of the output of the program and the Python package.
"""
import re
import shutil
import sys
from pathlib import Path

import gallery
import mathematics
import notebooks
import playground
import printed

INCLUDE = re.compile(r"```\{include\} (\S+)\n((?::[a-z-]+:.*\n)*)")
LINK = re.compile(r"(!?)\[((?:[^\]\[]|\[[^\]]*\])*)\]\(([^)\s]+)\)")
HEADING = re.compile(r"^(#+) (.*)$", re.M)
LANGUAGES = {".cpp": "cpp", ".hpp": "cpp", ".toml": "toml", ".py": "python", ".json": "json", ".sh": "bash",
             ".cmake": "cmake", ".mjs": "js", ".js": "js"}


def without_code(text):
    """The text with its fenced blocks blanked, of the same length."""
    return re.sub(r"^```.*?^```$", lambda m: re.sub(r"[^\n]", " ", m[0]), text, flags=re.S | re.M)


def slug(heading):
    """The anchor of a heading, as GitHub and MyST make it."""
    return re.sub(r"[^\w\- ]", "", re.sub(r"`", "", heading).lower()).replace(" ", "-")


class Site:
    def __init__(self, root, build):
        self.root, self.pages = root, root / "tools/docs/pages"
        self.linked = playground.is_built(build)
        self.out = build / "docs/source"
        self.mathematics = mathematics.Typesetter(Path(__file__).parent / "typeset.mjs", build / "docs/npm")
        self.placed = {}  # (README, anchor or "") -> page of the site with its anchor
        self.copied = set()

    def write(self, path, text):
        target = self.out / path
        target.parent.mkdir(parents=True, exist_ok=True)
        if not target.exists() or target.read_text() != text:  # Sphinx does not read unchanged files again
            target.write_text(text)
        self.copied.add(target)

    def page_texts(self):
        return {path.relative_to(self.pages).as_posix(): path.read_text() for path in sorted(self.pages.rglob("*.md"))}

    def place_readmes(self, texts):
        """Determines the page of each part of a README, and of the whole: the one that has its beginning."""
        firsts = {}
        for page, text in texts.items():
            for file, options in INCLUDE.findall(text):
                if file.startswith("generated"):
                    continue
                readme = (self.root / file).read_text()
                options = dict(re.findall(r":([a-z-]+): \"?(.*?)\"?\n", options))
                for marker in options.values():
                    if marker not in readme:
                        raise SystemExit(f"docs: {page} includes {file}, which has no '{marker}'")
                begin = readme.index(options["start-after"]) if "start-after" in options else 0
                end = readme.index(options["end-before"], begin) if "end-before" in options else len(readme)
                if begin < firsts.setdefault(file, begin + 1):
                    firsts[file], self.placed[file, ""] = begin, f"/{page}"
                for heading in HEADING.finditer(without_code(readme)):
                    if begin <= heading.start() < end:
                        is_start = "start-after" in options and heading.start() == begin
                        anchor = "" if is_start or heading[1] == "#" else "#" + slug(heading[2])
                        self.placed.setdefault((file, slug(heading[2])), f"/{page}{anchor}")

    def target_of(self, link, folder, is_image):
        path, _, anchor = link.partition("#")
        full = (folder / path).resolve() if path else None
        relative = full.relative_to(self.root).as_posix()
        if is_image:
            return self.image(full)
        if relative.startswith("tools/docs/pages/"):
            return "/" + relative.removeprefix("tools/docs/pages/") + (f"#{anchor}" if anchor else "")
        readme = f"{relative}/README.md".removeprefix("./") if full.is_dir() else relative
        if (readme, anchor) in self.placed:
            return self.placed[readme, anchor]
        if anchor and (readme, "") in self.placed:
            raise SystemExit(f"docs: {folder}: no page has the part of {link}")
        return self.file_page(full, relative)

    def image(self, full, folder="images"):
        target = self.out / folder / full.name
        target.parent.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(full, target)
        self.copied.add(target)
        return f"/{folder}/{full.name}"

    def file_page(self, full, relative):
        """A page that shows a file of the repository, or lists a folder."""
        page = f"files/{relative}.md"
        if self.out / page not in self.copied:
            self.copied.add(self.out / page)
            text = f"---\norphan: true\n---\n# {relative}\n\n"
            if full.is_dir():
                files = sorted(file for file in full.iterdir() if file.is_file() and file.stat().st_size < 60000)
                for file in files:
                    inside = self.file_page(file, file.relative_to(self.root).as_posix())
                    text += f"- [{file.name}]({inside})\n"
            else:
                content = full.read_text()
                fence = "`" * (max([2, *(len(run) for run in re.findall(r"^`+", content, re.M))]) + 1)
                text += f"{fence}{LANGUAGES.get(full.suffix, 'none')}\n{content.rstrip()}\n{fence}\n"
            self.write(page, text)
        return "/" + page

    def rewritten(self, text, file):
        """The text of a Markdown file of the repository with its links rewritten to pages of the site."""
        folder = (self.root / file).parent

        def lead(match):
            if re.match(r"(https?:|mailto:|#)", match[3]):
                if match[3].startswith("#") and not file.startswith("tools/docs/pages/"):
                    return f"[{match[2]}]({self.target_of(Path(file).name + match[3], folder, False)})"
                return match[0]
            return f"{match[1]}[{match[2]}]({self.target_of(match[3], folder, bool(match[1]))})"

        blank = without_code(text)
        out, at = [], 0
        for match in LINK.finditer(blank):
            out += [text[at:match.start()], LINK.sub(lead, text[match.start():match.end()])]
            at = match.end()
        return "".join([*out, text[at:]])

    def stage(self):
        texts = self.page_texts()
        self.place_readmes(texts)
        for page, text in texts.items():
            text = self.rewritten(text, f"tools/docs/pages/{page}")
            if self.linked:
                text = playground.with_links(text, page)
            self.write(page, INCLUDE.sub(lambda m: f"```{{include}} /{'' if m[1].startswith('generated') else 'readme/'}{m[1]}\n{m[2]}", text))
        for file in {file for file, _ in self.placed}:
            text = self.rewritten((self.root / file).read_text(), file)
            if self.placed[file, ""] == "/method.md":
                text = self.mathematics.typeset(text)
            if self.linked:
                text = playground.with_links(text, self.placed[file, ""][1:])
            self.write(f"readme/{file}", text)

    def clean(self):
        for path in self.out.rglob("*"):
            if path.is_file() and path not in self.copied:
                path.unlink()


def main(root, build):
    site = Site(root, build)
    for name, text in printed.texts(root, build).items():
        site.write(f"generated/{name}", text)
    for name, text in gallery.texts(root, build, site).items():
        site.write(f"generated/{name}", text)
    for name, text in playground.texts(build).items():
        site.write(f"generated/{name}", text)
    if list((build / "tools/python/hamel").glob("_hamel.*.so")):
        notebooks.write(root, build, site)
    site.stage()
    site.clean()


if __name__ == "__main__":
    main(Path(sys.argv[1]).resolve(), Path(sys.argv[2]).resolve())
