// How a page lies on a screen or on paper. Each function runs in the page, after `shownText`, and
// returns what it found wrong, in words.

/// Nothing is beyond the page, cut, squeezed, on top of other text, too small to read or to touch.
export function layout({ touch }) {
    const found = [];
    const words = element => {
        const text = (element.getAttribute('aria-label') ?? element.textContent).trim();
        const name = element.getAttribute('class') || element.id;
        return `${element.tagName.toLowerCase()}.${name} "${text.slice(0, 40)}"`;
    };
    const { scrollingElement: root } = document;
    if (root.scrollWidth > root.clientWidth) {
        found.push(`the page is ${root.scrollWidth} wide, the window ${root.clientWidth}`);
    }
    // What scrolls by itself may be wider than the window.
    const scrolls = element => {
        const { overflowX } = getComputedStyle(element);
        return ['auto', 'scroll'].includes(overflowX) && element.scrollWidth > element.clientWidth;
    };
    const within = element => {
        for (let at = element; at && at !== document.body; at = at.parentElement) {
            if (scrolls(at)) {
                return at;
            }
        }
        return null;
    };
    const texts = window.shownText();
    const isOut = box => box.left < -0.5 || box.right > root.clientWidth + 0.5;
    const outside =
        texts.filter(({ element, boxes }) => !within(element) && boxes.some(isOut));
    outside.forEach(({ element }) => found.push(`beyond the page: ${words(element)}`));
    for (const element of document.body.querySelectorAll('*')) {
        const { overflowX, overflowY, clip, clipPath } = getComputedStyle(element);
        const hides = value => value === 'hidden' || value === 'clip';
        const isShown = element.clientWidth > 2 && clip === 'auto' && clipPath === 'none';
        const cut = hides(overflowX) && element.scrollWidth > element.clientWidth + 1
            || hides(overflowY) && element.scrollHeight > element.clientHeight + 1;
        if (isShown && cut && !(element instanceof SVGElement)) {
            found.push(`cut: ${words(element)}`);
        }
        if (element instanceof SVGSVGElement && element.checkVisibility()) {
            const frame = element.getBoundingClientRect();
            for (const text of element.querySelectorAll('text')) {
                const box = text.getBoundingClientRect();
                const over = Math.max(frame.left - box.left, box.right - frame.right,
                    frame.top - box.top, box.bottom - frame.bottom);
                if (over > 1) {
                    found.push(`cut by its figure by ${over.toFixed(1)}: "${text.textContent}"`);
                }
            }
        }
    }
    // A sentence has the width that there is, and not one column of a grid.
    for (const element of document.querySelectorAll('p, figcaption')) {
        const { width, height } = element.getBoundingClientRect();
        const room = element.parentElement.clientWidth;
        if (element.checkVisibility() && width < room / 2 && height > width && width > 2) {
            found.push(`squeezed to ${width.toFixed(0)} of ${room} pixels: ${words(element)}`);
        }
    }
    // An input that is not seen lies over what is shown for it.
    const isSeen = { visibilityProperty: true, opacityProperty: true };
    const controls = [...document.querySelectorAll('input, select, canvas, img')]
        .filter(element => element.checkVisibility(isSeen))
        .map(element => ({ element, boxes: [element.getBoundingClientRect()] }));
    found.push(...overlaps([...texts, ...controls], words, within));
    for (const { element, boxes } of texts) {
        let size = parseFloat(getComputedStyle(element).fontSize);
        if (element instanceof SVGElement) {
            const drawn = element.closest('text');
            const matrix = drawn?.getScreenCTM();
            size *= matrix ? Math.hypot(matrix.a, matrix.b) : 1;
        }
        // Figures shrink with the width of the window; a phone is where they are smallest.
        const least = touch ? 11 : 9;
        if (size < least && boxes.length > 0) {
            found.push(`letters of ${size.toFixed(1)} pixels: ${words(element)}`);
        }
    }
    if (touch) {
        found.push(...targets());
    }
    return [...new Set(found)];

    function overlaps(all, words, within) {
        const inks = all.flatMap(({ element, boxes }) => boxes.map(box => ({ element, box })));
        inks.sort((a, b) => a.box.top - b.box.top);
        const found = [];
        inks.forEach(({ element, box }, i) => {
            for (let j = i + 1; j < inks.length && inks[j].box.top < box.bottom - 2; j++) {
                const other = inks[j];
                const right = Math.min(box.right, other.box.right);
                const wide = right - Math.max(box.left, other.box.left);
                const high = Math.min(box.bottom, other.box.bottom) - other.box.top;
                const nested = element.contains(other.element) || other.element.contains(element);
                // Lines stand closer than their boxes, and what scrolls is cut at its edge.
                const close = Math.min(box.height, other.box.height) * 0.45;
                const together = within(element) === within(other.element);
                if (!nested && wide > 2 && high > close && together) {
                    found.push(`overlap: ${words(element)} and ${words(other.element)}`);
                }
            }
        });
        return found;
    }

    /// WCAG 2.2, 2.5.8: 24 pixels, or links within a sentence.
    function targets() {
        const found = [];
        const all = 'button, select, input, summary, a[href], [role=slider], [role=button]';
        for (const element of document.querySelectorAll(all)) {
            const isShown = element.checkVisibility({ visibilityProperty: true });
            if (!isShown || window.isForReaders(element)) {
                continue;
            }
            const isInText = element.matches('a') && element.closest('p, li, td, figcaption, dd');
            const label = element.matches('[type=checkbox], [type=radio]') && element.labels?.[0];
            const boxes = [element, label].filter(Boolean).map(it => it.getBoundingClientRect());
            const fits = box => box.width >= 24 && box.height >= 24;
            if (!isInText && !boxes.some(fits)) {
                const { width, height } = boxes[0];
                const size = `${width.toFixed(0)} × ${height.toFixed(0)}`;
                found.push(`a target of ${size}: ${words(element)}`);
            }
        }
        return found;
    }
}

