# Reference values for five rough metal spheres, from the renderer Mitsuba 3
# and, next to them, from a float64 integrator in numpy that shares no code with it.
#
# Run by hand (about five minutes on two cores):
#
#     python3 -m venv venv
#     venv/bin/pip install mitsuba==3.9.1 numpy
#     nice venv/bin/python five_spheres.py             # writes five_spheres.json next to this file
#
# The variant is scalar_rgb, in single precision: the wheel holds none in double
# precision. "five_spheres.py llvm_ad_rgb" takes another one; LLVM 14 and 15 crash there, LLVM 22
# works (its path goes into the environment variable DRJIT_LIBLLVM_PATH).
#
# What must be known to compare with these values stands in CONVENTIONS below,
# which is written into five_spheres.json too.

import datetime
import json
import math
import os
import re
import sys

import mitsuba
import numpy

HERE = os.path.dirname(os.path.abspath(__file__))
VARIANT = sys.argv[1] if len(sys.argv) > 1 else "scalar_rgb"
mitsuba.set_variant(VARIANT)

COLUMNS, ROWS = 300, 100
VERTICAL_FIELD_OF_VIEW = 20.0
CAMERA = numpy.array([0.0, 0.0, 14.0])
CENTRES = numpy.array([[x, 0.0, 0.0] for x in (-4.4, -2.2, 0.0, 2.2, 4.4)])
ROUGHNESSES = (0.1, 0.325, 0.55, 0.775, 1.0)
TO_LIGHT = numpy.array([0.5, 0.7, 0.5]) / math.sqrt(0.99)
WINDOW = 20
ROW_LENGTH = 15

RUNS = 512
STUDENT_999 = 3.310  # two-sided 99.9 %, 511 degrees of freedom
# In each pixel, in each run. Mitsuba adds a pixel's samples up in single precision, so they
# are few, and the runs' mean is taken in double precision.
MITSUBA_SAMPLES = 64
ROUNDING = MITSUBA_SAMPLES * 2.0**-24
INTEGRATOR_POINTS = 1 << 14  # in each window, in each run
NODES = 48  # Gauss-Legendre nodes along each side of a pixel

CONVENTIONS = {
    "picture": "300 columns by 100 rows; column 0 is the left one, row 0 the top one. "
    "Pixel (c, r) is the square c..c+1 by r..r+1 and its value the mean over that square (box filter). "
    "The point (150, 50) is the middle of the picture. "
    "World +x points right, +y up, +z to the camera: the smoothest sphere (x = -4.4) is the leftmost one.",
    "ray": "The point (u, v) of the picture is seen along (s (u - 150), s (50 - v), -1), s = 2 tan(10 degrees) / 100.",
    "values": "Linear radiance, no tone curve, no exposure; red, green and blue are equal.",
    "surface": "Fresnel term 1 at all angles, GGX with alpha = roughness squared, one scattering at the microfacets "
    "(no energy compensation); nothing is clamped.",
    "shadowing_masking": "Mitsuba's roughconductor uses the separable G = G1(view) G1(light). 'separable' and "
    "'height_correlated' are the values of the float64 integrator with that G and with "
    "G = 1 / (1 + lambda(view) + lambda(light)). Compare Mitsuba only with a separable G.",
    "white": "Constant environment of radiance 1, mean over the window. one_bounce: Mitsuba's max_depth 2; the other "
    "spheres hide the environment and are black. all_bounces: unlimited depth; the other spheres are seen. "
    "alone: only this one sphere in the scene, where one bounce is all there is.",
    "light": "Black environment and one directional light of irradiance 1 on a surface perpendicular to it, "
    "Mitsuba's max_depth 2: light that comes by way of another sphere is left out, shadows are not. "
    "window: mean over the window. row: each pixel of the row through the brightest pixel.",
    "window": "20 by 20 pixels around the projected centre of the sphere, all of them wholly on the sphere.",
    "row": "15 pixels side by side, wholly on the sphere: around the brightest of all pixels wholly on it (separable "
    "G), moved to the side where that one is too close to the outline.",
    "uncertainty": "standard_error is that of the mean of 512 independent runs. The 99.9 % interval is value plus or "
    "minus half_width_999, which is 3.310 standard errors (Student, 511 degrees of freedom), for Mitsuba plus "
    "64 / 2^24 of the value, because it adds 64 samples up in single precision. The integrator's values for 'light' "
    "come from Gauss-Legendre nodes and have no noise.",
}


