#!/usr/bin/env python3
"""Put the hard cases of bilinear patches into hard_cases.json: rays made to break something, with their answers.

The ray is where two planes meet; each plane says a + b·u + c·v + d·u·v = 0. Without v, a quadratic in u is left, whose
roots are fractions with a square root to 80 digits. Nothing is shared with common/reference, which a test compares with the
answers, nor with the shaders.
"""

import json
from fractions import Fraction

from cone_cases import FAR, FILE, decimal, dot, f32, minus, quadratic, root, vector

# A place within this of an edge is on it: here no irrational root is as close.
TINY = Fraction(1, 10**40)


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def lerp(a, b, x):
    return [p + x * (q - p) for p, q in zip(a, b)]


def point(corners, u, v):
    return lerp(lerp(corners[0], corners[1], u), lerp(corners[2], corners[3], u), v)


def planes(corners, o, d):
    """The numbers a, b, c and d of two planes through the ray."""
    axis = max(range(3), key=lambda k: abs(d[k]))
    for k in range(3):
        if k != axis:
            n = cross(d, [Fraction(int(i == k)) for i in range(3)])
            a, b, c, e = (dot(n, minus(corner, o)) for corner in corners)
            yield a, b - a, c - a, e - b - c + a


def pairs(corners, o, d):
    """The u and v of all points of the whole surface on the line; a line within the surface has none."""
    (a, b, c, e), (f, g, h, i) = planes(corners, o, d)
    numbers = b * i - g * e, a * i + b * h - f * e - g * c, a * h - f * c
    if all(x == 0 for x in numbers):
        return None
    found = []
    for u in quadratic(*numbers):
        (under, over) = max(((c + e * u, a + b * u), (h + i * u, f + g * u)), key=lambda x: abs(x[0]))
        if abs(under) > TINY:
            found.append((u, -over / under))
        elif point(corners, u, 0) == point(corners, u, 1) and abs(over) <= TINY:
            found.append((u, Fraction(1, 2)))
    return found


def hits(corners, o, d):
    found = pairs(corners, o, d)
    if found is None:
        turned = [corners[k] for k in (0, 2, 1, 3)]
        found = [(u, v) for v, u in pairs(turned, o, d) or []]
    axis = max(range(3), key=lambda k: abs(d[k]))
    places = {}
    for u, v in found:
        if -TINY <= u <= 1 + TINY and -TINY <= v <= 1 + TINY:
            t = (point(corners, u, v)[axis] - o[axis]) / d[axis]
            if all(abs(t - other) > TINY for other in places):
                places[t] = (u, v)
    return sorted(places.items())


def case(name, family, corners, origin, direction, note, tmin=0.0):
    exact = [vector(corner) for corner in corners]
    o, d = vector(origin), vector(direction)
    found = [hit for hit in hits(exact, o, d) if hit[0] > Fraction(f32(tmin))]
    expect = {"hit": "yes" if found else "no"}
    tolerance = {}
    if found:
        t, (u, v) = found[0]
        expect["t"] = decimal(t)
        tolerance["t_ulp"] = 1
        normal = cross(lerp(minus(exact[1], exact[0]), minus(exact[3], exact[2]), v),
                       lerp(minus(exact[2], exact[0]), minus(exact[3], exact[1]), u))
        # At an edge without length there is none; where a patch is folded there are two.
        length = dot(normal, normal)
        if length > Fraction(1, 10**30) and name not in ("dart", "folded"):
            expect["normal"] = [decimal(x / root(length)) for x in normal]
            tolerance["normal_abs"] = 2e-07
    expect["count"] = len(found)
    return {
        "id": "patch_" + name, "primitive": "patch", "family": family,
        "ray": {"origin": [f32(x) for x in origin], "dir": [f32(x) for x in direction], "tmin": f32(tmin), "tmax": FAR},
        "shape": {"corners": [[f32(x) for x in corner] for corner in corners]},
        "expect": expect, "tol": tolerance, "note": note,
    }


