"use strict";

// Sliders: without this script both pictures stand side by side.
for (const slider of document.querySelectorAll(".slider")) {
    const input = slider.querySelector("input");
    const [before, after] = [...slider.querySelectorAll(".label")].map(label => label.textContent);
    const show = () => {
        slider.style.setProperty("--at", `${input.value}%`);
        input.setAttribute("aria-valuetext", `${input.value} % ${before}, ${100 - input.value} % ${after}`);
    };
    input.addEventListener("input", show);
    input.hidden = false;
    slider.classList.add("moves");
    show();
}

// The arrows at mdBook's edges and the arrow keys go where the links behind the page go, and say where.
for (const direction of ["previous", "next"]) {
    const ours = document.querySelector(`nav.pages .${direction}`);
    for (const arrow of document.querySelectorAll(`.nav-chapters.${direction}`)) {
        if (ours) {
            arrow.href = ours.href;
            arrow.title = ours.querySelector("span").textContent;
            arrow.setAttribute("aria-label", arrow.title);
        } else {
            arrow.remove();
        }
    }
}

// The first stop of the Tab key, and a button that is only a label in mdBook.
const skip = document.createElement("a");
skip.className = "skip";
skip.href = "#mdbook-content";
skip.textContent = "Skip to the text";
document.getElementById("mdbook-content").tabIndex = -1;
document.body.prepend(skip);
const contents = document.getElementById("mdbook-sidebar-toggle");
contents.tabIndex = 0;
contents.setAttribute("role", "button");
contents.addEventListener("keydown", event => {
    if (event.key === "Enter" || event.key === " ") {
        event.preventDefault();
        contents.click();
    }
});

// An option in the text would break behind its hyphens.
for (const code of document.querySelectorAll("main :not(pre) > code")) {
    if (/(^|\s)-/.test(code.textContent) && code.childElementCount === 0) {
        code.replaceChildren(...code.textContent.split(/(\s+)/).map(word => {
            if (!word.startsWith("-") || word.length > 30) {
                return word;
            }
            const option = document.createElement("span");
            option.className = "option";
            option.textContent = word;
            return option;
        }));
    }
}

// On a phone a drawing that fits would have labels too small to read.
for (const drawing of document.querySelectorAll("main .picture > .drawing")) {
    if (drawing.getAttribute("width") > 600 && !drawing.closest(".figure")) {
        const box = document.createElement("span");
        box.className = "wide";
        drawing.parentElement.replaceWith(box);
        box.append(drawing.parentElement);
    }
}

// What is wider than its column scrolls. Its edges show on which side there is more, the Tab key reaches it,
// and while it has the focus the arrow keys move it, not the pages.
const kinds = [
    ["main pre > code", "Code"], ["main .table-wrapper", "Table"], ["main .formula", "Formula"], ["main .wide", "Drawing"],
];
for (const [which, kind] of kinds) {
    for (const box of document.querySelectorAll(which)) {
        let frame = box.parentElement;
        if (kind !== "Code") {
            frame = document.createElement(kind === "Table" ? "div" : "span");
            box.replaceWith(frame);
            frame.append(box);
        }
        frame.classList.add("scrolls");
        if (kind === "Table" && box.scrollWidth > box.clientWidth) {
            box.classList.add("roomy");
        }
        const show = () => {
            const more = box.scrollWidth - box.clientWidth;
            frame.classList.toggle("before", more > 1 && box.scrollLeft > 1);
            frame.classList.toggle("after", more > 1 && box.scrollLeft < more - 1);
            if (more > 1) {
                box.tabIndex = 0;
                box.setAttribute("role", "region");
                box.setAttribute("aria-label", `${kind}, scrolls sideways`);
            } else {
                ["tabindex", "role", "aria-label"].forEach(name => box.removeAttribute(name));
            }
        };
        box.addEventListener("scroll", show, { passive: true });
        box.addEventListener("keydown", event => {
            if (box.tabIndex === 0 && ["ArrowLeft", "ArrowRight"].includes(event.key)) {
                event.stopPropagation();
            }
        });
        new ResizeObserver(show).observe(box);
        show();
    }
}
