"""blocks.py ROOT BUILD [PAGE ...]: runs the examples of the pages of the site and of the READMEs, each page in a separate folder.

Files are TOML blocks with a caption, or after a line that ends in `name.toml`:. Commands are the lines `$ hamel ...` of console blocks, and the
lines `hamel ...` of indented ones without placeholders (SYSTEM, FILE, ..., |). Programs are Python blocks; those of C++ are tests/examples.
"""
import os
import re
import subprocess
import sys
import tempfile
import time
from pathlib import Path

FENCE = re.compile(r"^```(?:\{code-block\} )?(\w+)\n((?::\w+: [^\n]*\n)*)(.*?)^```$", re.S | re.M)
INDENTED = re.compile(r"(?:^    .*\n(?: *\n)*)+", re.M)
PLACEHOLDER = re.compile(r"…|\.\.\.|\[|\||<| (SYSTEM|FILE|PAGE|NAME|COMMAND|KIND|E|N)\b|FILE\.toml|FILE\.h5|my_|\bx\.h5")


def blocks(text):
    """(kind, name, content) in the order of the page; kind is toml, python or command."""
    found = []
    for match in FENCE.finditer(text):
        language, options, content = match[1], match[2], match[3]
        before = text[: match.start()].rstrip().rsplit("\n", 1)[-1]
        name = re.search(r":caption: (\S+)", options) or re.search(r"`(\w+\.toml)`:$", before)
        if language == "toml" and name:
            found.append((match.start(), "toml", name[1], content))
        elif language == "python":
            found.append((match.start(), "python", "", content))
        elif language == "console":
            for line in re.findall(r"^\$ (hamel .*)$", content, re.M):
                found.append((match.start(), "command", "", line))
    plain = re.sub(r"^```.*?^```$", lambda m: re.sub(r"[^\n]", " ", m[0]), text, flags=re.S | re.M)
    for match in INDENTED.finditer(plain):
        joined = match[0].replace("\\\n", " ")
        for line in re.findall(r"^    (hamel [a-z].*?)\s*(?:\s#.*)?$", joined, re.M):
            if not PLACEHOLDER.search(line):
                found.append((match.start(), "command", "", line))
    return [block[1:] for block in sorted(found, key=lambda block: block[0])]


def main(root, build, pages):
    environment = os.environ | {"PATH": f"{build / 'tools'}:{os.environ['PATH']}", "PYTHONPATH": str(build / "tools/python")}
    passed, failed = 0, 0
    for page in pages:
        todo = blocks(page.read_text())
        with tempfile.TemporaryDirectory() as folder:
            for room in ("tools", "tests", "systems"):
                os.symlink(root / room, Path(folder) / room)
            for kind, name, content in todo:
                if kind == "toml":
                    (Path(folder) / name).write_text(content)
                    continue
                content = content.replace("--until 1e5", "--until 100")  # to avoid minutes of rows
                command = ["bash", "-o", "pipefail", "-c", content] if kind == "command" else [sys.executable, "-c", content]
                began = time.monotonic()
                done = subprocess.run(command, cwd=folder, env=environment, capture_output=True, text=True, timeout=300)
                seconds = time.monotonic() - began
                line = content if kind == "command" else f"{len(content.splitlines())} lines of Python"
                if done.returncode == 0:
                    passed += 1
                    print(f"{seconds:6.1f} s  {page.relative_to(root)}: {line}")
                else:
                    failed += 1
                    print(f"FAILED ({done.returncode})  {page.relative_to(root)}: {line}\n{done.stdout[-500:]}{done.stderr[-1500:]}")
    print(f"{passed} passed, {failed} failed")
    return 1 if failed or passed < 25 and len(pages) > 10 else 0


if __name__ == "__main__":
    root, build = Path(sys.argv[1]).resolve(), Path(sys.argv[2]).resolve()
    given = [Path(page).resolve() for page in sys.argv[3:]]
    tracked = subprocess.run(["git", "ls-files", "*.md"], cwd=root, capture_output=True, text=True, check=True).stdout.split()
    sys.exit(main(root, build, given or [root / page for page in tracked]))
