// A walk through a tree of boxes in the plane, visit by visit: docs/drawings/walk.rs draws the same one.
figures.add("walk", figure => {
    const [LEFT, RIGHT, GROUND] = [34, 434, 300];
    const NODES = { root: ["P", "Q"], P: ["R", "C"], Q: ["D", "E"], R: ["A", "B"] };
    const LEAVES = {
        A: [[84, 146], [84, 202], [152, 146]],
        B: [[94, 280], [150, 248], [142, 292]],
        C: [[212, 234], [268, 222], [236, 112]],
        D: [[312, 126], [364, 116], [340, 196]],
        E: [[376, 232], [424, 156], [420, 246]],
    };
    // Where letters stand in triangles, and all boxes in the tree.
    const LETTERS = { A: [101, 171], B: [130, 279], C: [238, 223], D: [340, 142], E: [409, 216] };
    const PLACES = {
        root: [656, 84], P: [578, 146], Q: [734, 146], R: [540, 208], C: [616, 208], D: [696, 208], E: [772, 208],
        A: [506, 270], B: [574, 270],
    };
    const STATES = ["visited now", "visited before", "on the stack", "missed", "behind the hit"];
    const kind = state => state ? `state ${state.replaceAll(" ", "-")}` : "state";

    // The box of a place; each level grows by a little, so that walls are seen apart.
    function bounds(of) {
        const corners = LEAVES[of] ?? NODES[of].flatMap(bounds);
        const ends = (choose, by) => [0, 1].map(i => choose(...corners.map(corner => corner[i])) + by);
        return [ends(Math.min, -5), ends(Math.max, 5)];
    }

    // Where a ray enters a box before `end`, and Infinity if nowhere.
    function entered(ray, [low, high], end) {
        const times = wall => wall.map((x, i) => (x - ray.eye[i]) / ray.towards[i]);
        const [one, other] = [times(low), times(high)];
        const enter = Math.max(0, ...one.map((t, i) => Math.min(t, other[i])));
        const leave = Math.min(end, ...one.map((t, i) => Math.max(t, other[i])));
        return enter <= leave ? enter : Infinity;
    }

    // Where a ray meets a triangle of the plane first.
    function met(ray, corners) {
        const cross = (a, b) => a[0] * b[1] - a[1] * b[0];
        return Math.min(...corners.map((from, i) => {
            const edge = corners[(i + 1) % 3].map((x, j) => x - from[j]);
            const away = from.map((x, j) => x - ray.eye[j]);
            const area = cross(ray.towards, edge);
            const along = cross(away, ray.towards) / area;
            return along >= 0 && along <= 1 ? cross(away, edge) / area : Infinity;
        }));
    }

    // As walk.glsl does it, or with the far child first. What a visit misses is told apart: boxes that the whole
    // ray misses, and boxes behind the hit.
    function walk(ray, nearFirst) {
        const [visits, stack] = [[], []];
        let [nearest, hit, next] = [Infinity, null, "root"];
        while (next ??= stack.pop()) {
            const visit = { of: next, missed: [], behind: [] };
            next = null;
            if (LEAVES[visit.of]) {
                const t = met(ray, LEAVES[visit.of]);
                visit.found = t < nearest ? "the triangle is hit: what lies behind is of no interest now"
                    : t < Infinity ? "the triangle lies behind the hit"
                        : "the triangle is missed, although its box was entered";
                if (t < nearest) {
                    [nearest, hit] = [t, visit.of];
                }
            } else {
                const children = NODES[visit.of];
                const at = Object.fromEntries(children.map(child => [child, entered(ray, bounds(child), nearest)]));
                const open = children.filter(child => at[child] < Infinity).sort((a, b) => at[a] - at[b]);
                for (const child of children.filter(child => !open.includes(child))) {
                    visit[entered(ray, bounds(child), Infinity) < Infinity ? "behind" : "missed"].push(child);
                }
                const [near, far] = open;
                if (far) {
                    next = nearFirst ? near : far;
                    stack.push(nearFirst ? far : near);
                    visit.found = `the ray enters ${near} and ${far}; ${near} is nearer, ${stack.at(-1)} is put aside`;
                } else if (near) {
                    next = near;
                    const begins = visit.behind.length ? `${visit.behind} begins behind the hit` : `misses ${visit.missed}`;
                    visit.found = `the ray enters ${near}, ${begins}`;
                } else {
                    visit.found = visit.behind.length === 2 ? `${visit.behind.join(" and ")} begin behind the hit: neither is opened`
                        : visit.missed.length === 2 ? `the ray misses ${visit.missed.join(" and ")}`
                            : `the ray misses ${visit.missed}, and ${visit.behind} begins behind the hit`;
                }
            }
            visits.push({ ...visit, stack: [...stack], nearest, hit });
        }
        return visits;
    }

    // What is known of each box after the last of some visits.
    function states(visits) {
        const known = {};
        for (const { of, missed, behind } of visits) {
            known[of] = STATES[1];
            missed.forEach(child => known[child] = STATES[3]);
            behind.forEach(child => known[child] = STATES[4]);
        }
        const { of, stack } = visits.at(-1);
        stack.forEach(waiting => known[waiting] = STATES[2]);
        known[of] = STATES[0];
        return known;
    }

    const visitsOf = ({ length }) => `${length} ${length === 1 ? "visit" : "visits"}`;
    const scene = figure.drawing("18 76 434 242", "Shapes in boxes");
    const tree = figure.drawing("474 62 330 230", "Their tree");
    const ends = { eye: LEFT, aim: RIGHT };
    for (const [name, x] of Object.entries(ends)) {
        ends[name] = figure.grip(scene, (_, y) => figure.set(name, GROUND - y));
        ends[name].setAttribute("cx", x);
    }
    const legend = figure.add(figure.stage, "span", "legend");
    STATES.forEach(state => figure.add(legend, "span", `key ${kind(state)}`, state));
    const region = figure.add(figure.stage, "span", "region");
    figure.add(region, "span", "label", "The stack, its top at the right");
    const records = figure.add(region, "span", "records");

    const box = (of, state, [left, top], [right, bottom]) =>
        `<rect class="${kind(state)}" data-of="${of}" x="${left}" y="${top}" width="${right - left}" height="${bottom - top}"/>`;
    const path = (kind, ...points) => `<path class="${kind}" d="M${points.join(" L")}"/>`;
    const letters = (text, [x, y], anchor = "middle") => `<text x="${x}" y="${y}" text-anchor="${anchor}">${text}</text>`;

    return () => {
        const heights = ["eye", "aim"].map(name => GROUND - figure.number(name));
        const [from, to] = heights;
        // A level ray may lie in a wall, where 0 / 0 is no number: it falls a little.
        const ray = { eye: [LEFT, from], towards: [RIGHT - LEFT, to - from || 1e-9] };
        const order = figure.word("first");
        const [near, far] = [walk(ray, true), walk(ray, false)];
        const visits = order === "near" ? near : far;
        const step = Math.min(figure.number("step"), visits.length);
        const visit = visits[step - 1];
        const known = states(visits.slice(0, step));
        const { hit } = visits.at(-1);
        figure.found = {
            visits: visits.map(({ of, found, stack }) => [of, found, stack]), hit, known, boxes: Object.keys(PLACES).map(bounds),
            counts: [near.length, far.length], corners: LEAVES,
        };

        const point = t => ray.eye.map((x, i) => x + t * ray.towards[i]);
        let shapes = "";
        for (const of of Object.keys(PLACES).slice(1)) {
            const [low, high] = bounds(of);
            shapes += box(of, known[of], low, high) + (NODES[of] ? letters(of, [low[0] + 2, low[1] - 6], "start") : "");
        }
        for (const [of, corners] of Object.entries(LEAVES)) {
            shapes += path(of === visit.hit ? "shape hit" : "shape", ...corners, corners[0]) + letters(of, LETTERS[of]);
        }
        const until = Math.min(visit.nearest, 1);
        shapes += path("ray", ray.eye, point(until)) + path("ray rest", point(until), point(1));
        if (visit.hit) {
            const [x, y] = point(visit.nearest);
            shapes += `<circle class="begin" cx="${x}" cy="${y}" r="5"/>`;
        }
        scene.innerHTML = shapes;
        Object.values(ends).forEach((grip, i) => grip.setAttribute("cy", heights[i]));

        const edges = Object.entries(NODES).flatMap(([of, children]) => children.map(child => path("edge", PLACES[of], PLACES[child])));
        const cards = Object.entries(PLACES).map(([of, [x, y]]) =>
            box(of, known[of], [x - 25, y - 14], [x + 25, y + 14]) + letters(of, [x, y + 5]));
        tree.innerHTML = edges.join("") + cards.join("");

        records.replaceChildren();
        (visit.stack.length ? visit.stack : ["empty"]).forEach(of => figure.add(records, "span", `record ${kind(of !== "empty" && STATES[2])}`, of));
        const end = step < visits.length ? "" : ` The walk is over: ${hit ? `the ray hits ${hit}` : "no triangle is hit"}.`;
        figure.said.textContent = `Visit ${step} of ${visits.length}, ${visit.of}: ${visit.found}.${end} `
            + `Near first takes ${visitsOf(near)}, far first ${far.length}.`;
    };
});
