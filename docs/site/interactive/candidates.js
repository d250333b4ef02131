// A ray through panes with holes: the order in which the device comes upon them, and what the any-hit shader says.
figures.add("candidates", figure => {
    const [LEFT, RIGHT, TOP, CELL, CELLS] = [20, 436, 56, 28, 5];
    const GROUND = TOP + CELL * CELLS;
    // Where each pane stands, and its cells from the ground up: 1 is wood, whose alpha is 1, and 0 a hole.
    const PANES = { A: [92, "10100"], B: [184, "11010"], C: [276, "01100"], D: [376, "10110"] };
    const NAMES = Object.keys(PANES);
    const TIMES = ["1st", "2nd", "3rd", "4th"];
    const ACCEPTED = { "return": "accepted", terminateRayEXT: "terminates" };

    const orders = names => names.length < 2 ? [names]
        : names.flatMap(first => orders(names.filter(name => name !== first)).map(rest => [first, ...rest]));
    const ALL = orders(NAMES);
    const alpha = (name, height) => Number(PANES[name][1][Math.min(Math.floor(height / CELL), CELLS - 1)]);

    // What the device does, pane by pane; tmax is as far as the ray still goes.
    function search(order, height, answer) {
        const steps = [];
        let [tmax, hit, calls, over] = [Infinity, null, 0, false];
        for (const name of order) {
            const t = PANES[name][0] - LEFT;
            const says = over ? "not met" : t > tmax ? "no call" : alpha(name, height) < 0.5 ? "ignored" : ACCEPTED[answer];
            calls += !over && t <= tmax;
            if (says === ACCEPTED[answer]) {
                [tmax, hit, over] = [t, name, answer === "terminateRayEXT"];
            }
            steps.push({ name, says, tmax, hit, calls });
        }
        return steps;
    }

    const scene = figure.drawing("0 16 450 242", "A ray through panes with holes");
    const chart = figure.drawing("0 16 450 242", "What all 24 orders give, and this one in orange");
    const grip = figure.grip(scene, (_, y) => figure.set("ray", GROUND - y));
    grip.setAttribute("cx", LEFT);
    const region = figure.add(figure.stage, "span", "region");
    figure.add(region, "span", "label", "The order in which the device meets the panes");
    const records = figure.add(region, "span", "records");

    const text = (x, y, words, anchor = "middle") => `<text x="${x}" y="${y}" text-anchor="${anchor}">${words}</text>`;
    const cell = (kind, x, bottom) => `<polygon class="${kind}" points="${[[-8, -CELL - 8], [8, 8 - CELL], [8, 8], [-8, -8]]
        .map(([right, down]) => [x + right, bottom + down]).join(" ")}"/>`;
    const line = (kind, from, to, y) => `<path class="${kind}" d="M${from} ${y} H${to}"/>`;

    return () => {
        const [height, answer] = [figure.number("ray"), figure.word("on wood")];
        const order = ALL[figure.number("order") - 1];
        const steps = search(order, height, answer);
        const now = figure.number("step") - 1;
        const { says, name, tmax, hit, calls } = steps[now];
        const ends = ALL.map(order => search(order, height, answer).at(-1));
        const tally = of => ends.reduce((sum, end) => ({ ...sum, [end[of]]: (sum[end[of]] ?? 0) + 1 }), {});
        const [hits, counts] = [tally("hit"), tally("calls")];
        figure.found = { order, steps, hits, counts, panes: PANES, eye: LEFT, ground: GROUND };

        const y = GROUND - height;
        const until = Math.min(LEFT + tmax, RIGHT);
        let shapes = line("ray", LEFT, until, y) + line("ray rest", until, RIGHT, y);
        for (const [of, [x, cells]] of Object.entries(PANES)) {
            const at = order.indexOf(of);
            const { says, calls } = steps[at];
            shapes += [...cells].map((wood, i) => cell(wood === "1" ? "shape" : "hole", x, GROUND - i * CELL)).join("");
            // What was the nearest until a nearer pane came.
            const lost = says === "accepted" && of !== hit ? "replaced" : says;
            const call = ["no call", "not met"].includes(says) ? says : `${TIMES[calls - 1]} call`;
            if (at <= now) {
                shapes += text(x, GROUND + 28, call) + (call === says ? "" : text(x, GROUND + 48, lost));
                shapes += call === says ? "" : `<circle class="${of === hit ? "begin" : says === "ignored" ? "passed hole" : "passed"}" cx="${x}" cy="${y}" r="5"/>`;
            }
            shapes += text(x, TOP - 16, of);
        }
        scene.innerHTML = shapes + (hit ? text(until + 14, y - 7, "tmax", "start") : "");
        grip.setAttribute("cy", y);

        const end = steps.at(-1);
        const wide = count => 260 * count / ALL.length;
        const bars = (tally, present, words) => Object.entries(tally).map(([key, count]) => [words(key), count, key === String(present)]);
        const rows = [
            ...bars(hits, end.hit, key => key === "null" ? "no hit" : `hit ${key}`), [],
            ...bars(counts, end.calls, key => key === "1" ? "1 call" : `${key} calls`),
        ];
        chart.innerHTML = rows.map(([words, count, present], i) => words ? text(80, 50 + 29 * i, words, "end")
            + `<rect class="state visited-${present ? "now" : "before"}" x="90" y="${36 + 29 * i}" width="${wide(count)}" height="19"/>`
            + text(98 + wide(count), 50 + 29 * i, `${count} of 24`, "start") : "").join("");

        records.replaceChildren();
        order.forEach((name, i) => figure.add(records, "span", `record state ${["visited-before", "visited-before read", ""][Math.sign(i - now) + 1]}`, name));
        const told = {
            "no call": "it lies beyond tmax: the any-hit shader is not called",
            "not met": "the search has ended before",
            ignored: "alpha is 0: the any-hit shader ignores the candidate",
            accepted: `alpha is 1: the any-hit shader returns, and the ray's tmax falls to ${name}`,
            terminates: "alpha is 1: the any-hit shader ends the search, although a nearer pane may be left",
        }[says];
        figure.said.textContent = `${TIMES[now]}, ${name}: ${told}. In the end: ${end.hit ? `hit ${end.hit}` : "no hit"}, `
            + `${end.calls} ${end.calls === 1 ? "call" : "calls"}. The closest hit `
            + (Object.keys(hits).length > 1 ? "depends on the order." : "is the same in all 24 orders.");
    };
});
