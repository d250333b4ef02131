#!/usr/bin/env python3
"""Write torus_cases.json: rays and tori with their hits, found in fractions by Sturm's theorem.

Inputs are rounded to f32 first. Nothing is shared with common/reference, which a test compares with the answers.
"""

import json
import pathlib
import struct
from fractions import Fraction

DIGITS = 20


def f32(x):
    return struct.unpack("f", struct.pack("f", x))[0]


def times(a, b):
    product = [Fraction(0)] * (len(a) + len(b) - 1)
    for i, x in enumerate(a):
        for k, y in enumerate(b):
            product[i + k] += x * y
    return product


def plus(a, b, factor=1):
    size = max(len(a), len(b))
    a, b = (list(p) + [Fraction(0)] * (size - len(p)) for p in (a, b))
    return [x + factor * y for x, y in zip(a, b)]


def trimmed(p):
    while p and p[-1] == 0:
        p = p[:-1]
    return p


def remainder(a, b):
    a = list(a)
    while len(a) >= len(b):
        factor = a[-1] / b[-1]
        for k in range(len(b)):
            a[len(a) - len(b) + k] -= factor * b[k]
        a.pop()
    return trimmed(a)


def polynomial(case):
    o, d, c, n = ([Fraction(x) for x in case[key]] for key in ("origin", "direction", "center", "axis"))
    major, minor = Fraction(case["major"]), Fraction(case["minor"])
    line = [[o[i] - c[i], d[i]] for i in range(3)]
    square, height = [Fraction(0)], [Fraction(0)]
    for i in range(3):
        square = plus(square, times(line[i], line[i]))
        height = plus(height, [n[i] * x for x in line[i]])
    axis = sum(x * x for x in n)
    left = plus(square, [major**2 - minor**2])
    flat = plus(square, [x / axis for x in times(height, height)], -1)
    return trimmed(plus(times(left, left), [4 * major**2 * x for x in flat], -1))


def value(p, x):
    result = Fraction(0)
    for c in reversed(p):
        result = result * x + c
    return result


def roots(p, low, high):
    """The different roots x with low < x <= high, to well over DIGITS digits."""
    chain = [p, trimmed([i * c for i, c in enumerate(p)][1:])]
    while True:
        rest = [-x for x in remainder(chain[-2], chain[-1])]
        if not rest:
            break
        chain.append(rest)
    last = chain[-1]
    if len(last) > 1:
        quotient, rest = [], list(p)
        while len(rest) >= len(last):
            quotient.insert(0, rest[-1] / last[-1])
            for k in range(len(last)):
                rest[len(rest) - len(last) + k] -= quotient[0] * last[k]
            rest.pop()
        return roots(quotient, low, high)

    def changes(x):
        signs = [y > 0 for y in (value(member, x) for member in chain) if y != 0]
        return sum(a != b for a, b in zip(signs, signs[1:]))

    found, stack = [], [(low, high)]
    while stack:
        a, b = stack.pop()
        count = changes(a) - changes(b)
        if count == 1 and b - a < Fraction(1, 2**90) * max(abs(b), Fraction(1, 2**60)):
            found.append(b)
        elif count > 0:
            middle = (a + b) / 2
            if count == 1 and value(p, middle) == 0:
                found.append(middle)
            else:
                stack += [(middle, b), (a, middle)]
    return sorted(found)


def decimal(x):
    """x, above 0, to DIGITS digits."""
    power = 0
    while x * 10**power < 10 ** (DIGITS - 1):
        power += 1
    return f"{round(x * 10**power)}e{-power}"


