#!/usr/bin/env python3
"""Put the hard cases of voxels into hard_cases.json: rays made to break something, with their answers.

The polynomial along each ray is made of fractions. What it has in common with its derivative is divided out; what is left
changes its sign at every root, and the roots are bisected to 200 places between those of its derivative. Nothing is shared with
common/reference, which a test compares with the answers, nor with the shaders.
"""

import json
from fractions import Fraction

from cone_cases import FAR, FILE, decimal, f32, vector

PLACES = 200
# A root within this of an end of the way through the box is that end: here no irrational root is as close.
TINY = Fraction(1, 10**50)


def trimmed(p):
    while p and p[-1] == 0:
        p = p[:-1]
    return p


def value(p, t):
    total = Fraction(0)
    for c in reversed(p):
        total = total * t + c
    return total


def derivative(p):
    return [k * c for k, c in enumerate(p)][1:]


def divided(p, q):
    """Quotient and remainder."""
    p, quotient = list(p), [Fraction(0)] * max(len(p) - len(q) + 1, 0)
    while len(p) >= len(q):
        k = len(p) - len(q)
        quotient[k] = p[-1] / q[-1]
        p = [c - quotient[k] * q[i - k] if i >= k else c for i, c in enumerate(p)][:-1]
    return quotient, trimmed(p)


def common(p, q):
    while q:
        p, q = q, divided(p, q)[1]
    return p


def roots(p, low, high):
    """The roots of a polynomial without double roots, from low to high."""
    if len(p) < 2:
        return []
    if len(p) == 2:
        places = [-p[0] / p[1]]
        return [t for t in places if low <= t <= high]
    turns = [low] + roots(squarefree(derivative(p)), low, high) + [high]
    found = []
    for a, b in zip(turns, turns[1:]):
        va, vb = value(p, a), value(p, b)
        if va == 0 and a not in found:
            found.append(a)
        if vb == 0 and b not in found:
            found.append(b)
        if va * vb < 0:
            exact = next((Fraction(n, 64) for n in range(int(a * 64) - 1, int(b * 64) + 2) if a < Fraction(n, 64) < b and value(p, Fraction(n, 64)) == 0), None)
            while exact is None and b - a > Fraction(1, 2**PLACES):
                middle = (a + b) / 2
                if value(p, middle) * va > 0:
                    a = middle
                else:
                    b = middle
            found.append(b if exact is None else exact)
    return sorted(set(found))


def squarefree(p):
    p = trimmed(p)
    return divided(p, common(p, derivative(p)))[0] if len(p) > 2 else p


def hits(low, high, corners, o, d):
    enter, leave, has_first, has_last = [], [], True, True
    for k in range(3):
        if d[k] == 0:
            if not low[k] <= o[k] < high[k]:
                return []
            continue
        ends = [(low[k] - o[k]) / d[k], (high[k] - o[k]) / d[k]]
        enter.append((min(ends), d[k] > 0))
        leave.append((max(ends), d[k] < 0))
    first, last = max(t for t, _ in enter), min(t for t, _ in leave)
    has_first = all(inside for t, inside in enter if t == first)
    has_last = all(inside for t, inside in leave if t == last)
    if first > last:
        return []
    total = [Fraction(0)] * 4
    for n, corner in enumerate(corners):
        product = [corner]
        for k in range(3):
            a, b = (o[k] - low[k], d[k]) if n >> k & 1 else (high[k] - o[k], -d[k])
            product = [(product[i] * a if i < len(product) else 0) + (product[i - 1] * b if i else 0) for i in range(len(product) + 1)]
        total = [x + y for x, y in zip(total, product)]
    p = squarefree(total)
    if not p:
        return []
    found = []
    for t in roots(p, first - 1, last + 1):
        at_first, at_last = abs(t - first) < TINY, abs(t - last) < TINY
        if (t > first or at_first) and (t < last or at_last) and (has_first or not at_first) and (has_last or not at_last):
            found.append(t)
    return found


def case(name, family, low, high, corners, origin, direction, note, tmin=0.0):
    o, d = vector(origin), vector(direction)
    found = [t for t in hits(vector(low), vector(high), vector(corners), o, d) if t > Fraction(f32(tmin))]
    expect = {"hit": "yes" if found else "no"}
    tolerance = {}
    if found:
        expect["t"] = decimal(found[0])
        tolerance["t_ulp"] = 1
    expect["count"] = len(found)
    return {
        "id": "voxel_" + name, "primitive": "voxel", "family": family,
        "ray": {"origin": [f32(x) for x in origin], "dir": [f32(x) for x in direction], "tmin": f32(tmin), "tmax": FAR},
        "shape": {"lo": [f32(x) for x in low], "hi": [f32(x) for x in high], "corners": [f32(x) for x in corners]},
        "expect": expect, "tol": tolerance, "note": note,
    }


def corners(f, low, high):
    return [f(*((high if n >> k & 1 else low)[k] for k in range(3))) for n in range(8)]


