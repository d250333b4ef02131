"""Times Embree on rays from a file, for `embree.rs`: `python3 embree.py FILE`, with `pip install embreex numpy`.

The file: the number of triangles, and nine floats each; then for each kind of ray its number, 1 if any hit will do,
and six floats each, origin and direction. All numbers have 32 bits. Prints, for each kind, the median processor time of
seven runs in milliseconds and the number of hits. Robust mode, one ray at a time, all triangles in one level.
"""

import json
import statistics
import sys
import time

import numpy
from embreex import rtcore_scene
from embreex.mesh_construction import TriangleMesh

data = numpy.fromfile(sys.argv[1], dtype=numpy.uint32)
count = int(data[0])
scene = rtcore_scene.EmbreeScene(robust=True)
TriangleMesh(scene, data[1 : 1 + 9 * count].view(numpy.float32).reshape(count, 3, 3).copy())
at = 1 + 9 * count
kinds = []
while at < len(data):
    rays, is_any = int(data[at]), int(data[at + 1])
    both = data[at + 2 : at + 2 + 6 * rays].view(numpy.float32).reshape(rays, 6)
    origins, directions = both[:, :3].copy(), both[:, 3:].copy()
    query = "OCCLUDED" if is_any else "INTERSECT"
    scene.run(origins[:1], directions[:1], query=query)  # the first call builds the tree
    times = []
    for _ in range(7):
        begun = time.process_time()
        hits = scene.run(origins, directions, query=query)
        times.append(1e3 * (time.process_time() - begun))
    kinds.append({"ms": statistics.median(times), "hits": int((hits >= 0).sum())})
    at += 2 + 6 * rays
print(json.dumps(kinds))
