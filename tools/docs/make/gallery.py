"""The gallery: every registered system, and examples of tests/examples, each with its picture, its facts and its command, from the program; and the
motions of the front page.

Pictures are kept in BUILD/docs/gallery under the hash of the program and of the command, so that a second build draws none.
"""
import hashlib
import html
import json
import re
import shutil
import subprocess
from concurrent.futures import ThreadPoolExecutor

import playground

# Options for systems that 10 s from their own start do not show well.
OPTIONS = {
    "bicycle": "--speed 5 --until 3",
    "falling_disk": "--until 6",
    "kick_scooter": "--until 2",
    "rattleback": "--until 3",
    "segway": "--until 1",
    "unicycle_3d": "--until 1",
}
# Files of tests/examples: what slides, opens and strikes. name: the words of the system, of its run, and of a picture of several times.
ROBOT = "tests/examples/skid_steered.urdf --wheel auto,friction=0.6 --root"
TURN = " ".join(f"--input {wheel}_axle.torque={torque}" for wheel, torque in
                (("front_left", -6), ("rear_left", -6), ("front_right", 6), ("rear_right", 6)))
EXAMPLES = {
    "braked_car": ("tests/examples/braked_car.toml", "--slip --until 5", "--strobe 6"),
    "rolling_car": ("tests/examples/rolling_car.toml", "--slip --until 5", "--strobe 6"),
    "cart_with_brake": ("tests/examples/cart_with_brake.toml", "--slip --until 6 --input rear.brake=tests/examples/cart_with_brake.csv", ""),
    "skate_that_slips": ("tests/examples/skate_that_slips.toml", "--slip --until 2", "--strobe 6"),
    "skid_steered_planar": (f"{ROBOT} planar", f"{TURN} --until 4", ""),
    "skid_steered_free": (f"{ROBOT} free", f"{TURN} --until 4", ""),
    "sliding_table": ("tests/examples/sliding_table.toml", "--slip --until 2", "--strobe 4"),
    "door_with_friction": ("tests/examples/door_with_friction.toml", "--slip --until 5", "--strobe 4"),
    "ball_on_shaken_table": ("tests/examples/ball_on_shaken_table.toml", "--slip --until 2", ""),
    "ball_off_a_dome": ("tests/examples/ball_off_a_dome.toml", "--slip --until 1.6", "--strobe 8"),
    "billiard_ball": ("--config tests/examples/billiard_ball.toml", "", "--strobe 6"),
    "rimless_wheel": ("tests/examples/rimless_wheel.toml", "--until 10", "--strobe 4 --at 2"),
    "woodpecker_toy": ("tests/examples/woodpecker_toy.toml", "--slip --until 1 --output-step 0.002", ""),
    "spun_coin": ("--config tests/examples/spun_coin.toml", "", ""),
    "thrown_box": ("tests/examples/thrown_box.toml", "--slip --until 0.6", "--strobe 6"),
}
PLAYED = "roller_racer"  # on the front page, from above


def hamel(program, *arguments, root=None):
    done = subprocess.run([program, *arguments], capture_output=True, text=True, cwd=root)
    if done.returncode not in (0, 1):
        raise SystemExit(f"docs: hamel {' '.join(arguments)}: {done.stderr}")
    return done


class Entry:
    """A system of the gallery: the words of its run, and where it is a file of the repository that file."""

    def __init__(self, name, system, run, times=""):
        self.name, self.system, self.run, self.times = name, system.split(), run.split(), times.split()
        self.file = next((word for word in self.system if word.startswith("tests/")), "")
        self.is_configuration = self.system[0] == "--config"

    def summary(self, root):
        """The comment at the beginning of its file."""
        comment = re.match(r"(?:<\?xml.*\n)?(?:<!--(.*?)-->|((?:# .*\n)+))", (root / self.file).read_text(), re.S)
        text = re.sub(r"^#? *", "", comment[1] or comment[2], flags=re.M)
        return " ".join(re.split(r"^(?:hamel|Source:) ", text, flags=re.M)[0].split()).rstrip(".:")


def entries(systems):
    registered = [Entry(name, name, OPTIONS.get(name, "--until 10")) for name in systems]
    return registered, [Entry(name, *words) for name, words in EXAMPLES.items()]