def cases():
    # z = xy.
    saddle = [[-1, -1, 1], [1, -1, -1], [-1, 1, -1], [1, 1, 1]]
    flat = [[0, 0, 0], [2, 0, 0], [0, 1, 0], [2, 1, 0]]
    wide = [[-1, 0, 0], [1, 0, 0], [-3, 2, 1], [3, 2, 1]]
    dart = [[0, 0, 0], [4, 0, 0], [0, 4, 0], [1, 1, 0]]
    bow = [[0, 0, 0], [2, 2, 0], [2, 0, 0], [0, 2, 0]]
    tip = [[0, 0, 0], [0, 0, 0], [-1, 2, 0], [1, 2, 1]]
    bent = [[0.1, -0.3, 0.2], [1.7, 0.1, -0.4], [-0.2, 1.3, 0.6], [1.4, 1.1, 0.9]]
    strip = [[-1, 0.5, -1e-6], [1, -0.25, 0], [-1, 0.5, 1e-6], [1, -0.249998, 0]]
    small = [[1e-6 * x for x in corner] for corner in saddle]
    yield case("above", "basic", saddle, [0.5, 0.25, 4], [0, 0, -1], "straight down on a saddle")
    yield case("bent", "basic", bent, [0.9, 0.3, 5], [-0.05, 0.03, -1], "no number is simple")
    yield case("bent_far", "distance", bent, [6000.7, 3000.4, 8000.3], [-0.6, -0.3, -0.8], "from 1e4")
    yield case("twice", "basic", saddle, [-3, -3, 0.25], [1, 1, 0], "in on one side of the valley, out on the other")
    yield case("tangent", "tangent", saddle, [-3, -3, 0], [1, 1, 0], "a tangent counts once")
    yield case("tangent_far", "tangent", saddle, [-4096, -4096, 0], [1, 1, 0], "the same from 5,800")
    yield case("tangent_slanted", "tangent", saddle, [-3, -5.5, -2.75], [1, 2, 1], "a tangent at a point that is not the middle")
    yield case("tangent_over", "tangent", saddle, [-3, -3, -1e-7], [1, 1, 0], "a ten-millionth below it")
    yield case("tangent_under", "tangent", saddle, [-3, -3, 1e-7], [1, 1, 0], "a ten-millionth above it: two hits")
    yield case("corners", "edge", saddle, [-3, -3, 1], [1, 1, 0], "from corner to corner")
    yield case("edge", "edge", saddle, [1, 0.25, 4], [0, 0, -1], "an edge belongs to the patch")
    yield case("edge_missed", "edge", saddle, [1.0000001, 0.25, 4], [0, 0, -1], "one rounding outside")
    yield case("edge_met", "edge", saddle, [0.99999994, 0.25, 4], [0, 0, -1], "one rounding inside")
    yield case("corner", "edge", bent, [1.7, 0.1, 4], [0, 0, -1], "a corner")
    yield case("edge_along", "line", saddle, [-3, 1, -3], [1, 0, 1], "along an edge: the ray lies in the surface and misses it")
    yield case("line", "line", saddle, [-3, 0.5, -1.5], [1, 0, 0.5], "along a line of the surface")
    yield case("line_other", "line", saddle, [0.25, -3, -0.75], [0, 1, 0.25], "and along one of the other kind")
    yield case("line_beside", "line", saddle, [-3, 0.5, -1.4999999], [1, 0, 0.5], "parallel to such a line: no root is left")
    yield case("line_near", "line", saddle, [-3, 0.5, -1.5], [1, 1e-6, 0.5], "turned off it by a millionth: it crosses that line in the middle")
    yield case("line_crossed", "line", saddle, [-3, 0.499999, -1.5], [1, 4e-7, 0.50000006], "across it, by less than a millionth")
    yield case("flat", "flat", flat, [0.5, 0.75, 4], [0.125, -0.25, -2], "a parallelogram: one root")
    yield case("flat_within", "flat", flat, [-1, 0.5, 0], [1, 0, 0], "in its plane: a miss")
    yield case("flat_corner", "flat", flat, [3, 2, 4], [-0.25, -0.25, -1], "through its corner")
    yield case("wide", "flat", wide, [0.5, 1, 4], [0, 0, -1], "a trapezium: a root outside")
    yield case("wide_edge", "flat", wide, [2, 1, 4], [0, 0, -1], "through its slanted edge")
    yield case("dart", "flat", dart, [1.25, 1.25, 3], [0, 0, -1], "a flat patch folded over itself: two pairs of u and v, one point")
    yield case("folded", "flat", bow, [1, 0.5, 3], [0, 0, -1], "two edges cross")
    yield case("pinch", "flat", bow, [1, 1, 3], [0, 0, -1], "where they cross, every line of one kind meets the ray")
    yield case("tip", "zero_edge", tip, [0, 0, 4], [0, 0, -1], "an edge that is a point, met")
    yield case("tip_missed", "zero_edge", tip, [0, -1e-7, 4], [0, 0, -1], "a ten-millionth beside it")
    yield case("tip_inside", "zero_edge", tip, [0.25, 1, 4], [0, 0, -1], "the rest of that patch")
    yield case("tip_edge", "zero_edge", tip, [-0.5, 1, 4], [0, 0, -1], "the edge from such a point")
    yield case("strip", "ratio", strip, [0, 0.125, 8], [0, 5e-8, -1], "a strip two millionths wide")
    yield case("strip_missed", "ratio", strip, [0, 0.12500202, 8], [0, 0, -1], "beside it")
    yield case("small", "ratio", small, [5e-7, 2.5e-7, 4], [0, 0, -1], "all of it a millionth wide")
    yield case("from_it", "inside", saddle, [0.5, 0.25, 0.125], [-0.5, -0.75, 0], "from the patch itself, through the valley")
    yield case("behind", "inside", saddle, [-2.75, -2.75, 0.25], [1, 1, 0], "the first of two hits is behind tmin", 2.5)


def main():
    file = json.loads(FILE.read_text())
    others = [c for c in file["cases"] if c["primitive"] not in ("patch", "voxel")]
    voxels = [c for c in file["cases"] if c["primitive"] == "voxel"]
    file["cases"] = others + list(cases()) + voxels
    FILE.write_text(json.dumps(file, indent=1, ensure_ascii=False))


if __name__ == "__main__":
    main()
