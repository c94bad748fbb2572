"""The page of errors, from tools/docs/errors.toml; its entries, for the test that runs them."""
import re
import tomllib
from pathlib import Path

KEYS = {"title", "message", "cause", "cure", "command", "cured", "change", "files", "needs"}
LANGUAGES = {".toml": "toml", ".csv": "text", ".urdf": "xml"}


def groups(root):
    """The groups of the page. Each entry fails by `command` with `files`, and is cured by `cured` with `cured_files`."""
    read = tomllib.loads((root / "tools/docs/errors.toml").read_text())["group"]
    for group in read:
        for entry in group["error"]:
            if unknown := set(entry) - KEYS:
                raise SystemExit(f"errors.toml: {entry['title']}: unknown key {unknown}")
            if ("cured" in entry) == ("change" in entry):
                raise SystemExit(f"errors.toml: {entry['title']}: expected one of cured and change")
            files = entry.setdefault("files", {})
            entry["cured_files"] = dict(files)
            if "change" in entry:
                name, (old, new) = next(iter(files)), entry["change"]
                if files[name].count(old) != 1:
                    raise SystemExit(f"errors.toml: {entry['title']}: {name} has '{old}' {files[name].count(old)} times")
                entry["cured_files"][name] = files[name].replace(old, new)
            entry.setdefault("cured", entry["command"])
    return read


def pattern(message):
    """The message as a regular expression, … for any text of a line."""
    return ".*".join(re.escape(piece) for piece in message.split("…"))


def fenced(language, text):
    return f"```{language}\n{text.strip()}\n```\n"


def wrapped(text):
    """A command and what it prints: messages are longer than a phone is wide."""
    return fenced("{code-block} console", f":class: wrapped\n\n{text}")


def page(root):
    out = []
    for group in groups(root):
        out += [f"## {group['title']}\n", *([group["text"] + "\n"] if "text" in group else [])]
        for entry in group["error"]:
            out.append(f"### {entry['title']}\n")
            out.append(wrapped(f"$ {entry['command']}\n{entry['message']}"))
            for name, text in entry["files"].items():
                out.append(f"`{name}`:\n\n" + fenced(LANGUAGES[Path(name).suffix], text))
            out.append(f"**Cause.** {entry['cause']}\n")
            out.append(f"**Cure.** {entry['cure']}\n")
            if "change" in entry:
                old, new = entry["change"]
                name = next(iter(entry["files"]))
                out.append((f"In `{name}`, instead of the lines above:\n\n" if new else f"Leave out of `{name}`:\n\n")
                           + fenced(LANGUAGES[Path(name).suffix], lines_with(entry["cured_files"][name], new) if new else old))
            else:
                out.append(wrapped(f"$ {entry['cured']}"))
    return "\n".join(out)


def lines_with(text, piece):
    """The whole lines of a text that have a piece of it."""
    begin = text.index(piece)
    first = text.rfind("\n", 0, begin) + 1
    end = text.find("\n", begin + len(piece))
    return text[first:end if end >= 0 else len(text)]