def picture(program, root, folder, entry):
    """The picture of a run's page, of its motion where there is one."""
    recorded, drawn = folder / f"{entry.name}.h5", folder / f"{entry.name}.png"
    if drawn.exists():
        return drawn
    rows = [] if entry.is_configuration or "--output-step" in entry.run else ["--output-step", "0.02"]
    hamel(program, "run", *entry.system, *entry.run, *rows, "-o", str(recorded), "--quiet", root=root)
    several = [["--motion", *entry.times, "--size", "720x440"]] if entry.times else []
    for figure in [*several, *(["--figure", figure, "--width", "9cm"] for figure in ("motion", "path", "axes"))]:
        done = subprocess.run([program, "report", str(recorded), *figure, "-o", str(drawn)], capture_output=True, text=True)
        if done.returncode == 0:
            return drawn
    if "chromium" in done.stderr:
        raise SystemExit(f"docs: {done.stderr}")
    names = re.search(r"expected (?:one of )?(.*)", done.stderr)
    raise SystemExit(f"docs: no picture of {entry.name}: {done.stderr}" + (names[1] if names else ""))


def address(program, root, entry):
    """The page of the playground with this run in it."""
    text, options, inputs = "", {}, {}
    if entry.file.endswith(".toml"):
        text = (root / entry.file).read_text()
    elif entry.file:  # the playground reads no robots
        text = hamel(program, "describe", *entry.system, "--toml", root=root).stdout
    for option, value in re.findall(r"--(\S+)(?: (?!--)(\S+))?", " ".join(entry.run)):
        if option == "input":
            name, given = value.split("=")
            if not given.endswith(".csv"):  # the playground has a slider for each input, and no tables
                inputs[name] = float(given)
        else:
            options[option.replace("-", "_")] = value or "true"
    return playground.address(text, "" if entry.file else entry.name, options, inputs)


def number(value):
    if value is None:
        return "not set"
    return ", ".join(f"{x:.6g}" for x in value) if isinstance(value, list) else f"{value:.6g}"


def facts(program, root, entry, linked):
    words = entry.system
    if entry.is_configuration:
        words = re.findall(r'^system = "(\w+)"', (root / entry.file).read_text(), re.M)
    told = json.loads(hamel(program, "describe", *words, "--json", root=root).stdout)
    summary = entry.summary(root) if entry.file else told["summary"]
    command = " ".join(["hamel run", *entry.system, *entry.run, f"--report {entry.name}.html"])
    lines = [f"## {entry.name}\n", f"{summary[0].upper()}{escape(summary[1:])}.\n", f"![{entry.name}](/images/gallery/{entry.name}.png)\n",
             "```", re.sub(r"(.{60,}?) (?=--)", r"\1 \\\n    ", command), "```\n"]
    if linked:
        lines.append(playground.link(address(program, root, entry), "Open it in the playground"))
    rows = [("Group", told["group"]), ("Equations", escape(told.get("formula", ""))), ("Exactly known", escape(told.get("known", ""))),
            ("Source", escape(told.get("source", "")))]
    if entry.file:
        rows.append(("File", f"[{entry.file}](/{{}})"))
    lines += ["| | |", "|---|---|"] + [f"| {k} | {v} |" for k, v in rows if v]
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


def tiles(listed):
    return "".join(f'<a href="#{entry.name.replace("_", "-")}"><img loading="lazy" alt="" src="_images/{entry.name}.png">'
                   f"<span>{html.escape(entry.name)}</span></a>" for entry in listed)


def texts(root, build, site):
    program = str(build / "tools/hamel")
    systems = json.loads(hamel(program, "list", "systems", "--json").stdout)
    registered, examples = entries([system["name"] for system in systems])
    told = "".join((root / entry.file).read_text() for entry in examples)
    version = hashlib.sha256((build / "tools/hamel").read_bytes() + json.dumps([OPTIONS, EXAMPLES, told]).encode()).hexdigest()[:16]
    folder = build / "docs/gallery" / version
    for old in (build / "docs/gallery").glob("*"):
        if old != folder:
            shutil.rmtree(old)
    folder.mkdir(parents=True, exist_ok=True)
    both = registered + examples
    with ThreadPoolExecutor(2) as pool:
        drawn = list(pool.map(lambda entry: picture(program, root, folder, entry), both))
        texts = list(pool.map(lambda entry: facts(program, root, entry, playground.is_built(build)), both))
    for file in drawn:
        site.image(file, "images/gallery")
    texts = [text.replace("(/{})", f"({site.file_page(root / entry.file, entry.file)})") if entry.file else text
             for entry, text in zip(both, texts)]
    return {
        "gallery.txt": f'''```{{raw}} html
<div class="tiles">{tiles(registered)}</div>
<p>Contacts that slide, open and strike:</p>
<div class="tiles">{tiles(examples)}</div>
```

''' + "\n".join(texts),
        "motion.txt": "```{raw} html\n" + motion(root, program, folder) + "\n```\n",
    }
