// Every rung of two solids, and single operations, on the reader's own device. The exact answers are stored:
// tests/site/this_gpu.rs has computed them for these very rays.
const [WITH, WITHOUT] = ["device", "device without keep"];
figures.shaders[WITHOUT] = figures.shaders[WITH].replaceAll("uintBitsToFloat(floatBitsToUint(a) ^ kept)", "a");

figures.add("device", figure => {
    const SIDE = 8, MANY = SIDE * SIDE;
    const RUNGS = { sphere: ["textbook", "stable", "two-float"], box: ["reciprocal", "division", "two-float"] };
    const LOW = [-0.7, -1.1, -0.3].map(Math.fround), HIGH = [0.9, 0.4, 1.3].map(Math.fround);

    // Only operations that are exact or rounded to the nearest: so the rays have the same bits everywhere.
    let state = 1;
    function random(low = -1, high = 1) {
        state = (Math.imul(state, 1664525) + 1013904223) >>> 0;
        return low + (high - low) * state / 2 ** 32;
    }
    const vector = make => [0, 1, 2].map(make);
    const small = (from, to) => 1 / (1 << random(from, to));

    // Towards the solid, or just beside it. Every t lies between a half and 1, where a ULP is 2⁻²⁴.
    function towards(solid, o) {
        const aim = vector(i => solid === "sphere" ? random(-0.8, 0.8) : LOW[i] + (HIGH[i] - LOW[i]) * random(-0.1, 1.1));
        return [o, aim.map((x, i) => 1.2 * (x - o[i]))];
    }
    const far = (solid, distance) => () => {
        const way = vector(() => random()), most = Math.max(...way.map(Math.abs));
        return towards(solid, way.map(x => Math.fround(x / most * distance)));
    };

    // At right angles to a radius, just outside or inside of its end.
    function grazing() {
        const p = random(), q = random(), n = 1 + p * p + q * q;
        const u = [2 * p / n, 2 * q / n, (2 - n) / n], v = vector(() => random());
        const along = vector(i => u[(i + 1) % 3] * v[(i + 2) % 3] - u[(i + 2) % 3] * v[(i + 1) % 3]);
        const reach = 1 + Math.sign(random()) * small(7, 23);
        return [u.map((x, i) => x * reach - 9 * along[i]), along.map(x => 12 * x)];
    }

    // Out through one wall where it comes in through another, or just beside.
    function atEdge(_, index) {
        const up = vector(() => random() < 0), [along, out, into] = vector(i => (index + i) % 3);
        const point = vector(i => i === along ? random(-0.2, 0.3) : (up[i] ? HIGH : LOW)[i]);
        const d = vector(i => random(0.2, 1) * (up[i] === (i === into) ? -1 : 1));
        point[out] += random() * small(8, 25);
        return [point.map((x, i) => x - 9 * d[i]), d.map(x => 12 * x)];
    }

    // In the plane of a wall, just outside, or inside.
    function inWall(_, index) {
        const axis = index % 3;
        const [o, d] = towards("box", vector(i => i === (axis + 1) % 3 ? 10 : 10 * random()));
        o[axis] = (index % 2 ? LOW : HIGH)[axis] * [1, 1, 1 + 2 ** -22, 0.5][index >> 4];
        d[axis] = 0;
        return [o, d];
    }

    const KINDS = {
        sphere: { "from 10": far("sphere", 10), "from 10³": far("sphere", 1e3), "from 10⁶": far("sphere", 1e6), grazing },
        box: { "from 10": far("box", 10), "from 10⁶": far("box", 1e6), "at an edge": atEdge, "in a wall": inWall },
    };
    const bits = pairs => new Uint32Array(Float32Array.from(pairs.flatMap(([o, d]) => [...o, 0, ...d, 0])).buffer);
    const batch = make => bits(Array.from({ length: MANY }, make));
    const rays = Object.fromEntries(Object.entries(KINDS).map(([solid, kinds]) => [solid, Object.values(kinds).map(batch)]));

    // The exact t in steps of 2⁻³²; 0 is a miss.
    const stored = Uint8Array.from(atob(figures.stored.device), letter => letter.charCodeAt(0));
    const truths = [...new Uint32Array(stored.buffer)].map(t => t / 2 ** 32);

    const run = (keep, subject, rung, given) => figures.compute(keep === "with" ? WITH : WITHOUT, SIDE, {
        given: ["4uiv", given], low: ["3f", ...LOW], high: ["3f", ...HIGH], subject: ["1ui", subject], rung: ["1ui", rung],
    });

    function asked(solid, rung, keep) {
        const subject = Object.keys(RUNGS).indexOf(solid);
        const result = { answers: [], points: [], falseHits: 0, falseMisses: 0 };
        rays[solid].forEach((given, kind) => {
            const answers = run(keep, subject, rung, given), floats = new Float32Array(answers.buffer);
            result.answers.push(...answers);
            for (let i = 0; i < MANY; i++) {
                const [hit, t] = [answers[4 * i], floats[4 * i + 1]];
                const truth = truths[(subject * 4 + kind) * MANY + i];
                const error = Math.abs(t - truth) * 2 ** 24;
                // What is not a number is infinitely wrong.
                const found = hit && truth ? { error: error >= 0 ? error : Infinity } : {};
                result.falseHits += found.falseHit = hit && !truth;
                result.falseMisses += found.falseMiss = !hit && truth > 0;
                result.points.push({ place: kind + (i + 1) / (MANY + 1), ...found });
            }
        });
        const errors = result.points.map(({ error }) => error).filter(error => error >= 0).sort((a, b) => a - b);
        const at = part => errors[Math.floor(part * (errors.length - 1))];
        return Object.assign(result, { median: at(0.5), most: at(0.99), worst: at(1) });
    }

    // Operands of which 64 bits hold sum and product exactly, and some that make numbers below 2⁻¹²⁶.
    const some = () => Math.fround(random(1, 2) * (1 << random(0, 9)));
    const operands = Array.from({ length: MANY }, () => [some(), some() * Math.sign(random())])
        .map(([a, b]) => [a, b, -Math.fround(a * b)]);
    const tiny = operands.map((_, i) => i ? [2 ** -130, 2 ** 10, 0] : [2 ** -65, 2 ** -65, 0]);
    const ulp = x => 2 ** (Math.floor(Math.log2(Math.abs(x))) - 23);

    const spell = error => error < 10 ? error.toFixed(2) : error < 1e6 ? Math.round(error).toLocaleString("en")
        : error ? `${figure.spell(error / 1e6)} million` : "–";

    // What an operation gives for each set of operands, in the words of the table.
    const good = (kept, word) => `${kept.filter(Boolean).length} of ${MANY} ${word}`;
    const rounded = off => values => {
        const errors = values.map(([r], i) => {
            const error = off(r, ...operands[i]);
            return Math.abs(error) / ulp(r - error);
        });
        return `${good(errors.map(error => error < 0.500001), "nearest")}, worst ${spell(Math.max(...errors))}`;
    };
    const twice = values => {
        // c is the rounded product with the other sign.
        const left = operands.map(([a, b, c]) => a * b + c);
        const counts = values.map(([r], i) => r === 0 ? "twice" : r === left[i] ? "once" : "otherwise");
        return `rounded ${[...new Set(counts)].join(" or ")}`;
    };
    const exact = by => values => good(values.map(([x, y], i) => x + y === by(...operands[i])), "exact");
    const kept = (index, text) => values => values[index][0] ? text : "0";
    // Its name, the draw and the first of its numbers there, what it is held to, and what Vulkan promises.
    const OPERATIONS = [
        ["a + b", 0, 0, rounded((r, a, b) => r - (a + b)), "either neighbour"],
        ["a * b", 0, 1, rounded((r, a, b) => r - a * b), "either neighbour"],
        ["a / b", 0, 2, rounded((r, a, b) => (r * b - a) / b), "2.5 ULP"],
        ["1.0 / a", 0, 3, rounded((r, a) => (r * a - 1) / a), "2.5 ULP"],
        ["sqrt(a)", 1, 0, rounded((r, a) => (r * r - a) / (2 * r)), "as 1 / inversesqrt"],
        ["inversesqrt(a)", 1, 1, rounded((r, a) => (r * r * a - 1) / (2 * r * a)), "2 ULP"],
        ["a * b + c", 1, 2, twice, "once or twice"],
        ["the same, a * b precise", 1, 3, twice, "twice"],
        ["two_sum(a, b)", 2, 0, exact((a, b) => a + b), "exact with RTE"],
        ["two_product(a, b)", 2, 2, exact((a, b) => a * b), "exact with RTE"],
        ["2⁻⁶⁵ * 2⁻⁶⁵", 3, 1, kept(0, "2⁻¹³⁰"), "may be 0"],
        ["2⁻¹³⁰ * 2¹⁰", 3, 1, kept(1, "2⁻¹²⁰"), "may be 0"],
    ];
    function operations(keep) {
        const draws = [[0, operands], [1, operands], [2, operands], [0, tiny]]
            .map(([rung, of]) => run(keep, 2, rung, bits(of.map(three => [three, [0, 0, 0]]))));
        const floats = draws.map(answers => new Float32Array(answers.buffer));
        const told = OPERATIONS.map(([, draw, at, tell]) => tell(operands.map((_, i) => floats[draw].slice(4 * i + at))));
        return { draws, told };
    }

    const gl = figures.context(), plain = gl.getParameter(gl.RENDERER);
    // Some browsers say the device's name only here.
    const more = plain.startsWith("WebKit") && gl.getExtension("WEBGL_debug_renderer_info");
    const device = more ? gl.getParameter(more.UNMASKED_RENDERER_WEBGL) : plain;
    figure.add(figure.stage, "span", "region", `Your browser calls this device: ${device}.`);
    const plot = figure.drawing("0 0 480 300", "The error of each ray, in ULP");
    const table = (kind, label) => {
        const panel = figure.add(figure.stage, "span", kind);
        figure.add(panel, "span", "label", label);
        return figure.add(panel, "table", "results");
    };
    const all = table("panel", "All rays of a rung, error in ULP");
    const single = table("region", "Operations, 64 times each, error in ULP");
    const cells = (all, tag = "td") => all.map(cell => `<${tag}>${cell}</${tag}>`).join("");
    const KEEPS = ["with", "without"];
    const text = (x, y, words, anchor = "middle") => `<text x="${x}" y="${y}" text-anchor="${anchor}">${words}</text>`;
    const line = (kind, x1, y1, x2, y2) => `<path class="${kind}" d="M${x1} ${y1} L${x2} ${y2}"/>`;
    // From a 64th of a ULP to four million.
    const height = error => 252 - 7 * (Math.min(Math.max(Math.log2(error), -6), 22) + 6);
    const SCALE = { "false hit": 20, "false miss": 44, "a million": height(1e6), "1,000": height(1e3), "½": height(0.5) };
    let found = null;

    function measured() {
        const [kept, loose] = KEEPS.map(operations);
        const cases = {};
        for (const [solid, rungs] of Object.entries(RUNGS)) {
            rungs.forEach((rung, index) =>
                cases[`${solid} ${rung}`] = Object.fromEntries(KEEPS.map(keep => [keep, asked(solid, index, keep)])));
        }
        const rows = OPERATIONS.map(([name, , , , promise], i) => {
            const without = kept.told[i] === loose.told[i] ? "the same" : loose.told[i];
            return `<tr>${cells([name, kept.told[i], without, promise])}</tr>`;
        });
        single.innerHTML = `<tr>${cells(["operation", "with keep", "without keep", "Vulkan promises"], "th")}</tr>${rows.join("")}`;
        // Near the menus, which on a phone are far from the figure's end.
        plot.ownerSVGElement.parentElement.append(figure.said);
        return { device, rays, walls: [LOW, HIGH], operands, cases, operations: { with: kept, without: loose } };
    }

    return () => {
        const [rung, keep] = ["rung", "keep"].map(name => figure.word(name));
        found ??= measured();
        figure.found = found;
        const { points, median, most, worst, falseHits, falseMisses } = found.cases[rung][keep];
        const dots = points.map(({ place, error, falseHit, falseMiss }) => {
            const [kind, y] = falseHit ? ["begin", SCALE["false hit"]] : falseMiss ? ["rounded", SCALE["false miss"]] : ["exact", height(error)];
            return y >= 0 ? `<circle class="${kind}" cx="${85 + 97 * place}" cy="${y}" r="3"/>` : "";
        });
        plot.innerHTML = Object.keys(KINDS[rung.split(" ")[0]]).map((kind, i) => text(132 + 97 * i, 288, kind)
            + line("edge", 84 + 97 * i, 8, 84 + 97 * i, 266)).join("") + line("bound", 84, height(0.5), 480, height(0.5))
            + Object.entries(SCALE).map(([label, y]) => text(78, y + 5, label, "end")).join("") + dots.join("");
        const rows = Object.entries(found.cases).flatMap(([name, kept]) => {
            const same = kept.with.answers.every((bits, i) => bits === kept.without.answers[i]);
            return (same ? ["both"] : KEEPS).map(which => {
                const { median, most, worst, falseHits, falseMisses } = kept[which] ?? kept.with;
                const read = name === rung && (same || which === keep) ? "read" : "";
                return `<tr class="${read}">${cells([name, which, ...[median, most, worst].map(spell), `${falseHits}, ${falseMisses}`])}</tr>`;
            });
        });
        all.innerHTML = `<tr>${cells(["rung", "keep", "median", "99 %", "worst", "false hits, misses"], "th")}</tr>${rows.join("")}`;
        figure.said.textContent = `${rung}, ${keep} keep: half of the hits are off by ${spell(median)} ULP at most, 99 of 100 by `
            + `${spell(most)}, the worst by ${spell(worst)}. Of ${points.length} rays, false hits: ${falseHits}, false misses: ${falseMisses}.`;
    };
});