/// The ring about what has the focus is seen on all sides: nothing around it cuts it.
export function ring() {
    const element = document.activeElement;
    const { outlineStyle, outlineWidth, outlineOffset } = getComputedStyle(element);
    if (outlineStyle === 'none') {
        return [];
    }
    const reach = parseFloat(outlineWidth) + parseFloat(outlineOffset);
    const box = element.getBoundingClientRect();
    for (let at = element.parentElement; at; at = at.parentElement) {
        const { overflowX, overflowY } = getComputedStyle(at);
        if (at === document.body || overflowX === 'visible' && overflowY === 'visible') {
            continue;
        }
        const outer = at.getBoundingClientRect();
        const [left, top] = [outer.left + at.clientLeft, outer.top + at.clientTop];
        const over = Math.max(left - (box.left - reach), box.right + reach - left - at.clientWidth,
            top - (box.top - reach), box.bottom + reach - top - at.clientHeight);
        if (over > 0.5) {
            const what = element.id || element.textContent.trim().slice(0, 40);
            return [`the ring about "${what}" is cut by ${over.toFixed(1)} pixels`];
        }
    }
    return [];
}

/// On paper: pictures are there, what must not be divided is asked to stay whole and fits, and
/// figures are not drawn larger than their letters ask for.
export function printed({ pageHeight }) {
    const found = [];
    const body = parseFloat(getComputedStyle(document.body).fontSize);
    for (const text of document.querySelectorAll('svg text')) {
        const { a, b } = text.getScreenCTM() ?? { a: 0, b: 0 };
        const size = parseFloat(getComputedStyle(text).fontSize) * Math.hypot(a, b);
        if (text.checkVisibility() && size > 1.5 * body) {
            const large = (size / body).toFixed(1);
            found.push(`letters of ${large} times those of the page: "${text.textContent}"`);
        }
    }
    for (const element of document.querySelectorAll('figure, img, svg, tr')) {
        if (!element.checkVisibility()) {
            continue;
        }
        const box = element.getBoundingClientRect();
        let whole = false;
        for (let at = element; at; at = at.parentElement) {
            whole ||= getComputedStyle(at).breakInside === 'avoid';
        }
        const replaced = element.matches('img, svg, tr');
        if (!whole && !replaced) {
            found.push(`may be divided: ${element.tagName}.${element.getAttribute('class')}`);
        }
        if (box.height > pageHeight) {
            found.push(`taller than a sheet: ${element.tagName}.${element.getAttribute('class')}`);
        }
    }
    // A button without a box of its own is what it holds.
    const controls = document.querySelectorAll('input, select, button, summary, [role=slider]');
    for (const control of controls) {
        if (control.getClientRects().length > 0) {
            const what = control.id || control.getAttribute('class') || control.tagName;
            found.push(`a control on paper: ${what.toLowerCase()}`);
        }
    }
    return found;
}
