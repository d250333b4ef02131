#!/usr/bin/env python3
"""Put the hard cases of algebraic surfaces into hard_cases.json: rays made to break something, with their answers.

The polynomial along each ray is made of fractions, and its roots are found as those of voxels are. Nothing is shared with
common/reference, which a test compares with the answers, nor with the shaders.
"""

import json
from fractions import Fraction

from cone_cases import FAR, FILE, decimal, f32, vector
from voxel_cases import TINY, roots, squarefree

# POV-Ray's order, written as it is in its documentation.
CUBIC = "xxx xxy xxz xx xyy xyz xy xzz xz x yyy yyz yy yzz yz y zzz zz z 1".split()
QUARTIC = (
    "xxxx xxxy xxxz xxx xxyy xxyz xxy xxzz xxz xx xyyy xyyz xyy xyzz xyz xy xzzz xzz xz x"
    " yyyy yyyz yyy yyzz yyz yy yzzz yzz yz y zzzz zzz zz z 1"
).split()


def listed(terms):
    """The 20 coefficients of a cubic, or the 35 of a quartic."""
    order = CUBIC if all(term in CUBIC for term in terms) else QUARTIC
    assert all(term in order for term in terms), terms
    return [f32(terms.get(term, 0)) for term in order]


def along(coefficients, o, d):
    order = CUBIC if len(coefficients) == 20 else QUARTIC
    total = [Fraction(0)] * 5
    for coefficient, term in zip(coefficients, order):
        product = [Fraction(coefficient)]
        for axis in term.replace("1", ""):
            a, b = o["xyz".index(axis)], d["xyz".index(axis)]
            product = [(product[i] * a if i < len(product) else 0) + (product[i - 1] * b if i else 0) for i in range(len(product) + 1)]
        for i, x in enumerate(product):
            total[i] += x
    return total


def scaled_roots(p, first, last):
    """As roots(), which looks for simple fractions one by one: seen from the middle, with a way through the box of about 8."""
    middle = Fraction(round((first + last) / 2))
    unit = Fraction(1)
    while last - first > 8 * unit:
        unit *= 2
    while 0 < last - first < 4 * unit:
        unit /= 2
    moved = []
    for c in reversed(p):
        # Horner's rule for p(middle + unit·t).
        product = [Fraction(0)] * (len(moved) + 1)
        for i, x in enumerate(moved):
            product[i] += x * middle
            product[i + 1] += x * unit
        product[0] += c
        moved = product
    while moved and moved[-1] == 0:
        moved.pop()
    low, high = ((t - middle) / unit for t in (first, last))
    return [middle + unit * t for t in roots(moved, low - 1, high + 1)]


def hits(low, high, coefficients, o, d):
    first, last = None, None
    for k in range(3):
        if d[k] == 0:
            if not low[k] <= o[k] <= high[k]:
                return []
            continue
        ends = sorted([(low[k] - o[k]) / d[k], (high[k] - o[k]) / d[k]])
        first = ends[0] if first is None else max(first, ends[0])
        last = ends[1] if last is None else min(last, ends[1])
    if first > last:
        return []
    p = squarefree(along(coefficients, o, d))
    if not p:
        return []
    return [t for t in scaled_roots(p, first, last) if t > first - TINY and t < last + TINY]


def case(name, family, half, terms, origin, direction, note, tmin=0.0, count=None):
    o, d = vector(origin), vector(direction)
    low, high = half if isinstance(half, tuple) else ([-half] * 3, [half] * 3)
    coefficients = listed(terms)
    found = [t for t in hits(vector(low), vector(high), coefficients, o, d) if t > Fraction(f32(tmin))]
    assert count is None or len(found) == count, (name, len(found), [float(t) for t in found])
    expect = {"hit": "yes" if found else "no"}
    tolerance = {}
    if found:
        expect["t"] = decimal(found[0])
        tolerance["t_ulp"] = 1
    expect["count"] = len(found)
    return {
        "id": "algebraic_" + name, "primitive": "algebraic", "family": family,
        "ray": {"origin": [f32(x) for x in origin], "dir": [f32(x) for x in direction], "tmin": f32(tmin), "tmax": FAR},
        "shape": {"lo": [f32(x) for x in low], "hi": [f32(x) for x in high], "coefficients": coefficients},
        "expect": expect, "tol": tolerance, "note": note,
    }


