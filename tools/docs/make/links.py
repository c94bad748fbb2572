"""links.py HTML: checks that every link, picture and script of the site refers to an existing file, every anchor exists, and no page needs the network."""
import sys
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urlsplit


class Page(HTMLParser):
    def __init__(self, path):
        super().__init__()
        self.ids, self.links, self.loads = set(), [], []
        self.feed(path.read_text())

    def handle_starttag(self, tag, attrs):
        attrs = dict(attrs)
        for key in ("id", "name"):
            if attrs.get(key):
                self.ids.add(attrs[key])
        if tag == "a" and attrs.get("href"):
            self.links.append(attrs["href"])
        if tag in ("script", "img", "iframe", "source") and attrs.get("src"):
            self.loads.append(attrs["src"])
        if tag == "link" and attrs.get("href") and attrs.get("rel") in ("stylesheet", "icon"):
            self.loads.append(attrs["href"])


def main(folder):
    pages = {path: Page(path) for path in sorted(folder.rglob("*.html"))
             if folder / "playground" not in path.parents}  # built and tested apart; its fragments are systems
    wrong, count = [], 0
    for path, page in pages.items():
        for link in page.links + page.loads:
            url = urlsplit(link)
            if url.scheme in ("http", "https"):
                if link in page.loads:
                    wrong.append(f"{path.name}: loads {link} from the network")
                continue
            if url.scheme in ("mailto", "data"):
                continue
            count += 1
            target = (path.parent / unquote(url.path)).resolve() if url.path else path
            if not target.exists():
                wrong.append(f"{path.relative_to(folder)}: there is no {link}")
            elif url.fragment and target in pages and unquote(url.fragment) not in pages[target].ids:
                wrong.append(f"{path.relative_to(folder)}: no place {link}")
    for line in wrong:
        print(line, file=sys.stderr)
    print(f"docs: {len(pages)} pages, {count} links and files, {len(wrong)} wrong")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main(Path(sys.argv[1]).resolve()))