def cases():
    zero, one = [0, 0, 0], [1, 1, 1]
    floor = corners(lambda x, y, z: z - 0.25, zero, one)
    saddle = corners(lambda x, y, z: (x - 0.5) * (y - 0.5), zero, one)
    cube = corners(lambda x, y, z: (x - 0.5) * (y - 0.5) * (z - 0.5), zero, one)
    three = corners(lambda x, y, z: (x - 0.25) * (y - 0.5) * (z - 0.75), zero, one)
    odd = [0.31, -0.17, -0.42, 0.23, -0.29, 0.55, 0.38, -0.61]
    wall = lambda low, high: corners(lambda x, y, z: x - 1, low, high)
    box = [0.3, -0.2, 0.1], [0.4, -0.1, 0.2]
    yield case("down", "basic", zero, one, floor, [0.5, 0.5, 4], [0, 0, -1], "a floor: the polynomial has degree one")
    yield case("slanted", "basic", zero, one, floor, [-2, 0.3, 2.1], [1, 0.1, -0.8], "the same on a slant")
    yield case("beside", "basic", zero, one, floor, [1.5, 0.5, 4], [0, 0, -1], "beside the box")
    yield case("within", "degree", zero, one, floor, [-1, 0.5, 0.25], [1, 0, 0], "in the surface: a miss")
    yield case("odd", "basic", *box, odd, [2, 1, 1.5], [-0.9, -0.62, -0.73], "no number is simple")
    yield case("odd_far", "distance", *box, odd, [6000.35, -8000.15, 0.15], [-0.6, 0.8, 0], "from 1e4")
    yield case("three", "basic", zero, one, three, [-1, -1, -1], [1, 1, 1], "three hits")
    yield case("three_far", "distance", zero, one, three, [-4096, -4096, -4096], [1, 1, 1], "the same from 7,000")
    yield case("cube_root", "tangent", zero, one, cube, [-1, -1, -1], [1, 1, 1], "three roots in one place")
    yield case("touch", "tangent", zero, one, saddle, [-1, -1, 0.5], [1, 1, 0], "a touch counts once")
    yield case("touch_far", "tangent", zero, one, saddle, [-4096, -4096, 0.5], [1, 1, 0], "the same from 5,800")
    yield case("touch_over", "tangent", zero, one, saddle, [-1, -0.9999999, 0.5], [1, 1, 0], "a ten-millionth beside it: two hits")
    yield case("touch_and_cross", "tangent", zero, one, cube, [-0.5, -0.5, 0], [1, 1, 0.25], "a touch, and no third root in the box")
    yield case("touch_not_met", "tangent", zero, one, [x + 1e-7 for x in saddle], [-1, -1, 0.5], [1, 1, 0], "raised by a ten-millionth: no hit")
    yield case("touch_cut", "tangent", zero, one, [x - 1e-7 for x in saddle], [-1, -1, 0.5], [1, 1, 0], "lowered by a ten-millionth: two hits")
    yield case("high_face", "face", zero, one, wall(zero, one), [-1, 0.5, 0.5], [1, 0, 0], "a wall in the high face belongs to the next voxel")
    yield case("low_face", "face", [1, 0, 0], [2, 1, 1], wall([1, 0, 0], [2, 1, 1]), [-1, 0.5, 0.5], [1, 0, 0], "and here it is the next voxel's")
    yield case("high_face_back", "face", zero, one, wall(zero, one), [3, 0.5, 0.5], [-1, 0.125, 0], "the same from the other side")
    yield case("low_face_back", "face", [1, 0, 0], [2, 1, 1], wall([1, 0, 0], [2, 1, 1]), [3, 0.25, 0.5], [-1, 0.125, 0], "and in the next voxel")
    yield case("edge", "face", [1, 0, 0], [2, 1, 1], wall([1, 0, 0], [2, 1, 1]), [0, -1, 0.5], [1, 1, 0], "at an edge of two low faces")
    yield case("edge_out", "face", [1, 0, 0], [2, 1, 1], wall([1, 0, 0], [2, 1, 1]), [0, 2, 0.5], [1, -1, 0], "at an edge of a low and a high face")
    yield case("corner_at_zero", "face", zero, one, [0, 1, 1, 1, 1, 1, 1, 1], [-1, -1, -1], [1, 1, 1], "a corner with the value 0")
    yield case("along_face", "face", zero, one, floor, [0, 0.5, 4], [0, 0, -1], "along a low face")
    yield case("along_high_face", "face", zero, one, floor, [1, 0.5, 4], [0, 0, -1], "along a high face")
    yield case("degree_two", "degree", zero, one, saddle, [-1, -0.25, 0.25], [1, 0.75, 0.125], "degree two: the value does not depend on z")
    yield case("degree_near", "degree", zero, one, [x + 1e-6 * (n == 7) for n, x in enumerate(saddle)], [-1, -0.25, 0.25], [1, 0.75, 0.125], "nearly so: a third root, very far")
    yield case("inside", "inside", zero, one, three, [0.375, 0.375, 0.375], [1, 1, 1], "from inside, between two hits")
    yield case("on_it", "inside", zero, one, three, [0.25, 0.25, 0.25], [1, 1, 1], "from the surface itself")
    yield case("behind", "inside", zero, one, three, [-1, -1, -1], [1, 1, 1], "the first of three is behind tmin", 1.25)
    yield case("small", "ratio", zero, [1e-6, 1e-6, 1e-6], three, [-1, -1, -1], [1, 1, 1], "a millionth wide")
    yield case("tiny_values", "ratio", zero, one, [1e-20 * x for x in three], [-1, -1, -1], [1, 1, 1], "values of 1e-20")


def main():
    file = json.loads(FILE.read_text())
    others = [c for c in file["cases"] if c["primitive"] != "voxel"]
    file["cases"] = others + list(cases())
    FILE.write_text(json.dumps(file, indent=1, ensure_ascii=False))


if __name__ == "__main__":
    main()
