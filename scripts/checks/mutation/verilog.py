# SPDX-License-Identifier: MIT OR Apache-2.0
"""Verilog as a stream of tokens: brackets, statements, literals, declared names. Only as much of the language as `edits` needs."""
import re

TOKEN = re.compile(r"""
    (?P<skip>\s+|//[^\n]*|/\*.*?\*/|`\w+[^\n]*|\(\*(?!\)).*?\*\))
  | (?P<string>"[^"]*")
  | (?P<based>\d*'[sS]?[bBdDoOhH][0-9a-fA-F_]+)
  | (?P<number>\d+)
  | (?P<word>\$?[A-Za-z_]\w*)
  | (?P<op><<<|>>>|===|!==|<<|>>|<=|>=|==|!=|&&|\|\||\+:|-:|\*\*|.)
""", re.X | re.S)
DECLARES = {"input", "output", "wire", "reg", "localparam", "parameter", "integer", "genvar"}
KEYWORDS = DECLARES | {"module", "endmodule", "always", "posedge", "assign", "if", "else", "begin", "end", "case", "endcase", "default",
                       "generate", "endgenerate", "for", "function", "endfunction", "or", "initial", "automatic", "signed"}
OPENS, CLOSES = "([{", ")]}"


class Token:
    def __init__(self, match):
        self.kind, self.text, self.start, self.end = match.lastgroup, match.group(), match.start(), match.end()


def tokens(text):
    found = [Token(match) for match in TOKEN.finditer(text)]
    return [token for token in found if token.kind != "skip"]


def partners(stream):
    """Returns for each bracket the index of its partner."""
    stack, partner_of = [], {}
    for index, token in enumerate(stream):
        if token.text in OPENS and token.kind == "op":
            stack.append(index)
        elif token.text in CLOSES and token.kind == "op":
            partner_of[index] = stack.pop()
            partner_of[partner_of[index]] = index
    return partner_of


def statements(stream, partner_of):
    """Returns for each token the index of the first token of its statement, and its depth in brackets."""
    first, start, depth, depths = [], 0, 0, []
    for index, token in enumerate(stream):
        closes = token.kind == "op" and token.text in CLOSES
        depth -= closes
        before = stream[index - 1] if index else None
        if before is not None and depth == 0 and (
            before.text in (";", "begin", "else", "end", "generate", "endgenerate", "endcase")
            or before.text == ")" and stream[partner_of[index - 1] - 1].text in ("if", "for", "case")
            or before.text == ")" and stream[partner_of[index - 1] - 1].text == "@"
            or before.kind == "word" and index > 2 and stream[index - 2].text == ":" and stream[index - 3].text == "begin"
            or before.text == ":" and stream[index - 2].text != "begin" and "?" not in (t.text for t in stream[start:index])
        ):
            start = index
        first.append(start)
        depths.append(depth)
        depth += token.kind == "op" and token.text in OPENS
    return first, depths


def literals(token):
    """Returns other values of a literal: one more, one less."""
    if token.kind == "number":
        value = int(token.text)
        return [str(other) for other in (value + 1, value - 1) if other >= 0]
    width, rest = token.text.split("'")
    base, digits = rest[0], rest[1:].replace("_", "")
    if base in "sS":
        return []
    radix = {"b": 2, "o": 8, "d": 10, "h": 16}[base.lower()]
    value, bits = int(digits, radix), int(width) if width else 32
    show = {2: f"{{:0{len(digits)}b}}", 8: "{:o}", 10: "{}", 16: "{:x}"}[radix]
    values = {(value + 1) % (1 << bits), (value - 1) % (1 << bits)} - {value}
    return [f"{width}'{base}{show.format(other)}" for other in sorted(values)]


def declared(stream, partner_of):
    """Returns names and the texts of their ranges; names with the same range can replace each other."""
    declarations, index = {}, 0
    while index < len(stream):
        token = stream[index]
        if token.kind == "word" and token.text in DECLARES - {"genvar", "integer"}:
            position, range_text = index + 1, ""
            while stream[position].text in ("wire", "reg", "signed"):
                position += 1
            if stream[position].text == "[":
                range_text = "".join(t.text for t in stream[position:partner_of[position] + 1])
                position = partner_of[position] + 1
            kind = "constant" if token.text in ("localparam", "parameter") else "signal"
            while position < len(stream) and stream[position].kind == "word" and stream[position].text not in KEYWORDS:
                memory = stream[position + 1].text == "["
                declarations[stream[position].text] = ("memory" if memory else kind, range_text)
                # Other names of a list without initial values.
                position += 1
                if stream[position].text == "," and stream[position + 1].text not in DECLARES:
                    position += 1
                else:
                    break
        index += 1
    return declarations
