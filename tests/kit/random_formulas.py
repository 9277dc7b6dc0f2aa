"""Random text in the formula language, the same for the same seed, and points to try it at."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

ONE = "sin cos tan atan sinh cosh tanh exp cbrt abs sign floor ceil fract round noise turbulence".split()
TWO = "atan2 min max step mod pow length noise turbulence".split()
THREE = "clamp mix smoothstep length noise turbulence max".split()
SIGNS = ["+", "-", "*", "/", "%"]
COMPARING = ["<", "<=", ">", ">=", "==", "!="]
NAMES = ["x", "y", "z", "height"]


class FormulaSource:
    """Writes formulas of x, y, z and height."""

    def __init__(self, seed: int) -> None:
        self.random = np.random.default_rng(seed)

    def formula(self, depth: int = 4) -> str:
        if depth == 0 or self.random.random() < 0.08:
            return self._leaf()
        kind = self.random.choice(["sign", "one", "two", "three", "power", "choice", "minus", "guarded"],
                                  p=[0.4, 0.2, 0.1, 0.06, 0.08, 0.06, 0.05, 0.05])
        a, b, c = (self.formula(depth - 1) for _ in range(3))
        return {
            "sign": lambda: f"({a} {self._pick(SIGNS)} {b})",
            "one": lambda: f"{self._pick(ONE)}({a})",
            "two": lambda: f"{self._pick(TWO)}({a}, {b})",
            "three": lambda: f"{self._pick(THREE)}({a}, {b}, {c})",
            "power": lambda: f"({a})^{self._pick(['2', '3', '5', '-1', '-2', '0.5', '1.5', '(0.3*x)'])}",
            "choice": lambda: f"({a} if {self._condition(b, c)} else {c})",
            "minus": lambda: f"-{a}",
            "guarded": lambda: f"{self._pick(['sqrt', 'log', 'log2'])}(0.1 + abs({a}))",
        }[kind]()

    def _leaf(self) -> str:
        if self.random.random() < 0.75:
            return self._pick(NAMES)
        return f"{self.random.uniform(0.1, 3):.3g}"

    def _condition(self, a: str, b: str) -> str:
        first, second = (f"{a} {self._pick(COMPARING)} {b}" for _ in range(2))
        return self._pick([first, f"{first} and {second}", f"{first} or not {second}", f"-1 < {a} <= 1", a])

    def _pick(self, choices: list[str]) -> str:
        return str(self.random.choice(choices))


def points(count: int, seed: int = 0, low: float = -2.0, high: float = 2.0) -> dict[str, NDArray[np.float64]]:
    """Values for x, y, z and height that a float32 holds exactly."""
    random = np.random.default_rng(seed)
    values = random.uniform(low, high, (len(NAMES), count)).astype(np.float32).astype(np.float64)
    return dict(zip(NAMES, values, strict=True))
