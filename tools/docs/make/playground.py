"""Links to the playground, where it is built: a page with a run in it."""
import base64
import html
import json
import re
import zlib

# A whole system, not a part of one: a fenced block that begins with its name.
TOML = re.compile(r"^```(?:toml|\{code-block\} toml\n:caption: \S+)\n((?:#.*\n)*name = (?:(?!^```).)*?)^```$\n", re.S | re.M)


def is_built(build):
    return (build / "playground/site/index.html").exists()


def address(text="", system="", options=None, inputs=None):
    """From the root of the site; its fragment is that of `fragmentOf` in tools/playground/page/src/state.js."""
    state = {"system": system, "options": options or {}, "parameters": {}, "inputs": inputs or {}} | ({"text": text} if text else {})
    packed = zlib.compressobj(9, wbits=-15)
    data = packed.compress(json.dumps(state).encode()) + packed.flush()
    return "playground/index.html#~" + base64.urlsafe_b64encode(data).decode().rstrip("=")


def link(target, words):
    return f'```{{raw}} html\n<p class="try"><a href="{html.escape(target)}">{words}</a></p>\n```\n'


def with_links(text, page):
    """The page, with a link below each file of a system in it."""
    up = "../" * page.count("/")
    return TOML.sub(lambda match: f"{match[0]}\n{link(up + address(text=match[1]), 'Open it in the playground')}", text)


def texts(build):
    """Of the front page and of the tutorial: how to begin without installing anything."""
    if not is_built(build):
        where = (
            '```{raw} html\n<p class="try first"><a href="howto/playground.html">The playground</a> moves them in a browser, with nothing to '
            "install; this copy of the site was built without it.</p>\n```\n"
        )
        return {"try_first.txt": where, "try_files.txt": ""}
    return {
        "try_first.txt": "```{raw} html\n"
        '<p class="try first"><a href="playground/index.html">Try it here: the playground</a> It has a bicycle that moves, and its text to change; '
        'nothing to install. <a href="playground/index.html#segway">Drive a segway</a>, '
        '<a href="playground/index.html#rattleback">spin a rattleback</a>, <a href="gallery.html">or any of these</a>.</p>\n```\n',
        "try_files.txt": "Nothing needs to be installed for a first look: the link below each file opens it in [the playground](/howto/playground.md), where "
        "it moves at once and where you change it.\n\n" + link("../playground/index.html#kick_scooter", "The scooter of minute one, in the playground"),
    }
