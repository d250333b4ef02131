// Two solids in the plane, and a ray: its intervals in each of them and in what an operation makes of them.
figures.add("solids", figure => {
    const [GROUND, RIGHT] = [216, 452];
    // A ball and a box. Their faces lie beside whole numbers, so that no slider puts a ray into a face.
    const A = { center: [290.5, 112.5], radius: 84 };
    const B = { low: [130.5, 60.5], high: [270.5, 150.5] };
    // What holds a point, of whether A and B hold it.
    const RULES = {
        union: [(a, b) => a || b, "A or B"],
        intersection: [(a, b) => a && b, "A and B"],
        difference: [(a, b) => a && !b, "A, not B"],
        inverse: [a => !a, "not A"],
    };

    // Between which t the line of a ray is in the ball, and in the box; the first end lies behind the second if nowhere.
    function inBall({ eye, d }) {
        const away = A.center.map((x, i) => x - eye[i]);
        const along = away[0] * d[0] + away[1] * d[1];
        const beside = away[0] * d[1] - away[1] * d[0];
        const half = Math.sqrt(A.radius ** 2 - beside ** 2);
        return half > 0 ? [along - half, along + half] : [Infinity, -Infinity];
    }
    function inBox({ eye, d }) {
        const at = wall => wall.map((x, i) => (x - eye[i]) / d[i]);
        const [one, other] = [at(B.low), at(B.high)];
        return [Math.max(...one.map((t, i) => Math.min(t, other[i]))), Math.min(...one.map((t, i) => Math.max(t, other[i])))];
    }

    // As solid.glsl walks: the rule is asked just before and just after each t at which an interval begins or ends.
    function crossings(parts, holds) {
        const changes = [...new Set(parts.filter(([enter, leave]) => enter < leave).flat())].sort((a, b) => a - b);
        return changes.flatMap(t => {
            const before = parts.map(([enter, leave]) => enter < t && t <= leave);
            const after = parts.map(([enter, leave]) => enter <= t && t < leave);
            const [was, is] = [holds(...before), holds(...after)];
            if (was === is) {
                return [];
            }
            // Undo the changes, one part at a time: the part that restores the old result has the face.
            const part = after[0] !== before[0] && holds(before[0], after[1]) === was ? 0 : 1;
            return [{ t, part, comes: after[part], enters: is }];
        });
    }

    // The normal of a face, turned to where the ray comes from.
    function normal(part, point, d) {
        let n = point.map((x, i) => (x - A.center[i]) / A.radius);
        if (part === 1) {
            const away = [0, 1].map(i => Math.min(Math.abs(point[i] - B.low[i]), Math.abs(point[i] - B.high[i])));
            n = away[0] < away[1] ? [1, 0] : [0, 1];
        }
        const side = n[0] * d[0] + n[1] * d[1] > 0 ? -1 : 1;
        return n.map(x => side * x);
    }

    const scene = figure.drawing("0 0 480 320", "Two solids, a ray, and its intervals in them");
    scene.ownerSVGElement.parentElement.classList.add("wide");
    const eyeGrip = figure.grip(scene, (x, y) => {
        figure.set("eye x", x);
        figure.set("eye y", GROUND - y);
    });
    const aimGrip = figure.grip(scene, (_, y) => figure.set("aim y", GROUND - y));
    aimGrip.setAttribute("cx", RIGHT);
    // Wide drawings are small on phones.
    [eyeGrip, aimGrip].forEach(grip => grip.setAttribute("r", 12));
    const legend = figure.add(figure.stage, "span", "legend");
    for (const [kind, text] of [["weight-a", "in A, the ball"], ["weight-b", "in B, the box"], ["handle", "in the solid that the operation makes"],
        ["begin", "what the ray meets first; its normal, turned to the eye"]]) {
        figure.add(legend, "span", `key ${kind}`, text);
    }

    const [width, height] = B.high.map((x, i) => x - B.low[i]);
    const ball = kind => `<circle class="${kind}" cx="${A.center[0]}" cy="${A.center[1]}" r="${A.radius}"/>`;
    const box = kind => `<rect class="${kind}" x="${B.low[0]}" y="${B.low[1]}" width="${width}" height="${height}"/>`;
    const room = `M0 0H480V${GROUND}H0Z`;
    const clip = (id, shape) => `<clipPath id="solids-${id}">${shape}</clipPath>`;
    const clips = clip("b", box("")) + clip("not-b", `<path clip-rule="evenodd" d="${room}M${B.low}h${width}v${height}h${-width}Z"/>`)
        + clip("room", `<path d="${room}"/>`);
    const cut = (shape, id) => `<g clip-path="url(#solids-${id})">${shape}</g>`;
    const [x, y, r] = [...A.center, A.radius];
    const SHAPES = {
        union: ball("shape") + box("shape"),
        intersection: cut(ball("shape"), "b"),
        difference: cut(ball("shape"), "not-b"),
        inverse: `<path class="shape" fill-rule="evenodd" d="${room}M${x - r} ${y}a${r} ${r} 0 1 0 ${2 * r} 0a${r} ${r} 0 1 0 ${-2 * r} 0Z"/>`,
    };
    const line = (kind, from, to) => `<path class="${kind}" d="M${from} L${to}"/>`;
    const text = (x, y, what, anchor = "start") => `<text x="${x}" y="${y}" text-anchor="${anchor}">${what}</text>`;

    return () => {
        const operation = figure.word("operation");
        const eye = [figure.number("eye x"), GROUND - figure.number("eye y")];
        const aim = [RIGHT, GROUND - figure.number("aim y")];
        const tmax = Math.hypot(aim[0] - eye[0], aim[1] - eye[1]);
        const ray = { eye, d: aim.map((x, i) => (x - eye[i]) / tmax) };
        const [holds, named] = RULES[operation];
        const parts = [inBall(ray), inBox(ray)];
        const all = crossings(parts, holds);
        // Infinitely far back the ray is in no part.
        const ends = [...holds(false, false) ? [-Infinity] : [], ...all.map(({ t }) => t), Infinity];
        const solid = Array.from({ length: ends.length >> 1 }, (_, i) => ends.slice(2 * i, 2 * i + 2));
        const first = all.find(({ t }) => t > 0 && t < tmax);
        const begins = solid.some(([enter, leave]) => enter < 0 && leave > 0);
        figure.found = { operation, ray, parts, solid, first, begins };

        const point = t => ray.eye.map((x, i) => x + t * ray.d[i]);
        let shapes = clips + SHAPES[operation] + ball("outline") + box("outline") + text(352, 150, "A", "end") + text(140, 80, "B");
        const rows = [["A", "weight-a", parts.slice(0, 1)], ["B", "weight-b", parts.slice(1)], [named, "shape", solid]];
        rows.forEach(([name, kind, intervals], row) => {
            const y = GROUND + 14 + 30 * row;
            shapes += text(4, y + 15, name) + line("edge", [eye[0], y + 10], [RIGHT, y + 10]);
            for (const [enter, leave] of intervals.map(([enter, leave]) => [Math.max(enter, 0), Math.min(leave, tmax)])) {
                if (enter < leave) {
                    const [from, to] = [point(enter)[0], point(leave)[0]];
                    shapes += `<rect class="${kind}" x="${from}" y="${y}" width="${to - from}" height="20"/>`;
                }
            }
        });
        shapes += line("ray", eye, point(first?.t ?? tmax)) + line("ray rest", point(first?.t ?? tmax), aim);
        let said = begins ? `The ray stays in the ${operation}: it meets no face.` : `The ray misses the ${operation}.`;
        if (first) {
            const at = point(first.t);
            const n = normal(first.part, at, ray.d);
            const tip = at.map((x, i) => x + 34 * n[i]);
            const barb = side => tip.map((x, i) => x - 11 * n[i] + side * 6 * [-n[1], n[0]][i]);
            shapes += line("sheet", at, [at[0], GROUND + 100]) + line("hit", at, tip)
                + `<polygon class="begin" points="${[tip.map((x, i) => x + 4 * n[i]), barb(1), barb(-1)].join(" ")}"/>`
                + `<circle class="begin" cx="${at[0]}" cy="${at[1]}" r="5.5"/>`;
            const face = "AB"[first.part];
            const verb = does => does ? "enters" : "leaves";
            const made = first.comes === first.enters ? `the ${operation}` : `${verb(first.enters)} the ${operation}`;
            said = `The ray begins ${begins ? "in" : "outside"} the ${operation}. First it meets a face of ${face}, from ${face}’s `
                + `${first.comes ? "outside" : "inside"}: it ${verb(first.comes)} ${face} and ${made}.`;
        }
        scene.innerHTML = shapes;
        eyeGrip.setAttribute("cx", eye[0]);
        eyeGrip.setAttribute("cy", eye[1]);
        aimGrip.setAttribute("cy", aim[1]);
        figure.said.textContent = said;
    };
});
