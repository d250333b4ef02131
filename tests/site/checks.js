// What is wrong with the page as it is laid out now, a line each.
(async () => {
    // What watches sizes has been told of the last change.
    await new Promise(done => requestAnimationFrame(() => requestAnimationFrame(done)));
    const wrong = [];
    const name = element => {
        const text = element.textContent.trim().slice(0, 40);
        return `<${element.tagName.toLowerCase()} class="${element.getAttribute("class") ?? ""}"> ${text}`;
    };

    const wide = document.documentElement.scrollWidth;
    if (wide > innerWidth) {
        wrong.push(`is ${wide} pixels wide, the screen ${innerWidth}`);
    }
    // What stands out of the text's column without a box that scrolls.
    const column = document.querySelector("main").getBoundingClientRect();
    for (const element of document.querySelectorAll("main *")) {
        const box = element.getBoundingClientRect();
        if (box.width > 0 && box.right > innerWidth + 1 && !scrolls(element)) {
            wrong.push(`${name(element)} ends ${Math.round(box.right - innerWidth)} pixels beyond the screen`);
        }
    }
    function scrolls(element) {
        for (let up = element.parentElement; up.tagName !== "MAIN"; up = up.parentElement) {
            if (["auto", "scroll", "hidden"].includes(getComputedStyle(up).overflowX)) {
                return true;
            }
        }
        return element.tagName === "INPUT";
    }

    // What scrolls sideways says so, to the eye and to the keyboard.
    let scrolling = 0;
    for (const box of document.querySelectorAll("main *")) {
        const more = box.scrollWidth - box.clientWidth;
        const { overflowX, display } = getComputedStyle(box);
        if (more > 1 && ["auto", "scroll"].includes(overflowX) && display !== "inline" && box.checkVisibility()) {
            const frame = box.closest(".scrolls");
            const arrow = frame && getComputedStyle(frame, "::after").content;
            if (arrow !== '"›"' || box.tabIndex !== 0 || !box.getAttribute("aria-label")) {
                wrong.push(`${name(box)} scrolls by ${more} pixels and does not say so`);
            }
            scrolling++;
        }
    }

    for (const formula of document.querySelectorAll("math")) {
        const box = formula.getBoundingClientRect();
        if (formula.checkVisibility() && !(box.width > 2 && box.height > 5)) {
            wrong.push(`formula '${formula.textContent}' is ${box.width} by ${box.height} pixels`);
        }
    }

    // Contrast, as WCAG 2 defines it, of every kind of text that is seen.
    const channels = text => {
        const found = text.match(/[\d.]+/g).map(Number);
        return found.length < 4 ? [...found, 1] : found;
    };
    const over = (front, back) => [0, 1, 2].map(i => front[i] * front[3] + back[i] * (1 - front[3]));
    const luminance = color => {
        const linear = color.map(c => c / 255).map(c => c <= 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4);
        return 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2];
    };
    const ground = element => {
        const layers = [];
        for (let up = element; up; up = up.parentElement) {
            const color = channels(getComputedStyle(up).backgroundColor);
            if (color[3] > 0) {
                layers.push(color);
            }
            if (color[3] === 1) {
                break;
            }
        }
        return layers.reverse().reduce((back, front) => over(front, back), [255, 255, 255]);
    };
    const seen = new Set();
    const texts = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
    while (texts.nextNode()) {
        const element = texts.currentNode.parentElement;
        if (!texts.currentNode.data.trim() || ["SCRIPT", "STYLE", "TEMPLATE", "NOSCRIPT"].includes(element.tagName)) {
            continue;
        }
        const up = element.parentElement;
        const kind = [element.tagName, element.className, up?.tagName, up?.className, up?.parentElement?.className].join();
        if (seen.has(kind) || !element.checkVisibility({ opacityProperty: true, visibilityProperty: true })) {
            continue;
        }
        seen.add(kind);
        const back = ground(element);
        const front = over(channels(getComputedStyle(element).color), back);
        const [light, dark] = [luminance(front), luminance(back)].sort((a, b) => b - a);
        const contrast = (light + 0.05) / (dark + 0.05);
        if (contrast < 4.5) {
            wrong.push(`${name(element)} has a contrast of ${contrast.toFixed(2)}`);
        }
    }
    return { wrong, kinds: seen.size, scrolling };
})()
