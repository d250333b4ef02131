// The checker board of chapter 43: one square per pixel, or the mean of a pixel's squares, and what is wrong with it.
figures.add("checker", figure => {
    const SIDE = 128;
    const CHECKERS = ["filtered", "point", "144 rays"];
    // Linear light, as the mean of squares must be.
    const [LIGHT, DARK] = [[0.8, 0.62, 0.38], [0.1, 0.045, 0.025]];
    const SKY = [214, 226, 240];
    const RAMP = [[26, 39, 89], [97, 47, 149], [188, 69, 111], [249, 170, 56], [255, 255, 238]];
    const picture = figure.canvas(SIDE, "What the pixels show");
    const map = figure.canvas(SIDE, "How far that is from the mean of 144 rays");
    const legend = figure.add(figure.stage, "span", "legend");
    RAMP.forEach((color, i) => {
        const key = figure.add(legend, "span", "key", ["right", "off by ⅛", "¼", "⅜", "½ or more"][i]);
        key.style.setProperty("--color", `rgb(${color})`);
    });

    // 60° from top to bottom; it looks across the squares.
    function camera(height, tilt) {
        const [half, turn, down] = [Math.tan(Math.PI / 6), 0.34, tilt * Math.PI / 180];
        const across = [Math.sin(turn), 0, -Math.cos(turn)];
        const along = (level, upward) => across.map(x => level * x).map((x, i) => i === 1 ? upward : x);
        return {
            eye: [0.3, height, 0.2].map(Math.fround), forward: along(Math.cos(down), -Math.sin(down)),
            right: [Math.cos(turn), 0, Math.sin(turn)].map(x => half * x),
            up: along(half * Math.sin(down), half * Math.cos(down)),
        };
    }

    const encoded = linear => 255 * (linear < 0.0031308 ? 12.92 * linear : 1.055 * linear ** (1 / 2.4) - 0.055);
    const seen = light => DARK.map((dark, i) => encoded(dark + light * (LIGHT[i] - dark)));

    function color(error) {
        const place = Math.min(8 * error, 3.999);
        const at = Math.floor(place);
        return RAMP[at].map((low, i) => low + (RAMP[at + 1][i] - low) * (place - at));
    }

    return () => {
        const chosen = CHECKERS.indexOf(figure.word("checker"));
        const view = camera(figure.number("height"), figure.number("tilt"));
        const uniforms = Object.entries(view).map(([name, numbers]) => [name, ["3f", ...numbers]]);
        const answers = figures.compute("checker", SIDE, { ...Object.fromEntries(uniforms), side: ["1ui", SIDE] });
        const floats = new Float32Array(answers.buffer);
        const contexts = [picture, map].map(canvas => canvas.getContext("2d"));
        const [shown, wrong] = contexts.map(context => context.createImageData(SIDE, SIDE));
        const errors = [0, 0];
        let count = 0;
        for (let y = 0; y < SIDE; y++) {
            for (let x = 0; x < SIDE; x++) {
                // WebGL's first line is the lowest one.
                const from = 4 * ((SIDE - 1 - y) * SIDE + x), to = 4 * (y * SIDE + x);
                const [filtered, point, many, t] = floats.subarray(from, from + 4);
                // Half sky and half board: the filter is for the board alone, and is not judged there.
                const whole = many >= 0;
                const lights = [filtered, point, whole ? many : filtered];
                shown.data.set([...(t === 0 ? SKY : seen(lights[chosen])), 255], to);
                wrong.data.set([...(whole ? color(Math.abs(lights[chosen] - many)) : SKY), 255], to);
                if (whole) {
                    count++;
                    errors.forEach((_, i) => errors[i] += Math.abs(lights[i] - many));
                }
            }
        }
        contexts[0].putImageData(shown, 0, 0);
        contexts[1].putImageData(wrong, 0, 0);
        const [filtered, point] = errors.map(sum => sum / count);
        figure.found = { filtered, point, count, view, answers };
        const spell = error => figure.spell(Number(error.toPrecision(2)));
        figure.said.textContent = (chosen === 2 ? "The mean of 144 rays is the truth that the others are held to. " : "")
            + `A dark square is 0, a light one 1. The average error of "filtered" is ${spell(filtered)}, of "point", one square `
            + `a pixel, ${spell(point)}. Pixels with sky in them are not judged.`;
    };
});
