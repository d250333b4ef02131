// A point in the plane of a triangle: its three weights, and what they mix.
figures.add("triangle", figure => {
    const GROUND = 300;
    // Those of docs/drawings/rays.rs. Each color has a channel of its own, so that light over light adds up.
    const CORNERS = { a: [70, 270], b: [420, 250], c: [220, 80] };
    const NAMES = Object.keys(CORNERS);
    const MEANT = { a: "1 − u − v", b: "u", c: "v" };

    const others = of => NAMES.filter(name => name !== of).map(name => CORNERS[name]);
    // Twice the area, with a sign for the way round.
    const area = (p, q, r) => (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0]);
    // The part of the triangle's area that lies opposite a corner; negative beyond that edge.
    const weight = (of, point) => area(point, ...others(of)) / area(CORNERS[of], ...others(of));
    const polygon = (kind, ...points) => `<polygon class="${kind}" points="${points.join(" ")}"/>`;

    // A corner's color at the corner, and none at the opposite edge.
    function fading(of) {
        const [p, q] = others(of);
        const edge = q.map((x, i) => x - p[i]);
        const along = edge.reduce((sum, x, i) => sum + x * (CORNERS[of][i] - p[i]), 0) / Math.hypot(...edge) ** 2;
        const foot = p.map((x, i) => x + along * edge[i]);
        const [x1, y1, x2, y2] = [...CORNERS[of], ...foot];
        return `<linearGradient id="fading-${of}" gradientUnits="userSpaceOnUse" x1="${x1}" y1="${y1}" x2="${x2}" y2="${y2}">`
            + `<stop class="corner-${of}"/><stop offset="1"/></linearGradient>`;
    }

    const letter = (of, [x, y]) => `<text x="${x}" y="${y}" text-anchor="middle">${of}</text>`;
    const letters = letter("a", [56, 284]) + letter("b", [434, 264]) + letter("c", [220, 68]);
    const [mixed, areas] = ["The mixed colour", "The weights as areas"].map(label => figure.drawing("34 44 416 252", label));
    mixed.innerHTML = NAMES.map(fading).join("") + `<g class="mixed">${polygon("", ...Object.values(CORNERS))}`
        + NAMES.map(of => `<polygon points="${Object.values(CORNERS).join(" ")}" fill="url(#fading-${of})"/>`).join("")
        + `</g>${letters}`;
    const grips = [mixed, areas].map(drawing => figure.grip(drawing, (x, y) => {
        figure.set("x", x);
        figure.set("y", GROUND - y);
    }));
    const legend = figure.add(figure.stage, "span", "legend");
    const keys = NAMES.map(of => figure.add(legend, "span", `key weight-${of}`));

    return () => {
        const point = [figure.number("x"), GROUND - figure.number("y")];
        const weights = NAMES.map(of => weight(of, point));
        const beyond = NAMES.filter((_, i) => weights[i] < 0);
        const color = weights.map(part => Math.round(255 * part));
        figure.found = { point, corners: Object.values(CORNERS), weights, color, hit: beyond.length === 0 };

        // What is negative lies over what reaches beyond the triangle.
        const within = NAMES.filter(of => !beyond.includes(of));
        areas.innerHTML = within.map(of => polygon(`weight-${of}`, point, ...others(of))).join("")
            + polygon("outline", ...Object.values(CORNERS))
            + beyond.map(of => polygon(`weight-${of} negative`, point, ...others(of))).join("") + letters;
        for (const grip of grips) {
            grip.setAttribute("cx", point[0]);
            grip.setAttribute("cy", point[1]);
            grip.style.fill = beyond.length ? "" : `rgb(${color})`;
        }
        const spelled = weights.map(part => part.toFixed(2).replace("-", "−"));
        keys.forEach((key, i) => key.textContent = `weight of ${NAMES[i]}: ${MEANT[NAMES[i]]} = ${spelled[i]}`);
        figure.said.textContent = beyond.length
            ? `The weight of ${beyond.join(" and of ")} is negative: the point lies outside. A ray through it misses the triangle.`
            : `The colour is ${spelled[0]} of a's red, ${spelled[1]} of b's green and ${spelled[2]} of c's blue. A ray through the point hits the triangle.`;
    };
});
