"""errors.py ROOT PROGRAM [--without urdf]: each entry of the page of errors fails with its message, and ends well when cured."""
import os
import re
import subprocess
import sys
import tempfile
from pathlib import Path

root, program = Path(sys.argv[1]).resolve(), Path(sys.argv[2]).resolve()
without = set(sys.argv[4:]) if sys.argv[3:4] == ["--without"] else set()
sys.dont_write_bytecode = True
sys.path.insert(0, str(root / "tools/docs/make"))
import errors  # noqa: E402

ENVIRONMENT = os.environ | {"PATH": f"{program.parent}:{os.environ['PATH']}"}


def output(command, files):
    with tempfile.TemporaryDirectory() as folder:
        for name, text in files.items():
            (Path(folder) / name).write_text(text)
        done = subprocess.run(["bash", "-c", command], cwd=folder, env=ENVIRONMENT, capture_output=True, text=True, timeout=60)
        return done.returncode, done.stdout + done.stderr


def wrong(entry):
    """Differences from the page."""
    status, text = output(entry["command"], entry["files"])
    if status not in (1, 2):
        yield f"{entry['command']}: ends with {status}, expected 1 or 2\n{text}"
    if not re.search(errors.pattern(entry["message"]), text):
        yield f"{entry['command']}: expected the message\n{entry['message']}\nin\n{text}"
    status, text = output(entry["cured"], entry["cured_files"])
    if status != 0:
        yield f"{entry['cured']}, cured: ends with {status}\n{text}"


entries = [entry for group in errors.groups(root) for entry in group["error"] if entry.get("needs") not in without]
failures = [f"{entry['title']}: {text}" for entry in entries for text in wrong(entry)]
print("\n".join(failures) or f"{len(entries)} entries")
sys.exit(1 if failures or len(entries) < 25 else 0)
