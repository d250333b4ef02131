// Moving triangles in two trees of boxes: one was built at frame 0 and is updated since, one is built anew.
figures.add("refit", figure => {
    const [WIDTH, HEIGHT, FRAMES] = [300, 240, 120];
    // Four triangles stand around the middle, and before each of them one that is nearer to it.
    const place = (i, turn) => {
        const angle = Math.PI * ((i >> 1) / 2 + 0.25 + turn);
        const [wide, high] = i % 2 ? [52, 40] : [112, 88];
        return [WIDTH / 2 + wide * Math.cos(angle), HEIGHT / 2 + high * Math.sin(angle)];
    };
    const HOME = Array.from({ length: 8 }, (_, i) => place(i, 0));
    // Where a triangle is after a part of the frames: the outer ones turn left and the inner ones right, or all rise
    // and fall with their neighbours.
    const WAYS = {
        "apart": (i, part) => place(i, part * (i % 2 ? 0.5 : -0.5)),
        "a wave": (i, part) => [HOME[i][0], HOME[i][1] + 22 * Math.sin(2 * Math.PI * (2 * part - HOME[i][0] / WIDTH))],
    };
    // Each level grows by a little, so that walls are seen apart.
    const GAP = 5;

    const corners = ([x, y], i) => [[-13, 10], [12, 13 - 6 * (i % 3)], [-4 + 4 * (i % 3), -13]].map(([dx, dy]) => [x + dx, y + dy]);
    const bounds = points => [Math.min, Math.max].map((pick, end) => [0, 1].map(axis => pick(...points.map(p => p[axis])) + GAP * (2 * end - 1)));

    // Halves of the list along its longer side, down to pairs.
    function build(list, places) {
        if (list.length === 2) {
            return list;
        }
        const [low, high] = bounds(list.map(i => places[i]));
        const axis = high[0] - low[0] > high[1] - low[1] ? 0 : 1;
        const sorted = [...list].sort((i, j) => places[i][axis] - places[j][axis]);
        return [sorted.slice(0, list.length / 2), sorted.slice(list.length / 2)].map(half => build(half, places));
    }

    // The boxes of a tree around triangles, a box before those within.
    function fit(tree, triangles) {
        if (typeof tree[0] === "number") {
            return [bounds(tree.flatMap(i => triangles[i]))];
        }
        const [one, other] = tree.map(half => fit(half, triangles));
        return [bounds([...one[0], ...other[0]]), ...one, ...other];
    }

    // How many boxes a ray meets that meets the root. In space the areas count, in the plane the circumferences.
    function cost(boxes) {
        const around = ([low, high]) => high[0] - low[0] + high[1] - low[1];
        return boxes.reduce((sum, box) => sum + around(box), 0) / around(boxes[0]);
    }

    const everything = HOME.map((_, i) => i);
    const COLORS = ["weight-a", "weight-b", "weight-c", "shape"];
    function moved(way, frame) {
        const [first, places] = [0, frame].map(frame => everything.map(i => WAYS[way](i, frame / FRAMES)));
        const triangles = places.map(corners);
        const trees = [first, places].map(places => build(everything, places));
        const boxes = trees.map(tree => fit(tree, triangles));
        // A color tells with which other triangle one shared a box at frame 0.
        const colors = everything.map(i => COLORS[trees[0].flat().findIndex(pair => pair.includes(i))]);
        return { triangles, colors, boxes, costs: boxes.map(cost) };
    }

    const panels = ["Built at frame 0, updated since", "Built anew"].map(label => figure.drawing(`0 0 ${WIDTH} ${HEIGHT}`, label));
    const grips = panels.map(panel => {
        const grip = figure.grip(panel, (_, y) => figure.set("ray", HEIGHT - y));
        grip.setAttribute("cx", 12);
        return grip;
    });
    const chart = figure.drawing("0 0 480 150", "How many boxes a ray meets on average, by frame: updated (solid), built anew (dashed)");
    chart.ownerSVGElement.parentElement.classList.add("wide");
    const legend = figure.add(figure.stage, "span", "legend");
    for (const [kind, text] of [["met", "a box that the ray meets"], ["bounds", "another box"], ["weight-a", "one colour: in one box at frame 0"]]) {
        figure.add(legend, "span", `key ${kind}`, text);
    }

    const rect = (kind, [[left, top], [right, bottom]]) =>
        `<rect class="${kind}" x="${left}" y="${top}" width="${right - left}" height="${bottom - top}"/>`;
    const text = (x, y, what, anchor = "start") => `<text x="${x}" y="${y}" text-anchor="${anchor}">${what}</text>`;
    const at = (frame, boxes) => [30 + 440 * frame / FRAMES, 130 - 17 * boxes];

    return () => {
        const [way, frame, y] = [figure.word("motion"), figure.number("frame"), HEIGHT - figure.number("ray")];
        const { triangles, colors, boxes, costs } = moved(way, frame);
        const hit = ([low, high]) => low[1] <= y && y <= high[1];
        const met = boxes.map(all => all.filter(hit).length);
        figure.found = { triangles, boxes, costs, met, y };

        panels.forEach((panel, number) => {
            panel.innerHTML = boxes[number].map(box => rect(hit(box) ? "bounds met" : "bounds", box)).join("")
                + triangles.map((points, i) => `<polygon class="${colors[i]}" points="${points.join(" ")}"/>`).join("")
                + `<path class="ray" d="M12 ${y} H${WIDTH}"/>`;
            grips[number].setAttribute("cy", y);
        });
        const all = Array.from({ length: FRAMES + 1 }, (_, frame) => moved(way, frame).costs);
        const line = number => `<path class="outline${number ? " sheet" : ""}" d="M${all.map((costs, frame) => at(frame, costs[number])).join(" L")}"/>`;
        const dot = cost => `<circle class="begin" cx="${at(frame, 0)[0]}" cy="${at(frame, cost)[1]}" r="5"/>`;
        const axes = [0, 7].map(boxes => `<path class="edge" d="M${at(0, boxes)} L${at(FRAMES, boxes)}"/>` + text(22, at(0, boxes)[1] + 5, boxes, "end"));
        chart.innerHTML = axes.join("") + `<path class="edge" d="M${at(frame, 0)} L${at(frame, 7)}"/>` + line(0) + line(1) + costs.map(dot).join("");
        const [updated, anew] = costs.map(cost => cost.toFixed(2));
        figure.said.textContent = `The ray meets ${met[0]} of 7 boxes in the updated tree, ${met[1]} in the new one. `
            + `On average a ray meets ${updated} and ${anew}: ${(costs[0] / costs[1]).toFixed(2)} times as many.`;
    };
});
