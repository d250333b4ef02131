// The discriminant of a far sphere, digit by digit: what cancels, and what a float has room for.
figures.add("digits", figure => {
    const f = Math.fround;
    const dot = (a, b) => f(f(a[0] * b[0]) + f(a[1] * b[1]));
    // Every float here is a whole number of 2⁻⁸⁰.
    const exactly = a => a.map(x => BigInt(x * 2 ** 80));
    const exactDot = (a, b) => a[0] * b[0] + a[1] * b[1];

    const drawing = figure.drawing("0 0 480 200");
    const legend = figure.add(figure.stage, "span", "legend");
    for (const [kind, text] of [["held", "a float holds these digits"], ["struck", "equal: they cancel"], ["wrong", "wrong digits"]]) {
        figure.add(legend, "span", `key ${kind}`, text);
    }

    // A digit's place is its power of ten. Three stand together.
    const across = place => 308 - 18 * place + 7 * Math.floor((14 - place) / 3);
    // In millionths.
    const digits = number => [...String(number).replace("-", "").padStart(7, "0")];
    const letter = (x, y, text, kind = "") => `<text class="digit ${kind}" x="${x}" y="${y}">${text}</text>`;
    function line(name, y, number, kind) {
        const all = digits(number), top = all.length - 7;
        return `<text x="4" y="${y}">${name}</text>` + all.map((digit, i) => letter(across(top - i), y, digit, kind(top - i, digit))).join("")
            + letter(349, y, ".") + (number < 0 ? letter(across(top) - 16, y, "−") : "");
    }

    return () => {
        const away = 1 + figure.number("distance");
        const aside = figure.number("aside") / 100;
        const [x, y] = [Math.cos(0.6), Math.sin(0.6)];
        const o = [f(x * away), f(y * away)];
        const towards = [-y * aside - o[0], x * aside - o[1]];
        const d = towards.map(part => f(part / Math.hypot(...towards)));

        // sphere_textbook() and sphere_stable() for a radius of 1, each operation rounded to 32 bits.
        const [a, b, c] = [dot(d, d), dot(o, d), f(dot(o, o) - 1)];
        const textbook = f(f(b * b) - f(a * c));
        const middle = f(-b / a);
        const foot = o.map((part, i) => f(part + f(middle * d[i])));
        const stable = f(a * f(1 - dot(foot, foot)));
        const [wholeO, wholeD] = [o, d].map(exactly);
        const operands = [
            exactDot(wholeO, wholeD) ** 2n, exactDot(wholeD, wholeD) * (exactDot(wholeO, wholeO) - (1n << 160n)),
        ].map(product => product * 1000000n >> 320n);
        const exact = operands[0] - operands[1];

        const [one, other] = operands.map(digits);
        const same = one.length === other.length ? one.findIndex((digit, i) => digit !== other[i]) : 0;
        const top = one.length - 7;
        // The last place that is no smaller than the last of 24 bits.
        const last = Math.max(Math.ceil(Math.log10(2 ** (Math.floor(Math.log2(b * b)) - 23))), -6);
        const held = top - last + 1;
        figure.found = { o, d, operands: operands.map(String), textbook, stable, same, held };

        const results = Object.entries({ exact: Number(exact) / 1e6, textbook, stable });
        const truth = digits(exact).reverse();
        drawing.innerHTML = operands.map((number, i) => {
            const y = 34 + 34 * i, left = across(top) - 10;
            return `<rect class="held" x="${left}" y="${y - 20}" width="${across(last) + 10 - left}" height="26"/>`
                + line("ba"[i] + " · " + "bc"[i], y, number, place => place < last ? "lost" : "")
                + (same ? `<path class="struck" d="M${left} ${y - 7} H${across(top - same + 1) + 10}"/>` : "");
        }).join("") + `<path class="edge" d="M4 84 H476"/>` + results.map(([name, number], i) =>
            line(name, 112 + 34 * i, Math.round(number * 1e6), (place, digit) =>
                digit === (truth[place + 6] ?? "0") && number < 0 === exact < 0 ? "" : "wrong")).join("");
        figure.said.textContent = `The ray passes the centre at ${figure.spell(aside)} radii. ${same} digits cancel, and a float holds ${held}: `
            + `${Math.max(held - same, 0)} are left. ${results.map(([name, number]) => `${name}: ${number < 0 ? "miss" : "hit"}`).join(", ")}.`;
    };
});