CAYLEY = {"xx": 4, "yy": 4, "zz": 4, "xyz": 16, "1": -1}
KUMMER = {
    "xxxx": 16, "yyyy": 16, "zzzz": 16, "xxyy": -20, "yyzz": -20, "xxzz": -20, "xyz": 26, "xx": -5, "yy": -5, "zz": -5, "1": 1,
}
TORUS = {
    "xxxx": 1, "yyyy": 1, "zzzz": 1, "xxyy": 2, "xxzz": 2, "yyzz": 2, "xx": -2.5, "yy": -2.5, "zz": 1.5, "1": 0.5625,
}
LEMNISCATE = {"xxxx": 1, "xx": -1, "yy": 1, "zz": 1}
MONKEY = {"xxx": 1, "xyy": -3, "z": -1}
STEINER = {"xxyy": 1, "yyzz": 1, "xxzz": 1, "xyz": 1}
CUBE = {"xxx": 1, "y": -1}
FOURTH = {"xxxx": 1, "y": -1}
CLEBSCH = {
    "xxx": 81, "yyy": 81, "zzz": 81, "xxy": -189, "xxz": -189, "xyy": -189, "yyz": -189, "xzz": -189, "yzz": -189, "xyz": 54,
    "xy": 126, "xz": 126, "yz": 126, "xx": -9, "yy": -9, "zz": -9, "x": -9, "y": -9, "z": -9, "1": 1,
}


def times(factor, terms):
    return {term: factor * x for term, x in terms.items()}


