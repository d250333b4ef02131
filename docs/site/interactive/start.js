// Where a shadow ray starts, zoomed in until single floats show: below the surface, or beyond what stands close by.
figures.add("start", figure => {
    const [WIDTH, HEIGHT, RAYS] = [480, 300, 400];
    const U = 2 ** -24;
    const svg = document.createElementNS("http://www.w3.org/2000/svg", "svg");
    svg.setAttribute("viewBox", `0 0 ${WIDTH} ${HEIGHT}`);
    svg.setAttribute("aria-hidden", "true");
    figure.stage.append(svg);
    const legend = figure.add(figure.stage, "span", "legend");
    const keys = {};
    for (const [kind, text] of [["surface", "the surface"], ["sheet", "the sheet, which must stop the ray"], ["bound", "the bound"],
        ["exact", "the exact hit"], ["rounded", "the point, rounded"], ["begin", "the start"]]) {
        keys[kind] = figure.add(legend, "span", `key ${kind}`, text);
    }

    // The surface goes from corner A to corner B, which are floats.
    const f = Math.fround;
    const [A, B] = [[0, f(0.1)], [2, f(0.7)]];
    const edge = B.map((b, i) => b - A[i]);
    const length = Math.hypot(...edge);
    const normal = [-edge[1] / length, edge[0] / length];
    const up = normal.map(f);
    // How far above the surface a point lies, in 64 bits.
    const above = p => normal[0] * (p[0] - A[0]) + normal[1] * (p[1] - A[1]);
    const dot = (a, b) => f(f(a[0] * b[0]) + f(a[1] * b[1]));
    const ulp = x => 2 ** (Math.floor(Math.log2(Math.abs(x))) - 23);

    // The hit of a ray from so far away that aims at a part of the edge, by operations that round to 32 bits.
    function hit(part, distance, corners) {
        const aimed = A.map((a, i) => a + part * edge[i]);
        const ahead = [Math.cos(0.8 + 0.4 * part), -Math.sin(0.8 + 0.4 * part)];
        const eye = aimed.map((x, i) => f(x - distance * ahead[i]));
        const d = ahead.map(f);
        const exact = -above(eye) / (normal[0] * d[0] + normal[1] * d[1]);
        const hit = eye.map((x, i) => x + exact * d[i]);
        const weight = f((hit[0] - A[0]) / edge[0]);
        const t = f(dot(up, A.map((a, i) => f(a - eye[i]))) / dot(up, d));
        const point = corners
            ? A.map((a, i) => f(a + f(weight * f(edge[i]))))
            : eye.map((x, i) => f(x + f(t * d[i])));
        return { hit, point };
    }
    const raised = (point, step) => point.map((x, i) => f(x + f(f(step) * up[i])));

    return () => {
        const corners = figure.word("point") === "by corners";
        const [distance, step, gap] = ["distance of the eye", "step", "height of the sheet"].map(name => figure.number(name));
        // What rounding costs the point by corners (chapter 41, derivation, step 1) and the start.
        const bound = U * normal.reduce((sum, n, i) => sum + Math.abs(n) * (2 * Math.max(A[i], B[i]) + 3 * edge[i]), 0);
        let acne = 0, leaks = 0;
        for (let i = 0; i < RAYS; i++) {
            const height = above(raised(hit((i + 0.5) / RAYS, distance, corners).point, step));
            acne += height < 0;
            leaks += height > gap;
        }
        const { hit: exact, point } = hit(0.7, distance, corners);
        const start = raised(point, step);
        const height = above(start);
        figure.found = { point, start, height, bound, acne: acne / RAYS, leaks: leaks / RAYS };

        // As much around the exact hit as shows all three points. It is a power of four, so that a step moves the
        // start and only now and then the picture.
        const far = Math.max(...[point, start].flatMap(p => p.map((x, i) => Math.abs(x - exact[i]))));
        const half = 4 ** Math.ceil(Math.log2(Math.max(6 * ulp(exact[1]), 1.2 * far)) / 2);
        const scale = HEIGHT / 2 / half;
        const at = p => [WIDTH / 2 + scale * (p[0] - exact[0]), HEIGHT / 2 - scale * (p[1] - exact[1])];
        const wide = half * WIDTH / HEIGHT;
        let shapes = "";
        const gaps = exact.map(ulp);
        const finest = 2 * half / gaps[1] <= 80;
        if (finest) {
            for (let x = Math.ceil((exact[0] - wide) / gaps[0]) * gaps[0]; x < exact[0] + wide; x += gaps[0]) {
                for (let y = Math.ceil((exact[1] - half) / gaps[1]) * gaps[1]; y < exact[1] + half; y += gaps[1]) {
                    const [left, top] = at([x, y]);
                    shapes += `<circle class="grid" cx="${left}" cy="${top}" r="1.5"/>`;
                }
            }
        }
        for (const [kind, lift] of [["surface", 0], ["sheet", gap], ["bound", corners ? bound : NaN]]) {
            const ends = [-2, 2].map(s => at(exact.map((x, i) => x + s * wide * edge[i] / length + lift * normal[i])));
            // A line that is not in the picture has no word in the legend.
            const inside = lift < 1.2 * half;
            keys[kind].hidden = !inside;
            if (inside) {
                shapes += `<path class="${kind}" d="M${ends[0]} L${ends[1]}"/>`;
            }
        }
        // A scale, as long as a power of ten.
        const unit = 10 ** Math.floor(Math.log10(2 * half)), end = 20 + scale * unit;
        shapes += `<path class="ray fine" d="M20 ${HEIGHT - 22} v8 H${end} v-8"/>`
            + `<text class="halo" x="${end + 10}" y="${HEIGHT - 14}">${figure.spell(unit).replace("1 × ", "")}</text>`;
        for (const [kind, p, r] of [["exact", exact, 4], ["rounded", point, 6], ["begin", start, 6]]) {
            const [x, y] = at(p);
            shapes += `<circle class="${kind}" cx="${x}" cy="${y}" r="${r}"/>`;
        }
        svg.innerHTML = shapes;

        const said = height < 0 ? "below the surface, and meets the surface that it leaves: acne"
            : height > gap ? "above the surface, beyond the sheet that should stop it: a leak"
                : "above the surface, and below the sheet: right";
        const percent = part => `${(100 * part).toFixed(0)}\u00a0%`;
        const verdict = acne && leaks ? "too short for some, too long for others" : acne ? "too short" : leaks ? "too long" : "right for all";
        figure.said.textContent = `This ray starts ${figure.spell(Math.abs(height))} ${said}. `
            + `Of ${RAYS} rays ${percent(acne / RAYS)} have acne and ${percent(leaks / RAYS)} leak: the step is ${verdict}. `
            + `${finest ? "Dots are floats." : "Floats lie too close to show."} `
            + (keys.sheet.hidden ? "The sheet lies above the picture. " : "")
            + (corners ? `The bound is ${figure.spell(bound)}${keys.bound.hidden ? ", above the picture" : ""}.` : "");
    };
});
