"""Pages of the notebooks of tools/python/notebooks, which are run when the site is built and kept until they or the package change."""
import base64
import hashlib
import re


def executed(path, build, folder):
    import nbclient
    import nbformat

    module = next((build / "tools/python/hamel").glob("_hamel.*.so"))
    name = hashlib.sha256(path.read_bytes() + module.read_bytes()).hexdigest()[:16]
    kept = folder / f"{path.stem}-{name}.ipynb"
    if not kept.exists():
        for old in folder.glob(f"{path.stem}-*.ipynb"):
            old.unlink()
        book = nbformat.read(path, as_version=4)
        nbclient.NotebookClient(book, timeout=300, kernel_name="python3", resources={"metadata": {"path": str(folder)}}).execute()
        nbformat.write(book, kept)
    return nbformat.read(kept, as_version=4)


def shown(output, picture):
    """An output as Markdown; picture(bytes) stores a picture and returns its path."""
    if output.output_type == "stream":
        return f"```\n{output.text.rstrip()}\n```\n" if output.name == "stdout" else ""
    data = output.get("data", {})
    if "image/png" in data:
        return f"![]({picture(base64.b64decode(data['image/png']))})\n"
    if "text/html" in data:
        return f'```{{raw}} html\n<div class="output">{data["text/html"]}</div>\n```\n'
    return f"```\n{data['text/plain']}\n```\n" if "text/plain" in data else ""


def page(path, book, site):
    parts = []
    for number, cell in enumerate(book.cells):
        if cell.cell_type == "markdown":
            parts.append(re.sub(r"\((\w+)\.ipynb\)", r"(/notebooks/\1.md)", cell.source) + "\n")
            continue
        parts.append(f"```python\n{cell.source}\n```\n")
        for i, output in enumerate(cell.outputs):
            def picture(content, place=f"images/notebooks/{path.stem}-{number}-{i}.png"):
                target = site.out / place
                target.parent.mkdir(parents=True, exist_ok=True)
                target.write_bytes(content)
                site.copied.add(target)
                return "/" + place

            parts.append(shown(output, picture))
    parts.append(f"*This page is the notebook `tools/python/notebooks/{path.name}`, run when the site was built.*\n")
    return "\n".join(parts)


def write(root, build, site):
    """Writes every notebook as /notebooks/NAME.md and redirects links to a notebook to that page."""
    folder = build / "docs/notebooks"
    folder.mkdir(parents=True, exist_ok=True)
    for path in sorted((root / "tools/python/notebooks").glob("*.ipynb")):
        site.write(f"notebooks/{path.stem}.md", page(path, executed(path, build, folder), site))
        site.placed[path.relative_to(root).as_posix(), ""] = f"/notebooks/{path.stem}.md"