# ---------------------------------------------------------------- geometry

PIXEL_SIZE = 2.0 * math.tan(math.radians(VERTICAL_FIELD_OF_VIEW / 2)) / ROWS


def directions_through(columns, rows):
    """Unit vectors from the camera through points of the picture."""
    directions = numpy.stack(
        [(columns - COLUMNS / 2) * PIXEL_SIZE, (ROWS / 2 - rows) * PIXEL_SIZE, -numpy.ones_like(columns)], axis=-1
    )
    return directions / numpy.linalg.norm(directions, axis=-1, keepdims=True)


def distances_to_sphere(origins, directions, centre):
    """Distance along each ray to the sphere, infinite where there is none."""
    to_centre = centre - origins
    along = (to_centre * directions).sum(-1)
    beside = to_centre - along[..., None] * directions
    inside = 1.0 - (beside * beside).sum(-1)
    distances = along - numpy.sqrt(numpy.maximum(inside, 0.0))
    return numpy.where((inside > 0.0) & (distances > 0.0), distances, numpy.inf)


def lies_on_sphere(column, row, columns, rows, sphere):
    """Whether a whole rectangle of pixels shows the sphere (whose outline is convex)."""
    corners = directions_through(
        numpy.array([column, column + columns, column, column + columns], float),
        numpy.array([row, row, row + rows, row + rows], float),
    )
    return bool(numpy.isfinite(distances_to_sphere(CAMERA, corners, CENTRES[sphere])).all())


def window_of(sphere):
    middle = COLUMNS / 2 + CENTRES[sphere][0] / (CAMERA[2] * PIXEL_SIZE)
    column, row = round(middle) - WINDOW // 2, ROWS // 2 - WINDOW // 2
    assert lies_on_sphere(column, row, WINDOW, WINDOW, sphere)
    return column, row, WINDOW, WINDOW


# ---------------------------------------------------------------- Mitsuba


def mitsuba_scene(spheres, lighting, max_depth, rectangle):
    column, row, columns, rows = rectangle
    scene = {
        "type": "scene",
        "integrator": {"type": "path", "max_depth": max_depth},
        "sensor": {
            "type": "perspective",
            "fov": VERTICAL_FIELD_OF_VIEW,
            "fov_axis": "y",
            "to_world": mitsuba.ScalarTransform4f().look_at(origin=CAMERA.tolist(), target=[0, 0, 0], up=[0, 1, 0]),
            "sampler": {"type": "multijitter", "sample_count": MITSUBA_SAMPLES},
            "film": {
                "type": "hdrfilm",
                "width": COLUMNS,
                "height": ROWS,
                "crop_offset_x": column,
                "crop_offset_y": row,
                "crop_width": columns,
                "crop_height": rows,
                "pixel_format": "rgb",
                "component_format": "float32",
                "rfilter": {"type": "box"},
            },
        },
        "emitter": {
            "white": {"type": "constant", "radiance": {"type": "rgb", "value": 1.0}},
            "light": {
                "type": "directional",
                "direction": (-TO_LIGHT).tolist(),
                "irradiance": {"type": "rgb", "value": 1.0},
            },
        }[lighting],
    }
    for sphere in spheres:
        scene[f"sphere{sphere}"] = {
            "type": "sphere",
            "center": CENTRES[sphere].tolist(),
            "radius": 1.0,
            "bsdf": {
                "type": "roughconductor",
                "material": "none",
                "distribution": "ggx",
                "alpha": ROUGHNESSES[sphere] ** 2,
                "sample_visible": True,
            },
        }
    return mitsuba.load_dict(scene)


