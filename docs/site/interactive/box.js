// A ray in the plane, past a sphere and a box: all roots, and the one that each shape's shader reports.
figures.add("box", figure => {
    const [LEFT, RIGHT, AIM, GROUND] = [84, 480, 466, 220];
    const SPHERE = { center: [195, 120], radius: 48 };
    const BOX = { low: [300, 60], high: [400, 140] };
    const ROWS = ["sphere", "slab of x", "slab of y", "box", "tmin, tmax"];
    const rowAt = row => 243 + 22 * row;
    const NEVER = [Infinity, -Infinity];

    // From the foot of the perpendicular, half a chord to either side.
    function sphereRoots({ origin, direction }) {
        const f = origin.map((x, i) => x - SPHERE.center[i]);
        const middle = -f[0] * direction[0] - f[1] * direction[1];
        const foot = f.map((x, i) => x + middle * direction[i]);
        const half = Math.sqrt(SPHERE.radius ** 2 - foot[0] ** 2 - foot[1] ** 2);
        return half >= 0 ? [middle - half, middle + half] : NEVER;
    }

    // Where the ray enters and leaves a slab. Without a way across, it is inside for ever or never.
    function slab({ origin, direction }, axis) {
        const [low, high, o, d] = [BOX.low[axis], BOX.high[axis], origin[axis], direction[axis]];
        if (d === 0) {
            return low <= o && o <= high ? [-Infinity, Infinity] : NEVER;
        }
        return [(low - o) / d, (high - o) / d].sort((a, b) => a - b);
    }

    // As sphere.rint and box.rint take it: the far root where the near one lies before tmin.
    function reported([near, far], tmin, tmax) {
        const first = near > tmin ? near : far;
        return first > tmin && first <= tmax ? first : null;
    }

    const spell = t => t.toFixed(0).replace("-", "−");
    function verdict([near, far], t, tmin, tmax) {
        const why = t === near ? `${spell(t)} is the first after tmin, and is reported`
            : t !== null ? `${near < 0 ? "the ray starts inside" : `${spell(near)} is too near`}, and ${spell(t)} is reported`
                : far <= tmin ? "both lie before tmin, a miss"
                    : near > tmax ? "both lie beyond tmax, a miss"
                        : "one lies before tmin, the other beyond tmax, a miss";
        return near <= far ? `roots ${spell(near)} and ${spell(far)}; ${why}.` : "no root, a miss.";
    }

    const drawing = figure.drawing(`0 0 ${RIGHT} 350`);
    let ray;
    const grips = [
        (x, y) => {
            figure.set("start x", x);
            figure.set("start y", GROUND - y);
        },
        (_, y) => figure.set("aim", GROUND - y),
        ...["tmin", "tmax"].map(name => x => figure.set(name, (x - ray.origin[0]) / ray.direction[0])),
    ].map(moved => figure.grip(drawing, moved));
    const legend = figure.add(figure.stage, "span", "legend");
    figure.add(legend, "span", "key begin", "a root that is reported");
    figure.add(legend, "span", "key rounded", "a root that is not");

    const path = (kind, ...points) => `<path class="${kind}" d="M${points.join(" L")}"/>`;
    const rect = (kind, [x, y], [right, bottom]) =>
        `<rect class="${kind}" x="${x}" y="${y}" width="${right - x}" height="${bottom - y}"/>`;
    const circle = (kind, [x, y], r) => `<circle class="${kind}" cx="${x}" cy="${y}" r="${r}"/>`;

    return () => {
        const origin = [figure.number("start x"), GROUND - figure.number("start y")];
        const aim = [AIM, GROUND - figure.number("aim")];
        const length = Math.hypot(aim[0] - origin[0], aim[1] - origin[1]);
        ray = { origin, direction: aim.map((x, i) => (x - origin[i]) / length) };
        const tmin = figure.number("tmin");
        const tmax = Math.max(figure.number("tmax"), tmin);
        const slabs = [slab(ray, 0), slab(ray, 1)];
        const [enter, leave] = [Math.max(slabs[0][0], slabs[1][0]), Math.min(slabs[0][1], slabs[1][1])];
        const shapes = { sphere: sphereRoots(ray), box: enter <= leave ? [enter, leave] : NEVER };
        const names = Object.keys(shapes);
        const hits = names.map(name => reported(shapes[name], tmin, tmax));
        figure.found = { ray, tmin, tmax, shapes, slabs, hits, sphere: SPHERE, box: BOX };

        const point = t => origin.map((x, i) => x + t * ray.direction[i]);
        // The t of a point lies below it.
        const across = t => Math.min(Math.max(point(t)[0], LEFT), RIGHT);
        const end = (RIGHT - origin[0]) / ray.direction[0];
        const part = [tmin, tmax].map(t => point(Math.min(t, end)));
        const bar = (row, kind, [from, to]) =>
            from <= to ? rect(kind, [across(from), rowAt(row) - 7], [across(to), rowAt(row) + 7]) : "";
        let shown = rect("slab-x", [BOX.low[0], 0], [BOX.high[0], GROUND]) + rect("slab-y", [0, BOX.low[1]], [RIGHT, BOX.high[1]])
            + rect("shape", BOX.low, BOX.high) + circle("shape", SPHERE.center, SPHERE.radius)
            + path("edge rest", point((LEFT - origin[0]) / ray.direction[0]), origin)
            + path("ray rest", origin, point(end)) + path("ray", ...part);
        ROWS.forEach((name, row) => shown += `<text x="4" y="${rowAt(row) + 5}">${name}</text>`
            + path("edge", [LEFT, rowAt(row)], [RIGHT, rowAt(row)]));
        shown += bar(0, "shape", shapes.sphere) + bar(1, "slab-x", slabs[0]) + bar(2, "slab-y", slabs[1])
            + bar(3, "shape", shapes.box) + path("ray", ...part.map(([x]) => [x, rowAt(4)]));
        names.forEach((name, i) => shapes[name].filter(t => point(t)[0] > LEFT && t < end).forEach(t => {
            const ends = [point(t), [across(t), rowAt(3 * i)]];
            shown += path("edge", ...ends) + ends.map(at => circle(t === hits[i] ? "begin" : "rounded", at, 5)).join("");
        }));
        drawing.innerHTML = shown;
        [origin, aim, ...part.map(([x]) => [Math.min(x, AIM), rowAt(4)])].forEach(([x, y], i) => {
            grips[i].setAttribute("cx", x);
            grips[i].setAttribute("cy", y);
            grips[i].setAttribute("r", 11);
        });
        const nearest = names[hits.indexOf(Math.min(...hits.filter(t => t !== null)))];
        figure.said.textContent = names.map((name, i) => `The ${name}: ${verdict(shapes[name], hits[i], tmin, tmax)} `).join("")
            + (nearest ? `The ray hits the ${nearest}.` : "The ray hits nothing.");
    };
});
