"""completion.py PREFIX: hamel installed in PREFIX is completed in bash, zsh and fish, in a terminal.

Names come from files of anyone: one that a shell would expand, run or cut reaches the program as it is, or is not offered.
A shell that is not installed is left out, but not where CI is set.
"""
import os
import pty
import re
import select
import shutil
import sys
import tempfile
import time

prefix = os.path.realpath(sys.argv[1])
SHELLS = {
    "bash": (["bash", "--norc", "--noprofile", "-i"],
             f"source {prefix}/share/bash-completion/completions/hamel; bind 'set show-all-if-ambiguous on'"),
    "zsh": (["zsh", "-f", "-i"], f"fpath=({prefix}/share/zsh/site-functions $fpath); autoload -U compinit; compinit -u -D; setopt no_list_ambiguous"),
    "fish": (["fish", "--no-config", "-i"], f"source {prefix}/share/fish/vendor_completions.d/hamel.fish"),
}
# What is typed before the TAB, and what the shell shows then.
CASES = [
    ("hamel ru", "hamel run"),
    ("hamel run rattle", "hamel run rattleback"),
    ("hamel run sus", "suslov_in_potential"),
    ("hamel run suslov --set in", "--set inertia="),
    ("hamel run suslov --scheme li", "--scheme lift"),
    ("hamel run suslov --retr", "--retraction"),
    ("hamel run rattleback --events rev", "--events reversed"),
    ("hamel help ens", "hamel help ensemble"),
    ("hamel list retr", "hamel list retractions"),
]
# Names of an event or a joint, completed and sent off with Enter. None of them leaves the file `ran`.
HOSTILE = ["$(touch ran)", "`touch ran`", "a;touch ran", "a&touch ran", "a|touch ran", "a>ran", "$IFS", "two words", "it's", "star*", "~",
           "{a}", "bang!!", "#x", "x[1]", "(touch ran)", "Ünï", "a\"b", "back\\slash", "x\u001by", "x\ny"]
# Not offered: what JSON writes with a backslash, and ~, which fish expands.
OFFERED = [name for name in HOSTILE if not any(c in name for c in "~\"\\\x1b\n")]
SYSTEM = """[[body]]
name = "a"
mass = 1
inertia = [1, 1, 1]
[[joint]]
name = {name}
kind = "hinge"
child = "a"
[[motor]]
joint = {name}
[events]
{name} = "t - 0.05"
"""
SYSTEM_BY_DATA = """group = "so2"
inertia = [1]
velocity = [1]
[events]
{name} = "t - 0.05"
"""


def read(fd, until, patience):
    """What appears on the terminal until the text or the patience ends, without its control sequences."""
    shown, end = b"", time.monotonic() + patience
    while time.monotonic() < end:
        if select.select([fd], [], [], 0.1)[0]:
            try:
                shown += os.read(fd, 65536)
            except OSError:
                break
        text = re.sub(rb"\x1b\[[0-9;?]*[a-zA-Z]|\x1b[()=>][A-Z0-9]?|\x1b\][^\x07]*\x07|\x07", b"", shown).decode(errors="replace")
        if until in text:
            return text, True
    return text if shown else "", False


def try_shell(name, command, setup):
    child, fd = pty.fork()
    if child == 0:
        os.environ.update(PATH=f"{prefix}/bin:{os.environ['PATH']}", TERM="xterm", PS1="> ", HOME="/tmp", COLUMNS="200", LINES="50")
        os.execvp(command[0], command)
    failed = 0
    try:
        read(fd, "> ", 3)
        os.write(fd, f"stty columns 200; {setup}; echo set'-'up\r".encode())
        read(fd, "set-up", 20)
        for typed, expected in CASES:
            os.write(fd, b"\x15")  # an empty line
            read(fd, "never shown", 0.3)
            os.write(fd, typed.encode() + b"\t")
            text, found = read(fd, expected, 10)
            if not found:
                failed += 1
                print(f"FAILED: {name}: '{typed}' and a TAB show\n{text[-400:]!r}\nexpected '{expected}'")
        failed += try_names(fd, name)
        os.write(fd, b"\x15exit\r")
    finally:
        os.close(fd)
        os.waitpid(child, 0)
    print(f"{name}: {len(CASES) + len(HOSTILE) - failed} of {len(CASES) + len(HOSTILE)}")
    return failed


def try_names(fd, name):
    """Hostile names, each the only candidate: what is run is `hamel`, with the name as its argument."""
    failed = 0
    status = "$status" if name == "fish" else "$?"
    with tempfile.TemporaryDirectory() as folder:
        os.write(fd, f"\x15cd {folder}; echo mo'v'ed\r".encode())
        read(fd, "moved", 10)
        for i, hostile in enumerate(HOSTILE):
            quoted = '"' + "".join(f"\\u{ord(c):04x}" for c in hostile) + '"'
            named_joint = not any(c in hostile for c in '",\x1b\n')
            with open(f"{folder}/{i}.toml", "w") as file:
                file.write((SYSTEM if named_joint else SYSTEM_BY_DATA).replace("{name}", quoted))
            lines = [f"hamel run {i}.toml --until 0.1 --quiet --events \t"]
            if named_joint:
                lines.append(f"hamel run {i}.toml --until 0.1 --quiet --input \t0")
            for line in lines:
                os.write(fd, b"\x15")
                read(fd, "never shown", 0.2)
                os.write(fd, line.split("\t")[0].encode() + b"\t")
                read(fd, "never shown", 1.5)
                os.write(fd, f"{line.split(chr(9))[1]}; echo sta'tu's={status}\r".encode())
                text, _ = read(fd, "status=", 5)
                more, _ = read(fd, "never shown", 0.3)
                ended = re.search(r"status=(\d+)", text + more)
                ran = os.path.exists(f"{folder}/ran")
                if ran or not ended or (ended[1] == "0") != (hostile in OFFERED):
                    failed += 1
                    print(f"FAILED: {name}: the name {hostile!r}: {'was run' if ran else 'arrived as another one'}: {text[-300:]!r}")
                if ran:
                    os.remove(f"{folder}/ran")
    return failed


missing = [name for name in SHELLS if not shutil.which(name)]
if missing:
    print(f"{'FAILED: ' if os.environ.get('CI') else ''}not installed: {', '.join(missing)}")
failed = sum(try_shell(name, *how) for name, how in SHELLS.items() if name not in missing)
sys.exit(1 if failed or missing and os.environ.get("CI") else 0)
