"""Count what a fragment shader does per pixel, by the shader itself, on the path that it takes.

Every statement of the assembled GLSL first adds its own texture fetches and arithmetic to two
counters; what stands in a loop adds them each time round, what stands in a branch not taken adds
nothing. So the figures hold for one picture on any driver. They are those of the source: a driver's
optimiser makes less of them, and splits vector operations into components if its processor has no
vectors. One of each counts: a fetch; an operator ``+ - * / % ^ & | << >>`` or its assignment; a
call of a built-in function that computes. Comparisons, loop counters, swizzles, constructors, signs
and the header's constants count nothing; both sides of ``?:`` count.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import Final

FETCHES: Final = frozenset({"texture", "textureLod", "textureGrad", "texelFetch"})
FUNCTIONS: Final = frozenset(
    re.findall(
        r"\w+",
        "abs acos asin atan ceil clamp cos cross degrees distance dot exp exp2 faceforward floor "
        "fma fract inverse inversesqrt length log log2 max min mix mod normalize pow radians "
        "reflect refract round sign sin smoothstep sqrt step tan transpose trunc",
    )
)
_OPERATORS: Final = frozenset({"+", "-", "*", "/", "%", "^", "&", "|", "<<", ">>"})
_ASSIGNMENTS: Final = frozenset(operator + "=" for operator in _OPERATORS)
_TOKEN: Final = re.compile(
    r"(?P<skip>\s+|//[^\n]*|/\*.*?\*/)|(?P<line>\#[^\n]*)"
    r"|(?P<word>[A-Za-z_]\w*|\d*\.?\d+(?:[eE][-+]?\d+)?\w*|\d+\.)"
    r"|(?P<sign>\+\+|--|(?:<<|>>|[-+*/%<>=!^&|])=|&&|\|\||<<|>>|.)",
    re.DOTALL,
)
_FOOTER: Final = """
void main() {
    counted_main();
    bool is_seen = any(greaterThan(f_radiance.rgb, vec3(0.0)));
    f_radiance = vec4(float(g_fetches), float(g_arithmetic), is_seen ? 1.0 : 0.0, 1.0);
}
"""


@dataclass(frozen=True)
class Tally:
    """How many fetches and arithmetic operations some tokens hold."""

    fetches: int
    arithmetic: int


def counted(source: str) -> str:
    """Return a fragment shader that writes its counts instead of ``f_radiance``.

    Red: fetches; green: arithmetic; blue: 1 where the shader itself wrote any light.
    Raises ValueError for GLSL that it cannot follow (``switch``, ``do``).
    """
    tokens = _tokens(source)
    version = [token for token in tokens if token.startswith("#version")]
    body = [token for token in tokens if not token.startswith("#")]
    body = ["counted_main" if token == "main" else token for token in body]
    text = " ".join(_Rewriter(body).rewritten())
    return "\n".join([*version, "int g_fetches = 0, g_arithmetic = 0;", text, _FOOTER])


def tally(tokens: list[str]) -> Tally:
    """Count the fetches and arithmetic of an expression or a declaration."""
    if tokens and tokens[0] == "const":
        return Tally(0, 0)
    before = ["", *tokens[:-1]]
    arithmetic = sum(
        token in _ASSIGNMENTS
        or (token in _OPERATORS and _ends_operand(last))
        or (token in FUNCTIONS)
        for last, token in zip(before, tokens, strict=True)
    )
    return Tally(sum(token in FETCHES for token in tokens), arithmetic)


def _ends_operand(token: str) -> bool:
    """Say whether a sign after this token has a left operand: otherwise it is no operation."""
    return token in {")", "]"} or (bool(re.match(r"[\w.]", token)) and token != "return")


def _tokens(source: str) -> list[str]:
    return [match[0] for match in _TOKEN.finditer(source) if match.lastgroup != "skip"]


class _Rewriter:
    """Walk the statements of every function body and put the counting before them."""

    def __init__(self, tokens: list[str]) -> None:
        self._tokens = tokens
        self._at = 0

    def rewritten(self) -> list[str]:
        """Return all tokens, those of function bodies with their counting."""
        out: list[str] = []
        while self._at < len(self._tokens):
            opens_body = self._tokens[self._at] == "{" and out[-1:] == [")"]
            out += self._block() if opens_body else self._take(1)
        return out

    def _block(self) -> list[str]:
        out = self._take(1)
        while self._tokens[self._at] != "}":
            out += self._statement()
        return out + self._take(1)

    def _statement(self) -> list[str]:
        """Return one statement after its counting; not for use without braces around it."""
        word = self._tokens[self._at]
        if word in {"switch", "do"}:
            raise ValueError(f'"{word}": counting knows if, for and while; write one of these')
        if word == "{":
            return self._block()
        if word == "if":
            return self._branch()
        if word in {"for", "while"}:
            return self._loop()
        statement = self._take(self._tokens.index(";", self._at) + 1 - self._at)
        return _counting(tally(statement)) + statement

    def _branch(self) -> list[str]:
        head = self._take(1) + self._parentheses()
        out = _counting(tally(head)) + head + self._braced()
        if self._at < len(self._tokens) and self._tokens[self._at] == "else":
            out += self._take(1) + self._braced()
        return out

    def _loop(self) -> list[str]:
        # A loop's own condition and step are bookkeeping: a counter compiles to nothing or to one
        # comparison. A `while` that computes does not occur.
        return self._take(1) + self._parentheses() + self._braced()

    def _braced(self) -> list[str]:
        return ["{", *self._statement(), "}"]

    def _parentheses(self) -> list[str]:
        depth, end = 0, self._at
        while True:
            depth += {"(": 1, ")": -1}.get(self._tokens[end], 0)
            end += 1
            if depth == 0:
                return self._take(end - self._at)

    def _take(self, count: int) -> list[str]:
        taken = self._tokens[self._at : self._at + count]
        self._at += count
        return taken


def _counting(found: Tally) -> list[str]:
    out = []
    if found.fetches:
        out.append(f"g_fetches += {found.fetches};")
    if found.arithmetic:
        out.append(f"g_arithmetic += {found.arithmetic};")
    return out
