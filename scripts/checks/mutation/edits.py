# SPDX-License-Identifier: MIT OR Apache-2.0
"""The mutations of a module: every place that an operator of mutation applies to."""
from verilog import CLOSES, DECLARES, KEYWORDS, declared, literals, partners, statements, tokens

REPLACEMENTS = {"+": ["-"], "-": ["+"], "*": ["+"], "&&": ["||"], "||": ["&&"], "==": ["!="], "!=": ["=="], "<": ["<=", ">="], ">": [">=", "<="],
         "<=": ["<", ">"], ">=": [">", "<"], "&": ["|"], "|": ["&"], "^": ["|"], "<<": [">>"], ">>": ["<<"]}


def edits(text, is_top, pick):
    """Returns (operator, start, end, replacement) of every mutation of a module."""
    stream = tokens(text)
    partner_of = partners(stream)
    first, depths = statements(stream, partner_of)
    names = declared(stream, partner_of)
    header = next((i for i, token in enumerate(stream) if token.text == ";"), 0)
    # The steps of loops, limits, and defaults of parameters are not mutated.
    excluded = set()
    for index, token in enumerate(stream):
        if token.text == "for":
            semicolons = [i for i in range(index + 1, partner_of[index + 1]) if stream[i].text == ";"]
            excluded.update(range(index, semicolons[0] + 1))
            excluded.update(range(semicolons[1], partner_of[index + 1] + 1))
        elif token.text == "@" and stream[index + 1].text == "(":
            excluded.update(range(index, partner_of[index + 1] + 1))
        elif token.kind == "word" and "_must_" in token.text:
            # A limit of a parameter, which no design exceeds.
            start = max(i for i in range(index) if stream[i].text == "if")
            excluded.update(range(start, next(i for i in range(index, len(stream)) if stream[i].text == ";") + 1))
    assigned_at, ranges = {}, {}
    for index, token in enumerate(stream):
        if depths[index] == 0 and token.text in ("=", "<=") and first[index] not in assigned_at:
            head = stream[first[index]].text
            if token.text == "=" or head not in DECLARES | {"assign"}:
                assigned_at[first[index]] = index
        if token.text == "[":
            head = stream[first[index]].text
            inside = stream[index + 1:partner_of[index]]
            before_value = first[index] not in assigned_at
            before = stream[index - 1].text
            if index < header:
                before_value = before in DECLARES | {"signed"}
            if (head in DECLARES or index < header) and before_value and any(t.text == ":" for t in inside):
                for i in range(index, partner_of[index] + 1):
                    ranges[i] = index
    found = []

    def edit(operator, start, end, replacement):
        found.append((operator, start, end, replacement))

    for index, token in enumerate(stream):
        start, end = token.start, token.end
        if index in ranges:
            # A narrower range: one bit or one word less.
            if ranges[index] == index and not (is_top and index < header):
                colon = next(i for i in range(index, partner_of[index]) if stream[i].text == ":")
                upwards = stream[index + 1].text == "0" and colon == index + 2
                position = stream[partner_of[index]].start if upwards else stream[colon].start
                if stream[first[index]].text not in ("parameter",):
                    edit("range", position, position, "-1")
            continue
        if index < header or index in excluded:
            continue
        statement, assigned = first[index], assigned_at.get(first[index])
        before = stream[index - 1]
        operand = before.kind in ("word", "number", "based") and before.text not in KEYWORDS or before.text in CLOSES
        if token.kind == "op" and token.text in REPLACEMENTS:
            if token.text == "<=" and index == assigned:
                # Without an assignment the value stays.
                close = next(i for i in range(index, len(stream)) if stream[i].text == ";" and depths[i] == 0)
                target = text[stream[statement].start:start].strip()
                edit("drop", stream[index + 1].start, stream[close].start, target)
            elif operand:
                for replacement in REPLACEMENTS[token.text]:
                    edit("operator", start, end, replacement)
            elif token.text in "&|":
                edit("operator", start, end, REPLACEMENTS[token.text][0])
        elif token.kind == "op" and token.text in "!~" and not operand:
            edit("negation", start, end, "")
        elif token.text == "?":
            position = index
            while True:
                position -= 1
                if stream[position].text in CLOSES and stream[position].kind == "op":
                    position = partner_of[position]
                elif stream[position].text in ("=", "(", "[", "{", ",", ":", "?") or position == assigned:
                    break
            edit("selection", stream[position + 1].start, start, f"!({text[stream[position + 1].start:start].strip()}) ")
        elif token.text == "if" and stream[index + 1].text == "(":
            inner = stream[index + 1].end, stream[partner_of[index + 1]].start
            edit("condition", *inner, f"!({text[inner[0]:inner[1]]})")
            edit("condition", *inner, "1'b0")
            edit("condition", *inner, "1'b1")
        elif token.kind in ("number", "based"):
            if before.text == "'" or stream[index - 1].text == "#":
                continue
            for replacement in literals(token):
                edit("constant", start, end, replacement)
        elif token.text == "[" and before.kind == "word" and before.text in names:
            # The next index, if the index is not a constant.
            inner = stream[index + 1:partner_of[index]]
            if any(t.kind == "word" for t in inner) and not any(t.text == ":" for t in inner):
                position = next((i for i in range(index, partner_of[index]) if stream[i].text in ("+:", "-:")), partner_of[index])
                edit("index", stream[position].start, stream[position].start, " + 1")
        elif token.kind == "word" and token.text in names and token.text != "clk_i":
            declares = stream[statement].text in DECLARES and (assigned is None or index < assigned)
            written = assigned is not None and index < assigned and depths[index] == 0
            connected = before.text == "."
            if declares or written or connected:
                continue
            same_kind = sorted(name for name, declaration in names.items()
                               if declaration == names[token.text] and name not in (token.text, "clk_i") and declaration[0] != "memory")
            if same_kind:
                edit("name", start, end, pick(f"{start}").choice(same_kind))
    return found
