// A link of the list of sections that is half beyond the edge comes into view as a whole when the
// focus comes to it: browsers scroll only what is not seen at all.
document.querySelector('.contents').addEventListener('focusin', ({ target }) => {
    target.scrollIntoView({ block: 'nearest', inline: 'nearest', behavior: 'instant' });
});