PLAIN = {"center": [0, 0, 0], "axis": [0, 1, 0], "major": 1, "minor": 0.25, "tmin": 0}
FLAT = PLAIN | {"minor": 1}
THIN = PLAIN | {"minor": 1e-6}
CASES = [
    ("four_hits", PLAIN, [-4, 0, 0], [1, 0, 0]),
    ("along_the_axis", PLAIN, [0, 4, 0], [0, -1, 0]),
    ("through_the_hole", PLAIN, [0.5, 4, 0], [-0.125, -1, 0]),
    ("through_the_centre", PLAIN, [4, 1, 0], [-4, -1, 0]),
    ("down_the_tube", PLAIN, [1, 4, 0], [0, -1, 0]),
    ("tangent_outer_equator", PLAIN, [1.25, 0, -4], [0, 0, 1]),
    ("tangent_inner_equator", PLAIN, [0.75, 0, -4], [0, 0, 1]),
    ("tangent_from_the_hole", PLAIN, [0.75, 0, -0.5], [0, 0, 1]),
    ("tangent_top", PLAIN, [1, 0.25, -4], [0, 0, 1]),
    ("touches_top_twice", PLAIN, [0.5, 0.25, -4], [0, 0, 1]),
    ("passes_outer_by_a_rounding", PLAIN, [1.2500001, 0, -4], [0, 0, 1]),
    ("enters_outer_by_a_rounding", PLAIN, [1.2499999, 0, -4], [0, 0, 1]),
    ("triple", PLAIN | {"major": 15, "minor": 5}, [20, 10, -20], [-4, -3, 10]),
    ("quadruple", PLAIN | {"minor": 0.5}, [0.5, -4, -4], [0, 1, 1]),
    ("thin", THIN, [-4, 0, 0], [1, 0, 0]),
    ("thin_within", THIN, [1 + 2**-21, 4, 0], [0, -1, 0]),
    ("thin_beside", THIN, [1 + 2**-19, 4, 0], [0, -1, 0]),
    ("thin_from_afar", PLAIN | {"major": 5, "minor": 5e-6}, [4003, 3000, 4], [-4, -3, 0]),
    ("closed_along_the_axis", FLAT, [0, 4, 0], [0, -1, 0]),
    ("closed_beside_the_axis", FLAT, [1e-3, 4, 0], [0, -1, 0]),
    ("closed_equator", FLAT, [-4, 0, 0], [1, 0, 0]),
    ("from_inside_across", PLAIN, [1, 0, 0], [1, 0, 0]),
    ("from_inside_along", PLAIN, [1, 0, 0], [0, 0, 1]),
    ("from_the_surface_outwards", PLAIN, [1.25, 0, 0], [1, 0, 0]),
    ("from_the_surface_inwards", PLAIN, [1.25, 0, 0], [-2, 0, 0]),
    ("from_the_surface_along", PLAIN, [1.25, 0, 0], [0, 0, 1]),
    ("million_radii", PLAIN, [1e6, 0.125, 0.0625], [-1, 0, 0]),
    ("million_radii_aslant", PLAIN, [6e5, 5e5, 6.2e5], [-6e5, -5e5, -619999]),
    ("short_direction", PLAIN, [-4, 0.1, 0], [1e-11, 0, 0]),
    ("long_direction", PLAIN, [-4, 0.1, 0], [1e11, 0, 0]),
    ("tilted", PLAIN | {"axis": [1, 2, -3], "center": [0.3, -0.7, 0.9]}, [4, 3, 2], [-2.8, -4.15, -1.1]),
    ("large", PLAIN | {"major": 1e6, "minor": 1e5}, [1.1e6, 10, 0], [-1, -0.001, 0.5]),
    ("second_hit", PLAIN | {"tmin": 3}, [-4, 0, 0], [1, 0, 0]),
    ("tmin_at_a_hit", PLAIN | {"tmin": 2.75}, [-4, 0, 0], [1, 0, 0]),
]


def main():
    written = []
    for name, shape, origin, direction in CASES:
        case = shape | {"origin": origin, "direction": direction}
        for key, given in case.items():
            case[key] = [f32(x) for x in given] if isinstance(given, list) else f32(given)
        size = sum(abs(Fraction(x)) for x in case["origin"] + case["center"]) + 4 * Fraction(case["major"])
        end = 2 * size / max(abs(Fraction(x)) for x in case["direction"])
        hits = [decimal(x) for x in roots(polynomial(case), Fraction(case["tmin"]), end)]
        written.append({"id": name} | case | {"hits": hits})
    lines = ",\n".join(" " + json.dumps(case) for case in written)
    text = f'{{"schema": "torus-cases/1", "cases": [\n{lines}\n]}}\n'
    pathlib.Path(__file__).with_name("torus_cases.json").write_text(text)


main()
