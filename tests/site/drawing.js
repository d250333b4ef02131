// What of the drawing, as it is painted now, does not stand out from what lies behind it, a line each.
(() => {
    const wrong = [];
    const channels = text => text.match(/[\d.]+/g).map(Number).slice(0, 3);
    const luminance = color => {
        const linear = color.map(c => c / 255).map(c => c <= 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4);
        return 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2];
    };
    const contrast = (front, back) => {
        const [light, dark] = [luminance(front), luminance(back)].sort((a, b) => b - a);
        return (light + 0.05) / (dark + 0.05);
    };
    const shapes = [...document.querySelectorAll("rect, polygon, circle, path, polyline, ellipse")]
        .filter(shape => !shape.closest("defs"))
        .map(shape => {
            const { fill, stroke, fillOpacity, opacity } = getComputedStyle(shape);
            return { shape, fill, stroke, part: fillOpacity * opacity, dot: shape.tagName === "circle" && stroke === "none" };
        });
    // Lines and dots are held to the sheets and cards they stand on; grids may be faint.
    const grounds = new Set(GROUNDS), grids = new Set(GRIDS);
    const areas = shapes.filter(({ fill, dot }) => fill !== "none" && !dot);
    const sheets = areas.filter(({ fill }) => grounds.has(fill));
    // What areas paint at a point before an element does.
    const behind = (element, point, areas) => {
        let color = [255, 255, 255];
        for (const { shape, fill, part } of areas) {
            const before = shape !== element && shape.compareDocumentPosition(element) & Node.DOCUMENT_POSITION_FOLLOWING;
            if (before && shape.isPointInFill(point)) {
                color = channels(fill).map((c, i) => c * part + color[i] * (1 - part));
            }
        }
        return color;
    };
    let seen = 0;
    const hold = (element, color, points, areas, least, what) => {
        const found = Math.min(...points.map(point => contrast(channels(color), behind(element, point, areas))));
        if (found < least) {
            wrong.push(`${what} has a contrast of ${found.toFixed(2)}`);
        }
        seen++;
    };
    for (const text of document.querySelectorAll("text")) {
        const words = text.textContent.trim();
        if (!words) {
            continue;
        }
        const box = text.getBBox();
        // Beside the letters, not under them; turned text is turned by its own matrix.
        const own = text.transform.baseVal.consolidate()?.matrix;
        const points = [0.02, 0.25, 0.5, 0.75, 0.98].map(part => {
            const point = new DOMPoint(box.x + part * box.width, box.y + box.height / 2);
            return own ? point.matrixTransform(own) : point;
        });
        hold(text, getComputedStyle(text).fill, points, areas, 4.5, `'${words}'`);
    }
    for (const { shape, fill, stroke, dot } of shapes) {
        if (dot && !grounds.has(fill)) {
            const at = new DOMPoint(shape.cx.baseVal.value, shape.cy.baseVal.value);
            hold(shape, fill, [at], sheets, 3, `a dot in ${fill}`);
        }
        if (stroke === "none" || grids.has(stroke)) {
            continue;
        }
        const length = shape.getTotalLength();
        const points = [0.1, 0.3, 0.5, 0.7, 0.9].map(part => shape.getPointAtLength(part * length));
        // Of an outline's two sides one is enough.
        if (fill === "none" || contrast(channels(stroke), channels(fill)) < 3) {
            hold(shape, stroke, points, sheets, 3, `a line in ${stroke}`);
        } else {
            seen++;
        }
    }
    return { wrong, seen };
})()