def cases():
    yield case("cubic", "basic", 1, CAYLEY, [3, 2, 2.5], [-0.75, -0.5, -0.625], "Cayley's cubic: a ray at its middle")
    yield case("clebsch", "basic", 1, CLEBSCH, [2, 1.5, 3], [-0.61, -0.47, -0.93], "Clebsch's cubic")
    yield case("monkey", "basic", 2, MONKEY, [0.3, 0.4, 5], [0.05, -0.02, -1], "a monkey saddle from above")
    yield case("quartic", "basic", 1.25, KUMMER, [3, 2.2, 2.7], [-0.8, -0.6, -0.65], "Kummer's quartic")
    yield case("four", "basic", 2, TORUS, [-4, 0.1, 0.05], [1, 0, 0], "a torus by its coefficients: four hits", count=4)
    yield case("odd", "basic", 2, TORUS, [3.1, 2.3, 1.7], [-0.93, -0.71, -0.47], "no number is simple")
    yield case("beside", "basic", 2, TORUS, [-4, 2.5, 0], [1, 0, 0], "beside the box", count=0)
    yield case("hole", "basic", 2, TORUS, [0.1, 0.05, 4], [0, 0, -1], "through the hole", count=0)
    yield case("far", "distance", 2, TORUS, [-6000.1, 8000.1, 0.05], [0.6, -0.8, 0], "from 1e4", count=4)
    yield case("far_cubic", "distance", 1, CAYLEY, [6000.1, 8000.05, 0.15], [-0.6, -0.8, 0], "a cubic from 1e4")
    yield case("very_far", "distance", 2, TORUS, [-1048576, 0.1, 0.05], [1, 0, 0], "from a million", count=4)
    yield case("touch", "tangent", 2, TORUS, [-4, 1.5, 0], [1, 0, 0], "a touch counts once", count=1)
    yield case("touch_twice", "tangent", 2, TORUS, [-4, 0, 0.5], [1, 0, 0], "two touches: the square of a quadratic", count=2)
    yield case("touch_twice_far", "tangent", 2, TORUS, [-4096, 0, 0.5], [1, 0, 0], "the same from 4,000", count=2)
    yield case("touch_not_met", "tangent", 2, TORUS, [-4, 0, 0.5000001], [1, 0, 0], "a ten-millionth above: no hit", count=0)
    yield case("touch_cut", "tangent", 2, TORUS, [-4, 0, 0.4999999], [1, 0, 0], "a ten-millionth below: four hits", count=4)
    yield case("touch_and_cross", "tangent", 2, TORUS, [-4, 0.5, 0], [1, 0, 0], "a touch between two crossings", count=3)
    yield case("touch_third", "tangent", 2, {"xx": 9, "x": -6, "y": -1, "1": 1}, [-1, 0, 0], [1, 0, 0], "a touch at a third, which is no float", count=1)
    yield case("triple", "multiple", 2, CUBE, [-4, 0, 0], [1, 0, 0], "three roots in one place", count=1)
    yield case("triple_far", "multiple", 2, CUBE, [-4096, 0, 0], [1, 0, 0], "the same from 4,000", count=1)
    yield case("triple_apart", "multiple", 2, CUBE, [-4, -0.0001, 0], [1, 0, 0], "moved by a ten-thousandth: one of them is real", count=1)
    yield case("triple_third", "multiple", 2, {"xxx": 27, "xx": -27, "x": 9, "y": -1, "1": -1}, [-1, 0, 0], [1, 0, 0], "three roots at a third", count=1)
    yield case("fourfold", "multiple", 2, FOURTH, [-4, 0, 0], [1, 0, 0], "four roots in one place", count=1)
    yield case("fourfold_far", "multiple", 2, FOURTH, [-4096, 0, 0], [1, 0, 0], "the same from 4,000", count=1)
    yield case("fourfold_above", "multiple", 2, FOURTH, [-4, -0.0001, 0], [1, 0, 0], "no root, and four roots of the derivative nearly", count=0)
    yield case("fourfold_below", "multiple", 2, FOURTH, [-4, 0.0001, 0], [1, 0, 0], "two of the four", count=2)
    yield case("plane", "degree", 2, {"xxxx": 1, "y": 1, "z": -2}, [0, 0.5, 4], [0, 0, -1], "degree one: along the axis the fourth power is lost", count=1)
    yield case("degree_two", "degree", 2, LEMNISCATE, [0.5, -4, 0.25], [0, 1, 0], "degree two", count=2)
    yield case("degree_three", "degree", 2, STEINER | {"zzz": 1}, [0.25, 0.5, -4], [0, 0, 1], "degree three")
    yield case("degree_near", "degree", 2, LEMNISCATE, [0.5, -4, 0.25], [1e-4, 1, 0], "degree four, nearly two: two roots are very far", count=2)
    yield case("degree_near_one", "degree", 2, {"xxxx": 1, "y": 1, "z": -2}, [0, 0.5, 4], [1e-5, 1e-3, -1], "degree four, nearly one", count=1)
    yield case("quadric", "degree", 2, {"xx": 1, "yy": 1, "zz": 1, "1": -1}, [-4, 0.1, 0.2], [1, 0, 0], "a ball given as a cubic", count=2)
    yield case("within", "degree", 2, {"xyz": 1, "x": 1}, [0, -4, 0.5], [0, 1, 0], "a ray within a plane of the surface: a miss", count=0)
    yield case("constant", "degree", 2, {"xyz": 1, "1": -1}, [0, -4, 0.5], [0, 1, 0], "the value does not change along the ray: a miss", count=0)
    yield case("node", "singular", 1, CAYLEY, [2.5, 2.5, -2.5], [-1, -1, 1], "through a node of Cayley's cubic and its middle", count=2)
    yield case("node_only", "singular", 1, CAYLEY, [0.5, 0.5, -4], [0, 0, 1], "through a node along an axis")
    yield case("node_line", "singular", 1, CAYLEY, [0.5, -2, 2], [0, 1, -1], "a line between two nodes lies in the surface: a miss", count=0)
    yield case("node_beside", "singular", 1, CAYLEY, [2.5, 2.50390625, -2.5], [-1, -1, 1], "beside a node")
    yield case("node_kummer", "singular", 1.25, KUMMER, [1.5, 2.5, 1.25], [-1, -2, -1], "through a node of Kummer's quartic", count=None)
    yield case("node_kummer_outer", "singular", 1.25, KUMMER, [4, 2, 3], [-3, -1, -2], "through a node where two parts meet")
    yield case("node_lemniscate", "singular", 1.125, LEMNISCATE, [0, -3, 0], [0, 1, 0], "through the node of a lemniscate: a touch", count=1)
    yield case("node_lemniscate_along", "singular", 1.125, LEMNISCATE, [-3, 0, 0], [1, 0, 0], "along its axis", count=3)
    yield case("double_line", "singular", 1, STEINER, [-3, 0.25, 0], [1, 0, 0], "along a plane in which Steiner's surface has two double lines", count=1)
    yield case("triple_point", "singular", 1, STEINER, [-3, -3, -3], [1, 1, 1], "through the triple point of Steiner's surface")
    yield case("face", "face", 2, CUBE, [-4, -8, 0], [1, 0, 0], "beyond the box in y: a miss", count=0)
    yield case("face_x", "face", 1, CUBE, [-4, 1, 0], [1, 0, 0], "a hit in a face counts", count=1)
    yield case("face_back", "face", 1, CUBE, [4, 1, 0], [-1, 0, 0], "the same from the other side", count=1)
    yield case("edge", "face", 1, {"xxx": 1, "y": -1}, [-4, 4, 0.5], [1, -1, 0], "past the box at an edge that is not in the surface", count=1)
    yield case("edge_met", "face", 1, {"xxx": 1, "y": -1}, [-1, 3, 0.5], [1, -1, 0], "at an edge that is in the surface", count=1)
    yield case("inside", "inside", 2, TORUS, [-1, 0.1, 0.05], [1, 0, 0], "from within the tube: three are left", count=3)
    yield case("on_it", "inside", 2, TORUS, [-1.5, 0, 0], [1, 0, 0], "from the surface itself", count=3)
    yield case("on_touch", "inside", 2, TORUS, [0, 1.5, 0], [1, 0, 0], "from a touch: it is at tmin, and does not count", count=0)
    yield case("behind", "inside", 2, TORUS, [-4, 0.1, 0.05], [1, 0, 0], "the first two are behind tmin", 4.0, count=2)
    yield case("at_tmin", "inside", 2, TORUS, [-4, 0, 0], [1, 0, 0], "the first is at tmin, and does not count", 2.5, count=3)
    yield case("small", "ratio", 2e-6, {"xxxx": 1e24, "yy": 1e12, "zz": 1e12, "1": -1}, [-1, 1e-7, 2e-7], [1, 0, 0], "a millionth wide, and coefficients from 1 to 1e24")
    yield case("large", "ratio", 2000, {"xxxx": 1e-12, "yy": 1e-6, "zz": 1e-6, "1": -1}, [-5000, 100, 200], [1, 0, 0], "a thousand wide, and coefficients from 1e-12 to 1")
    yield case("tiny_values", "ratio", 2, times(1e-20, TORUS), [-4, 0.1, 0.05], [1, 0, 0], "coefficients of 1e-20", count=4)
    yield case("huge_values", "ratio", 2, times(1e20, TORUS), [-4, 0.1, 0.05], [1, 0, 0], "coefficients of 1e20", count=4)
    yield case("slow", "ratio", 2, TORUS, [-4, 0.1, 0.05], [1e-10, 0, 0], "a direction of 1e-10", count=4)
    yield case("flat_box", "ratio", ([-2, -2, -1e-3], [2, 2, 1e-3]), TORUS, [-4, 0.1, 0.46875], [1, 0, -0.1875], "a box that is two thousand times as wide as it is high", count=1)


def main():
    file = json.loads(FILE.read_text())
    others = [c for c in file["cases"] if c["primitive"] != "algebraic"]
    file["cases"] = others + list(cases())
    FILE.write_text(json.dumps(file, indent=1, ensure_ascii=False))


if __name__ == "__main__":
    main()
