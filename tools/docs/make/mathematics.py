"""Displayed equations of a README, plain text in Unicode, as LaTeX, which typeset.mjs sets with KaTeX.

    (M18)  s = 0, or a one-parameter τ:   Eᵀ (dR_ξ)⁻ᵀ I E y = μ̄_k

A block of lines indented by four spaces that begins with a number, and those that hold more symbols than words, are equations.
"""
import json
import re
import subprocess
import unicodedata

RAISED = {**dict(zip("⁰¹²³⁴⁵⁶⁷⁸⁹⁺⁻ⁿ", "0123456789+-n")), "ᵀ": r"\top ", "*": "*"}
LOWERED = dict(zip("₀₁₂₃₄₅₆₇₈₉ₙᵢₖⱼ", "0123456789nikj"))
ACCENTS = {"\u0302": "hat", "\u0307": "dot", "\u0304": "bar", "\u0303": "tilde", "\u0308": "ddot"}
SYMBOLS = {"·": r"\cdot ", "×": r"\times ", "∘": r"\circ ", "⇔": r"\;\Leftrightarrow\;", "≤": r"\le ", "≥": r"\ge ", "≠": r"\ne ", "∫": r"\int ",
           "Σ": r"\sum ", "…": r"\dots ", "⟨": r"\langle ", "⟩": r"\rangle ", "∂": r"\partial ", "𝔡": r"\mathfrak{d}", "𝔤": r"\mathfrak{g}",
           "ℝ": r"\mathbb{R}", "½": r"\tfrac12 ", "¼": r"\tfrac14 ", "′": "'", "{": r"\{", "}": r"\}", "→": r"\to ", "∈": r"\in ", "%": r"\%",
           "#": r"\#", "&": r"\&", "±": r"\pm ", "⊗": r"\otimes ", "=\u0338": r"\ne "}
NAMES = {"Ad": r"\mathrm{Ad}", "ad": r"\mathrm{ad}", "dL": r"\mathrm{d}L", "dR": r"\mathrm{d}R", "dV": r"\mathrm{d}V", "dt": r"\,\mathrm{d}t",
         "dz": r"\,\mathrm{d}z", "err": r"\mathrm{err}", "SO": r"\mathrm{SO}", "SE": r"\mathrm{SE}", "id": r"\mathrm{id}", "Id": r"\mathrm{Id}",
         **{name: rf"\{name} " for name in ("exp", "sin", "cos", "tan", "log", "ker", "max", "min", "det")}, "atan": r"\operatorname{atan}"}
PRODUCTS = {"sh", "th", "nn", "dz", "ab", "hv"}  # of letters; and words of more than one capital, or with one behind the first letter
TOKEN = re.compile(r"""(?P<gap>\ {2,})|(?P<space>\ )|(?P<derivative>d/d[εztσ])|(?P<reference>\(M\d+\))
  |(?P<matrix>\[\[[^\]]*\],\ \[[^\]]*\]\])|(?P<wedge>\^(?=[\s,;)]|$))|(?P<script>[_^])|(?P<raised>[⁰¹²³⁴⁵⁶⁷⁸⁹⁺⁻ⁿᵀ*]+)|(?P<lowered>[₀₁₂₃₄₅₆₇₈₉ₙᵢₖⱼ½]+(?<=[₀₁₂₃₄₅₆₇₈₉ₙᵢₖⱼ]))
  |(?P<word>[A-Za-z]{2,}(?:[-–'][A-Za-z]{2,})*)|(?P<hyphened>(?<=[A-Za-z])-[a-z]{3,})|(?P<number>\d+(?:\.\d+)?)|(?P<any>.[\u0300-\u036f]*)""", re.X)


def is_product(word):
    return word in PRODUCTS or (re.fullmatch(r"[A-Za-z]{2,3}", word) and re.search(r"[A-Z]", word[1:]) and word not in NAMES) or word in ("Ey", "Iv")


def group_end(text, at):
    """Behind the closing brace of the group that begins at `at`."""
    depth = 0
    for i in range(at, len(text)):
        depth += {"{": 1, "}": -1}.get(text[i], 0)
        if depth == 0:
            return i + 1
    raise ValueError(f"no }} in {text[at:]}")


