#!/usr/bin/env python3
"""Put the hard cases of cones and quadrics into hard_cases.json: rays made to break something, with their answers.

The roots of each quadratic are found in fractions; a square root is an integer's, to 60 digits. Nothing is shared with
common/reference, which a test compares with the answers, nor with the shaders.
"""

import json
import math
import pathlib
import struct
from fractions import Fraction

FILE = pathlib.Path(__file__).with_name("hard_cases.json")
FAR = 1.0000000150474662e30
SCALE = 10**80


def f32(x):
    return struct.unpack("f", struct.pack("f", x))[0]


def vector(v):
    return [Fraction(f32(x)) for x in v]


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def minus(a, b):
    return [x - y for x, y in zip(a, b)]


def root(x):
    """A square root, rounded down to 80 digits behind the point; exact where it is a fraction."""
    n, d = x.numerator, x.denominator
    if math.isqrt(n) ** 2 == n and math.isqrt(d) ** 2 == d:
        return Fraction(math.isqrt(n), math.isqrt(d))
    return Fraction(math.isqrt(n * SCALE * SCALE // d), SCALE)


def quadratic(a, b, c):
    """The different roots of a·t² + b·t + c."""
    if a == 0:
        return [-c / b] if b != 0 else []
    square = b * b - 4 * a * c
    if square < 0:
        return []
    if square == 0:
        return [-b / (2 * a)]
    return sorted([(-b - root(square)) / (2 * a), (-b + root(square)) / (2 * a)])


def cone_hits(shape, o, d):
    a, b = vector(shape["a"]), vector(shape["b"])
    ra, rb = (Fraction(f32(r)) for r in shape["radii"])
    axis, f = minus(b, a), minus(o, a)
    length = dot(axis, axis)
    h, rate = dot(f, axis) / length, dot(d, axis) / length
    # Across the axis the line is p + t·q; the radius is r + t·s.
    p, q = [x - h * u for x, u in zip(f, axis)], [x - rate * u for x, u in zip(d, axis)]
    r, s = ra + (rb - ra) * h, (rb - ra) * rate
    side = quadratic(dot(q, q) - s * s, 2 * (dot(p, q) - r * s), dot(p, p) - r * r)
    # A place within 1e-40 of an end is that end: here no irrational root is as close.
    tiny = Fraction(1, 10**40)
    hits = [("side", t) for t in side if -tiny <= h + t * rate <= 1 + tiny]
    if shape["closed"] and rate != 0:
        for end, radius in ((0, ra), (1, rb)):
            t = (end - h) / rate
            across = [x + t * y for x, y in zip(p, q)]
            if dot(across, across) <= radius * radius and all(abs(t - other) > tiny for _, other in hits):
                hits.append((end, t))
    return sorted(hits, key=lambda hit: hit[1])


def cone_normal(shape, o, d, part, t):
    a, b = vector(shape["a"]), vector(shape["b"])
    axis = minus(b, a)
    if part == 0:
        return [-x for x in axis]
    if part == 1:
        return axis
    ra, rb = (Fraction(f32(r)) for r in shape["radii"])
    from_a = minus([x + t * y for x, y in zip(o, d)], a)
    h = dot(from_a, axis) / dot(axis, axis)
    across = [x - h * u for x, u in zip(from_a, axis)]
    return [x - (ra + (rb - ra) * h) * (rb - ra) / dot(axis, axis) * u for x, u in zip(across, axis)]


def quadric_line(shape, o, d):
    square, mixed, linear = (vector(shape[key]) for key in ("square", "mixed", "linear"))
    a, b, c = Fraction(0), Fraction(0), Fraction(f32(shape["rest"]))
    pairs = ((1, 2), (0, 2), (0, 1))
    for i in range(3):
        a += square[i] * d[i] ** 2
        b += 2 * square[i] * o[i] * d[i] + linear[i] * d[i]
        c += square[i] * o[i] ** 2 + linear[i] * o[i]
        j, k = pairs[i]
        a += mixed[i] * d[j] * d[k]
        b += mixed[i] * (o[j] * d[k] + d[j] * o[k])
        c += mixed[i] * o[j] * o[k]
    return a, b, c


def decimal(x, digits=50):
    """A fraction as a decimal of so many digits."""
    if x == 0:
        return "0.0"
    sign, x = ("-" if x < 0 else ""), abs(x)
    exponent = len(str(x.numerator)) - len(str(x.denominator))
    if Fraction(10) ** exponent > x:
        exponent -= 1
    whole = round(x / Fraction(10) ** (exponent - digits + 1))
    text = str(whole).rstrip("0")
    return f"{sign}{text[0]}.{text[1:] or '0'}e{exponent}" if abs(exponent) > 40 else sign + plain(whole, exponent - digits + 1)


def plain(whole, power):
    text = str(whole)
    if power >= 0:
        return text + "0" * power + ".0"
    text = text.rjust(1 - power, "0")
    return (text[:power] + "." + text[power:]).rstrip("0").ljust(len(text[:power]) + 2, "0")


def case(name, primitive, family, shape, origin, direction, note, tmin=0.0):
    o, d = vector(origin), vector(direction)
    if primitive == "cone":
        hits = cone_hits(shape, o, d)
    else:
        hits = [("side", t) for t in quadratic(*quadric_line(shape, o, d))]
    hits = [hit for hit in hits if hit[1] > Fraction(f32(tmin))]
    expect = {"hit": "yes" if hits else "no"}
    tolerance = {}
    if hits:
        part, t = hits[0]
        expect["t"] = decimal(t)
        tolerance["t_ulp"] = 1
        if primitive == "cone":
            normal = cone_normal(shape, o, d, part, t)
            length = dot(normal, normal)
            # At an apex there is none. Across a rim, side and disc have each their own.
            single = part == "side" and sum(abs(other[1] - t) < Fraction(1, 10**9) for other in hits) == 1
            if length > Fraction(1, 10**30) and (single or part != "side") and "rim" not in name:
                expect["normal"] = [decimal(x / root(length)) for x in normal]
                tolerance["normal_abs"] = 2e-07
    expect["count"] = len(hits)
    shape = {key: value if isinstance(value, bool) else [f32(x) for x in value] if isinstance(value, list) else f32(value)
             for key, value in shape.items()}
    return {
        "id": name, "primitive": primitive, "family": family,
        "ray": {"origin": [f32(x) for x in origin], "dir": [f32(x) for x in direction], "tmin": f32(tmin), "tmax": FAR},
        "shape": shape, "expect": expect, "tol": tolerance, "note": note,
    }


def cone(a, b, radii, closed):
    return {"a": a, "b": b, "radii": radii, "closed": closed}


def quadric(square, mixed, linear, rest):
    return {"square": square, "mixed": mixed, "linear": linear, "rest": rest}


def cases():
    can = cone([0, 0, 0], [0, 4, 0], [1, 1], True)
    pipe = cone([0, 0, 0], [0, 4, 0], [1, 1], False)
    funnel = cone([0, 0, 0], [0, 4, 0], [0, 3], False)
    filled = cone([0, 0, 0], [0, 4, 0], [0, 3], True)
    tilted = cone([1, 2, 2], [3, 4, 3], [1.5, 1.5], True)
    cut = cone([0.1, -0.3, 0.2], [0.7, 1.1, -0.4], [0.5, 0.2], True)
    thin = cone([-1, 0, 0], [1, 0.5, 0], [2e-6, 2e-6], True)
    make = lambda name, family, shape, o, d, note, tmin=0.0: case("cone_" + name, "cone", family, shape, o, d, note, tmin)
    yield make("across", "basic", can, [-4, 2, 0.25], [1, 0, 0], "in at one side, out at the other")
    yield make("through_discs", "basic", can, [0.5, 8, 0.25], [0, -1, 0], "a ray parallel to the axis: no root, two discs")
    yield make("through_pipe", "basic", pipe, [0.5, 8, 0.25], [0, -1, 0], "through the hole")
    yield make("along_wall", "parallel", pipe, [1, 8, 0], [0, -1, 0], "a ray within the side misses it")
    yield make("along_wall_rims", "parallel", can, [1, 8, 0], [0, -1, 0], "but not the rims of a closed one")
    yield make("near_parallel", "parallel", pipe, [0.5, 8, 0.25], [1e-7, -1, 0], "the side is met far below the pipe")
    yield make("near_parallel_in", "parallel", pipe, [0.9999999, 8, 0], [2e-8, -1, 0], "and here within it: a direction of 2e-8 decides")
    yield make("tangent", "tangent", can, [1, 2, -4], [0, 0, 1], "a tangent counts once")
    yield make("tangent_far", "tangent", can, [1, 2, -4096], [0, 0, 1], "the same from 4,096")
    yield make("tangent_slanted", "tangent", pipe, [1, -6, -4], [0, 2, 1], "a tangent across the axis")
    yield make("tangent_over", "tangent", can, [1.0000001, 2, -4], [0, 0, 1], "one rounding outside")
    yield make("tangent_under", "tangent", can, [0.99999994, 2, -4], [0, 0, 1], "one rounding inside: two hits")
    yield make("tangent_tilted", "tangent", tilted, [-1, 10.5, -6.5], [1, -2, 2], "across a tilted axis, exactly a radius from it")
    yield make("rim_touched", "rim", can, [-2, 3, 0], [1, 1, 0], "over the rim from outside: one hit")
    yield make("rim_entered", "rim", can, [-2, 5, 0], [1, -1, 0], "in at the rim, where side and disc meet: it counts once")
    yield make("rim_to_rim", "rim", can, [-2, 6, 0], [1, -2, 0], "in at one rim, out at the other")
    yield make("rim_open", "rim", pipe, [-2, 5, 0], [1, -1, 0], "a rim of a pipe belongs to its side")
    yield make("rim_missed", "rim", pipe, [-2, 5.0000005, 0], [1, -1, 0], "one rounding above it: only the inner wall")
    yield make("plane_of_disc", "rim", can, [-4, 4, 0.5], [1, 0, 0], "in the plane of a disc: two points of its rim")
    yield make("above_disc", "rim", can, [-4, 4.0000005, 0.5], [1, 0, 0], "one rounding above it")
    yield make("inside", "inside", can, [0.25, 1, 0.5], [1, 0.5, 0.25], "from inside")
    yield make("from_wall", "inside", can, [1, 1, 0], [-1, 0.5, 0.25], "from the side itself, inwards")
    yield make("from_disc", "inside", can, [0.25, 4, 0], [0.25, 1, 0], "from a disc, outwards")
    yield make("apex", "apex", funnel, [-4, 0, 0], [1, 0, 0], "an apex is a point of the surface")
    yield make("apex_through", "apex", filled, [0.5, -4, 0.25], [-0.125, 1, -0.0625], "in at the apex, out at the disc")
    yield make("apex_missed", "apex", funnel, [-4, -1e-6, 0], [1, 0, 0], "a millionth below it")
    yield make("apex_above", "apex", funnel, [-4, 1e-6, 0], [1, 0, 0], "a millionth above it: two hits 1e-6 apart")
    yield make("on_side", "parallel", filled, [-3, -4, 0], [3, 4, 0], "along a line of the side: apex and rim")
    yield make("beside_side", "parallel", funnel, [-3.75, -4, 0], [0.75, 1, 0], "parallel to a line of the side: a = 0, one root")
    yield make("near_side", "parallel", funnel, [-3.75, -4, 0], [0.75, 1.0000001, 0], "nearly parallel to it")
    yield make("mirror_image", "basic", funnel, [-4, -2, 0.5], [1, 0, 0], "the cone's mirror image is no part of it")
    yield make("cut", "basic", cut, [3, 2, 5], [-0.55, -0.35, -1], "no number is simple")
    yield make("cut_far", "distance", cut, [6000.3, 3000.2, 8000.1], [-0.6, -0.3, -0.8], "from 1e4")
    yield make("thin", "thin", thin, [0.25, 0.3125, 8], [0, 0, -1], "a radius of a millionth, through the axis")
    yield make("thin_beside", "thin", thin, [0.25, 0.312502, 8], [0, 0, -1], "nearly a radius beside it")
    yield make("thin_missed", "thin", thin, [0.25, 0.312503, 8], [0, 0, -1], "more than a radius beside it")
    yield make("thin_along", "thin", thin, [-3, -0.5, 0], [4, 1, 0], "along its axis")
    yield make("disc_alone", "ratio", cone([0, 0, 0], [0, 1e-6, 0], [1, 1], True), [0.5, 4, 0], [0, -1, 0], "a coin")
    yield make("coin_edge", "ratio", cone([0, 0, 0], [0, 1e-6, 0], [1, 1], True), [-4, 5e-7, 0.5], [1, 0, 0], "its edge")
    make = lambda name, family, shape, o, d, note, tmin=0.0: case("quad_" + name, "quadric", family, shape, o, d, note, tmin)
    none = [0, 0, 0]
    ball = quadric([1, 1, 1], none, none, -1)
    double = quadric([1, 1, -1], none, none, 0)
    tower = quadric([4, -1, 4], none, none, -1)
    bowl = quadric([1, 0, 1], none, [0, -1, 0], 0)
    saddle = quadric(none, [0, 0, 1], [0, 0, -1], 0)
    mixed = quadric([0.3, -0.7, 0.2], [0.4, -0.1, 0.9], [0.25, -0.6, 0.1], -0.35)
    yield make("ball", "basic", ball, [0.25, 0.5, 9], [0, 0, -1], "a sphere by its coefficients")
    yield make("ball_tangent", "tangent", ball, [1, 0, 9], [0, 0, -1], "a tangent counts once")
    yield make("ball_tangent_far", "tangent", ball, [1, 0, 4096], [0, 0, -1], "the same from 4,096")
    yield make("ball_over", "tangent", ball, [1.0000001, 0, 9], [0, 0, -1], "one rounding outside")
    yield make("ball_far", "distance", ball, [6000.3, -0.25, 8000.2], [-0.6, 0, -0.8], "from 1e4")
    yield make("ball_inside", "inside", ball, [0.25, 0.5, 0.125], [1, 2, -1], "from inside")
    yield make("asymptote", "degree", tower, [-3, -5, 0], [0.5, 1, 0], "parallel to an asymptote: a = 0, one root")
    yield make("asymptote_line", "degree", tower, [-2.5, -5, 0.5], [0.5, 1, 0], "a ruling: the ray lies in the surface and misses it")
    yield make("asymptote_axis", "degree", tower, [-2.5, -5, 0], [0.5, 1, 0], "an asymptote itself: neither root is left")
    yield make("asymptote_near", "degree", tower, [-3, -5, 0], [0.50000006, 1, 0], "nearly parallel to it: two roots, one very far")
    yield make("double_apex", "apex", double, [0.5, 0.25, -4], [-0.125, -0.0625, 1], "through the apex of a double cone")
    yield make("double_line", "degree", double, [3, 0, 3], [1, 0, 1], "along a line of the double cone")
    yield make("double_beside", "degree", double, [3, 0, -5], [1, 0, 1], "parallel to such a line")
    yield make("bowl_axis", "degree", bowl, [2, 9, 0.5], [0, -1, 0], "parallel to the axis of a paraboloid: one root")
    yield make("bowl_near_axis", "degree", bowl, [2, 9, 0.5], [1e-5, -1, 0], "nearly parallel to it")
    yield make("bowl_tangent", "tangent", bowl, [-3, 0, 0], [1, 0, 0], "a tangent at the bottom")
    yield make("saddle_down", "degree", saddle, [2, 3, 9], [0, 0, -1], "straight down on a saddle")
    yield make("saddle_line", "degree", saddle, [2, -3, -6], [0, 1, 2], "a line of the saddle")
    yield make("saddle_across", "basic", saddle, [3, -2.5, 0.1], [-1, 1, -0.3], "across it")
    yield make("plane", "degree", quadric(none, none, [1, 2, 3], -4), [0.1, 0.2, 9], [0.3, 0.1, -1], "no square at all: a plane")
    yield make("planes", "degree", quadric([1, 0, 0], none, none, -1), [-3, 0.2, 0.1], [1, 0.25, 0.5], "two planes")
    yield make("plane_twice", "tangent", quadric([1, 0, 0], none, none, 0), [-3, 0.2, 0.1], [1, 0.25, 0.5], "one plane twice: a double root")
    yield make("mixed", "basic", mixed, [2.3, -1.7, 4.1], [-0.35, 0.6, -0.9], "no number is simple")
    yield make("mixed_far", "distance", mixed, [2300.3, -1700.7, 4100.1], [-0.5, 0.37, -0.9], "from 5,000")
    yield make("shell", "ratio", quadric([1, 1, 1], none, none, -1e-12), [2e-7, 0, 4], [0, 0, -1], "a radius of a millionth")


def main():
    file = json.loads(FILE.read_text())
    others = [c for c in file["cases"] if c["primitive"] not in ("cone", "quadric")]
    file["cases"] = others + list(cases())
    FILE.write_text(json.dumps(file, indent=1, ensure_ascii=False))


if __name__ == "__main__":
    main()
