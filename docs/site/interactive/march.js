// A section through the land of chapter 21: where each march asks for the height, and where it stops.
figures.add("march", figure => {
    const [LENGTH, SIDE] = [480, 20];
    const RUNGS = ["relaxed", "lipschitz", "over-relaxed", "bisected"];
    // With these the steepest slope is k: 8·k·(a·fx + b·gx), in floats without an error.
    const LAND = { a: 8, fx: 1 / 256, fz: 0, b: 3, gx: 1 / 32, gz: 0 };
    const phase = u => u - Math.floor(u + 0.5);
    const wave = u => 8 * phase(u) * (1 - 2 * Math.abs(phase(u)));
    const ground = (k, x) => k * (LAND.a * wave(LAND.fx * x) + LAND.b * wave(LAND.gx * x));

    // The true hit in 64 bits: steps that are safe, but for a thousandth, and then halves.
    function exact(k, { o, d, tmax }) {
        const above = t => o[1] + t * d[1] - ground(k, o[0] + t * d[0]);
        const fall = k * d[0] + Math.abs(d[1]);
        for (let t = 0; t < tmax;) {
            const next = t + Math.max(above(t) / fall, 1e-3);
            if (above(next) <= 0) {
                let [low, high] = [t, next];
                for (let i = 0; i < 60; i++) {
                    const middle = (low + high) / 2;
                    [low, high] = above(middle) > 0 ? [middle, high] : [low, middle];
                }
                return high < tmax ? high : Infinity;
            }
            t = next;
        }
        return Infinity;
    }

    function march(k, { o, d, tmax }, rung, truth) {
        const uniforms = { o: ["3f", ...o], d: ["3f", ...d], tmax: ["1f", tmax], rung: ["1ui", rung], side: ["1ui", SIDE] };
        for (const [name, number] of Object.entries({ ...LAND, k, lipschitz: k })) {
            uniforms[`land.${name}`] = ["1f", number];
        }
        const answers = figures.compute("march", SIDE, uniforms);
        const floats = new Float32Array(answers.buffer);
        const [asked, t] = [answers[2], floats[3]];
        const places = Array.from({ length: Math.min(asked, SIDE ** 2) }, (_, i) => [...floats.subarray(4 * i, 4 * i + 2)]);
        // Who stands in the air behind the true hit has been through the ground.
        const through = places.some(([t, above]) => t > truth && above > 0.001);
        const off = t ? t - truth : 0;
        const word = !t ? (truth < Infinity ? "lost" : "rightly nothing")
            : truth === Infinity ? "false hit"
                : Math.abs(off) < 0.001 ? "right"
                    : `${Math.abs(off) < 1 ? "nearly right, " : ""}${figure.spell(Math.abs(off))} too ${off < 0 ? "near" : "far"}`;
        return { asked, places, t, off, through, word };
    }

    const scene = figure.drawing("-14 -144 508 244", "A section through the land, 480 long");
    scene.ownerSVGElement.parentElement.classList.add("wide");
    const ends = { eye: 0, aim: LENGTH };
    for (const [name, x] of Object.entries(ends)) {
        ends[name] = figure.grip(scene, (_, y) => figure.set(name, -y));
        ends[name].setAttribute("cx", x);
        // A wide drawing is small on a phone.
        ends[name].setAttribute("r", 12);
    }
    const legend = figure.add(figure.stage, "span", "legend");
    // Kinds are those of the site's colors: hollow dots, which are no grips, an orange one, a blue ring.
    for (const [kind, text] of [["passed", "the height is asked for here"], ["begin", "the hit of the march"], ["rounded", "the true hit"]]) {
        figure.add(legend, "span", `key ${kind}`, text);
    }
    const region = figure.add(figure.stage, "span", "region");
    figure.add(region, "span", "label", "Heights asked for, and the hit: right within 0.001, nearly right within 1 of the 480");
    const records = figure.add(region, "span", "records");

    const circle = (kind, [x, y], r) => `<circle class="${kind}" cx="${x}" cy="${y}" r="${r}"/>`;
    const path = (kind, points) => `<path class="${kind}" d="M${points.join(" L")}"/>`;

    return () => {
        const [k, eye, aim] = ["steepest slope", "eye", "aim"].map(name => figure.number(name));
        const length = Math.hypot(LENGTH, aim - eye);
        // It ends a little behind its aim, which may lie on the ground.
        const ray = { o: [0, eye, 0], d: [LENGTH / length, (aim - eye) / length, 0].map(Math.fround), tmax: 1.01 * length };
        const { tmax } = ray;
        const truth = exact(k, ray);
        const marches = RUNGS.map((_, rung) => march(k, ray, rung, truth));
        const rung = RUNGS.indexOf(figure.word("rung"));
        const { asked, places, t, off, through, word } = marches[rung];
        figure.found = { k, ray, truth, marches };

        const point = t => [ray.d[0] * t, -eye - ray.d[1] * t];
        const land = Array.from({ length: LENGTH / 2 + 21 }, (_, i) => 2 * i - 20).map(x => [x, -ground(k, x)]);
        const inside = places.filter(([t]) => t >= 0 && t <= tmax);
        const combs = inside.map(([t, above]) => `M${point(t)} v${above}`).join(" ");
        const until = t || tmax;
        scene.innerHTML = path("shape", [[-20, 110], ...land, [LENGTH + 20, 110]])
            + `<path class="edge" d="${combs}"/>` + path("ray", [point(0), point(until)]) + path("ray rest", [point(until), point(tmax)])
            + inside.map(([t]) => circle("passed", point(t), 3)).join("")
            + (t ? circle("begin", point(t), 5.5) : "") + (truth < Infinity ? circle("rounded", point(truth), 9) : "");
        Object.values(ends).forEach((grip, i) => grip.setAttribute("cy", -[eye, aim][i]));

        records.replaceChildren();
        marches.forEach(({ asked, word }, i) => {
            const record = figure.add(records, "span", "record", `${RUNGS[i]}: ${asked}, ${word}`);
            record.classList.toggle("read", i === rung);
        });
        const gaveUp = t && rung < 2 && asked === 300;
        const behind = `${figure.spell(Math.abs(off))} ${off < 0 ? "before" : "behind"} the true hit`;
        figure.said.textContent = `The ${RUNGS[rung]} march asks for ${asked} heights. ` + (gaveUp ? "It gives up, and calls the last place a hit. " : "")
            + (through ? t ? `It went through the ground: its hit lies ${behind}.` : "It went through the ground and never came back."
                : word === "right" ? "It ends at the true hit."
                    : !t ? "It hits nothing" + (truth < Infinity ? ": the ground is lost." : ", which is right.")
                        : truth === Infinity ? "Its hit is false: the ray meets no ground."
                            : `Its hit lies ${behind}.`);
    };
});