def tokens(text):
    """(kind, LaTeX) of a text."""
    at, out = 0, []
    while at < len(text):
        match = TOKEN.match(text, at)
        kind, token = match.lastgroup, match[0]
        at = match.end()
        if kind == "script":
            if text[at] == "{":
                end = group_end(text, at)
                inside = latex(text[at + 1:end - 1])
            else:
                end = re.compile(r"\w[\u0300-\u036f]*").match(text, at).end()
                inside = latex(text[at:end])
            out.append(("script", f"{token}{{{inside}}}"))
            at = end
        elif kind == "raised":
            out.append(("script", "^{" + "".join(RAISED[c] for c in token) + "}"))
        elif kind == "lowered":
            out.append(("script", "_{" + "".join(LOWERED[c] for c in token) + "}"))
        elif kind == "wedge":
            out.append(("script", r"^{\wedge}"))
        elif kind == "matrix":
            rows = re.findall(r"\[+([^\[\]]*)\]", token)
            cells = (" & ".join(latex(cell) for cell in row.split(", ")) for row in rows)
            out.append(("sign", r"\begin{pmatrix}" + r" \\ ".join(cells) + r"\end{pmatrix}"))
        elif kind == "reference":
            out.append(("sign", rf"\href{{#{token[1:-1]}}}{{\text{{{token}}}}}"))
        elif kind == "derivative":
            out.append(("sign", rf"\tfrac{{\mathrm{{d}}}}{{\mathrm{{d}}{token[-1]}}}\,"))
        elif kind == "word":
            if token in NAMES:
                out.append(("sign", NAMES[token]))
            else:
                out.append(("sign", token) if is_product(token) else ("text", token))
        elif kind == "hyphened":
            out.append(("text", token))
        elif kind == "gap":
            out.append(("space", r"\quad "))
        elif kind == "space":
            out.append(("space", " "))
        elif kind == "any":
            sign, accents = (SYMBOLS[token], "") if token in SYMBOLS else (SYMBOLS.get(token[0], token[0]), token[1:])
            for accent in accents:
                sign = rf"\{ACCENTS[accent]}{{{sign}}}"
            out.append(("sign", sign))
        else:
            out.append(("sign", token))
    return out


def latex(text):
    out, words = [], []

    def end_of_words():
        if words:
            said = "".join(words)
            set_words = [rf"\text{{{word}}}" for word in said.split()]
            out.append("\\ \\allowbreak ".join([*set_words, ""] if said.endswith(" ") else set_words))
            words.clear()

    for kind, token in tokens(unicodedata.normalize("NFD", text)):
        if kind == "text" or (words and kind == "space" and token == " "):
            if kind == "text" and not words and out and out[-1] == " ":
                out[-1] = "\\ "
            words.append(token)
        else:
            end_of_words()
            out.append(token)
    end_of_words()
    return "".join(out).strip()


BLOCK = re.compile(r"(?:^ {4}.*\n(?: *\n(?= {4}))?)+", re.M)


def equations(block):
    """[(number or "", indentation, pieces)] of the lines of a block, or None of one that is no equation."""
    lines = [line[4:].rstrip() for line in block.splitlines() if line.strip()]
    symbols = re.findall(r"[\u0370-\u03ff\u2070-\u209f=⁻¹²ᵀ′]", block)
    if not re.match(r"\(M\d+\)", lines[0]) and (len(symbols) < 4 or re.search(r"--|#|hamel |std::|\w\(\w+\)\s*\{", block)):
        return None
    out, column = [], 0
    for line in lines:
        number = re.match(r"\((M\d+)\)( +)", line)
        if number:
            column = number.end()
        body = line[number.end():] if number else line.strip()
        indented = 0 if number else max(0, len(line) - len(line.lstrip()) - column)
        out.append((number[1] if number else "", indented, [latex(piece) for piece in re.split(r" {3,}", body)]))
    return out


class Typesetter:
    """Blocks of equations in Markdown as HTML, by KaTeX."""

    def __init__(self, script, packages):
        self.command = ["node", str(script), str(packages)]

    def rendered(self, formulas):
        done = subprocess.run(self.command, input=json.dumps(formulas), capture_output=True, text=True)
        if done.returncode:
            raise SystemExit(f"docs: {done.stderr}")
        return json.loads(done.stdout)

    def typeset(self, markdown):
        blocks = [(match, equations(match[0])) for match in BLOCK.finditer(markdown)]
        blocks = [(match, lines) for match, lines in blocks if lines]
        html = iter(self.rendered([piece for _, lines in blocks for _, _, pieces in lines for piece in pieces]))
        out, at = [], 0
        for match, lines in blocks:
            rows = []
            for number, indented, pieces in lines:
                place = f'<span id="{number}" class="place">({number})</span>' if number else "<span></span>"
                style = f' style="padding-left:{indented / 2:.1f}ch"' if indented else ""
                rows.append(f'{place}<div{style}>{"".join(f"<span class=piece>{next(html)}</span> " for _ in pieces)}</div>')
            out += [markdown[at:match.start()], '```{raw} html\n<figure class="equations">\n', "\n".join(rows), "\n</figure>\n```\n\n"]
            at = match.end()
        return "".join(out) + markdown[at:]
