"""The gallery: every registered system with its picture, its facts and its command, from the program; and the motions of the front page.

Pictures are kept in BUILD/docs/gallery under the hash of the program and of the command, so that a second build draws none.
"""
import hashlib
import html
import json
import re
import shutil
import subprocess
from concurrent.futures import ThreadPoolExecutor

# Options for systems that 10 s from their own start do not show well.
OPTIONS = {
    "bicycle": "--speed 5 --until 3",
    "falling_disk": "--until 6",
    "kick_scooter": "--until 2",
    "rattleback": "--until 3",
    "segway": "--until 1",
    "unicycle_3d": "--until 1",
}
PLAYED = "roller_racer"  # on the front page, from above


def hamel(program, *arguments):
    done = subprocess.run([program, *arguments], capture_output=True, text=True)
    if done.returncode not in (0, 1):
        raise SystemExit(f"docs: hamel {' '.join(arguments)}: {done.stderr}")
    return done


def picture(program, folder, name):
    """The picture of a run's page, or None if the page has neither a motion nor a path."""
    options = OPTIONS.get(name, "--until 10").split()
    recorded, drawn = folder / f"{name}.h5", folder / f"{name}.png"
    if drawn.exists():
        return drawn
    hamel(program, "run", name, *options, "--output-step", "0.02", "-o", str(recorded), "--quiet")
    for figure in ("motion", "path", "axes"):
        done = subprocess.run([program, "report", str(recorded), "--figure", figure, "-o", str(drawn), "--width", "9cm"],
                              capture_output=True, text=True)
        if done.returncode == 0:
            return drawn
    if "chromium" in done.stderr:
        raise SystemExit(f"docs: {done.stderr}")
    names = re.search(r"expected (?:one of )?(.*)", done.stderr)
    raise SystemExit(f"docs: no picture of {name}: {done.stderr}" + (names[1] if names else ""))


def number(value):
    if value is None:
        return "not set"
    return ", ".join(f"{x:.6g}" for x in value) if isinstance(value, list) else f"{value:.6g}"


def facts(program, name, summary, playground):
    told = json.loads(hamel(program, "describe", name, "--json").stdout)
    lines = [f"## {name}\n", f"{summary[0].upper()}{summary[1:]}.\n", f"![{summary}](/images/gallery/{name}.png)\n",
             "```", f"hamel run {name} {OPTIONS.get(name, '--until 10')} --report {name}.html", "```\n",
             *([f"```{{raw}} html\n<p><a href=\"playground/index.html#{name}\">Open it in the playground</a></p>\n```\n"] if playground else [])]
    rows = [("Group", told["group"]), ("Equations", told["formula"]), ("Exactly known", told["known"]), ("Source", told["source"])]
    lines += ["| | |", "|---|---|"] + [f"| {k} | {escape(v)} |" for k, v in rows if v]
    if told.get("inputs"):
        lines.append("| Inputs | " + escape(", ".join(f"{i['name']} ({i['unit']})" for i in told["inputs"])) + " |")
    if told["parameters"]:
        lines += ["", "| parameter | default | | |", "|---|---|---|---|"]
        lines += [f"| `{p['name']}` | {number(p['default'])} | {escape(p['unit'])} | {escape(p['meaning'])} |"
                  for p in told["parameters"]]
    return "\n".join(lines) + "\n"


def escape(text):
    return re.sub(r"([\\*_`\[\]<|$])", r"\\\1", text)


def motion(root, program, folder):
    """The motion of the front page: the block that the page of a run draws, in the player of the notebooks."""
    page = folder / "played.html"
    if not page.exists():
        hamel(program, "run", PLAYED, "--until", "7", "--output-step", "0.05", "--report", str(page), "--quiet")
    text = re.search(r'id="hamel-data">(.*?)</script>', page.read_text(), re.S)[1]
    blocks = [block for section in json.loads(text)["sections"] for block in section["blocks"]]
    block = next(block for block in blocks if block["kind"] == "animation")
    block["title"] = "A roller racer, from above, drives forward because its handlebar is turned to and fro"
    data = json.dumps(block, separators=(",", ":")).replace("</", "<\\/")
    player = (root / "tools/python/hamel/animation.html").read_text().replace("__MOTION__", data)
    return f'<div class="motion" id="played"><iframe srcdoc="{html.escape(player)}" title="{block["title"]}"></iframe></div>'


def texts(root, build, site):
    program = str(build / "tools/hamel")
    playground = (build / "playground/site/index.html").exists()
    systems = json.loads(hamel(program, "list", "systems", "--json").stdout)
    names = [system["name"] for system in systems]
    version = hashlib.sha256((build / "tools/hamel").read_bytes() + json.dumps(OPTIONS).encode()).hexdigest()[:16]
    folder = build / "docs/gallery" / version
    for old in (build / "docs/gallery").glob("*"):
        if old != folder:
            shutil.rmtree(old)
    folder.mkdir(parents=True, exist_ok=True)
    with ThreadPoolExecutor(2) as pool:
        drawn = list(pool.map(lambda name: picture(program, folder, name), names))
        told = list(pool.map(lambda system: facts(program, system["name"], system["summary"], playground), systems))
    for file in drawn:
        site.image(file, "images/gallery")
    tiles = "".join(f'<a href="#{name.replace("_", "-")}"><img loading="lazy" alt="" src="_images/{name}.png">'
                    f"<span>{html.escape(name)}</span></a>" for name in names)
    return {
        "gallery.txt": f'```{{raw}} html\n<div class="tiles">{tiles}</div>\n```\n\n' + "\n".join(told),
        "motion.txt": "```{raw} html\n" + motion(root, program, folder) + "\n```\n",
    }
