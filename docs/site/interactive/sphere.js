// The sphere of chapter 42 from any distance, by each rung, and its error in ULP.
figures.add("sphere", figure => {
    const SIDE = 240;
    const RUNGS = ["textbook", "stable", "two-float"];
    const picture = figure.canvas(SIDE, "What the rung finds");
    const map = figure.canvas(SIDE, "Its error");
    const legend = figure.add(figure.stage, "span", "legend");
    // Of the error map in the chapter's picture: from half a ULP to a million.
    const RAMP = [[26, 39, 89], [97, 47, 149], [188, 69, 111], [249, 170, 56], [255, 255, 238]];
    const [MISS, FALSE_HIT, FALSE_MISS] = [[137, 137, 137], [255, 0, 0], [0, 231, 108]];
    for (const [color, text] of [[RAMP[0], "½ ULP"], [RAMP[1], "20"], [RAMP[2], "700"], [RAMP[3], "30,000"],
        [RAMP[4], "a million"], [MISS, "rightly missed"], [FALSE_HIT, "false hit"], [FALSE_MISS, "false miss"]]) {
        const key = figure.add(legend, "span", "key", text);
        key.style.setProperty("--color", `rgb(${color})`);
    }

    const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    const times = (a, s) => a.map(x => x * s);
    const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
    const unit = a => times(a, 1 / Math.sqrt(dot(a, a)));

    // The camera of the chapter's scene `one sphere`: a tenth more than the sphere fills.
    function camera(distance) {
        const away = 1 + distance;
        const eye = times(unit([2, 1.4, 3]), away).map(Math.fround);
        const forward = unit(times(eye, -1));
        const half = Math.tan(1.1 * Math.asin(1 / away));
        const right = times(unit(cross(forward, [0, 1, 0])), half);
        return { eye, forward, right, up: times(unit(cross(right, forward)), half) };
    }

    // The near root in 64 bits, which are enough to tell a float's last place; 0 for a miss.
    function exact(eye, d) {
        const a = dot(d, d), middle = -dot(eye, d) / a;
        const foot = eye.map((x, i) => x + middle * d[i]);
        const square = (1 - dot(foot, foot)) / a;
        return square >= 0 ? (dot(eye, eye) - 1) / a / (middle + Math.sqrt(square)) : 0;
    }

    const ulps = (t, right) => Math.abs(t - right) / 2 ** (Math.floor(Math.log2(right)) - 23);

    function color(error) {
        const place = Math.min(Math.max((Math.log2(Math.max(error, 0.5)) + 1) / 21 * 4, 0), 3.999);
        const at = Math.floor(place);
        return RAMP[at].map((low, i) => low + (RAMP[at + 1][i] - low) * (place - at));
    }

    return () => {
        const distance = figure.number("distance");
        const rung = RUNGS.indexOf(figure.word("rung"));
        const { eye, forward, right, up } = camera(distance);
        const answers = figures.compute("sphere", SIDE, {
            eye: ["3f", ...eye], forward: ["3f", ...forward], right: ["3f", ...right], up: ["3f", ...up],
            side: ["1ui", SIDE], rung: ["1ui", rung],
        });
        const floats = new Float32Array(answers.buffer);
        const contexts = [picture, map].map(canvas => canvas.getContext("2d"));
        const [shown, wrong] = contexts.map(context => context.createImageData(SIDE, SIDE));
        const light = unit([0.3, 1, 0.5]);
        const errors = [], truths = [], rays = new Set();
        let falseHits = 0, falseMisses = 0;
        for (let y = 0; y < SIDE; y++) {
            for (let x = 0; x < SIDE; x++) {
                // WebGL's first line is the lowest one.
                const from = 4 * ((SIDE - 1 - y) * SIDE + x), to = 4 * (y * SIDE + x);
                const [t, ...d] = floats.subarray(from, from + 4);
                const truth = exact(eye, d);
                truths.push(truth);
                rays.add(String(d));
                let seen = [214, 226, 240], error = MISS;
                if (t !== 0) {
                    const normal = unit(eye.map((o, i) => o + t * d[i]));
                    const bright = 0.25 + 0.75 * Math.max(dot(normal, light), 0);
                    seen = [236, 178, 92].map(part => part * bright);
                }
                if (t !== 0 && truth !== 0) {
                    errors.push(ulps(t, truth));
                    error = color(errors.at(-1));
                } else if (t !== 0) {
                    falseHits++;
                    error = FALSE_HIT;
                } else if (truth !== 0) {
                    falseMisses++;
                    error = FALSE_MISS;
                }
                shown.data.set([...seen, 255], to);
                wrong.data.set([...error, 255], to);
            }
        }
        contexts[0].putImageData(shown, 0, 0);
        contexts[1].putImageData(wrong, 0, 0);
        errors.sort((a, b) => a - b);
        const median = errors.length ? errors[errors.length >> 1] : NaN;
        const part = count => `${(100 * count / SIDE ** 2).toFixed(2)}\u00a0%`;
        // From afar neighbours round to one direction.
        const coarse = rays.size < SIDE ** 2 ? ` The pixels have no more than ${rays.size.toLocaleString("en")} directions: a float tells no others apart.` : "";
        figure.found = { median, rays: rays.size, falseHits, falseMisses, eye, answers, truths };
        figure.said.textContent = `Half of the ${errors.length.toLocaleString("en")} hits are off by ${median.toFixed(1)} ULP or more. `
            + `${part(falseHits)} of the rays hit where they should miss, ${part(falseMisses)} miss where they should hit.${coarse}`;
    };
});
