"use strict";

// What all figures share. A figure is drawn while it is in view or nearly so, at first and after a control has
// changed. Nothing moves by itself.
const figures = (() => {
    const shaders = {};
    const stored = {};
    const all = [];
    // One context for all figures of a page: browsers give a page only a few.
    let gl = null;
    const programs = new Map();
    let target = null;

    // What holds for every figure that runs a shader.
    const NOTE = "Your browser's WebGL 2 has computed this, from the text of shaders/. It has no precise: an exclusive or with 0 "
        + "stands in its place. The bits of other operations are not promised, and numbers below 2⁻¹²⁶ may become 0.";

    // What the reader is told in place of a drawing.
    class Unable extends Error {}

    class Figure {
        constructor(name, box, start) {
            this.name = name;
            this.box = box;
            this.controls = box.querySelector(".controls");
            this.stage = this.add(box, "span", "stage");
            this.sliders = this.add(box, "span", "controls");
            this.said = this.add(box, "output", "said");
            this.note = this.add(box, "span", "note");
            this.start = start;
            this.changed = true;
            this.seen = false;
            this.asked = false;
            this.read = new Set();
            // Sliders stand below the drawing: so a phone shows both, and the drawing first.
            for (const input of this.inputs().filter(({ type }) => type === "range")) {
                this.sliders.append(input.parentElement);
                this.tell(input);
            }
            box.addEventListener("input", ({ target }) => {
                if (target.type === "range") {
                    this.tell(target);
                }
                this.change();
            });
            // What lies outside a control's range has been brought into it.
            box.addEventListener("change", ({ target }) => {
                if (target.type === "number") {
                    target.value = this.number(target.name);
                }
            });
            // The arrow keys are the control's: they do not turn pages.
            box.addEventListener("keydown", event => {
                if (event.key.startsWith("Arrow")) {
                    event.stopPropagation();
                }
            });
        }

        inputs() {
            return [...this.box.querySelectorAll("[name]")];
        }

        add(to, tag, kind, text = "") {
            const element = document.createElement(tag);
            element.className = kind;
            element.textContent = text;
            to.append(element);
            return element;
        }

        // A picture of `side` by `side` pixels under a label.
        canvas(side, label) {
            const panel = this.add(this.stage, "span", "panel");
            this.add(panel, "span", "label", label);
            const canvas = this.add(panel, "canvas", "");
            canvas.width = canvas.height = side;
            canvas.setAttribute("role", "img");
            canvas.setAttribute("aria-label", label);
            return canvas;
        }

        // A drawing under a label or, without one, as wide as the stage, and the part of it that is drawn anew.
        // What it shows is told in words, too.
        drawing(viewBox, label) {
            const panel = this.add(this.stage, "span", label ? "panel" : "region");
            this.add(panel, "span", "label", label);
            const svg = this.shape(panel, "svg");
            svg.setAttribute("viewBox", viewBox);
            svg.setAttribute("aria-hidden", "true");
            return this.shape(svg, "g");
        }

        shape(to, tag) {
            return to.appendChild(document.createElementNS("http://www.w3.org/2000/svg", tag));
        }

        // A point of a drawing that the reader drags: `moved` is told where to. Controls do it for the keyboard.
        grip(drawing, moved) {
            const svg = drawing.ownerSVGElement;
            const grip = this.shape(svg, "circle");
            grip.setAttribute("class", "grip");
            grip.setAttribute("r", 10);
            grip.addEventListener("pointerdown", ({ pointerId }) => grip.setPointerCapture(pointerId));
            grip.addEventListener("pointermove", ({ pointerId, clientX, clientY }) => {
                if (grip.hasPointerCapture(pointerId)) {
                    const { x, y } = new DOMPoint(clientX, clientY).matrixTransform(svg.getScreenCTM().inverse());
                    moved(x, y);
                }
            });
            return grip;
        }

        // Sets a slider as the reader would; it brings the number into its range.
        set(name, number) {
            const input = this.input(name);
            input.value = Math.round(number);
            input.dispatchEvent(new Event("input", { bubbles: true }));
        }

        input(name) {
            const input = this.box.querySelector(`[name="${name}"]`);
            if (!input) {
                throw new Error(`the figure's mark has no control '${name}'`);
            }
            this.read.add(name);
            return input;
        }

        word(name) {
            return this.input(name).value;
        }

        // A number, brought into its range: one that is being typed may lie outside.
        number(name) {
            const input = this.input(name);
            if (input.dataset.low) {
                const { low, steps } = input.dataset;
                return Number((low * 10 ** (input.value / steps)).toPrecision(3));
            }
            const [value, least, most] = [Number(input.value), input.min, input.max];
            return input.min ? Math.min(Math.max(Math.round(value), least), most) : value;
        }

        // A number as it is written in a sentence.
        spell(number) {
            if (Math.abs(number) >= 0.001 || number === 0) {
                return number.toLocaleString("en", { maximumSignificantDigits: 3 });
            }
            const [digits, exponent] = number.toExponential(1).split("e-");
            const raised = [...exponent].map(digit => "⁰¹²³⁴⁵⁶⁷⁸⁹"[digit]).join("");
            return `${digits.replace(".0", "")} × 10⁻${raised}`;
        }

        tell(input) {
            const text = this.spell(this.number(input.name));
            input.parentElement.querySelector("output").textContent = text;
            input.setAttribute("aria-valuetext", text);
        }

        change() {
            this.changed = true;
            this.ask();
        }

        ask() {
            if (this.seen && this.changed && !this.asked) {
                this.asked = true;
                requestAnimationFrame(() => {
                    this.asked = false;
                    this.draw();
                });
            }
        }

        draw() {
            this.changed = false;
            try {
                this.show ??= this.start(this);
                this.show();
                this.stand(false);
                const unread = this.inputs().find(input => !this.read.has(input.name));
                if (unread) {
                    throw new Error(`the figure has no use for the control '${unread.name}'`);
                }
            } catch (error) {
                if (!(error instanceof Unable)) {
                    throw error;
                }
                this.stand(true);
                this.said.textContent = error.message;
            }
        }

        // The still picture stands where there is no drawing.
        stand(still) {
            this.box.classList.toggle("moves", !still);
            const picture = this.box.querySelector(".still");
            const focused = picture.contains(document.activeElement);
            picture.hidden = !still;
            this.stage.hidden = this.controls.hidden = this.sliders.hidden = still;
            // Who is on the picture by the keyboard goes on with what has taken its place.
            if (focused && !still) {
                this.inputs().find(({ type }) => type !== "hidden")?.focus({ preventScroll: true });
            }
            this.note.textContent = !still && shaders[this.name] ? NOTE : "";
        }
    }

    const view = new IntersectionObserver(entries => {
        for (const { target, isIntersecting } of entries) {
            const figure = all.find(({ box }) => box === target);
            figure.seen = isIntersecting;
            figure.ask();
        }
    }, { rootMargin: "300px 0px" });

    // A kind of figure: `start` makes its elements, and gives the function that draws it.
    function add(name, start) {
        for (const box of document.querySelectorAll(`.figure[data-figure="${name}"]`)) {
            all.push(new Figure(name, box, start));
            view.observe(box);
        }
    }

    function context() {
        if (!gl) {
            const canvas = document.createElement("canvas");
            gl = canvas.getContext("webgl2", { antialias: false, depth: false });
            if (!gl) {
                throw new Unable("This browser has no WebGL 2: the figure stands still.");
            }
            const again = () => all.forEach(figure => figure.change());
            canvas.addEventListener("webglcontextlost", event => {
                event.preventDefault();
                programs.clear();
                target = null;
                again();
            });
            canvas.addEventListener("webglcontextrestored", again);
        }
        if (gl.isContextLost()) {
            throw new Unable("The browser has taken the GPU away: the figure stands still until it is back.");
        }
        return gl;
    }

    function program(name) {
        if (!programs.has(name)) {
            const corner = "gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0";
            const made = gl.createProgram();
            for (const [kind, text] of [
                [gl.VERTEX_SHADER, `#version 300 es\nvoid main() { gl_Position = vec4(${corner}, 0.0, 1.0); }`],
                [gl.FRAGMENT_SHADER, shaders[name]],
            ]) {
                const shader = gl.createShader(kind);
                gl.shaderSource(shader, text);
                gl.compileShader(shader);
                if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS) && !gl.isContextLost()) {
                    throw new Error(`${name}: ${gl.getShaderInfoLog(shader)}`);
                }
                gl.attachShader(made, shader);
            }
            gl.linkProgram(made);
            if (!gl.getProgramParameter(made, gl.LINK_STATUS) && !gl.isContextLost()) {
                throw new Error(`${name}: ${gl.getProgramInfoLog(made)}`);
            }
            programs.set(name, made);
        }
        return programs.get(name);
    }

    // Runs a figure's shader once for each of `side` by `side` pixels, and gives the four whole numbers that it
    // writes for each. A uniform is a list: what follows `uniform` in WebGL's function, and its numbers.
    function compute(name, side, uniforms) {
        context();
        const made = program(name);
        gl.useProgram(made);
        for (const [uniform, [type, ...numbers]] of Object.entries(uniforms)) {
            gl[`uniform${type}`](gl.getUniformLocation(made, uniform), ...numbers);
        }
        if (!target || target.side !== side) {
            target = { side };
            gl.bindTexture(gl.TEXTURE_2D, gl.createTexture());
            gl.texStorage2D(gl.TEXTURE_2D, 1, gl.RGBA32UI, side, side);
            gl.bindFramebuffer(gl.FRAMEBUFFER, gl.createFramebuffer());
            const texture = gl.getParameter(gl.TEXTURE_BINDING_2D);
            gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D, texture, 0);
            gl.viewport(0, 0, side, side);
        }
        gl.drawArrays(gl.TRIANGLES, 0, 3);
        const answers = new Uint32Array(4 * side * side);
        gl.readPixels(0, 0, side, side, gl.RGBA_INTEGER, gl.UNSIGNED_INT, answers);
        context();
        return answers;
    }

    return { add, all, compute, context, shaders, stored };
})();