def mitsuba_runs(spheres, lighting, max_depth, rectangle):
    """The rectangle's pixels (row, column) from each run."""
    scene = mitsuba_scene(spheres, lighting, max_depth, rectangle)
    runs = []
    for seed in range(RUNS):
        picture = numpy.array(mitsuba.render(scene, seed=seed, spp=MITSUBA_SAMPLES), dtype=float)
        assert numpy.ptp(picture, axis=2).max() == 0.0
        runs.append(picture[..., 0])
    return numpy.array(runs)


# ---------------------------------------------------------------- float64 integrator
#
# All directions point away from the surface; "cosines" are with the surface's normal.


def smith_lambda(cosines, alpha):
    return 0.5 * (numpy.sqrt(1.0 + alpha**2 * (1.0 / cosines**2 - 1.0)) - 1.0)


def both_shadowings(view_cosines, light_cosines, alpha):
    """G, separable and height-correlated."""
    view, light = smith_lambda(view_cosines, alpha), smith_lambda(light_cosines, alpha)
    return numpy.stack([1.0 / ((1.0 + view) * (1.0 + light)), 1.0 / (1.0 + view + light)])


def seen_under_the_light(columns, rows, sphere):
    """Radiance seen at points of the picture on the sphere, for both G."""
    alpha = ROUGHNESSES[sphere] ** 2
    directions = directions_through(columns, rows)
    positions = CAMERA + distances_to_sphere(CAMERA, directions, CENTRES[sphere])[..., None] * directions
    normals = positions - CENTRES[sphere]
    light_cosines = normals @ TO_LIGHT
    lit = light_cosines > 0.0
    for other in range(len(CENTRES)):
        if other != sphere:
            lit &= numpy.isinf(distances_to_sphere(positions, TO_LIGHT, CENTRES[other]))
    halves = TO_LIGHT - directions
    halves /= numpy.linalg.norm(halves, axis=-1, keepdims=True)
    half_sines_squared = (numpy.cross(normals, halves) ** 2).sum(-1)
    half_cosines_squared = (normals * halves).sum(-1) ** 2
    density = alpha**2 / (math.pi * (half_sines_squared + alpha**2 * half_cosines_squared) ** 2)
    view_cosines = -(normals * directions).sum(-1)
    shadowings = both_shadowings(view_cosines, numpy.where(lit, light_cosines, 1.0), alpha)
    return numpy.where(lit, density * shadowings / (4.0 * view_cosines), 0.0)


def pixels_under_the_light(rectangle, sphere):
    """The rectangle's pixels (G, row, column), integrated over their areas."""
    column, row, columns, rows = rectangle
    nodes, weights = numpy.polynomial.legendre.leggauss(NODES)
    nodes, weights = (nodes + 1.0) / 2.0, weights / 2.0
    pixels = numpy.empty((2, rows, columns))
    for r in range(rows):
        for c in range(columns):
            u, v = numpy.meshgrid(column + c + nodes, row + r + nodes)
            pixels[:, r, c] = weights @ seen_under_the_light(u, v, sphere) @ weights
    return pixels


