// A thin lens from the side: the rays of a light, and the circle of confusion that the picture has in its place.
figures.add("lens", figure => {
    const [LENS, AXIS, FOCAL] = [112, 122, 44];
    // The picture of the chapter: so many pixels for a length of 1 at distance 1.
    const [HIGH, VIEW] = [600, 37];
    const PIXELS = HIGH / 2 / Math.tan(VIEW / 2 * Math.PI / 180);
    const [NEAR, FAR, SHOWN] = [60, 330, 220 / HIGH];
    const scene = figure.drawing("0 0 456 264", "From the side: film, lens and light");
    const chart = figure.drawing("0 0 456 264", "The circle in the picture, by the light's distance");
    const grips = ["aperture", "focus", "light"].map(name => figure.grip(scene, (x, y) =>
        figure.set(name, name === "aperture" ? 2 * (y - AXIS) : x - LENS)));

    const text = (x, y, words, anchor = "middle") => `<text class="halo" x="${x}" y="${y}" text-anchor="${anchor}">${words}</text>`;
    const path = (kind, ...points) => `<path class="${kind}" d="M${points.join(" L")}"/>`;
    const upright = (kind, x, half) => path(kind, [x, AXIS - half], [x, AXIS + half]);
    const measure = (to, y, words) => path("edge", [LENS, y], [to, y]) + path("edge", [LENS, y - 5], [LENS, y + 5])
        + path("edge", [to, y - 5], [to, y + 5]) + text((LENS + to) / 2, y - 5, words);
    // Where the lens makes an image of what is so far away.
    const image = distance => FOCAL * distance / (distance - FOCAL);
    // Of a light at a distance: in pixels of the picture.
    const circle = (aperture, focus, distance) => aperture * Math.abs(1 / focus - 1 / distance) * PIXELS;

    return () => {
        const [aperture, focus, light] = ["aperture", "focus", "light"].map(name => figure.number(name));
        const c = aperture * Math.abs(light - focus) / light;
        const pixels = circle(aperture, focus, light);
        const [film, meets] = [image(focus), image(light)];
        const [plane, source] = [LENS + focus, LENS + light];
        const rays = [-1, -0.5, 0, 0.5, 1].map(part => part * aperture / 2);
        // How far from the axis a ray from a place of the lens crosses the plane in focus, and the film.
        const crossing = place => place * (light - focus) / light;
        const onFilm = place => place * (1 - film / meets);
        figure.found = {
            c, pixels, film, meets, focal: FOCAL, infinite: aperture / focus * PIXELS,
            rays: rays.map(place => [place, crossing(place), onFilm(place)]),
        };

        let shapes = upright("sheet", plane, 92) + upright("surface", LENS - film, 62)
            + `<ellipse class="body" cx="${LENS}" cy="${AXIS}" rx="9" ry="${aperture / 2}"/>`;
        for (const place of rays) {
            shapes += path("ray light fine", [LENS - film, AXIS + onFilm(place)], [LENS, AXIS + place], [source, AXIS]);
            // The ray tracer's rays go on to the plane in focus.
            shapes += light < focus ? path("ray light fine rest", [source, AXIS], [plane, AXIS + crossing(place)]) : "";
        }
        shapes += upright("spread", plane, c / 2) + upright("spread", LENS - film, Math.abs(onFilm(aperture / 2)));
        // Beyond the drawing there is no room for the letter.
        shapes += c > 12 && c < 160 ? text(plane + 9, AXIS - c / 2 - 4, "c", "start") : "";
        shapes += text(LENS - film, 50, "film") + text(Math.min(plane, 396), 22, "plane in focus")
            + text(LENS - 12, AXIS - aperture / 2, "A", "end") + measure(plane, 230, "S₁") + measure(source, 256, "S₂");
        scene.innerHTML = shapes;
        [[LENS, AXIS + aperture / 2], [plane, 214], [source, AXIS]].forEach(([x, y], i) => {
            grips[i].setAttribute("cx", x);
            grips[i].setAttribute("cy", y);
        });

        // Half of the circle of each distance, up and down, as far as the picture reaches.
        const half = distance => Math.min(SHOWN * circle(aperture, focus, distance) / 2, 110);
        const places = Array.from({ length: FAR - NEAR + 1 }, (_, i) => NEAR + i);
        const band = [...places.map(place => [LENS + place, AXIS - half(place)]),
            ...places.reverse().map(place => [LENS + place, AXIS + half(place)])];
        chart.innerHTML = `<rect class="state" x="${LENS + NEAR}" y="${AXIS - 110}" width="${FAR - NEAR}" height="220"/>`
            + `<polygon class="body" points="${band.join(" ")}"/>` + upright("sheet", plane, 110)
            + `<circle class="state visited-now" cx="${source}" cy="${AXIS}" r="${SHOWN * pixels / 2}"/><circle class="begin" cx="${source}" cy="${AXIS}" r="3"/>`
            + text(LENS + NEAR - 8, AXIS - 98, `${HIGH} pixels`, "end") + text(LENS + NEAR - 8, AXIS + 5, `${figure.spell(pixels)} pixels`, "end")
            + text(Math.min(plane, 396), 252, "plane in focus");

        figure.said.textContent = `c = ${aperture} × |${light} − ${focus}| / ${light} = ${figure.spell(c)} on the plane in focus. `
            + `That is ${figure.spell(pixels)} pixels of a picture ${HIGH} high, with a field of view of ${VIEW}°. `
            + `A light infinitely far away has ${figure.spell(figure.found.infinite)}.`;
    };
});
