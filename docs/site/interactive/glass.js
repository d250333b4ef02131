// A ray into a body of glass: at each surface one part is reflected, and the rest refracted.
figures.add("glass", figure => {
    const [WIDTH, HEIGHT, SIDE] = [450, 300, 16];
    const [START, AIM, MIDDLE] = [24, 110, [260, 150]];
    // A slab ends out of sight.
    const BODIES = {
        prism: { corners: [[153, 212], [367, 212], [260, 26]], radius: 0 },
        slab: { corners: [[210, -900], [210, 1200], [310, 1200], [310, -900]], radius: 0 },
        ball: { corners: [], radius: 95 },
    };
    // The outward normal of each face, and how far it is from the middle.
    const faces = corners => corners.map(([x, y], i) => {
        const [right, down] = corners[(i + 1) % corners.length].map((end, j) => end - corners[i][j]);
        const length = Math.hypot(right, down);
        const distance = ((x - MIDDLE[0]) * down - (y - MIDDLE[1]) * right) / length;
        return [down / length, -right / length, distance].map(part => part * Math.sign(distance));
    });
    const scene = figure.drawing(`8 0 ${WIDTH} ${HEIGHT}`, "The ray, and how much of its light goes where");
    const chart = figure.drawing(`-6 0 ${WIDTH + 20} ${HEIGHT}`, "The part that is reflected, by the angle to the normal");
    const grips = Object.entries({ start: START, aim: AIM }).map(([name, x]) => {
        const grip = figure.grip(scene, (_, y) => figure.set(name, HEIGHT - y));
        grip.setAttribute("cx", x);
        return grip;
    });
    const legend = figure.add(figure.stage, "span", "legend");
    for (const [kind, text] of [["surface", "into the glass"], ["sheet", "out of the glass"], ["begin", "met by the brightest ray, in this order"]]) {
        figure.add(legend, "span", `key ${kind}`, text);
    }

    const percent = part => `${(100 * part).toFixed(part < 0.0995 && part > 0 ? 1 : 0)} %`;
    const text = ([x, y], words, anchor = "middle") => `<text class="halo" x="${x}" y="${y}" text-anchor="${anchor}">${words}</text>`;
    const path = (kind, points) => `<path class="${kind}" fill="none" d="M${points.map(([x, y]) => `${x.toFixed(2)} ${y.toFixed(2)}`).join(" L")}"/>`;
    const outline = ({ corners, radius }) => radius ? `<circle class="body" cx="${MIDDLE[0]}" cy="${MIDDLE[1]}" r="${radius}"/>`
        : `<polygon class="body" points="${corners.join(" ")}"/>`;
    // Where a ray leaves the part of the drawing that has room for words.
    function border(from, to) {
        const parts = [[32, WIDTH - 16], [24, HEIGHT - 8]].flatMap((walls, i) =>
            walls.map(wall => (wall - from[i]) / (to[i] - from[i])).filter(part => part > 0));
        const part = Math.min(...parts);
        return from.map((x, i) => x + part * (to[i] - x));
    }

    return () => {
        const heights = ["start", "aim"].map(name => HEIGHT - figure.number(name));
        const [index, body] = [parseFloat(figure.word("index")), BODIES[figure.word("body")]];
        const planes = faces(body.corners);
        const compute = chart => Array.from(new Float32Array(figures.compute("glass", SIDE, {
            start: ["2f", START, heights[0]], aim: ["2f", AIM, heights[1]], index: ["1f", index], side: ["1ui", SIDE],
            middle: ["2f", ...MIDDLE], radius: ["1f", body.radius], faces: ["3fv", planes.flat()], chart: ["1ui", chart],
        }).buffer));
        const [answers, curves] = [compute(0), compute(1)];
        const ray = n => ({
            from: n > 1 ? answers.slice(4 * (n >> 1), 4 * (n >> 1) + 2) : [START, heights[0]],
            to: answers.slice(4 * n, 4 * n + 2), light: answers[4 * n + 2], cosine: answers[4 * n + 3],
        });
        const rays = Array.from({ length: SIDE ** 2 }, (_, n) => ray(n));

        // The brightest way, and the surfaces on it.
        const surfaces = [];
        for (let n = 1; n < rays.length / 2 && rays[n].cosine <= 1; n = rays[2 * n].light > rays[2 * n + 1].light ? 2 * n : 2 * n + 1) {
            const angle = Math.acos(rays[n].cosine) * 180 / Math.PI;
            surfaces.push({ at: rays[n].to, angle, reflected: rays[2 * n].light / rays[n].light, out: surfaces.length > 0 });
        }
        const critical = Math.asin(1 / index) * 180 / Math.PI;
        figure.found = { rays, surfaces, critical, curves, start: [START, heights[0]], aim: [AIM, heights[1]], body, index, middle: MIDDLE };

        let shapes = outline(body), words = "";
        // Where no more words have room.
        const places = [[START, heights[0]], [AIM, heights[1]]];
        rays.map((ray, n) => ({ ...ray, n })).filter(({ light }) => light > 0.002).sort((a, b) => b.light - a.light)
            .forEach(({ from, to, light, cosine, n }) => {
                shapes += path("ray light", [from, to]).replace("/>", ` style="stroke-width: ${1 + 3 * light}; opacity: ${Math.max(light ** 0.3, 0.25)}"/>`);
                const end = border(from, to);
                if (cosine > 1 && n > 1 && light > 0.01 && places.every(([x, y]) => Math.hypot(x - end[0], y - end[1]) > 40)) {
                    places.push(end);
                    words += text([end[0], end[1] - 6], percent(light));
                }
            });
        const place = ({ angle, reflected }) => [50 + 4.4 * angle, 260 - 225 * reflected];
        let dots = "";
        surfaces.forEach((surface, i) => {
            for (const [[x, y], of] of [[surface.at, "scene"], [place(surface), "chart"]]) {
                const away = of === "scene" ? Math.hypot(x - MIDDLE[0], y - MIDDLE[1]) : 0;
                const number = away ? [x + 17 * (x - MIDDLE[0]) / away, y + 17 * (y - MIDDLE[1]) / away + 5] : [x - 12, y - 8];
                const dot = `<circle class="begin" cx="${x}" cy="${y}" r="5"/>${text(number, i + 1)}`;
                of === "scene" ? words += dot : dots += dot;
            }
        });
        scene.innerHTML = shapes + words;
        grips.forEach((grip, i) => grip.setAttribute("cy", heights[i]));

        const curve = out => Array.from({ length: SIDE ** 2 }, (_, i) => place({ angle: 90 * i / (SIDE ** 2 - 1), reflected: curves[4 * i + out] }));
        chart.innerHTML = [0, 30, 60, 90].map(angle => path("edge", [[50 + 4.4 * angle, 260], [50 + 4.4 * angle, 35]]) + text([50 + 4.4 * angle, 282], `${angle}°`)).join("")
            + [0, 0.5, 1].map(part => path("edge", [[50, 260 - 225 * part], [446, 260 - 225 * part]]) + text([44, 265 - 225 * part], `${100 * part} %`, "end")).join("")
            + path("surface", curve(0)) + path("sheet", curve(1)) + dots;

        figure.said.textContent = surfaces.length ? surfaces.slice(0, 4).map(({ angle, reflected, out }, i) =>
            `${i + 1}, ${out ? "out" : "in"} at ${angle.toFixed(1)}°: ${reflected === 1 ? "total reflection" : `${percent(reflected)} of what arrives is reflected`}.`).join(" ")
            + ` Within the glass, all is reflected beyond ${critical.toFixed(1)}° to the normal.` : "The ray misses the glass.";
    };
});