def row_through(column, row, sphere):
    """A row of pixels wholly on the sphere, with this pixel as close to its middle as possible."""
    firsts = range(column - ROW_LENGTH + 1, column + 1)
    firsts = [first for first in firsts if lies_on_sphere(first, row, ROW_LENGTH, 1, sphere)]
    return min(firsts, key=lambda first: abs(first + ROW_LENGTH // 2 - column)), row, ROW_LENGTH, 1


def brightest_pixel(sphere):
    """Column and row of the brightest of the pixels wholly on the sphere, separable G."""
    found = (-1.0, 0, 0)
    for row in range(ROWS):
        for column in range(COLUMNS):
            if lies_on_sphere(column, row, 1, 1, sphere):
                u, v = numpy.meshgrid(column + (numpy.arange(8) + 0.5) / 8, row + (numpy.arange(8) + 0.5) / 8)
                found = max(found, (float(seen_under_the_light(u, v, sphere)[0].mean()), column, row))
    return found[1], found[2]


def reflect_at_microfacets(view, normals, alphas, numbers):
    """Draw visible GGX normals (as spherical caps); return the new directions and weights for both G."""
    # Any two tangents will do: the surface is isotropic.
    helper = numpy.where(numpy.abs(normals[:, :1]) > 0.5, [[0.0, 1.0, 0.0]], [[1.0, 0.0, 0.0]])
    tangents = numpy.cross(helper, normals)
    tangents /= numpy.linalg.norm(tangents, axis=1, keepdims=True)
    frame = numpy.stack([tangents, numpy.cross(normals, tangents), normals], axis=1)
    local_view = numpy.einsum("nij,nj->ni", frame, view)
    stretch = numpy.stack([alphas, alphas, numpy.ones_like(alphas)], axis=1)
    stretched = local_view * stretch
    stretched /= numpy.linalg.norm(stretched, axis=1, keepdims=True)
    heights = (1.0 - numbers[:, 0]) * (1.0 + stretched[:, 2]) - stretched[:, 2]
    radii = numpy.sqrt(numpy.clip(1.0 - heights**2, 0.0, 1.0))
    angles = 2.0 * math.pi * numbers[:, 1]
    halves = numpy.stack([radii * numpy.cos(angles), radii * numpy.sin(angles), heights], axis=1) + stretched
    halves *= stretch
    halves /= numpy.linalg.norm(halves, axis=1, keepdims=True)
    local_light = 2.0 * (local_view * halves).sum(1, keepdims=True) * halves - local_view
    above = local_light[:, 2] > 0.0
    shadowings = both_shadowings(local_view[:, 2], numpy.where(above, local_light[:, 2], 1.0), alphas)
    view_shadowing = 1.0 / (1.0 + smith_lambda(local_view[:, 2], alphas))
    weights = numpy.where(above, shadowings / view_shadowing, 0.0)
    return numpy.einsum("nij,ni->nj", frame, local_light), weights


def white_once(rectangle, sphere, random):
    """The window's means (G) in the white environment: one bounce, all bounces, alone."""
    column, row, columns, rows = rectangle
    # A Kronecker sequence in four dimensions, shifted by chance: place in the window, first microfacet.
    root = 1.1673039782614187  # of x^5 = x + 1
    steps = root ** -numpy.arange(1.0, 5.0)
    points = (random.random(4) + numpy.arange(INTEGRATOR_POINTS)[:, None] * steps) % 1.0
    directions = directions_through(column + columns * points[:, 0], row + rows * points[:, 1])
    positions = CAMERA + distances_to_sphere(CAMERA, directions, CENTRES[sphere])[:, None] * directions
    numbers = points[:, 2:]
    on = numpy.full(INTEGRATOR_POINTS, sphere)
    throughputs = numpy.ones((2, INTEGRATOR_POINTS))
    alphas = numpy.array(ROUGHNESSES) ** 2
    sums = []
    while len(on):
        normals = positions - CENTRES[on]
        directions, weights = reflect_at_microfacets(-directions, normals, alphas[on], numbers)
        throughputs = throughputs * weights
        if not sums:
            alone = throughputs.sum(1)
        distances = numpy.stack([distances_to_sphere(positions, directions, centre) for centre in CENTRES])
        distances[on, numpy.arange(len(on))] = numpy.inf  # convex: no ray meets the sphere that it leaves
        on, nearest = distances.argmin(0), distances.min(0)
        free = numpy.isinf(nearest)
        sums.append(throughputs[:, free].sum(1))
        going_on = ~free & (throughputs[0] > 0.0)
        on, directions, throughputs = on[going_on], directions[going_on], throughputs[:, going_on]
        positions = positions[going_on] + nearest[going_on, None] * directions
        numbers = random.random((len(on), 2))
    return numpy.array([sums[0], sum(sums), alone]) / INTEGRATOR_POINTS


# ---------------------------------------------------------------- output


def mean_of_runs(runs, rounding=0.0):
    """Mean, standard error and half width of the 99.9 % interval; lists where a run holds a list."""
    mean = runs.mean(axis=0)
    error = runs.std(axis=0, ddof=1) / math.sqrt(len(runs))
    return {
        "value": rounded(mean),
        "standard_error": rounded(error),
        "half_width_999": rounded(STUDENT_999 * error + rounding * mean),
    }


def rounded(values):
    return [rounded(value) for value in values] if numpy.ndim(values) else float(f"{values:.8g}")


def values_of_sphere(sphere):
    everything, window = range(len(CENTRES)), window_of(sphere)
    column, row = brightest_pixel(sphere)
    row_of_pixels = row_through(column, row, sphere)

    random = numpy.random.default_rng(sphere)
    integrated = numpy.array([white_once(window, sphere, random) for _ in range(RUNS)])
    white = {}
    for index, (name, spheres, max_depth) in enumerate(
        [("one_bounce", everything, 2), ("all_bounces", everything, -1), ("alone", [sphere], 2)]
    ):
        white[name] = {
            "mitsuba": mean_of_runs(mitsuba_runs(spheres, "white", max_depth, window).mean(axis=(1, 2)), ROUNDING),
            "separable": mean_of_runs(integrated[:, index, 0]),
            "height_correlated": mean_of_runs(integrated[:, index, 1]),
        }

    window_means = pixels_under_the_light(window, sphere).mean(axis=(1, 2))
    row_pixels = pixels_under_the_light(row_of_pixels, sphere)[:, 0]
    light = {
        "window": {
            "mitsuba": mean_of_runs(mitsuba_runs(everything, "light", 2, window).mean(axis=(1, 2)), ROUNDING),
            "separable": {"value": rounded(window_means[0])},
            "height_correlated": {"value": rounded(window_means[1])},
        },
        "row": {
            "mitsuba": mean_of_runs(mitsuba_runs(everything, "light", 2, row_of_pixels)[:, 0], ROUNDING),
            "separable": {"value": rounded(row_pixels[0])},
            "height_correlated": {"value": rounded(row_pixels[1])},
        },
    }
    names = ("first_column", "first_row", "columns", "rows")
    return {
        "centre": CENTRES[sphere].tolist(),
        "roughness": ROUGHNESSES[sphere],
        "alpha": rounded(ROUGHNESSES[sphere] ** 2),
        "window": dict(zip(names, window)),
        "row": dict(zip(names, row_of_pixels)),
        "brightest_column": column,
        "white": white,
        "light": light,
    }


def print_differences(values):
    """How far the integrator is from Mitsuba, where 1 is the end of the 99.9 % interval; largest of a list."""
    print("roughness", values["roughness"])
    for lighting in ("white", "light"):
        for name, value in values[lighting].items():
            for shadowing in ("separable", "height_correlated"):
                mine, theirs = value[shadowing], value["mitsuba"]
                apart = numpy.abs(numpy.subtract(theirs["value"], mine["value"]))
                allowed = numpy.hypot(theirs["half_width_999"], mine.get("half_width_999", 0.0))
                print(f"    {lighting} {name:12} {shadowing:18} {(apart / allowed).max():8.2f}", flush=True)


def main():
    spheres = []
    for sphere in range(len(CENTRES)):
        spheres.append(values_of_sphere(sphere))
        print_differences(spheres[-1])
    answer = {
        "made_by": "five_spheres.py",
        "mitsuba_version": mitsuba.__version__,
        "variant": VARIANT,
        "date": datetime.date.today().isoformat(),
        "samples": {
            "runs": RUNS,
            "mitsuba_samples_per_pixel_and_run": MITSUBA_SAMPLES,
            "integrator_points_per_window_and_run": INTEGRATOR_POINTS,
            "gauss_legendre_nodes_per_pixel_side": NODES,
        },
        "conventions": CONVENTIONS,
        "camera": {
            "position": CAMERA.tolist(),
            "target": [0.0, 0.0, 0.0],
            "up": [0.0, 1.0, 0.0],
            "vertical_field_of_view_degrees": VERTICAL_FIELD_OF_VIEW,
            "columns": COLUMNS,
            "rows": ROWS,
        },
        "direction_to_light": TO_LIGHT.tolist(),
        "irradiance": 1.0,
        "spheres": spheres,
    }
    text = json.dumps(answer, indent=2)
    text = re.sub(r"\[[^][{}]+\]", lambda numbers: " ".join(numbers[0].split()), text)  # a list on one line
    with open(os.path.join(HERE, "five_spheres.json"), "w") as file:
        file.write(text + "\n")


if __name__ == "__main__":
    main()
